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
    pub offset: f64,
    /// The roughness.
    pub roughness: f64,
}

/// The residuals of a part's features.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SystematicOffsets {
    /// The residuals of all features.
    pub joint: SystematicOffset,
    /// The residuals of each; none for features without edges.
    pub by_feature: Vec<Option<SystematicOffset>>,
}

impl SystematicOffsets {
    /// The residuals of a part's features at a pose.
    pub fn new(camera: &Pinhole, pose: &Isometry3<f64>, features: &[Vec<PointToLine>]) -> Self {
        let squares = features
            .iter()
            .map(|pulls| WeightedSquares::new(camera, pose, pulls));
        let squares: Vec<Option<WeightedSquares>> = squares.collect();
        let sum = squares.iter().flatten().copied();
        let sum = sum.reduce(WeightedSquares::plus);
        let roots = squares.iter().map(|s| s.map(WeightedSquares::root));
        Self {
            joint: sum.map_or_else(SystematicOffset::default, WeightedSquares::root),
            by_feature: roots.collect(),
        }
    }
}

/// The weighted sums of squares of a feature's residuals.
#[derive(Clone, Copy)]
struct WeightedSquares {
    /// Of the systematic offset.
    offset: f64,
    /// Of the roughness.
    roughness: f64,
    /// The sum of weights.
    weight: f64,
}

impl WeightedSquares {
    /// The sums of a feature; none where there is no weight.
    fn new(camera: &Pinhole, pose: &Isometry3<f64>, pulls: &[PointToLine]) -> Option<Self> {
        let seen = pulls.iter().filter_map(|pull| {
            let off = residual(camera, pose, pull)?.off;
            Some(SeenPull { off, pull })
        });
        let seen: Vec<SeenPull<'_>> = seen.collect();
        let mut sums = Self {
            offset: 0.0,
            roughness: 0.0,
            weight: 0.0,
        };
        for (SeenPull { off, pull }, left) in seen.iter().zip(left(&seen)?) {
            sums.offset += pull.weight * (off - left) * (off - left);
            sums.roughness += pull.weight * left * left;
            sums.weight += pull.weight;
        }
        (sums.weight > 0.0).then_some(sums)
    }

    fn plus(self, other: Self) -> Self {
        Self {
            offset: self.offset + other.offset,
            roughness: self.roughness + other.roughness,
            weight: self.weight + other.weight,
        }
    }

    /// The root mean squares.
    fn root(self) -> SystematicOffset {
        SystematicOffset {
            offset: (self.offset / self.weight).sqrt(),
            roughness: (self.roughness / self.weight).sqrt(),
        }
    }
}

/// A point-to-line residual at a pose.
struct SeenPull<'a> {
    /// The distance, in pixels.
    off: f64,
    pull: &'a PointToLine,
}

/// The residuals of one feature's edges after it is translated, rotated and scaled to fit them.
fn left(seen: &[SeenPull<'_>]) -> Option<Vec<f64>> {
    let places = seen
        .iter()
        .map(|seen| seen.pull.target + seen.pull.normal * seen.off);
    let places: Vec<Point2<f64>> = places.collect();
    let sum = places.iter().map(|p| p.coords).reduce(|a, b| a + b)?;
    let middle = Point2::from(sum / places.len() as f64);
    let ways = seen.iter().zip(&places);
    let ways: Vec<Vector4<f64>> = ways
        .map(|(seen, place)| motion_along_normal(&seen.pull.normal, &(place - middle)))
        .collect();
    let [moves, turns] = FREE.map(|free| 1.0 / (free * free));
    let mut normal = Matrix4::from_diagonal(&Vector4::new(moves, moves, turns, turns));
    let mut right = Vector4::zeros();
    for (seen, way) in seen.iter().zip(&ways) {
        normal += way * way.transpose();
        right += way * seen.off;
    }
    let step = normal.cholesky()?.solve(&right);
    let left = seen.iter().zip(&ways);
    Some(left.map(|(seen, way)| seen.off - way.dot(&step)).collect())
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
        SystematicOffsets::new(&CAMERA, &Isometry3::identity(), &[pulls]).joint
    }

    #[test]
    fn a_line_next_to_its_edge_has_a_systematic_offset_and_a_rough_one_has_none() {
        let adjacent = of(pulls(|t| ([64.0 * t, 0.0], [0.0, 1.0], 2.0)));
        assert_relative_eq!(adjacent.offset, 2.0, epsilon = 0.01);
        assert!(adjacent.roughness < 0.01, "{adjacent:?}");
        // The edges alternate between both sides. The fitted line removes only the little that the
        // ends do not balance.
        let rough = of(pulls(|t| {
            let side = (f64::consts::PI * 64.0 * t).cos();
            ([64.0 * t, 0.0], [0.0, 1.0], side)
        }));
        assert!(rough.offset < 0.05, "{rough:?}");
        assert_relative_eq!(rough.roughness, 1.0, epsilon = 0.01);
    }

    #[test]
    fn a_tilted_line_has_a_systematic_offset() {
        // The offset runs from -1 to 1: its root mean square is 1/√3.
        let tilted = of(pulls(|t| ([64.0 * t, 0.0], [0.0, 1.0], 2.0 * t - 1.0)));
        assert_relative_eq!(tilted.offset, 3.0_f64.sqrt().recip(), epsilon = 0.02);
        assert!(tilted.roughness < 0.02, "{tilted:?}");
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
            assert!(found.roughness < 0.1 * found.offset, "{found:?}");
        }
        // Another ratio of axes is not a similarity, so it counts as roughness.
        let squeezed = circle(|x, y| x * x - y * y);
        assert!(squeezed.offset < 0.1 * squeezed.roughness, "{squeezed:?}");
    }
}
