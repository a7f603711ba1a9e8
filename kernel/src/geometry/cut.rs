//! Where a curve meets a surface.

use super::bounds::Box3;
use super::curve::Curve;
use super::surface::Surface;
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::roots::{Contact, Function, Root, Zeros, isolate, isolate_closely, probes};

/// How far above a surface a curve runs.
struct Height<'a> {
    curve: &'a Curve,
    surface: &'a Surface,
}

impl Function for Height<'_> {
    fn over(&self, t: Interval) -> Jet<Interval> {
        self.surface.level(self.curve.jet_over(t))
    }

    fn reach(&self, t: Interval) -> Interval {
        match self.curve.box_over(t) {
            Some(p) => self.surface.level(p),
            None => Interval::ENTIRE,
        }
    }

    fn at(&self, t: f64) -> Jet<f64> {
        self.surface.level(self.curve.jet(t))
    }

    fn value(&self, t: f64) -> f64 {
        self.surface.level(self.curve.point(t).into())
    }
}

/// Where the curve, over `range` of its parameter, meets the surface: isolated parameters with
/// their contact, or everywhere where it lies on the surface. `band` is the resolution.
pub fn cut(curve: &Curve, range: [f64; 2], surface: &Surface, band: f64) -> Zeros {
    if lies_on(curve, range, surface, band) {
        return Zeros::Everywhere;
    }
    let breaks = curve.breaks(range[0], range[1]);
    match isolate(&Height { curve, surface }, &breaks, band) {
        Zeros::Everywhere => touching(range),
        zeros => zeros,
    }
}

/// The same over a part of a curve that does not lie on the surface, however short: the roots, and
/// all misses that are close calls.
pub fn roots(
    curve: &Curve,
    range: [f64; 2],
    surface: &Surface,
    band: f64,
) -> (Vec<Root>, Vec<(f64, f64)>) {
    let breaks = curve.breaks(range[0], range[1]);
    let zeros = match isolate_closely(&Height { curve, surface }, &breaks, band) {
        Zeros::Everywhere => touching(range),
        zeros => zeros,
    };
    match zeros {
        Zeros::At { roots, misses } => (roots, misses),
        Zeros::Everywhere => (Vec::new(), Vec::new()),
    }
}

/// One touching root over the whole range.
fn touching([lo, hi]: [f64; 2]) -> Zeros {
    Zeros::At {
        roots: vec![Root {
            t: 0.5 * (lo + hi),
            lo,
            hi,
            contact: Contact::Touching,
            margin: Some(0.0),
        }],
        misses: Vec::new(),
    }
}

/// Whether a point of a box can be within `margin` of a surface, by its distance and by its level.
pub fn comes_near(surface: &Surface, b: &Box3, margin: f64) -> bool {
    // The distance of a surface changes by no more than the way.
    if surface.distance(&b.centre()).abs() > 0.5 * b.diagonal() + margin {
        return false;
    }
    let level = surface.level([0, 1, 2].map(|i| Interval::new(b.min[i], b.max[i])));
    level.lo <= margin && level.hi >= -margin
}

/// Whether the curve lies on the surface, within the band.
pub fn lies_on(curve: &Curve, [lo, hi]: [f64; 2], surface: &Surface, band: f64) -> bool {
    probes().all(|part| surface.distance(&curve.point(lo + (hi - lo) * part)).abs() <= band)
}
