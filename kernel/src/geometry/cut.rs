//! Where a curve meets a surface.

use super::curve::Curve;
use super::surface::Surface;
use crate::number::roots::{Zeros, isolate};

/// Where the curve, over `range` of its parameter, meets the surface: isolated parameters with
/// their contact, or everywhere where it lies on the surface. `band` is the resolution.
pub fn cut(curve: &Curve, range: [f64; 2], surface: &Surface, band: f64) -> Zeros {
    if lies_on(curve, range, surface, band) {
        return Zeros::Everywhere;
    }
    let breaks = curve.breaks(range[0], range[1]);
    isolate(&|t| surface.level(curve.jet_over(t)), &breaks, band)
}

/// The points at which a curve is asked whether it lies on a surface: more than twice the number
/// of zeros that any of the curves can have on any of the surfaces, so that one that is within the
/// band at all of them is so in between.
const PROBES: u32 = 67;

/// Fractions of a range: the first few already lie far apart, by steps of the golden section.
fn probes() -> impl Iterator<Item = f64> {
    (1..=PROBES).map(|k| (f64::from(k) * 0.618_033_988_749_895).fract())
}

fn lies_on(curve: &Curve, [lo, hi]: [f64; 2], surface: &Surface, band: f64) -> bool {
    probes().all(|part| surface.distance(&curve.point(lo + (hi - lo) * part)).abs() <= band)
}
