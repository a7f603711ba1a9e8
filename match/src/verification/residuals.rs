//! The residuals of edges, split into the systematic offset of features and the roughness of their
//! edges.
//!
//! The features of a part lie on their contours, however rough their edges are. Those of another
//! thing may have edges as smooth, and lie next to the contours or at an angle to them. For each
//! feature a translation, a rotation and a scale of the image are fitted to its edges. The residual
//! that they remove is the systematic offset; what remains is the roughness.

use crate::camera::Pinhole;
use crate::pose::refine::{PointToLine, residual};
use nalgebra::{Isometry3, Matrix4, Point2, Vector2, Vector4};
use schemars::JsonSchema;
use serde::Serialize;

/// The prior deviations of the translation, in pixels, and of the rotation and the scale. They are
/// large enough to remove nearly all of an offset. They are small enough that undetermined motions,
/// such as a translation along a line, stay zero.
const FREE: [f64; 2] = [6.0, 0.25];

/// The residuals of edges from contours, as root mean squares in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize)]
pub struct SystematicOffset {
    /// The systematic offset.
    pub wholes: f64,
    /// The roughness.
    pub edges: f64,
}

impl SystematicOffset {
    /// The residuals of all features of a part at a pose, and of each; none for features without
    /// edges.
    pub(crate) fn new(
        camera: &Pinhole,
        pose: &Isometry3<f64>,
        features: &[Vec<PointToLine>],
    ) -> (Self, Vec<Option<Self>>) {
        let squares = features.iter().map(|pulls| squares(camera, pose, pulls));
        let squares: Vec<Option<[f64; 3]>> = squares.collect();
        let sum = squares.iter().flatten().copied();
        let sum = sum.reduce(|a, b| [0, 1, 2].map(|i| a[i] + b[i]));
        (
            sum.map_or_else(Self::default, Self::root),
            squares.iter().map(|s| s.map(Self::root)).collect(),
        )
    }

    /// The root mean squares of weighted sums of squares and the sum of weights.
    fn root([wholes, edges, weight]: [f64; 3]) -> Self {
        Self {
            wholes: (wholes / weight).sqrt(),
            edges: (edges / weight).sqrt(),
        }
    }
}

/// The weighted sums of squares of the systematic offset and of the roughness of a feature, and the
/// sum of weights; none where there is no weight.
fn squares(camera: &Pinhole, pose: &Isometry3<f64>, pulls: &[PointToLine]) -> Option<[f64; 3]> {
    let seen = pulls.iter().filter_map(|pull| {
        let (off, _) = residual(camera, pose, pull)?;
        Some((off, pull))
    });
    let seen: Vec<(f64, &PointToLine)> = seen.collect();
    let mut sums = [0.0; 3];
    for ((off, pull), left) in seen.iter().zip(left(&seen)?) {
        sums[0] += pull.weight * (off - left) * (off - left);
        sums[1] += pull.weight * left * left;
        sums[2] += pull.weight;
    }
    (sums[2] > 0.0).then_some(sums)
}

/// The residuals of one feature's edges after it is translated, rotated and scaled to fit them.
fn left(seen: &[(f64, &PointToLine)]) -> Option<Vec<f64>> {
    let places = seen
        .iter()
        .map(|(off, pull)| pull.target + pull.normal * *off);
    let places: Vec<Point2<f64>> = places.collect();
    let sum = places.iter().map(|p| p.coords).reduce(|a, b| a + b)?;
    let middle = Point2::from(sum / places.len() as f64);
    let ways = seen.iter().zip(&places);
    let ways: Vec<Vector4<f64>> = ways
        .map(|((_, pull), place)| motion_along_normal(&pull.normal, &(place - middle)))
        .collect();
    let [moves, turns] = FREE.map(|free| 1.0 / (free * free));
    let mut normal = Matrix4::from_diagonal(&Vector4::new(moves, moves, turns, turns));
    let mut right = Vector4::zeros();
    for ((off, _), way) in seen.iter().zip(&ways) {
        normal += way * way.transpose();
        right += way * *off;
    }
    let step = normal.cholesky()?.solve(&right);
    let left = seen.iter().zip(&ways);
    Some(left.map(|((off, _), way)| off - way.dot(&step)).collect())
}

/// The derivatives of a contour point's motion along its normal: by the two components of a
/// translation, by a rotation and by a scale about a centre, from which the point lies at `from`.
fn motion_along_normal(normal: &Vector2<f64>, from: &Vector2<f64>) -> Vector4<f64> {
    Vector4::new(normal.x, normal.y, from.perp(normal), normal.dot(from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::Point3;
    use std::f64;

    const CAMERA: Pinhole = Pinhole {
        focal: [100.0, 100.0],
        centre: [0.0, 0.0],
        skew: 0.0,
    };

    /// Edges at given distances along the normals from points at depth 1.
    fn pulls(at: impl Fn(f64) -> ([f64; 2], [f64; 2], f64)) -> Vec<PointToLine> {
        let all = (0..64).map(|k| {
            let (place, normal, off) = at(f64::from(k) / 64.0);
            let (place, normal) = (Point2::from(place), Vector2::from(normal));
            PointToLine {
                point: Point3::new(place.x / 100.0, place.y / 100.0, 1.0),
                target: place + normal * off,
                normal,
                weight: 1.0,
            }
        });
        all.collect()
    }

    fn of(pulls: Vec<PointToLine>) -> SystematicOffset {
        SystematicOffset::new(&CAMERA, &Isometry3::identity(), &[pulls]).0
    }

    #[test]
    fn a_line_next_to_its_edge_has_a_systematic_offset_and_a_rough_one_has_none() {
        let adjacent = of(pulls(|t| ([64.0 * t, 0.0], [0.0, 1.0], 2.0)));
        assert_relative_eq!(adjacent.wholes, 2.0, epsilon = 0.01);
        assert!(adjacent.edges < 0.01, "{adjacent:?}");
        // The edges alternate between both sides. The fitted line removes only the little that the
        // ends do not balance.
        let rough = of(pulls(|t| {
            let side = (f64::consts::PI * 64.0 * t).cos();
            ([64.0 * t, 0.0], [0.0, 1.0], side)
        }));
        assert!(rough.wholes < 0.05, "{rough:?}");
        assert_relative_eq!(rough.edges, 1.0, epsilon = 0.01);
    }

    #[test]
    fn a_tilted_line_has_a_systematic_offset() {
        // The offset runs from -1 to 1: its root mean square is 1/√3.
        let tilted = of(pulls(|t| ([64.0 * t, 0.0], [0.0, 1.0], 2.0 * t - 1.0)));
        assert_relative_eq!(tilted.wholes, 3.0_f64.sqrt().recip(), epsilon = 0.02);
        assert!(tilted.edges < 0.02, "{tilted:?}");
    }

    #[test]
    fn a_circle_moved_or_of_another_radius_has_a_systematic_offset() {
        let circle = |off: fn(f64, f64) -> f64| {
            of(pulls(move |t| {
                let (y, x) = (t * f64::consts::TAU).sin_cos();
                ([20.0 * x, 20.0 * y], [x, y], off(x, y))
            }))
        };
        for found in [circle(|x, _| x), circle(|x, y| x + y), circle(|_, _| 1.0)] {
            assert!(found.edges < 0.1 * found.wholes, "{found:?}");
        }
        // Another ratio of axes is not a similarity, so it counts as roughness.
        let squeezed = circle(|x, y| x * x - y * y);
        assert!(squeezed.wholes < 0.1 * squeezed.edges, "{squeezed:?}");
    }
}
