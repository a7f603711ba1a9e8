//! The turns of a loop at the poles of a torus that reaches its axis.
//!
//! A pole is one point, and a whole segment of the parameter plane. A loop that passes through it
//! runs along the part of that segment that its face covers.

use crate::brep::Brep;
use crate::brep::arcs::reaches_from_above;
use crate::brep::topology::{CoedgeId, Sense};
use crate::geometry::curve::Curve;
use crate::geometry::surface::{Surface, Torus};
use crate::geometry::torus_curve::wrap;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::{Point3, Vector3};

/// The part of a pole's segment along which a loop runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PoleTurn<N: Float> {
    /// The angle about the tube at the pole.
    pub v: N,
    /// The angle about the axis where the loop arrives, and by how much it turns.
    pub from: N,
    pub by: N,
}

/// The distance from a pole within which a vertex is at the pole, relative to the minor radius times the
/// square root of the machine epsilon. With more bits, vertices lie closer to a pole and are not at it.
const AT_POLE: f64 = 1.0 / 16.0;

/// The fraction of an edge from its end at which a point stands for the edge's direction.
const NEXT_TO_END: f64 = 1.0 / (1 << 10) as f64;

/// The difference of the angles about the axis of an edge's direction at its end and of the point next to
/// its end above which that direction is not known: the edge turns back there.
const TANGENT_OFF: f64 = 1.0 / 16.0;

/// The error of a sector between known directions.
const SAME_ANGLE: f64 = 1.0 / (1 << 20) as f64;

/// The turns of a loop at the poles of its surface, in order. `side` is the sense of the face's
/// outward normal relative to the surface's.
pub(super) fn pole_turns<N: Float>(
    brep: &Brep<N>,
    surface: &Surface<N>,
    coedges: &[CoedgeId],
    side: Sense,
) -> Vec<PoleTurn<N>> {
    let Surface::Torus(torus) = surface else {
        return Vec::new();
    };
    let followers = coedges.iter().cycle().skip(1);
    let pairs = coedges.iter().zip(followers);
    let turns = pairs.filter_map(|(&arriving, &leaving)| {
        let [_, vertex] = brep.topology.run(arriving)?;
        if !is_pole(torus, &brep.point(vertex)) {
            return None;
        }
        let [arrival, departure] = [
            CoedgeEnd::last(brep, arriving),
            CoedgeEnd::first(brep, leaving),
        ];
        // Both poles of a horn torus are one point.
        let is_upper = match torus.is_horn() {
            true => reaches_from_above(torus, arrival.curve, [arrival.at, arrival.other]),
            false => torus
                .frame
                .coordinates(&brep.point(vertex))
                .z
                .is_above_zero(),
        };
        // Seen from outside, the face is to the left: it lies behind a turn at the upper pole, and
        // ahead of one at the lower pole.
        let is_backward = is_upper == (side == Sense::Along);
        let edge = |c: CoedgeId| brep.topology.coedge(c).edge;
        let is_slit = arriving != leaving && edge(arriving) == edge(leaving);
        let sector = match is_slit {
            true => N::TAU,
            false => sector([&arrival, &departure], torus, is_backward),
        };
        let from = arrival.direction(torus).angle;
        let pole = torus.pole_angle();
        Some(PoleTurn {
            v: if is_upper { pole } else { -pole },
            from,
            by: if is_backward { -sector } else { sector },
        })
    });
    turns.collect()
}

/// The angle that a face covers at a pole between the edge that arrives and the one that leaves. At a
/// cusp it is nothing or a whole turn, as the points next to the pole show.
fn sector<N: Float>(ends: [&CoedgeEnd<'_, N>; 2], torus: &Torus<N>, is_backward: bool) -> N {
    let between = |[from, to]: [N; 2]| match is_backward {
        true => (from - to).rem_euclid(N::TAU),
        false => (to - from).rem_euclid(N::TAU),
    };
    let directions = ends.map(|end| end.direction(torus));
    let sector = between(directions.map(|direction| direction.angle));
    let error = match directions.iter().all(|direction| direction.is_at_end) {
        true => SAME_ANGLE,
        false => TANGENT_OFF,
    };
    let is_cusp = sector.min(N::TAU - sector).is_short_of(N::from_f64(error));
    if !is_cusp {
        return sector;
    }
    match between(ends.map(|end| end.angle_inside(torus))).is_beyond(N::PI) {
        true => N::TAU,
        false => N::ZERO,
    }
}

/// Whether a point is at a pole.
pub(super) fn is_pole<N: Float>(torus: &Torus<N>, p: &Point3<N>) -> bool {
    let near = torus.minor * N::EPSILON.sqrt() * N::from_f64(AT_POLE);
    let mut poles = torus.poles();
    poles.any(|pole| (pole - p).length().is_within(near))
}

/// The angle about the axis of the direction of a coedge at a pole.
#[derive(Clone, Copy)]
struct EndDirection<N: Float> {
    angle: N,
    /// Whether it is that at the end, and not of a point next to the end.
    is_at_end: bool,
}

/// An end of a coedge.
struct CoedgeEnd<'a, N: Float> {
    curve: &'a Curve<N>,
    /// The parameter there, and at the other end.
    at: N,
    other: N,
}

impl<'a, N: Float> CoedgeEnd<'a, N> {
    fn first(brep: &'a Brep<N>, coedge: CoedgeId) -> Self {
        let coedge = brep.topology.coedge(coedge);
        let [lo, hi] = brep.range(coedge.edge);
        let [at, other] = match coedge.sense {
            Sense::Along => [lo, hi],
            Sense::Against => [hi, lo],
        };
        let curve = brep.curve(coedge.edge);
        Self { curve, at, other }
    }

    fn last(brep: &'a Brep<N>, coedge: CoedgeId) -> Self {
        let Self { curve, at, other } = Self::first(brep, coedge);
        let (at, other) = (other, at);
        Self { curve, at, other }
    }

    /// The coordinates in the torus's frame of the point at a fraction of the coedge from here.
    fn inside(&self, torus: &Torus<N>, fraction: f64) -> Vector3<N> {
        let t = self.at + (self.other - self.at) * N::from_f64(fraction);
        torus.frame.coordinates(&self.curve.point(t))
    }

    /// The direction in which the coedge arrives at a pole, or leaves it. At the pole of a horn torus edges
    /// are tangent to the axis and bend away from it.
    fn direction(&self, torus: &Torus<N>) -> EndDirection<N> {
        let away = match torus.is_horn() {
            true => self.curve.curvature(self.at),
            false => self.curve.tangent(self.at) * (self.other - self.at).signum(),
        };
        let leaving = torus.frame.components(&away);
        let (angle, inside) = (leaving.y.atan2(leaving.x), self.angle_inside(torus));
        let off = wrap(angle - inside).abs();
        let is_at_end = off.is_short_of(N::from_f64(TANGENT_OFF));
        EndDirection {
            angle: if is_at_end { angle } else { inside },
            is_at_end,
        }
    }

    /// The angle about the axis of a point next to the end.
    fn angle_inside(&self, torus: &Torus<N>) -> N {
        let q = self.inside(torus, NEXT_TO_END);
        q.y.atan2(q.x)
    }
}
