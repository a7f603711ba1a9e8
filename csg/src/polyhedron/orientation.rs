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
    let [u, v, w] = [b, c, d].map(|p| difference(p, a));
    dot(&cross(&u, &v), &w).cmp(&Rational::ZERO)
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
