//! Converts a boundary to the form of other kernels: every edge has two faces and ends in vertices,
//! and no face closes around its surface.
//!
//! `pairs` splits an edge of four or more faces into pairs of faces that enclose material between
//! them, and a vertex into its fans, so that solids that touch there remain separate. `tracks` and
//! `seams` cut a face that closes around its surface along a seam: a ruling, a meridian or a circle
//! of a torus. `loops` links the edges and the two sides of each seam to loops. `short` merges what
//! is smaller than the distance at which other kernels merge points.

mod gaps;
mod loops;
mod pairs;
mod seams;
pub(crate) mod short;
mod tracks;

use crate::parameters::ParameterWindow;
use nalgebra::Point3;
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{EdgeId, FaceId, Sense};
use premio_kernel::geometry::curve::Curve;
use std::borrow::Cow;

/// An edge between two sides of faces.
#[derive(Clone, Debug)]
pub struct SeamedEdge<'a> {
    /// The edge of the boundary that contains it; none for a seam.
    pub source: Option<EdgeId>,
    /// Its curve.
    pub curve: Cow<'a, Curve>,
    /// The range of the curve's parameter, increasing.
    pub range: [f64; 2],
    /// The vertices at the start and at the end.
    pub ends: [usize; 2],
}

/// One side of an edge, in a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct HalfEdge {
    /// The index of the edge.
    pub edge: usize,
    /// The sense in which the loop runs along it.
    pub sense: Sense,
}

/// A face that does not close around its surface.
#[derive(Clone, Debug)]
pub struct SeamedFace {
    /// The face of the boundary that contains it.
    pub(crate) source: FaceId,
    /// The surface, rotated so that angles are measured from the seam, with the window of the face.
    pub(crate) window: ParameterWindow,
    /// Whether the outward normal is the surface's own.
    pub(crate) sense: Sense,
    /// The loops, the outer one first. The face is to the left as seen from outside.
    pub loops: Vec<Vec<HalfEdge>>,
}

/// A boundary with seams.
#[derive(Clone, Debug, Default)]
pub struct TwoManifold<'a> {
    /// The vertices.
    pub points: Vec<Point3<f64>>,
    /// The edges.
    pub edges: Vec<SeamedEdge<'a>>,
    /// The faces.
    pub faces: Vec<SeamedFace>,
    /// The faces of each shell of each solid, the outer shell first.
    pub solids: Vec<Vec<Vec<usize>>>,
}

/// Why a boundary cannot be given seams.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SeamError {
    /// Material ends in a wall of zero thickness: a face has a crack along an edge, and no loop of
    /// other kernels passes twice through one place.
    #[error(
        "a wall without thickness at ({:.9}, {:.9}, {:.9}): no other kernel has such a face",
        place[0],
        place[1],
        place[2]
    )]
    Crack {
        /// A point of the edge.
        place: [f64; 3],
    },
    /// Every candidate seam runs along an edge or through a vertex.
    #[error(
        "no seam could be laid through face {} at ({:.9}, {:.9}, {:.9})",
        face.0, place[0], place[1], place[2]
    )]
    Blocked {
        /// The face.
        face: FaceId,
        /// A point of its boundary.
        place: [f64; 3],
    },
    /// The pieces of a face do not determine which loop encloses which.
    #[error("the loops of face {} do not determine which encloses which", face.0)]
    Loops {
        /// The face.
        face: FaceId,
    },
}

impl<'a> TwoManifold<'a> {
    /// The boundary with seams; `resolution` is the part's.
    ///
    /// # Errors
    /// A wall has no thickness, no seam could be laid through a face, or the loops of a face do not
    /// determine which encloses which.
    pub fn new(brep: &'a Brep, resolution: f64) -> Result<Self, SeamError> {
        let pairs = pairs::Pairs::new(brep);
        if let Some(edge) = pairs.crack(brep) {
            let [lo, hi] = brep.range(edge);
            let place = brep.curve(edge).point(0.5 * (lo + hi)).into();
            return Err(SeamError::Crack { place });
        }
        let cuts: Result<Vec<seams::Cut>, SeamError> = brep
            .topology
            .face_ids()
            .map(|face| seams::Cut::new(brep, face, &pairs.rings[face.index()], resolution))
            .collect();
        loops::seamed(brep, &pairs, &cuts?)
    }
}
