//! Whether flat pieces follow a surface.

use super::Accuracy;
use super::charts::Chart;
use crate::geometry::surface::Surface;
use nalgebra::{Point2, Point3};

/// Asks whether sides and triangles follow a surface.
pub(super) struct ChordTest<'a> {
    /// The surface.
    pub surface: &'a Surface,
    /// Where it is laid out.
    pub chart: &'a Chart,
    /// How near they have to be.
    pub accuracy: &'a Accuracy,
}

/// A vertex this near to an apex, as a part of the deviation or of a triangle, is at the apex.
pub(super) const APEX: f64 = 1.0 / (1 << 16) as f64;

impl ChordTest<'_> {
    /// Whether a side or a triangle with these corners is within the accuracy of the surface at the
    /// point of it that its middle in the chart stands for: the corners lie in the plane that is
    /// tangent there, and the normal turns little from there to them.
    pub fn contains(&self, middle: &Point2<f64>, corners: &[Point3<f64>]) -> bool {
        let on = self.chart.lift(middle);
        let normal = self.surface.normal(&on);
        corners.iter().all(|p| {
            let turned = || normal.angle(&self.surface.normal(p));
            normal.dot(&(on - p)).abs() <= self.accuracy.deviation
                && (self.is_apex(p) || turned() <= self.accuracy.angle)
        })
    }

    /// Where a side between two places of the chart, which stand for these points, leaves the
    /// surface: at its middle, or where it comes nearest to the middle of the chart.
    pub fn leaves(&self, ends: [Point2<f64>; 2], points: &[Point3<f64>; 2]) -> Option<Point2<f64>> {
        let middle = nalgebra::center(&ends[0], &ends[1]);
        if !self.contains(&middle, points) {
            return Some(middle);
        }
        let nearest = self.chart.nearest_to_middle(ends)?;
        (from_segment(&self.chart.lift(&nearest), points) > self.accuracy.deviation)
            .then_some(nearest)
    }

    /// Whether a point is a cone's apex, where there is no normal.
    pub fn is_apex(&self, p: &Point3<f64>) -> bool {
        let near = self.accuracy.deviation * APEX;
        matches!(self.surface, Surface::Cone(c) if (c.frame.origin - p).norm() <= near)
    }
}

/// How far a point is from a segment.
fn from_segment(p: &Point3<f64>, [a, b]: &[Point3<f64>; 2]) -> f64 {
    let (along, away) = (b - a, p - a);
    let part = away.dot(&along) / along.norm_squared();
    (away - along * part.clamp(0.0, 1.0)).norm()
}
