//! Tests whether flat pieces approximate a surface.

use super::Accuracy;
use super::charts::Chart;
use crate::geometry::surface::Surface;
use nalgebra::{Point2, Point3, Vector3};

/// The test whether sides and triangles approximate a surface.
pub(super) struct ChordTest<'a> {
    /// The surface.
    pub surface: &'a Surface,
    /// Its chart.
    pub chart: &'a Chart,
    /// The accuracy required.
    pub accuracy: &'a Accuracy,
}

/// The distance from an apex, relative to the deviation or to the triangle, within which a vertex
/// is at the apex.
pub(super) const APEX: f64 = 1.0 / (1 << 16) as f64;

impl ChordTest<'_> {
    /// Whether a side or a triangle with these corners is within the accuracy of the surface.
    /// `middle` is the position in the chart of the surface point tested. The corners must lie
    /// close to the tangent plane there, and the normal must turn little between it and them. The
    /// corners' own middle must lie close to the surface as well: where a thin tube bends sideways,
    /// a chord leaves the tube within the tangent plane.
    pub fn contains(&self, middle: &Point2<f64>, corners: &[Point3<f64>]) -> bool {
        let on = self.chart.lift(middle);
        let normal = self.surface.normal(&on);
        let sum: Vector3<f64> = corners.iter().map(|p| p.coords).sum();
        let flat = Point3::from(sum / corners.len() as f64);
        self.surface.distance(&flat).abs() <= self.accuracy.deviation
            && corners.iter().all(|p| {
                let turned = || normal.angle(&self.surface.normal(p));
                normal.dot(&(on - p)).abs() <= self.accuracy.deviation
                    && (self.is_apex(p) || turned() <= self.accuracy.angle)
            })
    }

    /// The position at which a side between two chart positions, which stand for `points`, leaves
    /// the surface: its middle, or the point closest to the middle of the chart. `None` if it does
    /// not.
    pub fn leaves(&self, ends: [Point2<f64>; 2], points: &[Point3<f64>; 2]) -> Option<Point2<f64>> {
        let middle = nalgebra::center(&ends[0], &ends[1]);
        if !self.contains(&middle, points) {
            return Some(middle);
        }
        let nearest = self.chart.nearest_to_middle(ends)?;
        (from_segment(&self.chart.lift(&nearest), points) > self.accuracy.deviation)
            .then_some(nearest)
    }

    /// Whether a point is a cone's apex or a torus's pole, where there is no normal.
    pub fn is_apex(&self, p: &Point3<f64>) -> bool {
        let near = self.accuracy.deviation * APEX;
        let mut apexes = self.surface.apexes();
        apexes.any(|apex| (apex - p).norm() <= near)
    }
}

/// The distance of a point from a segment.
fn from_segment(p: &Point3<f64>, [a, b]: &[Point3<f64>; 2]) -> f64 {
    let (along, away) = (b - a, p - a);
    let part = away.dot(&along) / along.norm_squared();
    (away - along * part.clamp(0.0, 1.0)).norm()
}
