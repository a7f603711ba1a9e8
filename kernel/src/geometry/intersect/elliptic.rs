//! Intersections of elliptic cylinders and cones in closed form: with planes, and with surfaces that
//! have common rulings.
//!
//! Notation: in the plane of a section, e and f are the axes of the conic, with the eigenvalues
//! λ <= μ of the restricted form, so that the conic is λ x² + μ y² + 2 g x + 2 h y + k = 0 about a
//! base point. At a vertex, where the gradient is along e, its half is ±w, and the conic about the
//! vertex is y² = 2 p x - κ x² with p = w/μ, κ = λ/μ.

use super::{Branch, RegionOfInterest, SurfaceIntersection, place};
use crate::geometry::curve::{Circle, Conic, Curve, Ellipse, Hyperbola, Line};
use crate::geometry::elliptic_surface::{EllipticCone, EllipticCylinder};
use crate::geometry::frame::Frame;
use crate::geometry::quadric_curve::Ruled;
use crate::geometry::surface::{Plane, Surface};
use crate::geometry::surface_pair::{PairMeasure, SurfacePair};
use crate::geometry::trace::BranchPosition;
use crate::geometry::vector::Length;
use crate::number::float::{Analytic, Float};
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::predicates::{Predicates, Side};
use crate::number::roots::{RootKind, Roots, isolate};
use nalgebra::{Point3, Vector3};

/// The ratio of a conic's size to the extent above which it is represented about a point.
const FAR: f64 = 256.0;

/// The ratio of the vertex's distance to the extent up to which a long ellipse is represented about
/// its vertex.
const NEAR: f64 = 16.0;

/// The angles u at which x cos u + y sin u = level, where they exist.
fn angles<N: Float>([x, y]: [N; 2], level: N) -> [N; 2] {
    let size = x.hypot(y);
    let middle = y.atan2(x);
    let half = ((size - level) * (size + level)).max(N::ZERO).sqrt();
    let half = half.atan2(level);
    [middle - half, middle + half]
}

/// An ellipse, or the circle that it is within the resolution.
pub(super) fn circle_or_ellipse<N: Float>(
    frame: Frame<N>,
    [a, b]: [N; 2],
    predicates: &Predicates,
) -> Curve<N> {
    match predicates.within(a - b) {
        true => Curve::Circle(Circle {
            frame,
            radius: N::HALF * (a + b),
        }),
        false => Curve::Ellipse(Ellipse { frame, a, b }),
    }
}

pub(super) fn plane_elliptic_cylinder<N: Float>(
    p: &Plane<N>,
    c: &EllipticCylinder<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let f = &c.frame;
    let at = place(&f.origin);
    let mut meeting = SurfaceIntersection::nothing();
    let up = (pair.extent.centre - f.origin).dot(&f.z);
    let n = f.components(&p.frame.z);
    let [a, b] = c.radii;
    if predicates.coincide("plane along axis", pair.how(PairMeasure::Lean), at) {
        let middle = f.origin + f.z * up;
        let level = (p.frame.origin - middle).dot(&p.frame.z);
        let rates = [a * n.x, b * n.y];
        let mut add = |u: N, tangent: bool| {
            let (sin, cos) = u.sin_cos();
            let origin = f.point(a * cos, b * sin, up);
            let direction = f.z;
            meeting.add(
                Curve::Line(Line { origin, direction }),
                tangent,
                pair.extent,
            );
        };
        let side = pair.how(PairMeasure::PlaneOnCylinder);
        match predicates.classify("plane on cylinder", side, place(&middle)) {
            Side::Outside => {}
            Side::On => {
                let outward = N::ONE.copysign(level);
                add((rates[1] * outward).atan2(rates[0] * outward), true);
            }
            Side::Inside => angles(rates, level).into_iter().for_each(|u| add(u, false)),
        }
        return meeting;
    }
    let local = |p: &Point3<N>| f.coordinates(p);
    let centre = pair.extent.centre;
    let base = local(&(centre - p.frame.z * (centre - p.frame.origin).dot(&p.frame.z)));
    let form = Vector3::new(N::ONE / (a * a), N::ONE / (b * b), N::ZERO);
    let section = Section::new(f, n, base, form, -N::ONE, (n.z / (a * b)).powi(2));
    // Half the gradient at the vertex is √λ.
    let slope = section.least.sqrt();
    section.add(slope, None, pair.extent, predicates, &mut meeting);
    meeting
}

pub(super) fn plane_elliptic_cone<N: Float>(
    p: &Plane<N>,
    c: &EllipticCone<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let apex = c.frame.origin;
    let height = pair.how(PairMeasure::Height);
    match predicates.classify_at_point("apex on plane", height, place(&apex)) {
        Side::On => plane_through_apex(p, c, pair, predicates),
        _ => plane_off_apex(p, c, pair, predicates),
    }
}

fn plane_through_apex<N: Float>(
    p: &Plane<N>,
    c: &EllipticCone<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let apex = c.frame.origin;
    let n = c.frame.components(&p.frame.z);
    let [a, b] = c.slopes;
    let rates = [a * n.x, b * n.y];
    let side = pair.how(PairMeasure::PlaneOnRuling);
    let rulings: Vec<(N, bool)> =
        match predicates.classify("plane along a cone's ruling", side, place(&apex)) {
            Side::Outside => return SurfaceIntersection::touch(apex),
            Side::On => {
                let sign = -N::ONE.copysign(n.z);
                vec![((rates[1] * sign).atan2(rates[0] * sign), true)]
            }
            Side::Inside => angles(rates, -n.z).map(|u| (u, false)).into(),
        };
    rulings_from_apex(&Ruled::EllipticCone(*c), rulings, pair.extent)
}

/// The rulings of a cone at the given angles, with whether the surfaces are tangent along them.
fn rulings_from_apex<N: Float>(
    cone: &Ruled<N>,
    rulings: Vec<(N, bool)>,
    extent: &RegionOfInterest<N>,
) -> SurfaceIntersection<N> {
    let frame = cone.frame();
    let [m, n] = cone.radii();
    let mut meeting = SurfaceIntersection::touch(frame.origin);
    for (u, tangent) in rulings {
        let (sin, cos) = u.sin_cos();
        let local = Vector3::new(m * cos, n * sin, N::ONE).unit();
        let curve = Curve::Line(Line {
            origin: frame.origin,
            direction: frame.vector(&local),
        });
        if let Some([_, end]) = curve.range_within(&extent.centre, extent.radius)
            && end > N::ZERO
        {
            meeting.nodes[0].on.push(BranchPosition {
                branch: meeting.branches.len(),
                t: N::ZERO,
            });
            meeting.branches.push(Branch {
                curve,
                range: [N::ZERO, end],
                closed: false,
                tangent,
            });
        }
    }
    meeting
}

fn plane_off_apex<N: Float>(
    p: &Plane<N>,
    c: &EllipticCone<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let f = &c.frame;
    let n = f.components(&p.frame.z);
    let level = (p.frame.origin - f.origin).dot(&p.frame.z);
    let [a, b] = c.slopes;
    let form = Vector3::new(N::ONE / (a * a), N::ONE / (b * b), -N::ONE);
    let reach = (a * n.x).hypot(b * n.y);
    // A section parallel to a tangent plane is a parabola.
    let tilt = pair.how(PairMeasure::PlaneOnRuling);
    let product = match predicates.coincide("ruling along plane", tilt, place(&f.origin)) {
        true => N::ZERO,
        false => (n.z.abs() - reach) * (n.z.abs() + reach) / (a * b).powi(2),
    };
    let section = Section::new(f, n, n * level, form, N::ZERO, product);
    // Half the gradient at the vertex is |level|/(a b √μ).
    let slope = level.abs() / (a * b * section.most.sqrt());
    let mut meeting = SurfaceIntersection::nothing();
    section.add(slope, Some(f.z), pair.extent, predicates, &mut meeting);
    meeting
}

/// The section of a quadric with a plane, about a base point of the plane.
struct Section<'a, N: Float> {
    frame: &'a Frame<N>,
    /// The plane's normal, the base point, and e and f, in the frame.
    normal: Vector3<N>,
    base: Vector3<N>,
    along: Vector3<N>,
    across: Vector3<N>,
    /// The quadric's form, by the squares of the coordinates.
    form: Vector3<N>,
    /// λ and μ.
    least: N,
    most: N,
    /// g, h and k.
    slopes: [N; 2],
    level: N,
}

impl<'a, N: Float> Section<'a, N> {
    /// The section of the quadric with the form and the constant; `product` is λ μ, which the
    /// normal gives without cancellation.
    fn new(
        frame: &'a Frame<N>,
        normal: Vector3<N>,
        base: Vector3<N>,
        form: Vector3<N>,
        constant: N,
        product: N,
    ) -> Self {
        let plane = Frame::about(Point3::from(base), normal);
        let of = |u: &Vector3<N>, v: &Vector3<N>| form.component_mul(u).dot(v);
        let (p, q, r) = (
            of(&plane.x, &plane.x),
            of(&plane.x, &plane.y),
            of(&plane.y, &plane.y),
        );
        let (sum, spread) = (N::HALF * (p + r), (N::HALF * (p - r)).hypot(q));
        let most = sum + spread;
        // The direction of the greatest eigenvalue.
        let (sin, cos) = (N::HALF * (N::TWO * q).atan2(p - r)).sin_cos();
        let across = plane.x * cos + plane.y * sin;
        let along = across.cross(&normal);
        Self {
            frame,
            normal,
            base,
            along,
            across,
            form,
            least: product / most,
            most,
            slopes: [of(&base, &along), of(&base, &across)],
            level: of(&base, &base) + constant,
        }
    }

    fn point(&self, x: N, y: N) -> Point3<N> {
        let local = self.base + self.along * x + self.across * y;
        self.frame.point(local.x, local.y, local.z)
    }

    /// Adds the conic; w is half the gradient at a vertex. Of a cone's section it is the branch on
    /// the side of the axis.
    fn add(
        &self,
        w: N,
        axis: Option<Vector3<N>>,
        extent: &RegionOfInterest<N>,
        predicates: &Predicates,
        meeting: &mut SurfaceIntersection<N>,
    ) {
        let [g, h] = self.slopes;
        let y = -h / self.most;
        let rest = self.level + h * y;
        // The closer vertex, where the two terms of the denominator do not cancel, and the other one.
        let near = (rest / (w.copysign(-g) - g), N::ONE.copysign(-g));
        let far = ((w.copysign(-g) - g) / self.least, -near.1);
        let is_on_nappe = |x: N| {
            let away = self.point(x, y) - self.frame.origin;
            axis.is_none_or(|z| away.dot(&z) > N::ZERO)
        };
        let vertex = [near, far]
            .into_iter()
            .find(|(x, _)| x.is_finite() && is_on_nappe(*x));
        let Some((x, inward)) = vertex else {
            return;
        };
        let tip = self.point(x, y);
        let away = (tip - extent.centre).length();
        let (p, kappa) = (w / self.most, self.least / self.most);
        let half = p / kappa.abs();
        let inner = self.frame.vector(&(self.along * inward));
        let normal = self.frame.vector(&self.normal);
        let is_far = half > N::from_f64(FAR) * (away + extent.radius) || kappa == N::ZERO;
        let is_long = half > N::from_f64(FAR) * extent.radius;
        if is_long && axis.is_none() && away > N::from_f64(NEAR) * extent.radius {
            return self.add_sides(extent, meeting);
        }
        let curve = if is_far || (is_long && axis.is_none()) {
            let frame = Frame::toward(tip, normal, inner);
            Curve::Conic(Conic::about_vertex(frame, p, kappa))
        } else if kappa > N::ZERO {
            let frame = Frame::toward(tip + inner * half, normal, inner);
            circle_or_ellipse(frame, [half, p / kappa.sqrt()], predicates)
        } else {
            let frame = Frame::toward(tip - inner * half, normal, inner);
            let (a, b) = (half, p / (-kappa).sqrt());
            Curve::Hyperbola(Hyperbola { frame, a, b })
        };
        meeting.add(curve, false, extent);
    }

    /// Adds the two sides of a long ellipse next to the base point.
    fn add_sides(&self, extent: &RegionOfInterest<N>, meeting: &mut SurfaceIntersection<N>) {
        let [g, h] = self.slopes;
        let square = h * h - self.most * self.level;
        if square <= N::ZERO {
            return;
        }
        let root = h + square.sqrt().copysign(h);
        let form = |u: &Vector3<N>, v: &Vector3<N>| self.form.component_mul(u).dot(v);
        for y in [-self.level / root, -root / self.most] {
            let point = self.point(N::ZERO, y);
            let gradient = self.along * g + self.across * (h + self.most * y);
            let slope = gradient.length();
            let inner = -gradient / slope;
            let across = self.normal.cross(&inner);
            let conic = Conic {
                frame: Frame::toward(
                    point,
                    self.frame.vector(&self.normal),
                    self.frame.vector(&inner),
                ),
                curvature: form(&across, &across) / slope,
                shear: form(&inner, &across) / slope,
                flatness: form(&inner, &inner) / slope,
            };
            meeting.add(Curve::Conic(conic), false, extent);
        }
    }
}

/// Two cylinders with parallel axes, of which one at least is elliptic: common rulings.
pub(super) fn parallel_cylinders<N: Float>(
    base: &Ruled<N>,
    other: &Surface<N>,
    extent: &RegionOfInterest<N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let frame = base.frame();
    let [m, n] = base.radii();
    let up = (extent.centre - frame.origin).dot(&frame.z);
    let point = |u: Jet<Interval<N>>| {
        let (sin, cos) = u.sin_cos();
        frame.world_of([cos.scale(m), sin.scale(n), Jet::constant(up)])
    };
    let mut meeting = SurfaceIntersection::nothing();
    for (u, tangent) in common_rulings(other, point, predicates) {
        let (sin, cos) = u.sin_cos();
        let line = Line {
            origin: frame.point(m * cos, n * sin, up),
            direction: frame.z,
        };
        meeting.add(Curve::Line(line), tangent, extent);
    }
    meeting
}

/// Two cones with a common apex intersect in common rulings.
pub(super) fn common_apex<N: Float>(
    base: &Ruled<N>,
    other: &Surface<N>,
    extent: &RegionOfInterest<N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let frame = base.frame();
    let r = extent.radius;
    let [m, n] = base.radii().map(|slope| slope * r);
    // The distance from the other cone along each ruling, at the extent's radius from the apex.
    let point = |u: Jet<Interval<N>>| {
        let (sin, cos) = u.sin_cos();
        frame.world_of([cos.scale(m), sin.scale(n), Jet::constant(r)])
    };
    let rulings = common_rulings(other, point, predicates);
    rulings_from_apex(base, rulings, extent)
}

/// The angles at which a closed curve of a base, a function of the angle, is on another surface, with
/// whether it is tangent to it.
fn common_rulings<N: Float>(
    other: &Surface<N>,
    point: impl Fn(Jet<Interval<N>>) -> [Jet<Interval<N>>; 3],
    predicates: &Predicates,
) -> Vec<(N, bool)> {
    let along = |t: Interval<N>| other.level(point(Jet::variable(t)));
    let breaks: Vec<N> = (0..=8)
        .map(|i| N::from_f64(0.1) + N::TAU * N::whole(i) / N::from_f64(8.0))
        .collect();
    let Roots::At { roots, .. } = isolate(&along, &breaks, predicates.resolution()) else {
        return Vec::new();
    };
    let angles = roots.iter().map(|r| (r.t, r.contact != RootKind::Simple));
    let mut angles: Vec<(N, bool)> = angles.collect();
    if let (Some(&(a, _)), Some(&(b, _))) = (angles.first(), angles.last())
        && angles.len() > 1
        && (a + N::TAU - b).abs() < N::ROUNDING * N::TAU
    {
        angles.pop();
    }
    angles
}
