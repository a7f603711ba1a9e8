//! How likely it is by chance that a segment runs where a contour is expected.
//!
//! About the part there are segments of many lengths, most of them of what is printed on things or lies
//! about. One that is as long as so much of the contour falls on it, to within a few pixels and a small
//! angle, as often as there are such segments in the area, times the part of the area and of all angles
//! that this takes.

use crate::correspondence::predicted_contours::PredictedContour;
use crate::image::ImageFeatures;
use nalgebra::Point2;
use std::f64::consts::PI;

/// How far about the part, in its size in the picture and in pixels, clutter is counted.
const ABOUT: f64 = 0.25;
const MARGIN: f64 = 16.0;
/// How far along a contour a segment may lie otherwise, in the contour's length, and in pixels.
const ALONG: f64 = 0.3;
const END: f64 = 10.0;
/// Nothing is more likely by chance.
const MOST: f64 = 0.9;

/// The segments about a part.
#[derive(Clone, Debug, PartialEq)]
pub struct Clutter {
    /// Their lengths in pixels, falling.
    lengths: Vec<f64>,
    /// The area in pixels that they lie in.
    area: f64,
}

impl Clutter {
    /// The segments about predicted arcs.
    pub fn about(picture: &ImageFeatures, arcs: &[PredictedContour]) -> Self {
        let size = picture.size.map(|n| n as f64);
        let (mut low, mut high): ([f64; 2], [f64; 2]) = (size, [0.0; 2]);
        for (_, seen) in arcs.iter().flat_map(|a| &a.points) {
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

    /// How likely a segment at least so long falls on a contour of a length, within a distance to
    /// either side and an angle to either side, in pixels and radians.
    pub fn chance(&self, length: f64, contour: f64, beside: f64, askew: f64) -> f64 {
        let many = self.lengths.partition_point(|l| *l >= length) as f64 + 0.5;
        let place = 2.0 * beside * (ALONG * contour + END);
        (many / self.area * place * (2.0 * askew / PI)).min(MOST)
    }
}
