//! The matrix of a member: a rigid motion, possibly with a mirror and a uniform scale.

use premio_kernel::motion::RationalMatrix;
use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::frame::length;
use super::super::rigid_fit::{NotRigid, Placement, placement};
use super::keywords::Word;
use super::number;
use crate::transform::Transform;

/// `p -> M S k p`, with `M` the motion, `S` the mirror `y -> -y` or the identity, `k` the factor.
#[derive(Debug)]
pub(super) struct Placed {
    pub(super) moves: Transform,
    pub(super) mirrored: bool,
    pub(super) factor: Rational,
    /// The largest difference between the entries used and those written.
    pub(super) residual: f64,
}

impl Placed {
    /// The placement of sixteen numbers by rows; the last number divides all others.
    pub(super) fn new(word: &Word<'_>) -> Result<Self, SpannedError> {
        let numbers: Result<Vec<Rational>, SpannedError> =
            word.list()?.iter().map(number).collect();
        let wrong = |_| word.unexpected("a matrix of sixteen numbers");
        let m: [Rational; 16] = numbers?.try_into().map_err(wrong)?;
        let last = m[12..15].iter().all(Rational::is_zero) && m[15] > Rational::ZERO;
        if !last {
            let expected = "a last row of three zeros and a number greater than zero";
            let found = "a matrix that is no motion";
            return Err(SpannedError::input(word.span.clone(), found, expected));
        }
        let matrix: RationalMatrix = [0, 4, 8].map(|row| [0, 1, 2].map(|j| m[row + j].clone()));
        let offset = [3, 7, 11].map(|at| &m[at] / &m[15]);
        let ScaledPlacement { factor, found } = match placement(&matrix, offset.clone()) {
            Err(NotRigid::Scaled(_)) => scaled(&matrix, offset),
            found => ScaledPlacement {
                factor: Rational::ONE,
                found,
            },
        };
        let found = found.map_err(|_| {
            let found = "a matrix that changes proportions or angles";
            let expected =
                "a rigid motion, perhaps mirrored, perhaps the same scale in all directions";
            SpannedError::input(word.span.clone(), found, expected)
        })?;
        Ok(Self {
            moves: found.moves,
            mirrored: found.mirrored,
            factor: factor / &m[15],
            residual: found.residual,
        })
    }
}

/// The motion of a matrix without its scale.
struct ScaledPlacement {
    factor: Rational,
    found: Result<Placement, NotRigid>,
}

fn scaled(matrix: &RationalMatrix, offset: [Rational; 3]) -> ScaledPlacement {
    let column = [0, 1, 2].map(|i| matrix[i][0].clone());
    let Some(factor) = length(&column) else {
        return ScaledPlacement {
            factor: Rational::ONE,
            found: Err(NotRigid::Distorted),
        };
    };
    let rigid = matrix
        .each_ref()
        .map(|row| row.each_ref().map(|entry| entry / &factor));
    let found = placement(&rigid, offset);
    ScaledPlacement { factor, found }
}
