//! Why an arc is not whole.

use super::arc_raster::ArcRaster;
use super::contrast::Contrast;
use super::detected_arc::{DetectedArc, DetectionState};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Why an arc, or a part of it, is not found.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(tag = "why", rename_all = "kebab-case")]
pub enum Reason {
    /// It does not lie in the image.
    OutOfImage,
    /// It is shorter than the shortest segment that the detector keeps.
    Short {
        /// Its length, in pixels.
        length: f64,
        /// The least length that the detector keeps, in pixels.
        needed: f64,
    },
    /// No light reaches either side.
    Dark {
        /// The brighter side's level.
        level: f64,
    },
    /// Both sides are at the top level of the sensor.
    Saturated,
    /// The contrast of the sides is too low.
    LowContrast {
        /// The greatest difference of the levels where it is not found.
        contrast: f64,
        /// The difference that the detector's threshold needs.
        needed: f64,
    },
    /// Another arc next to it is found in its place.
    #[serde(rename = "crowded")]
    CloseNeighbour {
        /// Which.
        by: u32,
    },
    /// The contrast suffices, but thinning or linking removes it.
    Lost {
        /// The least difference of the levels where it is not found.
        contrast: f64,
    },
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfImage => write!(f, "outside of the image"),
            Self::Short { length, needed } => {
                write!(f, "{length:.1} px long; the detector keeps {needed:.0}")
            }
            Self::Dark { level } => write!(f, "dark: {level:.0} levels on the brighter side"),
            Self::Saturated => write!(f, "both sides are saturated"),
            Self::LowContrast { contrast, needed } => {
                write!(
                    f,
                    "{contrast:.1} levels of contrast; the threshold takes {needed:.1}"
                )
            }
            Self::CloseNeighbour { by } => write!(f, "arc {by} is found next to it"),
            Self::Lost { contrast } => {
                write!(
                    f,
                    "{contrast:.0} levels of contrast, but lost in thinning or linking"
                )
            }
        }
    }
}

/// The quantities that determine reasons.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measure {
    /// The sensor's top level.
    pub top: f64,
    /// The difference of levels that the detector's threshold takes.
    pub needed: f64,
    /// The length in pixels that the detector keeps.
    pub shortest: f64,
    /// The radius of the mask and the thinning, in pixels.
    pub radius: usize,
}

/// Why an arc is not whole; none where it is.
pub(crate) fn reason(
    arc: usize,
    evidence: &[DetectedArc],
    contrast: &[Contrast],
    ink: &ArcRaster,
    measure: &Measure,
) -> Option<Reason> {
    let own = &evidence[arc];
    if own.state == DetectionState::Whole {
        return None;
    }
    let [start, end] = ink.spans[arc];
    if start > end {
        return Some(Reason::OutOfImage);
    }
    let covered = |along: f64| {
        let holds = |f: &super::Fragment| f.along[0] <= along && along <= f.along[1];
        own.fragments.iter().any(holds)
    };
    let open: Vec<&Contrast> = contrast.iter().filter(|c| !covered(c.along)).collect();
    let differences = || open.iter().map(|c| c.difference(measure.top));
    let most = differences().fold(0.0, f64::max);
    let brightest = open.iter().map(|c| c.left.max(c.right)).fold(0.0, f64::max);
    let saturated = |c: &&Contrast| c.left >= measure.top && c.right >= measure.top;
    if open.is_empty() {
        return Some(Reason::Lost { contrast: most });
    }
    if open.iter().all(saturated) {
        return Some(Reason::Saturated);
    }
    if brightest < measure.needed {
        return Some(Reason::Dark { level: brightest });
    }
    if most < measure.needed {
        return Some(Reason::LowContrast {
            contrast: most,
            needed: measure.needed,
        });
    }
    if end - start < measure.shortest {
        return Some(Reason::Short {
            length: end - start,
            needed: measure.shortest,
        });
    }
    if let Some(by) = crowd(arc, evidence, ink, measure.radius as i64 + 1) {
        return Some(Reason::CloseNeighbour { by });
    }
    // Where a part of it is too weak, that is the reason for the gap.
    let least = differences().fold(f64::INFINITY, f64::min);
    Some(match least < measure.needed {
        true => Reason::LowContrast {
            contrast: least,
            needed: measure.needed,
        },
        false => Reason::Lost { contrast: least },
    })
}

/// The arc that is found next to the greater part of an arc.
fn crowd(arc: usize, evidence: &[DetectedArc], ink: &ArcRaster, within: i64) -> Option<u32> {
    let own = &ink.pixels[ink.ranges[arc].clone()];
    let mut counts: Vec<(u32, usize)> = Vec::new();
    for pixel in own {
        let mut near: Vec<u32> = Vec::new();
        for y in -within..=within {
            for x in -within..=within {
                for other in ink.at(i64::from(pixel.x) + x, i64::from(pixel.y) + y) {
                    let found = evidence[other.arc as usize].state != DetectionState::Missed;
                    if other.arc as usize != arc && found && !near.contains(&other.arc) {
                        near.push(other.arc);
                    }
                }
            }
        }
        for other in near {
            match counts.iter_mut().find(|c| c.0 == other) {
                Some(count) => count.1 += 1,
                None => counts.push((other, 1)),
            }
        }
    }
    let most = counts
        .iter()
        .max_by_key(|c| (c.1, std::cmp::Reverse(c.0)))?;
    (2 * most.1 > own.len()).then_some(most.0)
}
