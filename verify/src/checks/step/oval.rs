//! Ellipsoids as rational B-spline surfaces from pole to pole.
//!
//! Notation: S = o + A n with n = (cos φ cos v, sin φ cos v, sin v), A the conjugate radii as columns,
//! D its determinant. Then S_φ × S_v = D cos v A⁻ᵀ n, and S·(S_φ × S_v) = D cos v (1 + o'·n) with
//! o' = A⁻¹ o. P starts at the south pole.

use super::net_ellipse::{AROUND, NetEllipse, SAME, angle_of_arcs};
use nalgebra::{Matrix3, Point3, Vector3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// An ellipsoid.
#[derive(Clone, Copy, Debug)]
pub struct OvalSurface {
    centre: Point3<f64>,
    /// A, its inverse, and D.
    radii: Matrix3<f64>,
    inverse: Matrix3<f64>,
    volume: f64,
    /// The spline's parameters at φ = 0 and at the south pole.
    starts: [f64; 2],
}

impl OvalSurface {
    /// The surface with five rings of control points: the south pole, the square below the equator, the
    /// equator, the square above it, and the north pole. `None` if it is no ellipsoid.
    pub fn new(rings: &[[Point3<f64>; AROUND]; 5], start: f64, south: f64) -> Option<Self> {
        let [low, below, equator, above, high] = rings;
        let z = 0.5 * (high[0] - low[0]);
        let size = z.norm() + (equator[0] - equator[4]).norm() + (equator[2] - equator[6]).norm();
        let NetEllipse { centre, x, y } = NetEllipse::new(equator, size)?;
        let is_near = |p: &Point3<f64>, q: Point3<f64>| (p - q).norm() <= SAME * size;
        let is_oval = (0..AROUND).all(|k| {
            is_near(&low[k], centre - z)
                && is_near(&high[k], centre + z)
                && is_near(&below[k], equator[k] - z)
                && is_near(&above[k], equator[k] + z)
        });
        if !is_oval {
            return None;
        }
        let radii = Matrix3::from_columns(&[x, y, z]);
        Some(Self {
            centre,
            radii,
            inverse: radii.try_inverse()?,
            volume: radii.determinant(),
            starts: [start, south],
        })
    }

    fn local(&self, p: &Point3<f64>) -> Vector3<f64> {
        self.inverse * (p - self.centre)
    }

    /// The distance of a point, to first order.
    pub fn distance(&self, p: &Point3<f64>) -> f64 {
        let q = self.local(p);
        let away = q.norm();
        let slope = (self.inverse.transpose() * (q / away)).norm();
        match slope.is_finite() {
            true => (away - 1.0) / slope,
            false => -self.radii.norm(),
        }
    }

    /// The point with the parameters of the B-spline.
    pub fn point(&self, [u, v]: [f64; 2]) -> Point3<f64> {
        let (sin, cos) = angle_of_arcs(u - self.starts[0]).sin_cos();
        let (up, out) = (angle_of_arcs(v - self.starts[1]) - FRAC_PI_2).sin_cos();
        self.centre + self.radii * Vector3::new(cos * out, sin * out, up)
    }

    /// φ and v of a point.
    pub fn parameters(&self, p: &Point3<f64>) -> [f64; 2] {
        let q = self.local(p);
        [q.y.atan2(q.x), q.z.atan2(q.x.hypot(q.y))]
    }

    /// The derivative of φ along a curve that moves by `d` at a point.
    pub fn angular_speed(&self, p: &Point3<f64>, d: &Vector3<f64>) -> f64 {
        let (q, d) = (self.local(p), self.inverse * d);
        (q.x * d.y - q.y * d.x) / (q.x * q.x + q.y * q.y)
    }

    /// Whether a point is a pole, within the tolerance, and whether it is the south pole.
    pub fn pole(&self, p: &Point3<f64>, tolerance: f64) -> Option<bool> {
        let z = self.radii.column(2);
        let is_at = |pole: Point3<f64>| (p - pole).norm() <= tolerance;
        match (is_at(self.centre - z), is_at(self.centre + z)) {
            (true, _) => Some(true),
            (_, true) => Some(false),
            _ => None,
        }
    }

    /// P of the area: the integral of |D A⁻ᵀ n| cos v from the south pole.
    pub fn area_flow(&self, [phi, v]: [f64; 2]) -> f64 {
        let cofactors = self.inverse.transpose() * self.volume;
        let (sin, cos) = phi.sin_cos();
        integral([-FRAC_PI_2, v], |v| {
            let (up, out) = v.sin_cos();
            (cofactors * Vector3::new(cos * out, sin * out, up)).norm() * out
        })
    }

    /// P of the volume, relative to a point.
    pub fn volume_flow(&self, [phi, v]: [f64; 2], about: &Point3<f64>) -> f64 {
        let o = self.inverse * (self.centre - about);
        let out = o.x * phi.cos() + o.y * phi.sin();
        let (sin, cos) = v.sin_cos();
        let level = sin + 1.0 - 0.5 * o.z * cos * cos;
        self.volume * (level + out * (0.5 * (v + sin * cos) + FRAC_PI_4)) / 3.0
    }

    /// The integral of P of the area by φ at the north pole.
    pub fn area_at_north(&self, range: [f64; 2]) -> f64 {
        integral(range, |phi| self.area_flow([phi, FRAC_PI_2]))
    }

    /// The same of the volume.
    pub fn volume_at_north(&self, [from, to]: [f64; 2], about: &Point3<f64>) -> f64 {
        let o = self.inverse * (self.centre - about);
        let out = o.x * (to.sin() - from.sin()) - o.y * (to.cos() - from.cos());
        self.volume * (2.0 * (to - from) + FRAC_PI_2 * out) / 3.0
    }
}

/// The number of pieces of a quadrature.
const PIECES: u32 = 24;

/// The nodes and weights of Gauss's quadrature of degree nine on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.0, 0.568_888_888_888_888_9),
    (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
    (0.906_179_845_938_664, 0.236_926_885_056_189_08),
];

/// The integral of a smooth function.
fn integral([from, to]: [f64; 2], f: impl Fn(f64) -> f64) -> f64 {
    let half = 0.5 * (to - from) / f64::from(PIECES);
    let middles = (0..PIECES).map(|k| from + half * f64::from(2 * k + 1));
    let piece = |m: f64| GAUSS.iter().map(|(x, w)| w * f(m + half * x)).sum::<f64>();
    half * middles.map(piece).sum::<f64>()
}
