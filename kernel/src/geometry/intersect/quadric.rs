//! Two quadrics, neither a plane: which of them carries the curve, and what needs no rulings.

use super::rulings::{Rulings, apart};
use super::{Branch, Extent, IntersectionError, Meeting, drift, place};
use crate::geometry::curve::{Curve, Line};
use crate::geometry::frame::Frame;
use crate::geometry::quartic::Ruled;
use crate::geometry::surface::{Cone, Cylinder, Surface};
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::roots::{Contact, Zeros, isolate};
use crate::number::scalar::Scalar;
use crate::number::sign::{Judge, ROUNDING, Side};
use nalgebra::{Point3, Vector3};
use std::f64::consts::TAU;

pub(super) fn quadric_quadric(
    x: &Surface,
    y: &Surface,
    extent: &Extent,
    judge: &Judge,
) -> Result<Meeting, IntersectionError> {
    use Surface as S;
    match (x, y) {
        (S::Cylinder(c), S::Cylinder(d)) => {
            if judge.within(drift(&c.frame.z, &d.frame.z, extent)) {
                return Ok(parallel_cylinders(c, d, extent, judge));
            }
            over_rulings(Ruled::Cylinder(*c), y, extent, judge)
        }
        (S::Cylinder(c), _) => over_rulings(Ruled::Cylinder(*c), y, extent, judge),
        (_, S::Cylinder(c)) => over_rulings(Ruled::Cylinder(*c), x, extent, judge),
        (S::Cone(c), S::Cone(d)) => cones(c, d, extent, judge),
        (S::Cone(c), _) => over_rulings(Ruled::Cone(*c), y, extent, judge),
        (_, S::Cone(c)) => over_rulings(Ruled::Cone(*c), x, extent, judge),
        _ => Ok(Meeting::nothing()),
    }
}

fn parallel_cylinders(c: &Cylinder, d: &Cylinder, extent: &Extent, judge: &Judge) -> Meeting {
    let z = c.frame.z;
    let at = |f: &Frame| f.origin + f.z * ((extent.centre - f.origin).dot(&z) / f.z.dot(&z));
    let (p, q) = (at(&c.frame), at(&d.frame));
    let away = q - p;
    let dist = away.norm();
    let mut meeting = Meeting::nothing();
    if judge.within(dist) {
        return meeting;
    }
    let axis = away / dist;
    let (r, s) = (c.radius, d.radius);
    let x = 0.5 * (dist + (r - s) * (r + s) / dist);
    let line = |origin| {
        Curve::Line(Line {
            origin,
            direction: z,
        })
    };
    let foot = p + axis * x;
    let side = |gap: f64| judge.side("cylinder along cylinder", gap, place(&foot));
    match (side(dist - (r + s)), side((r - s).abs() - dist)) {
        (Side::On, _) => meeting.add(line(p + axis * r), true, extent),
        (_, Side::On) => meeting.add(line(p + axis * r.copysign(r - s)), true, extent),
        (Side::Inside, Side::Inside) => {
            let area = (r + s - dist) * (dist + (r - s)) * (dist - (r - s)) * (dist + r + s);
            let half = z.cross(&axis) * (area.max(0.0).sqrt() / (2.0 * dist));
            meeting.add(line(foot - half), false, extent);
            meeting.add(line(foot + half), false, extent);
        }
        _ => {}
    }
    meeting
}

fn cones(c: &Cone, d: &Cone, extent: &Extent, judge: &Judge) -> Result<Meeting, IntersectionError> {
    let (sc, sd) = (Surface::Cone(*c), Surface::Cone(*d));
    let on_other = |apex: &Point3<f64>, surface: &Surface| judge.within(apart(surface, apex));
    let between = (c.frame.origin - d.frame.origin).norm();
    if judge.coincide("apex on apex", between, place(&c.frame.origin)) {
        return Ok(common_apex(c, &sd, extent, judge));
    }
    if on_other(&c.frame.origin, &sd) && !on_other(&d.frame.origin, &sc) {
        return over_rulings(Ruled::Cone(*d), &sc, extent, judge);
    }
    over_rulings(Ruled::Cone(*c), &sd, extent, judge)
}

/// Two cones with one apex meet in common rulings.
fn common_apex(c: &Cone, other: &Surface, extent: &Extent, judge: &Judge) -> Meeting {
    let mut meeting = Meeting::touch(c.frame.origin);
    let m = c.sin / c.cos;
    // The distance from the other cone, a part's radius away from the apex, along each ruling.
    let along = |u: Jet<Interval>| {
        let (s, k) = u.sin_cos();
        let r = extent.radius;
        let p = c
            .frame
            .world_of([k.scale(m * r), s.scale(m * r), Jet::constant(r)]);
        other.level(p)
    };
    let breaks: Vec<f64> = (0..=8).map(|i| 0.1 + TAU * f64::from(i) / 8.0).collect();
    let Zeros::At { roots, .. } = isolate(&|t| along(Jet::variable(t)), &breaks, judge.band())
    else {
        return meeting;
    };
    let mut angles: Vec<(f64, bool)> = roots
        .iter()
        .map(|r| (r.t, r.contact != Contact::Simple))
        .collect();
    if let (Some(&(a, _)), Some(&(b, _))) = (angles.first(), angles.last())
        && angles.len() > 1
        && (a + TAU - b).abs() < ROUNDING * TAU
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
            && end > 0.0
        {
            meeting.nodes[0].on.push((meeting.branches.len(), 0.0));
            meeting.branches.push(Branch {
                curve,
                range: [0.0, end],
                closed: false,
                tangent,
            });
        }
    }
    meeting
}

fn over_rulings(
    base: Ruled,
    other: &Surface,
    extent: &Extent,
    judge: &Judge,
) -> Result<Meeting, IntersectionError> {
    let rulings = Rulings::new(base, other, extent);
    let flat = match &base {
        // The other surface holds the direction of the rulings: a cone with a ruling along them.
        Ruled::Cylinder(_) => judge.within(rulings.lead * extent.radius),
        Ruled::Cone(c) => {
            let away = apart(other, &c.frame.origin);
            judge.coincide("apex on quadric", away, place(&c.frame.origin))
        }
    };
    if flat {
        rulings.single(judge)
    } else {
        rulings.double(judge)
    }
}
