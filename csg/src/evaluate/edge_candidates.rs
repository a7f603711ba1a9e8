//! Edge candidates: the pieces of curves between consecutive vertices. Each occurs once, however
//! many pairs of carriers gave its curve.

use super::arrangement::{Arrangement, Cut, IntersectionCurve};
use super::vertices::VertexCandidate;
use nalgebra::Point3;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::curve_surface::lies_on;
use premio_kernel::geometry::vector::Length;
use premio_kernel::hash::HashMap;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};

/// A piece of a curve between two corners, or a closed curve without any.
#[derive(Clone, Debug)]
pub(super) struct EdgeCandidate<N: Float = f64> {
    /// The index of the curve in the arrangement.
    pub meeting: usize,
    /// The range of the parameter, increasing.
    pub range: [N; 2],
    /// The corners at both ends.
    pub ends: Option<[usize; 2]>,
    /// All carriers that contain it, in increasing order.
    pub carriers: Vec<usize>,
    /// The pairs of carriers that are tangent along all of it.
    pub tangent: Vec<[usize; 2]>,
    /// The pairs of carriers of which it is the intersection.
    pub crossing: Vec<[usize; 2]>,
}

/// A key shared by copies of a piece.
#[derive(PartialEq, Eq, Hash)]
enum Name {
    /// The canonical index of a closed curve.
    Closed(usize),
    /// The corners at both ends, in increasing order.
    Open([usize; 2]),
}

impl Name {
    fn new(home: usize, ends: Option<[usize; 2]>) -> Self {
        match ends {
            Some([a, b]) => Self::Open([a.min(b), a.max(b)]),
            None => Self::Closed(home),
        }
    }
}

/// The part of a curve between two consecutive cuts.
struct Span<N: Float = f64> {
    range: [N; 2],
    /// The corners at both ends; none for a closed curve without cuts.
    ends: Option<[usize; 2]>,
}

pub(super) fn pieces<N: Float>(
    arrangement: &Arrangement<N>,
    predicates: &Predicates,
) -> Vec<EdgeCandidate<N>> {
    let homes = homes(arrangement, predicates);
    let mut all: Vec<EdgeCandidate<N>> = Vec::new();
    // Two pieces over the same points share their ends. They also share a canonical curve or, if
    // the curves coincide only within the resolution, two carriers.
    let mut known: HashMap<Name, Vec<usize>> = HashMap::default();
    for (index, m) in arrangement.meetings.iter().enumerate() {
        for Span { range, ends } in spans(m) {
            let piece = EdgeCandidate {
                meeting: index,
                range,
                ends,
                carriers: arrangement.holding(m, range, ends, predicates),
                tangent: m.tangent.clone(),
                crossing: m.crossing.clone(),
            };
            if piece.carriers.len() > 2 {
                let home = homes[index];
                let list = known.entry(Name::new(home, ends)).or_default();
                let middle = m.curve.point(N::HALF * (range[0] + range[1]));
                let same = list.iter().copied().find(|&i| {
                    let other: &EdgeCandidate<N> = &all[i];
                    let curve = &arrangement.meetings[other.meeting].curve;
                    (homes[other.meeting] == home || other.shares_two(&piece))
                        && passes(curve, other.range, &middle, predicates)
                });
                if let Some(i) = same {
                    all[i].add(&piece);
                    continue;
                }
                list.push(all.len());
            }
            all.push(piece);
        }
    }
    for piece in &mut all {
        let home = homes[piece.meeting];
        if home != piece.meeting {
            piece.move_to(home, arrangement);
        }
    }
    all
}

/// For each curve the first one that coincides with it. Copies come from several pairs of carriers.
/// Each copy is clipped to the faces of its own pair, and records only the carriers close to these.
fn homes<N: Float>(arrangement: &Arrangement<N>, predicates: &Predicates) -> Vec<usize> {
    let mut homes: Vec<usize> = (0..arrangement.meetings.len()).collect();
    let mut by_pair: HashMap<[usize; 2], Vec<usize>> = HashMap::default();
    for (i, m) in arrangement.meetings.iter().enumerate() {
        // A curve shorter than the resolution lies in everything close to it, and has no pieces.
        if m.carriers.len() < 3 || spans(m).is_empty() {
            continue;
        }
        for (k, &a) in m.carriers.iter().enumerate() {
            for &b in &m.carriers[k + 1..] {
                let list = by_pair.entry([a, b]).or_default();
                for &j in list.iter() {
                    let (p, q) = (first_home(&homes, i), first_home(&homes, j));
                    if p != q && same_curve(&arrangement.meetings[j], m, predicates) {
                        homes[p.max(q)] = p.min(q);
                    }
                }
                list.push(i);
            }
        }
    }
    (0..homes.len()).map(|i| first_home(&homes, i)).collect()
}

fn first_home(homes: &[usize], mut i: usize) -> usize {
    while homes[i] != i {
        i = homes[i];
    }
    i
}

/// Whether two intersection curves with two common carriers coincide. Two points of the longer one
/// are tested; at most one of them can be a crossing of the two.
fn same_curve<N: Float>(
    a: &IntersectionCurve<N>,
    b: &IntersectionCurve<N>,
    predicates: &Predicates,
) -> bool {
    let (long, short) = match a.bounds.diagonal().is_beyond(b.bounds.diagonal()) {
        true => (a, b),
        false => (b, a),
    };
    let [lo, hi] = long.range;
    [N::ONE, N::TWO].iter().all(|&part| {
        let p = long.curve.point(lo + (hi - lo) * part / N::from_f64(3.0));
        is_same_place(
            &short.curve.point(short.curve.parameter(&p)),
            &p,
            predicates,
        )
    })
}

/// Whether points of curves that may coincide are the same; otherwise they are far from each other.
fn is_same_place<N: Float>(p: &Point3<N>, q: &Point3<N>, predicates: &Predicates) -> bool {
    let reach = N::from_f64(SAME) * predicates.resolution::<N>();
    (p - q).length().is_within(reach)
}

/// The distance, in multiples of the resolution, within which curves and pieces that may coincide
/// do so.
const SAME: f64 = 64.0;

impl<N: Float> Arrangement<N> {
    /// The carriers that contain a span of a curve: the curve's own, and close to a contact those
    /// that contain both corners and are within the resolution of the span. A corner records only
    /// the carriers of curves close to the faces that split it, so those of the other corner are
    /// tested, too.
    fn holding(
        &self,
        m: &IntersectionCurve<N>,
        range: [N; 2],
        ends: Option<[usize; 2]>,
        predicates: &Predicates,
    ) -> Vec<usize> {
        let mut carriers = m.carriers.clone();
        let Some([a, b]) = ends.map(|ends| ends.map(|v| &self.corners[v])) else {
            return carriers;
        };
        let is_on = |corner: &VertexCandidate<N>, c: usize| {
            corner.is_on(c) || predicates.within(self.carriers[c].distance(&corner.point))
        };
        let mut either = [&a.carriers[..], &b.carriers].concat();
        either.sort_unstable();
        either.dedup();
        let held = either.into_iter().filter(|&c| {
            !m.carriers.contains(&c)
                && is_on(a, c)
                && is_on(b, c)
                && lies_on(&m.curve, range, &self.carriers[c], predicates.resolution())
        });
        carriers.extend(held);
        carriers.sort_unstable();
        carriers
    }
}

impl<N: Float> EdgeCandidate<N> {
    /// The length over which directions are compared: the size of its curve.
    pub(super) fn reach(&self, arrangement: &Arrangement<N>) -> N {
        N::from_f64(arrangement.meetings[self.meeting].bounds.diagonal())
    }

    /// Whether two pieces have at least two common carriers.
    fn shares_two(&self, other: &Self) -> bool {
        let shared = self.carriers.iter().filter(|c| other.carriers.contains(c));
        shared.count() > 1
    }

    /// Adds the carriers and tangencies of a copy.
    fn add(&mut self, copy: &EdgeCandidate<N>) {
        self.tangent.extend(&copy.tangent);
        self.crossing.extend(&copy.crossing);
        self.carriers.extend(&copy.carriers);
        self.carriers.sort_unstable();
        self.carriers.dedup();
    }

    /// Moves a piece to another copy of its curve, so that it can be joined to the pieces there.
    fn move_to(&mut self, home: usize, arrangement: &Arrangement<N>) {
        let Some([a, b]) = self.ends else { return };
        let own = &arrangement.meetings[self.meeting].curve;
        let curve = &arrangement.meetings[home].curve;
        let middle = N::HALF * (self.range[0] + self.range[1]);
        let at = |v: usize| curve.parameter(&arrangement.corners[v].point);
        let (mut lo, mut hi, t) = (at(a), at(b), curve.parameter(&own.point(middle)));
        if own.tangent(middle).dot(&curve.tangent(t)).is_below_zero() {
            (lo, hi) = (hi, lo);
            self.ends = Some([b, a]);
        }
        hi = curve.in_cycle(hi, lo);
        if let (true, Some(cycle)) = (hi.is_exactly(lo), curve.cycle()) {
            hi += cycle;
        }
        self.range = [lo, hi];
        self.meeting = home;
    }
}

/// The parts between consecutive cuts. The parts of an open curve before the first and after the
/// last cut are outside one of the faces' boxes.
fn spans<N: Float>(m: &IntersectionCurve<N>) -> Vec<Span<N>> {
    if m.cuts.is_empty() {
        let (range, ends) = (m.range, None);
        return if m.closed {
            vec![Span { range, ends }]
        } else {
            Vec::new()
        };
    }
    let between = |c: &[Cut<N>]| Span {
        range: [c[0].t, c[1].t],
        ends: Some([c[0].vertex, c[1].vertex]),
    };
    let mut spans: Vec<Span<N>> = m.cuts.windows(2).map(between).collect();
    if m.closed {
        let (first, last) = (m.cuts[0], m.cuts[m.cuts.len() - 1]);
        let period = m.range[1] - m.range[0];
        spans.push(Span {
            range: [last.t, first.t + period],
            ends: Some([last.vertex, first.vertex]),
        });
    }
    let length = |r: &[N; 2]| r[1] - r[0];
    let short = length(&m.range) * N::ROUNDING;
    spans.retain(|span| length(&span.range).is_beyond(short));
    spans
}

/// Whether a curve passes through a point within a range.
fn passes<N: Float>(
    curve: &Curve<N>,
    range: [N; 2],
    p: &Point3<N>,
    predicates: &Predicates,
) -> bool {
    let t = curve.in_cycle(curve.parameter(p), range[0]);
    // Two pieces between the same corners in the same carriers coincide or are far from each other.
    t.lies_in(range) && is_same_place(&curve.point(t), p, predicates)
}
