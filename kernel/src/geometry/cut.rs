//! Where a curve meets a surface.

use super::curve::Curve;
use super::surface::Surface;
use crate::number::roots::{Zeros, isolate};

/// Where the curve, over `range` of its parameter, meets the surface: isolated parameters with
/// their contact, or everywhere where it lies on the surface. `band` is the resolution.
pub fn cut(curve: &Curve, range: [f64; 2], surface: &Surface, band: f64) -> Zeros {
    let breaks = curve.breaks(range[0], range[1]);
    isolate(&|t| surface.level(curve.jet_over(t)), &breaks, band)
}
