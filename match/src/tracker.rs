//! The part in the next picture of a sequence: from its last pose, or by looking for it anew.

use crate::camera::Pinhole;
use crate::hypothesis::{Hypothesis, REACHES, drawn, settled};
use crate::matcher::Matcher;
use crate::part::SoughtPart;
use crate::verification::part_match::{PartMatch, SearchResult};
use nalgebra::Isometry3;

/// How far, in pixels, edges may have moved from picture to picture.
const MOVED: [f64; 3] = [24.0, 12.0, 6.0];

/// How much likelier a part is where it was expected: the logarithm of how many other places were not
/// looked at.
const EXPECTED: f64 = 6.0;

impl Matcher<'_> {
    /// The match that is reached from the last pose; none if the part is lost.
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
        // Where it is drawn to at once, and what is better about that.
        let settled = settled(part, picture, camera, &near);
        let all = [near, settled].into_iter().filter_map(|h| {
            let mut found = self.matched(&h.pose)?;
            found.odds += EXPECTED;
            let good = found.is_determined(part) && found.is_accepted();
            (good && is_near(part, camera, last, &found.pose)).then_some(found)
        });
        all.min_by(PartMatch::order)
    }

    /// What became of a picture of a sequence: the match, and whether it was looked for anew.
    pub fn next(&self, last: Option<&Isometry3<f64>>) -> (SearchResult, bool) {
        match last.and_then(|p| self.follow(p)) {
            Some(found) => {
                let finding = SearchResult {
                    matches: vec![found],
                    ..SearchResult::default()
                };
                (finding, false)
            }
            None => (self.find(), true),
        }
    }
}

/// Whether the images of the part's probes have moved no farther than edges may have.
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

/// How far, in pixels, the image of a point of the part may move from picture to picture.
const FARTHEST: f64 = 64.0;
