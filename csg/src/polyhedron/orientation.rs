//! Predicates of points in space: exact, filtered in f64.

use super::{PolyhedronFace, SpacePoint, normal_of};
use premio_kernel::number::rational::{Rational, to_f64};
use std::cmp::Ordering;

/// A point with its rounded coordinates.
#[derive(Debug, Clone)]
pub(super) struct FilteredPoint {
    pub exact: SpacePoint,
    pub near: [f64; 3],
}

impl FilteredPoint {
    pub fn new(exact: &SpacePoint) -> Self {
        Self {
            exact: exact.clone(),
            near: exact.each_ref().map(to_f64),
        }
    }
}

/// The error of a determinant of three differences, relative to the product of their sizes and in
/// roundings: each difference is off by one rounding of the coordinates, in each of six products.
const DETERMINANT_ROUNDINGS: f64 = 64.0;

/// The side of the plane through `a`, `b` and `c` on which `d` lies: greater above it, where the
/// three points run counterclockwise.
pub(super) fn orientation([a, b, c, d]: [&FilteredPoint; 4]) -> Ordering {
    let from_a = |p: &FilteredPoint| [0, 1, 2].map(|i| p.near[i] - a.near[i]);
    let [u, v, w] = [b, c, d].map(from_a);
    let normal = [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ];
    let value = normal[0] * w[0] + normal[1] * w[1] + normal[2] * w[2];
    let most = |p: &[f64; 3]| p.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let size = [a, b, c, d]
        .iter()
        .fold(0.0f64, |m, p| m.max(most(&p.near)));
    let span = [u, v, w].iter().fold(0.0f64, |m, p| m.max(most(p)));
    if value.abs() > DETERMINANT_ROUNDINGS * f64::EPSILON * size * span * span {
        return value.total_cmp(&0.0);
    }
    sixfold_volume([a, b, c, d]).cmp(&Rational::ZERO)
}

/// Six times the signed volume of a tetrahedron.
pub(super) fn sixfold_volume([a, b, c, d]: [&FilteredPoint; 4]) -> Rational {
    let [u, v, w] = [b, c, d].map(|p| difference(p, a));
    dot(&cross(&u, &v), &w)
}

/// The error of a cross product of two differences, as [`DETERMINANT_ROUNDINGS`].
const CROSS_ROUNDINGS: f64 = 16.0;

/// Whether three points are in line.
pub(super) fn are_in_line([a, b, c]: [&FilteredPoint; 3]) -> bool {
    let from_a = |p: &FilteredPoint| [0, 1, 2].map(|i| p.near[i] - a.near[i]);
    let [u, v] = [b, c].map(from_a);
    let most = |p: &[f64; 3]| p.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let size = [a, b, c].iter().fold(0.0f64, |m, p| m.max(most(&p.near)));
    let error = CROSS_ROUNDINGS * f64::EPSILON * size * most(&u).max(most(&v));
    let area = |i: usize, j: usize| (u[i] * v[j] - u[j] * v[i]).abs();
    if area(0, 1) > error || area(1, 2) > error || area(2, 0) > error {
        return false;
    }
    let [u, v] = [b, c].map(|p| difference(p, a));
    cross(&u, &v).iter().all(Rational::is_zero)
}

/// Whether two faces of one plane look the same way.
pub(super) fn is_same_side(
    a: &PolyhedronFace,
    b: &PolyhedronFace,
    points: &[FilteredPoint],
) -> bool {
    let [a, b] = [a, b].map(|face| normal_of(face, |i| &points[i].exact));
    dot(&a, &b) > Rational::ZERO
}

pub(super) fn difference(a: &FilteredPoint, b: &FilteredPoint) -> SpacePoint {
    std::array::from_fn(|i| &a.exact[i] - &b.exact[i])
}

pub(crate) fn dot(a: &SpacePoint, b: &SpacePoint) -> Rational {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub(crate) fn cross(a: &SpacePoint, b: &SpacePoint) -> SpacePoint {
    std::array::from_fn(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        &a[j] * &b[k] - &a[k] * &b[j]
    })
}

/// Twice the area vector of a polygon (Newell): its normal, of any length.
pub(super) fn plane_normal<'a>(corners: impl Iterator<Item = &'a SpacePoint>) -> SpacePoint {
    let corners: Vec<&SpacePoint> = corners.collect();
    let mut sum: SpacePoint = std::array::from_fn(|_| Rational::ZERO);
    let [first, rest @ ..] = &corners[..] else {
        return sum;
    };
    let from = |p: &SpacePoint| -> SpacePoint { std::array::from_fn(|i| &p[i] - &first[i]) };
    for pair in rest.windows(2) {
        let part = cross(&from(pair[0]), &from(pair[1]));
        for (sum, x) in sum.iter_mut().zip(part) {
            *sum += x;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A point on the line through two others, and one off it by a tiny fraction.
        #[test]
        fn points_next_to_a_line_are_not_on_it(
            a in prop::array::uniform3(-1000i32..1000),
            along in prop::array::uniform3(-1000i32..1000),
            [t, off] in prop::array::uniform2(-20i32..20),
            exponent in 0u32..60,
        ) {
            prop_assume!(along.iter().any(|x| *x != 0));
            // Thirds are rounded in f64.
            let third = |x: i32| Rational::from(x) / Rational::from(3);
            let at = |t: &Rational, off: &Rational| -> SpacePoint {
                std::array::from_fn(|i| {
                    let across = if i == 0 { off.clone() } else { Rational::ZERO };
                    third(a[i]) + third(along[i]) * t + across
                })
            };
            let (zero, t) = (Rational::ZERO, third(t));
            let off = Rational::from(off) / Rational::from(1u64 << exponent);
            let points = [at(&zero, &zero), at(&Rational::ONE, &zero), at(&t, &off)];
            let [p, q, r] = points.each_ref().map(FilteredPoint::new);
            // The offset is along x, and so off the line unless the line is along x.
            let is_on = off.is_zero() || along[1] == 0 && along[2] == 0;
            prop_assert_eq!(are_in_line([&p, &q, &r]), is_on);
        }
    }
}
