//! The probability that a segment of clutter runs along a predicted contour.
//!
//! Most segments around the part belong to prints on things or to other objects. The expected
//! number of those of a given length that fall on a contour, within a few pixels and a small angle,
//! is their density in the image times the share of the area and of all angles that this takes.

use crate::correspondence::predicted_contours::PredictedContour;
use crate::image::ImageFeatures;
use nalgebra::Point2;
use std::f64::consts::PI;

/// The margin around the part in which clutter is counted: relative to its size in the image, and
/// in pixels.
const ABOUT: f64 = 0.25;
const MARGIN: f64 = 16.0;
/// The range of positions along a contour: relative to the contour's length, and in pixels.
const ALONG: f64 = 0.3;
const END: f64 = 10.0;
/// The greatest probability of a chance match.
const MOST: f64 = 0.9;

/// The segments around a part in the image.
#[derive(Clone, Debug, PartialEq)]
pub struct Clutter {
    /// Their lengths in pixels, in falling order.
    lengths: Vec<f64>,
    /// The area that contains them, in square pixels.
    area: f64,
}

impl Clutter {
    /// The segments around predicted arcs.
    pub fn about(picture: &ImageFeatures, arcs: &[PredictedContour]) -> Self {
        let size = picture.size.map(|n| n as f64);
        let (mut low, mut high): ([f64; 2], [f64; 2]) = (size, [0.0; 2]);
        for seen in arcs.iter().flat_map(|a| &a.points).map(|p| &p.image) {
            if picture.edges.reaches(&seen.at) {
                for i in 0..2 {
                    low[i] = low[i].min(seen.at[i]);
                    high[i] = high[i].max(seen.at[i]);
                }
            }
        }
        for i in 0..2 {
            let margin = ABOUT * (high[i] - low[i]).max(0.0) + MARGIN;
            low[i] = (low[i] - margin).max(0.0);
            high[i] = (high[i] + margin).min(size[i]);
        }
        let within = |p: &Point2<f64>| (0..2).all(|i| p[i] >= low[i] && p[i] <= high[i]);
        let mut lengths: Vec<f64> = (0..picture.detection.segments.len() as u32)
            .filter_map(|s| {
                let [a, b] = picture.ends(s).map(Point2::from);
                within(&nalgebra::center(&a, &b)).then(|| (b - a).norm())
            })
            .collect();
        lengths.sort_by(|a, b| b.total_cmp(a));
        Self {
            lengths,
            area: ((high[0] - low[0]) * (high[1] - low[1])).max(1.0),
        }
    }

    /// The probability that a segment of at least a length falls by chance on a contour of a
    /// length, within a distance to either side, in pixels, and an angle to either side, in
    /// radians.
    pub fn chance(&self, length: f64, contour: f64, distance: f64, angle: f64) -> f64 {
        let many = self.lengths.partition_point(|l| *l >= length) as f64 + 0.5;
        let place = 2.0 * distance * (ALONG * contour + END);
        (many / self.area * place * (2.0 * angle / PI)).min(MOST)
    }
}
