//! How much of a match runs along the rows and columns of the picture, as edges of what is drawn, framed
//! or put together of pictures do, and those of a thing before a camera only where it stands square to it.

use crate::image::ImageFeatures;
use crate::verification::part_match::FeaturePair;

/// Shorter segments than this, in pixels, tell no direction.
const SHORTEST: f64 = 16.0;
/// How far off a row or a column the ends of a segment are, in pixels, or by its length.
const OFF: f64 = 0.75;
const SLOPE: f64 = 1.0 / 256.0;
/// From this share on what is found may be framed; all of it is at one. And so much runs both ways.
const SOME: f64 = 0.8;
const EITHER: f64 = 0.1;

/// From nothing to one, where all segments of what is found run along rows and columns, some along either.
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
