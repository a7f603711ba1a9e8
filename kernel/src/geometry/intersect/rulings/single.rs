//! The case of one intersection on each ruling: the rulings are a direction of the other quadric,
//! or pass through its apex.

use super::{Rulings, apart};
use crate::geometry::curve::{Curve, Line};
use crate::geometry::intersect::{Branch, IntersectionError, Node, SurfaceIntersection, place};
use crate::geometry::quadric_curve::{Height, QuadricCurve, Ruled, Sweep};
use crate::geometry::surface::Surface;
use crate::geometry::trigonometric::{
    HalfAngleQuotients, Trig1, Trig2, divide, divide_half, trig1, zeros_of,
};
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Predicates;
use nalgebra::{Point3, Vector3};

impl<N: Float> Rulings<'_, N> {
    /// The curve for k = 0: one point on each ruling, w = -C/(2B).
    pub(in crate::geometry::intersect) fn single(
        &self,
        predicates: &Predicates,
    ) -> Result<SurfaceIntersection<N>, IntersectionError> {
        let mut meeting = SurfaceIntersection::nothing();
        let shared = self.shared_ruling(predicates);
        let tangent = shared.is_some_and(|u0| self.touches_along(u0, predicates));
        let height = match shared {
            Some(u0) if tangent => self.without_contact(u0),
            Some(u0) => {
                let HalfAngleQuotients { linear, constant } =
                    divide_half(&self.linear, &self.constant, u0);
                Height::Cubic { linear, constant }
            }
            None => Height::Rational {
                linear: self.linear,
                constant: self.constant,
            },
        };
        let quartic = QuadricCurve {
            base: self.base,
            sweep: Sweep::Round { turns: 1 },
            height,
        };
        match self.single_conic(predicates) {
            Some(w) => self.add_conic(&w, false, predicates, &mut meeting),
            None => self.add_single(quartic, shared, predicates, &mut meeting),
        }
        if let Some(u0) = shared {
            self.add_shared(u0, &quartic, tangent, predicates, &mut meeting);
        }
        self.add_apexes(predicates, &mut meeting);
        Ok(meeting)
    }

    /// w = -C/(2B) if it is of degree one, which is a planar conic.
    fn single_conic(&self, predicates: &Predicates) -> Option<Trig1<N>> {
        let w = divide(&self.constant, &self.linear).map(|q| -N::HALF * q);
        self.meets_in_conics(predicates, |u| vec![trig1(&w, u.sin_cos())])
            .then_some(w)
    }

    /// Adds the curve w = -C/(2B), clipped to both surfaces.
    fn add_single(
        &self,
        quartic: QuadricCurve<N>,
        shared: Option<N>,
        predicates: &Predicates,
        meeting: &mut SurfaceIntersection<N>,
    ) {
        let whole = [N::ZERO, N::TAU];
        for range in self.bounded_ranges(&quartic, shared, self.reach()) {
            let curve = Curve::Quartic(Box::new(quartic));
            for range in self.on_other_nappe(&curve, range, predicates) {
                let branch = Branch {
                    curve: curve.clone(),
                    range,
                    closed: shared.is_none() && range == whole,
                    tangent: false,
                };
                meeting.branches.push(branch);
            }
        }
    }

    /// The ruling that lies on both surfaces for k = 0: a common zero of B and C.
    fn shared_ruling(&self, predicates: &Predicates) -> Option<N> {
        let surface = self.base.surface();
        let apex = match self.other {
            Surface::Cone(_) | Surface::EllipticCone(_) => self.other.frame().origin,
            _ => return None,
        };
        if !self.base.is_cone() {
            let is_on = predicates.within(surface.distance(&apex));
            return is_on.then(|| self.base.angle(&apex));
        }
        let up = surface.frame().coordinates(&apex).z;
        let u = self.base.angle(&apex);
        let u = if up < N::ZERO { u + N::PI } else { u };
        let is_on = predicates.within(apart(&surface, &apex));
        ((N::ONE / up).is_finite() && is_on).then_some(u)
    }

    /// Whether the surfaces are tangent along all of the common ruling u0.
    fn touches_along(&self, u0: N, predicates: &Predicates) -> bool {
        let surface = self.base.surface();
        let p = self.world(u0, N::ONE);
        let along = match self.base.is_cone() {
            true => (p - surface.frame().origin).unit(),
            false => surface.frame().z,
        };
        let normal = match self.other {
            Surface::Cone(cone) => {
                // The vector perpendicular to the ruling in the plane of the ruling and the axis.
                let axis = cone.frame.z;
                (axis - along * axis.dot(&along)).unit()
            }
            Surface::EllipticCone(cone) => {
                let upward = along * along.dot(&cone.frame.z).signum();
                self.other.normal(&(cone.frame.origin + upward))
            }
            _ => return false,
        };
        let drift = surface.normal(&p).cross(&normal).length() * self.extent.radius;
        predicates.coincide("tangent along a ruling", drift, place(&p))
    }

    /// w = -C/(2B), which is of degree one if B and C have a double zero at u0.
    fn without_contact(&self, u0: N) -> Height<N> {
        let factor = [N::ONE, -u0.cos(), -u0.sin()];
        let [a, b, c] = divide(&self.constant, &factor);
        let dot = |k: &Trig1<N>| k.iter().zip(&factor).map(|(k, f)| *k * *f).sum::<N>();
        let linear = dot(&self.linear) / dot(&factor);
        Height::Rational {
            linear: [linear, N::ZERO, N::ZERO],
            constant: [a, b, c, N::ZERO, N::ZERO],
        }
    }

    /// The ranges of u over which the single point of a ruling is on the base and within `reach`.
    fn bounded_ranges(&self, q: &QuadricCurve<N>, shared: Option<N>, reach: N) -> Vec<[N; 2]> {
        // The limits |w| = reach, w = 1/reach and the poles, as signs of N - x D with w = N/D.
        let quotient = |u: N| q.height_at(u);
        let is_cone = self.base.is_cone();
        let inside = |u: N| match is_cone {
            false => quotient(u).abs() <= reach,
            true => quotient(u) * reach >= N::ONE,
        };
        let bound = |x: N| -> Trig2<N> {
            let mut k = self.constant;
            for (c, b) in k.iter_mut().zip(&self.linear) {
                *c += N::TWO * x * *b;
            }
            k
        };
        let limits = match is_cone {
            false => vec![bound(reach), bound(-reach)],
            true => {
                vec![
                    bound(N::ONE / reach),
                    [
                        self.linear[0],
                        self.linear[1],
                        self.linear[2],
                        N::ZERO,
                        N::ZERO,
                    ],
                ]
            }
        };
        let mut marks: Vec<N> = shared.into_iter().collect();
        for k in &limits {
            marks.extend(zeros_of(k));
        }
        let mut marks: Vec<N> = marks.into_iter().map(|u| u.rem_euclid(N::TAU)).collect();
        marks.sort_by(N::total_cmp);
        marks.dedup_by(|a, b| (*a - *b).abs() < N::ONE / N::whole(1 << 24));
        let Some(&first) = marks.first() else {
            return if inside(N::HALF) {
                vec![[N::ZERO, N::TAU]]
            } else {
                Vec::new()
            };
        };
        marks.push(first + N::TAU);
        let mut ranges: Vec<[N; 2]> = Vec::new();
        for m in marks.windows(2) {
            if inside(N::HALF * (m[0] + m[1])) {
                match ranges.last_mut() {
                    // The curve does not end at the shared ruling but crosses it.
                    Some(last) if last[1] == m[0] && shared.is_some_and(|s| same_turn(s, m[0])) => {
                        last[1] = m[1];
                    }
                    _ => ranges.push([m[0], m[1]]),
                }
            }
        }
        ranges
    }

    /// Adds the ruling common to both surfaces, with the point where the rest of the curve crosses
    /// it.
    fn add_shared(
        &self,
        u0: N,
        q: &QuadricCurve<N>,
        tangent: bool,
        predicates: &Predicates,
        meeting: &mut SurfaceIntersection<N>,
    ) {
        let surface = self.base.surface();
        let frame = surface.frame();
        let [m, n] = self.base.radii();
        let (x, y) = (m * u0.cos(), n * u0.sin());
        let (origin, direction) = match &self.base {
            Ruled::Cylinder(_) | Ruled::EllipticCylinder(_) => {
                (frame.point(x, y, N::ZERO), frame.z)
            }
            Ruled::Cone(s) => {
                let local = Vector3::new(s.sin * u0.cos(), s.sin * u0.sin(), s.cos);
                (frame.origin, frame.vector(&local))
            }
            Ruled::EllipticCone(_) => {
                let local = Vector3::new(x, y, N::ONE);
                (frame.origin, frame.vector(&local.unit()))
            }
        };
        let curve = Curve::Line(Line { origin, direction });
        let Some([lo, hi]) = curve.range_within(&self.extent.centre, self.extent.radius) else {
            return;
        };
        let lo = if self.base.is_cone() {
            lo.max(N::ZERO)
        } else {
            lo
        };
        for range in self.on_other_nappe(&curve, [lo, hi], predicates) {
            let branch = Branch {
                curve: curve.clone(),
                range,
                closed: false,
                tangent,
            };
            meeting.branches.push(branch);
        }
        let crossing = Point3::from(q.at(u0));
        let is_near = (crossing - self.extent.centre).length() <= self.extent.radius;
        // The crossing may lie on the other nappe of either surface.
        let mut both = [&surface, self.other].into_iter();
        if is_near && both.all(|s| predicates.within(s.distance(&crossing))) {
            meeting.nodes.push(Node {
                point: crossing,
                on: Vec::new(),
            });
        }
    }
}

fn same_turn<N: Float>(a: N, b: N) -> bool {
    let d = (a - b).rem_euclid(N::TAU);
    d.min(N::TAU - d) < N::ONE / N::whole(1 << 20)
}
