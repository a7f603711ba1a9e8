//! The intersection of a line of sight with the front of a surface that is known to be visible
//! there.

use nalgebra::Vector3;
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{FaceId, Sense};
use premio_kernel::geometry::elliptic_surface::EllipticCone;
use premio_kernel::geometry::surface::{Cone, Surface, Torus};
use premio_visibility::camera::projection::LineOfSight;

/// The number of Newton's steps on a torus, and of the steps into which its ball is divided where
/// Newton's method fails.
const STEPS: usize = 8;
const CUTS: usize = 64;

/// The distance along a line of sight at which it intersects the front of a face's surface,
/// near `hint` where there are several intersections. A line that just misses the surface gets the
/// point nearest to it: its limb.
pub fn front(brep: &Brep, face: FaceId, sight: &LineOfSight, hint: f64) -> Option<f64> {
    let surface = brep.surface(face);
    let outwards = brep.sense(face) == Sense::Along;
    let f = surface.frame();
    let q = f.coordinates(&sight.origin);
    let w = f.components(&sight.direction);
    let at = match surface {
        Surface::Plane(_) => -q.z / w.z,
        Surface::Cylinder(s) => {
            let a = w.x * w.x + w.y * w.y;
            let b = q.x * w.x + q.y * w.y;
            let c = q.x * q.x + q.y * q.y - s.radius * s.radius;
            entry(a, b, c, outwards)
        }
        Surface::Sphere(s) => {
            let c = q.norm_squared() - s.radius * s.radius;
            entry(1.0, q.dot(&w), c, outwards)
        }
        Surface::Cone(s) => cone(s, &q, &w, outwards),
        Surface::Torus(s) => torus(s, &q, &w, outwards, hint)?,
        Surface::EllipticCylinder(s) => {
            let (of_line, of_origin) = (s.gradient(&w), s.gradient(&q));
            let c = of_origin.dot(&q) - 1.0;
            entry(of_line.dot(&w), of_origin.dot(&w), c, outwards)
        }
        Surface::EllipticCone(s) => elliptic_cone(s, &q, &w, outwards),
        Surface::Ellipsoid(s) => {
            let [origin, towards] = [&q, &w].map(|v| s.on_unit_sphere(v));
            let c = origin.norm_squared() - 1.0;
            entry(towards.norm_squared(), origin.dot(&towards), c, outwards)
        }
    };
    at.is_finite().then_some(at)
}

/// The root of a s² + 2 b s + c at which a line enters a convex surface, or leaves it.
fn entry(a: f64, b: f64, c: f64, enters: bool) -> f64 {
    let root = (b * b - a * c).max(0.0).sqrt();
    // The root without cancellation, the other from the product.
    let k = -(b + root.copysign(b));
    let roots = [k / a, c / k];
    let (least, most) = (roots[0].min(roots[1]), roots[0].max(roots[1]));
    match (root > 0.0, enters) {
        (false, _) => -b / a,
        (true, true) => least,
        (true, false) => most,
    }
}

/// The one of the two intersections with both nappes that is on the cone and visible from its
/// front.
fn cone(s: &Cone, q: &Vector3<f64>, w: &Vector3<f64>, enters: bool) -> f64 {
    let (k, m) = (s.cos * s.cos, s.sin * s.sin);
    let a = k * (w.x * w.x + w.y * w.y) - m * w.z * w.z;
    let b = k * (q.x * w.x + q.y * w.y) - m * q.z * w.z;
    let c = k * (q.x * q.x + q.y * q.y) - m * q.z * q.z;
    let root = (b * b - a * c).max(0.0).sqrt();
    let r = -(b + root.copysign(b));
    let mut best = f64::NAN;
    for at in [r / a, c / r] {
        let p = q + w * at;
        let rho = p.x.hypot(p.y);
        let slope = (p.x * w.x + p.y * w.y) / rho * s.cos - w.z * s.sin;
        let is_front = (slope <= 0.0) == enters;
        if at.is_finite() && p.z >= 0.0 && (is_front || best.is_nan()) {
            best = at;
        }
    }
    best
}

/// The same of an elliptic cone.
fn elliptic_cone(s: &EllipticCone, q: &Vector3<f64>, w: &Vector3<f64>, enters: bool) -> f64 {
    let (of_line, of_origin) = (s.gradient(w), s.gradient(q));
    let (a, b, c) = (of_line.dot(w), of_origin.dot(w), of_origin.dot(q));
    let root = (b * b - a * c).max(0.0).sqrt();
    let r = -(b + root.copysign(b));
    let mut best = f64::NAN;
    for at in [r / a, c / r] {
        let p = q + w * at;
        let is_front = (s.gradient(&p).dot(w) <= 0.0) == enters;
        if at.is_finite() && p.z >= 0.0 && (is_front || best.is_nan()) {
            best = at;
        }
    }
    best
}

/// The intersection with a torus near a hint: Newton's method on the distance, and a search in the
/// ball around the torus where that fails.
fn torus(s: &Torus, q: &Vector3<f64>, w: &Vector3<f64>, enters: bool, hint: f64) -> Option<f64> {
    let sign = if enters { 1.0 } else { -1.0 };
    let value = |t: f64| {
        let p = q + w * t;
        let rho = p.x.hypot(p.y);
        let across = rho - s.major;
        let tube = across.hypot(p.z);
        let slope = (across * (p.x * w.x + p.y * w.y) / rho + p.z * w.z) / tube;
        DistanceAlong {
            distance: sign * (tube - s.minor),
            slope: sign * slope,
        }
    };
    let fine = s.minor * f64::EPSILON.sqrt();
    let mut t = hint;
    for _ in 0..STEPS {
        let DistanceAlong { distance, slope } = value(t);
        // From outside to inside along the line.
        if distance.abs() <= fine && slope <= 0.0 {
            return Some(t);
        }
        let step = distance / slope;
        if step.is_nan() || step.abs() > s.minor {
            break;
        }
        t -= step;
    }
    searched(&value, q, w, s, hint)
}

/// A signed distance from a surface at a point of a line.
struct DistanceAlong {
    distance: f64,
    /// Its derivative along the line.
    slope: f64,
}

/// The crossing from outside to inside nearest to the hint, or otherwise the point where the line
/// is nearest.
fn searched(
    value: &impl Fn(f64) -> DistanceAlong,
    q: &Vector3<f64>,
    w: &Vector3<f64>,
    s: &Torus,
    hint: f64,
) -> Option<f64> {
    let nearest = -q.dot(w);
    let reach = s.circumradius();
    let half2 = reach * reach - (q + w * nearest).norm_squared();
    if half2 <= 0.0 {
        return None;
    }
    let half = half2.sqrt();
    let at = |k: usize| nearest - half + 2.0 * half * (k as f64 / CUTS as f64);
    let mut best: Option<f64> = None;
    let mut least = (f64::INFINITY, nearest);
    for k in 0..CUTS {
        let [mut lo, mut hi] = [at(k), at(k + 1)];
        let [f, g] = [value(lo).distance, value(hi).distance];
        if f.abs() < least.0 {
            least = (f.abs(), lo);
        }
        if f > 0.0 && g <= 0.0 {
            for _ in 0..48 {
                let middle = 0.5 * (lo + hi);
                match value(middle).distance > 0.0 {
                    true => lo = middle,
                    false => hi = middle,
                }
            }
            if best.is_none_or(|known| (lo - hint).abs() < (known - hint).abs()) {
                best = Some(lo);
            }
        }
    }
    best.or(Some(least.1))
}
