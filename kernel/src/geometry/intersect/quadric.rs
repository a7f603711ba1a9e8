//! Two quadrics, neither a plane: lines, pairs of conics, or the quartic.
//!
//! Notation as in [`quartic`](crate::geometry::quartic): along the rulings of the base, the other
//! quadric is k w² + 2 B(u) w + C(u), and Δ = B² − k C. The number and kind of the zeros of Δ tell
//! everything: a square means two planar conics, a double zero a node, none a pair of closed
//! branches. A zero is decided as the distance of the ruling from the other surface.

use super::plane::{plane_cone, plane_cylinder};
use super::{
    Branch, Extent, IntersectionError, Meeting, Node, drift, nappe_parts, place, positive_parts,
};
use crate::geometry::curve::{Curve, Line};
use crate::geometry::frame::Frame;
use crate::geometry::quartic::{Height, Quartic, Ruled, Sweep, Trig1, Trig2, trig1, trig2};
use crate::geometry::surface::{Cone, Cylinder, Plane, Surface};
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::roots::{Contact, Function, Zeros, bisect, isolate};
use crate::number::scalar::Scalar;
use crate::number::sign::{Judge, ROUNDING, Side};
use nalgebra::{Matrix3, Point3, Vector3};
use std::f64::consts::{PI, TAU};

/// pᵀ A p + 2 b·p + c in the frame of the base.
struct Quadric {
    a: Matrix3<f64>,
    b: Vector3<f64>,
    c: f64,
}

impl Quadric {
    /// The quadric that a surface lies on, seen in `frame`; to first order twice the distance
    /// times a length.
    fn of(surface: &Surface, frame: &Frame) -> Self {
        let g = surface.frame();
        let mut q = Self {
            a: Matrix3::zeros(),
            b: Vector3::zeros(),
            c: 0.0,
        };
        let (weights, constant) = match surface {
            Surface::Cylinder(s) => ([1.0, 1.0, 0.0], -s.radius * s.radius),
            Surface::Cone(s) => ([s.cos * s.cos, s.cos * s.cos, -s.sin * s.sin], 0.0),
            Surface::Sphere(s) => ([1.0, 1.0, 1.0], -s.radius * s.radius),
            Surface::Plane(_) | Surface::Torus(_) => ([0.0; 3], 0.0),
        };
        q.c = constant;
        for (axis, weight) in [g.x, g.y, g.z].into_iter().zip(weights) {
            let k = frame.components(&axis);
            let offset = axis.dot(&(frame.origin - g.origin));
            q.a += k * k.transpose() * weight;
            q.b += k * (offset * weight);
            q.c += offset * offset * weight;
        }
        q
    }
}

/// The distance of a point from the whole quadric of a surface: a cone with both nappes.
fn apart(surface: &Surface, p: &Point3<f64>) -> f64 {
    match surface {
        Surface::Cone(c) => {
            let q = c.frame.coordinates(p);
            (q.x.hypot(q.y) * c.cos - q.z.abs() * c.sin).abs()
        }
        _ => surface.distance(p).abs(),
    }
}

/// The other quadric along the rulings of the base.
struct Rulings<'a> {
    base: Ruled,
    other: &'a Surface,
    lead: f64,
    linear: Trig1,
    constant: Trig2,
    radicand: Trig2,
    /// The size of the terms that cancel in the radicand.
    scale: f64,
    extent: &'a Extent,
}

fn surface_of(base: &Ruled) -> Surface {
    match base {
        Ruled::Cylinder(c) => Surface::Cylinder(*c),
        Ruled::Cone(c) => Surface::Cone(*c),
    }
}

impl<'a> Rulings<'a> {
    fn new(base: Ruled, other: &'a Surface, extent: &'a Extent) -> Self {
        let surface = surface_of(&base);
        let q = Quadric::of(other, surface.frame());
        let (a, b) = (&q.a, &q.b);
        // The ruling's point is m (cos, sin, 0) + ... with m the radius or the slope.
        let (lead, linear, constant) = match &base {
            Ruled::Cylinder(s) => {
                let r = s.radius;
                let linear = [b.z, r * a[(0, 2)], r * a[(1, 2)]];
                let half = 0.5 * r * r;
                let constant = [
                    q.c + half * (a[(0, 0)] + a[(1, 1)]),
                    2.0 * r * b.x,
                    2.0 * r * b.y,
                    half * (a[(0, 0)] - a[(1, 1)]),
                    2.0 * half * a[(0, 1)],
                ];
                (a[(2, 2)], linear, constant)
            }
            Ruled::Cone(s) => {
                let m = s.sin / s.cos;
                let linear = [b.z, m * b.x, m * b.y];
                let half = 0.5 * m * m;
                let constant = [
                    a[(2, 2)] + half * (a[(0, 0)] + a[(1, 1)]),
                    2.0 * m * a[(0, 2)],
                    2.0 * m * a[(1, 2)],
                    half * (a[(0, 0)] - a[(1, 1)]),
                    2.0 * half * a[(0, 1)],
                ];
                (q.c, linear, constant)
            }
        };
        let square = product(&linear, &linear);
        let radicand = std::array::from_fn(|i| square[i] - lead * constant[i]);
        let sum = |k: &[f64]| k.iter().map(|c| c.abs()).sum::<f64>();
        let scale = sum(&square) + lead.abs() * sum(&constant);
        Self {
            base,
            other,
            lead,
            linear,
            constant,
            radicand,
            scale,
            extent,
        }
    }

    /// The point on the ruling u at height w, in the base's frame.
    fn local(&self, u: f64, w: f64) -> Vector3<f64> {
        match &self.base {
            Ruled::Cylinder(s) => Vector3::new(s.radius * u.cos(), s.radius * u.sin(), w),
            Ruled::Cone(s) => {
                let rho = s.sin / s.cos / w;
                Vector3::new(rho * u.cos(), rho * u.sin(), 1.0 / w)
            }
        }
    }

    fn world(&self, u: f64, w: f64) -> Point3<f64> {
        let p = self.local(u, w);
        surface_of(&self.base).frame().point(p.x, p.y, p.z)
    }

    /// The height of the point of a ruling that is next to the other surface.
    fn middle(&self, u: f64) -> f64 {
        -trig1(&self.linear, u.sin_cos()) / self.lead
    }

    fn delta(&self, u: f64) -> f64 {
        trig2(&self.radicand, u.sin_cos())
    }

    /// Whether a height lies on the base and in the extent.
    fn is_on_base(&self, w: f64) -> bool {
        match &self.base {
            Ruled::Cylinder(_) => true,
            Ruled::Cone(_) => w > 0.0 && 1.0 / w <= self.reach(),
        }
    }

    /// The greatest absolute height that can lie in the extent.
    fn reach(&self) -> f64 {
        let f = *surface_of(&self.base).frame();
        (f.origin - self.extent.centre).dot(&f.z).abs() + self.extent.radius
    }

    /// Whether Δ is positive, zero or negative at an angle, decided as the signed distance of the
    /// ruling from the other surface.
    fn state(&self, u: f64, judge: &Judge) -> Side {
        let w = self.middle(u);
        if !self.is_on_base(w) {
            // The decision concerns the other nappe or lies far off: the plain sign will do.
            return if self.delta(u) >= 0.0 {
                Side::Inside
            } else {
                Side::Outside
            };
        }
        let distance = apart(self.other, &self.world(u, w));
        let signed = if self.delta(u) >= 0.0 {
            -distance
        } else {
            distance
        };
        judge.side("ruling on quadric", signed, place(&self.world(u, w)))
    }

    /// The planar conic w = plane(u), where it lies on the base and on the other surface.
    fn add_conic(&self, w: &Trig1, tangent: bool, judge: &Judge, meeting: &mut Meeting) {
        let surface = surface_of(&self.base);
        let frame = surface.frame();
        let (normal, offset) = match &self.base {
            Ruled::Cylinder(s) => (Vector3::new(-w[1] / s.radius, -w[2] / s.radius, 1.0), w[0]),
            Ruled::Cone(s) => {
                let m = s.sin / s.cos;
                (Vector3::new(w[1] / m, w[2] / m, w[0]), 1.0)
            }
        };
        let size = normal.norm();
        if size * self.reach() * self.reach() < offset.abs() * judge.band() {
            return;
        }
        let n = frame.vector(&(normal / size));
        let origin = frame.origin + n * (offset / size);
        let plane = Plane {
            frame: Frame::about(origin, n),
        };
        let part = match &self.base {
            Ruled::Cylinder(s) => plane_cylinder(&plane, s, self.extent, judge),
            Ruled::Cone(s) => plane_cone(&plane, s, self.extent, judge),
        };
        for branch in part.branches {
            for range in self.on_other_nappe(&branch.curve, branch.range, judge) {
                let closed = branch.closed && range == branch.range;
                meeting.branches.push(Branch {
                    range,
                    closed,
                    tangent,
                    ..branch.clone()
                });
            }
        }
    }

    /// The parts of a curve that lie on the other surface's own nappe, where it is a cone.
    fn on_other_nappe(&self, curve: &Curve, range: [f64; 2], judge: &Judge) -> Vec<[f64; 2]> {
        nappe_parts(curve, range, self.other, judge.band())
    }
}

/// The product of two trigonometric polynomials of degree one.
fn product(m: &Trig1, q: &Trig1) -> Trig2 {
    [
        m[0] * q[0] + 0.5 * (m[1] * q[1] + m[2] * q[2]),
        m[0] * q[1] + m[1] * q[0],
        m[0] * q[2] + m[2] * q[0],
        0.5 * (m[1] * q[1] - m[2] * q[2]),
        0.5 * (m[1] * q[2] + m[2] * q[1]),
    ]
}

/// The q of degree one with m q nearest to `whole`.
pub(super) fn divide(whole: &Trig2, m: &Trig1) -> Trig1 {
    let columns: [Trig2; 3] =
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|q| product(m, &q));
    let normal =
        Matrix3::from_fn(|i, j| columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum());
    let right = Vector3::from_fn(|i, _| columns[i].iter().zip(whole).map(|(a, b)| a * b).sum());
    let q = normal.lu().solve(&right).unwrap_or_else(Vector3::zeros);
    [q.x, q.y, q.z]
}

/// sin((u-a)/2) sin((b-u)/2) as a trigonometric polynomial.
fn between(a: f64, b: f64) -> Trig1 {
    let (sin, cos) = (0.5 * (a + b)).sin_cos();
    [-0.5 * (0.5 * (b - a)).cos(), 0.5 * cos, 0.5 * sin]
}

pub(super) fn quadric_quadric(
    x: &Surface,
    y: &Surface,
    extent: &Extent,
    judge: &Judge,
) -> Result<Meeting, IntersectionError> {
    use Surface as S;
    match (x, y) {
        (S::Cylinder(c), S::Cylinder(d)) => {
            if judge.within(drift(&c.frame.z, &d.frame.z, extent)) {
                return Ok(parallel_cylinders(c, d, extent, judge));
            }
            over_rulings(Ruled::Cylinder(*c), y, extent, judge)
        }
        (S::Cylinder(c), _) => over_rulings(Ruled::Cylinder(*c), y, extent, judge),
        (_, S::Cylinder(c)) => over_rulings(Ruled::Cylinder(*c), x, extent, judge),
        (S::Cone(c), S::Cone(d)) => cones(c, d, extent, judge),
        (S::Cone(c), _) => over_rulings(Ruled::Cone(*c), y, extent, judge),
        (_, S::Cone(c)) => over_rulings(Ruled::Cone(*c), x, extent, judge),
        _ => Ok(Meeting::nothing()),
    }
}

fn parallel_cylinders(c: &Cylinder, d: &Cylinder, extent: &Extent, judge: &Judge) -> Meeting {
    let z = c.frame.z;
    let at = |f: &Frame| f.origin + f.z * ((extent.centre - f.origin).dot(&z) / f.z.dot(&z));
    let (p, q) = (at(&c.frame), at(&d.frame));
    let away = q - p;
    let dist = away.norm();
    let mut meeting = Meeting::nothing();
    if judge.within(dist) {
        return meeting;
    }
    let axis = away / dist;
    let (r, s) = (c.radius, d.radius);
    let x = 0.5 * (dist + (r - s) * (r + s) / dist);
    let line = |origin| {
        Curve::Line(Line {
            origin,
            direction: z,
        })
    };
    let foot = p + axis * x;
    let side = |gap: f64| judge.side("cylinder along cylinder", gap, place(&foot));
    match (side(dist - (r + s)), side((r - s).abs() - dist)) {
        (Side::On, _) => meeting.add(line(p + axis * r), true, extent),
        (_, Side::On) => meeting.add(line(p + axis * r.copysign(r - s)), true, extent),
        (Side::Inside, Side::Inside) => {
            let area = (r + s - dist) * (dist + (r - s)) * (dist - (r - s)) * (dist + r + s);
            let half = z.cross(&axis) * (area.max(0.0).sqrt() / (2.0 * dist));
            meeting.add(line(foot - half), false, extent);
            meeting.add(line(foot + half), false, extent);
        }
        _ => {}
    }
    meeting
}

fn cones(c: &Cone, d: &Cone, extent: &Extent, judge: &Judge) -> Result<Meeting, IntersectionError> {
    let (sc, sd) = (Surface::Cone(*c), Surface::Cone(*d));
    let on_other = |apex: &Point3<f64>, surface: &Surface| judge.within(apart(surface, apex));
    let between = (c.frame.origin - d.frame.origin).norm();
    if judge.coincide("apex on apex", between, place(&c.frame.origin)) {
        return Ok(common_apex(c, &sd, extent, judge));
    }
    if on_other(&c.frame.origin, &sd) && !on_other(&d.frame.origin, &sc) {
        return over_rulings(Ruled::Cone(*d), &sc, extent, judge);
    }
    over_rulings(Ruled::Cone(*c), &sd, extent, judge)
}

/// Two cones with one apex meet in common rulings.
fn common_apex(c: &Cone, other: &Surface, extent: &Extent, judge: &Judge) -> Meeting {
    let mut meeting = Meeting::touch(c.frame.origin);
    let m = c.sin / c.cos;
    // The distance from the other cone, a part's radius away from the apex, along each ruling.
    let along = |u: Jet<Interval>| {
        let (s, k) = u.sin_cos();
        let r = extent.radius;
        let p = c
            .frame
            .world_of([k.scale(m * r), s.scale(m * r), Jet::constant(r)]);
        other.level(p)
    };
    let breaks: Vec<f64> = (0..=8).map(|i| 0.1 + TAU * f64::from(i) / 8.0).collect();
    let Zeros::At { roots, .. } = isolate(&|t| along(Jet::variable(t)), &breaks, judge.band())
    else {
        return meeting;
    };
    let mut angles: Vec<(f64, bool)> = roots
        .iter()
        .map(|r| (r.t, r.contact != Contact::Simple))
        .collect();
    if let (Some(&(a, _)), Some(&(b, _))) = (angles.first(), angles.last())
        && angles.len() > 1
        && (a + TAU - b).abs() < ROUNDING * TAU
    {
        angles.pop();
    }
    for (u, tangent) in angles {
        let local = Vector3::new(c.sin * u.cos(), c.sin * u.sin(), c.cos);
        let curve = Curve::Line(Line {
            origin: c.frame.origin,
            direction: c.frame.vector(&local),
        });
        if let Some([_, end]) = curve.range_within(&extent.centre, extent.radius)
            && end > 0.0
        {
            meeting.nodes[0].on.push((meeting.branches.len(), 0.0));
            meeting.branches.push(Branch {
                curve,
                range: [0.0, end],
                closed: false,
                tangent,
            });
        }
    }
    meeting
}

fn over_rulings(
    base: Ruled,
    other: &Surface,
    extent: &Extent,
    judge: &Judge,
) -> Result<Meeting, IntersectionError> {
    let rulings = Rulings::new(base, other, extent);
    let flat = match &base {
        // The other surface holds the direction of the rulings: a cone with a ruling along them.
        Ruled::Cylinder(_) => judge.within(rulings.lead * extent.radius),
        Ruled::Cone(c) => {
            let away = apart(other, &c.frame.origin);
            judge.coincide("apex on quadric", away, place(&c.frame.origin))
        }
    };
    if flat {
        rulings.single(judge)
    } else {
        rulings.double(judge)
    }
}

impl Rulings<'_> {
    /// k = 0: one point on each ruling, w = -C/(2B).
    fn single(&self, judge: &Judge) -> Result<Meeting, IntersectionError> {
        let mut meeting = Meeting::nothing();
        let shared = self.shared_ruling(judge);
        let height = match shared {
            Some(u0) => {
                let (linear, constant) = divide_half(&self.linear, &self.constant, u0);
                Height::Cubic { linear, constant }
            }
            None => Height::Rational {
                linear: self.linear,
                constant: self.constant,
            },
        };
        let quartic = Quartic {
            base: self.base,
            sweep: Sweep::Round { turns: 1 },
            height,
        };
        match self.single_conic(judge) {
            Some(w) => self.add_conic(&w, false, judge, &mut meeting),
            None => self.add_single(quartic, shared, judge, &mut meeting),
        }
        if let Some(u0) = shared {
            self.add_shared(u0, &quartic, judge, &mut meeting);
        }
        self.add_apexes(judge, &mut meeting);
        Ok(meeting)
    }

    /// w = -C/(2B) where that is of degree one: a planar conic.
    fn single_conic(&self, judge: &Judge) -> Option<Trig1> {
        let w = divide(&self.constant, &self.linear).map(|q| -0.5 * q);
        self.meets_in_conics(judge, |u| vec![trig1(&w, u.sin_cos())])
            .then_some(w)
    }

    /// The curve w = -C/(2B), as far as it lies on both surfaces.
    fn add_single(
        &self,
        quartic: Quartic,
        shared: Option<f64>,
        judge: &Judge,
        meeting: &mut Meeting,
    ) {
        let whole = [0.0, TAU];
        for range in self.bounded_ranges(&quartic, shared, self.reach()) {
            let curve = Curve::Quartic(Box::new(quartic));
            for range in self.on_other_nappe(&curve, range, judge) {
                let branch = Branch {
                    curve: curve.clone(),
                    range,
                    closed: shared.is_none() && range == whole,
                    tangent: false,
                };
                meeting.branches.push(branch);
            }
        }
    }

    /// Whether the heights that `conics` gives over each ruling lie on the other surface.
    fn meets_in_conics(&self, judge: &Judge, conics: impl Fn(f64) -> Vec<f64>) -> bool {
        let mut worst: f64 = 0.0;
        let mut asked = false;
        for i in 0..24 {
            let u = TAU * (f64::from(i) + 0.3) / 24.0;
            for w in conics(u).into_iter().filter(|&w| self.is_on_base(w)) {
                asked = true;
                worst = worst.max(apart(self.other, &self.world(u, w)));
            }
        }
        let o = surface_of(&self.base).frame().origin;
        asked && judge.coincide("quadrics meeting in conics", worst, place(&o))
    }

    /// The ruling that lies on both surfaces, where k = 0: a common zero of B and C.
    fn shared_ruling(&self, judge: &Judge) -> Option<f64> {
        if let Ruled::Cylinder(_) = self.base {
            let Surface::Cone(c) = self.other else {
                return None;
            };
            let f = surface_of(&self.base);
            if !judge.within(f.distance(&c.frame.origin)) {
                return None;
            }
            let q = f.frame().coordinates(&c.frame.origin);
            return Some(q.y.atan2(q.x));
        }
        let Surface::Cone(c) = self.other else {
            return None;
        };
        let q = surface_of(&self.base).frame().coordinates(&c.frame.origin);
        let w = 1.0 / q.z;
        let u = q.y.atan2(q.x);
        let u = if q.z < 0.0 { u + PI } else { u };
        let on = judge.within(apart(&surface_of(&self.base), &c.frame.origin));
        (w.is_finite() && on).then_some(u)
    }

    /// The ranges of u over which the single point of a ruling is on the base within reach.
    fn bounded_ranges(&self, q: &Quartic, shared: Option<f64>, reach: f64) -> Vec<[f64; 2]> {
        // |w| = reach, w = 1/reach and the poles, as signs of N - x D with w = N/D.
        let quotient = |u: f64| q.height_at(u);
        let inside = |u: f64| match &self.base {
            Ruled::Cylinder(_) => quotient(u).abs() <= reach,
            Ruled::Cone(_) => quotient(u) * reach >= 1.0,
        };
        let bound = |x: f64| -> Trig2 {
            let mut k = self.constant;
            for (c, b) in k.iter_mut().zip(&self.linear) {
                *c += 2.0 * x * b;
            }
            k
        };
        let limits = match &self.base {
            Ruled::Cylinder(_) => vec![bound(reach), bound(-reach)],
            Ruled::Cone(_) => {
                vec![
                    bound(1.0 / reach),
                    [self.linear[0], self.linear[1], self.linear[2], 0.0, 0.0],
                ]
            }
        };
        let mut marks: Vec<f64> = shared.into_iter().collect();
        for k in &limits {
            marks.extend(zeros_of(k).into_iter().map(|r| r.0));
        }
        let mut marks: Vec<f64> = marks.into_iter().map(|u| u.rem_euclid(TAU)).collect();
        marks.sort_by(f64::total_cmp);
        marks.dedup_by(|a, b| (*a - *b).abs() < 1.0 / f64::from(1 << 24));
        let Some(&first) = marks.first() else {
            return if inside(0.5) {
                vec![[0.0, TAU]]
            } else {
                Vec::new()
            };
        };
        marks.push(first + TAU);
        let mut ranges: Vec<[f64; 2]> = Vec::new();
        for m in marks.windows(2) {
            if inside(0.5 * (m[0] + m[1])) {
                match ranges.last_mut() {
                    // The shared ruling is no end of the curve: it passes over it.
                    Some(last) if last[1] == m[0] && shared.is_some_and(|s| same_turn(s, m[0])) => {
                        last[1] = m[1];
                    }
                    _ => ranges.push([m[0], m[1]]),
                }
            }
        }
        ranges
    }

    /// The ruling common to both surfaces, with the point where the rest of the curve crosses it.
    fn add_shared(&self, u0: f64, q: &Quartic, judge: &Judge, meeting: &mut Meeting) {
        let surface = surface_of(&self.base);
        let frame = surface.frame();
        let (origin, direction) = match &self.base {
            Ruled::Cylinder(s) => (
                frame.point(s.radius * u0.cos(), s.radius * u0.sin(), 0.0),
                frame.z,
            ),
            Ruled::Cone(s) => {
                let local = Vector3::new(s.sin * u0.cos(), s.sin * u0.sin(), s.cos);
                (frame.origin, frame.vector(&local))
            }
        };
        let curve = Curve::Line(Line { origin, direction });
        let Some([lo, hi]) = curve.range_within(&self.extent.centre, self.extent.radius) else {
            return;
        };
        let lo = if matches!(self.base, Ruled::Cone(_)) {
            lo.max(0.0)
        } else {
            lo
        };
        for range in self.on_other_nappe(&curve, [lo, hi], judge) {
            let branch = Branch {
                curve: curve.clone(),
                range,
                closed: false,
                tangent: false,
            };
            meeting.branches.push(branch);
        }
        let crossing = Point3::from(q.at(u0));
        if (crossing - self.extent.centre).norm() <= self.extent.radius {
            meeting.nodes.push(Node {
                point: crossing,
                on: Vec::new(),
            });
        }
    }

    /// The apexes through which branches pass: singular points.
    fn add_apexes(&self, judge: &Judge, meeting: &mut Meeting) {
        let surface = surface_of(&self.base);
        for (s, o) in [(&surface, self.other), (self.other, &surface)] {
            if let Surface::Cone(c) = s
                && judge.within(o.distance(&c.frame.origin))
            {
                meeting.nodes.push(Node {
                    point: c.frame.origin,
                    on: Vec::new(),
                });
            }
        }
    }

    /// k ≠ 0: two points on each ruling where Δ > 0.
    fn double(&self, judge: &Judge) -> Result<Meeting, IntersectionError> {
        let mut meeting = Meeting::nothing();
        if let Some(root) = self.square_root(judge) {
            self.add_conics(&root, judge, &mut meeting);
        } else {
            self.add_quartic(judge, &mut meeting)?;
        }
        self.add_apexes(judge, &mut meeting);
        Ok(meeting)
    }

    /// The s of degree one with Δ = s², if within the band there is one.
    fn square_root(&self, judge: &Judge) -> Option<Trig1> {
        let [a0, c1, s1, c2, s2] = self.radicand;
        let rho = (2.0 * c2.hypot(s2)).sqrt();
        let noise = (ROUNDING * self.scale).sqrt();
        let (sin, cos) = (0.5 * s2.atan2(c2)).sin_cos();
        let root = if rho > noise {
            [(c1 * cos + s1 * sin) / (2.0 * rho), rho * cos, rho * sin]
        } else {
            [a0.max(0.0).sqrt(), 0.0, 0.0]
        };
        let both = |u: f64| {
            let s = trig1(&root, u.sin_cos());
            let middle = trig1(&self.linear, u.sin_cos());
            vec![(s - middle) / self.lead, (-s - middle) / self.lead]
        };
        self.meets_in_conics(judge, both).then_some(root)
    }

    fn add_conics(&self, root: &Trig1, judge: &Judge, meeting: &mut Meeting) {
        let w = |sign: f64| {
            let part = |i: usize| (sign * root[i] - self.linear[i]) / self.lead;
            [part(0), part(1), part(2)]
        };
        // Tangent all along where both conics are one.
        let gap = (0..8)
            .map(|i| TAU * f64::from(i) / 8.0)
            .map(|u| (u, self.middle(u)))
            .filter(|(_, m)| self.is_on_base(*m))
            .map(|(u, m)| apart(self.other, &self.world(u, m)))
            .reduce(f64::max);
        if gap.is_some_and(|g| judge.within(g)) {
            return self.add_conic(&w(0.0), true, judge, meeting);
        }
        self.add_conic(&w(1.0), false, judge, meeting);
        self.add_conic(&w(-1.0), false, judge, meeting);
        // Where they cross, s vanishes.
        let whole = [root[0], root[1], root[2], 0.0, 0.0];
        for (u, _) in zeros_of(&whole) {
            let m = self.middle(u);
            let p = self.world(u, m);
            if self.is_on_base(m) && judge.within(self.other.distance(&p)) {
                meeting.cross_at(p);
            }
        }
    }

    fn add_quartic(&self, judge: &Judge, meeting: &mut Meeting) -> Result<(), IntersectionError> {
        let structure = self.structure(judge)?;
        for &u in &structure.isolated {
            let p = self.world(u, self.middle(u));
            if self.is_on_base(self.middle(u)) && judge.within(self.other.distance(&p)) {
                meeting.nodes.push(Node {
                    point: p,
                    on: Vec::new(),
                });
            }
        }
        let mut curves: Vec<(Quartic, Vec<(f64, f64)>)> = Vec::new();
        let make = |sweep, height| Quartic {
            base: self.base,
            sweep,
            height,
        };
        let (lead, linear) = (self.lead, self.linear);
        if structure.arcs.is_empty() && structure.positive {
            match structure.nodes.first() {
                None => {
                    for sign in [1.0, -1.0] {
                        let radicand = self.radicand;
                        let height = Height::Whole {
                            lead,
                            linear,
                            radicand,
                            sign,
                        };
                        curves.push((make(Sweep::Round { turns: 1 }, height), Vec::new()));
                    }
                }
                Some(&node) => {
                    let half = between(node, node).map(|k| -k);
                    let rest = divide(&self.radicand, &half);
                    let height = Height::Deflated {
                        lead,
                        linear,
                        rest,
                        node: Some(node),
                        sign: 1.0,
                    };
                    let at = vec![(node, node), (node, node + TAU)];
                    curves.push((make(Sweep::Round { turns: 2 }, height), at));
                }
            }
        }
        for &[a, b] in &structure.arcs {
            let mut rest = divide(&self.radicand, &between(a, b));
            let node = structure.nodes.iter().copied().find_map(|n| {
                let n = a + (n - a).rem_euclid(TAU);
                (n < b).then_some(n)
            });
            let (mid, half) = (0.5 * (a + b), 0.5 * (b - a));
            let mut at = Vec::new();
            if let Some(n) = node {
                // rest = K sin²((u - n)/2): only K is wanted.
                rest = [2.0 * rest[0], 0.0, 0.0];
                let t = ((mid - n) / half).clamp(-1.0, 1.0).acos();
                at = vec![(n, t), (n, TAU - t)];
            }
            let height = Height::Deflated {
                lead,
                linear,
                rest,
                node,
                sign: 1.0,
            };
            curves.push((make(Sweep::Oval { mid, half }, height), at));
        }
        for (quartic, nodes) in curves {
            self.add_clipped(quartic, &nodes, judge, meeting);
        }
        Ok(())
    }

    /// Adds a branch, as far as it lies on the base's nappe and on the other's.
    fn add_clipped(&self, q: Quartic, nodes: &[(f64, f64)], judge: &Judge, meeting: &mut Meeting) {
        let curve = Curve::Quartic(Box::new(q));
        let Some(period) = curve.period() else { return };
        let mut ranges = vec![[0.0, period]];
        if let Ruled::Cone(_) = self.base {
            let above = OnNappe {
                quartic: &q,
                reach: self.reach(),
            };
            ranges = ranges
                .into_iter()
                .flat_map(|r| positive_parts(&curve, r, &above, judge.band()))
                .collect();
        }
        for r in ranges {
            for range in self.on_other_nappe(&curve, r, judge) {
                let closed = range == [0.0, period];
                let index = meeting.branches.len();
                meeting.branches.push(Branch {
                    curve: curve.clone(),
                    range,
                    closed,
                    tangent: false,
                });
                for &(u, t) in nodes {
                    let point = self.world(u, self.middle(u));
                    let t = range[0] + (t - range[0]).rem_euclid(period);
                    if t > range[1] {
                        continue;
                    }
                    let known = meeting
                        .nodes
                        .iter_mut()
                        .find(|n| judge.within((n.point - point).norm()));
                    match known {
                        Some(node) => node.on.push((index, t)),
                        None => meeting.nodes.push(Node {
                            point,
                            on: vec![(index, t)],
                        }),
                    }
                }
            }
        }
    }

    /// The zeros of Δ by kind.
    fn structure(&self, judge: &Judge) -> Result<Structure, IntersectionError> {
        let slope = derivative(&self.radicand);
        let flat = slope.iter().map(|c| c.abs()).sum::<f64>() <= ROUNDING * self.scale;
        let extrema = if flat { Vec::new() } else { zeros_of(&slope) };
        let mut out = Structure::default();
        if extrema.is_empty() {
            out.positive = self.state(0.0, judge) == Side::Inside;
            return Ok(out);
        }
        let states: Vec<(f64, Side)> = extrema
            .iter()
            .map(|&(u, _)| (u, self.state(u, judge)))
            .collect();
        let n = states.len();
        let mut roots: Vec<(f64, bool)> = Vec::new();
        for i in 0..n {
            let (u, s) = states[i];
            let (v, t) = states[(i + 1) % n];
            let v = if i + 1 == n { v + TAU } else { v };
            if (s == Side::Inside) != (t == Side::Inside) && s != Side::On && t != Side::On {
                let root = bisect(u, v, self.delta(u), |u| self.delta(u));
                roots.push((root, t == Side::Inside));
            }
            if s == Side::On {
                let (_, before) = states[(i + n - 1) % n];
                match (before, t) {
                    (Side::Inside, Side::Inside) => out.nodes.push(u),
                    (Side::Outside, Side::Outside) => out.isolated.push(u),
                    _ => {
                        let p = self.world(u, self.middle(u));
                        return Err(IntersectionError::Cusp { place: place(&p) });
                    }
                }
            }
        }
        out.positive = roots.is_empty() && states.iter().any(|s| s.1 == Side::Inside);
        for (i, &(a, rising)) in roots.iter().enumerate() {
            if rising {
                let (b, _) = roots[(i + 1) % roots.len()];
                out.arcs.push([a, if b < a { b + TAU } else { b }]);
            }
        }
        Ok(out)
    }
}

/// How far the height of a curve on a cone is from where it leaves the nappe's reach, scaled to a
/// length.
struct OnNappe<'a> {
    quartic: &'a Quartic,
    reach: f64,
}

impl OnNappe<'_> {
    fn height<S: Scalar>(&self, t: S) -> S {
        let w = self.quartic.height_at(t);
        (w - S::constant(1.0 / self.reach)).scale(self.reach * self.reach)
    }
}

impl Function for OnNappe<'_> {
    fn over(&self, t: Interval) -> Jet<Interval> {
        self.height(Jet::variable(t))
    }

    fn reach(&self, t: Interval) -> Interval {
        self.height(t)
    }

    fn at(&self, t: f64) -> Jet<f64> {
        self.height(Jet::variable(t))
    }

    fn value(&self, t: f64) -> f64 {
        self.height(t)
    }
}

/// The zeros of Δ by kind.
#[derive(Default)]
struct Structure {
    /// Δ is nowhere negative.
    positive: bool,
    /// The arcs of angles between simple zeros on which Δ is positive.
    arcs: Vec<[f64; 2]>,
    /// Double zeros with Δ positive on both sides.
    nodes: Vec<f64>,
    /// Double zeros with Δ negative on both sides.
    isolated: Vec<f64>,
}

fn same_turn(a: f64, b: f64) -> bool {
    let d = (a - b).rem_euclid(TAU);
    d.min(TAU - d) < 1.0 / f64::from(1 << 20)
}

/// A trigonometric polynomial of degree two with its derivatives, which are such, too.
struct Trigonometric([Trig2; 3]);

impl Trigonometric {
    fn new(k: &Trig2) -> Self {
        let slope = derivative(k);
        Self([*k, slope, derivative(&slope)])
    }

    fn jet<S: Scalar>(&self, u: S) -> Jet<S> {
        let at = u.sin_cos();
        let [v, d, dd] = [0, 1, 2].map(|i| trig2(&self.0[i], at));
        Jet { v, d, dd }
    }
}

impl Function for Trigonometric {
    fn over(&self, u: Interval) -> Jet<Interval> {
        self.jet(u)
    }

    fn at(&self, u: f64) -> Jet<f64> {
        self.jet(u)
    }

    fn value(&self, u: f64) -> f64 {
        trig2(&self.0[0], u.sin_cos())
    }
}

fn derivative([_, c1, s1, c2, s2]: &Trig2) -> Trig2 {
    [0.0, *s1, -c1, 2.0 * s2, -2.0 * c2]
}

/// The zeros of a trigonometric polynomial in [0, 2π), in order, and whether it changes sign there.
fn zeros_of(k: &Trig2) -> Vec<(f64, bool)> {
    let scale: f64 = k.iter().map(|c| c.abs()).sum();
    let f = Trigonometric::new(k);
    // Started off the axes, where symmetric polynomials have their zeros.
    let start = 0.1;
    let breaks: Vec<f64> = (0..=8).map(|i| start + TAU * f64::from(i) / 8.0).collect();
    let Zeros::At { roots, .. } = isolate(&f, &breaks, ROUNDING * scale) else {
        return Vec::new();
    };
    let mut zeros: Vec<(f64, bool)> = roots
        .iter()
        .map(|r| (r.t.rem_euclid(TAU), r.contact != Contact::Touching))
        .collect();
    zeros.sort_by(|a, b| a.0.total_cmp(&b.0));
    zeros.dedup_by(|a, b| (a.0 - b.0).abs() <= ROUNDING * TAU);
    zeros
}

/// B and C divided by sin((u - u0)/2), a zero of both, in half angles.
fn divide_half(b: &Trig1, c: &Trig2, u0: f64) -> ([f64; 2], [f64; 4]) {
    // Sampled away from the zero, and solved for: both are exact up to rounding.
    let samples: Vec<f64> = (0..8)
        .map(|i| u0 + TAU * (f64::from(i) + 0.5) / 8.0)
        .collect();
    let half = |u: f64| (0.5 * (u - u0)).sin();
    let mut nb = nalgebra::Matrix2::zeros();
    let mut rb = nalgebra::Vector2::zeros();
    let mut nc = nalgebra::Matrix4::zeros();
    let mut rc = nalgebra::Vector4::zeros();
    for &u in &samples {
        let f = nalgebra::Vector2::new((0.5 * u).cos(), (0.5 * u).sin());
        let g = nalgebra::Vector4::new(f.x, f.y, (1.5 * u).cos(), (1.5 * u).sin());
        nb += f * f.transpose();
        rb += f * (trig1(b, u.sin_cos()) / half(u));
        nc += g * g.transpose();
        rc += g * (trig2(c, u.sin_cos()) / half(u));
    }
    let fb = nb.lu().solve(&rb).unwrap_or_default();
    let fc = nc.lu().solve(&rc).unwrap_or_default();
    ([fb.x, fb.y], [fc.x, fc.y, fc.z, fc.w])
}
