//! How many faces turned towards the eye lie before a point of a contour, by rays.

use super::{Material, Ray};
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::number::sign::ROUNDING;
use std::f64::consts::TAU;

/// How many neighbours must agree.
const NEIGHBOURS: usize = 24;

/// A face that lies close is looked at again with lines of sight that run this much closer, and is
/// the point's own where it has come nearer by the other factor (by the root of the first on a
/// limb, with room for a mixture of both).
const CLOSER: f64 = 1.0 / 16.0;
const DRAWN: f64 = 0.5;

/// How far things must be apart for rays to tell them apart, in the part's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance {
    /// Gaps and slivers up to this length are none.
    pub sliver: f64,
    /// A count holds where it is the same on the lines of sight this far aside.
    pub aside: f64,
    /// The part's size.
    pub size: f64,
}

impl Material {
    /// How often the line of sight enters material between the eye and a point of a contour: its
    /// quantitative invisibility. None where the answer changes within the clearance: next to
    /// another contour, along a face seen edge-on, close behind another face.
    ///
    /// `sight` gives the unit direction from a point to the eye, and how far the line of sight
    /// reaches.
    pub fn invisibility(
        &self,
        point: &Point3<f64>,
        sight: impl Fn(&Point3<f64>) -> (Vector3<f64>, f64),
        clearance: &Clearance,
    ) -> Option<u32> {
        // Aside of a limb, its own surface lies this much nearer.
        let depth = 2.0 * (clearance.aside * clearance.size).sqrt();
        let (towards, length) = sight(point);
        if length <= depth {
            return None;
        }
        let own = self.along(point, towards, clearance)?;
        let unclear = |s: &f64| *s > clearance.aside && *s < depth;
        if own.iter().flatten().any(unclear) {
            return None;
        }
        let count = entries(&own, depth, length);
        let frame = Frame::about(*point, towards);
        // What is nearer than this is rounding on the point's own faces.
        let least = clearance.sliver * CLOSER * CLOSER;
        let agree = (0..NEIGHBOURS).all(|k| {
            let (sin, cos) = ((k as f64 + 0.25) * TAU / NEIGHBOURS as f64).sin_cos();
            let beside = |by: f64| {
                let origin = frame.point(by * cos, by * sin, 0.0);
                let (towards, length) = sight(&origin);
                Some((self.along(&origin, towards, clearance)?, length))
            };
            let Some((aside, length)) = beside(clearance.aside) else {
                return false;
            };
            if entries(&aside, depth, length) != count {
                return false;
            }
            // The point's own faces draw near with the line of sight, another one does not, however
            // close it lies.
            let close = first_exit(&aside, least);
            close >= depth
                || beside(clearance.aside * CLOSER)
                    .is_some_and(|(closer, _)| first_exit(&closer, 0.0) < close * DRAWN)
        });
        agree.then_some(count)
    }

    /// The material along a line of sight; none where gaps or slivers that are more than rounding
    /// are too short to count on: next to where two surfaces touch.
    fn along(
        &self,
        origin: &Point3<f64>,
        direction: Vector3<f64>,
        clearance: &Clearance,
    ) -> Option<Vec<[f64; 2]>> {
        let ray = Ray {
            origin: *origin,
            direction,
        };
        let found = self.intervals(&ray, clearance.size * ROUNDING);
        let short = |from: f64, to: f64| to - from <= clearance.sliver;
        let slivers = found.iter().any(|i| i[0] > 0.0 && short(i[0], i[1]));
        let gaps = found.windows(2);
        let mut gaps = gaps.filter(|w| w[0][1] > clearance.aside);
        let close = slivers || gaps.any(|w| short(w[0][1], w[1][0]));
        (!close).then_some(found)
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
