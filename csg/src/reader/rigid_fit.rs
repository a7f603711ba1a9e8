//! Finds the rigid placement that a matrix of six-digit decimals represents.
//!
//! Notation: `A` the matrix as written, `S` the mirror `y -> -y`, `R` an exact rotation with `A =
//! R` or `A = R S` up to the rounding of the file.

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion};
use premio_kernel::motion::RationalMatrix;
use premio_kernel::number::rational::{Rational, from_f64, to_f64};

use crate::transform::{Transform, TransformStep};

/// The largest difference between an entry of a matrix and that of the rotation it represents.
// Programs write six digits: 5e-7 an entry, and a few times that after products of matrices.
pub(super) const MAX_RESIDUAL: f64 = 2e-5;

/// The distance from an integer within which an entry is the sine or cosine of a quarter turn.
const NEAR_WHOLE: f64 = 1e-12;

/// The rounding of a rotation's entry if numbers are written with six digits or fewer.
const SIX_DIGITS: f64 = 1.1e-6;

/// The rounding of a rotation's entry if it was computed and written with all digits of an f64.
const ALL_DIGITS: f64 = 1e-15;

/// `p -> R S p + t` or `p -> R p + t`, and the largest difference between its matrix and the one
/// written.
#[derive(Debug, Clone)]
pub(super) struct Placement {
    pub(super) moves: Transform,
    pub(super) mirrored: bool,
    pub(super) residual: f64,
    /// Whether entries are written with more than six digits.
    full: bool,
}

/// Smaller differences are only the rounding of f64 entries.
pub(super) const F64_DIGITS: f64 = 1e-12;

impl Placement {
    /// Whether the matrix differs from the one that is written. A file of six digits has lost
    /// digits of its offsets, too.
    pub(super) fn replaces(&self) -> bool {
        match self.full {
            true => self.residual > F64_DIGITS,
            false => self.residual > 0.0,
        }
    }
}

/// Why a matrix is not a rigid placement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum NotRigid {
    /// A uniform scale by this factor.
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
    let digits = matrix.iter().flatten().map(significant_digits).max();
    let digits = digits.unwrap_or(0);
    let mirrored = doubles.determinant() < 0.0;
    let sign = |j: usize| if mirrored && j == 1 { -1.0 } else { 1.0 };
    let proper = Matrix3::from_fn(|i, j| sign(j) * doubles[(i, j)]);
    let rotation = nearest_rotation(&proper, rounding(digits)).ok_or(NotRigid::Distorted)?;
    let mut exact = rotation.motion().rotation_matrix();
    if mirrored {
        for row in &mut exact {
            row[1] = -std::mem::take(&mut row[1]);
        }
    }
    let residual = distance(&exact, matrix);
    if residual > MAX_RESIDUAL {
        return Err(NotRigid::Distorted);
    }
    Ok(Placement {
        moves: rotation.then(Transform::shift(offset)),
        mirrored,
        residual,
        full: digits > FEW,
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

/// The number of digits in most files.
const FEW: i32 = 6;

/// The largest distance of an entry from a sine or cosine, for the number of digits written.
fn rounding(digits: i32) -> f64 {
    let beyond = digits.max(FEW) - FEW;
    ALL_DIGITS.max(SIX_DIGITS * 0.1f64.powi(beyond))
}

/// The number of significant digits of a decimal, at most seventeen.
fn significant_digits(value: &Rational) -> i32 {
    const MOST: i32 = 17;
    let ten = Rational::from(10);
    let mut magnitude = if *value < Rational::ZERO {
        -value
    } else {
        value.clone()
    };
    // Entries are at most about one; much smaller ones are noise.
    let mut digits = 0;
    while digits < MOST && !magnitude.is_int() {
        magnitude *= &ten;
        if magnitude >= Rational::ONE || digits > 0 {
            digits += 1;
        } else if magnitude.is_zero() {
            break;
        }
    }
    digits
}

fn nearest_rotation(matrix: &Matrix3<f64>, rounding: f64) -> Option<Transform> {
    quarter_turns(matrix).or_else(|| {
        let step = whole_angle(matrix, rounding).or_else(|| general(matrix))?;
        let mut moves = Transform::new();
        moves.push(step).ok()?;
        Some(moves)
    })
}

/// A matrix of zeros and ones, which is exact.
fn quarter_turns(matrix: &Matrix3<f64>) -> Option<Transform> {
    let whole = matrix.map(f64::round);
    if (matrix - whole).amax() > NEAR_WHOLE {
        return None;
    }
    let entry = |i: usize, j: usize| from_f64(whole[(i, j)]).unwrap_or(Rational::ZERO);
    Transform::quarter_turns(&[0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j))))
}

/// A rotation about a coordinate axis by a multiple of a quarter degree, if it explains all digits.
fn whole_angle(matrix: &Matrix3<f64>, rounding: f64) -> Option<TransformStep> {
    const STEPS: f64 = 4.0;
    let axis = (0..3).find(|&k| (matrix[(k, k)] - 1.0).abs() <= NEAR_WHOLE)?;
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let degrees = matrix[(j, i)].atan2(matrix[(i, i)]).to_degrees();
    let degrees = from_f64((degrees * STEPS).round() / STEPS)?;
    let step = TransformStep::about(axis, degrees);
    let motion = step.motion().ok()?;
    let explained = (motion.rotation_f64() - matrix).amax() <= rounding;
    explained.then_some(step)
}

/// The rotation of the quaternion closest to a matrix.
fn general(matrix: &Matrix3<f64>) -> Option<TransformStep> {
    let rotation = Rotation3::from_matrix_unchecked(orthogonal_factor(matrix)?);
    let quaternion: Quaternion<f64> = UnitQuaternion::from_rotation_matrix(&rotation).into_inner();
    let [x, y, z, w] = quaternion.coords.into();
    let [w, x, y, z] = [w, x, y, z].map(from_f64);
    Some(TransformStep::Quaternion([w?, x?, y?, z?]))
}

/// The orthogonal factor of the polar decomposition, by Newton's iteration (Higham 1986). A matrix
/// so close to orthogonal needs two steps; zeros stay zeros.
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
    use premio_kernel::motion::Motion;
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
        assert_eq!(found.moves.motion(), &turn);
        assert!(!found.mirrored && found.residual > 0.0);
    }

    #[test]
    fn quarter_turns_leave_no_residual() {
        let turn = Motion::rotation([0, 0, 1].map(Rational::from), &(-90).into()).unwrap();
        let found = placement(&turn.rotation_matrix(), origin()).unwrap();
        assert_eq!((found.moves.motion(), found.residual), (&turn, 0.0));
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
            let off = (found.moves.motion().rotation_f64() - turn.rotation_f64()).amax();
            prop_assert!(off < 3e-6);
        }
    }
}
