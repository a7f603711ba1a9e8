//! Finds where a face leaves room for a seam.

use crate::parameters::ParameterWindow;
use nalgebra::{Point2, Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{EdgeId, FaceId};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Surface, turn};
use premio_kernel::geometry::torus_curve::wrap;
use std::f64::consts::TAU;

/// Points along the edges of a face, edge by edge.
#[derive(Debug)]
pub(super) struct Samples {
    edges: Vec<Sampled>,
    /// The points where edges touch.
    touches: Vec<Point3<f64>>,
}

#[derive(Debug)]
struct Sampled {
    points: Vec<Point3<f64>>,
    /// Whether the last point equals the first without being a vertex.
    closed: bool,
}

/// The number of steps into which a smooth piece of a curve is divided.
const STEPS: u32 = 16;

/// The distance from an edge's ends, relative to its range, at which it is sampled in their place:
/// at an apex the angle is undefined.
const INNER: f64 = 1.0 / (1 << 16) as f64;

/// The number of candidate seams.
const TRIED: usize = 24;

impl Samples {
    /// Samples of a face's edges, which show how often they turn around the surface's axis.
    pub fn new(
        brep: &Brep,
        face: FaceId,
        edges: impl Iterator<Item = EdgeId>,
        resolution: f64,
    ) -> Self {
        let surface = *brep.surface(face);
        let near_apexes = ApexSurroundings {
            apexes: surface.apexes().collect(),
            surface,
            resolution,
        };
        let sampled = |edge: EdgeId| {
            let (curve, [lo, hi]) = (brep.curve(edge), brep.range(edge));
            let breaks = curve.breaks(lo, hi);
            let steps = breaks.windows(2).flat_map(|pair| {
                let (a, b) = (pair[0], pair[1]);
                (0..STEPS).map(move |k| a + (b - a) * f64::from(k) / f64::from(STEPS))
            });
            let inner = INNER * (hi - lo);
            let mut at = vec![lo, lo + inner];
            at.extend(steps.skip(1));
            at.extend([hi - inner, hi]);
            let mut points = vec![curve.point(lo)];
            for pair in at.windows(2) {
                points.extend(near_apexes.samples(curve, [pair[0], pair[1]]));
            }
            Sampled {
                points,
                closed: brep.topology.edge(edge).ends.is_none(),
            }
        };
        let edges: Vec<EdgeId> = edges.collect();
        let all = brep.topology.touches.iter().zip(&brep.geometry.touches);
        let touches = all.filter(|(touch, _)| touch.edges.iter().any(|e| edges.contains(e)));
        Self {
            touches: touches.map(|(_, p)| *p).collect(),
            edges: edges.into_iter().map(sampled).collect(),
        }
    }

    pub fn points(&self) -> impl Iterator<Item = &Point3<f64>> {
        self.edges.iter().flat_map(|e| &e.points)
    }

    /// The change of parameter `i`, an angle, along each edge; NaN for an edge through a pole.
    pub fn turns(&self, window: &ParameterWindow, i: usize) -> Vec<f64> {
        let turn = |edge: &Sampled| {
            let angles: Vec<f64> = edge
                .points
                .iter()
                .map(|p| window.parameters_at(p)[i])
                .collect();
            angles.windows(2).map(|w| wrap(w[1] - w[0])).sum()
        };
        self.edges.iter().map(turn).collect()
    }

    /// The values of parameter `i`, an angle, at which edges end, turn back or touch.
    pub fn critical(&self, window: &ParameterWindow, i: usize) -> Vec<f64> {
        let touches = self.touches.iter().map(|p| window.parameters_at(p)[i]);
        let mut critical: Vec<f64> = touches.filter(|x| x.is_finite()).collect();
        for edge in &self.edges {
            edge.add_turns(window, i, &mut critical);
        }
        for angle in &mut critical {
            *angle = turn(*angle);
        }
        critical.sort_by(f64::total_cmp);
        critical.dedup_by(|b, a| *b - *a <= SAME);
        critical
    }

    /// The values of parameter `i`, an angle, at which a seam is tried. The first is zero if there
    /// is room. The others lie amid the gaps between the critical values, the widest gap first.
    pub fn candidates(&self, window: &ParameterWindow, i: usize) -> Vec<f64> {
        let mut critical = self.critical(window, i);
        let Some(&first) = critical.first() else {
            return vec![0.0];
        };
        critical.push(first + TAU);
        let mut gaps: Vec<[f64; 2]> = critical.windows(2).map(|w| [w[0], w[1]]).collect();
        gaps.sort_by(|a, b| (b[1] - b[0]).total_cmp(&(a[1] - a[0])));
        let room = ROOM * (gaps[0][1] - gaps[0][0]);
        let has_room = critical.iter().all(|c| {
            let away = turn(*c);
            away.min(TAU - away) > room
        });
        let zero = has_room.then_some(0.0);
        let middles = gaps.iter().map(|[a, b]| turn(0.5 * (a + b)));
        zero.into_iter().chain(middles.take(TRIED)).collect()
    }
}

/// A surface next to its apexes, where a short curve may turn by any angle.
struct ApexSurroundings {
    surface: Surface,
    apexes: Vec<Point3<f64>>,
    resolution: f64,
}

impl ApexSurroundings {
    /// The samples of a curve after the first of two parameters, up to the second.
    fn samples(&self, curve: &Curve, range: [f64; 2]) -> Vec<Point3<f64>> {
        let mut points = Vec::new();
        let mut waiting = vec![(range, NEAR_APEX)];
        while let Some(([a, b], halvings)) = waiting.pop() {
            let ends = [a, b].map(|t| curve.point(t));
            if halvings > 0 && self.may_turn(ends) {
                let middle = 0.5 * (a + b);
                waiting.extend([([middle, b], halvings - 1), ([a, middle], halvings - 1)]);
            } else {
                points.push(ends[1]);
            }
        }
        points
    }

    /// Whether a curve may turn unseen between two points, neither of which is at an apex: they are
    /// far from each other compared with their distance from the apex, or have different angles and
    /// are far from each other compared with their distance from the axis.
    fn may_turn(&self, [p, q]: [Point3<f64>; 2]) -> bool {
        let step = (q - p).norm();
        let least = |away: &dyn Fn(&Point3<f64>) -> f64| away(&p).min(away(&q));
        let is_near = |apex: &Point3<f64>| {
            let away = least(&|x| (x - apex).norm());
            away > self.resolution && 2.0 * step > away
        };
        let [u, v] = [p, q].map(|x| self.surface.parameters(&x)[0]);
        let from_axis = |x: &Point3<f64>| {
            let q = self.surface.frame().coordinates(x);
            q.x.hypot(q.y)
        };
        let turns = || {
            let away = least(&from_axis);
            away > self.resolution && wrap(v - u).abs() > 0.5 * LEAP && 2.0 * step > away
        };
        self.apexes.iter().any(is_near) || (!self.apexes.is_empty() && turns())
    }
}

/// The number of times that the step between two samples is halved next to an apex.
const NEAR_APEX: u32 = 48;

/// The change between consecutive samples above which an angle jumps.
const LEAP: f64 = 1.0;

/// The difference up to which angles are equal.
pub(super) const SAME: f64 = 1.0 / (1u64 << 36) as f64;

/// The distance of the closest critical value, relative to the widest gap, that leaves room for a
/// seam.
const ROOM: f64 = 1.0 / 8.0;

impl Sampled {
    /// Adds the angles at the ends of the edge and where it turns back.
    fn add_turns(&self, window: &ParameterWindow, i: usize, found: &mut Vec<f64>) {
        let parameters = self.points.iter().map(|p| window.parameters_at(p));
        let known: Vec<Point2<f64>> = parameters.filter(|p| p[i].is_finite()).collect();
        let (Some(first), Some(last)) = (known.first(), known.last()) else {
            return;
        };
        let mut steps: Vec<(f64, f64)> = known
            .windows(2)
            .map(|w| (w[0][i], wrap(w[1][i] - w[0][i])))
            .collect();
        match self.closed {
            false => found.extend([first[i], last[i]]),
            true => steps.extend(steps.first().copied()),
        }
        let turns = steps.windows(2).filter(|s| s[0].1 * s[1].1 <= 0.0);
        found.extend(turns.map(|s| s[1].0));
        // The angle jumps at an apex.
        let leaps = steps.iter().filter(|s| s.1.abs() > LEAP);
        found.extend(leaps.flat_map(|s| [s.0, s.0 + s.1]));
    }
}

/// The candidate axes of a sphere's parameters for a face, the best first; `arm` points from the
/// centre to a point, and the frame has the sphere's own axes. The poles must be far from the edges.
/// Among these, one to which most edges are parallel circles comes first, or the sphere's own axis if
/// none is better.
pub(super) fn axes(
    frame: &Frame,
    arm: impl Fn(&Point3<f64>) -> Vector3<f64>,
    samples: &Samples,
    circles: &[Vector3<f64>],
) -> Vec<Vector3<f64>> {
    let arms: Vec<Vector3<f64>> = samples.points().map(|p| arm(p).normalize()).collect();
    let away = |z: &Vector3<f64>| {
        let near = arms.iter().map(|a| a.dot(z).abs());
        1.0 - near.fold(0.0, f64::max)
    };
    let parallel = |z: &Vector3<f64>| {
        let along = circles.iter().filter(|c| c.dot(z).abs() > 1.0 - PARALLEL);
        along.count()
    };
    let known = std::iter::once(&frame.z).chain(circles);
    let clear = known.filter(|z| away(z) > CLEAR);
    let best = clear.reduce(|best, z| {
        if parallel(z) > parallel(best) {
            z
        } else {
            best
        }
    });
    let spread = (0..SPREAD).map(|k| {
        let z = (f64::from(k) + 0.5) / f64::from(SPREAD);
        let (sin, cos) = (GOLDEN * f64::from(k)).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * cos, r * sin, z)
    });
    // Reversed, so that of two equally distant ones the later one comes first.
    let mut all: Vec<Vector3<f64>> = [frame.x, frame.y].into_iter().chain(spread).collect();
    all.reverse();
    all.sort_by(|a, b| away(b).total_cmp(&away(a)));
    best.copied().into_iter().chain(all).collect()
}

/// Directions are equal if their cosine is closer to one than this.
const PARALLEL: f64 = 1.0 / (1u64 << 40) as f64;
/// A pole is far from the edges if the cosine of the angle to each is less than one minus this.
const CLEAR: f64 = 1.0 / 512.0;
/// The number of axes tried in addition to a sphere's own.
const SPREAD: u32 = 64;
/// The golden angle: its multiples spread over the circle.
const GOLDEN: f64 = 2.399_963_229_728_653;
