//! Intersections of lines of sight with whole surfaces.

use crate::image_curve::polynomial::{QuarticPolynomial, clear_roots};
use crate::ray_casting::{OriginIncidence, SightLine};
use crate::scene::Scene;
use nalgebra::Vector3;
use premio_kernel::geometry::ellipsoid::Ellipsoid;
use premio_kernel::geometry::elliptic_surface::{EllipticCone, EllipticCylinder};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Cone, Cylinder, Sphere, Surface, Torus};
use premio_kernel::number::bisection::ValueAndSlope;
use premio_kernel::number::float::Analytic;
use premio_kernel::number::interval::Interval;
use premio_kernel::number::jet::Jet;
use premio_kernel::number::predicates::{Compare, ROUNDING};
use premio_kernel::number::roots::{RootKind, Roots, isolate};

/// An intersection of a line and a surface.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LineHit {
    /// The distance along the line.
    pub(crate) at: f64,
    /// Whether the line only touches the surface.
    pub(crate) touches: bool,
}

/// The line q + t w in the frame of a surface.
#[derive(Clone, Copy, Debug)]
struct LocalLine {
    q: Vector3<f64>,
    w: Vector3<f64>,
    /// How it intersects the surface at q.
    own: OriginIncidence,
}

/// Up to four intersections of a line and a surface.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LineHits {
    all: [LineHit; 4],
    count: usize,
}

impl LineHits {
    /// The intersections.
    pub(crate) fn as_slice(&self) -> &[LineHit] {
        &self.all[..self.count]
    }

    fn push(&mut self, at: f64, touches: bool) {
        if at.is_finite() && self.count < 4 {
            self.all[self.count] = LineHit { at, touches };
            self.count += 1;
        }
    }
}

impl LineHits {
    /// Adds the intersections of the line q + t w with both nappes of a cone that lie on its own.
    fn push_on_nappe(&mut self, both: &Self, q: &Vector3<f64>, w: &Vector3<f64>) {
        for hit in both.as_slice() {
            if (q.z + hit.at * w.z).reaches(0.0) {
                self.push(hit.at, hit.touches);
            }
        }
    }
}

impl Scene<'_> {
    /// The intersections of a line of sight with the surface of a face, without the root at the
    /// origin that `own` states.
    pub(crate) fn line_hits(
        &self,
        ray: &SightLine,
        surface: &Surface,
        own: OriginIncidence,
    ) -> LineHits {
        let mut found = LineHits::default();
        let f = surface.frame();
        let q = f.coordinates(&ray.origin);
        let w = f.components(&ray.towards);
        let line = LocalLine { q, w, own };
        match surface {
            Surface::Plane(_) => {
                if own == OriginIncidence::No && !self.edge_on(&f.origin, &f.z) {
                    found.push(-q.z / w.z, false);
                }
            }
            // A line through the apex has a double root, whatever its direction.
            Surface::Cone(_) | Surface::EllipticCone(_)
                if own == OriginIncidence::No && self.through_apex(&q, &w) =>
            {
                found.push(-q.dot(&w), true);
            }
            Surface::Cylinder(s) => self.cylinder(s, &line, &mut found),
            Surface::Sphere(s) => self.sphere(s, &line, &mut found),
            Surface::Cone(s) => self.cone(s, &line, &mut found),
            Surface::EllipticCylinder(s) => self.elliptic_cylinder(s, &line, &mut found),
            Surface::EllipticCone(s) => self.elliptic_cone(s, &line, &mut found),
            Surface::Ellipsoid(s) => self.ellipsoid(s, &line, &mut found),
            Surface::Torus(s) => self.torus(s, &line, ray.length, &mut found),
        }
        found
    }

    fn cylinder(&self, s: &Cylinder, &LocalLine { q, w, own }: &LocalLine, found: &mut LineHits) {
        let a = w.x * w.x + w.y * w.y;
        let b = q.x * w.x + q.y * w.y;
        let c = (q.x.hypot(q.y) - s.radius) * (q.x.hypot(q.y) + s.radius);
        self.quadric([a, b, c], own, |_| 2.0 * s.radius, found);
    }

    fn sphere(&self, s: &Sphere, &LocalLine { q, w, own }: &LocalLine, found: &mut LineHits) {
        let b = q.dot(&w);
        let c = (q.norm() - s.radius) * (q.norm() + s.radius);
        self.quadric([1.0, b, c], own, |_| 2.0 * s.radius, found);
    }

    fn cone(&self, s: &Cone, &LocalLine { q, w, own }: &LocalLine, found: &mut LineHits) {
        let (k, m) = (s.cos * s.cos, s.sin * s.sin);
        let a = k * (w.x * w.x + w.y * w.y) - m * w.z * w.z;
        let b = k * (q.x * w.x + q.y * w.y) - m * q.z * w.z;
        let rho = q.x.hypot(q.y);
        let c = (s.cos * rho - s.sin * q.z) * (s.cos * rho + s.sin * q.z);
        let gradient = |t: f64| 2.0 * s.sin * (q.z + t * w.z).abs();
        let mut both = LineHits::default();
        self.quadric([a, b, c], own, gradient, &mut both);
        found.push_on_nappe(&both, &q, &w);
    }

    fn elliptic_cylinder(
        &self,
        s: &EllipticCylinder,
        &LocalLine { q, w, own }: &LocalLine,
        found: &mut LineHits,
    ) {
        let rho = (q.x / s.radii[0]).hypot(q.y / s.radii[1]);
        let c = (rho - 1.0) * (rho + 1.0);
        let [a, b] = [w, q].map(|v| s.gradient(&v).dot(&w));
        let gradient = |t: f64| 2.0 * s.gradient(&(q + w * t)).norm();
        self.quadric([a, b, c], own, gradient, found);
    }

    fn elliptic_cone(
        &self,
        s: &EllipticCone,
        &LocalLine { q, w, own }: &LocalLine,
        found: &mut LineHits,
    ) {
        let rho = (q.x / s.slopes[0]).hypot(q.y / s.slopes[1]);
        let c = (rho - q.z) * (rho + q.z);
        let [a, b] = [w, q].map(|v| s.gradient(&v).dot(&w));
        let gradient = |t: f64| 2.0 * s.gradient(&(q + w * t)).norm();
        let mut both = LineHits::default();
        self.quadric([a, b, c], own, gradient, &mut both);
        found.push_on_nappe(&both, &q, &w);
    }

    fn ellipsoid(&self, s: &Ellipsoid, &LocalLine { q, w, own }: &LocalLine, found: &mut LineHits) {
        let [origin, towards] = [q, w].map(|v| s.on_unit_sphere(&v));
        let (away, a) = (origin.norm(), towards.norm_squared());
        let (b, c) = (origin.dot(&towards), (away - 1.0) * (away + 1.0));
        let gradient = |t: f64| 2.0 * s.gradient(&(q + w * t)).norm();
        self.quadric([a, b, c], own, gradient, found);
    }

    /// Whether a line passes through the origin of its frame.
    fn through_apex(&self, q: &Vector3<f64>, w: &Vector3<f64>) -> bool {
        (q - w * q.dot(w)).norm().is_within(4.0 * self.resolution)
    }

    /// The roots of a s² + 2 b s + c; `gradient` converts the value into a distance.
    fn quadric(
        &self,
        [a, b, c]: [f64; 3],
        own: OriginIncidence,
        gradient: impl Fn(f64) -> f64,
        found: &mut LineHits,
    ) {
        // A line along a ruling stays on the surface, or never intersects it.
        let flat = a.is_within(ROUNDING);
        match own {
            OriginIncidence::Tangent => {}
            OriginIncidence::Through if flat => {}
            OriginIncidence::Through => found.push(-2.0 * b / a, false),
            OriginIncidence::No if flat => {
                if b.abs().is_beyond(ROUNDING * c.abs().sqrt()) {
                    found.push(-0.5 * c / b, false);
                }
            }
            OriginIncidence::No => {
                let at = -b / a;
                let extremum = c - b * b / a;
                if extremum.is_within(4.0 * self.resolution * gradient(at)) {
                    return found.push(at, true);
                }
                let radicand = b * b - a * c;
                if radicand.is_below_zero() {
                    return;
                }
                let k = -(b + radicand.sqrt().copysign(b));
                found.push(k / a, false);
                found.push(c / k, false);
            }
        }
    }

    /// The intersections of a line with a torus, without the known ones at its origin.
    fn torus(
        &self,
        s: &Torus,
        LocalLine { q, w, own }: &LocalLine,
        length: f64,
        found: &mut LineHits,
    ) {
        // The torus lies inside this sphere; the origin may be far away.
        let reach = s.circumradius() + 4.0 * self.resolution;
        let nearest = -q.dot(w);
        let half2 = reach * reach - (q + w * nearest).norm_squared();
        if half2.is_at_most(0.0) {
            return;
        }
        let (lo, hi) = (nearest - half2.sqrt(), nearest + half2.sqrt());
        let (lo, hi) = (lo.max(0.0), hi.min(length));
        if lo.reaches(hi) {
            return;
        }
        let known = match own {
            OriginIncidence::No => return self.whole_torus(s, [q, w], [lo, hi], found),
            OriginIncidence::Through => 1,
            OriginIncidence::Tangent => 2,
        };
        self.rest_of_torus(s, [q, w], [lo, hi], known, found);
    }

    /// The intersections of a range of the line q + t w with a torus.
    fn whole_torus(
        &self,
        s: &Torus,
        [q, w]: [&Vector3<f64>; 2],
        [lo, hi]: [f64; 2],
        found: &mut LineHits,
    ) {
        if let Some(clear) = clear_torus_hits(s, [q, w], [lo, hi], self.resolution) {
            clear.into_iter().for_each(|at| found.push(at, false));
            return;
        }
        let surface = Surface::Torus(Torus {
            frame: Frame::world(),
            ..*s
        });
        let f = |t: Interval| {
            let p: [Jet<Interval>; 3] =
                std::array::from_fn(|i| Jet::variable(t).scale(w[i]) + Jet::constant(q[i]));
            surface.level(p)
        };
        for [lo, hi] in self.parts_off_poles(s, q, w, [lo, hi], found) {
            if self.isolated(&f, lo, hi, found) == Roots::Everywhere {
                found.push(0.5 * (lo + hi), true);
            }
        }
    }

    /// The intersections of a range of the line q + t w with a torus, less the `known` ones at t = 0.
    fn rest_of_torus(
        &self,
        s: &Torus,
        [q, w]: [&Vector3<f64>; 2],
        [lo, hi]: [f64; 2],
        known: usize,
        found: &mut LineHits,
    ) {
        let quartic = torus_quartic(s, q, w);
        // The gradient of the quartic is 8 R r ρ; on a ring ρ is at least R - r.
        let reach = s.circumradius() + 4.0 * self.resolution;
        let least = match s.is_ring() {
            true => s.major - s.minor,
            false => q.x.hypot(q.y).max(ROUNDING.sqrt() * reach),
        };
        let size = 8.0 * s.major.abs() * s.minor * least / reach.powi(known as i32);
        let mut rest: QuarticPolynomial = [0.0; 5];
        rest[..5 - known].copy_from_slice(&quartic[known..]);
        let is_clear = |_, value: f64| (value / size).abs().is_beyond(CLEAR * self.resolution);
        let is_accurate = is_accurate(s, q.norm() + reach, self.resolution);
        let clear = is_accurate.then(|| clear_roots(&rest, [lo, hi], &is_clear));
        if let Some(clear) = clear.flatten() {
            clear.into_iter().for_each(|at| found.push(at, false));
            return;
        }
        let f = |t: Interval| {
            let t = Jet::variable(t);
            let zero = Jet::constant(0.0);
            rest.iter()
                .rev()
                .fold(zero, |sum, &k| sum * t + Jet::constant(k))
                .scale(1.0 / size)
        };
        let mut both = LineHits::default();
        self.isolated(&f, lo, hi, &mut both);
        let own = Torus {
            frame: Frame::world(),
            ..*s
        };
        for hit in both.as_slice() {
            let p: [f64; 3] = (q + w * hit.at).into();
            if s.is_ring() || own.sheet_level(p).is_above_zero() {
                found.push(hit.at, hit.touches);
            }
        }
    }

    /// The parts of a range of a line that are not close to a pole of a torus; at a pole the line
    /// touches the surface. The line is given in the torus's frame.
    fn parts_off_poles(
        &self,
        s: &Torus,
        q: &Vector3<f64>,
        w: &Vector3<f64>,
        range: [f64; 2],
        found: &mut LineHits,
    ) -> Vec<[f64; 2]> {
        let mut parts = vec![range];
        for pole in s.poles() {
            let from_pole = q - s.frame.coordinates(&pole);
            let at = -from_pole.dot(w);
            let [from, to] = [-1.0, 1.0].map(|side| at + side * 4.0 * self.resolution);
            let is_through = self.through_apex(&from_pole, w) && at.lies_in(range);
            if is_through {
                found.push(at, true);
                let halves = parts
                    .iter()
                    .flat_map(|&[lo, hi]| [[lo, hi.min(from)], [lo.max(to), hi]]);
                parts = halves.filter(|[lo, hi]| lo.is_short_of(*hi)).collect();
            }
        }
        parts
    }

    fn isolated(
        &self,
        f: &impl Fn(Interval) -> Jet<Interval>,
        lo: f64,
        hi: f64,
        found: &mut LineHits,
    ) -> Roots {
        let zeros = isolate(f, &[lo, hi], self.resolution);
        if let Roots::At { roots, .. } = &zeros {
            for r in roots {
                found.push(r.t, r.contact == RootKind::Touching);
            }
        }
        zeros
    }
}

/// The least distance from a torus at which a line is clear of it, in multiples of the resolution.
const CLEAR: f64 = 128.0;
/// The least sine of the angle at which a line crosses a torus clearly.
const STEEP: f64 = 1.0 / 128.0;
/// A bound on the rounding errors of a quartic, relative to those of its largest term.
const ROUNDINGS: f64 = 64.0;

/// The intersections of a range of the line q + t w with a ring torus about z, in increasing order.
/// `None` unless each is a crossing, and the line is clear of the torus at both ends of the range and at
/// each extremum of the quartic.
fn clear_torus_hits(
    s: &Torus,
    [q, w]: [&Vector3<f64>; 2],
    [lo, hi]: [f64; 2],
    resolution: f64,
) -> Option<Vec<f64>> {
    let (middle, half) = (0.5 * (lo + hi), 0.5 * (hi - lo));
    let c = q + w * middle;
    if !is_accurate(s, c.norm() + half + s.circumradius(), resolution) {
        return None;
    }
    let distance = |t: f64| {
        let p = c + w * t;
        let rho = p.x.hypot(p.y);
        let across = rho - s.major;
        let tube = across.hypot(p.z);
        ValueAndSlope {
            value: tube - s.minor,
            slope: (across * (p.x * w.x + p.y * w.y) / rho + p.z * w.z) / tube,
        }
    };
    let is_clear = |t: f64, _| distance(t).value.abs().is_beyond(CLEAR * resolution);
    let roots = clear_roots(&torus_quartic(s, &c, w), [-half, half], &is_clear)?;
    let polished = |t: f64| {
        let ValueAndSlope { value, slope } = distance(t);
        slope
            .abs()
            .is_beyond(STEEP)
            .then(|| middle + (t - value / slope))
    };
    roots.into_iter().map(polished).collect()
}

/// Whether the quartic gives the distance from a torus to less than the resolution, at points whose
/// coordinates, and those of the line's origin, are below `size`. It does not if the tube is thin, or if
/// the hole is small.
fn is_accurate(s: &Torus, size: f64, resolution: f64) -> bool {
    let noise = ROUNDINGS * f64::EPSILON * size.powi(4);
    // Next to the torus the quartic is the distance times 8 R r ρ, and ρ is at least R - r.
    let least = 8.0 * s.major * s.minor * (s.major - s.minor);
    s.is_ring() && noise.is_short_of(resolution * least)
}

/// The quartic (|p|² + R² - r²)² - 4 R² (x² + y²) along the line p = q + t w.
fn torus_quartic(s: &Torus, q: &Vector3<f64>, w: &Vector3<f64>) -> QuarticPolynomial {
    // |p|² + R² - r² = t² + b t + c.
    let b = 2.0 * q.dot(w);
    let c = q.norm_squared() + s.major * s.major - s.minor * s.minor;
    let k = 4.0 * s.major * s.major;
    [
        c * c - k * (q.x * q.x + q.y * q.y),
        2.0 * b * c - 2.0 * k * (q.x * w.x + q.y * w.y),
        b * b + 2.0 * c - k * (w.x * w.x + w.y * w.y),
        2.0 * b,
        1.0,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RESOLUTION: f64 = 1e-10;

    /// The roots of the signed distance, by isolation.
    fn isolated(s: &Torus, [q, w]: [&Vector3<f64>; 2], range: [f64; 2]) -> Vec<f64> {
        let surface = Surface::Torus(*s);
        let f = |t: Interval| {
            let p: [Jet<Interval>; 3] =
                std::array::from_fn(|i| Jet::variable(t).scale(w[i]) + Jet::constant(q[i]));
            surface.level(p)
        };
        match isolate(&f, &range, RESOLUTION) {
            Roots::At { roots, .. } => roots.iter().map(|root| root.t).collect(),
            Roots::Everywhere => Vec::new(),
        }
    }

    proptest! {
        #[test]
        fn clear_hits_are_those_of_root_isolation(
            q in prop::array::uniform3(-1.5..1.5_f64),
            w in prop::array::uniform3(-1.0..1.0_f64),
            minor in 0.01..0.99_f64,
        ) {
            let [q, w] = [Vector3::from(q), Vector3::from(w)];
            prop_assume!(w.norm() > 0.1);
            let w = w.normalize();
            let s = Torus { frame: Frame::world(), major: 1.0, minor };
            let range = [-3.0, 3.0];
            if let Some(found) = clear_torus_hits(&s, [&q, &w], range, RESOLUTION) {
                let known = isolated(&s, [&q, &w], range);
                prop_assert_eq!(found.len(), known.len());
                for (x, y) in found.iter().zip(&known) {
                    prop_assert!((x - y).abs() < 1e-12, "{x} {y}");
                }
            }
        }
    }

    /// A line along x at the height of the tube's top, and the same a little lower.
    #[test]
    fn a_line_along_the_top_of_a_torus_is_not_clear() {
        let s = Torus {
            frame: Frame::world(),
            major: 2.0,
            minor: 0.5,
        };
        let w = Vector3::x();
        let hits = |z: f64| {
            let q = Vector3::new(0.0, 0.0, z);
            clear_torus_hits(&s, [&q, &w], [-4.0, 4.0], RESOLUTION)
        };
        assert_eq!(hits(0.5), None);
        assert_eq!(hits(0.5 - 1e-9), None);
        assert_eq!(hits(0.6).map(|hits| hits.len()), Some(0));
        assert!(!is_accurate(&Torus { minor: 1e-5, ..s }, 8.0, RESOLUTION));
        assert!(!is_accurate(
            &Torus {
                minor: 2.0 - 1e-9,
                ..s
            },
            8.0,
            RESOLUTION
        ));
        // At half the height the tube is cut at 2 ± √(1/4 - 1/16).
        let across = (0.25_f64 - 0.0625).sqrt();
        let places = [-2.0 - across, -2.0 + across, 2.0 - across, 2.0 + across];
        let found = hits(0.25).unwrap_or_default();
        assert_eq!(found.len(), 4);
        for (x, y) in found.iter().zip(places) {
            assert!((x - y).abs() < 1e-14, "{x} {y}");
        }
    }
}
