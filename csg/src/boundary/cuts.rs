//! Where curves are cut: by the carriers of all faces that come near, and at points known
//! beforehand.

use super::arrangement::{Arrangement, Cut, Meeting, common};
use super::concern::{Between, Unlisted};
use super::corners::Corners;
use super::halfspaces::Solids;
use nalgebra::{Matrix3, Point3, Vector3};
use premio_kernel::geometry::bounds::Box3;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::cut::{comes_near, lies_on, roots};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::roots::{Contact, Root};
use premio_kernel::number::sign::{Judge, ROUNDING};
use rstar::AABB;
use std::collections::HashMap;

/// A curve may pass one corner twice, but never within this part of a radian or a unit.
pub(super) const CLOSE_PASS: f64 = 1.0 / (1 << 16) as f64;

/// A contact of so high an order that many points are within the band.
pub(super) struct Wide {
    meeting: usize,
    carrier: usize,
    /// The parameter that fits best.
    t: f64,
    /// How far from there the points are within the band.
    pub reach: f64,
}

/// What is met on the way and dealt with when all curves are cut.
#[derive(Default)]
pub(super) struct Later {
    /// The contacts of high order.
    pub wide: Vec<Wide>,
    /// The close calls.
    pub calls: Vec<Unlisted>,
}

impl Arrangement {
    /// Cuts a curve by the carriers of all faces that come near it.
    pub(super) fn cut_meeting(
        &mut self,
        index: usize,
        solids: &Solids,
        judge: &Judge,
        corners: &mut Corners,
        later: &mut Later,
    ) {
        let m = &self.meetings[index];
        let around = AABB::from_corners(m.bounds.min, m.bounds.max);
        let mut near: Vec<(usize, Box3)> = Vec::new();
        for s in self.tree.locate_in_envelope_intersecting(around) {
            for (k, side) in solids.all[s.data].sides.iter().enumerate() {
                let c = self.sides[s.data][k].0;
                let face = side.bounds.grown(judge.reach());
                if !m.carriers.contains(&c) && common(&face, &m.bounds).is_some() {
                    near.push((c, face));
                }
            }
        }
        near.sort_by_key(|n| n.0);
        let known: Vec<Cut> = m.cuts.clone();
        let mut holding = Vec::new();
        let mut cuts = Vec::new();
        for faces in near.chunk_by(|a, b| a.0 == b.0) {
            match self.cuts_by(index, faces, &known, judge, corners, later) {
                Some(found) => cuts.extend(found),
                None => holding.push(faces[0].0),
            }
        }
        let m = &mut self.meetings[index];
        m.carriers.extend(holding);
        m.carriers.sort_unstable();
        m.cuts.extend(cuts);
    }

    /// The cuts of a curve by the faces of one carrier; none where the carrier holds the curve.
    fn cuts_by(
        &self,
        index: usize,
        faces: &[(usize, Box3)],
        known: &[Cut],
        judge: &Judge,
        corners: &mut Corners,
        later: &mut Later,
    ) -> Option<Vec<Cut>> {
        let c = faces[0].0;
        let m = &self.meetings[index];
        let mut cuts = self.special_points(index, c, known, judge, corners);
        let special: Vec<(f64, Point3<f64>)> = cuts
            .iter()
            .map(|s| (s.t, corners.all[s.vertex].point))
            .collect();
        let at_special =
            |p: &Point3<f64>| special.iter().any(|s| (s.1 - p).norm() <= judge.reach());
        let (roots, misses) = m.meet(&self.carriers[c], faces, judge)?;
        let mut note = |question, distance, p: &Point3<f64>| {
            let (_, call) = judge.decide(question, distance, (*p).into());
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
            let ends = [r.lo, r.hi].map(|t| (m.curve.point(t) - p).norm());
            let mut reach = ends[0].max(ends[1]);
            if r.contact == Contact::Touching {
                reach = reach.max(m.touching_length(r.t, &self.carriers[c], judge));
            }
            if reach > judge.reach() {
                later.wide.push(Wide {
                    meeting: index,
                    carrier: c,
                    t: r.t,
                    reach,
                });
                continue;
            }
            let all = [m.carriers[0], m.carriers[1], c];
            let plain = r.contact == Contact::Simple;
            let p = if plain { self.polished(p, all) } else { p };
            cuts.push(Cut {
                t: r.t,
                vertex: corners.at(&p, &all, judge),
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

    /// Puts a cut whose place is not well known at a corner that is, where there is one in reach.
    pub(super) fn place_wide(&mut self, w: &Wide, judge: &Judge, corners: &mut Corners) {
        let m = &self.meetings[w.meeting];
        let all = [m.carriers[0], m.carriers[1], w.carrier];
        let middle = m.curve.point(w.t);
        let fits = |v: &usize| {
            let p = corners.all[*v].point;
            (p - middle).norm() <= w.reach
                && all
                    .iter()
                    .all(|&c| judge.within(self.carriers[c].distance(&p)))
                && judge.within((m.curve.point(m.curve.parameter(&p)) - p).norm())
        };
        let away = |v: &usize| (corners.all[*v].point - middle).norm();
        let best = (0..corners.all.len())
            .filter(fits)
            .min_by(|a, b| away(a).total_cmp(&away(b)));
        let (t, vertex) = match best {
            Some(v) => {
                let p = corners.all[v].point;
                // A curve may pass its corner twice: only elsewhere its parameter is asked for.
                let t = match judge.within((p - middle).norm()) {
                    true => w.t,
                    false => in_range(&m.curve, m.range, m.curve.parameter(&p)),
                };
                (t, corners.at(&p, &all, judge))
            }
            None => (w.t, corners.at(&middle, &all, judge)),
        };
        self.meetings[w.meeting].cuts.push(Cut { t, vertex });
    }

    /// The points of a curve known beforehand to lie on a carrier: where the curve crosses itself,
    /// and the carrier's apex. The distance is no smooth function along the curve there, so roots
    /// next to them are less well known than the points.
    fn special_points(
        &self,
        index: usize,
        carrier: usize,
        known: &[Cut],
        judge: &Judge,
        corners: &mut Corners,
    ) -> Vec<Cut> {
        let m = &self.meetings[index];
        let surface = &self.carriers[carrier];
        let mut special: Vec<Cut> = Vec::new();
        for cut in known {
            let p = corners.all[cut.vertex].point;
            if judge.within(surface.distance(&p)) {
                let vertex = corners.at(&p, &[carrier], judge);
                special.push(Cut { vertex, ..*cut });
            }
        }
        if let Surface::Cone(cone) = surface {
            let apex = cone.frame.origin;
            if m.bounds.grown(judge.band()).holds(&apex) {
                let t = in_range(&m.curve, m.range, m.curve.parameter(&apex));
                let away = (m.curve.point(t) - apex).norm();
                if t >= m.range[0] && t <= m.range[1] && judge.within(away) {
                    let all = [m.carriers[0], m.carriers[1], carrier];
                    special.push(Cut {
                        t,
                        vertex: corners.at(&apex, &all, judge),
                    });
                }
            }
        }
        special
    }

    /// The common point of three surfaces next to `p`, by Newton's steps where they are well
    /// apart in direction.
    fn polished(&self, p: Point3<f64>, all: [usize; 3]) -> Point3<f64> {
        let mut q = p;
        for _ in 0..2 {
            let rows = all.map(|c| self.carriers[c].normal(&q).transpose());
            let off = Vector3::from_fn(|i, _| self.carriers[all[i]].distance(&q));
            let m = Matrix3::from_rows(&rows);
            if m.determinant().abs() < ROUNDING.sqrt() {
                return p;
            }
            match m.lu().solve(&off) {
                Some(step) => q -= step,
                None => return p,
            }
        }
        q
    }

    /// Makes every curve know the corners that its carriers know.
    pub(super) fn share_corners(&mut self, judge: &Judge) {
        let mut by_pair: HashMap<(usize, usize), Vec<usize>> = HashMap::new();
        for (i, m) in self.meetings.iter().enumerate() {
            for (k, &a) in m.carriers.iter().enumerate() {
                for &b in &m.carriers[k + 1..] {
                    by_pair.entry((a, b)).or_default().push(i);
                }
            }
        }
        for (v, corner) in self.corners.iter().enumerate() {
            let mut asked: Vec<usize> = Vec::new();
            for (k, &a) in corner.carriers.iter().enumerate() {
                for &b in &corner.carriers[k + 1..] {
                    asked.extend(by_pair.get(&(a, b)).into_iter().flatten());
                }
            }
            asked.sort_unstable();
            asked.dedup();
            for i in asked {
                let m = &mut self.meetings[i];
                if m.bounds.grown(judge.band()).holds(&corner.point) {
                    m.pass(v, &corner.point, judge);
                }
            }
        }
    }
}

/// The roots of a surface along a curve, and the nearest misses.
type Met = (Vec<Root>, Vec<(f64, f64)>);

impl Meeting {
    /// Where the curve meets a surface, as far as it runs through the boxes of faces of it; none
    /// where it lies on the surface.
    fn meet(&self, surface: &Surface, faces: &[(usize, Box3)], judge: &Judge) -> Option<Met> {
        let band = judge.band();
        if lies_on(&self.curve, self.range, surface, band) {
            return None;
        }
        let mut all = Met::default();
        let near = |b: &Box3| {
            faces.iter().any(|(_, face)| common(face, b).is_some())
                && comes_near(surface, b, judge.reach())
        };
        let mut parts = self.parts.as_slice();
        while let Some(first) = parts.iter().position(|p| near(&p.1)) {
            parts = &parts[first..];
            let count = parts.iter().take_while(|p| near(&p.1)).count();
            let range = [parts[0].0[0], parts[count - 1].0[1]];
            let (found, misses) = roots(&self.curve, range, surface, band);
            all.0.extend(found);
            all.1.extend(misses);
            parts = &parts[count..];
        }
        Some(all)
    }

    /// How far from a point where the curve touches a surface it leaves that by more than the
    /// resolution, to a factor of two.
    fn touching_length(&self, t: f64, surface: &Surface, judge: &Judge) -> f64 {
        let length = self.range[1] - self.range[0];
        let leaves = |step: &f64| {
            let sides = [t - step, t + step].map(|t| surface.distance(&self.curve.point(t)));
            *step >= length || !sides.iter().any(|&away| judge.within(away))
        };
        let mut steps = std::iter::successors(Some(length * ROUNDING), |step| Some(2.0 * step));
        let first = steps.find(leaves).unwrap_or(length);
        (self.curve.point(t + first) - self.curve.point(t)).norm()
    }

    /// Whether a parameter lies in a range, on a closed curve a turn more or less.
    fn holds_within(&self, lo: f64, hi: f64, t: f64) -> bool {
        let period = if self.closed {
            self.range[1] - self.range[0]
        } else {
            0.0
        };
        [-period, 0.0, period]
            .iter()
            .any(|turn| lo <= t + turn && t + turn <= hi)
    }

    /// Cuts the curve at a corner that it passes through: a closed curve that was opened at it, and
    /// a quartic that runs into an apex, where it has no direction, at its ends, too.
    fn pass(&mut self, vertex: usize, p: &Point3<f64>, judge: &Judge) {
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
                .any(|c| c.vertex == vertex && (!opened || (c.t - t).abs() < CLOSE_PASS));
            let on = t >= lo && t <= hi && judge.within((self.curve.point(t) - p).norm());
            if on && !known {
                self.cuts.push(Cut { t, vertex });
            }
        }
    }
}

/// A parameter brought into the cycle that starts with a range.
fn in_range(curve: &Curve, range: [f64; 2], t: f64) -> f64 {
    curve.in_cycle(t, range[0])
}
