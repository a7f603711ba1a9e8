//! Finds missing contours: the surfaces along a line of sight change at contours only.
//!
//! Lines are drawn across the image, and lines of sight are followed along them. Where two
//! neighbours cross different surfaces of the tree, bisection finds the position of the change. A
//! contour must pass there at the depth of the change, and a visible one if the closest surface
//! changes.

use super::images::{Images, Passing};
use super::window::Window;
use premio_csg::ray_casting::{Clearance, RayOracle, SurfaceCrossing, Surfaces};
use premio_kernel::number::predicates::ROUNDING;
use premio_visibility::Contours;
use premio_visibility::camera::projection::Projection;
use std::f64::consts::PI;
use std::fmt;

/// The number of lines drawn across the image.
const LINES: usize = 24;
/// The number of lines of sight along each.
const SIGHTS: usize = 32;
/// Powers of the plastic number, the steps of Roberts's sequence in the unit square.
const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];
/// The number of changes searched for between two neighbouring lines of sight.
const CHANGES: usize = 8;
/// The number of bisections: to less than a millionth of the window.
const HALVINGS: usize = 17;
/// The distance within which a contour must pass, in multiples of the remaining interval.
const NEAR: f64 = 4.0;
/// The allowed depth error of a contour, in multiples of a curved surface's depth close to its
/// limb.
const DEEP: f64 = 16.0;
/// The number of missing contours that are reported individually.
const NAMED: usize = 5;

/// What is missing at a position in the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lack {
    /// No contour passes.
    Contour,
    /// Contours pass, but none at the depth of the change.
    Depth,
    /// The contour there is marked as hidden, but nothing is in front of it.
    Visible,
}

/// A change of the surfaces along lines of sight that no contour explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Missing {
    /// What is missing.
    pub lack: Lack,
    /// The position of the change in the part's frame.
    pub place: [f64; 3],
}

/// The changes found along lines across an image.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outlines {
    /// The number of changes with a contour.
    pub explained: usize,
    /// The number of changes too close to something else.
    pub ambiguous: usize,
    /// The changes without a contour.
    pub missing: Vec<Missing>,
}

/// The surfaces that a line of sight hits; `None` close to where surfaces touch.
type Hits = Option<Vec<SurfaceCrossing>>;

struct Search<'a> {
    surfaces: Surfaces<'a>,
    window: &'a Window,
    clearance: &'a Clearance,
}

/// Two neighbouring lines of sight that hit different surfaces.
struct Change {
    at: [[f64; 2]; 2],
    hits: [Vec<SurfaceCrossing>; 2],
}

impl Outlines {
    /// Searches for the contours of a view.
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
            let hits = places.map(|at| search.hits(at));
            for k in 1..SIGHTS {
                if let (Some(a), Some(b)) = (&hits[k - 1], &hits[k]) {
                    let at = [places[k - 1], places[k]];
                    outlines.between(&search, &images, at, [a, b]);
                }
            }
        }
        outlines
    }

    /// Records the changes between two lines of sight, one after the other.
    fn between(
        &mut self,
        search: &Search<'_>,
        images: &Images<'_>,
        at: [[f64; 2]; 2],
        hits: [&[SurfaceCrossing]; 2],
    ) {
        let mut from = at[0];
        let mut hits_from = hits[0].to_vec();
        for _ in 0..CHANGES {
            if same(&hits_from, hits[1]) {
                return;
            }
            let pair = Change {
                at: [from, at[1]],
                hits: [hits_from, hits[1].to_vec()],
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
                hits: [_, hits_beyond],
            } = change;
            (from, hits_from) = (beyond, hits_beyond);
        }
        self.ambiguous += 1;
    }
}

/// Whether two lines of sight hit the same surfaces from the same sides.
fn same(a: &[SurfaceCrossing], b: &[SurfaceCrossing]) -> bool {
    let one = |(a, b): (&SurfaceCrossing, &SurfaceCrossing)| {
        a.surface == b.surface && a.outwards == b.outwards
    };
    a.len() == b.len() && a.iter().zip(b).all(one)
}

impl Search<'_> {
    /// Points along a random line across the window: a chord of the circle around the image.
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

    /// The surfaces that the line of sight of an image point hits beyond the near plane.
    fn hits(&self, at: [f64; 2]) -> Hits {
        let ray = self.window.ray(at);
        let length = ray.direction.norm();
        let least = self.clearance.size * ROUNDING / length;
        let mut hits = self.surfaces.crossings(&ray, least)?;
        let nearer = hits.iter().filter(|c| c.at <= self.window.near).count();
        // Where the near plane cuts material there is a face that the tree does not have.
        if nearer % 2 == 1 {
            return None;
        }
        hits.drain(..nearer);
        let short = |w: &[SurfaceCrossing]| (w[1].at - w[0].at) * length <= self.clearance.sliver;
        (!hits.windows(2).any(short)).then_some(hits)
    }

    /// The position of one change between two lines of sight.
    fn narrowed(&self, pair: Change) -> Option<Change> {
        let Change {
            at: [mut a, mut b],
            hits: [mut hits_a, mut hits_b],
        } = pair;
        for _ in 0..HALVINGS {
            let middle = [0, 1].map(|i| 0.5 * (a[i] + b[i]));
            let hits = self.hits(middle)?;
            if same(&hits, &hits_a) {
                (a, hits_a) = (middle, hits);
            } else {
                (b, hits_b) = (middle, hits);
            }
        }
        Some(Change {
            at: [a, b],
            hits: [hits_a, hits_b],
        })
    }

    /// The depth down to which the edge of a surface may lie, if the surface that a change begins
    /// with is steep: if its depth changes by more than `deep` between the two lines of sight. It
    /// is the depth of what is hit instead, or of the far side of what ends there.
    fn steep_until(&self, change: &Change, index: usize, deep: f64) -> Option<f64> {
        let [first, second] = &change.hits;
        let [a, b] = change.at;
        let at = |hits: &[SurfaceCrossing]| hits.get(index).map_or(f64::INFINITY, |c| c.at);
        let ((own, from), (instead, other)) = match at(first) <= at(second) {
            true => ((first, a), (second, b)),
            false => ((second, b), (first, a)),
        };
        let near = own.get(index)?;
        // A body that ends there has a far side of its own.
        let until = match own.len() > instead.len() {
            true => own.get(index + 1)?.at,
            false => instead.get(index)?.at,
        };
        // The face may be narrower than the interval, so its own slope is used.
        let slope = self.slope([from, other], near);
        // A limb is about twice as far as the slope close to it indicates.
        let is_steep = slope.is_nan() || NEAR * slope.abs() > deep;
        is_steep.then_some(until.max(near.at))
    }

    /// The depth difference of a surface between the second of two lines of sight and the first,
    /// extrapolated from its slope at the first.
    fn slope(&self, [from, other]: [[f64; 2]; 2], near: &SurfaceCrossing) -> f64 {
        let (ray, second) = (self.window.ray(from), self.window.ray(other));
        let step = second.origin - ray.origin + (second.direction - ray.direction) * near.at;
        self.surfaces.slope(&ray, near, &step)
    }

    /// Whether two lines of sight hit one surface at depths that its slope does not explain.
    fn leaps(&self, between: [[f64; 2]; 2], [a, b]: [&SurfaceCrossing; 2], deep: f64) -> bool {
        let fall = (a.at - b.at).abs();
        let slope = || self.slope(between, a).abs();
        fall > deep && fall > NEAR * slope()
    }

    /// Whether the surfaces of a change are at one depth within rounding. Rounding decides which of two
    /// tangent surfaces is hit, within the square root of it from where they touch.
    fn is_tie(&self, change: &Change, index: usize) -> bool {
        let [first, second] = &change.hits;
        let (Some(a), Some(b)) = (first.get(index), second.get(index)) else {
            return false;
        };
        let length = self.window.ray(change.at[0]).direction.norm();
        (a.at - b.at).abs() * length <= ROUNDING * self.clearance.size
    }

    /// What is missing at a change; `None` if a contour explains it.
    fn lack(&self, change: &Change, images: &Images<'_>) -> Option<Missing> {
        let [a, b] = change.at;
        let width = (b[0] - a[0]).hypot(b[1] - a[1]);
        // The depth of a curved surface relative to its limb.
        let deep = |depth: f64| {
            let lateral = NEAR * width * self.window.scale(depth);
            DEEP * (lateral * self.clearance.size).sqrt()
        };
        let [first, second] = &change.hits;
        let unlike = |(a, b): (&SurfaceCrossing, &SurfaceCrossing)| {
            !same(std::slice::from_ref(a), std::slice::from_ref(b))
                || self.leaps(change.at, [a, b], deep(a.at))
        };
        let common = first.iter().zip(second).position(unlike);
        let index = common.unwrap_or(first.len().min(second.len()));
        let depth = [first, second]
            .into_iter()
            .filter_map(|hits| hits.get(index))
            .fold(f64::INFINITY, |least, c| c.at.min(least));
        let deep = deep(depth);
        let scale = self.window.scale(depth);
        let mut near = NEAR * width + self.clearance.shift / scale;
        if self.is_tie(change, index) {
            near += ROUNDING.sqrt() * self.clearance.size / scale;
        }
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
