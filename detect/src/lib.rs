//! The processing model (Haralick & Shapiro, Computer and Robot Vision): one detector of edges,
//! lines, conics and corners, for a whole grey image and for the known pixels of a predicted one.
//!
//! The steps: [gradient masks](Mask) (ch. 7), [thinning](Thinning) (ch. 6), hysteresis (Canny
//! 1986), linking of pixels to [chains](EdgeChain) (ch. 11), splitting of chains at corners (Ramer
//! 1972), and fits of lines and ellipses to the pieces (ch. 11, Fitzgibbon 1999).
//!
//! No step uses a pixel outside the [`PixelMask`]. So an image of which little is known gives the
//! same edges as the whole one wherever [`Detector::radius`] pixels around them are known.

mod corners;
mod detection;
mod detector;
mod fit;
mod gradient;
mod grey;
mod joining;
mod linking;
mod parameters;
mod pixel_mask;
mod segments;
mod shrink;
mod splitting;
mod thinning;
mod walk;
mod workspace;

#[cfg(test)]
mod tests;

pub use detection::{
    DetectedCorner, DetectedSegment, Detection, EdgeChain, EdgePixel, SegmentShape,
};
pub use grey::Grey;
pub use parameters::{Detector, DetectorError, Mask, Thinning};
pub use pixel_mask::PixelMask;
pub use workspace::Workspace;
