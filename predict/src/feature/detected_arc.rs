//! What a detector found of each arc: edge pixels assigned to the arcs whose images they are.

use super::arc_raster::ArcRaster;
use crate::setup::criteria::Criteria;
use premio_detect::{Detection, Detector, EdgePixel};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The cosine of the greatest angle between an edge's gradient and the normal of its arc.
const ALIGNED: f64 = 0.77;
/// The length of an arc that one edge pixel represents, on each side of it, in pixels.
const STANDS_FOR: f64 = 0.75;

/// The detection state of an arc.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, JsonSchema, Serialize, Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum DetectionState {
    /// In one piece, except for its ends.
    Whole,
    /// In pieces, or in part.
    Broken,
    /// Not at all.
    Missed,
}

impl DetectionState {
    /// All states.
    pub const ALL: [Self; 3] = [Self::Whole, Self::Broken, Self::Missed];

    /// Its index in [`Self::ALL`].
    pub(crate) fn index(self) -> usize {
        self as usize
    }

    /// Its word in reports.
    pub fn word(self) -> &'static str {
        match self {
            Self::Whole => "whole",
            Self::Broken => "broken",
            Self::Missed => "missed",
        }
    }
}

/// A piece of an arc that is found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fragment {
    /// Its range along the arc, in pixels.
    pub along: [f64; 2],
    /// The indices of its segments in the detection.
    pub segments: Vec<u32>,
}

/// The detection of an arc.
#[derive(Clone, Debug, PartialEq)]
pub struct DetectedArc {
    /// The pieces of it, in order.
    pub fragments: Vec<Fragment>,
    /// The covered share of the arc without its ends.
    pub share: f64,
    /// The resulting state.
    pub state: DetectionState,
    /// The root mean square distance of the edge pixels from it, in pixels.
    pub off: f64,
}

/// An edge pixel assigned to an arc.
#[derive(Clone, Copy, Debug)]
struct Mark {
    along: f64,
    off: f64,
    segment: u32,
}

/// What a detector found of each arc.
pub(crate) fn evidence(
    detection: &Detection,
    detector: &Detector,
    criteria: &Criteria,
    ink: &ArcRaster,
) -> Vec<DetectedArc> {
    let mut marks: Vec<Vec<Mark>> = vec![Vec::new(); ink.ranges.len()];
    for (number, segment) in detection.segments.iter().enumerate() {
        let chain = &detection.chains[segment.chain as usize];
        let [from, to] = segment.range.map(|i| i as usize);
        for &i in &chain.pixels[from..to] {
            let pixel = &detection.pixels[i as usize];
            if let Some(near) = nearest(ink, pixel, criteria.reach) {
                marks[near.arc as usize].push(Mark {
                    along: near.along,
                    off: near.off,
                    segment: number as u32,
                });
            }
        }
    }
    // Near the end of an arc the mask also covers other arcs.
    let margin = detector.radius() as f64 + 1.0;
    let all = marks.into_iter().zip(&ink.spans);
    all.map(|(marks, span)| judge(marks, *span, margin, detector.gap, criteria))
        .collect()
}

/// The arc nearest to an edge pixel.
#[derive(Clone, Copy)]
struct NearestArc {
    arc: u32,
    /// The length along it, in pixels.
    along: f64,
    /// The signed distance from it, in pixels.
    off: f64,
    cost: f64,
}

/// The arc of an edge pixel.
fn nearest(ink: &ArcRaster, pixel: &EdgePixel, reach: f64) -> Option<NearestArc> {
    let window = reach.ceil() as i64;
    let gradient = pixel.gradient;
    let strength = gradient[0].hypot(gradient[1]);
    let mut best: Option<NearestArc> = None;
    for y in -window..=window {
        for x in -window..=window {
            for near in ink.at(i64::from(pixel.x) + x, i64::from(pixel.y) + y) {
                let [u, v] = near.direction;
                let d = [pixel.at[0] - near.at[0], pixel.at[1] - near.at[1]];
                let (along, across) = (d[0] * u + d[1] * v, d[1] * u - d[0] * v);
                let aligned = (gradient[1] * u - gradient[0] * v).abs() / strength;
                if across.abs() > reach || along.abs() > 1.0 || aligned < ALIGNED {
                    continue;
                }
                // An edge at the greatest angle costs as much as one at a distance of one pixel.
                let cost = d[0].hypot(d[1]) + (1.0 - aligned) / (1.0 - ALIGNED);
                if best.is_none_or(|known| cost < known.cost) {
                    best = Some(NearestArc {
                        arc: near.arc,
                        along: near.along + along,
                        off: across,
                        cost,
                    });
                }
            }
        }
    }
    best
}

/// The detection that results from the edge pixels of an arc.
fn judge(
    mut marks: Vec<Mark>,
    [start, end]: [f64; 2],
    margin: f64,
    gap: f64,
    criteria: &Criteria,
) -> DetectedArc {
    let missed = DetectedArc {
        fragments: Vec::new(),
        share: 0.0,
        state: DetectionState::Missed,
        off: 0.0,
    };
    if marks.is_empty() || start > end {
        return missed;
    }
    marks.sort_by(|a, b| a.along.total_cmp(&b.along));
    let squares: f64 = marks.iter().map(|m| m.off * m.off).sum();
    let off = (squares / marks.len() as f64).sqrt();
    let mut fragments: Vec<Fragment> = Vec::new();
    for mark in &marks {
        let [from, to] = [mark.along - STANDS_FOR, mark.along + STANDS_FOR];
        match fragments.last_mut() {
            Some(last) if from <= last.along[1] + gap => {
                last.along[1] = to;
                if !last.segments.contains(&mark.segment) {
                    last.segments.push(mark.segment);
                }
            }
            _ => fragments.push(Fragment {
                along: [from.max(start), to],
                segments: vec![mark.segment],
            }),
        }
    }
    for fragment in &mut fragments {
        fragment.along[1] = fragment.along[1].min(end);
    }
    // The core of the arc: without its ends, which are shorter for short arcs.
    let inset = margin.min(0.25 * (end - start));
    let core = [start + inset, end - inset];
    let within = |f: &Fragment| (f.along[1].min(core[1]) - f.along[0].max(core[0])).max(0.0);
    let share = match core[1] > core[0] {
        true => fragments.iter().map(within).sum::<f64>() / (core[1] - core[0]),
        false => 1.0,
    };
    let pieces = fragments.iter().filter(|f| within(f) > 0.0).count();
    let state = match (
        share >= criteria.whole && pieces <= 1,
        share >= criteria.least,
    ) {
        (true, _) => DetectionState::Whole,
        (false, true) => DetectionState::Broken,
        (false, false) => DetectionState::Missed,
    };
    DetectedArc {
        fragments,
        share,
        state,
        off,
    }
}
