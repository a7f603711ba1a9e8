//! Walks on a surface along plane sections of it, and the arcs they cross.
//!
//! A walk is a straight line of a plane, a ruling or a parallel of a cylinder or a cone, a great
//! circle or a parallel of a sphere, or either circle of a torus. Each lies in a plane, so its
//! crossings with an arc are the roots of that plane's distance along the arc; at the top of a torus,
//! which the plane touches, those of the cylinder's through the walk. Notation: s is the length
//! along the walk, D its direction, N the outward normal of the face, T the direction of an arc; the
//! face lies to the left, towards N × T, so the walk enters the face where D·(N × T) > 0.

use super::topology::Sense;
use crate::geometry::bounds::Box3;
use crate::geometry::curve::Curve;
use crate::geometry::frame::Frame;
use crate::geometry::section::{line_meets, section_roots, surface_roots};
use crate::geometry::surface::{Cylinder, Plane, Surface, Torus};
use crate::number::sign::ROUNDING;
use nalgebra::{Point3, Vector3};
use std::f64::consts::TAU;

/// A piece of a face's boundary: the face lies to the left of its sense, seen from the side the
/// face's outward normal points to.
#[derive(Clone, Copy, Debug)]
pub struct DirectedArc<'a> {
    /// The curve.
    pub curve: &'a Curve,
    /// The range of its parameter, increasing.
    pub range: [f64; 2],
    /// Whether it is run along the curve's direction.
    pub sense: Sense,
}

impl DirectedArc<'_> {
    /// Whether both are of one edge: if a face has two such arcs, it lies on both sides of the edge.
    /// Several edges may be of one curve.
    pub fn shares_edge(&self, other: &Self) -> bool {
        std::ptr::eq(self.curve, other.curve) && self.range == other.range
    }
}

/// What a walk does where it meets an arc.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Passage {
    /// It goes into the face, from the arc's right to its left.
    Entering,
    /// It goes out of the face, from the arc's left to its right.
    Leaving,
    /// It touches the arc, runs along it, or passes an end of it within the resolution: take
    /// another walk.
    Unclear,
}

/// A meeting of a walk with an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The length along the walk from its start, in the part's unit.
    pub at: f64,
    /// The index of the arc.
    pub arc: usize,
    /// The parameter on the arc's curve.
    pub t: f64,
    /// What the walk does there.
    pub passage: Passage,
}

#[derive(Clone, Copy, Debug)]
enum Track {
    Line(Vector3<f64>),
    /// About the frame's z axis, from its x axis, with the radius.
    Circle(Frame, f64),
}

/// Which part of the plane section the walk is.
#[derive(Clone, Copy, Debug)]
enum Branch {
    Whole,
    /// On this side of the plane through the point.
    Half(Point3<f64>, Vector3<f64>),
    /// The outer (+1) or inner (-1) of a torus's two circles at one height.
    Parallel(Torus, f64),
    /// A torus's circle next to its top (+1) or bottom (-1): of the two that the cylinder shares
    /// with it, which stands upright on the walk.
    Level(Cylinder, f64),
}

/// Next to the top of a torus, as a part of the tube's radius: there the two circles at one height
/// are close to each other, those at one distance from the axis far apart.
const TOP: f64 = 0.5;

/// A walk on a surface from a point of it.
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    /// Of the plane that the walk lies in.
    normal: Vector3<f64>,
    start: Point3<f64>,
    track: Track,
    branch: Branch,
    length: f64,
    /// What holds a straight walk of a given length; else without bounds.
    extent: Box3,
}

impl Walk {
    fn new(
        start: &Point3<f64>,
        normal: Vector3<f64>,
        track: Track,
        branch: Branch,
        length: f64,
    ) -> Self {
        Self {
            normal,
            start: *start,
            track,
            branch,
            length,
            extent: Box3::ALL,
        }
    }

    /// A straight line without end in a plane, along the unit vector `direction`.
    pub fn straight(plane: &Plane, start: &Point3<f64>, direction: Vector3<f64>) -> Self {
        let normal = direction.cross(&plane.frame.z).normalize();
        let track = Track::Line(direction);
        Self::new(start, normal, track, Branch::Whole, f64::INFINITY)
    }

    /// The great circle of a sphere from `start` towards `target`, once round; none where they
    /// lie on one diameter.
    pub fn great_circle(
        centre: &Point3<f64>,
        start: &Point3<f64>,
        target: &Point3<f64>,
    ) -> Option<Self> {
        let arm = start - centre;
        let normal = arm.cross(&(target - centre));
        let size = normal.norm();
        let clear = size > arm.norm_squared() * ROUNDING.sqrt();
        clear.then(|| Self::circle(start, *centre, normal / size, Branch::Whole))
    }

    fn circle(
        start: &Point3<f64>,
        centre: Point3<f64>,
        axis: Vector3<f64>,
        branch: Branch,
    ) -> Self {
        let arm = start - centre;
        let frame = Frame::toward(centre, axis, arm);
        let radius = arm.norm();
        let track = Track::Circle(frame, radius);
        Self::new(start, axis, track, branch, TAU * radius)
    }

    /// The parallel circle of a cylinder, a cone, a sphere or a torus through `start`, once round
    /// in the given sense about the axis. None on the axis and on a plane.
    pub fn parallel(
        surface: &Surface,
        start: &Point3<f64>,
        sense: Sense,
        band: f64,
    ) -> Option<Self> {
        let f = surface.frame();
        let q = f.coordinates(start);
        let rho = q.x.hypot(q.y);
        let branch = match surface {
            Surface::Plane(_) => return None,
            Surface::Torus(t) => {
                let away = rho - t.major;
                if away.abs() <= TOP * t.minor {
                    let upright = Cylinder {
                        frame: *f,
                        radius: rho,
                    };
                    Branch::Level(upright, q.z.signum())
                } else {
                    Branch::Parallel(*t, away.signum())
                }
            }
            _ => Branch::Whole,
        };
        let centre = f.origin + f.z * q.z;
        let away = rho > band.max(ROUNDING * q.norm());
        away.then(|| Self::circle(start, centre, f.z * sense.sign(), branch))
    }

    /// The ruling of a cylinder or a cone through `start`, or at the angle `u` from a cone's apex,
    /// without end; along the axis or, on a cylinder, against it.
    pub fn ruling(surface: &Surface, start: &Point3<f64>, u: f64, sense: Sense) -> Option<Self> {
        let f = surface.frame();
        let (sin, cos) = u.sin_cos();
        Self::ruling_over(surface, start, f.x * cos + f.y * sin, sense)
    }

    /// The ruling of a cylinder or a cone through a point of it; on the axis, as the one at the
    /// angle zero.
    pub fn ruling_through(surface: &Surface, start: &Point3<f64>, sense: Sense) -> Option<Self> {
        let f = surface.frame();
        let q = f.coordinates(start);
        let rho = q.x.hypot(q.y);
        let radial = match rho > 0.0 {
            true => f.x * (q.x / rho) + f.y * (q.y / rho),
            false => f.x,
        };
        Self::ruling_over(surface, start, radial, sense)
    }

    /// The ruling over a unit vector across the axis.
    fn ruling_over(
        surface: &Surface,
        start: &Point3<f64>,
        radial: Vector3<f64>,
        sense: Sense,
    ) -> Option<Self> {
        let f = surface.frame();
        let direction = match surface {
            Surface::Cylinder(_) => f.z * sense.sign(),
            Surface::Cone(c) => f.z * c.cos + radial * c.sin,
            _ => return None,
        };
        let branch = Branch::Half(f.origin, radial);
        let track = Track::Line(direction);
        Some(Self::new(
            start,
            f.z.cross(&radial),
            track,
            branch,
            f64::INFINITY,
        ))
    }

    /// The circle about the tube of a torus through `start`, once round with the angle about the
    /// tube rising or falling.
    pub fn tube(torus: &Torus, start: &Point3<f64>, sense: Sense) -> Self {
        let f = &torus.frame;
        let q = f.coordinates(start);
        let radial = (f.x * q.x + f.y * q.y).normalize();
        let axis = radial.cross(&f.z) * sense.sign();
        let centre = f.origin + radial * torus.major;
        Self::circle(start, centre, axis, Branch::Half(f.origin, radial))
    }

    /// The walk from the same point that way round which leads to the side of `left` at `p`.
    pub(super) fn toward(self, p: &Point3<f64>, left: &Vector3<f64>) -> Self {
        if self.direction(p).dot(left) < 0.0 {
            self.reversed()
        } else {
            self
        }
    }

    /// The walk from the same point the other way.
    pub(super) fn reversed(self) -> Self {
        let track = match self.track {
            Track::Line(d) => Track::Line(-d),
            Track::Circle(f, r) => Track::Circle(Frame::toward(f.origin, -f.z, f.x), r),
        };
        Self { track, ..self }.upto(self.length)
    }

    /// The same walk, no longer than `length`.
    pub fn upto(self, length: f64) -> Self {
        let length = self.length.min(length);
        let extent = match &self.track {
            Track::Line(d) if length.is_finite() => {
                Box3::of(&self.start).hull(&Box3::of(&(self.start + d * length)))
            }
            _ => Box3::ALL,
        };
        Self {
            length,
            extent,
            ..self
        }
    }

    /// How long it is.
    pub(super) fn length(&self) -> f64 {
        self.length
    }

    /// Whether the walk ends where it starts.
    pub(super) fn closes(&self) -> bool {
        matches!(self.track, Track::Circle(_, radius) if self.length >= TAU * radius)
    }

    /// The point at the length s.
    pub fn point(&self, s: f64) -> Point3<f64> {
        match &self.track {
            Track::Line(d) => self.start + d * s,
            Track::Circle(f, r) => {
                let (sin, cos) = (s / r).sin_cos();
                f.point(r * cos, r * sin, 0.0)
            }
        }
    }

    /// The length at which the walk passes a point of it.
    pub fn at(&self, p: &Point3<f64>) -> f64 {
        match &self.track {
            Track::Line(d) => (p - self.start).dot(d),
            Track::Circle(f, r) => {
                let q = f.coordinates(p);
                q.y.atan2(q.x).rem_euclid(TAU) * r
            }
        }
    }

    /// The unit direction at a point of the walk.
    pub(super) fn direction(&self, p: &Point3<f64>) -> Vector3<f64> {
        match &self.track {
            Track::Line(d) => *d,
            Track::Circle(f, _) => f.z.cross(&(p - f.origin)).normalize(),
        }
    }

    fn passes(&self, p: &Point3<f64>, band: f64) -> bool {
        let on_branch = match &self.branch {
            Branch::Whole => true,
            Branch::Half(o, side) => (p - o).dot(side) > -band,
            Branch::Parallel(t, side) => {
                let q = t.frame.coordinates(p);
                (q.x.hypot(q.y) - t.major) * side > -band
            }
            Branch::Level(c, side) => (p - c.frame.origin).dot(&c.frame.z) * side > -band,
        };
        let s = self.at(p);
        on_branch && s > -band && s < self.length + band
    }

    /// Whether the walk may pass through a box.
    pub fn may_meet(&self, lo: &[f64; 3], hi: &[f64; 3], band: f64) -> bool {
        let Box3 { min, max } = &self.extent;
        if (0..3).any(|i| lo[i] - band > max[i] || hi[i] + band < min[i]) {
            return false;
        }
        let above = |o: &Point3<f64>, n: &Vector3<f64>| {
            let mid: f64 = (0..3).map(|i| n[i] * (0.5 * (lo[i] + hi[i]) - o[i])).sum();
            let half: f64 = (0..3).map(|i| n[i].abs() * 0.5 * (hi[i] - lo[i])).sum();
            (mid, half + band)
        };
        let (mid, half) = above(&self.start, &self.normal);
        if mid.abs() > half {
            return false;
        }
        if let Branch::Half(o, side) = &self.branch {
            let (mid, half) = above(o, side);
            if mid < -half {
                return false;
            }
        }
        match &self.track {
            Track::Line(d) => {
                let (mid, half) = above(&self.start, d);
                mid >= -half && mid - half <= self.length
            }
            Track::Circle(..) => true,
        }
    }

    /// [`Self::may_meet`] of a box.
    pub fn may_meet_box(&self, b: &Box3, band: f64) -> bool {
        self.may_meet(&b.min, &b.max, band)
    }

    /// The crossings with `arcs` on `surface`, in order; `side` tells whether the outward normal
    /// of the face is the surface's own, `band` is the resolution.
    pub fn crossings(
        &self,
        surface: &Surface,
        side: Sense,
        arcs: &[DirectedArc<'_>],
        band: f64,
    ) -> Vec<Crossing> {
        let mut found = Vec::new();
        for (i, arc) in arcs.iter().enumerate() {
            self.meet(
                surface,
                side,
                arc,
                &[arc.range],
                band,
                &mut |at, t, passage| {
                    found.push(Crossing {
                        at,
                        arc: i,
                        t,
                        passage,
                    });
                },
            );
        }
        found.sort_by(|a, b| a.at.total_cmp(&b.at));
        found
    }

    /// Reports the crossings with one arc, of which only some ranges may be met: (length along the
    /// walk, parameter, passage).
    pub(super) fn meet(
        &self,
        surface: &Surface,
        side: Sense,
        arc: &DirectedArc<'_>,
        ranges: &[[f64; 2]],
        band: f64,
        found: &mut impl FnMut(f64, f64, Passage),
    ) {
        let [lo, hi] = arc.range;
        if !closes(arc) {
            for t in [lo, hi] {
                let p = arc.curve.point(t);
                if self.off(&p).abs() <= band && self.passes(&p, band) {
                    found(self.at(&p).max(0.0), t, Passage::Unclear);
                }
            }
        }
        let sign = arc.sense.sign() * side.sign();
        let mut root = |t: f64, plain: bool| {
            let p = arc.curve.point(t);
            if !self.passes(&p, band) {
                return;
            }
            let s = self.at(&p);
            let across = self.direction(&p).cross(&surface.normal(&p));
            let turn = sign * across.dot(&arc.curve.tangent(t));
            let at_end = s <= band || s >= self.length - band;
            let passage = if !plain || at_end || turn.is_nan() || turn.abs() < ROUNDING.sqrt() {
                Passage::Unclear
            } else if turn > 0.0 {
                Passage::Entering
            } else {
                Passage::Leaving
            };
            found(s.max(0.0), t, passage);
        };
        if let Track::Line(d) = &self.track
            && line_meets(arc.curve, arc.range, (&self.start, d), band, &mut root)
        {
            return;
        }
        for &range in ranges {
            match self.branch {
                Branch::Level(c, _) => {
                    surface_roots(arc.curve, range, &Surface::Cylinder(c), band, &mut root);
                }
                _ => {
                    let section = (&self.start, &self.normal);
                    section_roots(arc.curve, range, section, band, &mut root);
                }
            }
        }
    }

    /// The distance of a point from what cuts the walk out of its surface.
    fn off(&self, p: &Point3<f64>) -> f64 {
        match self.branch {
            Branch::Level(c, _) => Surface::Cylinder(c).distance(p),
            _ => (p - self.start).dot(&self.normal),
        }
    }
}

/// Whether the arc runs over its whole closed curve.
fn closes(arc: &DirectedArc<'_>) -> bool {
    arc.curve.period().is_some_and(|period| {
        let [lo, hi] = arc.range;
        hi - lo >= period * (1.0 - ROUNDING)
    })
}
