//! The input of the assembly: edges with the faces around them, and the points between them.

use super::topology::{CoedgeId, Sense, VertexId};
use crate::geometry::curve::Curve;
use crate::geometry::surface::Surface;
use crate::hash::HashMap;
use crate::number::float::Float;
use nalgebra::Point3;

/// A face at an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaceUse {
    /// The index of the surface.
    pub surface: usize,
    /// Whether the outward normal is that of the surface.
    pub outward: Sense,
    /// Whether the face's loop runs in the edge's direction.
    pub sense: Sense,
}

impl FaceUse {
    /// The side of the surface on which the face lies.
    pub(super) fn side(&self) -> SurfaceSide {
        SurfaceSide {
            surface: self.surface,
            outward: self.outward,
        }
    }
}

/// An edge with the faces around it.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeInput<N: Float = f64> {
    /// The index of the curve.
    pub curve: usize,
    /// The range of the parameter, increasing.
    pub range: [N; 2],
    /// The indices of the points at both ends; none for a closed edge.
    pub ends: Option<[usize; 2]>,
    /// The faces, counterclockwise about the curve's direction. Consecutive pairs enclose material.
    pub face_uses: Vec<FaceUse>,
    /// Whether two faces meet smoothly.
    pub smooth: bool,
    /// The indices of the points that the edge passes through.
    pub passes: Vec<usize>,
}

/// A point where curves end or cross, or where a curve is tangent to a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexInput<N: Float = f64> {
    /// The location.
    pub place: Point3<N>,
    /// The indices of all surfaces through it.
    pub surfaces: Vec<usize>,
    /// The pairs of surfaces for which it is a singular point: a tangency, a self-crossing of their
    /// curve, or an apex.
    pub nodes: Vec<[usize; 2]>,
}

/// All edges of a boundary, and the closed surfaces that are faces without edges.
#[derive(Clone, Debug, Default)]
pub struct BoundaryInput<N: Float = f64> {
    /// The surfaces.
    pub surfaces: Vec<Surface<N>>,
    /// The curves.
    pub curves: Vec<Curve<N>>,
    /// The points.
    pub points: Vec<VertexInput<N>>,
    /// The edges.
    pub edges: Vec<EdgeInput<N>>,
    /// The surfaces that are faces as a whole.
    pub whole: Vec<SurfaceSide>,
}

/// A side of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct SurfaceSide {
    /// The index of the surface.
    pub surface: usize,
    /// Whether the outward normal is that of the surface.
    pub outward: Sense,
}

/// The ids of the entities made from the input.
pub(super) struct Names {
    /// The partner of each coedge across the material at its edge.
    pub partner: Vec<CoedgeId>,
    /// The vertex id of a point.
    pub vertex_of: HashMap<usize, VertexId>,
    /// The surface index of an input surface.
    pub surface_of: HashMap<usize, usize>,
}
