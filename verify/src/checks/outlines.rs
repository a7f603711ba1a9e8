//! Whether contours are missing: what lines of sight meet in the tree changes at contours only.
//!
//! Lines are drawn across the image, and lines of sight are followed along them. Where two
//! neighbours cross different surfaces of the tree, halving finds the place of the change; some
//! contour must pass there, at the depth of the change, and a visible one where it is the nearest
//! surface that changes.

use super::images::{Images, Passing};
use super::window::Window;
use premio_csg::ray_casting::{Clearance, RayOracle, SurfaceCrossing, Surfaces};
use premio_kernel::number::predicates::ROUNDING;
use premio_visibility::Contours;
use premio_visibility::camera::projection::Projection;
use std::f64::consts::PI;
use std::fmt;

/// How many lines are drawn across the image.
const LINES: usize = 24;
/// How many lines of sight are followed along each.
const SIGHTS: usize = 32;
/// The powers of the plastic number, by which Roberts's sequence steps through the unit square.
const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];
/// How many changes are looked for between two neighbouring lines of sight.
const CHANGES: usize = 8;
/// How often the place of a change is halved: to less than a millionth of the window.
const HALVINGS: usize = 17;
/// How near a contour must pass, in multiples of the interval that is left.
const NEAR: f64 = 4.0;
/// How many times the depth of a round surface next to its limb a contour may be off in depth.
const DEEP: f64 = 16.0;
/// How many missing contours are named.
const NAMED: usize = 5;

/// What is amiss at a place of the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lack {
    /// No contour passes.
    Contour,
    /// Contours pass, but none at the depth of the change.
    Depth,
    /// What passes is said to be hidden, but nothing lies before it.
    Visible,
}

/// A change in what lines of sight meet that no contour explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Missing {
    /// What is amiss.
    pub lack: Lack,
    /// The place of the change in the part's frame.
    pub place: [f64; 3],
}

/// The changes that were found along lines across an image.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outlines {
    /// How many changes have their contour.
    pub explained: usize,
    /// How many lie too close to something else.
    pub ambiguous: usize,
    /// Those that lack one.
    pub missing: Vec<Missing>,
}

/// What a line of sight meets; none next to where surfaces touch.
type Met = Option<Vec<SurfaceCrossing>>;

struct Search<'a> {
    surfaces: Surfaces<'a>,
    window: &'a Window,
    clearance: &'a Clearance,
}

/// Two neighbouring lines of sight that meet different surfaces.
struct Change {
    at: [[f64; 2]; 2],
    met: [Vec<SurfaceCrossing>; 2],
}

impl Outlines {
    /// Looks for the contours of a view.
    pub fn new(material: &RayOracle, seen: &Contours, clearance: &Clearance) -> Self {
        let projection = Projection::new(&seen.camera, clearance.size);
        let window = Window::around(&projection, material.bounds());
        let images = Images::new(seen, &window);
        let search = Search {
            surfaces: Surfaces::new(material),
            window: &window,
            clearance,
        };
        let mut outlines = Self::default();
        for line in 0..LINES {
            let places = search.places(line);
            let met = places.map(|at| search.met(at));
            for k in 1..SIGHTS {
                if let (Some(a), Some(b)) = (&met[k - 1], &met[k]) {
                    let at = [places[k - 1], places[k]];
                    outlines.between(&search, &images, at, [a, b]);
                }
            }
        }
        outlines
    }

    /// Takes up the changes between two lines of sight, one after the other.
    fn between(
        &mut self,
        search: &Search<'_>,
        images: &Images<'_>,
        at: [[f64; 2]; 2],
        met: [&[SurfaceCrossing]; 2],
    ) {
        let mut from = at[0];
        let mut met_from = met[0].to_vec();
        for _ in 0..CHANGES {
            if same(&met_from, met[1]) {
                return;
            }
            let pair = Change {
                at: [from, at[1]],
                met: [met_from, met[1].to_vec()],
            };
            let Some(change) = search.narrowed(pair) else {
                self.ambiguous += 1;
                return;
            };
            match search.lack(&change, images) {
                None => self.explained += 1,
                Some(missing) => self.missing.push(missing),
            }
            let Change {
                at: [_, beyond],
                met: [_, met_beyond],
            } = change;
            (from, met_from) = (beyond, met_beyond);
        }
        self.ambiguous += 1;
    }
}

/// Whether two lines of sight meet the same surfaces from the same sides.
fn same(a: &[SurfaceCrossing], b: &[SurfaceCrossing]) -> bool {
    let one = |(a, b): (&SurfaceCrossing, &SurfaceCrossing)| {
        a.surface == b.surface && a.outwards == b.outwards
    };
    a.len() == b.len() && a.iter().zip(b).all(one)
}

impl Search<'_> {
    /// Places along a line across the window, at random: a chord of the circle around the image.
    fn places(&self, line: usize) -> [[f64; 2]; SIGHTS] {
        let part = |i: usize| ((line as f64 + 0.5) * STEPS[i]).fract();
        let (sin, cos) = (PI * part(0)).sin_cos();
        let off = 2.0 * part(1) - 1.0;
        let half = (1.0 - off * off).sqrt();
        let Window { centre, radius, .. } = self.window;
        std::array::from_fn(|k| {
            let along = half * (2.0 * (k as f64 + part(1)) / SIGHTS as f64 - 1.0);
            [
                centre[0] + radius * (off * cos - along * sin),
                centre[1] + radius * (off * sin + along * cos),
            ]
        })
    }

    /// What the line of sight of an image point meets beyond the near plane.
    fn met(&self, at: [f64; 2]) -> Met {
        let ray = self.window.ray(at);
        let length = ray.direction.norm();
        let least = self.clearance.size * ROUNDING / length;
        let mut met = self.surfaces.crossings(&ray, least)?;
        let nearer = met.iter().filter(|c| c.at <= self.window.near).count();
        // Where the near plane cuts material there is a face that the tree does not have.
        if nearer % 2 == 1 {
            return None;
        }
        met.drain(..nearer);
        let short = |w: &[SurfaceCrossing]| (w[1].at - w[0].at) * length <= self.clearance.sliver;
        (!met.windows(2).any(short)).then_some(met)
    }

    /// The place of one change between two lines of sight.
    fn narrowed(&self, pair: Change) -> Option<Change> {
        let Change {
            at: [mut a, mut b],
            met: [mut met_a, mut met_b],
        } = pair;
        for _ in 0..HALVINGS {
            let middle = [0, 1].map(|i| 0.5 * (a[i] + b[i]));
            let met = self.met(middle)?;
            if same(&met, &met_a) {
                (a, met_a) = (middle, met);
            } else {
                (b, met_b) = (middle, met);
            }
        }
        Some(Change {
            at: [a, b],
            met: [met_a, met_b],
        })
    }

    /// Where the surface that a change begins with falls so steeply to its edge that from one line of
    /// sight to the next it is more than `deep`: the depth down to which the edge may be. That is of
    /// what is met instead, or of the far side of what ends there.
    fn steep_until(&self, change: &Change, index: usize, deep: f64) -> Option<f64> {
        let [first, second] = &change.met;
        let [a, b] = change.at;
        let at = |met: &[SurfaceCrossing]| met.get(index).map_or(f64::INFINITY, |c| c.at);
        let ((own, from), (instead, other)) = match at(first) <= at(second) {
            true => ((first, a), (second, b)),
            false => ((second, b), (first, a)),
        };
        let near = own.get(index)?;
        // What ends there has a far side of its own.
        let until = match own.len() > instead.len() {
            true => own.get(index + 1)?.at,
            false => instead.get(index)?.at,
        };
        // The face may be narrower than the interval: its own slope tells.
        let slope = self.slope([from, other], near);
        // A limb lies about twice as far as the slope next to it says.
        let is_steep = slope.is_nan() || NEAR * slope.abs() > deep;
        is_steep.then_some(until.max(near.at))
    }

    /// How much deeper a surface is met by the second of two lines of sight than by the first, as far
    /// as its slope there tells.
    fn slope(&self, [from, other]: [[f64; 2]; 2], near: &SurfaceCrossing) -> f64 {
        let (ray, beside) = (self.window.ray(from), self.window.ray(other));
        let step = beside.origin - ray.origin + (beside.direction - ray.direction) * near.at;
        self.surfaces.slope(&ray, near, &step)
    }

    /// Whether two lines of sight meet one surface at depths that a fall of it does not explain.
    fn leaps(&self, between: [[f64; 2]; 2], [a, b]: [&SurfaceCrossing; 2], deep: f64) -> bool {
        let fall = (a.at - b.at).abs();
        let slope = || self.slope(between, a).abs();
        fall > deep && fall > NEAR * slope()
    }

    /// What a change lacks; none where a contour explains it.
    fn lack(&self, change: &Change, images: &Images<'_>) -> Option<Missing> {
        let [a, b] = change.at;
        let width = (b[0] - a[0]).hypot(b[1] - a[1]);
        // A round surface lies this much deeper than its limb.
        let deep = |depth: f64| {
            let beside = NEAR * width * self.window.scale(depth);
            DEEP * (beside * self.clearance.size).sqrt()
        };
        let [first, second] = &change.met;
        let unlike = |(a, b): (&SurfaceCrossing, &SurfaceCrossing)| {
            !same(std::slice::from_ref(a), std::slice::from_ref(b))
                || self.leaps(change.at, [a, b], deep(a.at))
        };
        let common = first.iter().zip(second).position(unlike);
        let index = common.unwrap_or(first.len().min(second.len()));
        let depth = [first, second]
            .into_iter()
            .filter_map(|met| met.get(index))
            .fold(f64::INFINITY, |least, c| c.at.min(least));
        let deep = deep(depth);
        let near = NEAR * width + self.clearance.shift / self.window.scale(depth);
        let until = self.steep_until(change, index, deep).unwrap_or(depth);
        let there = |p: &Passing| p.depth[0] - deep <= until && depth <= p.depth[1] + deep;
        // What begins there closer to the eye may be narrower than the interval.
        let before = |p: &Passing| p.depth[1] < depth;
        let lack = if !images.any(a, near, |_| true) {
            Lack::Contour
        } else if !images.any(a, near, there) {
            Lack::Depth
        } else if index == 0 && !images.any(a, near, |p| p.visible && (there(p) || before(p))) {
            Lack::Visible
        } else {
            return None;
        };
        let ray = self.window.ray(a);
        let place = (ray.origin + ray.direction * depth).into();
        Some(Missing { lack, place })
    }
}

impl fmt::Display for Lack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Contour => "no contour",
            Self::Depth => "no contour at its depth",
            Self::Visible => "no visible contour",
        })
    }
}

impl fmt::Display for Outlines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            explained,
            ambiguous,
            missing,
        } = self;
        write!(
            f,
            "{explained} changes between lines of sight have their contour, {ambiguous} are too close to another"
        )?;
        if !missing.is_empty() {
            write!(f, ", {} have none", missing.len())?;
        }
        for Missing { lack, place } in missing.iter().take(NAMED) {
            let [x, y, z] = place;
            write!(f, "; {lack} at ({x:.6}, {y:.6}, {z:.6})")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
