//! The rigid placement that a matrix of six-digit decimals stands for.
//!
//! Notation: `A` the matrix as written, `S` the mirror `y -> -y`, `R` an exact rotation with
//! `A = R` or `A = R S` up to the rounding of the file.

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion};
use premio_kernel::motion::{Motion, RationalMatrix};
use premio_kernel::number::rational::{Rational, from_f64, to_f64};

/// How far, entry by entry, a matrix may be from the rotation it stands for.
// OpenSCAD writes six digits: 5e-7 an entry, and a few times that after products of matrices.
pub(super) const MAX_RESIDUAL: f64 = 2e-5;

/// An entry this near to a whole number comes from a sine or cosine of a quarter turn.
const NEAR_WHOLE: f64 = 1e-12;

/// The rounding of an entry written with six digits.
const SIX_DIGITS: f64 = 1.1e-6;

/// `p -> R S p + t` or `p -> R p + t`, and how far its matrix is from the one written.
#[derive(Debug, Clone)]
pub(super) struct Placement {
    pub(super) motion: Motion,
    pub(super) mirrored: bool,
    pub(super) residual: f64,
}

impl Placement {
    /// The placement that moves nothing.
    pub(super) fn identity() -> Self {
        Self {
            motion: Motion::identity(),
            mirrored: false,
            residual: 0.0,
        }
    }

    /// This placement first, then the other.
    pub(super) fn then(&self, outer: &Self) -> Self {
        let inner = if outer.mirrored {
            self.motion.mirrored_y()
        } else {
            self.motion.clone()
        };
        Self {
            motion: inner.then(&outer.motion),
            mirrored: self.mirrored != outer.mirrored,
            residual: self.residual.max(outer.residual),
        }
    }
}

/// Why a matrix is no rigid placement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum NotRigid {
    /// The same factor in all directions.
    Scaled(f64),
    /// Lengths or angles change.
    Distorted,
}

/// The exact rigid placement nearest to a matrix and a translation.
pub(super) fn placement(
    matrix: &RationalMatrix,
    offset: [Rational; 3],
) -> Result<Placement, NotRigid> {
    let doubles = Matrix3::from_fn(|i, j| to_f64(&matrix[i][j]));
    check_rigid(&doubles)?;
    let mirrored = doubles.determinant() < 0.0;
    let sign = |j: usize| if mirrored && j == 1 { -1.0 } else { 1.0 };
    let proper = Matrix3::from_fn(|i, j| sign(j) * doubles[(i, j)]);
    let rotation = nearest_rotation(&proper).ok_or(NotRigid::Distorted)?;
    let mut exact = rotation.rotation_matrix();
    if mirrored {
        for row in &mut exact {
            row[1] = -std::mem::take(&mut row[1]);
        }
    }
    let residual = distance(&exact, matrix);
    if residual > MAX_RESIDUAL {
        return Err(NotRigid::Distorted);
    }
    let motion = rotation.then(&Motion::translation(offset));
    Ok(Placement {
        motion,
        mirrored,
        residual,
    })
}

/// The largest difference between two entries.
fn distance(a: &RationalMatrix, b: &RationalMatrix) -> f64 {
    let entries = a.iter().flatten().zip(b.iter().flatten());
    entries
        .map(|(x, y)| to_f64(&(x - y)).abs())
        .fold(0.0, f64::max)
}

fn check_rigid(matrix: &Matrix3<f64>) -> Result<(), NotRigid> {
    // A product of two columns doubles the error of an entry, and adds three of them.
    let gram = matrix.transpose() * matrix;
    let far = |target: f64| (gram - Matrix3::identity() * target).amax();
    if far(1.0) <= 6.0 * MAX_RESIDUAL {
        return Ok(());
    }
    let square = gram.trace() / 3.0;
    if square > 0.0 && far(square) <= 6.0 * MAX_RESIDUAL * square {
        return Err(NotRigid::Scaled(square.sqrt()));
    }
    Err(NotRigid::Distorted)
}

fn nearest_rotation(matrix: &Matrix3<f64>) -> Option<Motion> {
    quarter_turns(matrix)
        .or_else(|| whole_angle(matrix))
        .or_else(|| general(matrix))
}

/// A matrix of zeros and ones, which is exact.
fn quarter_turns(matrix: &Matrix3<f64>) -> Option<Motion> {
    let whole = matrix.map(f64::round);
    if (matrix - whole).amax() > NEAR_WHOLE {
        return None;
    }
    let zero = Motion::identity();
    let entry = |i: usize, j: usize| from_f64(whole[(i, j)]).unwrap_or(Rational::ZERO);
    let exact = [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)));
    Motion::from_matrix(exact, zero.offset().clone())
}

/// A turn about a coordinate axis by a multiple of a quarter degree, if that explains all digits.
fn whole_angle(matrix: &Matrix3<f64>) -> Option<Motion> {
    const STEPS: f64 = 4.0;
    let axis = (0..3).find(|&k| (matrix[(k, k)] - 1.0).abs() <= NEAR_WHOLE)?;
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let degrees = matrix[(j, i)].atan2(matrix[(i, i)]).to_degrees();
    let degrees = from_f64((degrees * STEPS).round() / STEPS)?;
    let direction = std::array::from_fn(|k| Rational::from(u8::from(k == axis)));
    let motion = Motion::rotation(direction, &degrees).ok()?;
    ((motion.rotation_f64() - matrix).amax() <= SIX_DIGITS).then_some(motion)
}

/// The rotation of the quaternion that is nearest to a matrix.
fn general(matrix: &Matrix3<f64>) -> Option<Motion> {
    let rotation = Rotation3::from_matrix_unchecked(orthogonal_factor(matrix)?);
    let quaternion: Quaternion<f64> = UnitQuaternion::from_rotation_matrix(&rotation).into_inner();
    let [x, y, z, w] = quaternion.coords.into();
    let [w, x, y, z] = [w, x, y, z].map(from_f64);
    Motion::from_quaternion([w?, x?, y?, z?])
}

/// The orthogonal factor of the polar decomposition, by Newton's iteration (Higham 1986).
/// A matrix this close to orthogonal needs two steps; zeros stay zeros.
fn orthogonal_factor(matrix: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    let mut factor = *matrix;
    for _ in 0..4 {
        factor = (factor + factor.try_inverse()?.transpose()) / 2.0;
    }
    Some(factor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use premio_kernel::number::rational::from_decimal;
    use proptest::prelude::*;

    fn origin() -> [Rational; 3] {
        Motion::identity().offset().clone()
    }

    fn written(matrix: &Matrix3<f64>) -> RationalMatrix {
        // Six significant digits.
        let entry = |x: f64| from_decimal(&format!("{x:.5e}")).unwrap();
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(matrix[(i, j)])))
    }

    #[test]
    fn whole_angles_are_recognised() {
        let turn = Motion::rotation([0, 1, 0].map(Rational::from), &30.into()).unwrap();
        let found = placement(&written(&turn.rotation_f64()), origin()).unwrap();
        assert_eq!(found.motion, turn);
        assert!(!found.mirrored && found.residual > 0.0);
    }

    #[test]
    fn quarter_turns_leave_no_residual() {
        let turn = Motion::rotation([0, 0, 1].map(Rational::from), &(-90).into()).unwrap();
        let found = placement(&turn.rotation_matrix(), origin()).unwrap();
        assert_eq!((found.motion, found.residual), (turn, 0.0));
    }

    #[test]
    fn what_is_not_rigid_is_refused() {
        let matrix = |m: [[i32; 3]; 3]| m.map(|row| row.map(Rational::from));
        let refused = |m| placement(&matrix(m), origin()).map(|_| ()).unwrap_err();
        assert_eq!(
            refused([[2, 0, 0], [0, 2, 0], [0, 0, 2]]),
            NotRigid::Scaled(2.0)
        );
        assert_eq!(
            refused([[1, 0, 0], [0, 2, 0], [0, 0, 1]]),
            NotRigid::Distorted
        );
        assert_eq!(
            refused([[0, 0, 0], [0, 0, 0], [0, 0, 0]]),
            NotRigid::Distorted
        );
        assert_eq!(
            refused([[1, 1, 0], [0, 1, 0], [0, 0, 1]]),
            NotRigid::Distorted
        );
    }

    proptest! {
        #[test]
        fn any_rotation_is_found(
            axis in prop::array::uniform3(-9i32..=9),
            degrees in -180.0f64..180.0,
            mirror in any::<bool>(),
        ) {
            let axis = if axis == [0; 3] { [1, 0, 0] } else { axis }.map(Rational::from);
            let turn = Motion::rotation(axis, &from_f64(degrees).unwrap()).unwrap();
            let mut matrix = turn.rotation_f64();
            if mirror {
                matrix.column_mut(1).neg_mut();
            }
            let found = placement(&written(&matrix), origin()).unwrap();
            prop_assert_eq!(found.mirrored, mirror);
            prop_assert!(found.residual < 3e-6);
            let off = (found.motion.rotation_f64() - turn.rotation_f64()).amax();
            prop_assert!(off < 3e-6);
        }
    }
}
