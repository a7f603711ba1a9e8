//! How far features are off their contours as wholes, against how rough their edges are.
//!
//! The features of a part lie where its contours do, however rough their edges are; those of another
//! thing may have as fine edges, and lie next to the contours, or askew. What a move, a turn and a scale
//! of the image bring nearer is taken for the former, what is left for the latter.

use crate::camera::Pinhole;
use crate::pose::refine::{PointToLine, residual};
use nalgebra::{Isometry3, Matrix4, Point2, Vector2, Vector4};
use schemars::JsonSchema;
use serde::Serialize;

/// The deviation of a move, in pixels, and of a turn and of a scale: so large that little is taken off,
/// and small enough that what an edge does not tell, as a move along a line, is nothing.
const FREE: [f64; 2] = [6.0, 0.25];

/// How far edges are off contours, as root mean squares in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize)]
pub struct SystematicOffset {
    /// Features as wholes.
    pub wholes: f64,
    /// The edges of each, next to that.
    pub edges: f64,
}

impl SystematicOffset {
    /// How far the edges are off that the features of a part at a pose are drawn to: of all together, and
    /// of each; none of those that are drawn to nothing.
    pub fn new(
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

    /// Of weighted squares, and the sum of weights.
    fn root([wholes, edges, weight]: [f64; 3]) -> Self {
        Self {
            wholes: (wholes / weight).sqrt(),
            edges: (edges / weight).sqrt(),
        }
    }
}

/// The weighted squares of how far a feature's edges are off as a whole, and next to that, and the sum of
/// weights; none where there is no weight.
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

/// How far the edges of one feature are off when it is moved, turned and scaled to be nearest to them.
fn left(seen: &[(f64, &PointToLine)]) -> Option<Vec<f64>> {
    let places = seen
        .iter()
        .map(|(off, pull)| pull.target + pull.normal * *off);
    let places: Vec<Point2<f64>> = places.collect();
    let sum = places.iter().map(|p| p.coords).reduce(|a, b| a + b)?;
    let middle = Point2::from(sum / places.len() as f64);
    let ways = seen.iter().zip(&places);
    let ways: Vec<Vector4<f64>> = ways
        .map(|((_, pull), place)| ways_off(&pull.normal, &(place - middle)))
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

/// How far a contour goes along its normal by a move, by a turn and by a scale about what is so far off.
fn ways_off(normal: &Vector2<f64>, from: &Vector2<f64>) -> Vector4<f64> {
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

    /// Edges that lie off points a unit away, as far along normals as is told.
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
    fn a_line_beside_its_edge_is_off_as_a_whole_and_a_rough_one_is_not() {
        let beside = of(pulls(|t| ([64.0 * t, 0.0], [0.0, 1.0], 2.0)));
        assert_relative_eq!(beside.wholes, 2.0, epsilon = 0.01);
        assert!(beside.edges < 0.01, "{beside:?}");
        // To either side by turns: what a line takes of it is the little that the ends do not balance.
        let rough = of(pulls(|t| {
            let side = (f64::consts::PI * 64.0 * t).cos();
            ([64.0 * t, 0.0], [0.0, 1.0], side)
        }));
        assert!(rough.wholes < 0.05, "{rough:?}");
        assert_relative_eq!(rough.edges, 1.0, epsilon = 0.01);
    }

    #[test]
    fn a_line_askew_is_off_as_a_whole() {
        // From -1 to 1: the root mean square is 1/√3.
        let askew = of(pulls(|t| ([64.0 * t, 0.0], [0.0, 1.0], 2.0 * t - 1.0)));
        assert_relative_eq!(askew.wholes, 3.0_f64.sqrt().recip(), epsilon = 0.02);
        assert!(askew.edges < 0.02, "{askew:?}");
    }

    #[test]
    fn a_circle_moved_or_of_another_radius_is_off_as_a_whole() {
        let circle = |off: fn(f64, f64) -> f64| {
            of(pulls(move |t| {
                let (y, x) = (t * f64::consts::TAU).sin_cos();
                ([20.0 * x, 20.0 * y], [x, y], off(x, y))
            }))
        };
        for found in [circle(|x, _| x), circle(|x, y| x + y), circle(|_, _| 1.0)] {
            assert!(found.edges < 0.1 * found.wholes, "{found:?}");
        }
        // An ellipse of other axes is none of these.
        let squeezed = circle(|x, y| x * x - y * y);
        assert!(squeezed.wholes < 0.1 * squeezed.edges, "{squeezed:?}");
    }
}
