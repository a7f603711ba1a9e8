//! The number of slices of an extrusion that is twisted or scaled unevenly, as OpenSCAD counts them.
//!
//! Without `slices`, `$fn` gives the slices of a whole turn. Without `$fn`, the longest path of a
//! corner is cut into pieces of at most `$fs`, and the twist into steps of at most `$fa`; the
//! smaller number counts.

use premio_kernel::number::rational::{Rational, to_f64};

use super::super::error::SpannedError;
use super::arguments::Arguments;
use super::facets::Fineness;
use crate::figure::FigurePoint;

/// The largest number of slices.
const MAX_SLICES: f64 = 10_000.0;

/// The most degrees of twist in a slice.
const MAX_STEP: f64 = 120.0;

/// The paths of an extrusion's corners.
struct CornerPaths {
    /// The greatest distance of a corner from the axis, before it is scaled.
    radius: f64,
    /// The greatest distance by which the scale moves a corner.
    shift: f64,
    height: f64,
    /// The angle of the top in degrees.
    degrees: f64,
    /// The scale of the top.
    top: [f64; 2],
}

/// The number of slices of an extrusion of these outlines.
pub(super) fn slices(
    outlines: &[Vec<FigurePoint>],
    height: &Rational,
    degrees: &Rational,
    top: &[Rational; 2],
    arguments: &Arguments,
) -> Result<usize, SpannedError> {
    let count = match arguments.find("slices") {
        Some(slices) => to_f64(slices.number()?),
        None => {
            let paths = CornerPaths::new(outlines, height, degrees, top);
            paths.slices(Fineness::new(arguments)?)
        }
    };
    Ok(count.clamp(1.0, MAX_SLICES) as usize)
}

impl CornerPaths {
    fn new(
        outlines: &[Vec<FigurePoint>],
        height: &Rational,
        degrees: &Rational,
        top: &[Rational; 2],
    ) -> Self {
        let top = top.each_ref().map(to_f64);
        let corners = outlines.iter().flatten();
        let [mut radius, mut shift] = [0.0f64; 2];
        for [x, y] in corners.map(|corner| corner.each_ref().map(to_f64)) {
            radius = radius.max(x.hypot(y));
            shift = shift.max((x - x * top[0]).hypot(y - y * top[1]));
        }
        Self {
            radius,
            shift,
            height: to_f64(height),
            degrees: to_f64(degrees).abs(),
            top,
        }
    }

    fn slices(&self, fineness: Fineness) -> f64 {
        let [x, y] = self.top;
        let is_even = x.total_cmp(&y).is_eq();
        let Fineness {
            sides,
            angle,
            length,
        } = fineness;
        if self.degrees.total_cmp(&0.0).is_eq() {
            return match sides {
                Some(sides) => sides.floor(),
                None => (self.shift.hypot(self.height) / length).ceil(),
            };
        }
        let least = (self.degrees / MAX_STEP).ceil();
        let count = match sides {
            Some(sides) => (self.degrees * sides / 360.0).ceil(),
            None => {
                let path = match is_even && x.total_cmp(&1.0).is_ne() {
                    true => self.spiral(),
                    false => self.degrees.to_radians() * self.radius,
                };
                let by_length = (path.hypot(self.height) / length).ceil();
                by_length.min((self.degrees / angle).ceil())
            }
        };
        count.max(least)
    }

    /// The length of the outermost corner's path in the plane, where the scale is equal in all
    /// directions: a part of an Archimedean spiral.
    fn spiral(&self) -> f64 {
        let turned = self.degrees.to_radians();
        let factor = self.top[0];
        let outer = factor.max(1.0);
        let end = turned * outer / (outer - factor.min(1.0));
        let from_centre = |angle: f64| (angle * angle.hypot(1.0) + angle.asinh()) / 2.0;
        self.radius / end * (from_centre(end) - from_centre(end - turned))
    }
}
