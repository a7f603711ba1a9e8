//! Prisms and revolutions: point membership by the winding number of the figure's outline, and the
//! crossings of a line with the surface of every edge.

use super::polynomial::{quadratic, torus_crossings};
use crate::figure::{ArcTurn, Figure, FigureEdge};
use crate::primitive::RevolutionAngle;
use nalgebra::Vector3;
use premio_kernel::number::rational::{Rational, to_f64};

/// The circle of an arc.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    pub centre: [f64; 2],
    pub radius: f64,
    is_counterclockwise: bool,
}

/// An edge of a figure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub start: [f64; 2],
    pub end: [f64; 2],
    pub circle: Option<Circle>,
}

/// What a figure is swept along.
#[derive(Clone, Copy, Debug)]
pub(super) enum Sweep {
    /// Along z up to a height; lengths grow by `growth` for every unit.
    Along { height: f64, growth: f64 },
    /// About z by an angle in radians; `None` for a whole turn.
    About { angle: Option<f64> },
}

/// A swept figure in f64.
#[derive(Clone, Debug)]
pub(super) struct SectionShape {
    pub edges: Vec<Edge>,
    pub sweep: Sweep,
    bounds: [[f64; 3]; 2],
}

impl Edge {
    fn new(edge: &FigureEdge) -> Self {
        let near = |p: &[Rational; 2]| p.each_ref().map(to_f64);
        Self {
            start: near(&edge.start),
            end: near(&edge.end),
            circle: edge.arc.as_ref().map(|arc| Circle {
                centre: near(&arc.centre),
                radius: to_f64(&arc.radius),
                is_counterclockwise: arc.turn == ArcTurn::Counterclockwise,
            }),
        }
    }

    /// Its share of the winding number about a point.
    fn winding(&self, [x, y]: [f64; 2]) -> i32 {
        let (s, e) = (self.start, self.end);
        let side = (e[0] - s[0]) * (y - s[1]) - (e[1] - s[1]) * (x - s[0]);
        let chord = match (s[1] <= y, e[1] <= y) {
            (true, false) if side > 0.0 => 1,
            (false, true) if side < 0.0 => -1,
            _ => 0,
        };
        let Some(circle) = self.circle else {
            return chord;
        };
        let [dx, dy] = [x - circle.centre[0], y - circle.centre[1]];
        if dx.hypot(dy) >= circle.radius {
            return chord;
        }
        // Between the chord and the arc.
        match circle.is_counterclockwise {
            true if side <= 0.0 => chord + 1,
            false if side >= 0.0 => chord - 1,
            _ => chord,
        }
    }
}

impl SectionShape {
    pub fn prism(figure: &Figure, height: &Rational, top: &Rational) -> Self {
        let [lo, hi] = figure.bounds();
        let (height, k) = (to_f64(height), to_f64(top));
        let low = [0, 1].map(|i| f64::min(lo[i], lo[i] * k));
        let high = [0, 1].map(|i| f64::max(hi[i], hi[i] * k));
        let growth = (k - 1.0) / height;
        Self {
            edges: figure.edges().iter().map(Edge::new).collect(),
            sweep: Sweep::Along { height, growth },
            bounds: [[low[0], low[1], 0.0], [high[0], high[1], height]],
        }
    }

    pub fn revolution(figure: &Figure, angle: Option<&RevolutionAngle>) -> Self {
        let [lo, hi] = figure.bounds();
        let angle = angle.map(|angle| to_f64(angle.degrees()).to_radians());
        Self {
            edges: figure.edges().iter().map(Edge::new).collect(),
            sweep: Sweep::About { angle },
            bounds: [[-hi[0], -hi[0], lo[1]], [hi[0], hi[0], hi[1]]],
        }
    }

    pub fn bounds(&self) -> [[f64; 3]; 2] {
        self.bounds
    }

    /// Whether a point of the bounding box is inside.
    pub fn contains(&self, p: &Vector3<f64>) -> bool {
        let at = match self.sweep {
            Sweep::Along { growth, .. } => {
                let scale = 1.0 + growth * p.z;
                if scale <= 0.0 {
                    return false;
                }
                [p.x / scale, p.y / scale]
            }
            Sweep::About { angle } => {
                let turned = p.y.atan2(p.x).rem_euclid(std::f64::consts::TAU);
                if angle.is_some_and(|angle| turned > angle) {
                    return false;
                }
                [p.x.hypot(p.y), p.z]
            }
        };
        self.edges.iter().map(|edge| edge.winding(at)).sum::<i32>() != 0
    }

    /// Passes the parameters in (-half, half) at which a line may cross the boundary to `add`.
    pub fn crossings(
        &self,
        o: &Vector3<f64>,
        d: &Vector3<f64>,
        half: f64,
        add: &mut dyn FnMut(f64),
    ) {
        for edge in &self.edges {
            match self.sweep {
                Sweep::Along { growth, .. } => extruded(edge, growth, o, d, add),
                Sweep::About { .. } => revolved(edge, o, d, half, add),
            }
        }
        if let Sweep::About { angle: Some(angle) } = self.sweep {
            for (sin, cos) in [(0.0, 1.0), angle.sin_cos()] {
                add((sin * o.x - cos * o.y) / (cos * d.y - sin * d.x));
            }
        }
    }
}

fn extruded(
    edge: &Edge,
    growth: f64,
    o: &Vector3<f64>,
    d: &Vector3<f64>,
    add: &mut dyn FnMut(f64),
) {
    let scale = 1.0 + growth * o.z;
    match edge.circle {
        None => {
            let [s, e] = [edge.start, edge.end];
            let [nx, ny] = [e[1] - s[1], s[0] - e[0]];
            let level = nx * s[0] + ny * s[1];
            let along = nx * d.x + ny * d.y - level * growth * d.z;
            add((level * scale - nx * o.x - ny * o.y) / along);
        }
        Some(circle) => {
            let [cx, cy] = circle.centre;
            let (r, k) = (circle.radius * scale, circle.radius * growth * d.z);
            cone([o.x - cx, o.y - cy], d, r, k, add);
        }
    }
}

/// The crossings with the surface at the distance `r + k t` from an axis along z.
fn cone([x, y]: [f64; 2], d: &Vector3<f64>, r: f64, k: f64, add: &mut dyn FnMut(f64)) {
    let a = d.x * d.x + d.y * d.y - k * k;
    let b = x * d.x + y * d.y - r * k;
    let c = x * x + y * y - r * r;
    quadratic(a, b, c).into_iter().for_each(add);
}

fn revolved(edge: &Edge, o: &Vector3<f64>, d: &Vector3<f64>, half: f64, add: &mut dyn FnMut(f64)) {
    let [s, e] = [edge.start, edge.end];
    match edge.circle {
        None if s[1] == e[1] => add((s[1] - o.z) / d.z),
        None => {
            let slope = (e[0] - s[0]) / (e[1] - s[1]);
            cone([o.x, o.y], d, s[0] + slope * (o.z - s[1]), slope * d.z, add);
        }
        Some(circle) => {
            let ([major, z], r) = (circle.centre, circle.radius);
            let o = Vector3::new(o.x, o.y, o.z - z);
            if major == 0.0 {
                let c = o.norm_squared() - r * r;
                quadratic(d.norm_squared(), o.dot(d), c)
                    .into_iter()
                    .for_each(add);
                return;
            }
            torus_crossings(&o, d, [major, r], half).for_each(add);
        }
    }
}
