//! The curves in which carriers meet, and the points in which they are cut.
//!
//! Everything that coincides within the resolution is made one here, before any topology: equal
//! surfaces become one carrier, equal points one vertex that is known by all carriers through it.

use super::EvaluationError;
use super::halfspaces::{HalfSpace, Solids};
use nalgebra::{Matrix3, Point3, Vector3};
use premio_kernel::brep::topology::Sense;
use premio_kernel::geometry::bounds::{Box3, pieces};
use premio_kernel::geometry::curve::{Curve, Line};
use premio_kernel::geometry::cut::{comes_near, lies_on, roots};
use premio_kernel::geometry::intersect::{Branch, Extent, coincidence, meet};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::roots::{Contact, Root};
use premio_kernel::number::sign::{Judge, ROUNDING};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use std::collections::{BTreeMap, HashMap};

/// Where a curve is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// The parameter.
    pub t: f64,
    /// The vertex there.
    pub vertex: usize,
}

/// A curve in which carriers meet.
#[derive(Clone, Debug)]
pub(super) struct Meeting {
    /// The curve.
    pub curve: Curve,
    /// The range of its parameter.
    pub range: [f64; 2],
    /// Whether the range is a whole period.
    pub closed: bool,
    /// All carriers that hold it, in order.
    pub carriers: Vec<usize>,
    /// The pair of carriers it was found from, where they are tangent all along it.
    pub tangent: Option<[usize; 2]>,
    /// Its box.
    pub bounds: Box3,
    /// Its smooth pieces with their boxes, in order.
    pub parts: Vec<([f64; 2], Box3)>,
    /// Where it is cut, in order.
    pub cuts: Vec<Cut>,
}

/// A point where a curve is cut.
#[derive(Clone, Debug)]
pub(super) struct Corner {
    /// The place.
    pub point: Point3<f64>,
    /// The carriers through it, in order.
    pub carriers: Vec<usize>,
}

/// A contact of so high an order that many points are within the band.
struct Wide {
    meeting: usize,
    carrier: usize,
    /// The parameter that fits best.
    t: f64,
    /// How far from there the points are within the band.
    reach: f64,
}

/// The solids' boxes, to be asked for what lies near.
pub(super) type SolidTree = RTree<GeomWithData<Rectangle<[f64; 3]>, usize>>;

/// All carriers, curves and corners.
#[derive(Debug)]
pub(super) struct Arrangement {
    /// The distinct surfaces.
    pub carriers: Vec<Surface>,
    /// For each half space of each solid: its carrier and the sense relative to it.
    pub sides: Vec<Vec<(usize, Sense)>>,
    /// The curves.
    pub meetings: Vec<Meeting>,
    /// The corners.
    pub corners: Vec<Corner>,
    /// The solids' boxes.
    pub tree: SolidTree,
}

pub(super) fn arrange(
    solids: &Solids,
    extent: &Extent,
    judge: &Judge,
) -> Result<Arrangement, EvaluationError> {
    let (carriers, sides) = merge(solids, extent, judge);
    let band = judge.band();
    let boxes = solids.all.iter().enumerate().map(|(i, s)| {
        let b = s.bounds.grown(band);
        GeomWithData::new(Rectangle::from_corners(b.min, b.max), i)
    });
    let tree = RTree::bulk_load(boxes.collect());
    let mut found = Arrangement {
        carriers,
        sides,
        meetings: Vec::new(),
        corners: Vec::new(),
        tree,
    };
    let mut corners = Corners::new(band);
    for ((a, b), supports) in found.pairs(solids, band) {
        found.add_pair(a, b, &supports, extent, judge, &mut corners)?;
    }
    let mut wide = Vec::new();
    for i in 0..found.meetings.len() {
        found.cut_meeting(i, solids, judge, &mut corners, &mut wide);
    }
    // The best known first: the others are put where they are.
    wide.sort_by(|a, b| a.reach.total_cmp(&b.reach));
    for w in &wide {
        found.place_wide(w, judge, &mut corners);
    }
    found.corners = corners.all;
    found.share_corners(judge);
    for m in &mut found.meetings {
        m.cuts.sort_by(|a, b| a.t.total_cmp(&b.t));
        m.cuts
            .dedup_by(|a, b| a.vertex == b.vertex && (a.t - b.t).abs() < CLOSE_PASS);
    }
    Ok(found)
}

/// Points nearer to one another than this many times the resolution are a close call.
const CLOSE_CALL: f64 = 100.0;

/// A curve may pass one corner twice, but never within this part of a radian or a unit.
const CLOSE_PASS: f64 = 1.0 / (1 << 16) as f64;

/// The distinct surfaces, and each half space's carrier.
fn merge(
    solids: &Solids,
    extent: &Extent,
    judge: &Judge,
) -> (Vec<Surface>, Vec<Vec<(usize, Sense)>>) {
    // Equal surfaces have nearly the same point next to the extent's centre: sorted by it, only
    // neighbours are compared.
    let foot = |s: &Surface| {
        let f = s.frame();
        let away = extent.centre - f.origin;
        match s {
            Surface::Plane(_) => extent.centre - f.z * f.z.dot(&away),
            Surface::Cylinder(_) => f.origin + f.z * f.z.dot(&away),
            Surface::Cone(_) | Surface::Sphere(_) | Surface::Torus(_) => f.origin,
        }
    };
    let mut list: Vec<(f64, usize, usize, &HalfSpace)> = Vec::new();
    for (i, s) in solids.all.iter().enumerate() {
        for (k, side) in s.sides.iter().enumerate() {
            list.push((foot(&side.surface).x, i, k, side));
        }
    }
    list.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let window = 4.0 * judge.band() + ROUNDING * extent.radius;
    let mut sides: Vec<Vec<(usize, Sense)>> = solids
        .all
        .iter()
        .map(|s| vec![(usize::MAX, Sense::Along); s.sides.len()])
        .collect();
    let mut carriers: Vec<Surface> = Vec::new();
    // The carriers that may still be met, by the place of their foot.
    let mut recent: Vec<(f64, usize)> = Vec::new();
    for (x, i, k, side) in list {
        recent.retain(|(y, _)| x - y <= window);
        let known = recent.iter().find_map(|&(_, c)| {
            coincidence(&carriers[c], &side.surface, extent, judge).map(|sense| (c, sense))
        });
        sides[i][k] = known.unwrap_or_else(|| {
            carriers.push(side.surface);
            recent.push((x, carriers.len() - 1));
            (carriers.len() - 1, Sense::Along)
        });
    }
    (carriers, sides)
}

type Pairs = BTreeMap<(usize, usize), Vec<Box3>>;

impl Arrangement {
    /// The pairs of carriers whose faces' boxes meet, with the boxes that they share.
    fn pairs(&self, solids: &Solids, band: f64) -> Pairs {
        let mut pairs = Pairs::new();
        for (i, s) in solids.all.iter().enumerate() {
            let around = AABB::from_corners(s.bounds.min, s.bounds.max);
            for near in self.tree.locate_in_envelope_intersecting(around) {
                let j = near.data;
                if j >= i {
                    self.add_pairs_of(solids, i, j, band, &mut pairs);
                }
            }
        }
        pairs
    }

    fn add_pairs_of(&self, solids: &Solids, i: usize, j: usize, band: f64, pairs: &mut Pairs) {
        let (s, o) = (&solids.all[i], &solids.all[j]);
        for (k, a) in s.sides.iter().enumerate() {
            let box_a = a.bounds.grown(band);
            for (l, b) in o.sides.iter().enumerate() {
                let (c, d) = (self.sides[i][k].0, self.sides[j][l].0);
                if c == d || (i == j && k >= l) {
                    continue;
                }
                if let Some(shared) = common(&box_a, &b.bounds.grown(band)) {
                    pairs.entry((c.min(d), c.max(d))).or_default().push(shared);
                }
            }
        }
    }

    fn add_pair(
        &mut self,
        a: usize,
        b: usize,
        supports: &[Box3],
        extent: &Extent,
        judge: &Judge,
        corners: &mut Corners,
    ) -> Result<(), EvaluationError> {
        let met = meet(&self.carriers[a], &self.carriers[b], extent, judge)?;
        let mut kept: Vec<Vec<usize>> = Vec::new();
        for branch in &met.branches {
            kept.push(self.add_branch(a, b, branch, supports, judge));
        }
        for node in &met.nodes {
            if node.on.is_empty() && !supports.iter().any(|s| s.holds(&node.point)) {
                continue;
            }
            let vertex = corners.at(&node.point, &[a, b], judge);
            for &(branch, t) in &node.on {
                for &m in &kept[branch] {
                    let [lo, hi] = self.meetings[m].range;
                    if t >= lo - judge.band() && t <= hi + judge.band() {
                        let t = t.clamp(lo, hi);
                        self.meetings[m].cuts.push(Cut { t, vertex });
                    }
                }
            }
        }
        Ok(())
    }

    /// Adds a branch as far as both faces' boxes hold it: the indices it was given.
    fn add_branch(
        &mut self,
        a: usize,
        b: usize,
        branch: &Branch,
        supports: &[Box3],
        judge: &Judge,
    ) -> Vec<usize> {
        let ranges = match &branch.curve {
            Curve::Line(line) => clipped(line, branch.range, supports),
            _ => vec![branch.range],
        };
        let mut kept = Vec::new();
        for range in ranges {
            let parts = pieces(&branch.curve, range);
            let b3 = parts.iter().fold(Box3::EMPTY, |b, p| b.hull(&p.1));
            if !supports
                .iter()
                .any(|s| common(s, &b3.grown(judge.band())).is_some())
            {
                continue;
            }
            kept.push(self.meetings.len());
            self.meetings.push(Meeting {
                curve: branch.curve.clone(),
                range,
                closed: branch.closed && range == branch.range,
                carriers: vec![a, b],
                tangent: branch.tangent.then_some([a, b]),
                bounds: b3,
                parts,
                cuts: Vec::new(),
            });
        }
        kept
    }

    /// Cuts a curve by the carriers of all faces that come near it.
    fn cut_meeting(
        &mut self,
        index: usize,
        solids: &Solids,
        judge: &Judge,
        corners: &mut Corners,
        wide: &mut Vec<Wide>,
    ) {
        let band = judge.band();
        let m = &self.meetings[index];
        let around = AABB::from_corners(m.bounds.min, m.bounds.max);
        let mut near: Vec<(usize, Box3)> = Vec::new();
        for s in self.tree.locate_in_envelope_intersecting(around) {
            for (k, side) in solids.all[s.data].sides.iter().enumerate() {
                let c = self.sides[s.data][k].0;
                let face = side.bounds.grown(band);
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
            let c = faces[0].0;
            let special = self.special_points(index, c, &known, judge, corners);
            let m = &self.meetings[index];
            let Some((roots, misses)) = m.meet(&self.carriers[c], faces, band) else {
                holding.push(c);
                continue;
            };
            for r in roots {
                let p = m.curve.point(r.t);
                let absorbed = special.iter().any(|s| {
                    let at = corners.all[s.vertex].point;
                    m.holds_within(r.lo, r.hi, s.t) || (at - p).norm() <= CLOSE_CALL * band
                });
                if absorbed {
                    continue;
                }
                if let Some(margin) = r.margin {
                    judge.note("curve on surface", margin, p.coords.into());
                }
                let all = [m.carriers[0], m.carriers[1], c];
                let reach = [r.lo, r.hi].map(|t| (m.curve.point(t) - p).norm());
                let reach = reach[0].max(reach[1]);
                if reach > CLOSE_CALL * band {
                    wide.push(Wide {
                        meeting: index,
                        carrier: c,
                        t: r.t,
                        reach,
                    });
                    continue;
                }
                let plain = r.contact == Contact::Simple;
                let p = if plain { self.polished(p, all) } else { p };
                cuts.push(Cut {
                    t: r.t,
                    vertex: corners.at(&p, &all, judge),
                });
            }
            for (t, value) in misses {
                judge.note(
                    "curve beside surface",
                    value,
                    m.curve.point(t).coords.into(),
                );
            }
            cuts.extend(special);
        }
        let m = &mut self.meetings[index];
        m.carriers.extend(holding);
        m.carriers.sort_unstable();
        m.cuts.extend(cuts);
    }

    /// Puts a cut whose place is not well known at a corner that is, where there is one in reach.
    fn place_wide(&mut self, w: &Wide, judge: &Judge, corners: &mut Corners) {
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
                let t = in_range(&m.curve, m.range, m.curve.parameter(&p));
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
    fn share_corners(&mut self, judge: &Judge) {
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
    fn meet(&self, surface: &Surface, faces: &[(usize, Box3)], band: f64) -> Option<Met> {
        if lies_on(&self.curve, self.range, surface, band) {
            return None;
        }
        let mut all = Met::default();
        let near = |b: &Box3| {
            faces.iter().any(|(_, face)| common(face, b).is_some())
                && comes_near(surface, b, CLOSE_CALL * band)
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

/// The parameter of a closed curve brought into a range that starts where it does.
fn in_range(curve: &Curve, range: [f64; 2], t: f64) -> f64 {
    match curve.period() {
        Some(period) => range[0] + (t - range[0]).rem_euclid(period),
        None => t,
    }
}

/// What two boxes share.
fn common(a: &Box3, b: &Box3) -> Option<Box3> {
    let min: [f64; 3] = std::array::from_fn(|i| a.min[i].max(b.min[i]));
    let max: [f64; 3] = std::array::from_fn(|i| a.max[i].min(b.max[i]));
    (0..3)
        .all(|i| min[i] <= max[i])
        .then_some(Box3 { min, max })
}

/// The parts of a line within the boxes, overlapping ones joined.
fn clipped(line: &Line, range: [f64; 2], boxes: &[Box3]) -> Vec<[f64; 2]> {
    let mut parts: Vec<[f64; 2]> = Vec::new();
    for b in boxes {
        let [mut lo, mut hi] = range;
        for i in 0..3 {
            let (o, d) = (line.origin[i], line.direction[i]);
            // Steep enough to cross the slab within the extent, or else it lies along it.
            let (x, y) = ((b.min[i] - o) / d, (b.max[i] - o) / d);
            if d == 0.0 || !x.is_finite() || !y.is_finite() {
                if o < b.min[i] || o > b.max[i] {
                    hi = f64::NEG_INFINITY;
                }
                continue;
            }
            lo = lo.max(x.min(y));
            hi = hi.min(x.max(y));
        }
        if lo < hi {
            parts.push([lo, hi]);
        }
    }
    parts.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for p in parts {
        match joined.last_mut() {
            Some(last) if p[0] <= last[1] => last[1] = last[1].max(p[1]),
            _ => joined.push(p),
        }
    }
    joined
}

/// Corners by place, so that equal ones are one.
struct Corners {
    all: Vec<Corner>,
    grid: HashMap<[i64; 3], Vec<usize>>,
    cell: f64,
}

impl Corners {
    fn new(band: f64) -> Self {
        Self {
            all: Vec::new(),
            grid: HashMap::new(),
            cell: 256.0 * band,
        }
    }

    fn key(&self, p: &Point3<f64>) -> [i64; 3] {
        [0, 1, 2].map(|i| (p[i] / self.cell).floor() as i64)
    }

    /// The corner at `p`, which the given carriers pass through.
    fn at(&mut self, p: &Point3<f64>, carriers: &[usize], judge: &Judge) -> usize {
        let reach = 100.0 * judge.band();
        let lo = self.key(&(p - Vector3::repeat(reach)));
        let hi = self.key(&(p + Vector3::repeat(reach)));
        let mut best: Option<(f64, usize)> = None;
        for x in lo[0]..=hi[0] {
            for y in lo[1]..=hi[1] {
                for z in lo[2]..=hi[2] {
                    for &v in self.grid.get(&[x, y, z]).into_iter().flatten() {
                        let d = (self.all[v].point - p).norm();
                        if best.is_none_or(|b| d < b.0) {
                            best = Some((d, v));
                        }
                    }
                }
            }
        }
        if let Some((d, v)) = best
            && d < reach
            && judge.coincide("point on point", d, [p.x, p.y, p.z])
        {
            for &c in carriers {
                if let Err(at) = self.all[v].carriers.binary_search(&c) {
                    self.all[v].carriers.insert(at, c);
                }
            }
            return v;
        }
        let v = self.all.len();
        let mut carriers = carriers.to_vec();
        carriers.sort_unstable();
        self.all.push(Corner {
            point: *p,
            carriers,
        });
        self.grid.entry(self.key(p)).or_default().push(v);
        v
    }
}
