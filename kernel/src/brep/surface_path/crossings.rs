//! The crossings of a path with arcs.

use super::{Branch, CrossingSense, DirectedArc, PathCrossing, SurfacePath, Track};
use crate::brep::topology::Sense;
use crate::geometry::curve::{Circle, Curve, Line};
use crate::geometry::curve_plane::{
    SectionPlane, line_intersections, section_roots, surface_roots,
};
use crate::geometry::surface::Surface;
use crate::geometry::torus_parameter::TorusParameter;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::Vector3;

/// A curve crosses a path clearly if the sine of their angle is greater than this times its rounding
/// error over its radius of curvature.
const TURNS_BACK: f64 = 16.0;

impl<N: Float> SurfacePath<N> {
    /// The crossings with `arcs` on `surface`, in order. `side` is the sense of the face's outward
    /// normal relative to the surface's.
    pub fn crossings(
        &self,
        surface: &Surface<N>,
        side: Sense,
        arcs: &[DirectedArc<'_, N>],
        resolution: N,
    ) -> Vec<PathCrossing<N>> {
        let mut found = Vec::new();
        for (i, arc) in arcs.iter().enumerate() {
            self.intersections(
                surface,
                side,
                arc,
                &[arc.range],
                resolution,
                &mut |at, t, passage| {
                    found.push(PathCrossing {
                        at,
                        arc: i,
                        t,
                        passage,
                    });
                },
            );
        }
        found.sort_by(|a, b| a.at.total_cmp(&b.at));
        found
    }

    /// Reports the crossings with one arc, within the given ranges: (length along the path,
    /// parameter, crossing sense).
    pub(in crate::brep) fn intersections(
        &self,
        surface: &Surface<N>,
        side: Sense,
        arc: &DirectedArc<'_, N>,
        ranges: &[[N; 2]],
        resolution: N,
        found: &mut impl FnMut(N, N, CrossingSense),
    ) {
        let [lo, hi] = arc.range;
        if !closes(arc) {
            for t in [lo, hi] {
                let p = arc.curve.point(t);
                if self.off(&p).is_within(resolution) && self.passes(&p, resolution) {
                    found(self.at(&p).max(N::ZERO), t, CrossingSense::Unclear);
                }
            }
        }
        let mut root = |t: N, simple: bool| {
            let p = arc.curve.point(t);
            if self.passes(&p, resolution) {
                let passage = match simple {
                    true => self.passage(surface, side, arc, t, resolution),
                    false => CrossingSense::Unclear,
                };
                found(self.at(&p).max(N::ZERO), t, passage);
            }
        };
        if let Track::Line(d) = &self.track
            && line_intersections(arc.curve, arc.range, &self.line(d), resolution, &mut root)
        {
            return;
        }
        if !ranges.is_empty()
            && let Some(all) = self.crossings_on_torus(surface, arc.curve, resolution)
        {
            let all = all.into_iter().map(|t| arc.curve.in_cycle(t, lo));
            return all
                .filter(|t| t.lies_in(arc.range))
                .for_each(|t| root(t, true));
        }
        let mut lost = None;
        for &range in ranges {
            let count = self.roots(arc.curve, range, resolution, &mut root);
            if self.has_lost_a_root(arc.curve, range, count, resolution) {
                lost = Some(range[0]);
            }
        }
        if let Some(t) = lost {
            found(N::ZERO, t, CrossingSense::Unclear);
        }
    }

    /// The sense in which an arc crosses the path at a parameter: unclear at the path's ends, and where
    /// the arc is tangent to the path.
    fn passage(
        &self,
        surface: &Surface<N>,
        side: Sense,
        arc: &DirectedArc<'_, N>,
        t: N,
        resolution: N,
    ) -> CrossingSense {
        let p = arc.curve.point(t);
        let s = self.at(&p);
        let sign = arc.sense.sign::<N>() * side.sign::<N>();
        let across = self.direction(&p).cross(&surface.normal(&p));
        let turn = sign * across.dot(&arc.curve.tangent(t));
        let at_end = s.is_at_most(resolution) || s.reaches(self.length - resolution);
        let is_along = turn.is_nan() || turn.abs().is_short_of(N::ROUNDING.sqrt());
        // The curve may turn back within its rounding error, and cross the path again.
        let is_vague = || match arc.curve {
            Curve::Toric(c) => {
                let bend = arc.curve.curvature(t).length();
                let turned = c.rounding_error(t) * bend * N::from_f64(TURNS_BACK);
                turn.abs().is_short_of(turned)
            }
            _ => false,
        };
        if at_end || is_along || is_vague() {
            CrossingSense::Unclear
        } else if turn.is_above_zero() {
            CrossingSense::Entering
        } else {
            CrossingSense::Leaving
        }
    }

    /// Reports the parameters within a range at which a curve crosses the path's section, and whether
    /// each is simple; gives their number.
    fn roots(
        &self,
        curve: &Curve<N>,
        range: [N; 2],
        resolution: N,
        root: &mut impl FnMut(N, bool),
    ) -> u32 {
        let mut count = 0_u32;
        let mut counted = |t: N, simple: bool| {
            count += 1;
            root(t, simple);
        };
        match self.branch {
            Branch::Level(c, _) => {
                let upright = Surface::Cylinder(c);
                surface_roots(curve, range, &upright, resolution, &mut counted);
            }
            _ => {
                let section = SectionPlane {
                    point: &self.start,
                    normal: &self.normal,
                };
                section_roots(curve, range, section, resolution, &mut counted);
            }
        }
        count
    }

    /// Whether an arc ends on another side of the section than `roots` changes of side allow. Along
    /// a curve that runs within its rounding error of the section, roots can be lost.
    fn has_lost_a_root(&self, curve: &Curve<N>, range: [N; 2], roots: u32, resolution: N) -> bool {
        if !matches!(curve, Curve::Toric(_) | Curve::Quartic(_)) {
            return false;
        }
        let [first, last] = range.map(|t| self.off(&curve.point(t)));
        let is_clear = first.abs().is_beyond(resolution) && last.abs().is_beyond(resolution);
        is_clear && (first * last).is_below_zero() == roots.is_multiple_of(2)
    }

    /// The line of a straight path in a direction.
    fn line(&self, direction: &Vector3<N>) -> Line<N> {
        Line {
            origin: self.start,
            direction: *direction,
        }
    }

    /// The transversal crossings of a circular path with a whole curve through the angles of a
    /// torus, where the circle is one of that torus or of the curve's other surface. `None` if the
    /// result is ambiguous, and for other paths and curves.
    fn crossings_on_torus(
        &self,
        surface: &Surface<N>,
        curve: &Curve<N>,
        resolution: N,
    ) -> Option<Vec<N>> {
        let (Track::Circle(frame, radius), Curve::Toric(curve)) = (&self.track, curve) else {
            return None;
        };
        if *surface != Surface::Torus(curve.torus) {
            let (frame, radius) = (*frame, *radius);
            return curve.across_circle(&Circle { frame, radius }, surface, resolution);
        }
        let [theta, phi] = surface.parameters(&self.start);
        let (fixed, angle) = match self.branch {
            // The path may start at a pole.
            Branch::Half(_, radial) if !curve.torus.is_ring() => {
                let out = surface.frame().components(&radial);
                (TorusParameter::Around, out.y.atan2(out.x))
            }
            Branch::Half(..) => (TorusParameter::Around, theta),
            Branch::Parallel(..) | Branch::Level(..) => (TorusParameter::Tube, phi),
            Branch::Whole => return None,
        };
        curve.across(fixed, angle, resolution)
    }
}

/// Whether the arc covers its entire closed curve.
fn closes<N: Float>(arc: &DirectedArc<'_, N>) -> bool {
    arc.curve.period().is_some_and(|period| {
        let [lo, hi] = arc.range;
        (hi - lo).reaches(period * (N::ONE - N::ROUNDING))
    })
}
