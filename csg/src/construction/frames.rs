//! Rotations along given directions. A direction without a rational length is rounded far below
//! the resolution of a part.

use premio_kernel::motion::Motion;
use premio_kernel::number::double_double::F106;
use premio_kernel::number::float::Float;
use premio_kernel::number::rational::{Rational, exact_sqrt};

use crate::polyhedron::{SpacePoint, dot};
use crate::primitive::{Primitive, PrimitiveError};

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

/// The primitive with given axes, and its placement, if it is a cylinder or a right frustum whose
/// sizes are rational: of equal radii across the axis.
pub(super) fn right_frustum(
    [x, y, z]: &[SpacePoint; 3],
    top: &Rational,
) -> Option<(Result<Primitive, PrimitiveError>, Motion)> {
    let square = dot(x, x);
    let is_right = [(x, y), (y, z), (z, x)]
        .iter()
        .all(|(u, v)| dot(u, v).is_zero());
    if !is_right || dot(y, y) != square {
        return None;
    }
    let (radius, height) = (exact_sqrt(&square)?, exact_sqrt(&dot(z, z))?);
    let turn = |first: &SpacePoint, second: &SpacePoint| {
        let row = |i: usize| [&first[i] / &radius, &second[i] / &radius, &z[i] / &height];
        let zero = [Rational::ZERO, Rational::ZERO, Rational::ZERO];
        Motion::from_matrix([row(0), row(1), row(2)], zero)
    };
    let motion = turn(x, y).or_else(|| turn(y, x))?;
    let widest = &radius * top;
    Some((Primitive::frustum(radius, widest, height), motion))
}

/// Whether a number needs no rounding.
fn is_short(x: &Rational) -> bool {
    premio_kernel::number::rational::bits(x) <= SHORT
}

/// The length in bits of numbers that are kept exact.
const SHORT: usize = 256;
