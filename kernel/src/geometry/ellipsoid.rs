//! The ellipsoid: the image of a sphere under an affine map.
//!
//! Notation, in the ellipsoid's frame: r = (a, b, c) are the radii along x, y and z; X = x/a, Y = y/b,
//! Z = z/c are the coordinates of the point of the unit sphere of which a point is the image.

use super::elliptic_surface::{conjugate_level, conjugate_slope, perpendicular_axes};
use super::frame::{Frame, perpendicular};
use crate::geometry::vector::Length;
use crate::number::bisection::{ValueAndSlope, bisect_newton};
use crate::number::float::{Analytic, Float};
use crate::number::predicates::Compare;
use nalgebra::{Point3, Vector3};

/// An ellipsoid: the image of the points e cos v + k sin v of the unit sphere, with e = i cos u + j sin u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid<N: Float = f64> {
    /// Origin at the centre, along the axes of symmetry.
    pub frame: Frame<N>,
    /// The radii along x, y and z.
    pub radii: [N; 3],
    /// Perpendicular axes i, j and k of the unit sphere, in the frame, which only define the parameters:
    /// the longitude u from i towards j, and the latitude v towards k.
    pub axes: [Vector3<N>; 3],
}

/// The ellipse in which a plane cuts an ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidSection<N: Float = f64> {
    /// The centre.
    pub centre: Point3<N>,
    /// The perpendicular radii, the longer one first.
    pub radii: [Vector3<N>; 2],
}

/// The greatest number of rounds in which three conjugate axes are made perpendicular.
const ROUNDS: u32 = 24;

impl<N: Float> Ellipsoid<N> {
    /// An ellipsoid with the radii along the axes of a frame, and its parameters about the third.
    pub fn new(frame: Frame<N>, radii: [N; 3]) -> Self {
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        Self { frame, radii, axes }
    }

    /// The image of the unit sphere about o with the conjugate axes x, y and z. Each pair of axes is
    /// made perpendicular in turn (Hestenes, 1958); perpendicular ones stay as they are.
    pub fn with_axes(o: Point3<N>, mut axes: [Vector3<N>; 3]) -> Self {
        for _ in 0..ROUNDS {
            let mut is_done = true;
            for [i, j] in [[0, 1], [0, 2], [1, 2]] {
                let [p, q] = [axes[i], axes[j]];
                let size = p.length() * q.length();
                if p.dot(&q).is_within(N::EPSILON * size) {
                    continue;
                }
                is_done = false;
                [axes[i], axes[j]] = perpendicular_axes(p, q);
            }
            if is_done {
                break;
            }
        }
        let [x, _, z] = axes;
        let frame = Frame::toward(o, z.unit(), x);
        Self::new(frame, axes.map(|axis| axis.length()))
    }

    /// The signed distance to first order, which is smooth at the centre.
    pub(super) fn level<S: Analytic<Float = N>>(&self, p: [S; 3]) -> S {
        conjugate_level(self.frame.local(p), self.radii)
    }

    /// The ratio of X² + Y² + Z² - 1 to the level.
    pub(super) fn slope<S: Analytic<Float = N>>(&self, q: [S; 3]) -> S {
        conjugate_slope(q, self.radii)
    }

    /// The point of the unit sphere of which a point, in the frame, is the image.
    pub fn on_unit_sphere(&self, q: &Vector3<N>) -> Vector3<N> {
        let [a, b, c] = self.radii;
        Vector3::new(q.x / a, q.y / b, q.z / c)
    }

    /// The same with a unit vector of the unit sphere, in the frame, as the axis of the parameters.
    pub fn about(&self, pole: Vector3<N>) -> Self {
        let Frame { x, y, z, .. } = Frame::about(Point3::origin(), pole);
        Self {
            axes: [x, y, z],
            ..*self
        }
    }

    /// The coordinates along the axes of the parameters of the point of the unit sphere of which a
    /// point, in the frame, is the image.
    pub fn on_axes(&self, q: &Vector3<N>) -> Vector3<N> {
        let p = self.on_unit_sphere(q);
        Vector3::from(self.axes.map(|axis| axis.dot(&p)))
    }

    /// The images of the axes of the parameters: conjugate radii.
    pub fn conjugate_radii(&self) -> [Vector3<N>; 3] {
        self.axes.map(|axis| self.frame.vector(&self.image(&axis)))
    }

    /// Longitude in (-pi, pi] and latitude of a point, in the frame.
    pub(super) fn parameters(&self, q: &Vector3<N>) -> [N; 2] {
        let q = self.on_axes(q);
        [q.y.atan2(q.x), q.z.atan2(q.x.hypot(q.y))]
    }

    /// The point with the given parameters.
    pub(super) fn point(&self, u: N, v: N) -> Point3<N> {
        let [x, y, z] = self.conjugate_radii();
        let ((sin, cos), (up, out)) = (u.sin_cos(), v.sin_cos());
        self.frame.origin + (x * cos + y * sin) * out + z * up
    }

    /// The image of a circle on the unit sphere: its centre, and perpendicular radii, the longer one
    /// first. The circle is at a height along a unit normal in the frame.
    pub fn section(&self, normal: &Vector3<N>, height: N) -> EllipsoidSection<N> {
        let radius = ((N::ONE - height) * (N::ONE + height)).max(N::ZERO).sqrt();
        let along = perpendicular(normal);
        let across = normal.cross(&along);
        let world = |v: &Vector3<N>| self.frame.vector(&self.image(v));
        EllipsoidSection {
            centre: self.frame.origin + world(normal) * height,
            radii: perpendicular_axes(world(&along) * radius, world(&across) * radius),
        }
    }

    /// The image, in the frame, of a vector.
    pub fn image(&self, p: &Vector3<N>) -> Vector3<N> {
        p.component_mul(&Vector3::from(self.radii))
    }

    /// Half the width along a unit normal in the frame.
    pub fn half_width(&self, n: &Vector3<N>) -> N {
        self.image(n).length()
    }

    /// The greatest radius.
    pub fn circumradius(&self) -> N {
        let [a, b, c] = self.radii;
        a.max(b).max(c)
    }

    /// Half the gradient of X² + Y² + Z² in the frame.
    pub fn gradient(&self, q: &Vector3<N>) -> Vector3<N> {
        self.on_unit_sphere(&self.on_unit_sphere(q))
    }

    /// The coefficients of the squares of the local coordinates, and the constant, of an equation that is
    /// the distance times a length close to the surface.
    pub fn equation(&self) -> ([N; 3], N) {
        let square = self.mean_square();
        let squares = self.radii.map(|r| square / (r * r));
        (squares, square)
    }

    /// The square of the geometric mean of the least and the greatest radius.
    fn mean_square(&self) -> N {
        let [a, b, c] = self.radii;
        a.min(b).min(c) * self.circumradius()
    }

    /// The signed distance of a point in the frame.
    ///
    /// The nearest point q has q - p along the gradient: q_i = r_i² p_i/(r_i² + t), with t the greatest
    /// root of Σ (r_i p_i/(r_i² + t))² = 1 (Eberly, 2013). The distance is t |q/r²|.
    pub(super) fn distance(&self, p: &Vector3<N>) -> N {
        let least = (0..3).min_by(|&i, &j| self.radii[i].total_cmp(&self.radii[j]));
        let least = least.unwrap_or(0);
        // In units of the least radius.
        let unit = self.radii[least];
        let r = self.radii.map(|r| r / unit);
        let p: [N; 3] = std::array::from_fn(|i| p[i].abs() / unit);
        let excess: [N; 3] = std::array::from_fn(|i| (r[i] - N::ONE) * (r[i] + N::ONE));
        // With s = 1 + t: the sum decreases for s > 0.
        let sum = |s: N| {
            let mut out = ValueAndSlope {
                value: -N::ONE,
                slope: N::ZERO,
            };
            for i in 0..3 {
                let part = r[i] * p[i] / (excess[i] + s);
                out.value += part * part;
                out.slope -= N::TWO * part * part / (excess[i] + s);
            }
            out
        };
        let along = |s: N| -> [N; 3] { std::array::from_fn(|i| p[i] / (excess[i] + s)) };
        let length = |g: [N; 3]| Vector3::from(g).length();
        let flat: N = (0..3)
            .filter(|&i| excess[i] > N::ZERO)
            .map(|i| r[i] * p[i] / excess[i])
            .map(|part| part * part)
            .sum();
        let is_on_flat = (0..3).all(|i| excess[i] > N::ZERO || p[i] == N::ZERO);
        if is_on_flat && flat < N::ONE {
            // The nearest point leaves the plane of the others along a least axis.
            let part = |i: usize| match excess[i] > N::ZERO {
                true => p[i] / excess[i],
                false => N::ZERO,
            };
            let [x, y, z] = [0, 1, 2].map(part);
            let rest = N::ONE - flat;
            return -unit * (x * x + y * y + z * z + rest).sqrt();
        }
        let most = (0..3).map(|i| r[i] * p[i]).map(|x| x * x).sum::<N>().sqrt();
        let s = bisect_newton(N::ZERO, most.max(N::ONE), N::ONE, sum);
        unit * (s - N::ONE) * length(along(s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::elliptic_surface::tests::{axes, vector};
    use crate::geometry::surface::Surface;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn conjugate_axes_give_the_surface(
            o in vector(), axes in axes(), u in 0.0..6.3_f64, v in -1.5..1.5_f64,
        ) {
            let [x, y, z] = axes;
            let ellipsoid = Ellipsoid::with_axes(o.into(), axes);
            let surface = Surface::Ellipsoid(ellipsoid);
            let (out, up) = (v.cos(), v.sin());
            let p = Point3::from(o + (x * u.cos() + y * u.sin()) * out + z * up);
            prop_assert!(surface.distance(&p).abs() < 1e-13, "{}", surface.distance(&p));
            let [a, b] = surface.parameters(&p);
            prop_assert!((surface.point(a, b) - p).norm() < 1e-12);
            // The normal is perpendicular to the directions of both parameters.
            let normal = surface.normal(&p);
            let around = y * u.cos() - x * u.sin();
            let along = z * out - (x * u.cos() + y * u.sin()) * up;
            prop_assert!(normal.dot(&around).abs() < 1e-11 * around.norm());
            prop_assert!(normal.dot(&along).abs() < 1e-11 * along.norm());
            let [a, b, c] = ellipsoid.radii;
            assert_relative_eq!(a * b * c, x.cross(&y).dot(&z).abs(), max_relative = 1e-12);
        }

        #[test]
        fn the_distance_is_that_from_the_nearest_point(
            o in vector(), axes in axes(), p in vector(), part in 0.5..3.0_f64,
        ) {
            let p = Point3::from(o + p * part);
            let surface = Surface::Ellipsoid(Ellipsoid::with_axes(o.into(), axes));
            let distance = surface.distance(&p);
            // No point of the surface is nearer, and one is as near.
            let mut nearest = f64::INFINITY;
            for i in 0..240 {
                for j in 0..120 {
                    let (u, v) = (f64::from(i) * 0.026_18, f64::from(j - 60) * 0.026_18);
                    nearest = nearest.min((surface.point(u, v) - p).norm());
                }
            }
            prop_assert!(distance.abs() < nearest + 1e-12, "{distance} {nearest}");
            prop_assert!(nearest < distance.abs() + 0.1, "{distance} {nearest}");
            let level = surface.level([p.x, p.y, p.z]);
            prop_assert!(level * distance >= 0.0, "{level} {distance}");
        }
    }

    #[test]
    fn distances_along_the_axes_are_exact() {
        let surface = Surface::Ellipsoid(Ellipsoid::new(Frame::world(), [3.0, 2.0, 1.0]));
        // At the centre the nearest point is on the shortest axis. On the longest axis it is at its
        // end beyond the centre of curvature, at 3 - 1²/3; before that at x = r² p/(r² - 1²).
        for (p, distance) in [
            ([0.0, 0.0, 0.0], -1.0),
            ([0.0, 0.0, 4.0], 3.0),
            ([0.0, 0.0, 0.5], -0.5),
            ([5.0, 0.0, 0.0], 2.0),
            ([2.9, 0.0, 0.0], -0.1),
            ([1.6, 0.0, 0.0], -(0.2_f64 * 0.2 + (1.0 - 0.36)).sqrt()),
        ] {
            let found = surface.distance(&p.into());
            assert_relative_eq!(found, distance, max_relative = 1e-14);
        }
    }
}
