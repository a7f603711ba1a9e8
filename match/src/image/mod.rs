//! The features of an image, prepared for matching.

mod corners;
mod downsampled;
mod edges;
mod lines;

pub(crate) use corners::{LinePath, chains};
pub use downsampled::{DownsampledImage, downsampled};
pub(crate) use edges::{Edges, PIECE, Reach, bin};
pub(crate) use lines::{ImageLine, lines};

use premio_detect::{Detection, Detector, Grey, Mask, PixelMask, SegmentShape};

/// The features of an image.
#[derive(Clone, Debug)]
pub struct ImageFeatures {
    /// Its width and height in pixels.
    pub(crate) size: [usize; 2],
    /// The result of the detector.
    pub(crate) detection: Detection,
    /// Its lines, the longest first.
    pub(crate) lines: Vec<ImageLine>,
    /// Its edge pixels indexed by position and orientation.
    pub(crate) edges: Edges,
    /// The residual of edge pixels from their lines, in pixels: the median of the root mean squares
    /// of long straight segments.
    pub(crate) straightness: f64,
}

impl ImageFeatures {
    /// The features that a detector finds in an image.
    pub fn new(grey: &Grey, detector: &Detector) -> Self {
        let domain = PixelMask::full(grey.width, grey.height);
        let detection = detector.detect(grey, &domain);
        let size = [grey.width, grey.height];
        Self {
            size,
            lines: lines(&detection),
            edges: Edges::new(&detection, size),
            straightness: straightness(&detection),
            detection,
        }
    }

    /// The ends of a segment; of a whole ellipse those of its longer axis.
    ///
    /// # Panics
    /// The image has no such segment.
    pub fn ends(&self, segment: u32) -> [[f64; 2]; 2] {
        match self.detection.segments[segment as usize].shape {
            SegmentShape::Line { ends } | SegmentShape::Arc { ends, .. } => ends,
            SegmentShape::Ellipse { centre, axes, .. } => {
                [1.0, -1.0].map(|s| [0, 1].map(|i| centre[i] + s * axes[0][i]))
            }
        }
    }
}

/// See [`ImageFeatures::straightness`].
fn straightness(detection: &Detection) -> f64 {
    let straight = detection.segments.iter().filter_map(|s| match s.shape {
        SegmentShape::Line { ends: [a, b] } => {
            ((b[0] - a[0]).hypot(b[1] - a[1]) >= LONG).then_some(s.rms)
        }
        _ => None,
    });
    let mut all: Vec<f64> = straight.collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(0.5)
}

/// The least length of a long segment, in pixels.
const LONG: f64 = 40.0;

/// The detector for images when no model specifies one.
pub fn detector() -> Detector {
    Detector {
        mask: Mask::Gaussian { sigma: 1.0 },
        threshold: 4.0,
        low: Some(1.5),
        shortest: 10.0,
        ..Detector::default()
    }
}
