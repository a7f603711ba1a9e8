//! Intersections of lines of sight with whole surfaces.

use crate::ray_casting::{OriginIncidence, SightLine};
use crate::scene::Scene;
use nalgebra::Vector3;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Surface, Torus};
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
        match surface {
            Surface::Plane(_) => {
                if own == OriginIncidence::No && !self.edge_on(&f.origin, &f.z) {
                    found.push(-q.z / w.z, false);
                }
            }
            Surface::Cylinder(s) => {
                let a = w.x * w.x + w.y * w.y;
                let b = q.x * w.x + q.y * w.y;
                let c = (q.x.hypot(q.y) - s.radius) * (q.x.hypot(q.y) + s.radius);
                self.quadric([a, b, c], own, |_| 2.0 * s.radius, &mut found);
            }
            Surface::Sphere(s) => {
                let b = q.dot(&w);
                let c = (q.norm() - s.radius) * (q.norm() + s.radius);
                self.quadric([1.0, b, c], own, |_| 2.0 * s.radius, &mut found);
            }
            // A line through the apex has a double root, whatever its direction.
            Surface::Cone(_) | Surface::EllipticCone(_)
                if own == OriginIncidence::No && self.through_apex(&q, &w) =>
            {
                found.push(-q.dot(&w), true);
            }
            Surface::Cone(s) => {
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
            Surface::EllipticCylinder(s) => {
                let rho = (q.x / s.radii[0]).hypot(q.y / s.radii[1]);
                let c = (rho - 1.0) * (rho + 1.0);
                let [a, b] = [&w, &q].map(|v| s.gradient(v).dot(&w));
                let gradient = |t: f64| 2.0 * s.gradient(&(q + w * t)).norm();
                self.quadric([a, b, c], own, gradient, &mut found);
            }
            Surface::EllipticCone(s) => {
                let rho = (q.x / s.slopes[0]).hypot(q.y / s.slopes[1]);
                let c = (rho - q.z) * (rho + q.z);
                let [a, b] = [&w, &q].map(|v| s.gradient(v).dot(&w));
                let gradient = |t: f64| 2.0 * s.gradient(&(q + w * t)).norm();
                let mut both = LineHits::default();
                self.quadric([a, b, c], own, gradient, &mut both);
                found.push_on_nappe(&both, &q, &w);
            }
            Surface::Ellipsoid(s) => {
                let [origin, towards] = [&q, &w].map(|v| s.on_unit_sphere(v));
                let (away, a) = (origin.norm(), towards.norm_squared());
                let (b, c) = (origin.dot(&towards), (away - 1.0) * (away + 1.0));
                let gradient = |t: f64| 2.0 * s.gradient(&(q + w * t)).norm();
                self.quadric([a, b, c], own, gradient, &mut found);
            }
            Surface::Torus(s) => self.torus(s, &q, &w, own, ray.length, &mut found),
        }
        found
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

    /// The roots of the torus's quartic (|q|² + R² - r²)² = 4 R² (x² + y²) along the line, less
    /// the known ones.
    fn torus(
        &self,
        s: &Torus,
        q: &Vector3<f64>,
        w: &Vector3<f64>,
        own: OriginIncidence,
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
        let (major, minor) = (s.major, s.minor);
        // s² + b s + c with c the value at the origin, then the quartic's coefficients.
        let b = 2.0 * q.dot(w);
        let c = q.norm_squared() + major * major - minor * minor;
        let k = 4.0 * major * major;
        let quartic = [
            c * c - k * (q.x * q.x + q.y * q.y),
            2.0 * b * c - 2.0 * k * (q.x * w.x + q.y * w.y),
            b * b + 2.0 * c - k * (w.x * w.x + w.y * w.y),
            2.0 * b,
            1.0,
        ];
        let known = match own {
            OriginIncidence::No => 0,
            OriginIncidence::Through => 1,
            OriginIncidence::Tangent => 2,
        };
        if known == 0 {
            let q0 = [q.x, q.y, q.z];
            let surface = Surface::Torus(Torus {
                frame: Frame::world(),
                ..*s
            });
            let f = |t: Interval| {
                let p: [Jet<Interval>; 3] =
                    std::array::from_fn(|i| Jet::variable(t).scale(w[i]) + Jet::constant(q0[i]));
                surface.level(p)
            };
            for [lo, hi] in self.parts_off_poles(s, q, w, [lo, hi], found) {
                if self.isolated(&f, lo, hi, found) == Roots::Everywhere {
                    found.push(0.5 * (lo + hi), true);
                }
            }
            return;
        }
        // The gradient of the quartic is 8 R r ρ; on a ring ρ is at least R - r.
        let least = match s.is_ring() {
            true => major - minor,
            false => q.x.hypot(q.y).max(ROUNDING.sqrt() * reach),
        };
        let size = 8.0 * major.abs() * minor * least / reach.powi(known as i32);
        let rest = &quartic[known..];
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
