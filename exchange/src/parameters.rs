//! The parameters of a surface along a curve on it. Those of an elliptic surface are the parameters of
//! the rational B-spline that a file has in its place, which starts at the window's start.

use crate::rational_circle;
use nalgebra::{Point2, Point3, Vector3};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Sphere, Surface, turn};
use premio_kernel::number::float::Analytic;
use premio_kernel::number::jet::Jet;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A surface with the parameter window of a face on it. The window of an angle covers one period
/// from its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterWindow {
    /// The surface.
    pub surface: Surface,
    /// The start of each parameter's window, if the parameter is an angle with a period.
    pub starts: [f64; 2],
    /// The distance of the face from the origin of the surface's frame.
    pub reach: f64,
}

/// atan2(y, x), with two derivatives.
fn angle(y: Jet<f64>, x: Jet<f64>) -> Jet<f64> {
    let square = x.v * x.v + y.v * y.v;
    let d = (x.v * y.d - y.v * x.d) / square;
    let twist = x.v * y.dd - y.v * x.dd;
    Jet {
        v: y.v.atan2(x.v),
        d,
        dd: (twist - 2.0 * d * (x.v * x.d + y.v * y.d)) / square,
    }
}

/// The file's parameter at a latitude of an ellipsoid: that of half a circle from the lower pole.
fn file_latitude(v: f64) -> f64 {
    rational_circle::parameter(v + FRAC_PI_2) - FRAC_PI_2
}

/// The same of a latitude that changes.
fn file_latitude_along(v: Jet<f64>) -> Jet<f64> {
    let quarter = Jet::constant(FRAC_PI_2);
    rational_circle::parameter_along(v + quarter) - quarter
}

impl ParameterWindow {
    /// The parameters of a point that moves on the surface, with two derivatives. They are not
    /// shifted into the window. `None` on the axis, where the angle is undefined.
    pub fn along(&self, p: [Jet<f64>; 3]) -> Option<[Jet<f64>; 2]> {
        let [x, y, z] = self.surface.frame().local(p);
        if matches!(self.surface, Surface::Plane(_)) {
            return Some([x, y]);
        }
        let [x, y, z] = match &self.surface {
            Surface::EllipticCylinder(s) => {
                let [a, b] = s.radii;
                [x.scale(1.0 / a), y.scale(1.0 / b), z]
            }
            Surface::EllipticCone(s) => {
                let [a, b] = s.slopes;
                [x.scale(1.0 / a), y.scale(1.0 / b), z]
            }
            Surface::Ellipsoid(s) => {
                let unit = [x, y, z].into_iter().zip(s.radii);
                let unit: Vec<Jet<f64>> = unit.map(|(x, r)| x.scale(1.0 / r)).collect();
                s.axes.map(|axis| {
                    unit[0].scale(axis.x) + unit[1].scale(axis.y) + unit[2].scale(axis.z)
                })
            }
            _ => [x, y, z],
        };
        let rho = (x.square() + y.square()).root();
        let about = match self.surface.is_elliptic() {
            true => self.file_angle_along(angle(y, x)),
            false => angle(y, x),
        };
        let along = match &self.surface {
            Surface::Plane(_)
            | Surface::Cylinder(_)
            | Surface::Cone(_)
            | Surface::EllipticCylinder(_)
            | Surface::EllipticCone(_) => z,
            Surface::Sphere(_) => angle(z, rho),
            Surface::Ellipsoid(_) => file_latitude_along(angle(z, rho)),
            Surface::Torus(s) => angle(z, rho - Jet::constant(s.major)),
        };
        (about.d.is_finite() && about.dd.is_finite()).then_some([about, along])
    }

    /// The parameters of a point, in the window; on the axis the angle is NaN.
    pub fn parameters_at(&self, p: &Point3<f64>) -> Point2<f64> {
        let [u, v] = self.surface.parameters(p);
        let u = match self.surface {
            Surface::Plane(_) => u,
            _ if self.is_on_axis(p) => f64::NAN,
            _ if self.surface.is_elliptic() => {
                let start = self.starts[0];
                start + rational_circle::parameter(turn(u - start))
            }
            _ => self.within(0, u),
        };
        let v = match self.surface {
            Surface::Ellipsoid(_) => file_latitude(v),
            _ => self.within(1, v),
        };
        Point2::new(u, v)
    }

    /// Whether a point of the surface is on the axis of its angle.
    fn is_on_axis(&self, p: &Point3<f64>) -> bool {
        let q = self.surface.frame().coordinates(p);
        let (away, reach) = match &self.surface {
            Surface::Ellipsoid(s) => (s.on_axes(&q).xy().norm(), 1.0),
            _ => (q.x.hypot(q.y), self.reach),
        };
        away <= AXIS * reach
    }

    /// The file's parameter at an angle that changes, in the window.
    fn file_angle_along(&self, angle: Jet<f64>) -> Jet<f64> {
        let start = self.starts[0];
        let from_start = Jet {
            v: turn(angle.v - start),
            ..angle
        };
        let parameter = rational_circle::parameter_along(from_start);
        Jet {
            v: start + parameter.v,
            ..parameter
        }
    }

    /// The surface's own angle at a parameter.
    pub fn angle_at(&self, u: f64) -> f64 {
        match self.surface.is_elliptic() {
            true => self.starts[0] + rational_circle::angle(turn(u - self.starts[0])),
            false => u,
        }
    }

    /// The same window with its seam at an angle of the surface, which the surface is turned to
    /// unless it is elliptic.
    pub fn cut_at(&self, angle: f64) -> Self {
        let mut cut = *self;
        match self.surface.is_elliptic() {
            true => cut.starts[0] = angle,
            false => cut.surface = turned(&self.surface, angle),
        }
        cut
    }

    /// A parameter shifted into the window.
    fn within(&self, i: usize, x: f64) -> f64 {
        match self.surface.periods()[i] {
            Some(_) => self.starts[i] + turn(x - self.starts[i]),
            None => x,
        }
    }

    /// The shift of consecutive parameters along a curve that moves their middle into the window.
    pub fn shift(&self, i: usize, middle: f64) -> f64 {
        self.within(i, middle) - middle
    }

    /// The point with the given parameters.
    pub fn point(&self, uv: [f64; 2]) -> Point3<f64> {
        let v = match self.surface {
            Surface::Ellipsoid(_) => rational_circle::angle(uv[1] + FRAC_PI_2) - FRAC_PI_2,
            _ => uv[1],
        };
        self.surface.point(self.angle_at(uv[0]), v)
    }

    /// The value that differs from `x` by whole periods and is closest to `other`.
    pub fn nearest_equivalent(&self, i: usize, x: f64, other: f64) -> f64 {
        match self.surface.periods()[i] {
            Some(_) => x + TAU * ((other - x) / TAU).round(),
            None => x,
        }
    }
}

/// The distance from the axis, relative to the face's reach, within which a point is on the axis.
const AXIS: f64 = 1.0 / (1u64 << 36) as f64;

/// The same surface with its angle measured from another ruling or meridian.
fn turned(surface: &Surface, by: f64) -> Surface {
    let (sin, cos) = by.sin_cos();
    let f = surface.frame();
    let x = f.x * cos + f.y * sin;
    let frame = Frame {
        x,
        y: f.z.cross(&x),
        ..*f
    };
    placed(surface, frame)
}

/// A sphere or an ellipsoid with another axis of its parameters; any other surface as it is.
pub fn with_axis(surface: &Surface, z: Vector3<f64>) -> Surface {
    match surface {
        Surface::Sphere(sphere) if z != sphere.frame.z => Surface::Sphere(Sphere {
            frame: Frame::about(sphere.frame.origin, z),
            ..*sphere
        }),
        Surface::Ellipsoid(s) if z != s.axes[2] => Surface::Ellipsoid(s.about(z)),
        other => *other,
    }
}

fn placed(surface: &Surface, frame: Frame) -> Surface {
    let mut placed = *surface;
    match &mut placed {
        Surface::Plane(s) => s.frame = frame,
        Surface::Cylinder(s) => s.frame = frame,
        Surface::Cone(s) => s.frame = frame,
        Surface::Sphere(s) => s.frame = frame,
        Surface::Torus(s) => s.frame = frame,
        Surface::EllipticCylinder(s) => s.frame = frame,
        Surface::EllipticCone(s) => s.frame = frame,
        Surface::Ellipsoid(s) => s.frame = frame,
    }
    placed
}
