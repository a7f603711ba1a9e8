//! Parameters on arcs, and the points where the boundary touches itself.

use crate::contour_generator::contour_arc::{Change, ContourArc, Split};
use crate::contour_generator::junctions::{JunctionKind, JunctionSupport, Junctions};
use crate::scene::Scene;
use crate::scene::tolerance::IMAGE_TOLERANCE;
use premio_kernel::number::predicates::Compare;

/// A parameter on an arc: within it, or at one of its ends.
#[derive(Clone, Copy, Debug)]
pub struct Settled {
    /// The parameter.
    pub t: f64,
    /// Whether it is an end, within the slack.
    pub at_end: bool,
}

/// Settles a parameter in the range of an arc, or at its end if it lies at most `near` beyond; none
/// if it lies farther.
pub fn settle(contour_arc: &ContourArc<'_>, t: f64, near: f64) -> Option<Settled> {
    let [lo, hi] = contour_arc.range;
    let t = match contour_arc.curve.period() {
        Some(period) => {
            let t = lo + (t - lo).rem_euclid(period);
            // Just before the start is closer to the start than to the end.
            if !contour_arc.closed && (t - hi).is_beyond(lo + period - t) {
                t - period
            } else {
                t
            }
        }
        None => t,
    };
    if contour_arc.closed {
        return Some(Settled { t, at_end: false });
    }
    let slack = near / contour_arc.curve.speed(t);
    if t.is_short_of(lo - slack) || t.is_beyond(hi + slack) || t.is_nan() {
        return None;
    }
    let at_end = t.is_at_most(lo + slack) || t.reaches(hi - slack);
    Some(Settled {
        t: t.clamp(lo, hi),
        at_end,
    })
}

/// Of the parameters of one point of a closed curve, the one nearest to `t`.
pub fn nearest_turn(contour_arc: &ContourArc<'_>, from: f64, t: f64) -> f64 {
    match contour_arc.curve.period() {
        Some(period) if contour_arc.closed => from + ((t - from) / period).round() * period,
        _ => from,
    }
}

/// Splits the arcs at the points where the boundary touches itself. The front arc may change there,
/// also for arcs that overlap in the image.
pub fn split_at_touches(
    contour_arcs: &mut [ContourArc<'_>],
    scene: &Scene<'_>,
    junctions: &mut Junctions<'_>,
) {
    let near = IMAGE_TOLERANCE * scene.resolution;
    let (topology, geometry) = (&scene.brep.topology, &scene.brep.geometry);
    for (touch, place) in topology.touches.iter().zip(&geometry.touches) {
        let within = |contour_arc: &ContourArc<'_>| match contour_arc.edge {
            Some(edge) => touch.edges.contains(&edge),
            None => contour_arc
                .faces
                .iter()
                .any(|f| touch.faces.contains(&f.face)),
        };
        let meeting = |contour_arc: &ContourArc<'_>| {
            let at = settle(contour_arc, contour_arc.curve.parameter(place), near)?;
            let met = (contour_arc.curve.point(at.t) - place)
                .norm()
                .is_within(near);
            met.then_some(at)
        };
        let all = contour_arcs
            .iter_mut()
            .filter(|contour_arc| within(contour_arc));
        let met: Vec<_> = all.filter_map(|s| Some((meeting(s)?, s))).collect();
        // Limbs that end there, at an apex, may hide one that passes.
        if met.len() < if touch.fans > 0 { 1 } else { 2 } {
            continue;
        }
        let passing = met.into_iter().filter(|(at, _)| !at.at_end);
        let passing: Vec<_> = passing.collect();
        if passing.is_empty() {
            continue;
        }
        let junction = match touch.vertex {
            Some(vertex) => junctions.vertex(vertex, place),
            None => junctions.add(JunctionKind::T, JunctionSupport::Alone, place),
        };
        junctions.mark_ambiguous(junction);
        for (at, contour_arc) in passing {
            let contours = &mut junctions.list[junction as usize].contours;
            contours.push(contour_arc.contour);
            contour_arc.splits.push(Split {
                t: at.t,
                junction,
                change: Change::Correct,
            });
        }
    }
}
