//! The boundary representation: topology as ids in one arena, geometry hung on the ids.
//!
//! Faces are maximal and there are no seams: a sphere is one face without a loop, a cylinder has
//! three faces, two closed edges and no vertex. Where the boundary is no manifold it is represented
//! as it is: an edge may bound more than two face corners, and a point at which the boundary touches
//! itself, in a vertex, along an edge or within a face, is a touch.

mod arcs;
pub mod assemble;
pub mod bounding_box;
pub mod check;
pub mod cycle_basis;
pub mod face_integrals;
pub mod locate;
mod non_manifold_points;
pub mod point_in_solid;
mod region;
mod shells;
pub mod signature;
pub mod surface_path;
pub mod topology;

use crate::geometry::curve::Curve;
use crate::geometry::surface::Surface;
use crate::number::float::Float;
use nalgebra::{Point3, Vector3};
use topology::{EdgeId, FaceId, Sense, Topology, VertexId};

/// The geometry that hangs on the entities: indexed by their ids.
#[derive(Clone, Debug, Default)]
pub struct BrepGeometry<N: Float = f64> {
    /// The distinct carriers that have a face.
    pub surfaces: Vec<Surface<N>>,
    /// The distinct curves that have an edge.
    pub curves: Vec<Curve<N>>,
    /// The place of each vertex, by [`VertexId`].
    pub points: Vec<Point3<N>>,
    /// Each edge's curve (an index into `curves`) and range of its parameter, by [`EdgeId`]; a
    /// closed edge runs over one period, and a range may pass the end of a period.
    pub arcs: Vec<EdgeGeometry<N>>,
    /// Each face's surface (an index into `surfaces`) and whether the face's outward normal is the
    /// surface's own, by [`FaceId`].
    pub patches: Vec<FaceGeometry>,
    /// The place of each touch, by [`TouchId`](topology::TouchId).
    pub touches: Vec<Point3<N>>,
}

/// The geometry of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeGeometry<N: Float = f64> {
    /// The index of the curve.
    pub curve: usize,
    /// The parameter from the edge's first end to its last, increasing.
    pub range: [N; 2],
}

/// The geometry of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaceGeometry {
    /// The index of the surface.
    pub surface: usize,
    /// `Along` where the outward normal of the solid is the surface's normal.
    pub sense: Sense,
}

/// A boundary representation.
#[derive(Clone, Debug, Default)]
pub struct Brep<N: Float = f64> {
    /// Who meets whom.
    pub topology: Topology,
    /// Where.
    pub geometry: BrepGeometry<N>,
}

impl<N: Float> Brep<N> {
    /// The curve of an edge.
    pub fn curve(&self, edge: EdgeId) -> &Curve<N> {
        &self.geometry.curves[self.geometry.arcs[edge.0 as usize].curve]
    }

    /// The range of an edge on its curve.
    pub fn range(&self, edge: EdgeId) -> [N; 2] {
        self.geometry.arcs[edge.0 as usize].range
    }

    /// The surface of a face.
    pub fn surface(&self, face: FaceId) -> &Surface<N> {
        &self.geometry.surfaces[self.geometry.patches[face.0 as usize].surface]
    }

    /// The sense of a face's surface.
    pub fn sense(&self, face: FaceId) -> Sense {
        self.geometry.patches[face.0 as usize].sense
    }

    /// The place of a vertex.
    pub fn point(&self, vertex: VertexId) -> Point3<N> {
        self.geometry.points[vertex.0 as usize]
    }

    /// The normal of a face at a point of it, pointing out of the material.
    pub fn outward(&self, face: FaceId, p: &Point3<N>) -> Vector3<N> {
        let n = self.surface(face).normal(p);
        match self.sense(face) {
            Sense::Along => n,
            Sense::Against => -n,
        }
    }

    /// The same in f64: what lies closer together than these tell has one place.
    pub fn to_f64(&self) -> Brep {
        let g = &self.geometry;
        let arc = |a: &EdgeGeometry<N>| EdgeGeometry {
            curve: a.curve,
            range: a.range.map(N::rounded),
        };
        Brep {
            topology: self.topology.clone(),
            geometry: BrepGeometry {
                surfaces: g.surfaces.iter().map(Surface::to_f64).collect(),
                curves: g.curves.iter().map(Curve::to_f64).collect(),
                points: g.points.iter().map(|p| p.map(N::rounded)).collect(),
                arcs: g.arcs.iter().map(arc).collect(),
                patches: g.patches.clone(),
                touches: g.touches.iter().map(|p| p.map(N::rounded)).collect(),
            },
        }
    }
}
