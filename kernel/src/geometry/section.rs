//! Where a curve meets a plane, or a line of its surface: in closed form where there is one.

use super::curve::Curve;
use super::cut::cut;
use super::frame::Frame;
use super::quartic::{Quartic, Ruled, Sweep};
use super::surface::{Plane, Surface};
use crate::number::roots::{Contact, Zeros};
use crate::number::sign::ROUNDING;
use nalgebra::{Point3, Vector3};
use std::f64::consts::TAU;

/// Where a curve meets a plane, over a range: reports each parameter and whether the curve plainly
/// crosses there. Lines and conics with an angle in closed form.
pub fn plane_roots(
    curve: &Curve,
    range: [f64; 2],
    plane: &Plane,
    band: f64,
    found: &mut impl FnMut(f64, bool),
) {
    let section = (&plane.frame.origin, &plane.frame.z);
    section_roots(curve, range, section, band, found);
}

/// The same for the plane through a point with a unit normal.
pub(crate) fn section_roots(
    curve: &Curve,
    range: [f64; 2],
    (o, n): (&Point3<f64>, &Vector3<f64>),
    band: f64,
    found: &mut impl FnMut(f64, bool),
) {
    let plane = || Plane {
        frame: Frame::about(*o, *n),
    };
    match curve {
        Curve::Line(c) => {
            let height = (c.origin - o).dot(n);
            line_roots(height, c.direction.dot(n), range, band, found);
        }
        Curve::Circle(c) => {
            let k = [c.radius * c.frame.x.dot(n), c.radius * c.frame.y.dot(n)];
            turn_roots((c.frame.origin - o).dot(n), k, range, band, found);
        }
        Curve::Ellipse(c) => {
            let k = [c.a * c.frame.x.dot(n), c.b * c.frame.y.dot(n)];
            turn_roots((c.frame.origin - o).dot(n), k, range, band, found);
        }
        Curve::Quartic(c) if through_axis(c, (o, n), band) => {
            ruling_roots(c, range, n, band, found);
        }
        _ => surface_roots(curve, range, &Surface::Plane(plane()), band, found),
    }
}

/// The same for any surface.
pub(crate) fn surface_roots(
    curve: &Curve,
    range: [f64; 2],
    surface: &Surface,
    band: f64,
    found: &mut impl FnMut(f64, bool),
) {
    match cut(curve, range, surface, band) {
        Zeros::Everywhere => found(0.5 * (range[0] + range[1]), false),
        Zeros::At { roots, .. } => {
            for r in roots {
                found(r.t, r.contact == Contact::Simple);
            }
        }
    }
}

fn base_frame(curve: &Quartic) -> &Frame {
    match &curve.base {
        Ruled::Cylinder(s) => &s.frame,
        Ruled::Cone(s) => &s.frame,
    }
}

/// Whether a plane goes through the axis of the surface whose rulings carry a curve.
fn through_axis(curve: &Quartic, (o, n): (&Point3<f64>, &Vector3<f64>), band: f64) -> bool {
    let axis = base_frame(curve);
    let away = (axis.origin - o).dot(n).abs();
    n.dot(&axis.z).abs() <= ROUNDING && away <= band
}

/// Where a curve over the rulings of a surface meets a plane through their axis, with the normal
/// `n`: on two rulings.
fn ruling_roots(
    curve: &Quartic,
    [lo, hi]: [f64; 2],
    n: &Vector3<f64>,
    band: f64,
    found: &mut impl FnMut(f64, bool),
) {
    let axis = base_frame(curve);
    let u = (-n.dot(&axis.x)).atan2(n.dot(&axis.y));
    let period = curve.period();
    let mut within = |t: f64, plain: bool| {
        let t = period.map_or(t, |period| lo + (t - lo).rem_euclid(period));
        if t >= lo && t <= hi {
            found(t, plain);
        }
    };
    for u in [u, u + 0.5 * TAU] {
        match curve.sweep {
            Sweep::Round { turns } => {
                let first = lo + (u - lo).rem_euclid(TAU);
                (0..turns.max(1)).for_each(|k| within(first + TAU * f64::from(k), true));
            }
            Sweep::Oval { mid, half } => {
                let away = (u - mid + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU;
                // At the ends of the sweep the curve touches the ruling.
                let end = if away < 0.0 { 0.0 } else { 0.5 * TAU };
                let q = axis.coordinates(&curve.at(end).into());
                if (away.abs() - half).abs() * q.x.hypot(q.y) <= band {
                    within(end, false);
                } else if away.abs() < half {
                    let t = (-away / half).acos();
                    within(t, true);
                    within(TAU - t, true);
                }
            }
        }
    }
}

/// Zeros of height + slope t.
fn line_roots(
    height: f64,
    slope: f64,
    [lo, hi]: [f64; 2],
    band: f64,
    found: &mut impl FnMut(f64, bool),
) {
    let (a, b) = (height + slope * lo, height + slope * hi);
    if a.abs() <= band && b.abs() <= band {
        found(0.5 * (lo + hi), false);
    } else if a * b <= 0.0 {
        found((-height / slope).clamp(lo, hi), true);
    }
}

/// Zeros of c + k[0] cos t + k[1] sin t.
fn turn_roots(
    c: f64,
    k: [f64; 2],
    [lo, hi]: [f64; 2],
    band: f64,
    found: &mut impl FnMut(f64, bool),
) {
    let size = k[0].hypot(k[1]);
    let at = k[1].atan2(k[0]);
    if size + c.abs() <= band {
        return found(0.5 * (lo + hi), false);
    }
    if c.abs() > size + band {
        return;
    }
    let mut within = |t: f64, plain: bool| {
        let t = lo + (t - lo).rem_euclid(TAU);
        if t <= hi {
            found(t, plain);
        }
    };
    if c.abs() >= size - band {
        return within(if c > 0.0 { at + TAU / 2.0 } else { at }, false);
    }
    // The height that is missed is better known than its arc cosine near the top.
    let half = ((size - c) * (size + c)).sqrt().atan2(-c);
    within(at - half, true);
    within(at + half, true);
}

/// Where a line on one of two quadrics, by a point and its unit direction, meets the curve they
/// share over a range: where it meets the other one, a cylinder. Reports each parameter, and that
/// the curve is crossed plainly; false where no more can be said in closed form.
pub fn line_meets(
    curve: &Curve,
    [lo, hi]: [f64; 2],
    (start, direction): (&Point3<f64>, &Vector3<f64>),
    band: f64,
    found: &mut impl FnMut(f64, bool),
) -> bool {
    let Curve::Quartic(quartic) = curve else {
        return false;
    };
    let Ruled::Cylinder(s) = &quartic.base else {
        return false;
    };
    let (q, w) = (s.frame.coordinates(start), s.frame.components(direction));
    let a = w.x * w.x + w.y * w.y;
    if a <= ROUNDING.sqrt() {
        return false;
    }
    let b = q.x * w.x + q.y * w.y;
    let rho = q.x.hypot(q.y);
    let c = (rho - s.radius) * (rho + s.radius);
    let radicand = b * b - a * c;
    // Next to a touch the roots are not told from each other.
    if radicand.abs() <= 16.0 * s.radius * band * a {
        return false;
    }
    if radicand < 0.0 {
        return true;
    }
    let k = -(b + radicand.sqrt().copysign(b));
    for at in [k / a, c / k] {
        let p = start + direction * at;
        let t = curve.in_cycle(curve.parameter(&p), lo);
        // Else on another branch.
        if t >= lo && t <= hi && (curve.point(t) - p).norm() <= 64.0 * band {
            found(t, true);
        }
    }
    true
}
