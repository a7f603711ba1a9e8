//! The exact boundary of a solid whose primitives have plane faces.
//!
//! The boundary is evaluated with rounded numbers, which determine which planes meet in each corner.
//! Then each corner is the common point of three of these planes, in exact arithmetic.

use std::collections::BTreeSet;

use nalgebra::{Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{LoopId, Sense, VertexId};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::rational::{Rational, to_f64};

use super::ConstructionError;
use super::plane_faces::{own_corners, polyhedron};
use crate::evaluate::{EvaluationOptions, evaluate};
use crate::polyhedron::{Polyhedron, PolyhedronFace, SpacePoint, cross, dot};
use crate::tree::Tree;

/// Plane faces around a solid, with exact corners.
pub(super) struct PlaneFacedBoundary {
    /// The corners.
    pub points: Vec<SpacePoint>,
    /// The faces, counterclockwise as seen from the outside.
    pub faces: Vec<PolyhedronFace>,
}

impl PlaneFacedBoundary {
    /// The boundary of the solid of a tree; `None` if a primitive has other than plane faces, or the
    /// planes through a corner do not determine it.
    ///
    /// # Errors
    /// The boundary cannot be evaluated.
    pub fn of_tree(tree: &Tree) -> Result<Option<Self>, ConstructionError> {
        let mut placed = tree.leaves().map(|(_, placed)| placed);
        if !placed.all(|placed| own_corners(&placed.primitive).is_some()) {
            return Ok(None);
        }
        let known = evaluate(tree, &EvaluationOptions::default())
            .map_err(|error| ConstructionError::Boundary(error.to_string().into()))?;
        let planes = planes(tree)?;
        let corners = CornerPlanes {
            brep: &known.brep,
            planes: &planes,
            resolution: known.resolution,
        };
        let Some(points) = corners.points() else {
            return Ok(None);
        };
        let faces = known.brep.topology.face_ids().map(|face| {
            let loops = known.brep.topology.face(face).loops.iter();
            let loops = loops.map(|&ring| corners.vertices(ring));
            loops
                .collect::<Option<Vec<_>>>()
                .map(|loops| PolyhedronFace { loops })
        });
        let faces = faces.collect::<Option<Vec<_>>>();
        Ok(faces.map(|faces| Self { points, faces }))
    }

    /// The polyhedron.
    ///
    /// # Errors
    /// More than two faces meet in an edge, or there are no faces.
    pub fn polyhedron(&self) -> Result<Polyhedron, ConstructionError> {
        Ok(Polyhedron::from_faces(&self.points, &self.faces)?.polyhedron)
    }
}

/// A plane of the points p with n · p = d.
struct ExactPlane {
    normal: SpacePoint,
    offset: Rational,
    /// The unit normal and the distance from the origin, rounded.
    near: (Vector3<f64>, f64),
}

impl ExactPlane {
    fn new(normal: SpacePoint, point: &SpacePoint) -> Self {
        let offset = dot(&normal, point);
        let rounded = Vector3::from(normal.each_ref().map(to_f64));
        let length = rounded.norm();
        let near = (rounded / length, to_f64(&offset) / length);
        Self {
            normal,
            offset,
            near,
        }
    }

    /// The distance of a point, rounded.
    fn distance(&self, point: &Point3<f64>) -> f64 {
        (self.near.0.dot(&point.coords) - self.near.1).abs()
    }
}

/// The planes of all faces of the primitives.
fn planes(tree: &Tree) -> Result<Vec<ExactPlane>, ConstructionError> {
    let mut planes = Vec::new();
    for (_, placed) in tree.leaves() {
        let own = polyhedron(&placed.primitive)?;
        let motion = &placed.motion;
        let solid = own.mapped(&motion.rotation_matrix(), motion.offset())?;
        for face in 0..solid.faces().len() {
            let point = solid.corners(face).next();
            planes.extend(point.map(|point| ExactPlane::new(solid.normal(face), point)));
        }
    }
    Ok(planes)
}

/// The exact corners of an evaluated boundary.
struct CornerPlanes<'a> {
    brep: &'a Brep,
    planes: &'a [ExactPlane],
    resolution: f64,
}

impl CornerPlanes<'_> {
    /// The exact place of each vertex; `None` if one is not determined.
    fn points(&self) -> Option<Vec<SpacePoint>> {
        let geometry = &self.brep.geometry;
        let on: Option<Vec<usize>> = geometry.surfaces.iter().map(|s| self.plane_of(s)).collect();
        let on = on?;
        let mut around: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); geometry.points.len()];
        for face in self.brep.topology.face_ids() {
            let plane = on[geometry.patches[face.index()].surface];
            for &ring in &self.brep.topology.face(face).loops {
                for vertex in self.vertices(ring)? {
                    around[vertex].insert(plane);
                }
            }
        }
        let places = geometry.points.iter().zip(&around);
        places
            .map(|(near, planes)| self.corner(near, planes))
            .collect()
    }

    /// The plane of a primitive in which a surface lies.
    fn plane_of(&self, surface: &Surface) -> Option<usize> {
        let Surface::Plane(plane) = surface else {
            return None;
        };
        let (origin, normal) = (plane.frame.origin, plane.frame.z);
        // Parallel planes within the resolution of each other are one.
        let is_same = |known: &ExactPlane| {
            known.distance(&origin) <= 2.0 * self.resolution
                && known.near.0.cross(&normal).norm() <= SAME
        };
        self.planes.iter().position(is_same)
    }

    /// The indices of the vertices of a loop; `None` if it has none.
    fn vertices(&self, ring: LoopId) -> Option<Vec<usize>> {
        let topology = &self.brep.topology;
        let coedges = topology.ring(ring).coedges.iter();
        let start = |&id| -> Option<VertexId> {
            let coedge = topology.coedge(id);
            let [from, to] = topology.edge(coedge.edge).ends?;
            Some(match coedge.sense {
                Sense::Along => from,
                Sense::Against => to,
            })
        };
        coedges.map(|id| start(id).map(VertexId::index)).collect()
    }

    /// The common point of the three planes at the largest angles among those around a vertex.
    fn corner(&self, near: &Point3<f64>, planes: &BTreeSet<usize>) -> Option<SpacePoint> {
        let around: Vec<&ExactPlane> = planes
            .iter()
            .take(MAX_PLANES)
            .map(|&k| &self.planes[k])
            .collect();
        let mut best: Option<(f64, [&ExactPlane; 3])> = None;
        for (i, &p) in around.iter().enumerate() {
            for (j, &q) in around.iter().enumerate().skip(i + 1) {
                for &r in &around[j + 1..] {
                    let volume = p.near.0.cross(&q.near.0).dot(&r.near.0).abs();
                    if best.is_none_or(|(known, _)| volume > known) {
                        best = Some((volume, [p, q, r]));
                    }
                }
            }
        }
        let (_, planes) = best?;
        let point = common_point(planes)?;
        let rounded = Point3::from(point.each_ref().map(to_f64));
        ((rounded - near).norm() <= FAR * self.resolution).then_some(point)
    }
}

/// The common point of three planes, by Cramer's rule; `None` if there is none, or more than one.
fn common_point([p, q, r]: [&ExactPlane; 3]) -> Option<SpacePoint> {
    let [u, v, w] = [
        cross(&q.normal, &r.normal),
        cross(&r.normal, &p.normal),
        cross(&p.normal, &q.normal),
    ];
    let determinant = dot(&p.normal, &u);
    (!determinant.is_zero()).then(|| {
        std::array::from_fn(|i| {
            (&p.offset * &u[i] + &q.offset * &v[i] + &r.offset * &w[i]) / &determinant
        })
    })
}

/// The largest number of planes around a vertex of which three are chosen.
const MAX_PLANES: usize = 32;

/// The largest distance of an exact corner from the rounded one, in resolutions.
const FAR: f64 = 1024.0;

/// The sine of the angle below which planes through one point are one.
const SAME: f64 = 1.0 / (1u64 << 36) as f64;
