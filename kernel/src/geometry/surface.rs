//! The five surfaces that bound PADL-2 solids.
//!
//! Each is oriented: its negative side is the inside of the primitive it bounds. A cone is one
//! nappe. Angles are in radians, lengths in the part's unit.

use super::frame::Frame;
use crate::geometry::vector::Length;
use crate::number::analytic::dot;
use crate::number::float::{Analytic, Float};
use nalgebra::{Point3, Vector3};

/// A plane: its frame's z axis is the normal, pointing to the outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane<N: Float = f64> {
    /// Origin in the plane, z the unit normal.
    pub frame: Frame<N>,
}

/// A circular cylinder about its frame's z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<N: Float = f64> {
    /// z along the axis.
    pub frame: Frame<N>,
    /// The radius.
    pub radius: N,
}

/// One nappe of a circular cone: apex at the frame's origin, opening along +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<N: Float = f64> {
    /// Origin at the apex, z along the axis into the nappe.
    pub frame: Frame<N>,
    /// The sine of the half angle.
    pub sin: N,
    /// The cosine of the half angle.
    pub cos: N,
}

/// A sphere about its frame's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere<N: Float = f64> {
    /// Origin at the centre; the axes only define the parameters.
    pub frame: Frame<N>,
    /// The radius.
    pub radius: N,
}

/// A ring torus about its frame's z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus<N: Float = f64> {
    /// Origin at the centre, z along the axis.
    pub frame: Frame<N>,
    /// The radius of the spine circle.
    pub major: N,
    /// The radius of the tube, less than `major`.
    pub minor: N,
}

/// A surface that can bound a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface<N: Float = f64> {
    /// A plane.
    Plane(Plane<N>),
    /// A circular cylinder.
    Cylinder(Cylinder<N>),
    /// One nappe of a circular cone.
    Cone(Cone<N>),
    /// A sphere.
    Sphere(Sphere<N>),
    /// A ring torus.
    Torus(Torus<N>),
}

/// The kinds of surfaces, by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SurfaceKind {
    /// A plane.
    Plane,
    /// A circular cylinder.
    Cylinder,
    /// A circular cone.
    Cone,
    /// A sphere.
    Sphere,
    /// A torus.
    Torus,
}

impl SurfaceKind {
    /// The name used in output.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plane => "plane",
            Self::Cylinder => "cylinder",
            Self::Cone => "cone",
            Self::Sphere => "sphere",
            Self::Torus => "torus",
        }
    }
}

impl<N: Float> Surface<N> {
    /// The kind of surface.
    pub fn kind(&self) -> SurfaceKind {
        match self {
            Self::Plane(_) => SurfaceKind::Plane,
            Self::Cylinder(_) => SurfaceKind::Cylinder,
            Self::Cone(_) => SurfaceKind::Cone,
            Self::Sphere(_) => SurfaceKind::Sphere,
            Self::Torus(_) => SurfaceKind::Torus,
        }
    }

    /// The surface's frame.
    pub fn frame(&self) -> &Frame<N> {
        match self {
            Self::Plane(s) => &s.frame,
            Self::Cylinder(s) => &s.frame,
            Self::Cone(s) => &s.frame,
            Self::Sphere(s) => &s.frame,
            Self::Torus(s) => &s.frame,
        }
    }

    /// The implicit function: smooth, zero on the surface, negative inside, with a gradient of
    /// length one on the surface. It is the signed distance to first order.
    pub fn level<S: Analytic<Float = N>>(&self, p: [S; 3]) -> S {
        match self {
            Self::Plane(s) => {
                let o = &s.frame.origin;
                let d = [
                    p[0] - S::constant(o.x),
                    p[1] - S::constant(o.y),
                    p[2] - S::constant(o.z),
                ];
                dot(&s.frame.z, d)
            }
            Self::Cylinder(s) => {
                let [x, y, _] = s.frame.local(p);
                (x.square() + y.square() - S::constant(s.radius * s.radius))
                    .scale(N::HALF / s.radius)
            }
            Self::Cone(s) => {
                let [x, y, z] = s.frame.local(p);
                (x.square() + y.square()).root().scale(s.cos) - z.scale(s.sin)
            }
            Self::Sphere(s) => {
                let [x, y, z] = s.frame.local(p);
                (x.square() + y.square() + z.square() - S::constant(s.radius * s.radius))
                    .scale(N::HALF / s.radius)
            }
            Self::Torus(s) => {
                let [x, y, z] = s.frame.local(p);
                let across = (x.square() + y.square()).root() - S::constant(s.major);
                (across.square() + z.square() - S::constant(s.minor * s.minor))
                    .scale(N::HALF / s.minor)
            }
        }
    }

    /// The implicit polynomial of the surface; for a cone it vanishes on both nappes.
    pub(crate) fn polynomial(&self, p: &Point3<N>) -> N {
        let q = self.frame().coordinates(p);
        let across = q.x * q.x + q.y * q.y;
        match self {
            Self::Plane(_) => q.z,
            Self::Cylinder(s) => across - s.radius * s.radius,
            Self::Sphere(s) => across + q.z * q.z - s.radius * s.radius,
            Self::Cone(s) => across * s.cos * s.cos - q.z * q.z * s.sin * s.sin,
            Self::Torus(s) => {
                let sum = across + q.z * q.z + s.major * s.major - s.minor * s.minor;
                sum * sum - N::from_f64(4.0) * s.major * s.major * across
            }
        }
    }

    /// The signed distance of a point, negative inside. It is exact for all five surfaces except
    /// behind the apex of a cone, where it is a lower bound of the distance with the right sign.
    pub fn distance(&self, p: &Point3<N>) -> N {
        let q = self.frame().coordinates(p);
        match self {
            Self::Plane(_) => q.z,
            Self::Cylinder(s) => beyond_circle(q.x, q.y, s.radius),
            Self::Cone(s) => q.x.hypot(q.y) * s.cos - q.z * s.sin,
            Self::Sphere(s) => q.length() - s.radius,
            Self::Torus(s) => (q.x.hypot(q.y) - s.major).hypot(q.z) - s.minor,
        }
    }

    /// The outward unit normal at a point of the surface; at a cone's apex, the direction of the
    /// axis.
    pub fn normal(&self, p: &Point3<N>) -> Vector3<N> {
        let f = self.frame();
        let q = f.coordinates(p);
        let local = match self {
            Self::Plane(_) => return f.z,
            Self::Cylinder(_) => Vector3::new(q.x, q.y, N::ZERO),
            Self::Cone(s) => {
                let rho = q.x.hypot(q.y);
                if rho == N::ZERO {
                    return -f.z;
                }
                Vector3::new(q.x / rho * s.cos, q.y / rho * s.cos, -s.sin)
            }
            Self::Sphere(_) => q,
            Self::Torus(s) => {
                let rho = q.x.hypot(q.y);
                let k = (rho - s.major) / rho;
                Vector3::new(q.x * k, q.y * k, q.z)
            }
        };
        f.vector(&local.unit())
    }

    /// The normal curvature of the surface at `p` in the unit tangent direction `t`, positive
    /// where the surface bends towards its inside.
    pub fn normal_curvature(&self, p: &Point3<N>, t: &Vector3<N>) -> N {
        self.second_form(p, t, t)
    }

    /// The second fundamental form dN(a)·b at `p` for two tangent vectors: the change of the
    /// outward normal along `a`, measured along `b`. It is positive where the surface bends towards
    /// its inside.
    pub fn second_form(&self, p: &Point3<N>, a: &Vector3<N>, b: &Vector3<N>) -> N {
        let f = self.frame();
        let q = f.coordinates(p);
        let (a, b) = (f.components(a), f.components(b));
        // The component of a tangent vector along the parallel circle, from its distance to the
        // axis.
        let along = |t: &Vector3<N>, rho: N| (q.x * t.y - q.y * t.x) / rho;
        match self {
            Self::Plane(_) => N::ZERO,
            Self::Cylinder(s) => along(&a, s.radius) * along(&b, s.radius) / s.radius,
            Self::Cone(s) => {
                let rho = q.x.hypot(q.y);
                along(&a, rho) * along(&b, rho) * s.cos / rho
            }
            Self::Sphere(s) => a.dot(&b) / s.radius,
            Self::Torus(s) => {
                let rho = q.x.hypot(q.y);
                let parallel = along(&a, rho) * along(&b, rho);
                let cos = (rho - s.major) / s.minor;
                parallel * cos / rho + (a.dot(&b) - parallel) / s.minor
            }
        }
    }

    /// The parameters of a point on the surface: (x, y) of a plane; the angle and the height of a
    /// cylinder and of a cone (above the apex); longitude and latitude of a sphere; the angles
    /// about the axis and about the tube of a torus. Angles lie in [0, 2 pi), the latitude in
    /// [-pi/2, pi/2].
    pub fn parameters(&self, p: &Point3<N>) -> [N; 2] {
        let q = self.frame().coordinates(p);
        match self {
            Self::Plane(_) => [q.x, q.y],
            Self::Cylinder(_) | Self::Cone(_) => [turn(q.y.atan2(q.x)), q.z],
            Self::Sphere(_) => [turn(q.y.atan2(q.x)), q.z.atan2(q.x.hypot(q.y))],
            Self::Torus(s) => {
                let across = q.x.hypot(q.y) - s.major;
                [turn(q.y.atan2(q.x)), turn(q.z.atan2(across))]
            }
        }
    }

    /// The point with the given parameters.
    pub fn point(&self, u: N, v: N) -> Point3<N> {
        let f = self.frame();
        let (sin, cos) = u.sin_cos();
        match self {
            Self::Plane(_) => f.point(u, v, N::ZERO),
            Self::Cylinder(s) => f.point(s.radius * cos, s.radius * sin, v),
            Self::Cone(s) => {
                let rho = v * s.sin / s.cos;
                f.point(rho * cos, rho * sin, v)
            }
            Self::Sphere(s) => {
                let rho = s.radius * v.cos();
                f.point(rho * cos, rho * sin, s.radius * v.sin())
            }
            Self::Torus(s) => {
                let rho = s.major + s.minor * v.cos();
                f.point(rho * cos, rho * sin, s.minor * v.sin())
            }
        }
    }

    /// The periods of the two parameters, where periodic.
    pub fn periods(&self) -> [Option<N>; 2] {
        match self {
            Self::Plane(_) => [None, None],
            Self::Cylinder(_) | Self::Cone(_) | Self::Sphere(_) => [Some(N::TAU), None],
            Self::Torus(_) => [Some(N::TAU), Some(N::TAU)],
        }
    }

    /// The nearest point of the surface to `p`, where it is unique.
    pub fn nearest(&self, p: &Point3<N>) -> Point3<N> {
        let mut q = *p;
        for _ in 0..2 {
            q -= self.normal(&q) * self.distance(&q);
        }
        q
    }
}

/// The distance of (x, y) outside the circle of radius r about the origin: (x² + y² - r²)/(ρ + r).
/// The differences are taken so that no digits cancel close to an axis, where planes are tangent.
fn beyond_circle<N: Float>(x: N, y: N, r: N) -> N {
    let (x, y) = (x.abs(), y.abs());
    let (least, most) = if x < y { (x, y) } else { (y, x) };
    (least * least + (most - r) * (most + r)) / ((x * x + y * y).sqrt() + r)
}

/// The angle modulo 2 pi, in [0, 2 pi).
pub fn turn<N: Float>(angle: N) -> N {
    let a = angle.rem_euclid(N::TAU);
    if a >= N::TAU { N::ZERO } else { a }
}

/// One surface of each kind about a frame, for tests.
#[cfg(test)]
pub(crate) fn of_every_kind(frame: Frame, radius: f64, [major, minor]: [f64; 2]) -> [Surface; 5] {
    let (sin, cos) = (0.6, 0.8);
    [
        Surface::Plane(Plane { frame }),
        Surface::Cylinder(Cylinder { frame, radius }),
        Surface::Cone(Cone { frame, sin, cos }),
        Surface::Sphere(Sphere { frame, radius }),
        Surface::Torus(Torus {
            frame,
            major,
            minor,
        }),
    ]
}
