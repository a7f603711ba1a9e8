//! Splits curves at their intersections with the carriers of all faces close to them, and at points
//! known beforehand.

use super::arrangement::{Arrangement, Cut, IntersectionCurve, common, is_one_pass};
use super::close_calls::{Between, Unlisted};
use super::halfspaces::HalfSpaceModel;
use super::vertices::VertexMerger;
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::curve_surface::{comes_near, lies_on, roots};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::{Length, rounded, solution};
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use premio_kernel::number::roots::{Root, RootKind};
use rstar::AABB;
use std::collections::HashMap;

/// A contact of such a high order that a long piece is within the resolution.
pub(super) struct Wide<N: Float = f64> {
    meeting: usize,
    carrier: usize,
    /// The best estimate of the parameter.
    t: N,
    /// The distance from there up to which the points are within the resolution.
    pub reach: N,
}

/// Items that are handled after all curves have been split.
#[derive(Default)]
pub(super) struct Later<N: Float = f64> {
    /// The contacts of high order.
    pub wide: Vec<Wide<N>>,
    /// The close calls.
    pub calls: Vec<Unlisted>,
}

impl<N: Float> Arrangement<N> {
    /// Splits a curve by the carriers of all faces close to it.
    pub(super) fn cut_meeting(
        &mut self,
        index: usize,
        solids: &HalfSpaceModel<N>,
        predicates: &Predicates,
        corners: &mut VertexMerger<N>,
        later: &mut Later<N>,
    ) {
        let m = &self.meetings[index];
        let around = AABB::from_corners(m.bounds.min, m.bounds.max);
        let mut near: Vec<(usize, Aabb)> = Vec::new();
        for s in self.tree.locate_in_envelope_intersecting(around) {
            for (k, side) in solids.all[s.data].sides.iter().enumerate() {
                let c = self.sides[s.data][k].0;
                let face = side.bounds.grown(predicates.reach::<N>());
                if !m.carriers.contains(&c) && common(&face, &m.bounds).is_some() {
                    near.push((c, face));
                }
            }
        }
        near.sort_by_key(|n| n.0);
        let known: Vec<Cut<N>> = m.cuts.clone();
        let mut holding = Vec::new();
        let mut cuts = Vec::new();
        for faces in near.chunk_by(|a, b| a.0 == b.0) {
            match self.cuts_by(index, faces, &known, predicates, corners, later) {
                Some(found) => cuts.extend(found),
                None => holding.push(faces[0].0),
            }
        }
        let m = &mut self.meetings[index];
        m.carriers.extend(holding);
        m.carriers.sort_unstable();
        m.cuts.extend(cuts);
    }

    /// The cuts of a curve by the faces of one carrier; `None` if the carrier contains the curve.
    fn cuts_by(
        &self,
        index: usize,
        faces: &[(usize, Aabb)],
        known: &[Cut<N>],
        predicates: &Predicates,
        corners: &mut VertexMerger<N>,
        later: &mut Later<N>,
    ) -> Option<Vec<Cut<N>>> {
        let c = faces[0].0;
        let m = &self.meetings[index];
        let mut cuts = self.special_points(index, c, known, predicates, corners);
        let special: Vec<(N, Point3<N>)> = cuts
            .iter()
            .map(|s| (s.t, corners.all[s.vertex].point))
            .collect();
        let at_special = |p: &Point3<N>| {
            let mut points = special.iter().map(|s| s.1);
            points.any(|s| (s - p).length().is_within(predicates.reach()))
        };
        let (roots, misses) = m.intersection(&self.carriers[c], faces, predicates)?;
        let mut note = |question, distance, p: &Point3<N>| {
            let (_, call) = predicates.decide(question, distance, rounded(p));
            let call = call.map(|call| (call, Between::Curve(index, c)));
            later.calls.extend(call);
        };
        for r in roots {
            let p = m.curve.point(r.t);
            if special.iter().any(|s| m.holds_within(r.lo, r.hi, s.0)) || at_special(&p) {
                continue;
            }
            if let Some(margin) = r.margin {
                note("curve on surface", margin, &p);
            }
            let ends = [r.lo, r.hi].map(|t| (m.curve.point(t) - p).length());
            let mut reach = ends[0].max(ends[1]);
            if r.contact == RootKind::Touching {
                reach = reach.max(m.touching_length(r.t, &self.carriers[c], predicates));
            }
            if reach.is_beyond(predicates.reach()) {
                later.wide.push(Wide {
                    meeting: index,
                    carrier: c,
                    t: r.t,
                    reach,
                });
                continue;
            }
            let all = [m.carriers[0], m.carriers[1], c];
            let is_simple = r.contact == RootKind::Simple;
            let p = if is_simple {
                self.polished(p, all, predicates)
            } else {
                p
            };
            cuts.push(Cut {
                t: r.t,
                vertex: corners.at(&p, &all, predicates),
            });
        }
        for (t, value) in misses {
            let p = m.curve.point(t);
            if !at_special(&p) {
                note("curve beside surface", value, &p);
            }
        }
        Some(cuts)
    }

    /// Moves an inaccurate cut to an accurate corner, if there is one within its reach.
    pub(super) fn place_wide(
        &mut self,
        w: &Wide<N>,
        predicates: &Predicates,
        corners: &mut VertexMerger<N>,
    ) {
        let m = &self.meetings[w.meeting];
        let all = [m.carriers[0], m.carriers[1], w.carrier];
        let middle = m.curve.point(w.t);
        let fits = |v: &usize| {
            let p = corners.all[*v].point;
            (p - middle).length().is_within(w.reach)
                && all
                    .iter()
                    .all(|&c| predicates.within(self.carriers[c].distance(&p)))
                && predicates.within((m.curve.point(m.curve.parameter(&p)) - p).length())
        };
        let away = |v: &usize| (corners.all[*v].point - middle).length();
        let best = (0..corners.all.len())
            .filter(fits)
            .min_by(|a, b| away(a).total_cmp(&away(b)));
        let (t, vertex) = match best {
            Some(v) => {
                let p = corners.all[v].point;
                // A curve may pass its corner twice, so the parameter is recomputed only if the
                // corner is elsewhere.
                let t = match predicates.within((p - middle).length()) {
                    true => w.t,
                    false => in_range(&m.curve, m.range, m.curve.parameter(&p)),
                };
                (t, corners.at(&p, &all, predicates))
            }
            None => (w.t, corners.at(&middle, &all, predicates)),
        };
        self.meetings[w.meeting].cuts.push(Cut { t, vertex });
    }

    /// The known points of a curve on a carrier: the self-crossings of the curve, and the carrier's
    /// apex. The distance along the curve is not smooth there, so roots close to them are less
    /// accurate than the points.
    fn special_points(
        &self,
        index: usize,
        carrier: usize,
        known: &[Cut<N>],
        predicates: &Predicates,
        corners: &mut VertexMerger<N>,
    ) -> Vec<Cut<N>> {
        let m = &self.meetings[index];
        let surface = &self.carriers[carrier];
        let mut special: Vec<Cut<N>> = Vec::new();
        for cut in known {
            let p = corners.all[cut.vertex].point;
            if predicates.within(surface.distance(&p)) {
                let vertex = corners.at(&p, &[carrier], predicates);
                special.push(Cut { vertex, ..*cut });
            }
        }
        if let Surface::Cone(cone) = surface {
            let apex = cone.frame.origin;
            if m.bounds.grown(predicates.resolution::<N>()).contains(&apex) {
                let t = in_range(&m.curve, m.range, m.curve.parameter(&apex));
                let away = (m.curve.point(t) - apex).length();
                if t.lies_in(m.range) && predicates.within(away) {
                    let all = [m.carriers[0], m.carriers[1], carrier];
                    special.push(Cut {
                        t,
                        vertex: corners.at(&apex, &all, predicates),
                    });
                }
            }
        }
        special
    }

    /// The common point of three surfaces close to `p`, by Newton's method if their normals are
    /// well separated. For surfaces that are tangent within the resolution the steps may lead
    /// anywhere.
    fn polished(&self, p: Point3<N>, all: [usize; 3], predicates: &Predicates) -> Point3<N> {
        let mut q = p;
        for _ in 0..2 {
            let rows = all.map(|c| self.carriers[c].normal(&q));
            let off = all.map(|c| self.carriers[c].distance(&q));
            let volume = rows[0].dot(&rows[1].cross(&rows[2]));
            if volume.abs().is_short_of(N::ROUNDING.sqrt()) {
                return p;
            }
            match solution(rows.map(<[N; 3]>::from), off) {
                Some(step) => q -= Vector3::from(step),
                None => return p,
            }
        }
        match predicates.within((q - p).length()) {
            true => q,
            false => p,
        }
    }

    /// Adds to every curve the corners of its carriers, and to every corner the carriers of the
    /// curves through it. Each cut was found from two carriers of the curve and a third one.
    pub(super) fn share_corners(&mut self, predicates: &Predicates) {
        let mut by_pair: HashMap<(usize, usize), Vec<usize>> = HashMap::new();
        for (i, m) in self.meetings.iter().enumerate() {
            for (k, &a) in m.carriers.iter().enumerate() {
                for &b in &m.carriers[k + 1..] {
                    by_pair.entry((a, b)).or_default().push(i);
                }
            }
        }
        for v in 0..self.corners.len() {
            let mut visited: Vec<usize> = Vec::new();
            // A new carrier of a corner may add further curves.
            loop {
                let carriers = &self.corners[v].carriers;
                let mut ask: Vec<usize> = Vec::new();
                for (k, &a) in carriers.iter().enumerate() {
                    for &b in &carriers[k + 1..] {
                        ask.extend(by_pair.get(&(a, b)).into_iter().flatten());
                    }
                }
                ask.sort_unstable();
                ask.dedup();
                ask.retain(|i| !visited.contains(i));
                if !self.pass_all(&ask, v, predicates) {
                    break;
                }
                visited.extend(ask);
            }
        }
    }

    /// Adds a corner to the curves that pass through it. Returns whether the corner got a new
    /// carrier.
    fn pass_all(&mut self, meetings: &[usize], v: usize, predicates: &Predicates) -> bool {
        let corner = &mut self.corners[v];
        let known = corner.carriers.len();
        for &i in meetings {
            let m = &mut self.meetings[i];
            if m.bounds
                .grown(predicates.resolution::<N>())
                .contains(&corner.point)
            {
                m.pass(v, &corner.point, predicates);
            }
            if m.cuts.iter().any(|cut| cut.vertex == v) {
                corner.carriers.extend(&m.carriers);
            }
        }
        corner.carriers.sort_unstable();
        corner.carriers.dedup();
        corner.carriers.len() > known
    }
}

/// The roots of a surface along a curve, and the near misses.
type Intersections<N> = (Vec<Root<N>>, Vec<(N, N)>);

impl<N: Float> IntersectionCurve<N> {
    /// The intersections of the curve with a surface, inside the boxes of the surface's faces;
    /// `None` if the curve lies on the surface.
    fn intersection(
        &self,
        surface: &Surface<N>,
        faces: &[(usize, Aabb)],
        predicates: &Predicates,
    ) -> Option<Intersections<N>> {
        let resolution = predicates.resolution();
        if lies_on(&self.curve, self.range, surface, resolution) {
            return None;
        }
        let mut all = Intersections::default();
        let near = |b: &Aabb| {
            faces.iter().any(|(_, face)| common(face, b).is_some())
                && comes_near(surface, b, predicates.reach())
        };
        let mut parts = self.parts.as_slice();
        while let Some(first) = parts.iter().position(|p| near(&p.1)) {
            parts = &parts[first..];
            let count = parts.iter().take_while(|p| near(&p.1)).count();
            let range = [parts[0].0[0], parts[count - 1].0[1]];
            let (found, misses) = roots(&self.curve, range, surface, resolution);
            all.0.extend(found);
            all.1.extend(misses);
            parts = &parts[count..];
        }
        Some(all)
    }

    /// The distance from a point of tangency at which the curve leaves the surface by more than the
    /// resolution, to a factor of two.
    fn touching_length(&self, t: N, surface: &Surface<N>, predicates: &Predicates) -> N {
        let length = self.range[1] - self.range[0];
        let leaves = |step: &N| {
            let sides = [t - *step, t + *step].map(|t| surface.distance(&self.curve.point(t)));
            step.reaches(length) || !sides.iter().any(|&away| predicates.within(away))
        };
        let mut steps =
            std::iter::successors(Some(length * N::ROUNDING), |step| Some(N::TWO * *step));
        let first = steps.find(leaves).unwrap_or(length);
        (self.curve.point(t + first) - self.curve.point(t)).length()
    }

    /// Whether a parameter lies in a range; for a closed curve, modulo the period.
    fn holds_within(&self, lo: N, hi: N, t: N) -> bool {
        let period = if self.closed {
            self.range[1] - self.range[0]
        } else {
            N::ZERO
        };
        [-period, N::ZERO, period]
            .iter()
            .any(|&turn| (t + turn).lies_in([lo, hi]))
    }

    /// Splits the curve at a corner that it passes through. A closed curve that was opened at the
    /// corner is split at its ends, too, and so is a quartic that ends in an apex, where it has no
    /// direction.
    fn pass(&mut self, vertex: usize, p: &Point3<N>, predicates: &Predicates) {
        let [lo, hi] = self.range;
        let t = in_range(&self.curve, self.range, self.curve.parameter(p));
        let runs_into = matches!(self.curve, Curve::Quartic(_)) || self.curve.period().is_some();
        let opened = !self.closed && runs_into;
        let ends = if opened {
            [Some(lo), Some(hi)]
        } else {
            [None, None]
        };
        for t in ends.into_iter().flatten().chain([t]) {
            let known = self
                .cuts
                .iter()
                .any(|c| c.vertex == vertex && (!opened || is_one_pass(c.t, t)));
            let on = t.lies_in([lo, hi]) && predicates.within((self.curve.point(t) - p).length());
            if on && !known {
                self.cuts.push(Cut { t, vertex });
            }
        }
    }
}

/// A parameter shifted into the cycle that starts with a range.
fn in_range<N: Float>(curve: &Curve<N>, range: [N; 2], t: N) -> N {
    curve.in_cycle(t, range[0])
}
