//! The surfaces that bound solids: planes, quadrics and tori.
//!
//! Each is oriented: its negative side is the inside of the primitive it bounds. A cone is one
//! nappe. Angles are in radians, lengths in the part's unit.

use super::ellipsoid::Ellipsoid;
use super::elliptic_surface::{EllipticCone, EllipticCylinder, eccentric_angle};
use super::frame::Frame;
use crate::geometry::vector::Length;
use crate::number::analytic::dot;
use crate::number::float::{Analytic, Float};
use crate::number::predicates::Compare;
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

/// A torus about its frame's z axis: the points whose distance ρ from the axis and height z satisfy
/// (ρ - major)² + z² = minor².
///
/// It is a ring if the tube does not reach the axis. Otherwise it is one sheet of a horn or spindle
/// torus, which ends in two poles on the axis: the outer sheet (an apple) if `major` is positive,
/// the inner one (a lemon) if it is negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus<N: Float = f64> {
    /// Origin at the centre, z along the axis.
    pub frame: Frame<N>,
    /// The radius of the spine circle; negative for the inner sheet.
    pub major: N,
    /// The radius of the tube, greater than `-major`.
    pub minor: N,
}

impl<N: Float> Torus<N> {
    /// Whether the tube does not reach the axis.
    pub fn is_ring(&self) -> bool {
        self.minor.is_short_of(self.major)
    }

    /// Whether both poles are one point.
    pub fn is_horn(&self) -> bool {
        self.pole_height()
            .is_some_and(|height| height.is_at_most(N::ZERO))
    }

    /// The greatest distance from the axis.
    pub fn reach(&self) -> N {
        self.major + self.minor
    }

    /// The greatest distance from the centre: at the equator, or at the poles of the inner sheet.
    pub fn circumradius(&self) -> N {
        self.pole_height().unwrap_or(N::ZERO).max(self.reach())
    }

    /// The angle about the tube at the upper pole; pi for a ring, whose parallels all have an angle
    /// in [-pi, pi].
    pub fn pole_angle(&self) -> N {
        match self.pole_height() {
            Some(height) if height > N::ZERO => height.atan2(-self.major),
            _ => N::PI,
        }
    }

    /// The height of the poles above and below the centre; `None` for a ring.
    pub fn pole_height(&self) -> Option<N> {
        let square = (self.minor - self.major) * self.reach();
        (!self.is_ring()).then(|| square.max(N::ZERO).sqrt())
    }

    /// The poles: two, or one where both coincide; none of a ring.
    pub fn poles(&self) -> impl Iterator<Item = Point3<N>> + use<N> {
        let (origin, up) = (self.frame.origin, self.frame.z);
        let heights = self
            .pole_height()
            .map(|height| match height.is_above_zero() {
                true => [Some(height), Some(-height)],
                false => [Some(height), None],
            });
        let heights = heights.into_iter().flatten().flatten();
        heights.map(move |height| origin + up * height)
    }

    /// The distance from a pole within which the sheet is within the resolution of the axis, so that
    /// its normal is not known. The sheet leaves the axis along it where both poles are one point.
    pub fn pole_neighbourhood(&self, resolution: N) -> N {
        let along = (N::TWO * self.minor * resolution).sqrt();
        match self.pole_height() {
            Some(height) if height > N::ZERO => along.min(resolution * self.minor / height),
            _ => along,
        }
    }

    /// The side of the sphere through the poles, which separates the sheets: positive on this sheet,
    /// negative on the other, zero at the poles.
    pub fn sheet_level<S: Analytic<Float = N>>(&self, p: [S; 3]) -> S {
        let [x, y, z] = self.frame.local(p);
        let square = S::constant((self.minor - self.major) * self.reach());
        let beyond = x.square() + y.square() + z.square() - square;
        beyond.scale(N::HALF * self.major.signum() / self.minor)
    }
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
    /// A torus.
    Torus(Torus<N>),
    /// An elliptic cylinder.
    EllipticCylinder(EllipticCylinder<N>),
    /// One nappe of an elliptic cone.
    EllipticCone(EllipticCone<N>),
    /// An ellipsoid.
    Ellipsoid(Ellipsoid<N>),
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
    /// An elliptic cylinder.
    EllipticCylinder,
    /// An elliptic cone.
    EllipticCone,
    /// An ellipsoid.
    Ellipsoid,
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
            Self::EllipticCylinder => "elliptic cylinder",
            Self::EllipticCone => "elliptic cone",
            Self::Ellipsoid => "ellipsoid",
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
            Self::EllipticCylinder(_) => SurfaceKind::EllipticCylinder,
            Self::EllipticCone(_) => SurfaceKind::EllipticCone,
            Self::Ellipsoid(_) => SurfaceKind::Ellipsoid,
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
            Self::EllipticCylinder(s) => &s.frame,
            Self::EllipticCone(s) => &s.frame,
            Self::Ellipsoid(s) => &s.frame,
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
            Self::EllipticCylinder(s) => s.level(p),
            Self::EllipticCone(s) => s.level(p),
            Self::Ellipsoid(s) => s.level(p),
        }
    }

    /// The implicit polynomial of the surface; it vanishes on both nappes of a cone, and on both
    /// sheets of a torus.
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
            Self::EllipticCylinder(s) => of_equation(&q, s.equation()),
            Self::EllipticCone(s) => of_equation(&q, s.equation()),
            Self::Ellipsoid(s) => of_equation(&q, s.equation()),
        }
    }

    /// The signed distance of a point, negative inside. It is exact except behind the apex of a cone and behind a pole of a torus, where it is a lower bound of the
    /// distance with the right sign.
    pub fn distance(&self, p: &Point3<N>) -> N {
        let q = self.frame().coordinates(p);
        match self {
            Self::Plane(_) => q.z,
            Self::Cylinder(s) => beyond_circle(q.x, q.y, s.radius),
            Self::Cone(s) => q.x.hypot(q.y) * s.cos - q.z * s.sin,
            Self::Sphere(s) => q.length() - s.radius,
            Self::Torus(s) => (q.x.hypot(q.y) - s.major).hypot(q.z) - s.minor,
            Self::EllipticCylinder(s) => s.distance(&q),
            Self::EllipticCone(s) => s.distance(&q),
            Self::Ellipsoid(s) => s.distance(&q),
        }
    }

    /// The outward unit normal at a point of the surface; at a cone's apex and a torus's pole, the
    /// direction of the axis.
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
                if rho == N::ZERO {
                    return f.z * N::ONE.copysign(q.z);
                }
                let k = (rho - s.major) / rho;
                Vector3::new(q.x * k, q.y * k, q.z)
            }
            Self::EllipticCylinder(s) => s.gradient(&q),
            Self::Ellipsoid(s) => s.gradient(&q),
            Self::EllipticCone(s) => {
                let gradient = s.gradient(&q);
                if gradient == Vector3::zeros() {
                    return -f.z;
                }
                gradient
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
            // The gradient is linear in the coordinates.
            Self::EllipticCylinder(s) => s.gradient(&a).dot(&b) / s.gradient(&q).length(),
            Self::EllipticCone(s) => s.gradient(&a).dot(&b) / s.gradient(&q).length(),
            Self::Ellipsoid(s) => s.gradient(&a).dot(&b) / s.gradient(&q).length(),
        }
    }

    /// Whether it is a torus whose tube does not reach the axis.
    pub fn is_ring_torus(&self) -> bool {
        matches!(self, Self::Torus(torus) if torus.is_ring())
    }

    /// Whether it is elliptic: the image of a round surface under an affine map.
    pub fn is_elliptic(&self) -> bool {
        matches!(
            self,
            Self::EllipticCylinder(_) | Self::EllipticCone(_) | Self::Ellipsoid(_)
        )
    }

    /// The points at which the surface has no normal: the apex of a cone, the poles of a torus.
    pub fn apexes(&self) -> impl Iterator<Item = Point3<N>> + use<N> {
        let (apex, torus) = match self {
            Self::Cone(_) | Self::EllipticCone(_) => (Some(self.frame().origin), None),
            Self::Torus(s) => (None, Some(*s)),
            Self::Plane(_)
            | Self::Cylinder(_)
            | Self::Sphere(_)
            | Self::EllipticCylinder(_)
            | Self::Ellipsoid(_) => (None, None),
        };
        let poles = torus.into_iter().flat_map(|torus| torus.poles());
        apex.into_iter().chain(poles)
    }

    /// The parameters of a point on the surface: (x, y) of a plane; the angle and the height of a
    /// cylinder and of a cone (above the apex); longitude and latitude of a sphere; the angles
    /// about the axis and about the tube of a torus. Those of the elliptic surfaces are those of
    /// the round ones of which they are images. Angles lie in [0, 2 pi), the latitude in
    /// [-pi/2, pi/2], the angle about a tube that reaches the axis in [-pi, pi].
    pub fn parameters(&self, p: &Point3<N>) -> [N; 2] {
        let q = self.frame().coordinates(p);
        match self {
            Self::Plane(_) => [q.x, q.y],
            Self::Cylinder(_) | Self::Cone(_) => [turn(q.y.atan2(q.x)), q.z],
            Self::Sphere(_) => [turn(q.y.atan2(q.x)), q.z.atan2(q.x.hypot(q.y))],
            Self::Torus(s) => {
                let across = q.x.hypot(q.y) - s.major;
                let about_tube = q.z.atan2(across);
                let about_tube = match s.is_ring() {
                    true => turn(about_tube),
                    false => about_tube,
                };
                [turn(q.y.atan2(q.x)), about_tube]
            }
            Self::EllipticCylinder(EllipticCylinder { radii, .. })
            | Self::EllipticCone(EllipticCone { slopes: radii, .. }) => {
                [turn(eccentric_angle([q.x, q.y], *radii)), q.z]
            }
            Self::Ellipsoid(s) => {
                let [u, v] = s.parameters(&q);
                [turn(u), v]
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
            Self::EllipticCylinder(s) => f.point(s.radii[0] * cos, s.radii[1] * sin, v),
            Self::EllipticCone(s) => f.point(v * s.slopes[0] * cos, v * s.slopes[1] * sin, v),
            Self::Ellipsoid(s) => s.point(u, v),
        }
    }

    /// The periods of the two parameters, where periodic.
    pub fn periods(&self) -> [Option<N>; 2] {
        match self {
            Self::Plane(_) => [None, None],
            Self::Cylinder(_)
            | Self::Cone(_)
            | Self::Sphere(_)
            | Self::EllipticCylinder(_)
            | Self::EllipticCone(_)
            | Self::Ellipsoid(_) => [Some(N::TAU), None],
            Self::Torus(s) => [Some(N::TAU), s.is_ring().then_some(N::TAU)],
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

/// The value of an equation without mixed products at a local point: the coefficients of the squares,
/// and the constant.
fn of_equation<N: Float>(q: &Vector3<N>, (squares, constant): ([N; 3], N)) -> N {
    let all: N = (0..3).map(|i| squares[i] * q[i] * q[i]).sum();
    all - constant
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

/// Both sheets of a spindle torus about a frame, the inner one first, and a horn torus, for tests.
#[cfg(test)]
pub(crate) fn sheets(frame: Frame) -> [Torus; 3] {
    [(-3.0, 5.0), (3.0, 5.0), (2.0, 2.0)].map(|(major, minor)| Torus {
        frame,
        major,
        minor,
    })
}

/// One surface of each kind about a frame, for tests.
#[cfg(test)]
pub(crate) fn of_every_kind(frame: Frame, radius: f64, [major, minor]: [f64; 2]) -> [Surface; 8] {
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
        Surface::EllipticCylinder(EllipticCylinder {
            frame,
            radii: [radius, 0.75 * radius],
        }),
        Surface::EllipticCone(EllipticCone {
            frame,
            slopes: [0.75, 0.5],
        }),
        Surface::Ellipsoid(
            Ellipsoid::new(frame, [1.5 * radius, 0.75 * radius, radius])
                .about(Vector3::new(0.48, -0.64, 0.6)),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn frame() -> Frame {
        let axis = Vector3::new(0.3, -0.4, 0.7).normalize();
        Frame::about(Point3::new(1.0, -2.0, 0.5), axis)
    }

    #[test]
    fn a_tube_that_reaches_the_axis_ends_in_poles() {
        let [inner, outer, horn] = sheets(frame());
        // 5² - 3² = 4².
        for torus in [inner, outer] {
            assert!(!torus.is_ring());
            assert_eq!(torus.pole_height(), Some(4.0));
            let poles: Vec<Point3<f64>> = torus.poles().collect();
            for (pole, height) in poles.iter().zip([4.0, -4.0]) {
                assert_relative_eq!(*pole, torus.frame.point(0.0, 0.0, height), epsilon = 1e-14);
                assert!(Surface::Torus(torus).distance(pole).abs() < 1e-14);
            }
        }
        assert_relative_eq!(inner.pole_angle(), 4.0_f64.atan2(3.0));
        assert_relative_eq!(outer.pole_angle(), 4.0_f64.atan2(-3.0));
        assert_eq!([inner, outer].map(|t| t.circumradius()), [4.0, 8.0]);
        assert_eq!(horn.poles().count(), 1);
        assert_relative_eq!(horn.pole_angle(), std::f64::consts::PI);
        let ring = Torus {
            major: 5.0,
            minor: 3.0,
            ..outer
        };
        assert!(ring.is_ring() && ring.poles().next().is_none());
    }

    #[test]
    fn each_point_of_a_spindle_is_on_one_sheet() {
        let [inner, outer, _] = sheets(frame());
        for (own, other) in [(inner, outer), (outer, inner)] {
            let surface = Surface::Torus(own);
            for i in 0..12 {
                for j in -9..10 {
                    let v = own.pole_angle() * f64::from(j) / 9.5;
                    let u = 0.1 + 0.5 * f64::from(i);
                    let p = surface.point(u, v);
                    assert_relative_eq!(surface.parameters(&p)[0], u, epsilon = 1e-12);
                    assert_relative_eq!(surface.parameters(&p)[1], v, epsilon = 1e-12);
                    assert!(surface.distance(&p).abs() < 1e-13);
                    assert!(surface.polynomial(&p).abs() < 1e-10);
                    assert!(own.sheet_level([p.x, p.y, p.z]) > 0.0);
                    assert!(other.sheet_level([p.x, p.y, p.z]) < 0.0);
                    assert!(Surface::Torus(other).distance(&p).abs() > 0.1);
                }
            }
        }
    }
}
