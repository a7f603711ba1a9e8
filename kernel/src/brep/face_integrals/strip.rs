//! The moments of a strip of a surface between two v at one u, in closed form.
//!
//! Notation: P relative to the reference point, N the normal, h = P·N, J = |P_u × P_v|, all at one
//! u; e is the radial direction there, Z the axis, c the frame's origin; m and d are the middle and
//! half the length of the strip. Every integral is a product with d, or with sin d, so nothing
//! cancels in a thin strip.
//!
//! - Plane, cylinder, cone, elliptic or not: P = p + q v, J = j + k v, and h does not depend on v.
//! - Sphere, torus: P, h and J are a + b cos v + c sin v.

use super::Moments;
use super::ellipsoid_strip::ellipsoid_strip;
use super::waves::round;
use crate::geometry::surface::Surface;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use nalgebra::{Point3, Vector3};

/// ∫ J dv, ∫ h J dv and ∫ h J P dv between two v, measured from a middle.
pub(super) fn strip<N: Float>(
    surface: &Surface<N>,
    reference: &Point3<N>,
    u: N,
    middle: N,
    [from, to]: [N; 2],
) -> Moments<N> {
    let f = surface.frame();
    let (sin, cos) = u.sin_cos();
    let (c, z, e) = (f.origin - reference, f.z, f.x * cos + f.y * sin);
    let (m, d) = (middle + N::HALF * (from + to), N::HALF * (to - from));
    match surface {
        Surface::Plane(_) => straight([c + f.x * u, f.y], [N::ONE, N::ZERO], c.dot(&z), m, d),
        Surface::Cylinder(s) => {
            let p = c + e * s.radius;
            straight([p, z], [s.radius, N::ZERO], p.dot(&e), m, d)
        }
        Surface::Cone(s) => {
            let (normal, out) = (e * s.cos - z * s.sin, e * (s.sin / s.cos) + z);
            let jacobian = [N::ZERO, s.sin / (s.cos * s.cos)];
            straight([c, out], jacobian, c.dot(&normal), m, d)
        }
        Surface::Sphere(s) => {
            let r = s.radius;
            let height = [r, c.dot(&e), c.dot(&z)];
            round([c, e * r, z * r], height, [N::ZERO, r * r, N::ZERO], m, d)
        }
        Surface::Torus(s) => {
            let (major, r) = (s.major, s.minor);
            let height = [r, c.dot(&e) + major, c.dot(&z)];
            let jacobian = [r * major, r * r, N::ZERO];
            round([c + e * major, e * r, z * r], height, jacobian, m, d)
        }
        Surface::EllipticCylinder(s) => {
            let [a, b] = s.radii;
            let p = c + f.x * (a * cos) + f.y * (b * sin);
            let across = f.x * (b * cos) + f.y * (a * sin);
            let size = across.length();
            straight([p, z], [size, N::ZERO], p.dot(&across) / size, m, d)
        }
        Surface::EllipticCone(s) => {
            let [a, b] = s.slopes;
            let out = f.x * (a * cos) + f.y * (b * sin) + z;
            let across = f.x * (b * cos) + f.y * (a * sin) - z * (a * b);
            let size = across.length();
            let jacobian = [N::ZERO, size];
            straight([c, out], jacobian, c.dot(&across) / size, m, d)
        }
        Surface::Ellipsoid(s) => ellipsoid_strip(s, reference, u, m, d),
    }
}

/// P = p + q v and J = j + k v.
fn straight<N: Float>(
    [p, q]: [Vector3<N>; 2],
    [j, k]: [N; 2],
    height: N,
    m: N,
    d: N,
) -> Moments<N> {
    // The integrals of 1, v and v².
    let length = N::TWO * d;
    let [one, first, second] = [
        length,
        length * m,
        length * (m * m + d * d / N::from_f64(3.0)),
    ];
    let area = j * one + k * first;
    let at = (p * area + q * (j * first + k * second)) * height;
    [area, height * area, at.x, at.y, at.z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::frame::Frame;
    use crate::geometry::surface::{Torus, of_every_kind, sheets};
    use crate::number::quadrature::adaptive;
    use approx::assert_relative_eq;

    #[test]
    fn strips_are_the_integrals_of_their_densities() {
        let frame = Frame::about(
            Point3::new(1.0, -2.0, 0.5),
            Vector3::new(0.3, -0.4, 0.7).normalize(),
        );
        let surfaces = of_every_kind(frame, 1.5, [3.0, 1.25]);
        let reference = Point3::new(0.2, 0.1, -0.7);
        // The strip ends below the upper pole of each sheet.
        let [inner, outer, horn] = sheets(frame);
        let inner = Torus {
            major: -1.0,
            ..inner
        };
        let sheets = [inner, outer, horn].map(Surface::Torus);
        let surfaces = surfaces.into_iter().chain(sheets);
        for (surface, u) in surfaces.zip([0.3, 1.1, 2.0, 4.0, 5.5, 0.7, 2.5, 0.2, 3.3, 5.9, 1.7]) {
            let surface = &surface;
            let density = |v: f64| {
                let step = 1e-5;
                let p = surface.point(u, v);
                let by_u = surface.point(u + step, v) - surface.point(u - step, v);
                let by_v = surface.point(u, v + step) - surface.point(u, v - step);
                let j = by_u.cross(&by_v).norm() / (4.0 * step * step);
                let p_to = p - reference;
                let h = p_to.dot(&surface.normal(&p)) * j;
                [j, h, h * p_to.x, h * p_to.y, h * p_to.z]
            };
            let closed = strip(surface, &reference, u, 0.5, [-0.3, 0.8]);
            let summed = adaptive(0.2, 1.3, &[1e-12; 5], &density);
            for (a, b) in closed.iter().zip(summed) {
                assert_relative_eq!(*a, b, max_relative = 1e-7, epsilon = 1e-7);
            }
        }
    }
}
