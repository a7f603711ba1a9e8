//! Rotations along given directions. A direction without a rational length is rounded far below
//! the resolution of a part.

use premio_kernel::motion::Motion;
use premio_kernel::number::double_double::F106;
use premio_kernel::number::float::Float;
use premio_kernel::number::rational::{Rational, exact_sqrt};

use crate::polyhedron::{SpacePoint, dot};

/// The square root of a number that is not negative: exact, or rounded to 106 bits.
pub(super) fn root(square: &Rational) -> Rational {
    exact_sqrt(square).unwrap_or_else(|| {
        let root = F106::nearest(square).sqrt();
        root.exact().unwrap_or_default()
    })
}

/// The length of a vector: exact, or rounded to 106 bits.
pub(super) fn length(u: &SpacePoint) -> Rational {
    root(&dot(u, u))
}

/// The motion that takes the origin to a point and the z axis to a direction.
pub(super) fn along(origin: &SpacePoint, direction: &SpacePoint) -> Motion {
    let size = length(direction);
    let rounded = |x: &Rational| F106::nearest(x).exact().unwrap_or_default();
    let [x, y, z] = direction.each_ref().map(|x| x / &size);
    let is_below = z < Rational::ZERO;
    // The quaternion of half the turn from z, or from -z after half a turn about x.
    let quaternion = match is_below {
        false => [Rational::ONE + z, -y, x, Rational::ZERO],
        true => [-y, Rational::ONE - z, Rational::ZERO, x],
    };
    let quaternion = match quaternion.iter().all(is_short) {
        true => quaternion,
        false => quaternion.each_ref().map(rounded),
    };
    let turn = Motion::from_quaternion(quaternion).unwrap_or_default();
    turn.then(&Motion::translation(origin.clone()))
}

/// Whether a number needs no rounding.
fn is_short(x: &Rational) -> bool {
    premio_kernel::number::rational::bits(x) <= SHORT
}

/// The length in bits of numbers that are kept exact.
const SHORT: usize = 256;
