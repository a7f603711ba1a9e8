//! The arcs of an image: curves across which its brightness may jump.

use super::flatten::Polyline;
use premio_kernel::brep::topology::{EdgeId, FaceId};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What an arc is the image of.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, JsonSchema, Serialize, Deserialize,
)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum ArcSource {
    /// An edge of the part.
    Edge {
        /// Which.
        edge: u32,
    },
    /// A limb of a face.
    Limb {
        /// The face.
        face: u32,
        /// The index of the limb of the face, in the order of the contours.
        ordinal: u32,
    },
    /// The boundary of a shadow that an edge casts on a face.
    EdgeShadow {
        /// The light.
        light: u32,
        /// The edge that casts it.
        edge: u32,
        /// The face it falls on.
        face: u32,
    },
    /// The boundary of a shadow that a limb of the light's view casts on a face.
    LimbShadow {
        /// The light.
        light: u32,
        /// The face whose limb casts it.
        caster: u32,
        /// Which of its limbs.
        ordinal: u32,
        /// The face it falls on.
        face: u32,
    },
    /// Where a face turns away from a light: its limb in the light's view. The brightness is
    /// continuous there, but beyond it the face is as dark as in a shadow.
    Terminator {
        /// The light.
        light: u32,
        /// The face.
        face: u32,
        /// Which of its limbs.
        ordinal: u32,
    },
    /// The outline of a highlight on a face.
    Highlight {
        /// The light that it reflects.
        light: u32,
        /// The face.
        face: u32,
    },
}

impl ArcSource {
    /// The edge of the part that the arc or its shadow is of.
    pub(crate) fn edge(&self) -> Option<EdgeId> {
        match *self {
            Self::Edge { edge } | Self::EdgeShadow { edge, .. } => Some(EdgeId(edge)),
            _ => None,
        }
    }

    /// The face whose limb it is, or on which it lies.
    pub(crate) fn face(&self) -> Option<FaceId> {
        match *self {
            Self::Limb { face, .. } => Some(FaceId(face)),
            _ => self.ground(),
        }
    }

    /// For a shadow: the face whose limb casts it.
    pub(crate) fn caster(&self) -> Option<FaceId> {
        match *self {
            Self::LimbShadow { caster, .. } => Some(FaceId(caster)),
            _ => None,
        }
    }

    /// The light that it depends on.
    pub(crate) fn light(&self) -> Option<u32> {
        match *self {
            Self::Edge { .. } | Self::Limb { .. } => None,
            Self::EdgeShadow { light, .. }
            | Self::LimbShadow { light, .. }
            | Self::Terminator { light, .. }
            | Self::Highlight { light, .. } => Some(light),
        }
    }

    /// The face in whose inside it lies.
    pub(crate) fn ground(&self) -> Option<FaceId> {
        match *self {
            Self::EdgeShadow { face, .. }
            | Self::LimbShadow { face, .. }
            | Self::Terminator { face, .. }
            | Self::Highlight { face, .. } => Some(FaceId(face)),
            _ => None,
        }
    }

    /// Its word in reports.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Edge { .. } => "edge",
            Self::Limb { .. } => "limb",
            Self::EdgeShadow { .. } | Self::LimbShadow { .. } => "shadow",
            Self::Terminator { .. } => "terminator",
            Self::Highlight { .. } => "highlight",
        }
    }
}

/// An arc: a visible piece of a contour or of a shadow's boundary, or a highlight's outline.
#[derive(Clone, Debug)]
pub struct PredictedArc {
    /// Its source.
    pub source: ArcSource,
    /// The contour of the view from which it is cut.
    pub contour: Option<u32>,
    /// Whether normal and light are continuous across it, so that it is invisible.
    pub smooth: bool,
    /// The coefficients of its exact image: 3 of a line a x + b y + c = 0, or 6 of a conic; empty
    /// where it is neither, or not known to be.
    pub coefficients: Vec<f64>,
    /// Its image, with the parameters of the curve in space.
    pub line: Polyline,
    /// Where other arcs end on it: indices of its polyline's points, increasing.
    pub stops: Vec<usize>,
    /// For a shadow's boundary: the lit side.
    pub shade: Option<Shade>,
    /// For a highlight's outline: the region that contains it.
    pub within: Option<u32>,
}

/// The side of a shadow's boundary that a light reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shade {
    /// The light.
    pub light: usize,
    /// The side that it reaches.
    pub lit: ArcSide,
}

/// A side of a curve in an image whose y points down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArcSide {
    /// To the left along its direction.
    Left,
    /// To the right.
    Right,
}

impl ArcSide {
    /// The side of the line from `a` to `b` that `p` is on.
    pub(crate) fn new(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> Self {
        let cross = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        // With y down a point on the right turns clockwise on the page, which is positive.
        if cross > 0.0 { Self::Right } else { Self::Left }
    }

    /// The other one.
    pub(crate) fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}
