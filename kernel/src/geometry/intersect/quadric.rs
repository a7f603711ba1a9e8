//! Intersection of two quadrics, neither of which is a plane: the choice of the one whose rulings
//! carry the curve, and the cases that need no rulings.

use super::rulings::Rulings;
use super::{Branch, IntersectionError, RegionOfInterest, SurfaceIntersection, place};
use crate::geometry::curve::{Curve, Line};
use crate::geometry::frame::Frame;
use crate::geometry::quadric_curve::Ruled;
use crate::geometry::surface::{Cone, Cylinder, Surface};
use crate::geometry::surface_pair::{PairMeasure, SurfacePair};
use crate::geometry::trace::BranchPosition;
use crate::geometry::vector::Length;
use crate::number::float::{Analytic, Float};
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::predicates::{Predicates, Side};
use crate::number::roots::{RootKind, Roots, isolate};
use nalgebra::Vector3;

pub(super) fn quadric_quadric<N: Float>(
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    use Surface as S;
    let turned = pair.turned();
    match (pair.a.surface, pair.b.surface) {
        (S::Cylinder(c), S::Cylinder(d)) => {
            let at = place(&c.frame.origin);
            if predicates.coincide("axes side by side", pair.how(PairMeasure::Drift), at) {
                return Ok(parallel_cylinders(c, d, pair, predicates));
            }
            over_rulings(pair, predicates)
        }
        (S::Cylinder(_), _) => over_rulings(pair, predicates),
        (_, S::Cylinder(_)) => over_rulings(&turned, predicates),
        (S::Cone(c), S::Cone(_)) => cones(c, pair, predicates),
        (S::Cone(_), _) => over_rulings(pair, predicates),
        (_, S::Cone(_)) => over_rulings(&turned, predicates),
        _ => Ok(SurfaceIntersection::nothing()),
    }
}

fn parallel_cylinders<N: Float>(
    c: &Cylinder<N>,
    d: &Cylinder<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let extent = pair.extent;
    let z = c.frame.z;
    let at = |f: &Frame<N>| f.origin + f.z * ((extent.centre - f.origin).dot(&z) / f.z.dot(&z));
    let (p, q) = (at(&c.frame), at(&d.frame));
    let away = q - p;
    let dist = away.length();
    let mut meeting = SurfaceIntersection::nothing();
    if predicates.coincide(
        "axis on axis",
        pair.how(PairMeasure::BetweenAxes),
        place(&p),
    ) {
        return meeting;
    }
    let axis = away / dist;
    let (r, s) = (c.radius, d.radius);
    let x = N::HALF * (dist + (r - s) * (r + s) / dist);
    let line = |origin| {
        Curve::Line(Line {
            origin,
            direction: z,
        })
    };
    let foot = p + axis * x;
    let side = |gap| predicates.classify("cylinder along cylinder", pair.how(gap), place(&foot));
    let outer = side(PairMeasure::AdjacentCylinders);
    match (outer, side(PairMeasure::CylinderInCylinder)) {
        (Side::On, _) => meeting.add(line(p + axis * r), true, extent),
        (_, Side::On) => meeting.add(line(p + axis * r.copysign(r - s)), true, extent),
        (Side::Inside, Side::Inside) => {
            let area = (r + s - dist) * (dist + (r - s)) * (dist - (r - s)) * (dist + r + s);
            let half = z.cross(&axis) * (area.max(N::ZERO).sqrt() / (N::TWO * dist));
            meeting.add(line(foot - half), false, extent);
            meeting.add(line(foot + half), false, extent);
        }
        _ => {}
    }
    meeting
}

fn cones<N: Float>(
    c: &Cone<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    let at = place(&c.frame.origin);
    if predicates.classify_at_point("apex on apex", pair.how(PairMeasure::Between), at) == Side::On
    {
        return Ok(common_apex(c, pair.b.surface, pair.extent, predicates));
    }
    let turned = pair.turned();
    if holds_apex(&turned, predicates) && !holds_apex(pair, predicates) {
        return over_rulings(&turned, predicates);
    }
    over_rulings(pair, predicates)
}

/// Two cones with a common apex intersect in common rulings.
fn common_apex<N: Float>(
    c: &Cone<N>,
    other: &Surface<N>,
    extent: &RegionOfInterest<N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let mut meeting = SurfaceIntersection::touch(c.frame.origin);
    let m = c.sin / c.cos;
    // The distance from the other cone along each ruling, at the extent's radius from the apex.
    let along = |u: Jet<Interval<N>>| {
        let (s, k) = u.sin_cos();
        let r = extent.radius;
        let p = c
            .frame
            .world_of([k.scale(m * r), s.scale(m * r), Jet::constant(r)]);
        other.level(p)
    };
    let breaks: Vec<N> = (0..=8)
        .map(|i| N::from_f64(0.1) + N::TAU * N::whole(i) / N::from_f64(8.0))
        .collect();
    let Roots::At { roots, .. } = isolate(
        &|t| along(Jet::variable(t)),
        &breaks,
        predicates.resolution(),
    ) else {
        return meeting;
    };
    let mut angles: Vec<(N, bool)> = roots
        .iter()
        .map(|r| (r.t, r.contact != RootKind::Simple))
        .collect();
    if let (Some(&(a, _)), Some(&(b, _))) = (angles.first(), angles.last())
        && angles.len() > 1
        && (a + N::TAU - b).abs() < N::ROUNDING * N::TAU
    {
        angles.pop();
    }
    for (u, tangent) in angles {
        let local = Vector3::new(c.sin * u.cos(), c.sin * u.sin(), c.cos);
        let curve = Curve::Line(Line {
            origin: c.frame.origin,
            direction: c.frame.vector(&local),
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

/// The curve over the rulings of the first surface. If the curve has a cusp over these, at the apex
/// of the second surface, the rulings of the second are used: each has one point of the curve
/// besides the apex.
fn over_rulings<N: Float>(
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    match over_first(pair, predicates) {
        Err(IntersectionError::Cusp { .. }) if holds_apex(pair, predicates) => {
            over_first(&pair.turned(), predicates)
        }
        known => known,
    }
}

/// Whether the second surface is a cone whose apex lies on the first.
fn holds_apex<N: Float>(pair: &SurfacePair<'_, N>, predicates: &Predicates) -> bool {
    let Surface::Cone(cone) = pair.b.surface else {
        return false;
    };
    let (away, at) = (
        pair.how(PairMeasure::PointOnQuadric),
        place(&cone.frame.origin),
    );
    predicates.classify_at_point("apex on quadric", away, at) == Side::On
}

/// The sine of α + θ for a cone of half-angle α whose axis makes the angle θ with a direction. With
/// the sine of α − θ it makes the cone's form sin² α − sin² θ at the direction.
fn sine_of_sum<N: Float>(cone: &Cone<N>, direction: &Vector3<N>) -> N {
    let (cos, sin) = (
        cone.frame.z.dot(direction).abs(),
        cone.frame.z.cross(direction).length(),
    );
    cone.sin * cos + cone.cos * sin
}

fn over_first<N: Float>(
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    let base = match pair.a.surface {
        Surface::Cylinder(c) => Ruled::Cylinder(*c),
        Surface::Cone(c) => Ruled::Cone(*c),
        Surface::Plane(_) | Surface::Sphere(_) | Surface::Torus(_) => {
            return Ok(SurfaceIntersection::nothing());
        }
    };
    let rulings = Rulings::new(base, pair);
    let is_single = match base {
        // The rulings are a direction of the other surface: a cone with a ruling parallel to them.
        // Two cylinders that reach this place have axes that are not parallel, however small the
        // angle.
        Ruled::Cylinder(c) => match pair.b.surface {
            Surface::Cone(cone) => {
                let sine = rulings.lead / sine_of_sum(cone, &c.frame.z);
                predicates.within(sine * pair.extent.radius)
            }
            Surface::Cylinder(_) => false,
            _ => predicates.within(rulings.lead * pair.extent.radius),
        },
        Ruled::Cone(_) => holds_apex(&pair.turned(), predicates),
    };
    if is_single {
        rulings.single(predicates)
    } else {
        rulings.double(predicates)
    }
}
