//! Surfaces as represented in a STEP file, and the flow through them.
//!
//! For a surface S(u, v) with F = S · (S_u × S_v) / 3, the volume between a face and the origin is
//! the integral of F over the face. By Green's theorem that is the integral of -P du along its
//! loops, where P is the integral of F by v. For cones v is measured from the apex, for spheres and
//! the sheets of tori from the south pole, so that P is zero there.

use super::curve::Placement;
use super::oval::OvalSurface;
use super::ruled::RuledSurface;
use nalgebra::{Point3, Vector3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// A surface.
#[derive(Clone, Debug)]
pub struct StepSurface {
    pub place: Placement,
    pub form: SurfaceForm,
}

/// The form of a surface, with its sizes.
#[derive(Clone, Copy, Debug)]
pub enum SurfaceForm {
    Plane,
    Cylinder {
        radius: f64,
    },
    /// With the radius in the plane of the placement.
    Cone {
        radius: f64,
        slope: f64,
    },
    Sphere {
        radius: f64,
    },
    Torus {
        major: f64,
        minor: f64,
    },
    /// The surface of revolution of a circle from pole to pole; v is the angle from the south pole.
    Sheet {
        major: f64,
        minor: f64,
        /// The angle about the circle at the north pole.
        end: f64,
    },
    /// A rational B-spline between two ellipses. Its u is the angle about them; only points are asked
    /// for by the parameters of the spline.
    Ruled(RuledSurface),
    /// A rational B-spline of an ellipsoid, with its own latitude as v.
    Oval(OvalSurface),
}

/// What is integrated over a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaceQuantity {
    /// The volume between the face and a point.
    Volume,
    /// The area.
    Area,
}

/// The relative difference of the radii of a torus below which it is like a horn torus at its poles.
const HORN: f64 = 1.0 / 256.0;

/// Where an edge to the pole of a horn torus is first evaluated.
const AT_HORN: f64 = 1.0 / 512.0;

/// Where an edge to another pole is first evaluated.
const AT_POLE: f64 = 1.0 / (1 << 20) as f64;

/// A point at which the angle about the axis is undefined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pole {
    /// An apex, or a sphere's south pole.
    South,
    /// A sphere's north pole, or the apex of a cone that opens downwards.
    North,
}

impl StepSurface {
    /// The distance of a point.
    pub fn distance(&self, p: &Point3<f64>) -> f64 {
        let q = self.place.local(p);
        let rho = q.x.hypot(q.y);
        match self.form {
            SurfaceForm::Plane => q.z,
            SurfaceForm::Cylinder { radius } => rho - radius,
            SurfaceForm::Cone { radius, slope } => {
                (rho - (radius + q.z * slope).abs()) / (1.0 + slope * slope).sqrt()
            }
            SurfaceForm::Sphere { radius } => q.norm() - radius,
            SurfaceForm::Torus { major, minor } | SurfaceForm::Sheet { major, minor, .. } => {
                (rho - major).hypot(q.z) - minor
            }
            SurfaceForm::Ruled(surface) => surface.distance(p),
            SurfaceForm::Oval(surface) => surface.distance(p),
        }
    }

    /// Whether u is an angle about the axis.
    pub fn has_angle(&self) -> bool {
        !matches!(self.form, SurfaceForm::Plane)
    }

    /// The point with given parameters, in the parameterisation of ISO 10303-42.
    pub fn point(&self, [u, v]: [f64; 2]) -> Point3<f64> {
        let Placement { origin, x, y, z } = self.place;
        let about = x * u.cos() + y * u.sin();
        match self.form {
            SurfaceForm::Plane => origin + x * u + y * v,
            SurfaceForm::Cylinder { radius } => origin + about * radius + z * v,
            SurfaceForm::Cone { radius, slope } => origin + about * (radius + v * slope) + z * v,
            SurfaceForm::Sphere { radius } => origin + (about * v.cos() + z * v.sin()) * radius,
            SurfaceForm::Torus { major, minor } => {
                origin + about * (major + minor * v.cos()) + z * (minor * v.sin())
            }
            SurfaceForm::Sheet { major, minor, end } => {
                let v = v - end;
                origin + about * (major + minor * v.cos()) + z * (minor * v.sin())
            }
            SurfaceForm::Ruled(surface) => surface.point([u, v]),
            SurfaceForm::Oval(surface) => surface.point([u, v]),
        }
    }

    /// The pole close to the end `p` of an edge, if there is one; `inner` is a point of the edge near
    /// that end. Both poles of a sheet may be one point.
    pub fn pole(&self, p: &Point3<f64>, inner: &Point3<f64>, tolerance: f64) -> Option<Pole> {
        let q = self.place.local(p);
        let is_on_axis = q.x.hypot(q.y) <= tolerance;
        match self.form {
            SurfaceForm::Cone { slope, .. } if is_on_axis => match slope > 0.0 {
                true => Some(Pole::South),
                false => Some(Pole::North),
            },
            SurfaceForm::Sheet { .. } if is_on_axis => match self.place.local(inner).z < 0.0 {
                true => Some(Pole::South),
                false => Some(Pole::North),
            },
            SurfaceForm::Ruled(surface) => match surface.apex(p, tolerance)? {
                true => Some(Pole::South),
                false => Some(Pole::North),
            },
            SurfaceForm::Oval(surface) => match surface.pole(p, tolerance)? {
                true => Some(Pole::South),
                false => Some(Pole::North),
            },
            SurfaceForm::Sphere { .. } if is_on_axis => match q.z < 0.0 {
                true => Some(Pole::South),
                false => Some(Pole::North),
            },
            _ => None,
        }
    }

    /// The distance from a pole at which an edge is first evaluated, relative to its first piece. An edge is
    /// tangent to the axis at the pole of a horn torus: its distance from the axis is the square of that from
    /// the pole, and so small a number does not give the angle.
    pub fn next_to_pole(&self) -> f64 {
        match self.form {
            SurfaceForm::Sheet { major, minor, .. } if minor - major < HORN * minor => AT_HORN,
            _ => AT_POLE,
        }
    }

    /// v at the north pole of a surface of revolution of a circle.
    pub fn north_of_sheet(&self) -> Option<f64> {
        match self.form {
            SurfaceForm::Sheet { end, .. } => Some(2.0 * end),
            _ => None,
        }
    }

    /// u and v of a point, with angles between -pi and pi.
    pub fn parameters(&self, p: &Point3<f64>) -> [f64; 2] {
        let q = self.place.local(p);
        let rho = q.x.hypot(q.y);
        let angle = q.y.atan2(q.x);
        match self.form {
            SurfaceForm::Plane => [q.x, q.y],
            SurfaceForm::Cylinder { .. } | SurfaceForm::Cone { .. } => [angle, q.z],
            SurfaceForm::Sphere { .. } => [angle, q.z.atan2(rho)],
            SurfaceForm::Torus { major, .. } => [angle, q.z.atan2(rho - major)],
            SurfaceForm::Sheet { major, end, .. } => [angle, q.z.atan2(rho - major) + end],
            SurfaceForm::Ruled(surface) => surface.parameters(p),
            SurfaceForm::Oval(surface) => surface.parameters(p),
        }
    }

    /// The derivative of u along a curve that moves by `d` at a point.
    pub fn u_speed(&self, p: &Point3<f64>, d: &Vector3<f64>) -> f64 {
        match &self.form {
            SurfaceForm::Ruled(surface) => return surface.angular_speed(p, d),
            SurfaceForm::Oval(surface) => return surface.angular_speed(p, d),
            _ => {}
        }
        let (q, d) = (self.place.local(p), self.place.turned(d));
        match self.form {
            SurfaceForm::Plane => d.x,
            _ => (q.x * d.y - q.y * d.x) / (q.x * q.x + q.y * q.y),
        }
    }

    /// P of a quantity at given parameters, relative to a reference point.
    pub fn flow(&self, quantity: FaceQuantity, at: [f64; 2], about: &Point3<f64>) -> f64 {
        match quantity {
            FaceQuantity::Volume => self.volume_flow(at, about),
            FaceQuantity::Area => self.area_flow(at),
        }
    }

    /// P of the area, whose F is the length of S_u × S_v.
    fn area_flow(&self, [u, v]: [f64; 2]) -> f64 {
        match self.form {
            SurfaceForm::Plane => v,
            SurfaceForm::Cylinder { radius } => radius * v,
            SurfaceForm::Cone { radius, slope } => {
                let rho = radius + v * slope;
                0.5 * rho * rho / slope * (1.0 + slope * slope).sqrt()
            }
            SurfaceForm::Sphere { radius } => radius * radius * (v.sin() + 1.0),
            SurfaceForm::Torus { major, minor } => minor * (major * v + minor * v.sin()),
            SurfaceForm::Sheet { major, minor, end } => {
                minor * (major * v + minor * ((v - end).sin() + end.sin()))
            }
            SurfaceForm::Ruled(surface) => surface.area_flow([u, v]),
            SurfaceForm::Oval(surface) => surface.area_flow([u, v]),
        }
    }

    fn volume_flow(&self, [u, v]: [f64; 2], about: &Point3<f64>) -> f64 {
        match &self.form {
            SurfaceForm::Ruled(surface) => return surface.volume_flow([u, v], about),
            SurfaceForm::Oval(surface) => return surface.volume_flow([u, v], about),
            _ => {}
        }
        let o = self.place.turned(&(self.place.origin - about));
        let (sin_u, cos_u) = u.sin_cos();
        let out = o.x * cos_u + o.y * sin_u;
        let (sin, cos) = v.sin_cos();
        let three = match self.form {
            SurfaceForm::Plane => v * o.z,
            SurfaceForm::Cylinder { radius } => v * radius * (radius + out),
            SurfaceForm::Cone { radius, slope } => {
                let rho = radius + v * slope;
                0.5 * rho * rho / slope * (out - slope * o.z + radius)
            }
            SurfaceForm::Sphere { radius } => {
                let level = radius * (sin + 1.0) - 0.5 * o.z * cos * cos;
                radius * radius * (level + out * (0.5 * (v + sin * cos) + FRAC_PI_4))
            }
            SurfaceForm::Torus { major, minor } => torus_flow([major, minor], v, out, o.z),
            SurfaceForm::Sheet { major, minor, end } => {
                let [here, south] =
                    [v - end, -end].map(|v| torus_flow([major, minor], v, out, o.z));
                here - south
            }
            SurfaceForm::Ruled(_) | SurfaceForm::Oval(_) => 0.0,
        };
        three / 3.0
    }

    /// The integral of P du at a pole, from one angle to another.
    pub fn flow_at_pole(
        &self,
        quantity: FaceQuantity,
        pole: Pole,
        [from, to]: [f64; 2],
        about: &Point3<f64>,
    ) -> f64 {
        if let (SurfaceForm::Sheet { .. }, Pole::North) = (self.form, pole) {
            return self.flow_at_north_of_sheet(quantity, [from, to], about);
        }
        if let (SurfaceForm::Oval(surface), Pole::North) = (&self.form, pole) {
            return match quantity {
                FaceQuantity::Volume => surface.volume_at_north([from, to], about),
                FaceQuantity::Area => surface.area_at_north([from, to]),
            };
        }
        let (SurfaceForm::Sphere { radius }, Pole::North) = (self.form, pole) else {
            return 0.0;
        };
        if quantity == FaceQuantity::Area {
            return 2.0 * radius * radius * (to - from);
        }
        let o = self.place.turned(&(self.place.origin - about));
        let out = o.x * (to.sin() - from.sin()) - o.y * (to.cos() - from.cos());
        radius * radius * (2.0 * radius * (to - from) + FRAC_PI_2 * out) / 3.0
    }

    /// The integral of P du at the north pole of a sheet. P is a constant and a multiple of the
    /// distance of the axis in the direction of u.
    fn flow_at_north_of_sheet(
        &self,
        quantity: FaceQuantity,
        [from, to]: [f64; 2],
        about: &Point3<f64>,
    ) -> f64 {
        let SurfaceForm::Sheet { major, minor, end } = self.form else {
            return 0.0;
        };
        if quantity == FaceQuantity::Area {
            return self.area_flow([0.0, 2.0 * end]) * (to - from);
        }
        let o = self.place.turned(&(self.place.origin - about));
        let at = |out: f64| {
            let [north, south] = [end, -end].map(|v| torus_flow([major, minor], v, out, o.z));
            north - south
        };
        let (constant, rate) = (at(0.0), at(1.0) - at(0.0));
        let out = o.x * (to.sin() - from.sin()) - o.y * (to.cos() - from.cos());
        (constant * (to - from) + rate * out) / 3.0
    }
}

/// Three times P of the volume on a torus, with the position of its centre outwards and upwards.
fn torus_flow([a, r]: [f64; 2], v: f64, out: f64, up: f64) -> f64 {
    let (sin, cos) = v.sin_cos();
    let out = out + a;
    r * ((a * out + r * r) * sin - a * up * cos
        + a * r * v
        + r * out * 0.5 * (v + sin * cos)
        + 0.5 * r * up * sin * sin)
}
