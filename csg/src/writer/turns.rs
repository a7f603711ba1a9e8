//! Rotations about coordinate axes, the only ones in `.padl`.

use nalgebra::Matrix3;
use premio_kernel::number::rational::{Rational, from_f64};

use crate::transform::{Transform, TransformStep};

/// A rotation about a coordinate axis.
#[derive(Clone)]
pub(super) struct AxisTurn {
    /// The index of the axis.
    pub axis: usize,
    /// The angle.
    pub degrees: Rational,
}

/// The rotations about coordinate axes, in degrees, that compose to a step. They are exact if the
/// step is one of them, or if whole decimals of a degree about x, y and z in this order give it;
/// otherwise they are accurate to f64. A translation gives none.
pub(super) fn about_axes(step: &TransformStep) -> Vec<AxisTurn> {
    if let TransformStep::Turn { axis, degrees } = step {
        let others = |k: usize| (0..3).all(|i| i == k || axis[i].is_zero());
        if let Some(k) = (0..3).find(|&k| others(k)) {
            let backwards = axis[k] < Rational::ZERO;
            let degrees = if backwards { -degrees } else { degrees.clone() };
            return vec![AxisTurn { axis: k, degrees }];
        }
    }
    let Ok(motion) = step.motion() else {
        return Vec::new();
    };
    let angles = angles(&motion.rotation_f64());
    let [x, y, z] = angles;
    // The other angles that give the same rotation. As decimals only one of them may be exact.
    let others = [x + 180.0, 180.0 - y, z + 180.0];
    let exact = (0..=9)
        .flat_map(|digits| [rounded(&angles, digits), rounded(&others, digits)])
        .find(|turns| {
            let mut turned = Transform::new();
            let steps = turns.iter().cloned();
            let mut steps = steps.map(|turn| TransformStep::about(turn.axis, turn.degrees));
            let all = steps.all(|step| turned.push(step).is_ok());
            all && *turned.motion() == motion
        });
    exact.unwrap_or_else(|| {
        let exactly = |(axis, degrees): (usize, f64)| {
            let degrees = from_f64(degrees)?;
            Some(AxisTurn { axis, degrees })
        };
        angles.into_iter().enumerate().filter_map(exactly).collect()
    })
}

/// The non-zero rotations, by angles of few decimals.
fn rounded(angles: &[f64; 3], digits: i32) -> Vec<AxisTurn> {
    let scale = 10f64.powi(digits);
    let round = |(axis, &degrees): (usize, &f64)| {
        let whole = from_f64((degrees * scale).round())?;
        (!whole.is_zero()).then(|| AxisTurn {
            axis,
            degrees: whole / from_f64(scale).unwrap_or(Rational::ONE),
        })
    };
    angles.iter().enumerate().filter_map(round).collect()
}

/// The angles in degrees of rotations about x, then y, then z.
fn angles(m: &Matrix3<f64>) -> [f64; 3] {
    let level = m[(0, 0)].hypot(m[(1, 0)]);
    let y = (-m[(2, 0)]).atan2(level);
    // With x rotated to z, rotations about x and z are the same.
    let upright = level < f64::EPSILON;
    let (x, z) = match upright {
        true => (0.0, (-m[(0, 1)]).atan2(m[(1, 1)])),
        false => (m[(2, 1)].atan2(m[(2, 2)]), m[(1, 0)].atan2(m[(0, 0)])),
    };
    [x, y, z].map(f64::to_degrees)
}
