//! Counts the faces turned towards the eye in front of a contour point, by ray casting.

use super::{Ray, RayOracle};
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::number::predicates::ROUNDING;
use std::f64::consts::TAU;

/// The number of neighbouring lines of sight that must agree.
const NEIGHBOURS: usize = 24;

/// The factor by which neighbouring lines of sight are moved closer to re-examine a face close to
/// the point. The face is the point's own if its distance decreases by the factor `DRAWN`. On a
/// limb the distance decreases with the square root of the first factor; the second leaves room for
/// a mixture of both cases.
const CLOSER: f64 = 1.0 / 16.0;
const DRAWN: f64 = 0.5;

/// A face whose distance decreases by less than this factor, that is by less than that of a surface
/// at an angle to the line of sight, folds there.
const FOLDED: f64 = 1.0 / 8.0;

/// The smallest distances that ray casting resolves, in the part's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Gaps and slivers up to this length are ignored.
    pub sliver: f64,
    /// A count is valid if it is the same on lines of sight at this lateral distance.
    pub lateral: f64,
    /// The error of the position of a curve in which curved surfaces intersect: they are tangent
    /// within the resolution, and cross close to that curve.
    pub shift: f64,
    /// The part's size.
    pub size: f64,
}

/// The result of ray casting about how a contour point is hidden.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SightEvidence {
    /// The number of times that all lines of sight enter material between the eye and the point:
    /// its quantitative invisibility.
    Count(u32),
    /// The count, where a face of the point folds closer to it than ray casting resolves. In front
    /// of a point that is not on the limb itself, the fold may lie once more.
    Fold(u32),
    /// The counts differ: another contour is close, or a face is seen edge-on.
    Mixed,
    /// Another face is close in front of the point.
    Close,
    /// Material or gaps in front of the point are too thin: surfaces touch close to it.
    Thin,
}

/// The line of sight from a point to the eye or the near plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SightSegment {
    /// The unit vector from the point to the eye.
    pub towards: Vector3<f64>,
    /// The length.
    pub length: f64,
}

impl Clearance {
    /// The clearance with the lines of sight moved closer by a factor.
    pub fn closer(&self, by: f64) -> Self {
        Self {
            sliver: self.sliver * by,
            lateral: self.lateral * by,
            ..*self
        }
    }
}

impl RayOracle {
    /// Counts how often the lines of sight close to a contour point enter material between the eye
    /// and the point.
    ///
    /// `sight` gives the line of sight from a point to the eye.
    pub fn invisibility(
        &self,
        point: &Point3<f64>,
        sight: impl Fn(&Point3<f64>) -> SightSegment,
        clearance: &Clearance,
    ) -> SightEvidence {
        self.count(point, sight, clearance)
            .unwrap_or_else(|why| why)
    }

    fn count(
        &self,
        point: &Point3<f64>,
        sight: impl Fn(&Point3<f64>) -> SightSegment,
        clearance: &Clearance,
    ) -> Result<SightEvidence, SightEvidence> {
        // At the lateral distance from a limb, its own surface is closer by this much.
        let depth = 2.0 * (clearance.lateral * clearance.size).sqrt();
        let SightSegment { towards, length } = sight(point);
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
        // Smaller distances are rounding on the point's own faces.
        let least = clearance.sliver * CLOSER * CLOSER;
        let mut folds = false;
        for k in 0..NEIGHBOURS {
            let (sin, cos) = ((k as f64 + 0.25) * TAU / NEIGHBOURS as f64).sin_cos();
            let at_lateral = |by: f64| {
                let origin = frame.point(by * cos, by * sin, 0.0);
                let SightSegment { towards, length } = sight(&origin);
                Ok((self.along(&origin, towards, clearance)?, length))
            };
            let (lateral, length) = at_lateral(clearance.lateral)?;
            if entries(&lateral, depth, length) != count {
                return Err(SightEvidence::Mixed);
            }
            // The distance to the point's own faces decreases as the line of sight approaches the
            // point; that to another face does not, however close it is, and however many own faces
            // lie before it.
            if let Some(close) = last_exit(&lateral, [least, depth]) {
                let (closer, _) = at_lateral(clearance.lateral * CLOSER)?;
                let drawn = last_exit(&closer, [0.0, depth]);
                if drawn.is_none_or(|drawn| drawn >= close * DRAWN) {
                    return Err(SightEvidence::Close);
                }
                folds |= drawn.is_some_and(|drawn| drawn > close * FOLDED);
            }
        }
        Ok(match folds {
            true => SightEvidence::Fold(count),
            false => SightEvidence::Count(count),
        })
    }

    /// The material along a line of sight. Fails if gaps or slivers longer than rounding are too
    /// short to be reliable, as they are where two surfaces touch.
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

/// The last end of material between two distances.
fn last_exit(intervals: &[[f64; 2]], [from, to]: [f64; 2]) -> Option<f64> {
    let ends = intervals.iter().map(|i| i[1]);
    ends.filter(|end| *end > from && *end < to).reduce(f64::max)
}

fn entries(intervals: &[[f64; 2]], from: f64, to: f64) -> u32 {
    intervals
        .iter()
        .filter(|i| i[1] > from && i[1] < to)
        .count() as u32
}
