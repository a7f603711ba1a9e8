//! Intersection of a quadric with the rulings of a cylinder or a cone.
//!
//! Notation as in [`quadric_curve`](crate::geometry::quadric_curve): along the rulings of the base,
//! the difference of the other quadric and the base is k w² + 2 B(u) w + C(u), and Δ = B² − k C. If
//! k = 0 a ruling has a single intersection; otherwise it has two, none or a double one.

mod difference;
mod double;
mod single;

use self::difference::Difference;
use super::elliptic::{plane_elliptic_cone, plane_elliptic_cylinder};
use super::plane::{plane_cone, plane_cylinder};
use super::{Branch, Node, RegionOfInterest, SurfaceIntersection, parts_on, place};
use crate::geometry::curve::Curve;
use crate::geometry::frame::Frame;
use crate::geometry::quadric_curve::Ruled;
use crate::geometry::surface::{Plane, Surface};
use crate::geometry::surface_pair::{Carrier, SurfacePair};
use crate::geometry::trigonometric::{Trig1, Trig2, product, trig1};
use crate::geometry::vector::Length;
use crate::number::float::{Float, harmonic};
use crate::number::predicates::{Predicates, Side};
use nalgebra::{Point3, Vector3};

/// The rulings at which candidate conics are tested.
fn sampled_rulings<N: Float>() -> impl Iterator<Item = N> {
    (0..24).map(|i| N::TAU * (N::whole(i) + N::from_f64(0.3)) / N::from_f64(24.0))
}

/// The distance of a point from the whole quadric of a surface; a cone has both nappes.
pub(super) fn apart<N: Float>(surface: &Surface<N>, p: &Point3<N>) -> N {
    match surface {
        Surface::Cone(c) => {
            let q = c.frame.coordinates(p);
            (q.x.hypot(q.y) * c.cos - q.z.abs() * c.sin).abs()
        }
        Surface::EllipticCone(c) => {
            let q = c.frame.coordinates(p);
            let upright = c.frame.point(q.x, q.y, q.z.abs());
            surface.distance(&upright).abs()
        }
        _ => surface.distance(p).abs(),
    }
}

/// The other quadric along the rulings of the base.
pub(super) struct Rulings<'a, N: Float = f64> {
    base: Ruled<N>,
    other: &'a Surface<N>,
    pub lead: N,
    linear: Trig1<N>,
    constant: Trig2<N>,
    radicand: Trig2<N>,
    /// The size of the terms that cancel in the radicand.
    scale: N,
    extent: &'a RegionOfInterest<N>,
}

impl<'a, N: Float> Rulings<'a, N> {
    /// The quadric over the rulings of the pair's first surface.
    pub(super) fn new(base: Ruled<N>, pair: &SurfacePair<'a, N>) -> Self {
        let q = Difference::new(pair);
        let (a, b) = (&q.a, &q.b);
        // The ruling's point is (m cos, n sin, 0) + ..., with m and n the radii or the slopes.
        let [m, n] = base.radii();
        let [along, across] = [m * m * a[(0, 0)], n * n * a[(1, 1)]];
        let angular = |mean: N, x: N, y: N| {
            [
                mean + N::HALF * (along + across),
                N::TWO * m * x,
                N::TWO * n * y,
                N::HALF * (along - across),
                m * n * a[(0, 1)],
            ]
        };
        let (lead, linear, constant) = if base.is_cone() {
            let constant = angular(a[(2, 2)], a[(0, 2)], a[(1, 2)]);
            (q.c, [b.z, m * b.x, n * b.y], constant)
        } else {
            let linear = [b.z, m * a[(0, 2)], n * a[(1, 2)]];
            (a[(2, 2)], linear, angular(q.c, b.x, b.y))
        };
        let square = product(&linear, &linear);
        let radicand = std::array::from_fn(|i| square[i] - lead * constant[i]);
        let sum = |k: &[N]| k.iter().map(|c| c.abs()).sum::<N>();
        let scale = sum(&square) + lead.abs() * sum(&constant);
        Self {
            base,
            other: pair.b.surface,
            lead,
            linear,
            constant,
            radicand,
            scale,
            extent: pair.extent,
        }
    }

    /// The point on the ruling u at height w, in the base's frame.
    fn local(&self, u: N, w: N) -> Vector3<N> {
        let [m, n] = self.base.radii();
        let (sin, cos) = u.sin_cos();
        match self.base.is_cone() {
            true => Vector3::new(m / w * cos, n / w * sin, N::ONE / w),
            false => Vector3::new(m * cos, n * sin, w),
        }
    }

    fn world(&self, u: N, w: N) -> Point3<N> {
        let p = self.local(u, w);
        self.base.frame().point(p.x, p.y, p.z)
    }

    /// The height of the ruling's point that is closest to the other surface.
    fn middle(&self, u: N) -> N {
        -trig1(&self.linear, u.sin_cos()) / self.lead
    }

    fn delta(&self, u: N) -> N {
        harmonic(&self.radicand, u.sin_cos())
    }

    /// Whether a height lies on the base and in the extent.
    fn is_on_base(&self, w: N) -> bool {
        !self.base.is_cone() || (w > N::ZERO && N::ONE / w <= self.reach())
    }

    /// Whether a height lies on the base and in an extent twice as large.
    fn is_about_base(&self, w: N) -> bool {
        !self.base.is_cone() || (w > N::ZERO && N::ONE / w <= N::TWO * self.reach())
    }

    /// The greatest absolute height in the extent.
    fn reach(&self) -> N {
        let f = self.base.frame();
        (f.origin - self.extent.centre).dot(&f.z).abs() + self.extent.radius
    }

    /// Whether Δ is positive, zero or negative at an angle. The decision is made on the signed
    /// distance of the ruling from the other surface.
    fn state(&self, u: N, predicates: &Predicates) -> Side {
        let w = self.middle(u);
        if !self.is_on_base(w) {
            // The point lies on the other nappe or far away; the sign of Δ suffices.
            return if self.delta(u) >= N::ZERO {
                Side::Inside
            } else {
                Side::Outside
            };
        }
        let distance = apart(self.other, &self.world(u, w));
        let signed = if self.delta(u) >= N::ZERO {
            -distance
        } else {
            distance
        };
        predicates.classify_at_point("ruling on quadric", signed, place(&self.world(u, w)))
    }

    /// Adds the planar conic w = plane(u), clipped to the base and to the other surface.
    fn add_conic(
        &self,
        w: &Trig1<N>,
        tangent: bool,
        predicates: &Predicates,
        meeting: &mut SurfaceIntersection<N>,
    ) {
        let surface = self.base.surface();
        let frame = surface.frame();
        let [m, n] = self.base.radii();
        let (normal, offset) = match self.base.is_cone() {
            true => (Vector3::new(w[1] / m, w[2] / n, w[0]), N::ONE),
            false => (Vector3::new(-w[1] / m, -w[2] / n, N::ONE), w[0]),
        };
        let size = normal.length();
        if size * self.reach() * self.reach() < offset.abs() * predicates.resolution() {
            return;
        }
        let n = frame.vector(&(normal / size));
        let origin = frame.origin + n * (offset / size);
        let plane = Plane {
            frame: Frame::about(origin, n),
        };
        let section = Surface::Plane(plane);
        let carriers = [&section, &surface].map(Carrier::constructed);
        let pair = SurfacePair::new(carriers[0], carriers[1], self.extent);
        let part = match &self.base {
            Ruled::Cylinder(s) => plane_cylinder(&plane, s, &pair, predicates),
            Ruled::Cone(s) => plane_cone(&plane, s, &pair, predicates),
            Ruled::EllipticCylinder(s) => plane_elliptic_cylinder(&plane, s, &pair, predicates),
            Ruled::EllipticCone(s) => plane_elliptic_cone(&plane, s, &pair, predicates),
        };
        for branch in part.branches {
            for range in self.on_other_nappe(&branch.curve, branch.range, predicates) {
                let closed = branch.closed && range == branch.range;
                meeting.branches.push(Branch {
                    range,
                    closed,
                    tangent,
                    ..branch.clone()
                });
            }
        }
    }

    /// The parts of a curve that lie on the other surface; for a cone, on its one nappe.
    fn on_other_nappe(
        &self,
        curve: &Curve<N>,
        range: [N; 2],
        predicates: &Predicates,
    ) -> Vec<[N; 2]> {
        parts_on(curve, range, self.other, predicates.resolution())
    }

    /// Whether the heights that `conics` gives over each ruling lie on the other surface.
    fn meets_in_conics(&self, predicates: &Predicates, conics: impl Fn(N) -> Vec<N>) -> bool {
        let mut worst: N = N::ZERO;
        let mut tested = false;
        for u in sampled_rulings() {
            for w in conics(u).into_iter().filter(|&w| self.is_on_base(w)) {
                tested = true;
                worst = worst.max(apart(self.other, &self.world(u, w)));
            }
        }
        let o = self.base.frame().origin;
        tested && predicates.coincide("quadrics meeting in conics", worst, place(&o))
    }

    /// Adds the apexes through which branches pass; they are singular points.
    fn add_apexes(&self, predicates: &Predicates, meeting: &mut SurfaceIntersection<N>) {
        let surface = self.base.surface();
        for (s, o) in [(&surface, self.other), (self.other, &surface)] {
            let common = s.apexes().filter(|p| predicates.within(o.distance(p)));
            meeting.nodes.extend(common.map(|point| Node {
                point,
                on: Vec::new(),
            }));
        }
    }
}
