//! What a detector finds. Positions are in pixels, at sub-pixel accuracy, in image axes: pixel
//! (x, y) has its centre at (x, y), y downwards.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is found in an image.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Detection {
    /// The edge pixels after thinning, row by row; also those of chains that are too short.
    pub pixels: Vec<EdgePixel>,
    /// The pixels linked in order.
    pub chains: Vec<EdgeChain>,
    /// The chains cut into lines and conics; those of a chain follow one another.
    pub segments: Vec<DetectedSegment>,
    /// Where segments meet at an angle.
    pub corners: Vec<DetectedCorner>,
}

/// A pixel that an edge passes through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePixel {
    /// Its column.
    pub x: u32,
    /// Its row.
    pub y: u32,
    /// The edge within it: the top of the parabola through the gradient magnitudes across the
    /// edge, along that image axis to which the gradient is nearer (Devernay 1995).
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
    /// Which pixels of the chain it takes, half open. A closed chain starts where a segment does.
    pub range: [u32; 2],
    /// The fitted curve.
    pub shape: SegmentShape,
    /// The root mean square distance, in pixels, of the fitted points from the curve. Next to the
    /// ends of a long segment, where the mask sees what is beyond, points are not fitted.
    pub rms: f64,
}

/// A fitted curve; its ends are in the order of the chain.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum SegmentShape {
    /// A straight line.
    Line {
        /// The first and the last pixel, brought onto the line; at a corner, the point next to it;
        /// at another split the pixel beyond it, if that is farther out.
        ends: [[f64; 2]; 2],
    },
    /// A part of an ellipse.
    Arc {
        /// a, b, c, d, e, f of a x² + b x y + c y² + d x + e y + f = 0, the largest being 1.
        conic: [f64; 6],
        /// The first and the last pixel, brought onto the ellipse.
        ends: [[f64; 2]; 2],
        /// The pixel in the middle, brought onto the ellipse: it tells on which side the arc runs.
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

/// Where segments meet at an angle: consecutive ones of a chain, or those at chain ends close
/// together.
#[derive(Clone, Debug, PartialEq)]
pub struct DetectedCorner {
    /// The point nearest to all their lines, or tangents.
    pub at: [f64; 2],
    /// The indices of the segments, increasing; one alone where a closed arc meets itself.
    pub segments: Vec<u32>,
}
