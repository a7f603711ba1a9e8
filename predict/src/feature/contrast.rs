//! The brightness on both sides along an arc.

use crate::image::shading::Shading;
use crate::image_arcs::arc::ArcSide;
use crate::image_arcs::{PredictedArc, Regions};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The spacing of the positions at which the sides are evaluated, in pixels.
const EVERY: f64 = 6.0;
/// The distance from the arc at which the sides are evaluated: that of the first unmixed pixel.
const ASIDE: f64 = 1.0;

/// The grey levels on both sides of an arc, before noise and steps.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Contrast {
    /// The length along the arc, in pixels.
    pub along: f64,
    /// The level to the left of its direction.
    pub left: f64,
    /// The level to the right.
    pub right: f64,
}

impl Contrast {
    /// The difference of the sides in levels, clipped to the range of a sensor with this top level.
    pub(crate) fn difference(&self, top: f64) -> f64 {
        (self.left.clamp(0.0, top) - self.right.clamp(0.0, top)).abs()
    }
}

/// The regions on the sides of an arc with a number: by section, the left and the right one.
pub(crate) fn sides(regions: &Regions, number: usize, arc: &PredictedArc) -> Vec<[u32; 2]> {
    if let Some(region) = arc.within {
        return vec![[region; 2]];
    }
    let sections = regions.sections.of_arc(number);
    sections
        .map(|s| [ArcSide::Left, ArcSide::Right].map(|on| regions.adjacent(s, on)))
        .collect()
}

/// The brightness along an arc with a number, within a part of it.
pub(crate) fn contrast(
    shading: &Shading<'_>,
    regions: &Regions,
    number: usize,
    arc: &PredictedArc,
    [start, end]: [f64; 2],
) -> Vec<Contrast> {
    let sides = sides(regions, number, arc);
    let steps = ((end - start) / EVERY).ceil().max(1.0);
    let mut found = Vec::new();
    let (mut before, mut section) = (0.0, 0);
    let mut next = 0u32;
    let place = |k: u32| start + (end - start) * ((f64::from(k) + 0.5) / steps);
    for (i, [a, b]) in arc.line.segments() {
        section += usize::from(i > 0 && arc.stops.contains(&i));
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let d = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
        while f64::from(next) < steps && place(next) <= before + length {
            let along = place(next);
            next += 1;
            let s = along - before;
            if s < 0.0 || !d[0].is_finite() {
                continue;
            }
            let at = [a[0] + s * d[0], a[1] + s * d[1]];
            // With y down, left is the direction turned counterclockwise.
            let lateral = [ASIDE * d[1], -ASIDE * d[0]];
            let level = |side: usize, sign: f64| {
                let at = [at[0] + sign * lateral[0], at[1] + sign * lateral[1]];
                let region = &regions.all[sides[section][side] as usize];
                let seen = region.seen.unwrap_or_else(|| shading.cast(at));
                shading.level(at, &seen, &mut shading.distance(&seen.point))
            };
            found.push(Contrast {
                along,
                left: level(0, 1.0),
                right: level(1, -1.0),
            });
        }
        before += length;
    }
    found
}
