//! The elliptic cylinder and the elliptic cone: the images of round ones under affine maps.
//!
//! Notation, in a surface's frame: a and b are the radii (the slopes of a cone) along x and y;
//! X = x/a, Y = y/b; u is the eccentric angle, (X, Y) = ρ (cos u, sin u).

use super::frame::Frame;
use crate::geometry::vector::Length;
use crate::number::bisection::{ValueAndSlope, bisect_newton};
use crate::number::float::{Analytic, Float};
use crate::number::predicates::Compare;
use nalgebra::{Matrix3, Point3, Vector3};

/// A cylinder about its frame's z axis with an ellipse as cross section: (a cos u, b sin u, v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticCylinder<N: Float = f64> {
    /// z along the axis, x and y along the axes of the cross section.
    pub frame: Frame<N>,
    /// The radii of the cross section along x and y.
    pub radii: [N; 2],
}

/// One nappe of an elliptic cone: v (a cos u, b sin u, 1) with v > 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipticCone<N: Float = f64> {
    /// Origin at the apex, z along the axis into the nappe, x and y along the other axes of symmetry.
    pub frame: Frame<N>,
    /// The radii along x and y of the cross section at the height 1.
    pub slopes: [N; 2],
}

/// The eccentric angle of a point of the plane, with the radii of the ellipse.
pub(crate) fn eccentric_angle<N: Float>([x, y]: [N; 2], [a, b]: [N; 2]) -> N {
    (y / b).atan2(x / a)
}

/// The axes of the ellipse with two conjugate axes, the longer one first, by Rytz's construction: the
/// angle at which the radius is perpendicular to the tangent.
pub fn perpendicular_axes<N: Float>(p: Vector3<N>, q: Vector3<N>) -> [Vector3<N>; 2] {
    let square = p.length_squared() - q.length_squared();
    let (sin, cos) = (N::HALF * (N::TWO * p.dot(&q)).atan2(square)).sin_cos();
    [p * cos + q * sin, q * cos - p * sin]
}

/// Σ (q/r)² - 1.
fn beyond_radii<N: Float, S: Analytic<Float = N>, const K: usize>(q: [S; K], radii: [N; K]) -> S {
    let parts = std::array::from_fn::<S, K, _>(|i| q[i].scale(N::ONE / radii[i]).square());
    sum(parts) - S::constant(N::ONE)
}

/// The distance beyond radii to first order, smooth at the centre: Σ (q/r)² - 1 over its slope.
pub(super) fn conjugate_level<N: Float, S: Analytic<Float = N>, const K: usize>(
    q: [S; K],
    radii: [N; K],
) -> S {
    beyond_radii(q, radii).over(conjugate_slope(q, radii))
}

/// √(|∇Σ|² + (Σ - 1)²/m²) for Σ = Σ (q/r)², with the greatest radius m.
pub(super) fn conjugate_slope<N: Float, S: Analytic<Float = N>, const K: usize>(
    q: [S; K],
    radii: [N; K],
) -> S {
    let square = |r: N| N::TWO / (r * r);
    let gradient = std::array::from_fn::<S, K, _>(|i| q[i].scale(square(radii[i])).square());
    let most = radii.into_iter().fold(radii[0], N::max);
    let beyond = beyond_radii(q, radii).scale(N::ONE / most);
    (sum(gradient) + beyond.square()).root()
}

/// The sum of some terms.
fn sum<S: Analytic, const K: usize>(parts: [S; K]) -> S {
    let [first, rest @ ..] = &parts[..] else {
        return S::constant(S::Float::ZERO);
    };
    rest.iter().fold(*first, |sum, part| sum + *part)
}

impl<N: Float> EllipticCylinder<N> {
    /// The cylinder o + x cos u + y sin u + v z with conjugate axes x, y and z; x is the longer axis of
    /// its cross section.
    pub fn with_axes(o: Point3<N>, [x, y, z]: [Vector3<N>; 3]) -> Self {
        let along = z.unit();
        let [p, q] = [x, y].map(|axis| axis - along * along.dot(&axis));
        let [long, short] = perpendicular_axes(p, q);
        Self {
            frame: Frame::toward(o, along, long),
            radii: [long.length(), short.length()],
        }
    }

    /// The signed distance to first order: (ρ² - 1)/√(|∇ρ²|² + (ρ² - 1)²/m²), which is smooth on the
    /// axis; m is the greater radius.
    pub(super) fn level<S: Analytic<Float = N>>(&self, p: [S; 3]) -> S {
        let [x, y, _] = self.frame.local(p);
        conjugate_level([x, y], self.radii)
    }

    /// The ratio of ρ² - 1 to the level.
    pub(super) fn slope<S: Analytic<Float = N>>(&self, [x, y, _]: [S; 3]) -> S {
        conjugate_slope([x, y], self.radii)
    }

    /// The signed distance of a point in the surface's frame.
    pub(super) fn distance(&self, q: &Vector3<N>) -> N {
        from_tangent_planes([q.x, q.y], self.radii, N::ONE, N::ZERO)
    }

    /// The gradient of ρ²/2 in the surface's frame.
    pub fn gradient(&self, q: &Vector3<N>) -> Vector3<N> {
        let [a, b] = self.radii;
        Vector3::new(q.x / (a * a), q.y / (b * b), N::ZERO)
    }

    /// The coefficients of the squares of the local coordinates, and the constant, of an equation
    /// that is the distance times a length close to the surface.
    pub fn equation(&self) -> ([N; 3], N) {
        let [a, b] = self.radii;
        ([b / a, a / b, N::ZERO], a * b)
    }
}

impl<N: Float> EllipticCone<N> {
    /// The cone o + v (x cos u + y sin u + z) with conjugate axes x, y and z. The axes of symmetry are
    /// the eigenvectors of its dual form x xᵀ + y yᵀ - z zᵀ.
    pub fn with_axes(o: Point3<N>, [x, y, z]: [Vector3<N>; 3]) -> Self {
        let rough = Frame::about(o, z.unit());
        let [x, y, z] = [x, y, z].map(|axis| rough.components(&axis));
        let dual = x * x.transpose() + y * y.transpose() - z * z.transpose();
        let [first, second, third] = eigenvectors(dual);
        // One eigenvalue is negative: that of the axis inside the cone.
        let [along, long, short] = if first.value.is_below_zero() {
            [first, second, third]
        } else if second.value.is_below_zero() {
            [second, third, first]
        } else {
            [third, first, second]
        };
        let [a, b] = [long, short].map(|axis| (axis.value / -along.value).sqrt());
        let up = N::ONE.copysign(along.vector.dot(&z));
        let axis = rough.vector(&(along.vector * up));
        let frame = Frame::toward(o, axis, rough.vector(&long.vector));
        Self {
            frame,
            slopes: [a, b],
        }
    }

    /// The signed distance to first order: (ρ - z) times the inverse of the gradient's length, whose
    /// square is 1 + (cos² u/a² + sin² u/b²) on the surface.
    pub(super) fn level<S: Analytic<Float = N>>(&self, p: [S; 3]) -> S {
        let q = self.frame.local(p);
        (self.radius(q) - q[2]) * self.inverse_slope(q)
    }

    /// ρ.
    pub(super) fn radius<S: Analytic<Float = N>>(&self, [x, y, _]: [S; 3]) -> S {
        let [a, b] = self.slopes;
        (x.scale(N::ONE / a).square() + y.scale(N::ONE / b).square()).root()
    }

    /// The inverse of the length of the gradient of ρ - z.
    pub(super) fn inverse_slope<S: Analytic<Float = N>>(&self, [x, y, _]: [S; 3]) -> S {
        let [a, b] = self.slopes;
        let [across, along] = [(x, a), (y, b)].map(|(x, r)| x.scale(N::ONE / r).square());
        let square = across + along;
        let steep = across.scale(N::ONE / (a * a)) + along.scale(N::ONE / (b * b));
        let limit = |r: N| r * r / (N::ONE + r * r);
        let (least, most) = (limit(a.min(b)), limit(a.max(b)));
        square
            .over(square + steep)
            .known_within([least, most])
            .root()
    }

    /// The signed distance of a point in the surface's frame. Behind the apex it is a lower bound.
    pub(super) fn distance(&self, q: &Vector3<N>) -> N {
        from_tangent_planes([q.x, q.y], self.slopes, q.z, N::ONE)
    }

    /// The gradient of (ρ² - z²)/2 in the surface's frame.
    pub fn gradient(&self, q: &Vector3<N>) -> Vector3<N> {
        let [a, b] = self.slopes;
        Vector3::new(q.x / (a * a), q.y / (b * b), -q.z)
    }

    /// As of [`EllipticCylinder::equation`]; the constant is zero.
    pub fn equation(&self) -> ([N; 3], N) {
        let [a, b] = self.slopes;
        let scale = self.sine_squared();
        ([scale / (a * a), scale / (b * b), -scale], N::ZERO)
    }

    /// The square of the sine of a mean half angle.
    pub(crate) fn sine_squared(&self) -> N {
        let [a, b] = self.slopes;
        a * b / (N::ONE + a * b)
    }
}

/// An eigenvalue and its unit eigenvector.
#[derive(Clone, Copy)]
struct Eigenpair<N: Float> {
    value: N,
    vector: Vector3<N>,
}

/// The eigenvalues and eigenvectors of a symmetric matrix by Jacobi's rotations, which keep small
/// entries accurate.
fn eigenvectors<N: Float>(mut m: Matrix3<N>) -> [Eigenpair<N>; 3] {
    let mut axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    for _ in 0..SWEEPS {
        let mut is_diagonal = true;
        for [i, j] in [[0, 1], [0, 2], [1, 2]] {
            let size = (m[(i, i)] * m[(j, j)]).abs().sqrt();
            if m[(i, j)].is_within(N::HALF * N::EPSILON * size) {
                continue;
            }
            is_diagonal = false;
            let ratio = (m[(j, j)] - m[(i, i)]) / (N::TWO * m[(i, j)]);
            let tan = N::ONE.copysign(ratio) / (ratio.abs() + ratio.hypot(N::ONE));
            let cos = N::ONE / tan.hypot(N::ONE);
            let sin = tan * cos;
            let shift = tan * m[(i, j)];
            m[(i, i)] -= shift;
            m[(j, j)] += shift;
            m[(i, j)] = N::ZERO;
            m[(j, i)] = N::ZERO;
            let k = 3 - i - j;
            let (x, y) = (m[(i, k)], m[(j, k)]);
            for (entry, value) in [(i, cos * x - sin * y), (j, sin * x + cos * y)] {
                m[(entry, k)] = value;
                m[(k, entry)] = value;
            }
            let (u, v) = (axes[i], axes[j]);
            axes[i] = u * cos - v * sin;
            axes[j] = u * sin + v * cos;
        }
        if is_diagonal {
            break;
        }
    }
    [0, 1, 2].map(|i| Eigenpair {
        value: m[(i, i)],
        vector: axes[i],
    })
}

/// The greatest number of rounds of Jacobi's rotations.
const SWEEPS: u32 = 24;

/// The greatest signed distance of (x, y, level) from the tangent planes of a cylinder over an ellipse
/// (`rise` 0, `level` 1) or a cone (`rise` 1), which is that from the surface. The plane at u has the
/// normal (cos u/a, sin u/b, -rise), and the distance is (X cos u + Y sin u - level)/√g with
/// g = rise + cos² u/a² + sin² u/b². In each quadrant it has one maximum.
fn from_tangent_planes<N: Float>([x, y]: [N; 2], [a, b]: [N; 2], level: N, rise: N) -> N {
    let (x, y) = (x.abs() / a, y.abs() / b);
    let [flat, steep] = [a, b].map(|r| N::ONE / (r * r));
    let change = steep - flat;
    let square = |sin: N, cos: N| rise + cos * cos * flat + sin * sin * steep;
    let distance = |u: N| {
        let (sin, cos) = u.sin_cos();
        (x * cos + y * sin - level) / square(sin, cos).sqrt()
    };
    // A positive multiple of the derivative.
    let turn = |u: N| {
        let (sin, cos) = u.sin_cos();
        let (along, across) = (x * cos + y * sin, y * cos - x * sin);
        let (g, both) = (square(sin, cos), sin * cos);
        ValueAndSlope {
            value: across * g - (along - level) * both * change,
            slope: across * both * change
                - along * g
                - (along - level) * (cos * cos - sin * sin) * change,
        }
    };
    let quarter = N::HALF * N::PI;
    let ends = [N::ZERO, quarter];
    for (end, off) in ends.into_iter().zip([y, x]) {
        if off.is_exactly(N::ZERO) && turn(end).slope.is_at_most(N::ZERO) {
            return distance(end);
        }
    }
    distance(bisect_newton(N::ZERO, quarter, N::ONE, turn))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::geometry::surface::Surface;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    pub(crate) fn vector() -> impl Strategy<Value = Vector3<f64>> {
        prop::array::uniform3(-2.0..2.0).prop_map(Vector3::from)
    }

    /// Conjugate axes that are not nearly in one plane.
    pub(crate) fn axes() -> impl Strategy<Value = [Vector3<f64>; 3]> {
        let all = [vector(), vector(), vector()];
        all.prop_filter("flat", |[x, y, z]| x.cross(y).dot(z).abs() > 0.2)
    }

    fn surfaces(o: Vector3<f64>, axes: [Vector3<f64>; 3]) -> [Surface; 2] {
        let o = Point3::from(o);
        [
            Surface::EllipticCylinder(EllipticCylinder::with_axes(o, axes)),
            Surface::EllipticCone(EllipticCone::with_axes(o, axes)),
        ]
    }

    proptest! {
        #[test]
        fn conjugate_axes_give_the_surface(
            o in vector(), [x, y, z] in axes(), u in 0.0..6.3_f64, v in 0.1..3.0_f64,
        ) {
            let [cylinder, cone] = surfaces(o, [x, y, z]);
            let round = x * u.cos() + y * u.sin();
            for (surface, p) in [(cylinder, o + round + z * v), (cone, o + (round + z) * v)] {
                let p = Point3::from(p);
                let off = surface.distance(&p).abs();
                prop_assert!(off < 1e-13 * (1.0 + p.coords.norm()), "{off}");
                let [a, b] = surface.parameters(&p);
                prop_assert!((surface.point(a, b) - p).norm() < 1e-12);
                // The normal is perpendicular to the directions of both parameters.
                let around = y * u.cos() - x * u.sin();
                let normal = surface.normal(&p);
                prop_assert!(normal.dot(&around).abs() < 1e-11 * around.norm());
            }
        }

        #[test]
        fn distances_are_those_of_the_nearest_point(
            o in vector(), axes in axes(), p in vector(),
        ) {
            let p = Point3::from(p * 2.0);
            for surface in surfaces(o, axes) {
                let distance = surface.distance(&p);
                let mut nearest = f64::INFINITY;
                for i in 0..4000 {
                    let u = f64::from(i) * std::f64::consts::TAU / 4000.0;
                    // The nearest point of a ruling.
                    let (a, b) = (surface.point(u, 1.0), surface.point(u, 2.0));
                    let d = (b - a).normalize();
                    let mut t = (p - a).dot(&d);
                    if let Surface::EllipticCone(cone) = surface {
                        t = t.max((cone.frame.origin - a).dot(&d));
                    }
                    nearest = nearest.min((a + d * t - p).norm());
                }
                let is_behind_apex = match surface {
                    Surface::EllipticCone(c) => (c.frame.origin - p).norm() < nearest + 1e-9,
                    _ => false,
                };
                if !is_behind_apex {
                    prop_assert!((distance.abs() - nearest).abs() < 2e-3, "{distance} {nearest}");
                }
                let level = surface.level([p.x, p.y, p.z]);
                prop_assert!(level * distance >= 0.0, "{level} {distance}");
                let on = p - surface.normal(&p) * (0.999 * distance);
                if distance.abs() < 0.01 {
                    let near = surface.level([on.x, on.y, on.z]);
                    prop_assert!((near - surface.distance(&on)).abs() < 1e-3 * distance.abs());
                }
            }
        }

        #[test]
        fn the_second_form_is_the_change_of_the_normal(
            o in vector(), axes in axes(), u in 0.0..6.3_f64, v in 0.5..3.0_f64,
        ) {
            let step = 1e-6;
            for surface in surfaces(o, axes) {
                let p = surface.point(u, v);
                let [ahead, behind] = [step, -step].map(|d| surface.point(u + d, v));
                let change = surface.normal(&ahead) - surface.normal(&behind);
                let along = ahead - behind;
                let curvature = change.dot(&along) / along.norm_squared();
                let form = surface.normal_curvature(&p, &along.normalize());
                prop_assert!((curvature - form).abs() < 1e-4 * (1.0 + form));
            }
        }
    }

    #[test]
    fn a_needle_keeps_its_slopes() {
        // Nearly a ruling: the slopes are 1e-6 and 2e-6.
        let frame = Frame::about(Point3::origin(), Vector3::new(0.3, -0.4, 0.7).normalize());
        let axes = [frame.x * 1e-6, frame.y * 2e-6, frame.z];
        let cone = EllipticCone::with_axes(Point3::origin(), axes);
        let mut slopes = cone.slopes;
        slopes.sort_by(f64::total_cmp);
        assert_relative_eq!(slopes[0], 1e-6, max_relative = 1e-14);
        assert_relative_eq!(slopes[1], 2e-6, max_relative = 1e-14);
    }

    #[test]
    fn on_an_axis_the_distance_is_that_of_the_nearer_vertex() {
        let cylinder = EllipticCylinder {
            frame: Frame::world(),
            radii: [5.0, 3.0],
        };
        // On the major axis inside the evolute, at x = 1.6, the foot is at x = 2.5: the distance is
        // √(0.9² + 3²·(1 - 0.25)).
        let off = cylinder.distance(&Vector3::new(1.6, 0.0, 7.0));
        assert_relative_eq!(off, -(0.81f64 + 6.75).sqrt(), max_relative = 1e-14);
        assert_relative_eq!(cylinder.distance(&Vector3::new(4.0, 0.0, 0.0)), -1.0);
        assert_relative_eq!(cylinder.distance(&Vector3::zeros()), -3.0);
        assert_relative_eq!(cylinder.distance(&Vector3::new(0.0, 5.0, 0.0)), 2.0);
    }
}
