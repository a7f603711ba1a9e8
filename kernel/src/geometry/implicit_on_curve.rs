//! A surface's implicit polynomial restricted to a line or a circle, by its few coefficients.
//!
//! The polynomial is nearly constant along a line close to a ruling, and along a circle about
//! nearly the axis of the surface. Its coefficients separate such a curve from the surface over
//! long intervals. In coordinates the terms cancel, and only very short intervals are conclusive.

use super::curve::{Circle, Curve, Line};
use super::surface::Surface;
use super::trigonometric::Trig2;
use super::vector::Length;
use crate::number::float::{Analytic, Float};
use crate::number::interval::Interval;

/// The restriction of a surface's implicit polynomial to a curve. Its value is the level times the
/// factor that [`conjugate`] gives.
#[derive(Debug)]
pub(super) enum ImplicitOnCurve<N: Float> {
    /// For a circle, a trigonometric polynomial of its angle.
    Circle {
        coefficients: Trig2<N>,
        /// A bound of the rounding error.
        slop: N,
    },
    /// For a line, the coefficients by the powers of its parameter.
    Line {
        powers: Quartic<N>,
        /// The distance of the line's origin from the surface's.
        away: N,
    },
}

/// The coefficients of a polynomial, the constant first.
type Quartic<N> = [N; 5];

/// The number of sample points: that of the coefficients.
const POINTS: u32 = 5;
/// The number of roundings in a coefficient.
const ROUNDINGS: f64 = 64.0;

impl<N: Float> ImplicitOnCurve<N> {
    /// `None` for other curves, and for f64 where the restriction gives no advantage.
    pub(super) fn new(curve: &Curve<N>, surface: &Surface<N>) -> Option<Self> {
        match (curve, surface) {
            (Curve::Circle(circle), Surface::Torus(_)) => Some(Self::circle(circle, surface)),
            _ if N::IS_DOUBLE => None,
            (Curve::Circle(circle), _) => Some(Self::circle(circle, surface)),
            (Curve::Line(line), _) => Some(Self::line(line, surface)),
            _ => None,
        }
    }

    /// The restriction to a circle.
    pub(super) fn circle(circle: &Circle<N>, surface: &Surface<N>) -> Self {
        let mut coefficients = [N::ZERO; 5];
        let mut most = N::ZERO;
        for n in 0..POINTS {
            let u = N::TAU * N::whole(n) / N::whole(POINTS);
            let (sin, cos) = u.sin_cos();
            let (x, y) = (circle.radius * cos, circle.radius * sin);
            let p = circle.frame.point(x, y, N::ZERO);
            let value = surface.polynomial(&p);
            most = most.max(size(surface, (p - surface.frame().origin).length()));
            let (sin2, cos2) = (N::TWO * sin * cos, N::TWO * cos * cos - N::ONE);
            let rates = [N::HALF, cos, sin, cos2, sin2];
            for (k, rate) in coefficients.iter_mut().zip(rates) {
                *k += N::TWO / N::whole(POINTS) * rate * value;
            }
        }
        Self::Circle {
            coefficients,
            slop: N::from_f64(ROUNDINGS) * N::EPSILON * most,
        }
    }

    fn line(line: &Line<N>, surface: &Surface<N>) -> Self {
        let frame = surface.frame();
        let (from, by) = (
            frame.coordinates(&line.origin),
            frame.components(&line.direction),
        );
        let [x, y, z] = [0, 1, 2].map(|i| square([from[i], by[i], N::ZERO]));
        let across: Quartic<N> = std::array::from_fn(|n| x[n] + y[n]);
        let minus = |polynomial: Quartic<N>, constant: N| {
            let [first, rest @ ..] = polynomial;
            let [a, b, c, d] = rest;
            [first - constant, a, b, c, d]
        };
        let powers = match surface {
            Surface::Plane(_) => [from[2], by[2], N::ZERO, N::ZERO, N::ZERO],
            Surface::Cylinder(s) => minus(across, s.radius * s.radius),
            Surface::Sphere(s) => {
                let all = std::array::from_fn(|n| across[n] + z[n]);
                minus(all, s.radius * s.radius)
            }
            Surface::Cone(s) => {
                std::array::from_fn(|n| across[n] * s.cos * s.cos - z[n] * s.sin * s.sin)
            }
            Surface::Torus(s) => {
                let all: Quartic<N> = std::array::from_fn(|n| across[n] + z[n]);
                let [a, b, c, ..] = minus(all, s.minor * s.minor - s.major * s.major);
                let far = N::from_f64(4.0) * s.major * s.major;
                let sum = square([a, b, c]);
                std::array::from_fn(|n| sum[n] - far * across[n])
            }
            Surface::EllipticCylinder(s) => weighted([x, y, z], s.equation()),
            Surface::EllipticCone(s) => weighted([x, y, z], s.equation()),
            Surface::Ellipsoid(s) => weighted([x, y, z], s.equation()),
        };
        Self::Line {
            powers,
            away: (line.origin - frame.origin).length(),
        }
    }

    /// A range of the surface's level over an interval of the parameter; `place` is a box that
    /// contains the curve there.
    pub(super) fn level(
        &self,
        t: Interval<N>,
        surface: &Surface<N>,
        place: [Interval<N>; 3],
    ) -> Interval<N> {
        let (value, slop) = match self {
            Self::Circle { coefficients, slop } => (t.harmonic(coefficients, t.sin_cos()), *slop),
            Self::Line { powers, away } => {
                let most = size(surface, *away + t.magnitude());
                (over(powers, t), N::from_f64(ROUNDINGS) * N::EPSILON * most)
            }
        };
        let value = value + Interval::around(N::ZERO, slop);
        value.over(conjugate(surface, surface.frame().local(place)))
    }
}

/// The weighted sum of the squares of the coordinates, less a constant.
fn weighted<N: Float>(
    [x, y, z]: [Quartic<N>; 3],
    ([a, b, c], constant): ([N; 3], N),
) -> Quartic<N> {
    let mut sum: Quartic<N> = std::array::from_fn(|n| a * x[n] + b * y[n] + c * z[n]);
    sum[0] -= constant;
    sum
}

/// The square of a polynomial of degree two.
fn square<N: Float>([a, b, c]: [N; 3]) -> Quartic<N> {
    [
        a * a,
        N::TWO * a * b,
        b * b + N::TWO * a * c,
        N::TWO * b * c,
        c * c,
    ]
}

/// The range of a polynomial over an interval, by expansion about the midpoint.
fn over<N: Float>(powers: &Quartic<N>, t: Interval<N>) -> Interval<N> {
    let middle = t.mid();
    let mut about = *powers;
    for first in 0..about.len() {
        for n in (first..about.len() - 1).rev() {
            about[n] += about[n + 1] * middle;
        }
    }
    let run = t - Interval::point(middle);
    let term = |sum: Interval<N>, c: &N| sum * run + Interval::point(*c);
    about.iter().rev().fold(Interval::point(N::ZERO), term)
}

/// The size of the terms of a surface's polynomial at the distance `away` from its origin, to which
/// the rounding error is proportional.
fn size<N: Float>(surface: &Surface<N>, away: N) -> N {
    let (lengths, degree) = match surface {
        Surface::Plane(_) => (away, 1),
        Surface::Cylinder(s) => (away + s.radius, 2),
        Surface::Sphere(s) => (away + s.radius, 2),
        Surface::Cone(_) => (away, 2),
        Surface::Torus(s) => (away + s.major.abs() + s.minor, 4),
        Surface::EllipticCylinder(s) => return weight(s.equation(), away),
        Surface::EllipticCone(s) => return weight(s.equation(), away),
        Surface::Ellipsoid(s) => return weight(s.equation(), away),
    };
    lengths.powi(degree)
}

/// A bound of the terms of an equation at the distance `away` from its origin.
fn weight<N: Float>((squares, constant): ([N; 3], N), away: N) -> N {
    let most = squares.into_iter().map(N::abs).fold(N::ZERO, N::max);
    most * away * away + constant
}

/// The ratio of the polynomial to the level, over a box in the surface's frame.
fn conjugate<N: Float>(surface: &Surface<N>, [x, y, z]: [Interval<N>; 3]) -> Interval<N> {
    let across = (x.square() + y.square()).root();
    match surface {
        Surface::Plane(_) => Interval::point(N::ONE),
        Surface::Cylinder(s) => Interval::point(N::TWO * s.radius),
        Surface::Sphere(s) => Interval::point(N::TWO * s.radius),
        Surface::Cone(s) => across.scale(s.cos) + z.scale(s.sin),
        Surface::Torus(s) => {
            let far = (across + Interval::point(s.major)).square();
            let far = far + z.square() - Interval::point(s.minor * s.minor);
            far.scale(N::TWO * s.minor)
        }
        Surface::EllipticCylinder(s) => s.slope([x, y, z]).scale(s.equation().1),
        Surface::EllipticCone(s) => {
            let sum = s.radius([x, y, z]) + z;
            sum.over(s.inverse_slope([x, y, z])).scale(s.sine_squared())
        }
        Surface::Ellipsoid(s) => s.slope([x, y, z]).scale(s.equation().1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::frame::Frame;
    use crate::geometry::surface::{Cone, Torus, of_every_kind};
    use nalgebra::{Point3, Vector3};

    #[test]
    fn levels_are_the_surface_s_along_the_curve() {
        let frame = Frame::about(
            Point3::new(0.3, -0.2, 0.1),
            Vector3::new(0.2, 0.3, 0.9).normalize(),
        );
        let surfaces = of_every_kind(frame, 1.2, [1.1, 0.4]);
        let circle = Circle {
            frame: Frame::about(Point3::new(0.0, 0.1, 1.3), Vector3::z()),
            radius: 0.9,
        };
        let line = Line {
            origin: Point3::new(-0.7, 0.4, 2.0),
            direction: Vector3::new(0.1, -0.2, -0.3).normalize(),
        };
        for surface in &surfaces {
            for (curve, own) in [
                (
                    Curve::Circle(circle),
                    ImplicitOnCurve::circle(&circle, surface),
                ),
                (Curve::Line(line), ImplicitOnCurve::line(&line, surface)),
            ] {
                are_the_surface_s(surface, &curve, &own);
            }
        }
    }

    fn are_the_surface_s(surface: &Surface, curve: &Curve, own: &ImplicitOnCurve<f64>) {
        for k in 0..60 {
            let t = Interval::around(0.1 * f64::from(k), 1e-3);
            let place = curve.box_over(t).unwrap();
            let level_range = own.level(t, surface, place);
            let p = curve.point(t.mid());
            let level = surface.level([p.x, p.y, p.z]);
            assert!(
                level_range.lo <= level && level <= level_range.hi,
                "{level_range:?} {level}"
            );
            // Farther away the other nappe of a cone may be close, where the polynomial is
            // inconclusive.
            let is_far = level.abs() > 0.5;
            assert!(
                level_range.width() < 0.02 || is_far,
                "{level_range:?} {level} {surface:?}"
            );
        }
    }

    #[test]
    fn a_line_nearly_on_a_ruling_is_clear_at_once() {
        let cone = Surface::Cone(Cone {
            frame: Frame::world(),
            sin: 0.6,
            cos: 0.8,
        });
        let line = |off: f64| Line {
            origin: Point3::new(0.6, 0.0, 0.8 + off),
            direction: Vector3::new(0.6, 0.0, 0.8),
        };
        let far = Interval::new(0.0, 100.0);
        for off in [-1e-9, 1e-9] {
            let line = line(off);
            let place = Curve::Line(line).box_over(far).unwrap();
            let level_range = ImplicitOnCurve::line(&line, &cone).level(far, &cone, place);
            assert!(
                level_range.lo * off < 0.0 && level_range.hi * off < 0.0,
                "{level_range:?}"
            );
        }
    }

    #[test]
    fn a_coaxial_circle_next_to_a_torus_is_clear_at_once() {
        let frame = Frame::world();
        let torus = Surface::Torus(Torus {
            frame,
            major: 1.0,
            minor: 0.5,
        });
        let gap = 1.0 / 1024.0;
        let circle = Circle {
            frame: Frame::about(Point3::new(0.0, 0.0, 0.5), Vector3::z()),
            radius: 1.0 + gap,
        };
        let whole = Interval::new(0.0, 6.3);
        let place = Curve::Circle(circle).box_over(whole).unwrap();
        // The box of the full circle contains the axis, where the range is infinite; that of a
        // quarter does not.
        let quarter = Interval::new(0.1, 1.5);
        let near = Curve::Circle(circle).box_over(quarter).unwrap();
        let level_range = ImplicitOnCurve::circle(&circle, &torus).level(quarter, &torus, near);
        assert!(
            level_range.lo > 0.5 * gap * gap && level_range.hi < 4.0 * gap * gap,
            "{level_range:?}"
        );
        assert!(
            ImplicitOnCurve::circle(&circle, &torus)
                .level(whole, &torus, place)
                .hi
                > 0.0
        );
    }
}
