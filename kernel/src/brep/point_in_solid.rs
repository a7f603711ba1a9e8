//! Point-in-solid classification by the parity of a line's crossings.

use super::Brep;
use super::bounding_box::face_bounds;
use super::locate::{FaceLocator, PointLocation};
use super::topology::FaceId;
use crate::geometry::bounds::Aabb;
use crate::geometry::curve::{Curve, Line};
use crate::geometry::curve_surface::cut;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use crate::number::roots::{RootKind, Roots};
use nalgebra::{Point3, Vector3};

/// The number of lines tried before the question is left open.
const LINES: u32 = 64;

/// Whether the solids contain a point that is not on the boundary. `None` if every ray from it
/// passes within `resolution` of an edge of some face it crosses. The resolution must be at least
/// the rounding error of the faces.
pub fn contains<N: Float>(brep: &Brep<N>, p: &Point3<N>, resolution: N) -> Option<bool> {
    let faces: Vec<FaceId> = brep.topology.face_ids().collect();
    Closed::new(brep, &faces, resolution).contains(p)
}

/// A face with its box.
struct BoxedFace {
    face: FaceId,
    bounds: Aabb,
}

/// The faces of closed shells, with their boxes.
pub(super) struct Closed<'a, N: Float> {
    brep: &'a Brep<N>,
    faces: Vec<BoxedFace>,
    /// The box of all faces.
    pub bounds: Aabb,
    resolution: N,
}

impl<'a, N: Float> Closed<'a, N> {
    /// The faces; points within `resolution` of an edge count as on it.
    pub fn new(brep: &'a Brep<N>, faces: &[FaceId], resolution: N) -> Self {
        let boxed = |&face: &FaceId| BoxedFace {
            face,
            bounds: face_bounds(brep, face).grown(resolution),
        };
        let faces: Vec<BoxedFace> = faces.iter().map(boxed).collect();
        let bounds = faces.iter().fold(Aabb::EMPTY, |all, f| all.hull(&f.bounds));
        Self {
            brep,
            faces,
            bounds,
            resolution,
        }
    }

    /// Whether they contain a point. Rays are tried until one crosses faces only away from their
    /// edges.
    fn contains(&self, p: &Point3<N>) -> Option<bool> {
        let crossings = (0..LINES).find_map(|k| {
            let ray = Line {
                origin: *p,
                direction: towards(k),
            };
            let [_, far] = self.reach(&ray);
            self.crossings(&ray, [N::ZERO, far])
        });
        crossings.map(|all| all.len() % 2 == 1)
    }

    /// Whether they enclose others that do not cross them, though they may touch. The points where
    /// a line crosses the two sets, and the order of these points, decide.
    pub fn enclosing(&self, others: &Self) -> Option<bool> {
        (0..LINES).find_map(|k| {
            let line = others.line_across(k);
            let range = others.reach(&line);
            let at = *others.crossings(&line, range)?.first()?;
            let [_, far] = self.reach(&line);
            // Where the two touch, the order is ambiguous.
            let beyond = self.crossings(&line, [at - self.resolution, far])?;
            let apart = beyond.iter().all(|t| t.is_beyond(at + self.resolution));
            apart.then_some(beyond.len() % 2 == 1)
        })
    }

    /// The k-th line through the box, which need not meet the faces. Each passes the middle at
    /// another distance.
    fn line_across(&self, k: u32) -> Line<N> {
        let b = self.faces[k as usize % self.faces.len()].bounds;
        let part = |i: u32| {
            N::from_f64(0.5) + N::from_f64(0.21) * (N::whole(k + 1) * N::whole(i + 2)).sin()
        };
        let at = |i: usize| {
            let (lo, hi) = (N::from_f64(b.min[i]), N::from_f64(b.max[i]));
            lo + (hi - lo) * part(i as u32)
        };
        Line {
            origin: Point3::new(at(0), at(1), at(2)),
            direction: towards(k),
        }
    }

    /// The range of a line outside which there are no crossings.
    fn reach(&self, line: &Line<N>) -> [N; 2] {
        let away = (self.bounds.centre().map(N::from_f64) - line.origin).length();
        let length = N::TWO * (away + N::from_f64(self.bounds.diagonal()));
        [-length, length]
    }

    /// The crossings of a line with the faces, in order; `None` if one is ambiguous.
    fn crossings(&self, line: &Line<N>, range: [N; 2]) -> Option<Vec<N>> {
        let mut crossed = Vec::new();
        let curve = Curve::Line(*line);
        for BoxedFace {
            face,
            bounds: around,
        } in &self.faces
        {
            if around.along(line, range).is_none() {
                continue;
            }
            let Roots::At { roots, .. } =
                cut(&curve, range, self.brep.surface(*face), self.resolution)
            else {
                return None;
            };
            if roots.is_empty() {
                continue;
            }
            let locator = FaceLocator::from_face(self.brep, *face, self.resolution);
            for root in roots {
                match locator.place(&curve.point(root.t)) {
                    PointLocation::Outside => {}
                    PointLocation::Inside if root.contact == RootKind::Simple => {
                        crossed.push(root.t)
                    }
                    _ => return None,
                }
            }
        }
        crossed.sort_by(N::total_cmp);
        Some(crossed)
    }
}

/// The direction of the k-th line. None is parallel to an axis or a common diagonal.
fn towards<N: Float>(k: u32) -> Vector3<N> {
    let a = N::from_f64(0.61) + N::from_f64(2.4) * N::whole(k);
    let rise = N::from_f64(0.37) - N::from_f64(0.21) * N::whole(k % 5);
    Vector3::new(a.cos(), a.sin(), rise).unit()
}
