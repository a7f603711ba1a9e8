//! Paths on a surface along plane sections of it, and their crossings with arcs.
//!
//! A path is a straight line of a plane, a ruling or a parallel of a cylinder or a cone (of an elliptic
//! one an ellipse), a section of a sphere or an ellipsoid through its centre, a parallel of one, or
//! either circle of a torus. Each lies in a plane, so its
//! crossings with an arc are the roots of that plane's distance along the arc. At the top of a
//! torus the plane is tangent, and the cylinder through the path is used. Notation: s is the length
//! along the path, D its direction, N the outward normal of the face, T the direction of an arc.
//! The face lies to the left, towards N × T, so the path enters the face where D·(N × T) > 0.

mod central;
mod crossings;
mod reach;
mod track;

use super::Brep;
use super::topology::{CoedgeId, Sense};
use crate::geometry::bounds::Aabb;
use crate::geometry::curve::Curve;
use crate::geometry::elliptic_surface::{EllipticCone, EllipticCylinder, eccentric_angle};
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Cylinder, Plane, Surface, Torus};
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::{Point3, Vector3};
use reach::Reach;
use track::Track;

/// A piece of a face's boundary. The face lies to the left of its direction, seen from the side to
/// which the face's outward normal points.
#[derive(Clone, Copy, Debug)]
pub struct DirectedArc<'a, N: Float = f64> {
    /// The curve.
    pub curve: &'a Curve<N>,
    /// The range of its parameter, increasing.
    pub range: [N; 2],
    /// Whether it runs in the curve's direction.
    pub sense: Sense,
}

impl<'a, N: Float> DirectedArc<'a, N> {
    /// A coedge of a boundary representation.
    ///
    /// # Panics
    /// The boundary has no such coedge.
    pub fn new(brep: &'a Brep<N>, coedge: CoedgeId) -> Self {
        let coedge = brep.topology.coedge(coedge);
        Self {
            curve: brep.curve(coedge.edge),
            range: brep.range(coedge.edge),
            sense: coedge.sense,
        }
    }

    /// Whether both belong to one edge. If a face has two such arcs, it lies on both sides of the
    /// edge. Several edges may belong to one curve.
    pub(crate) fn shares_edge(&self, other: &Self) -> bool {
        std::ptr::eq(self.curve, other.curve) && self.range == other.range
    }
}

/// How a path crosses an arc.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CrossingSense {
    /// The path enters the face, from the arc's right to its left.
    Entering,
    /// The path leaves the face, from the arc's left to its right.
    Leaving,
    /// The path is tangent to the arc, runs along it, passes an end of it within the resolution, or
    /// crosses it where the arc may turn back within its rounding error. Another path is needed.
    Unclear,
}

/// An intersection of a path with an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathCrossing<N: Float = f64> {
    /// The length along the walk from its start, in the part's unit.
    pub at: N,
    /// The index of the arc.
    pub arc: usize,
    /// The parameter on the arc's curve.
    pub t: N,
    /// How the path crosses the arc.
    pub passage: CrossingSense,
}

/// The part of the plane section that is the path.
#[derive(Clone, Copy, Debug)]
enum Branch<N: Float = f64> {
    Whole,
    /// The part on this side of the plane through the point.
    Half(Point3<N>, Vector3<N>),
    /// The outer (+1) or inner (-1) of a torus's two circles at one height.
    Parallel(Torus<N>, N),
    /// A torus's circle close to its top (+1) or bottom (-1): one of the two circles that it shares
    /// with the cylinder perpendicular to the path's plane.
    Level(Cylinder<N>, N),
}

/// The distance from the top of a torus, relative to the tube's radius, within which the cylinder
/// is used. There the two circles at one height are close to each other, and those at one distance
/// from the axis are not.
const TOP: f64 = 0.5;

/// A path on a surface from a point of it.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePath<N: Float = f64> {
    /// The normal of the plane in which the path lies.
    normal: Vector3<N>,
    start: Point3<N>,
    track: Track<N>,
    branch: Branch<N>,
    length: N,
    reach: Reach,
}

impl<N: Float> SurfacePath<N> {
    fn new(
        start: &Point3<N>,
        normal: Vector3<N>,
        track: Track<N>,
        branch: Branch<N>,
        length: N,
    ) -> Self {
        Self {
            normal,
            start: *start,
            track,
            branch,
            length,
            reach: Reach::new(start, &normal, &track, &branch, length),
        }
    }

    /// An endless straight line in a plane, along the unit vector `direction`.
    pub(crate) fn straight(plane: &Plane<N>, start: &Point3<N>, direction: Vector3<N>) -> Self {
        let normal = direction.cross(&plane.frame.z).unit();
        let track = Track::Line(direction);
        Self::new(start, normal, track, Branch::Whole, N::INFINITY)
    }

    /// The great circle of a sphere from `start` towards `target`, once round; `None` if the two
    /// are antipodal or coincide.
    pub fn great_circle(centre: &Point3<N>, start: &Point3<N>, target: &Point3<N>) -> Option<Self> {
        let arm = start - centre;
        let normal = arm.cross(&(target - centre));
        let size = normal.length();
        let clear = size.is_beyond(arm.length_squared() * N::ROUNDING.sqrt());
        clear.then(|| Self::circle(start, *centre, normal / size, Branch::Whole))
    }

    fn circle(start: &Point3<N>, centre: Point3<N>, axis: Vector3<N>, branch: Branch<N>) -> Self {
        let arm = start - centre;
        let frame = Frame::toward(centre, axis, arm);
        let radius = arm.length();
        let track = Track::Circle(frame, radius);
        Self::new(start, axis, track, branch, N::TAU * radius)
    }

    /// The parallel circle of a cylinder, a cone, a sphere or a torus through `start`, once round
    /// in the given sense about the axis. `None` on the axis and for a plane.
    pub fn parallel(
        surface: &Surface<N>,
        start: &Point3<N>,
        sense: Sense,
        resolution: N,
    ) -> Option<Self> {
        let f = surface.frame();
        let q = f.coordinates(start);
        let rho = q.x.hypot(q.y);
        let branch = match surface {
            Surface::Plane(_) => return None,
            Surface::Ellipsoid(s) => return Self::parallel_of(s, start, sense, resolution),
            Surface::Torus(t) => {
                let away = rho - t.major;
                if away.is_within(N::from_f64(TOP) * t.minor) {
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
        let is_off_axis = rho.is_beyond(resolution.max(N::ROUNDING * q.length()));
        let radii = match surface {
            Surface::EllipticCylinder(s) => Some(s.radii),
            Surface::EllipticCone(s) => Some(s.slopes.map(|slope| slope * q.z)),
            _ => None,
        };
        if let Some(radii) = radii {
            return is_off_axis.then(|| Self::ellipse(start, f.at(centre), radii, sense));
        }
        is_off_axis.then(|| Self::circle(start, centre, f.z * sense.sign::<N>(), branch))
    }

    /// The ellipse through `start` about the centre of a frame, once round.
    fn ellipse(start: &Point3<N>, frame: Frame<N>, [a, b]: [N; 2], sense: Sense) -> Self {
        let frame = match sense {
            Sense::Along => frame,
            Sense::Against => Frame {
                y: -frame.y,
                z: -frame.z,
                ..frame
            },
        };
        let q = frame.coordinates(start);
        let track = Track::Ellipse(frame, [a, b], eccentric_angle([q.x, q.y], [a, b]));
        let length = N::TAU * a.max(b);
        Self::new(start, frame.z, track, Branch::Whole, length)
    }

    /// The endless ruling of a cylinder or a cone through `start`, or at the angle `u` from a
    /// cone's apex. It runs along the axis or, on a cylinder, against it.
    pub fn ruling(surface: &Surface<N>, start: &Point3<N>, u: N, sense: Sense) -> Option<Self> {
        let f = surface.frame();
        let (sin, cos) = u.sin_cos();
        let across = match surface {
            Surface::EllipticCylinder(EllipticCylinder { radii: [a, b], .. })
            | Surface::EllipticCone(EllipticCone { slopes: [a, b], .. }) => {
                f.x * (*a * cos) + f.y * (*b * sin)
            }
            _ => f.x * cos + f.y * sin,
        };
        Self::ruling_over(surface, start, across, sense)
    }

    /// The ruling of a cylinder or a cone through a point of it; for a point on the axis, the one
    /// at angle zero.
    pub(crate) fn ruling_through(
        surface: &Surface<N>,
        start: &Point3<N>,
        sense: Sense,
    ) -> Option<Self> {
        let f = surface.frame();
        let q = f.coordinates(start);
        let rho = q.x.hypot(q.y);
        let radial = match rho.is_above_zero() {
            true => f.x * (q.x / rho) + f.y * (q.y / rho),
            false => f.x,
        };
        Self::ruling_over(surface, start, radial, sense)
    }

    /// The ruling in the direction of a vector perpendicular to the axis: a unit vector, but for an
    /// elliptic surface.
    fn ruling_over(
        surface: &Surface<N>,
        start: &Point3<N>,
        across: Vector3<N>,
        sense: Sense,
    ) -> Option<Self> {
        let f = surface.frame();
        let radial = match surface.is_elliptic() {
            true => across.unit(),
            false => across,
        };
        let direction = match surface {
            Surface::Cylinder(_) | Surface::EllipticCylinder(_) => f.z * sense.sign::<N>(),
            Surface::Cone(c) => f.z * c.cos + radial * c.sin,
            Surface::EllipticCone(c) => {
                let [a, b] = c.slopes;
                let (x, y) = (f.x.dot(&radial), f.y.dot(&radial));
                // The cross section at the height 1 has this distance from the axis there.
                let reach = N::ONE / (x / a).hypot(y / b);
                (f.z + radial * reach).unit()
            }
            _ => return None,
        };
        let branch = Branch::Half(f.origin, radial);
        let track = Track::Line(direction);
        Some(Self::new(
            start,
            f.z.cross(&radial),
            track,
            branch,
            N::INFINITY,
        ))
    }

    /// The circle about the tube of a torus through `start`, once round, with the angle about the
    /// tube increasing or decreasing.
    pub fn tube(torus: &Torus<N>, start: &Point3<N>, sense: Sense) -> Self {
        let f = &torus.frame;
        let q = f.coordinates(start);
        let radial = (f.x * q.x + f.y * q.y).unit();
        let axis = radial.cross(&f.z) * sense.sign::<N>();
        let centre = f.origin + radial * torus.major;
        Self::circle(start, centre, axis, Branch::Half(f.origin, radial))
    }

    /// The meridian of a torus that reaches its axis, through `start`, to the pole to which the angle
    /// about the tube increases or decreases.
    pub fn meridian(torus: &Torus<N>, start: &Point3<N>, sense: Sense) -> Self {
        let q = torus.frame.coordinates(start);
        let [_, v] = Surface::Torus(*torus).parameters(start);
        Self::meridian_through(torus, start, [q.y.atan2(q.x), v], sense)
    }

    /// The meridian from a point at these parameters, which may be a pole. Both poles of a horn torus are
    /// one point with different parameters.
    pub fn meridian_from(torus: &Torus<N>, [u, v]: [N; 2], sense: Sense) -> Self {
        let start = Surface::Torus(*torus).point(u, v);
        Self::meridian_through(torus, &start, [u, v], sense)
    }

    fn meridian_through(torus: &Torus<N>, start: &Point3<N>, [u, v]: [N; 2], sense: Sense) -> Self {
        let f = &torus.frame;
        let (sin, cos) = u.sin_cos();
        let radial = f.x * cos + f.y * sin;
        let axis = radial.cross(&f.z) * sense.sign::<N>();
        let centre = f.origin + radial * torus.major;
        let turn = torus.pole_angle() - v * sense.sign::<N>();
        Self::circle(start, centre, axis, Branch::Half(f.origin, radial)).upto(turn * torus.minor)
    }

    /// The path from the same point in the direction that leads to the side of `left` at `p`.
    pub(super) fn toward(self, p: &Point3<N>, left: &Vector3<N>) -> Self {
        if self.direction(p).dot(left).is_below_zero() {
            self.reversed()
        } else {
            self
        }
    }

    /// The path from the same point in the opposite direction.
    pub(super) fn reversed(self) -> Self {
        let track = self.track.reversed();
        Self::new(&self.start, self.normal, track, self.branch, self.length)
    }

    /// The same path, limited to `length`.
    pub fn upto(self, length: N) -> Self {
        let length = self.length.min(length);
        Self::new(&self.start, self.normal, self.track, self.branch, length)
    }

    /// The length.
    pub fn length(&self) -> N {
        self.length
    }

    /// Whether the path ends where it starts.
    pub(super) fn closes(&self) -> bool {
        let round = self.track.round();
        round.is_some_and(|round| self.length.reaches(round))
    }

    /// The point at the length s.
    pub fn point(&self, s: N) -> Point3<N> {
        self.track.point(&self.start, s)
    }

    /// The length at which the path passes a point of it.
    pub(crate) fn at(&self, p: &Point3<N>) -> N {
        self.track.at(&self.start, p)
    }

    /// The unit direction at a point of the walk.
    pub(super) fn direction(&self, p: &Point3<N>) -> Vector3<N> {
        self.track.direction(p)
    }

    fn passes(&self, p: &Point3<N>, resolution: N) -> bool {
        let inward = match &self.branch {
            Branch::Whole => N::INFINITY,
            Branch::Half(o, side) => (p - o).dot(side),
            Branch::Parallel(t, side) => {
                let q = t.frame.coordinates(p);
                (q.x.hypot(q.y) - t.major) * *side
            }
            Branch::Level(c, side) => (p - c.frame.origin).dot(&c.frame.z) * *side,
        };
        let s = self.at(p);
        inward.is_beyond(-resolution) && s.lies_between([-resolution, self.length + resolution])
    }

    /// Whether the path may pass through a box.
    pub(crate) fn may_intersect(&self, lo: &[f64; 3], hi: &[f64; 3], resolution: N) -> bool {
        self.reach.may_intersect(lo, hi, resolution.above())
    }

    /// [`Self::may_intersect`] of a box.
    pub(crate) fn may_intersect_box(&self, b: &Aabb, resolution: N) -> bool {
        self.may_intersect(&b.min, &b.max, resolution)
    }

    /// The distance of a point from the surface that cuts the path out of its own surface.
    fn off(&self, p: &Point3<N>) -> N {
        match self.branch {
            Branch::Level(c, _) => Surface::Cylinder(c).distance(p),
            _ => (p - self.start).dot(&self.normal),
        }
    }
}
