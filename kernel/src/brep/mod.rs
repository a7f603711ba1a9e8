//! The boundary representation: topology as ids in one arena, with geometry attached to the ids.
//!
//! Faces are maximal and there are no seams: a sphere is one face without a loop; a cylinder has
//! three faces, two closed edges and no vertex. A non-manifold boundary is represented as it is. An
//! edge may bound more than two face corners. A point at which the boundary touches itself, in a
//! vertex, along an edge or within a face, is a touch.

mod arcs;
pub mod assemble;
pub mod assembly_error;
pub mod boundary_input;
pub mod bounding_box;
pub mod check;
mod cycle_space;
pub mod disjoint_union;
mod end_gaps;
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

/// The geometry of the entities, indexed by their ids.
#[derive(Clone, Debug, Default)]
pub struct BrepGeometry<N: Float = f64> {
    /// The surfaces that have a face, distinct within each of the bodies that were joined.
    pub surfaces: Vec<Surface<N>>,
    /// The curves that have an edge, distinct in the same way.
    pub curves: Vec<Curve<N>>,
    /// The location of each vertex, by [`VertexId`].
    pub points: Vec<Point3<N>>,
    /// Each edge's curve (an index into `curves`) and parameter range, by [`EdgeId`]. A closed edge
    /// covers one period, and a range may extend beyond the end of a period.
    pub arcs: Vec<EdgeGeometry<N>>,
    /// Each face's surface (an index into `surfaces`), and whether the face's outward normal is
    /// that of the surface, by [`FaceId`].
    pub patches: Vec<FaceGeometry>,
    /// The location of each touch, by [`TouchId`](topology::TouchId).
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
    /// `Along` if the outward normal of the solid is the surface's normal.
    pub sense: Sense,
}

/// A boundary representation.
#[derive(Clone, Debug, Default)]
pub struct Brep<N: Float = f64> {
    /// The incidences of the entities.
    pub topology: Topology,
    /// The geometry of the entities.
    pub geometry: BrepGeometry<N>,
}

impl<N: Float> Brep<N> {
    /// The curve of an edge.
    ///
    /// # Panics
    /// The boundary has no such edge.
    pub fn curve(&self, edge: EdgeId) -> &Curve<N> {
        &self.geometry.curves[self.geometry.arcs[edge.0 as usize].curve]
    }

    /// The range of an edge on its curve.
    ///
    /// # Panics
    /// The boundary has no such edge.
    pub fn range(&self, edge: EdgeId) -> [N; 2] {
        self.geometry.arcs[edge.0 as usize].range
    }

    /// The surface of a face.
    ///
    /// # Panics
    /// The boundary has no such face.
    pub fn surface(&self, face: FaceId) -> &Surface<N> {
        &self.geometry.surfaces[self.geometry.patches[face.0 as usize].surface]
    }

    /// The index of a face's surface. Faces of one surface have the same.
    ///
    /// # Panics
    /// The boundary has no such face.
    pub fn carrier(&self, face: FaceId) -> usize {
        self.geometry.patches[face.0 as usize].surface
    }

    /// The sense of a face's surface.
    ///
    /// # Panics
    /// The boundary has no such face.
    pub fn sense(&self, face: FaceId) -> Sense {
        self.geometry.patches[face.0 as usize].sense
    }

    /// The location of a vertex.
    ///
    /// # Panics
    /// The boundary has no such vertex.
    pub fn point(&self, vertex: VertexId) -> Point3<N> {
        self.geometry.points[vertex.0 as usize]
    }

    /// The normal of a face at a point of it, pointing out of the material.
    ///
    /// # Panics
    /// The boundary has no such face.
    pub fn outward(&self, face: FaceId, p: &Point3<N>) -> Vector3<N> {
        let n = self.surface(face).normal(p);
        match self.sense(face) {
            Sense::Along => n,
            Sense::Against => -n,
        }
    }

    /// The boundary rounded to f64. Points closer than f64 can distinguish become equal.
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
