//! The circles along which a torus and another surface are tangent.
//!
//! A meridian is one where a sphere lies in the tube, where a straight pipe or another bend
//! continues the tube, or where a ring lies in or around it. The other case is a parallel: a rim of the
//! ring, or where an ellipsoid of revolution touches it.
//!
//! Along each such circle the other surface, as a function of the torus's angles, has a double
//! zero. It is divided out before the remaining factor is traced.

use super::place;
use crate::geometry::bivariate_trig_poly::BivariateTrigPoly;
use crate::geometry::curve::Circle;
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Surface, Torus};
use crate::geometry::surface_pair::{PairMeasure, SurfacePair};
use crate::geometry::trigonometric::divide;
use crate::geometry::vector::{Length, direction};
use crate::number::float::{Analytic, Float};
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::predicates::Predicates;
use crate::number::roots::{RootKind, Roots, isolate};
use nalgebra::{Point3, Vector3};

/// A circle of a torus along which another surface is tangent to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Contact<N: Float> {
    /// A circle of the tube, at this θ.
    Meridian(N),
    /// A parallel, at this φ: the outer or the inner equator, unless the other surface is an ellipsoid.
    Rim(N),
}

impl<N: Float> Contact<N> {
    /// The circle.
    pub fn circle(&self, t: &Torus<N>) -> Circle<N> {
        match *self {
            Self::Meridian(theta) => meridian(t, theta),
            Self::Rim(phi) => {
                let (sin, cos) = phi.sin_cos();
                let is_equator = phi == N::ZERO || phi == N::PI;
                let up = if is_equator { N::ZERO } else { t.minor * sin };
                parallel(t, up, t.major + t.minor * cos)
            }
        }
    }

    /// The form with its double zero along the circle divided out.
    pub fn divided_out(&self, form: &BivariateTrigPoly<N>) -> BivariateTrigPoly<N> {
        let (Self::Meridian(angle) | Self::Rim(angle)) = *self;
        let (sin, cos) = angle.sin_cos();
        let factor = [N::ONE, -cos, -sin];
        let mut rest = BivariateTrigPoly::zero();
        for j in 0..5 {
            let entry = |i: usize| match self {
                Self::Meridian(_) => [i, j],
                Self::Rim(_) => [j, i],
            };
            let column = [0, 1, 2, 3, 4].map(entry).map(|[m, n]| form.0[m][n]);
            for (i, c) in divide(&column, &factor).into_iter().enumerate() {
                let [m, n] = entry(i);
                rest.0[m][n] = c;
            }
        }
        rest
    }

    /// The angles (θ, φ) of the circle's points at which a form vanishes.
    pub fn zeros(&self, form: &BivariateTrigPoly<N>) -> Vec<[N; 2]> {
        let along = |x: Interval<N>| match *self {
            Self::Meridian(theta) => {
                let p = form.partials(Interval::point(theta), x);
                Jet {
                    v: p.f,
                    d: p.y,
                    dd: p.yy,
                }
            }
            Self::Rim(phi) => {
                let p = form.partials(x, Interval::point(phi));
                Jet {
                    v: p.f,
                    d: p.x,
                    dd: p.xx,
                }
            }
        };
        let precision = form.bound() * N::ROUNDING;
        let Roots::At { roots, .. } = isolate(&along, &breaks_of_turn(), precision) else {
            return Vec::new();
        };
        let once = roots.iter().filter(|r| is_once(r.t));
        let angles = |t: N| match *self {
            Self::Meridian(theta) => [theta, t],
            Self::Rim(phi) => [t, phi],
        };
        once.map(|r| angles(r.t)).collect()
    }

    /// The angles of the intersection of a meridian and a rim.
    pub fn crossing(&self, other: &Self) -> Option<[N; 2]> {
        match (*self, *other) {
            (Self::Meridian(theta), Self::Rim(phi)) => Some([theta, phi]),
            _ => None,
        }
    }
}

/// The circle about the axis with the given radius, at the height `up`.
pub(super) fn parallel<N: Float>(t: &Torus<N>, up: N, radius: N) -> Circle<N> {
    let frame = t.frame.at(t.frame.origin + t.frame.z * up);
    Circle { frame, radius }
}

/// The circle of the tube at the angle θ.
pub(super) fn meridian<N: Float>(t: &Torus<N>, theta: N) -> Circle<N> {
    let out = t.frame.x * theta.cos() + t.frame.y * theta.sin();
    let centre = t.frame.origin + out * t.major;
    let frame = Frame {
        origin: centre,
        x: out,
        y: t.frame.z,
        z: out.cross(&t.frame.z),
    };
    Circle {
        frame,
        radius: t.minor,
    }
}

/// All circles of a torus, the first of the pair, along which the other surface is tangent to it.
pub(super) fn contacts<N: Float>(
    t: &Torus<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Vec<Contact<N>> {
    let mut all = Vec::new();
    if let Surface::Ellipsoid(_) = pair.b.surface {
        return tangent_parallels(t, pair.b.surface, predicates);
    }
    all.extend(equal_tubes(t, pair, predicates).map(Contact::Meridian));
    if let Surface::Torus(o) = pair.b.surface {
        if ring_on_tube(pair, predicates).is_some() {
            let q = t.frame.coordinates(&o.frame.origin);
            all.push(Contact::Meridian(q.y.atan2(q.x)));
        }
        if let Some(outer) = ring_on_tube(&pair.turned(), predicates) {
            all.push(Contact::Rim(if outer { N::ZERO } else { N::PI }));
        }
    }
    all
}

/// The parallels of a torus along which an ellipsoid is tangent to it: those of the double zeros along
/// one circle of the tube at which it is tangent all around.
fn tangent_parallels<N: Float>(
    t: &Torus<N>,
    ellipsoid: &Surface<N>,
    predicates: &Predicates,
) -> Vec<Contact<N>> {
    let along = |x: Interval<N>| {
        let (sin, cos) = Jet::variable(x).sin_cos();
        let out = Jet::constant(t.major) + cos.scale(t.minor);
        let up = sin.scale(t.minor);
        ellipsoid.level(t.frame.world_of([out, Jet::constant(N::ZERO), up]))
    };
    let Roots::At { roots, .. } = isolate(&along, &breaks_of_turn(), predicates.resolution())
    else {
        return Vec::new();
    };
    let torus = Surface::Torus(*t);
    let is_tangent = |phi: N| {
        (0..PLACES).all(|k| {
            let p = torus.point(N::TAU * N::whole(k) / N::whole(PLACES), phi);
            let tilt = torus.normal(&p).cross(&ellipsoid.normal(&p)).length();
            predicates.within(ellipsoid.distance(&p)) && predicates.within(tilt * t.minor)
        })
    };
    // A parallel within the resolution of a rim is the rim.
    let exact = |phi: N| {
        let half_turns = (phi / N::PI).round();
        let rim = if half_turns == N::ONE { N::PI } else { N::ZERO };
        let off = t.minor * (phi - half_turns * N::PI);
        if predicates.within(off) { rim } else { phi }
    };
    let double = roots.iter().filter(|r| r.contact != RootKind::Simple);
    let angles = double.map(|r| r.t).filter(|t| is_once(*t)).map(exact);
    angles
        .filter(|phi| is_tangent(*phi))
        .map(Contact::Rim)
        .collect()
}

/// The number of points of a parallel at which tangency is tested.
const PLACES: i32 = 12;

/// The ends of the pieces in which a whole turn is searched for zeros. Nothing is special at the first.
fn breaks_of_turn<N: Float>() -> Vec<N> {
    let eighth = N::TAU / N::from_f64(8.0);
    (0..=8)
        .map(|i| N::from_f64(0.1) + eighth * N::whole(i))
        .collect()
}

/// Whether a zero is not the first one again, after a whole turn.
fn is_once<N: Float>(zero: N) -> bool {
    zero < N::from_f64(0.1) + N::TAU * (N::ONE - N::ROUNDING)
}

/// Whether a torus, the second of the pair, is tangent to the tube of the first along its entire
/// outer (`true`) or inner rim.
fn ring_on_tube<N: Float>(pair: &SurfacePair<'_, N>, predicates: &Predicates) -> Option<bool> {
    let at = place(&pair.b.surface.frame().origin);
    let coincide = |question, relation| predicates.coincide(question, pair.how(relation), at);
    let outer = [true, false].into_iter();
    // A torus that reaches its axis has no inner rim.
    let is_ring = matches!(pair.b.surface, Surface::Torus(o) if o.is_ring());
    let mut outer = outer.filter(|&outer| {
        (outer || is_ring) && coincide("rim on tube", PairMeasure::RimOfTube(outer))
    });
    let outer = outer.next()?;
    let on = coincide("centre on spine", PairMeasure::OffSpine)
        && coincide("axis along spine", PairMeasure::AcrossSpine);
    on.then_some(outer)
}

/// The angle θ of a meridian circle along which the other surface is tangent to the torus: a sphere
/// in the tube, or a straight pipe or another bend that continues it.
fn equal_tubes<N: Float>(
    t: &Torus<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Option<N> {
    let (other, extent) = (pair.b.surface, pair.extent);
    let f = other.frame();
    let radii = match other {
        Surface::Sphere(_) | Surface::Cylinder(_) => PairMeasure::SizeOfTube,
        Surface::Torus(_) => PairMeasure::Tubes,
        Surface::Plane(_)
        | Surface::Cone(_)
        | Surface::EllipticCylinder(_)
        | Surface::EllipticCone(_)
        | Surface::Ellipsoid(_) => return None,
    };
    if !predicates.coincide("equal radii", pair.how(radii), place(&t.frame.origin)) {
        return None;
    }
    let centre = match other {
        Surface::Cylinder(_) => f.origin + f.z * (t.frame.origin - f.origin).dot(&f.z),
        Surface::Torus(u) => {
            let away = t.frame.origin - f.origin;
            common_spine_point(t, u, &away, predicates)?
        }
        _ => f.origin,
    };
    let q = t.frame.coordinates(&centre);
    let theta = q.y.atan2(q.x);
    let spine = Surface::Torus(Torus {
        minor: N::ZERO,
        ..*t
    });
    if !predicates.within(spine.distance(&centre)) {
        return None;
    }
    let tangent = t.frame.y * theta.cos() - t.frame.x * theta.sin();
    let along = match other {
        Surface::Sphere(_) => tangent,
        Surface::Cylinder(_) => f.z,
        _ => {
            let out = (centre - f.origin).unit();
            f.z.cross(&out)
        }
    };
    predicates
        .within(tangent.cross(&along).length() * extent.radius)
        .then_some(theta)
}

/// A common point of both spines, where the spine circles of two tori are tangent.
fn common_spine_point<N: Float>(
    t: &Torus<N>,
    u: &Torus<N>,
    away: &Vector3<N>,
    predicates: &Predicates,
) -> Option<Point3<N>> {
    // The common tangent of tangent circles is perpendicular to both radii, so the point lies on
    // the line through the feet of both centres. The points of t's spine in u's plane are tried,
    // and the converse.
    let normal = t.frame.z.cross(&u.frame.z);
    let candidates: Vec<Point3<N>> = if predicates.within(normal.length() * t.major) {
        let d = away - t.frame.z * t.frame.z.dot(away);
        let dir = direction(&d)?;
        [N::ONE, -N::ONE]
            .map(|s| t.frame.origin + dir * (s * t.major))
            .into()
    } else {
        // The tangent lies in both planes, along their common line; the radii are perpendicular to
        // it.
        let line = normal.unit();
        let out = t.frame.z.cross(&line);
        [N::ONE, -N::ONE]
            .map(|s| t.frame.origin + out * (s * t.major))
            .into()
    };
    let spine = Surface::Torus(Torus {
        minor: N::ZERO,
        ..*u
    });
    candidates
        .into_iter()
        .find(|p| predicates.within(spine.distance(p)))
}
