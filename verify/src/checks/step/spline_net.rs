//! The control net of a rational B-spline surface.

use super::net_ellipse::{AROUND, SAME};
use super::oval::OvalSurface;
use super::ruled::RuledSurface;
use super::surface::SurfaceForm;
use nalgebra::Point3;
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, TAU};

/// The control points and weights by rows, along the second parameter, and both sets of knots.
#[derive(Clone, Debug)]
pub struct SplineNet {
    pub points: Vec<Vec<Point3<f64>>>,
    pub weights: Vec<Vec<f64>>,
    pub degrees: [f64; 2],
    pub multiplicities: [Vec<f64>; 2],
    pub knots: [Vec<f64>; 2],
}

/// The weight of a control point of arcs of a quarter turn.
fn weight(k: usize) -> f64 {
    match k.is_multiple_of(2) {
        true => 1.0,
        false => FRAC_1_SQRT_2,
    }
}

impl SplineNet {
    /// The surface between two similar ellipses, or the ellipsoid, that it represents.
    pub fn form(&self) -> Option<SurfaceForm> {
        let [first, second] = &self.multiplicities;
        let is_round = self.points.len() == AROUND
            && self.degrees[0] == 2.0
            && *first == [3.0, 2.0, 2.0, 2.0, 3.0]
            && is_by_quarters(&self.knots[0], first.len());
        let columns = self.points.first()?.len();
        let is_full = self.points.iter().all(|row| row.len() == columns)
            && self.weights.len() == AROUND
            && self.weights.iter().all(|row| row.len() == columns);
        if !is_round || !is_full {
            return None;
        }
        let is_bent = self.degrees[1] == 2.0;
        let is_weighted = self.weights.iter().enumerate().all(|(k, row)| {
            let expected = |l: usize| weight(k) * if is_bent { weight(l) } else { 1.0 };
            let mut off = row.iter().enumerate().map(|(l, w)| w - expected(l));
            off.all(|off| off.abs() <= SAME)
        });
        let start = *self.knots[0].first()?;
        match (columns, &second[..]) {
            (2, [2.0, 2.0]) if self.degrees[1] == 1.0 && is_weighted => {
                let heights = <[f64; 2]>::try_from(self.knots[1].clone()).ok()?;
                let rings = [self.column(0)?, self.column(1)?];
                RuledSurface::new(&rings, start, heights).map(SurfaceForm::Ruled)
            }
            (5, [3.0, 2.0, 3.0]) if is_bent && is_weighted => {
                if !is_by_quarters(&self.knots[1], second.len()) {
                    return None;
                }
                let columns = [0, 1, 2, 3, 4].map(|l| self.column(l));
                let [
                    Some(south),
                    Some(low),
                    Some(equator),
                    Some(high),
                    Some(north),
                ] = columns
                else {
                    return None;
                };
                let rings = [south, low, equator, high, north];
                OvalSurface::new(&rings, start, self.knots[1][0]).map(SurfaceForm::Oval)
            }
            _ => None,
        }
    }

    fn column(&self, l: usize) -> Option<[Point3<f64>; AROUND]> {
        let points: Vec<Point3<f64>> = self.points.iter().map(|row| row[l]).collect();
        points.try_into().ok()
    }
}

/// Whether knots are a quarter turn apart.
fn is_by_quarters(knots: &[f64], count: usize) -> bool {
    let Some(start) = knots.first() else {
        return false;
    };
    let off = |(knot, k): (&f64, u32)| knot - start - FRAC_PI_2 * f64::from(k);
    knots.len() == count
        && knots
            .iter()
            .zip(0u32..)
            .map(off)
            .all(|off| off.abs() <= SAME * TAU)
}
