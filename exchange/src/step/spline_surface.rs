//! Elliptic surfaces as rational B-spline surfaces, which are exact.

use super::part21::{Id, List, Reals};
use super::shape::Shape;
use crate::two_manifold::SeamedFace;
use nalgebra::Vector3;
use premio_kernel::geometry::ellipsoid::Ellipsoid;
use premio_kernel::geometry::surface::Surface;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

/// The number of points of an edge at which its height is taken.
const PLACES: u32 = 16;

/// The part of the height of a face by which its surface continues beyond its edges.
const MARGIN: f64 = 0.25;

impl Shape<'_, '_> {
    /// The elliptic surface around a face, by the circle of its angle and the range of its heights.
    pub(super) fn elliptic_surface(&mut self, face: &SeamedFace) -> Id {
        let surface = &face.window.surface;
        let is_cone = matches!(surface, Surface::EllipticCone(_));
        let [low, high] = self.heights(face, is_cone);
        let start = face.window.starts[0];
        let origin = surface.frame().origin;
        let mut rows = Vec::with_capacity(CONTROLS);
        for k in 0..CONTROLS {
            let quarter = start + FRAC_PI_2 * (k / 2) as f64;
            let points = [low, high].map(|height| {
                let axis = origin + surface.frame().z * height;
                let radius = |u: f64| surface.point(u, height) - axis;
                let out: Vector3<f64> = match k % 2 {
                    0 => radius(quarter),
                    _ => radius(quarter) + radius(quarter + FRAC_PI_2),
                };
                self.point(&(axis + out))
            });
            rows.push(List(&points).to_string());
        }
        let weights = (0..CONTROLS).map(|k| match k % 2 {
            0 => "(1.,1.)".to_owned(),
            _ => Reals(&[FRAC_1_SQRT_2; 2]).to_string(),
        });
        let weights: Vec<String> = weights.collect();
        let knots: Vec<f64> = (0..5).map(|k| start + FRAC_PI_2 * f64::from(k)).collect();
        self.exchange.add(format_args!(
            "(BOUNDED_SURFACE()B_SPLINE_SURFACE(2,1,({}),.UNSPECIFIED.,.T.,.F.,.F.)\
             B_SPLINE_SURFACE_WITH_KNOTS((3,2,2,2,3),(2,2),{},{},.UNSPECIFIED.)\
             GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(({}))\
             REPRESENTATION_ITEM('')SURFACE())",
            rows.join(","),
            Reals(&knots),
            Reals(&[low, high]),
            weights.join(",")
        ))
    }

    /// An ellipsoid from pole to pole, by the circle of its longitude from a start.
    pub(super) fn ellipsoid(&mut self, s: &Ellipsoid, start: f64) -> Id {
        let [x, y, z] = s.conjugate_radii();
        // The corners of the squares around the unit circles: of longitude, and of half a meridian.
        let corner = |from: f64, k: usize| {
            let quarter = |k: usize| (from + FRAC_PI_2 * (k / 2) as f64).sin_cos();
            let ((sin, cos), (next_sin, next_cos)) = (quarter(k), quarter(k + 2));
            match k % 2 {
                0 => (sin, cos),
                _ => (sin + next_sin, cos + next_cos),
            }
        };
        let weight = |k: usize| match k.is_multiple_of(2) {
            true => 1.0,
            false => FRAC_1_SQRT_2,
        };
        let (mut rows, mut weights) = (Vec::new(), Vec::new());
        for k in 0..CONTROLS {
            let (sin, cos) = corner(start, k);
            let out = x * cos + y * sin;
            let points: Vec<Id> = (0..CONTROLS_OF_HALF)
                .map(|l| {
                    let (up, along) = corner(-FRAC_PI_2, l);
                    self.point(&(s.frame.origin + out * along + z * up))
                })
                .collect();
            rows.push(List(&points).to_string());
            let row: Vec<f64> = (0..CONTROLS_OF_HALF)
                .map(|l| weight(k) * weight(l))
                .collect();
            weights.push(Reals(&row).to_string());
        }
        let around: Vec<f64> = (0..5).map(|k| start + FRAC_PI_2 * f64::from(k)).collect();
        let along = [-FRAC_PI_2, 0.0, FRAC_PI_2];
        self.exchange.add(format_args!(
            "(BOUNDED_SURFACE()B_SPLINE_SURFACE(2,2,({}),.UNSPECIFIED.,.T.,.F.,.F.)\
             B_SPLINE_SURFACE_WITH_KNOTS((3,2,2,2,3),(3,2,3),{},{},.UNSPECIFIED.)\
             GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(({}))\
             REPRESENTATION_ITEM('')SURFACE())",
            rows.join(","),
            Reals(&around),
            Reals(&along),
            weights.join(",")
        ))
    }

    /// The heights between which a face lies, with a margin; a cone from its apex if the face comes
    /// close to it.
    fn heights(&self, face: &SeamedFace, is_cone: bool) -> [f64; 2] {
        let frame = face.window.surface.frame();
        let edges = face
            .loops
            .iter()
            .flatten()
            .map(|half| &self.seamed.edges[half.edge]);
        let heights = edges.flat_map(|edge| {
            let [lo, hi] = edge.range;
            let at = move |k: u32| lo + (hi - lo) * f64::from(k) / f64::from(PLACES);
            (0..=PLACES).map(move |k| frame.coordinates(&edge.curve.point(at(k))).z)
        });
        let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], z| {
            [lo.min(z), hi.max(z)]
        });
        let margin = MARGIN * (high - low);
        match is_cone && low <= 2.0 * margin {
            true => [0.0, high + margin],
            false => [low - margin, high + margin],
        }
    }
}

/// The number of control points of a circle of four quarters.
const CONTROLS: usize = 9;

/// The number of control points of half a circle.
const CONTROLS_OF_HALF: usize = 5;
