//! Elliptic cylinders and cones as rational B-spline surfaces between two ellipses.
//!
//! Notation: S = o + z v + (x cos φ + y sin φ) ρ with ρ = a + g v, e = x cos φ + y sin φ, e' its
//! derivative, D = x·(y × z). Then S·(S_u × S_v) = ρ φ_u (k + a D) with
//! k = o·(e' × z) - g o·(x × y), and the integral of ρ by v is R = a v, or ρ²/2g.

use super::net_ellipse::{AROUND, NetEllipse, SAME, angle_of_arcs};
use nalgebra::{Matrix3, Point3, Vector3};

/// A surface with straight lines between similar ellipses in parallel planes.
#[derive(Clone, Copy, Debug)]
pub struct RuledSurface {
    /// o.
    origin: Point3<f64>,
    /// x, y and z as columns, and the inverse.
    axes: Matrix3<f64>,
    inverse: Matrix3<f64>,
    /// a and g.
    base: f64,
    growth: f64,
    /// The parameter at which φ is zero.
    start: f64,
}

impl RuledSurface {
    /// The surface with two rings of control points, the parameter of their first point, and the range
    /// of the second parameter. `None` if the rings are no ellipses, or not similar ones.
    pub fn new(
        rings: &[[Point3<f64>; AROUND]; 2],
        start: f64,
        [low, high]: [f64; 2],
    ) -> Option<Self> {
        let radii = |ring: &[Point3<f64>; AROUND]| {
            (ring[0] - ring[4]).norm() + (ring[2] - ring[6]).norm() + ring[0].coords.norm()
        };
        let size = radii(&rings[0]) + radii(&rings[1]);
        let [lower, upper] = [0, 1].map(|end| NetEllipse::new(&rings[end], size));
        let [(c0, x0, y0), (c1, x1, y1)] = [lower?, upper?].map(|e| (e.centre.coords, e.x, e.y));
        // The larger ellipse has the axes.
        let is_upper = x1.norm() + y1.norm() >= x0.norm() + y0.norm();
        let (x, y) = if is_upper { (x1, y1) } else { (x0, y0) };
        let length = x.norm_squared() + y.norm_squared();
        let of = |u: &Vector3<f64>, v: &Vector3<f64>| (u.dot(&x) + v.dot(&y)) / length;
        let [r0, r1] = [of(&x0, &y0), of(&x1, &y1)];
        let similar = [(x0, y0, r0), (x1, y1, r1)];
        let mut off = similar
            .iter()
            .map(|(u, v, r)| (u - x * *r).norm() + (v - y * *r).norm());
        if !off.all(|off| off <= SAME * size) || low >= high {
            return None;
        }
        let growth = (r1 - r0) / (high - low);
        let z = (c1 - c0) / (high - low);
        let axes = Matrix3::from_columns(&[x, y, z]);
        Some(Self {
            origin: Point3::from(c0 - z * low),
            axes,
            inverse: axes.try_inverse()?,
            base: r0 - growth * low,
            growth: if growth.abs() * (high - low) <= SAME {
                0.0
            } else {
                growth
            },
            start,
        })
    }

    fn local(&self, p: &Point3<f64>) -> Vector3<f64> {
        self.inverse * (p - self.origin)
    }

    /// The distance of a point, to first order.
    pub fn distance(&self, p: &Point3<f64>) -> f64 {
        let q = self.local(p);
        let rho = q.x.hypot(q.y);
        let gradient = Vector3::new(q.x / rho, q.y / rho, -self.growth);
        let slope = (self.inverse.transpose() * gradient).norm();
        let off = rho - (self.base + self.growth * q.z).abs();
        match slope.is_finite() {
            true => off / slope,
            false => off * self.axes.norm(),
        }
    }

    /// The point with the parameters of the B-spline.
    pub fn point(&self, [u, v]: [f64; 2]) -> Point3<f64> {
        let (sin, cos) = angle_of_arcs(u - self.start).sin_cos();
        let rho = self.base + self.growth * v;
        self.origin + self.axes * Vector3::new(rho * cos, rho * sin, v)
    }

    /// φ and v of a point.
    pub fn parameters(&self, p: &Point3<f64>) -> [f64; 2] {
        let q = self.local(p);
        [q.y.atan2(q.x), q.z]
    }

    /// The derivative of φ along a curve that moves by `d` at a point.
    pub fn angular_speed(&self, p: &Point3<f64>, d: &Vector3<f64>) -> f64 {
        let (q, d) = (self.local(p), self.inverse * d);
        (q.x * d.y - q.y * d.x) / (q.x * q.x + q.y * q.y)
    }

    /// Whether a point is the apex, within the tolerance, and whether the surface opens upwards.
    pub fn apex(&self, p: &Point3<f64>, tolerance: f64) -> Option<bool> {
        if self.growth == 0.0 {
            return None;
        }
        let apex = self.origin + self.axes.column(2) * (-self.base / self.growth);
        ((p - apex).norm() <= tolerance).then_some(self.growth > 0.0)
    }

    /// R.
    fn size(&self, v: f64) -> f64 {
        let rho = self.base + self.growth * v;
        match self.growth == 0.0 {
            true => self.base * v,
            false => 0.5 * rho * rho / self.growth,
        }
    }

    fn axis(&self, k: usize) -> Vector3<f64> {
        self.axes.column(k).into()
    }

    /// P of the area by φ, whose F is the length of the cross product.
    pub fn area_flow(&self, [phi, v]: [f64; 2]) -> f64 {
        let (sin, cos) = phi.sin_cos();
        let [x, y, z] = [0, 1, 2].map(|k| self.axis(k));
        let turned = y * cos - x * sin;
        let normal = turned.cross(&z) - x.cross(&y) * self.growth;
        self.size(v) * normal.norm()
    }

    /// P of the volume by φ.
    pub fn volume_flow(&self, [phi, v]: [f64; 2], about: &Point3<f64>) -> f64 {
        let (sin, cos) = phi.sin_cos();
        let [x, y, z] = [0, 1, 2].map(|k| self.axis(k));
        let o = self.origin - about;
        let turned = y * cos - x * sin;
        let flat = x.cross(&y);
        let k = o.dot(&turned.cross(&z)) - self.growth * o.dot(&flat);
        self.size(v) * (k + self.base * flat.dot(&z)) / 3.0
    }
}
