//! The result of a detector. Positions are in pixels, at sub-pixel accuracy, in image axes: pixel
//! (x, y) has its centre at (x, y), y downwards.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The detection in an image.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Detection {
    /// The edge pixels after thinning, row by row; also those of chains that are too short.
    pub pixels: Vec<EdgePixel>,
    /// The pixels linked in order.
    pub chains: Vec<EdgeChain>,
    /// The chains cut into lines and conics; the segments of a chain are consecutive.
    pub segments: Vec<DetectedSegment>,
    /// The corners of segments.
    pub corners: Vec<DetectedCorner>,
}

/// A pixel that an edge passes through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePixel {
    /// Its column.
    pub x: u32,
    /// Its row.
    pub y: u32,
    /// The sub-pixel position of the edge in it: the maximum of the parabola through the gradient
    /// magnitudes across the edge, along the image axis nearer to the gradient (Devernay 1995).
    pub at: [f64; 2],
    /// The gradient, in levels per pixel: it points to the bright side.
    pub gradient: [f64; 2],
}

/// Edge pixels in order along an edge, so that in the image, y downwards, the bright side is on the
/// right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EdgeChain {
    /// Indices into the pixels of the detection. A pixel where edges branch may be the end of
    /// several chains.
    pub pixels: Vec<u32>,
    /// Whether the first pixel follows the last.
    pub closed: bool,
}

/// A piece of a chain that is one line or one conic.
#[derive(Clone, Debug, PartialEq)]
pub struct DetectedSegment {
    /// The index of its chain.
    pub chain: u32,
    /// The half-open range of the chain's pixels that it covers. A closed chain starts where a
    /// segment does.
    pub range: [u32; 2],
    /// The fitted curve.
    pub shape: SegmentShape,
    /// The root mean square distance, in pixels, of the fitted points from the curve. Points near
    /// the ends of a long segment, where the mask covers what is beyond, are not fitted.
    pub rms: f64,
}

/// A fitted curve; its ends are in the order of the chain.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum SegmentShape {
    /// A straight line.
    Line {
        /// The first and the last pixel, projected onto the line; at a corner, the point nearest to
        /// it; at another split the pixel beyond it, if that is farther out.
        ends: [[f64; 2]; 2],
    },
    /// A part of an ellipse.
    Arc {
        /// a, b, c, d, e, f of a x² + b x y + c y² + d x + e y + f = 0, the largest being 1.
        conic: [f64; 6],
        /// The first and the last pixel, projected onto the ellipse.
        ends: [[f64; 2]; 2],
        /// The middle pixel, projected onto the ellipse: it determines which of the two arcs is
        /// meant.
        middle: [f64; 2],
    },
    /// A whole ellipse.
    Ellipse {
        /// a, b, c, d, e, f of a x² + b x y + c y² + d x + e y + f = 0, the largest being 1.
        conic: [f64; 6],
        /// The centre.
        centre: [f64; 2],
        /// The half axes as vectors from the centre, the longer one first.
        axes: [[f64; 2]; 2],
    },
}

/// A point where segments end at an angle to each other: consecutive ones of a chain, or those at
/// chain ends near each other.
#[derive(Clone, Debug, PartialEq)]
pub struct DetectedCorner {
    /// The point nearest to all their lines, or tangents.
    pub at: [f64; 2],
    /// The indices of the segments, increasing; one alone where a closed arc has a corner with
    /// itself.
    pub segments: Vec<u32>,
}
