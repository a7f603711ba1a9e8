//! How many faces turned towards the eye lie before a point of a contour, by rays.

use super::{Ray, RayOracle};
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::number::predicates::ROUNDING;
use std::f64::consts::TAU;

/// How many neighbours must agree.
const NEIGHBOURS: usize = 24;

/// A face that lies close is looked at again with lines of sight that run this much closer, and is
/// the point's own where it has come nearer by the other factor (by the root of the first on a
/// limb, with room for a mixture of both).
const CLOSER: f64 = 1.0 / 16.0;
const DRAWN: f64 = 0.5;

/// What has come nearer by less than this, more than a surface at an angle to the line of sight
/// does, folds there.
const FOLDED: f64 = 1.0 / 8.0;

/// How far things must be apart for rays to tell them apart, in the part's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Gaps and slivers up to this length are none.
    pub sliver: f64,
    /// A count holds where it is the same on the lines of sight this far aside.
    pub lateral: f64,
    /// How far a curve along which round surfaces meet may lie from where it is told: they touch by
    /// the resolution, and cross next to that.
    pub shift: f64,
    /// The part's size.
    pub size: f64,
}

/// What lines of sight tell of how a point of a contour is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SightEvidence {
    /// How often they all enter material between the eye and the point: its quantitative
    /// invisibility.
    Count(u32),
    /// The same, but a face of the point folds next to it, nearer than lines of sight can tell: before
    /// a point that is not on the limb itself the fold may lie once more.
    Fold(u32),
    /// They disagree: another contour is near, or a face is seen edge-on.
    Mixed,
    /// A face that is not the point's own lies close before it.
    Close,
    /// Material or gaps before it are too thin to count on: surfaces touch near by.
    Thin,
}

impl Clearance {
    /// The same with lines of sight that run this much closer.
    pub fn closer(&self, by: f64) -> Self {
        Self {
            sliver: self.sliver * by,
            lateral: self.lateral * by,
            ..*self
        }
    }
}

impl RayOracle {
    /// How often the lines of sight next to a point of a contour enter material between the eye
    /// and the point.
    ///
    /// `sight` gives the unit direction from a point to the eye, and how far the line of sight
    /// reaches.
    pub fn invisibility(
        &self,
        point: &Point3<f64>,
        sight: impl Fn(&Point3<f64>) -> (Vector3<f64>, f64),
        clearance: &Clearance,
    ) -> SightEvidence {
        self.count(point, sight, clearance)
            .unwrap_or_else(|why| why)
    }

    fn count(
        &self,
        point: &Point3<f64>,
        sight: impl Fn(&Point3<f64>) -> (Vector3<f64>, f64),
        clearance: &Clearance,
    ) -> Result<SightEvidence, SightEvidence> {
        // Aside of a limb, its own surface lies this much nearer.
        let depth = 2.0 * (clearance.lateral * clearance.size).sqrt();
        let (towards, length) = sight(point);
        if length <= depth {
            return Err(SightEvidence::Close);
        }
        let own = self.along(point, towards, clearance)?;
        let unclear = |s: &f64| *s > clearance.lateral && *s < depth;
        if own.iter().flatten().any(unclear) {
            return Err(SightEvidence::Close);
        }
        let count = entries(&own, depth, length);
        let frame = Frame::about(*point, towards);
        // What is nearer than this is rounding on the point's own faces.
        let least = clearance.sliver * CLOSER * CLOSER;
        let mut folds = false;
        for k in 0..NEIGHBOURS {
            let (sin, cos) = ((k as f64 + 0.25) * TAU / NEIGHBOURS as f64).sin_cos();
            let beside = |by: f64| {
                let origin = frame.point(by * cos, by * sin, 0.0);
                let (towards, length) = sight(&origin);
                Ok((self.along(&origin, towards, clearance)?, length))
            };
            let (lateral, length) = beside(clearance.lateral)?;
            if entries(&lateral, depth, length) != count {
                return Err(SightEvidence::Mixed);
            }
            // The point's own faces draw near with the line of sight, another one does not, however
            // close it lies.
            let close = first_exit(&lateral, least);
            if close < depth {
                let (closer, _) = beside(clearance.lateral * CLOSER)?;
                let drawn = first_exit(&closer, 0.0);
                if drawn >= close * DRAWN {
                    return Err(SightEvidence::Close);
                }
                folds |= drawn > close * FOLDED;
            }
        }
        Ok(match folds {
            true => SightEvidence::Fold(count),
            false => SightEvidence::Count(count),
        })
    }

    /// The material along a line of sight, where no gaps or slivers that are more than rounding
    /// are too short to count on: next to where two surfaces touch.
    fn along(
        &self,
        origin: &Point3<f64>,
        direction: Vector3<f64>,
        clearance: &Clearance,
    ) -> Result<Vec<[f64; 2]>, SightEvidence> {
        let ray = Ray {
            origin: *origin,
            direction,
        };
        let found = self.intervals(&ray, clearance.size * ROUNDING);
        let short = |from: f64, to: f64| to - from <= clearance.sliver;
        let slivers = found.iter().any(|i| i[0] > 0.0 && short(i[0], i[1]));
        let gaps = found.windows(2);
        let mut gaps = gaps.filter(|w| w[0][1] > clearance.lateral);
        let close = slivers || gaps.any(|w| short(w[0][1], w[1][0]));
        match close {
            true => Err(SightEvidence::Thin),
            false => Ok(found),
        }
    }
}

/// Where the material beyond `from` first ends.
fn first_exit(intervals: &[[f64; 2]], from: f64) -> f64 {
    let ends = intervals.iter().map(|i| i[1]).filter(|end| *end > from);
    ends.fold(f64::INFINITY, f64::min)
}

fn entries(intervals: &[[f64; 2]], from: f64, to: f64) -> u32 {
    intervals
        .iter()
        .filter(|i| i[1] > from && i[1] < to)
        .count() as u32
}
