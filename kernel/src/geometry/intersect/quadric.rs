//! Intersection of two quadrics, neither of which is a plane: the choice of the one whose rulings
//! carry the curve, and the cases that need no rulings.

use super::rulings::Rulings;
use super::{IntersectionError, SurfaceIntersection, elliptic, place};
use crate::geometry::curve::{Curve, Line};
use crate::geometry::elliptic_surface::EllipticCone;
use crate::geometry::frame::Frame;
use crate::geometry::quadric_curve::Ruled;
use crate::geometry::surface::{Cone, Cylinder, Surface};
use crate::geometry::surface_pair::{PairMeasure, SurfacePair};
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::{Predicates, Side};
use nalgebra::Vector3;

pub(super) fn quadric_quadric<N: Float>(
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    use Surface as S;
    let turned = pair.turned();
    match (Ruled::new(pair.a.surface), Ruled::new(pair.b.surface)) {
        (Some(base), Some(other)) if !base.is_cone() && !other.is_cone() => {
            let at = place(&base.frame().origin);
            if !predicates.coincide("axes side by side", pair.how(PairMeasure::Drift), at) {
                return over_rulings(pair, predicates);
            }
            Ok(match (pair.a.surface, pair.b.surface) {
                (S::Cylinder(c), S::Cylinder(d)) => parallel_cylinders(c, d, pair, predicates),
                (_, other) => elliptic::parallel_cylinders(&base, other, pair.extent, predicates),
            })
        }
        (Some(base), Some(other)) if base.is_cone() && other.is_cone() => {
            cones(&base, pair, predicates)
        }
        (Some(base), _) if !base.is_cone() => over_rulings(pair, predicates),
        (_, Some(other)) if !other.is_cone() => over_rulings(&turned, predicates),
        (Some(_), _) => over_rulings(pair, predicates),
        (_, Some(_)) => over_rulings(&turned, predicates),
        (None, None) => Ok(SurfaceIntersection::nothing()),
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
    base: &Ruled<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    let at = place(&base.frame().origin);
    if predicates.classify_at_point("apex on apex", pair.how(PairMeasure::Between), at) == Side::On
    {
        return Ok(elliptic::common_apex(
            base,
            pair.b.surface,
            pair.extent,
            predicates,
        ));
    }
    let turned = pair.turned();
    if holds_apex(&turned, predicates) && !holds_apex(pair, predicates) {
        return over_rulings(&turned, predicates);
    }
    over_rulings(pair, predicates)
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
    let apex = match pair.b.surface {
        Surface::Cone(_) | Surface::EllipticCone(_) => pair.b.surface.frame().origin,
        _ => return false,
    };
    let (away, at) = (pair.how(PairMeasure::PointOnQuadric), place(&apex));
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

/// The sine of the angle between a direction and the closest ruling of an elliptic cone, to first
/// order.
fn sine_from_cone<N: Float>(cone: &EllipticCone<N>, direction: &Vector3<N>) -> N {
    let d = cone.frame.components(direction);
    let gradient = cone.gradient(&d);
    gradient.dot(&d) / (N::TWO * gradient.length())
}

pub(super) fn over_first<N: Float>(
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    let Some(base) = Ruled::new(pair.a.surface) else {
        return Ok(SurfaceIntersection::nothing());
    };
    let rulings = Rulings::new(base, pair);
    let is_single = if base.is_cone() {
        holds_apex(&pair.turned(), predicates)
    } else {
        // The rulings are a direction of the other surface: a cone with a ruling parallel to them.
        // Two cylinders that reach this place have axes that are not parallel, however small the
        // angle.
        let direction = base.frame().z;
        let sine = match pair.b.surface {
            Surface::Cone(cone) => Some(rulings.lead / sine_of_sum(cone, &direction)),
            Surface::EllipticCone(cone) => Some(sine_from_cone(cone, &direction)),
            Surface::Sphere(_) => Some(rulings.lead),
            _ => None,
        };
        sine.is_some_and(|sine| predicates.within(sine * pair.extent.radius))
    };
    if is_single {
        rulings.single(predicates)
    } else {
        rulings.double(predicates)
    }
}
