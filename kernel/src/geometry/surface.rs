//! The five surfaces that bound PADL-2 solids.
//!
//! Each is oriented: its negative side is the inside of the primitive it bounds. A cone is one
//! nappe. Angles are in radians, lengths in the part's unit.

use super::frame::Frame;
use crate::number::scalar::{Scalar, dot};
use nalgebra::{Point3, Vector3};
use std::f64::consts::TAU;

/// A plane: its frame's z axis is the normal, pointing to the outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Origin in the plane, z the unit normal.
    pub frame: Frame,
}

/// A circular cylinder about its frame's z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// z along the axis.
    pub frame: Frame,
    /// The radius.
    pub radius: f64,
}

/// One nappe of a circular cone: apex at the frame's origin, opening along +z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Origin at the apex, z along the axis into the nappe.
    pub frame: Frame,
    /// The sine of the half angle.
    pub sin: f64,
    /// The cosine of the half angle.
    pub cos: f64,
}

/// A sphere about its frame's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Origin at the centre; the axes only serve the parameters.
    pub frame: Frame,
    /// The radius.
    pub radius: f64,
}

/// A ring torus about its frame's z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// Origin at the centre, z along the axis.
    pub frame: Frame,
    /// The radius of the spine circle.
    pub major: f64,
    /// The radius of the tube, less than `major`.
    pub minor: f64,
}

/// A surface that can bound a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    /// A plane.
    Plane(Plane),
    /// A circular cylinder.
    Cylinder(Cylinder),
    /// One nappe of a circular cone.
    Cone(Cone),
    /// A sphere.
    Sphere(Sphere),
    /// A ring torus.
    Torus(Torus),
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
    /// The name used in outputs.
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

impl Surface {
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
    pub fn frame(&self) -> &Frame {
        match self {
            Self::Plane(s) => &s.frame,
            Self::Cylinder(s) => &s.frame,
            Self::Cone(s) => &s.frame,
            Self::Sphere(s) => &s.frame,
            Self::Torus(s) => &s.frame,
        }
    }

    /// A smooth function that is zero on the surface, negative inside, with a gradient of length
    /// one on the surface: the signed distance to first order.
    pub fn level<S: Scalar>(&self, p: [S; 3]) -> S {
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
                (x.square() + y.square() - S::constant(s.radius * s.radius)).scale(0.5 / s.radius)
            }
            Self::Cone(s) => {
                let [x, y, z] = s.frame.local(p);
                (x.square() + y.square()).sqrt().scale(s.cos) - z.scale(s.sin)
            }
            Self::Sphere(s) => {
                let [x, y, z] = s.frame.local(p);
                (x.square() + y.square() + z.square() - S::constant(s.radius * s.radius))
                    .scale(0.5 / s.radius)
            }
            Self::Torus(s) => {
                let [x, y, z] = s.frame.local(p);
                let across = (x.square() + y.square()).sqrt() - S::constant(s.major);
                (across.square() + z.square() - S::constant(s.minor * s.minor)).scale(0.5 / s.minor)
            }
        }
    }

    /// The signed distance of a point, negative inside; exact for all five but behind the apex of
    /// a cone, where it is a lower bound of the distance with the right sign.
    pub fn distance(&self, p: &Point3<f64>) -> f64 {
        let q = self.frame().coordinates(p);
        match self {
            Self::Plane(_) => q.z,
            Self::Cylinder(s) => beyond_circle(q.x, q.y, s.radius),
            Self::Cone(s) => q.x.hypot(q.y) * s.cos - q.z * s.sin,
            Self::Sphere(s) => q.norm() - s.radius,
            Self::Torus(s) => (q.x.hypot(q.y) - s.major).hypot(q.z) - s.minor,
        }
    }

    /// The outward unit normal at a point of the surface; along the axis at a cone's apex.
    pub fn normal(&self, p: &Point3<f64>) -> Vector3<f64> {
        let f = self.frame();
        let q = f.coordinates(p);
        let local = match self {
            Self::Plane(_) => return f.z,
            Self::Cylinder(_) => Vector3::new(q.x, q.y, 0.0),
            Self::Cone(s) => {
                let rho = q.x.hypot(q.y);
                if rho == 0.0 {
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
        f.vector(&local.normalize())
    }

    /// The normal curvature of the surface at `p` in the unit tangent direction `t`, positive
    /// where the surface bends towards its inside.
    pub fn normal_curvature(&self, p: &Point3<f64>, t: &Vector3<f64>) -> f64 {
        let f = self.frame();
        let q = f.coordinates(p);
        let t = f.components(t);
        match self {
            Self::Plane(_) => 0.0,
            Self::Cylinder(s) => {
                let along = (q.x * t.y - q.y * t.x) / s.radius;
                along * along / s.radius
            }
            Self::Cone(s) => {
                let rho = q.x.hypot(q.y);
                let along = (q.x * t.y - q.y * t.x) / rho;
                along * along * s.cos / rho
            }
            Self::Sphere(s) => 1.0 / s.radius,
            Self::Torus(s) => {
                let rho = q.x.hypot(q.y);
                let along = (q.x * t.y - q.y * t.x) / rho;
                let cos = (rho - s.major) / s.minor;
                along * along * cos / rho + (1.0 - along * along) / s.minor
            }
        }
    }

    /// The parameters of a point on the surface: a plane's (x, y); the angle and the height of a
    /// cylinder and of a cone (from the apex); longitude and latitude of a sphere; the angle about
    /// the axis and about the tube of a torus. Angles lie in [0, 2 pi), the latitude in
    /// [-pi/2, pi/2].
    pub fn parameters(&self, p: &Point3<f64>) -> [f64; 2] {
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
    pub fn point(&self, u: f64, v: f64) -> Point3<f64> {
        let f = self.frame();
        let (sin, cos) = u.sin_cos();
        match self {
            Self::Plane(_) => f.point(u, v, 0.0),
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

    /// The periods of the two parameters, where they have one.
    pub fn periods(&self) -> [Option<f64>; 2] {
        match self {
            Self::Plane(_) => [None, None],
            Self::Cylinder(_) | Self::Cone(_) | Self::Sphere(_) => [Some(TAU), None],
            Self::Torus(_) => [Some(TAU), Some(TAU)],
        }
    }

    /// The nearest point of the surface to `p`, where it is unique.
    pub fn nearest(&self, p: &Point3<f64>) -> Point3<f64> {
        let mut q = *p;
        for _ in 0..2 {
            q -= self.normal(&q) * self.distance(&q);
        }
        q
    }
}

/// How far (x, y) lies outside the circle of radius r about the origin: (x² + y² - r²)/(ρ + r), with
/// the differences taken so that next to an axis, where planes are tangent, no digits cancel.
fn beyond_circle(x: f64, y: f64, r: f64) -> f64 {
    let (x, y) = (x.abs(), y.abs());
    let (least, most) = if x < y { (x, y) } else { (y, x) };
    (least * least + (most - r) * (most + r)) / ((x * x + y * y).sqrt() + r)
}

/// The angle brought into [0, 2 pi).
pub fn turn(angle: f64) -> f64 {
    let a = angle.rem_euclid(TAU);
    if a >= TAU { 0.0 } else { a }
}
