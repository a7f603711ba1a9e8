//! Intersections of a curve with a plane, or with a line on its surface, in closed form where
//! possible.

use super::curve::{Curve, Line};
use super::curve_surface::cut;
use super::frame::Frame;
use super::quadric_curve::{QuadricCurve, Ruled, Sweep};
use super::surface::{Plane, Surface};
use crate::geometry::vector::Length;
use crate::number::elementary_roots::{linear_roots, wave_roots};
use crate::number::float::Float;
use crate::number::roots::{RootKind, Roots};
use nalgebra::{Point3, Vector3};

/// Intersects a curve with a plane over a range. Reports each parameter, and whether the curve
/// crosses there transversally. Lines, circles and ellipses have a closed form.
pub fn plane_roots<N: Float>(
    curve: &Curve<N>,
    range: [N; 2],
    plane: &Plane<N>,
    resolution: N,
    found: &mut impl FnMut(N, bool),
) {
    let section = SectionPlane {
        point: &plane.frame.origin,
        normal: &plane.frame.z,
    };
    section_roots(curve, range, section, resolution, found);
}

/// A plane.
#[derive(Clone, Copy)]
pub(crate) struct SectionPlane<'a, N: Float = f64> {
    /// A point of it.
    pub point: &'a Point3<N>,
    /// The unit normal.
    pub normal: &'a Vector3<N>,
}

/// Intersects with a plane.
pub(crate) fn section_roots<N: Float>(
    curve: &Curve<N>,
    range: [N; 2],
    section: SectionPlane<'_, N>,
    resolution: N,
    found: &mut impl FnMut(N, bool),
) {
    let SectionPlane {
        point: o,
        normal: n,
    } = section;
    let plane = || Plane {
        frame: Frame::about(*o, *n),
    };
    match curve {
        Curve::Line(c) => {
            let height = (c.origin - o).dot(n);
            linear_roots(height, c.direction.dot(n), range, resolution, found);
        }
        Curve::Circle(c) => {
            let k = [c.radius * c.frame.x.dot(n), c.radius * c.frame.y.dot(n)];
            wave_roots((c.frame.origin - o).dot(n), k, range, resolution, found);
        }
        Curve::Ellipse(c) => {
            let k = [c.a * c.frame.x.dot(n), c.b * c.frame.y.dot(n)];
            wave_roots((c.frame.origin - o).dot(n), k, range, resolution, found);
        }
        Curve::Quartic(c) if through_axis(c, section, resolution) => {
            ruling_roots(c, range, n, resolution, found);
        }
        _ => surface_roots(curve, range, &Surface::Plane(plane()), resolution, found),
    }
}

/// Intersects with any surface.
pub(crate) fn surface_roots<N: Float>(
    curve: &Curve<N>,
    range: [N; 2],
    surface: &Surface<N>,
    resolution: N,
    found: &mut impl FnMut(N, bool),
) {
    match cut(curve, range, surface, resolution) {
        Roots::Everywhere => found(N::HALF * (range[0] + range[1]), false),
        Roots::At { roots, .. } => {
            for r in roots {
                found(r.t, r.contact == RootKind::Simple);
            }
        }
    }
}

/// Whether a plane contains the axis of the surface whose rulings carry a curve.
fn through_axis<N: Float>(
    curve: &QuadricCurve<N>,
    section: SectionPlane<'_, N>,
    resolution: N,
) -> bool {
    let axis = curve.base.frame();
    let away = (axis.origin - section.point).dot(section.normal).abs();
    section.normal.dot(&axis.z).abs() <= N::ROUNDING && away <= resolution
}

/// Intersects a curve over the rulings of a surface with a plane through their axis and with normal
/// `n`. The intersections lie on two rulings.
fn ruling_roots<N: Float>(
    curve: &QuadricCurve<N>,
    [lo, hi]: [N; 2],
    n: &Vector3<N>,
    resolution: N,
    found: &mut impl FnMut(N, bool),
) {
    let axis = curve.base.frame();
    let [a, b] = curve.base.radii();
    let [x, y] = match curve.base {
        Ruled::Cylinder(_) | Ruled::Cone(_) => [n.dot(&axis.x), n.dot(&axis.y)],
        Ruled::EllipticCylinder(_) | Ruled::EllipticCone(_) => {
            [a * n.dot(&axis.x), b * n.dot(&axis.y)]
        }
    };
    let u = (-x).atan2(y);
    let period = curve.period();
    let mut within = |t: N, simple: bool| {
        let t = period.map_or(t, |period| lo + (t - lo).rem_euclid(period));
        if t >= lo && t <= hi {
            found(t, simple);
        }
    };
    for u in [u, u + N::HALF * N::TAU] {
        match curve.sweep {
            Sweep::Round { turns } => {
                let first = lo + (u - lo).rem_euclid(N::TAU);
                (0..turns.max(1)).for_each(|k| within(first + N::TAU * N::whole(k), true));
            }
            Sweep::Oval { mid, half } => {
                let away = (u - mid + N::HALF * N::TAU).rem_euclid(N::TAU) - N::HALF * N::TAU;
                // At the ends of the sweep the curve is tangent to the ruling.
                let end = if away < N::ZERO {
                    N::ZERO
                } else {
                    N::HALF * N::TAU
                };
                let q = axis.coordinates(&curve.at(end).into());
                if (away.abs() - half).abs() * q.x.hypot(q.y) <= resolution {
                    within(end, false);
                } else if away.abs() < half {
                    let t = (-away / half).acos();
                    within(t, true);
                    within(N::TAU - t, true);
                }
            }
        }
    }
}

/// Intersects a line on one of two quadrics with their intersection curve over a range. The line
/// meets the curve where it meets the other quadric, a cylinder. Reports each parameter, always as a transversal crossing. Returns false if there is no
/// reliable closed form.
pub fn line_intersections<N: Float>(
    curve: &Curve<N>,
    [lo, hi]: [N; 2],
    line: &Line<N>,
    resolution: N,
    found: &mut impl FnMut(N, bool),
) -> bool {
    let Curve::Quartic(quartic) = curve else {
        return false;
    };
    let Ruled::Cylinder(s) = &quartic.base else {
        return false;
    };
    let q = s.frame.coordinates(&line.origin);
    let w = s.frame.components(&line.direction);
    let a = w.x * w.x + w.y * w.y;
    if a <= N::ROUNDING.sqrt() {
        return false;
    }
    let b = q.x * w.x + q.y * w.y;
    let rho = q.x.hypot(q.y);
    let c = (rho - s.radius) * (rho + s.radius);
    let radicand = b * b - a * c;
    // Close to tangency the two roots cannot be separated.
    if radicand.abs() <= N::from_f64(16.0) * s.radius * resolution * a {
        return false;
    }
    if radicand < N::ZERO {
        return true;
    }
    let k = -(b + radicand.sqrt().copysign(b));
    for at in [k / a, c / k] {
        let p = line.origin + line.direction * at;
        let t = curve.in_cycle(curve.parameter(&p), lo);
        // Otherwise the point lies on another branch.
        if t >= lo && t <= hi && (curve.point(t) - p).length() <= N::from_f64(64.0) * resolution {
            found(t, true);
        }
    }
    true
}
