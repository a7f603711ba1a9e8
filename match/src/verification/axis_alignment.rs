//! How much of a match runs along the rows and columns of the image.
//!
//! Edges of drawings, frames and mounted pictures do. Edges of a thing before a camera do only
//! where it stands square to the camera.

use crate::image::ImageFeatures;
use crate::verification::part_match::FeaturePair;

/// Segments shorter than this, in pixels, have no reliable direction.
const SHORTEST: f64 = 16.0;
/// The greatest deviation of a segment from a row or a column: of its ends in pixels, or as a
/// slope.
const OFF: f64 = 0.75;
const SLOPE: f64 = 1.0 / 256.0;
/// The aligned share from which a match may be framed; at 1 it is. `EITHER` is the least share
/// along rows and along columns.
const SOME: f64 = 0.8;
const EITHER: f64 = 0.1;

/// From 0 to 1: 1 where all segments of what is found run along rows and columns, some along
/// either.
pub fn framed(picture: &ImageFeatures, pairs: &[FeaturePair]) -> f64 {
    let found = pairs.iter().filter_map(|p| p.found.as_ref());
    let (mut along, mut all) = ([0.0; 2], 0.0);
    for &segment in found.flat_map(|f| &f.segments) {
        let [a, b] = picture.ends(segment);
        let [x, y] = [0, 1].map(|i| (b[i] - a[i]).abs());
        let length = x.hypot(y);
        if length < SHORTEST {
            continue;
        }
        all += length;
        for (along, off) in along.iter_mut().zip([y, x]) {
            if off < OFF.max(SLOPE * length) {
                *along += length;
            }
        }
    }
    if all == 0.0 {
        return 0.0;
    }
    let [rows, columns] = along.map(|length| length / all);
    let share = (rows + columns - SOME) / (1.0 - SOME);
    share.clamp(0.0, 1.0) * (rows.min(columns) / EITHER).min(1.0)
}
