//! The points that a face's chart needs besides its edges: apexes, the middle of a chart, and the cap
//! about the centre of a projection.

use super::{Builder, Corner};
use crate::tessellation::chord_test::APEX;
use nalgebra::{Point2, Point3};
use spade::{PositionInTriangulation, Triangulation};
use std::f64::consts::TAU;

/// The distance from the middle of the chart beyond which the pole of a torus is not added.
const FARTHEST: f64 = (1 << 10) as f64;

/// The number of sides of a cap, whose triangles are congruent.
const RIM: u32 = 6;

impl Builder<'_> {
    /// Adds the apex, or the point opposite to the centre of the projection, which prevents small
    /// triangles from reaching around the sphere. A chord through that point serves as well.
    pub(super) fn add_middle(&mut self) {
        let net = &self.domain.net;
        let at_middle = |c: &Corner| {
            c.at == Point2::origin() || self.fit.is_apex(&self.lines.points[c.point as usize])
        };
        let known = net.vertices().any(|v| at_middle(v.data()));
        let on_chord = match net.locate(spade::Point2::new(0.0, 0.0)) {
            PositionInTriangulation::OnEdge(edge) => net.is_constraint_edge(edge.as_undirected()),
            _ => false,
        };
        if !known && !on_chord {
            let middle = self.lines.add(self.fit.chart.lift(&Point2::origin()));
            self.corner(Point2::origin(), middle);
        }
    }

    /// Adds a pole of a torus, unless the centre of the projection is close to it.
    pub(super) fn add_pole(&mut self, at: Point2<f64>) {
        if at.coords.norm() < FARTHEST {
            self.add_point(at);
        }
    }

    /// Adds the point of the surface at a position in the chart, unless there is a corner or a chord.
    pub(super) fn add_point(&mut self, at: Point2<f64>) {
        let net = &self.domain.net;
        let is_free = match net.locate(spade::Point2::new(at.x, at.y)) {
            PositionInTriangulation::OnEdge(edge) => !net.is_constraint_edge(edge.as_undirected()),
            PositionInTriangulation::OnVertex(_) => false,
            _ => true,
        };
        let near = APEX * (1.0 + at.coords.norm());
        let is_here = |c: &Corner| (c.at - at).norm() <= near;
        if is_free && !net.vertices().any(|v| is_here(v.data())) {
            let point = self.lines.add(self.fit.chart.lift(&at));
            self.corner(at, point);
        }
    }

    /// Adds the rim of a cap about the centre of the projection, and the triangles of the cap.
    pub(super) fn add_cap(&mut self, centre: Point3<f64>, wide: f64) {
        let centre = self.lines.add(centre);
        let away = 1.0 / (0.5 * wide).tan();
        let mut rim = Vec::new();
        for k in 0..RIM {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(RIM)).sin_cos();
            let at = Point2::new(away * cos, away * sin);
            let point = self.lines.add(self.fit.chart.lift(&at));
            let corner = self.corner(at, point);
            self.crowded |= corner.is_none();
            rim.extend(corner.map(|c| (c, point)));
        }
        for (k, &(from, a)) in rim.iter().enumerate() {
            let (to, b) = rim[(k + 1) % rim.len()];
            if self.domain.net.can_add_constraint(from, to) {
                self.domain.net.add_constraint(from, to);
            }
            self.domain.cap.push([b, a, centre]);
        }
    }
}
