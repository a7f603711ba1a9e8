//! The tracker: finds the part in the next image of a sequence from its last pose, or by a new
//! search.

use crate::camera::Pinhole;
use crate::hypothesis::{Hypothesis, REACHES, drawn, settled};
use crate::matcher::Matcher;
use crate::part::SoughtPart;
use crate::search::monitor::{SEARCH_STEPS, SearchStopped};
use crate::verification::part_match::{PartMatch, SearchResult};
use nalgebra::Isometry3;

/// The search radii, in pixels, for edges that moved between images.
const MOVED: [f64; 3] = [24.0, 12.0, 6.0];

/// The prior log-odds of a part at its expected position: the logarithm of the number of other
/// positions that were not searched.
const EXPECTED: f64 = 6.0;

/// The result for an image of a sequence.
#[derive(Clone, Debug)]
pub struct TrackResult {
    /// The result.
    pub result: SearchResult,
    /// Whether the whole image was searched.
    pub anew: bool,
}

impl Matcher<'_> {
    /// The match found from the last pose; none if the part is lost.
    pub fn follow(&self, last: &Isometry3<f64>) -> Option<PartMatch> {
        let Self {
            part,
            picture,
            camera,
            ..
        } = *self;
        let start = Hypothesis {
            pose: *last,
            ratio: f64::NEG_INFINITY,
            chain: 0,
            of: 0,
        };
        let reaches = [&MOVED[..], &REACHES[1..]].concat();
        let near = drawn(part, picture, camera, &start, &reaches)?;
        // The pose after refinement, and the best one around it.
        let settled = settled(part, picture, camera, &near);
        let all = [near, settled].into_iter().filter_map(|h| {
            let mut found = self.matched(&h.pose)?;
            found.odds += EXPECTED;
            let good = found.is_determined(part) && found.is_accepted();
            (good && is_near(part, camera, last, &found.pose)).then_some(found)
        });
        all.min_by(PartMatch::order)
    }

    /// The result for the next image of a sequence.
    ///
    /// # Errors
    /// The monitor stopped the search.
    pub fn next(&self, last: Option<&Isometry3<f64>>) -> Result<TrackResult, SearchStopped> {
        match last.and_then(|p| self.follow(p)) {
            Some(found) => {
                let finding = SearchResult {
                    matches: vec![found],
                    ..SearchResult::default()
                };
                self.monitor.advance(SEARCH_STEPS);
                Ok(TrackResult {
                    result: finding,
                    anew: false,
                })
            }
            None => Ok(TrackResult {
                result: self.find()?,
                anew: true,
            }),
        }
    }
}

/// Whether the images of the part's probe points moved by at most `FARTHEST`.
fn is_near(
    part: &SoughtPart<'_>,
    camera: &Pinhole,
    a: &Isometry3<f64>,
    b: &Isometry3<f64>,
) -> bool {
    part.probes().iter().all(|p| {
        let [a, b] = [a * p, b * p];
        a.z > 0.0 && b.z > 0.0 && (camera.project(&a) - camera.project(&b)).norm() <= FARTHEST
    })
}

/// How far the image of a probe point may move between images, in pixels.
const FARTHEST: f64 = 64.0;
