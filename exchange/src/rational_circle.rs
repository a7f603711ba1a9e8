//! The parameter of a circle as a rational B-spline of four quarters, whose knots are the quarter
//! turns.
//!
//! On a quarter of degree two with the weights 1, √½, 1, the tangent of half the angle from its middle
//! is linear in the parameter. An ellipse and a cone over it have the same parameter.

use premio_kernel::number::jet::Jet;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_8};

/// The quarter of an angle, from its start: the angle of its middle.
fn middle(angle: f64) -> f64 {
    ((angle / FRAC_PI_2).floor() + 0.5) * FRAC_PI_2
}

/// The parameter at an angle.
pub(crate) fn parameter(angle: f64) -> f64 {
    let middle = middle(angle);
    middle + FRAC_PI_4 * (0.5 * (angle - middle)).tan() / FRAC_PI_8.tan()
}

/// The angle at a parameter.
pub(crate) fn angle(parameter: f64) -> f64 {
    let middle = middle(parameter);
    middle + 2.0 * ((parameter - middle) * FRAC_PI_8.tan() / FRAC_PI_4).atan()
}

/// The parameter at an angle that changes, with two derivatives.
pub(crate) fn parameter_along(angle: Jet<f64>) -> Jet<f64> {
    let middle = middle(angle.v);
    let tan = (0.5 * (angle.v - middle)).tan();
    let scale = FRAC_PI_4 / FRAC_PI_8.tan();
    let (first, second) = (
        0.5 * scale * (1.0 + tan * tan),
        0.5 * scale * tan * (1.0 + tan * tan),
    );
    Jet {
        v: middle + scale * tan,
        d: first * angle.d,
        dd: second * angle.d * angle.d + first * angle.dd,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_those_of_the_spline() {
        // A quarter by its control points (1, 0), (1, 1), (0, 1).
        let weight = 0.5_f64.sqrt();
        for k in 0..20 {
            let t = f64::from(k) / 20.0;
            let (a, b, c) = ((1.0 - t).powi(2), 2.0 * weight * t * (1.0 - t), t * t);
            let on = (c + b).atan2(a + b);
            for quarter in 0..4 {
                let start = f64::from(quarter) * FRAC_PI_2;
                let at = start + t * FRAC_PI_2;
                assert!((parameter(start + on) - at).abs() < 1e-15 * 8.0);
                assert!((angle(at) - start - on).abs() < 1e-15 * 8.0);
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_parameter() {
        let step = 1e-5;
        for k in 0..40 {
            let on = 0.05 + 0.15 * f64::from(k);
            let jet = parameter_along(Jet::variable(on));
            let [before, after] = [parameter(on - step), parameter(on + step)];
            assert!((jet.d - (after - before) / (2.0 * step)).abs() < 1e-8);
            let second = (after - 2.0 * jet.v + before) / (step * step);
            assert!((jet.dd - second).abs() < 1e-4);
        }
    }
}
