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
        /// Which of its limbs, in the order of the contours.
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
    /// The boundary of a shadow that a limb, as the light sees it, casts on a face.
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
    /// Where a face turns away from a light: its limb, as the light sees it. The brightness does not
    /// jump there, but what is beyond is as dark as a shadow.
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
        /// The light that it mirrors.
        light: u32,
        /// The face.
        face: u32,
    },
}

impl ArcSource {
    /// The edge of the part, of its image or of its shadow.
    pub fn edge(&self) -> Option<EdgeId> {
        match *self {
            Self::Edge { edge } | Self::EdgeShadow { edge, .. } => Some(EdgeId(edge)),
            _ => None,
        }
    }

    /// The face that it is a limb of, or that it lies on.
    pub fn face(&self) -> Option<FaceId> {
        match *self {
            Self::Limb { face, .. } => Some(FaceId(face)),
            _ => self.ground(),
        }
    }

    /// The face whose limb casts it, of a shadow.
    pub fn caster(&self) -> Option<FaceId> {
        match *self {
            Self::LimbShadow { caster, .. } => Some(FaceId(caster)),
            _ => None,
        }
    }

    /// The light that it depends on.
    pub fn light(&self) -> Option<u32> {
        match *self {
            Self::Edge { .. } | Self::Limb { .. } => None,
            Self::EdgeShadow { light, .. }
            | Self::LimbShadow { light, .. }
            | Self::Terminator { light, .. }
            | Self::Highlight { light, .. } => Some(light),
        }
    }

    /// The face that it lies on, where it is none of its boundary.
    pub fn ground(&self) -> Option<FaceId> {
        match *self {
            Self::EdgeShadow { face, .. }
            | Self::LimbShadow { face, .. }
            | Self::Terminator { face, .. }
            | Self::Highlight { face, .. } => Some(FaceId(face)),
            _ => None,
        }
    }

    /// The word for it.
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
    /// What it is the image of.
    pub source: ArcSource,
    /// The contour of the view that it is a piece of.
    pub contour: Option<u32>,
    /// Whether neither the normal nor the light jumps across it, so that nothing is seen of it.
    pub smooth: bool,
    /// The line that it is in the image exactly, a x + b y + c = 0, or the conic: 3 or 6 coefficients;
    /// none where it is neither, or not known to be.
    pub coefficients: Vec<f64>,
    /// Its image, with the parameters of the curve in space.
    pub line: Polyline,
    /// Where other arcs end on it: indices of its polyline's points, increasing.
    pub stops: Vec<usize>,
    /// Of a shadow's boundary, which side is lit.
    pub shade: Option<Shade>,
    /// Of a highlight's outline, the region that it lies in.
    pub within: Option<u32>,
}

/// Which side of a shadow's boundary a light reaches.
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
    /// To the left as it runs.
    Left,
    /// To the right.
    Right,
}

impl ArcSide {
    /// The side of the line from `a` to `b` that `p` is on.
    pub fn new(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> Self {
        let cross = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        // With y down what is to the right turns clockwise on the page, and that is positive.
        if cross > 0.0 { Self::Right } else { Self::Left }
    }

    /// The other one.
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}
