//! Real roots of a smooth function on an interval, isolated with their multiplicity.
//!
//! The function is given as a jet over an interval: certified ranges of its value and of two
//! derivatives. Where the first derivative has no zero there is at most one root. Where the second
//! has none there are at most two, and the extremum between them decides: outside the resolution by
//! its certified sign, within it as a tangency. Other intervals are halved. The values are
//! distances, so the resolution is the part's.

use super::bisection::{ValueAndSlope, bisect, bisect_newton};
use super::chebyshev_model::ChebyshevModel;
use super::float::{Analytic, Float};
use super::function::Function;
use super::interval::Interval;
use super::jet::Jet;
use super::monotone_samples::{MonotoneSamples, Sample};
use super::predicates::CLOSE;
use super::probes::probes;

/// The multiplicity of a root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RootKind {
    /// A simple root.
    Simple,
    /// An even number of roots within the resolution: the graph touches zero.
    Touching,
    /// An odd number of roots, more than one, within the resolution.
    Inflected,
}

/// An isolated root, or a cluster of roots within the resolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root<N: Float = f64> {
    /// The best estimate of the parameter.
    pub t: N,
    /// Where the cluster begins.
    pub lo: N,
    /// Where the cluster ends.
    pub hi: N,
    /// The multiplicity.
    pub contact: RootKind,
    /// The least absolute value found next to the root; `None` if the root is unambiguous.
    pub margin: Option<N>,
}

/// The zeros of a function on an interval.
#[derive(Clone, Debug, PartialEq)]
pub enum Roots<N: Float = f64> {
    /// The function is within the resolution over the entire interval.
    Everywhere,
    /// The roots, and the near misses.
    At {
        /// The roots, in increasing order.
        roots: Vec<Root<N>>,
        /// Local minima of the absolute value close to zero. A slow descent to a root is not one.
        misses: Vec<NearMiss<N>>,
    },
}

impl<N: Float> Roots<N> {
    /// No root and no near miss.
    const NONE: Self = Self::At {
        roots: Vec::new(),
        misses: Vec::new(),
    };
}

/// A local minimum of a function's absolute value close to zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearMiss<N: Float = f64> {
    /// The parameter.
    pub t: N,
    /// The function's value there.
    pub value: N,
}

#[derive(Clone, Copy)]
struct Cluster<N: Float = f64> {
    lo: N,
    hi: N,
    t: N,
    kind: Kind,
    margin: Option<N>,
}

/// What is known of a cluster's best estimate.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// A root of a monotone function between opposite signs.
    Simple,
    /// The function is monotone and within the resolution.
    Level,
    /// An extremum.
    Extremum,
    /// Some point of the cluster.
    Loose,
}

/// How far beyond the range the function's sign is evaluated, as a fraction of the range.
const OUTSIDE: f64 = 1.0 / (1 << 10) as f64;

/// Hysteresis at the edge of the resolution: a function that exceeds the resolution by no more than
/// this factor counts as within it. Otherwise rounding would break one cluster into several.
const FRINGE: f64 = 1.0 + 1.0 / 64.0;

/// The relative width from which on second-order Taylor bounds are used. Most roots are isolated
/// before; next to a contact of high order halving continues, and tighter bounds pay.
const SMALL: f64 = 1.0 / 16.0;

/// The number of halvings after which, and after each doubling of which, a polynomial model of the
/// rest of the piece is tried.
const SOME: u32 = 8;

/// The number of halvings from which on a polynomial model of each part is tried.
const MANY: u32 = 64;

/// The error of a polynomial model, relative to the resolution. It is less than half of the fringe,
/// so that a function that is constant at the edge of the resolution can still be classified.
const FINE: f64 = 1.0 / 256.0;

/// A search for roots. The function is a trait object, so that the search is compiled once for all
/// functions.
struct Search<'a, N: Float> {
    f: &'a dyn Function<N>,
    resolution: N,
    /// The largest absolute value that is reported as a near miss.
    reach: N,
    floor: N,
    clusters: Vec<Cluster<N>>,
    profile: MonotoneSamples<N>,
}

/// The roots of `f` on the pieces between consecutive `breaks`, on each of which `f` is smooth. For
/// a closed curve the breaks span a whole period, and the caller identifies its ends. Near misses
/// are not searched for.
pub fn isolate<N: Float>(f: &dyn Function<N>, breaks: &[N], resolution: N) -> Roots<N> {
    // Without a limit, there is no error.
    search(f, breaks, resolution, resolution, u32::MAX).unwrap_or(Roots::NONE)
}

/// The roots, and all near misses that are close calls.
///
/// # Errors
/// The roots take too many halvings.
pub(crate) fn isolate_closely<N: Float>(
    f: &dyn Function<N>,
    breaks: &[N],
    resolution: N,
) -> Result<Roots<N>, Inseparable> {
    let most = match N::IS_DOUBLE {
        true => u32::MAX,
        false => MOST,
    };
    search(f, breaks, resolution, N::from_f64(CLOSE) * resolution, most)
}

/// A function stays so close to zero over a range, relative to its rounding error, that its roots
/// cannot be separated in reasonable time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the points of a curve close to a surface cannot be separated")]
pub struct Inseparable;

/// The most halvings of a piece in extended precision. The pieces of all named cases take fewer
/// than a hundred.
const MOST: u32 = 1 << 12;

fn search<N: Float>(
    f: &dyn Function<N>,
    breaks: &[N],
    resolution: N,
    reach: N,
    most: u32,
) -> Result<Roots<N>, Inseparable> {
    let (Some(&first), Some(&last)) = (breaks.first(), breaks.last()) else {
        return Ok(Roots::NONE);
    };
    let floor =
        (last - first).abs().max(first.abs()).max(last.abs()) * N::EPSILON * N::from_f64(64.0);
    let mut search = Search {
        f,
        resolution,
        reach,
        floor,
        clusters: Vec::new(),
        profile: MonotoneSamples::default(),
    };
    for pair in breaks.windows(2) {
        search.piece(pair[0], pair[1], most)?;
    }
    Ok(search.finish(first, last))
}

impl<N: Float> Search<'_, N> {
    fn value(&self, t: N) -> N {
        self.f.value(t)
    }

    /// A certified range of the value at a point.
    fn value_over(&self, t: N) -> Interval<N> {
        let reach = self.f.reach(Interval::point(t));
        if reach.width().is_finite() {
            reach
        } else {
            self.f.over(Interval::point(t)).v
        }
    }

    /// The ranges over an interval, or `None` if no value in it is close to zero. The cheapest
    /// bound that suffices is used: the direct one, then Taylor forms about the middle, the
    /// second-order one only for `small` intervals.
    fn unclear(&self, x: Interval<N>, small: bool) -> Option<Jet<Interval<N>>> {
        let unclear = |v: &Interval<N>| !self.is_clear(*v);
        Some(self.f.reach(x)).filter(unclear)?;
        let Jet { v, d, dd } = self.f.over(x);
        Some(v).filter(unclear)?;
        if !(d.has_zero() && d.width().is_finite()) {
            return Some(Jet { v, d, dd });
        }
        let middle = x.mid();
        let run = x - Interval::point(middle);
        let v = v.intersection(self.value_over(middle) + d * run);
        Some(v).filter(unclear)?;
        if !(small && dd.has_zero() && dd.width().is_finite()) {
            return Some(Jet { v, d, dd });
        }
        let at = self.f.over(Interval::point(middle));
        let bent = (dd * run.square()).times(0.5);
        let v = v.intersection(at.v + at.d * run + bent);
        let d = d.intersection(at.d + dd * run);
        Some(Jet { v, d, dd }).filter(|jet| unclear(&jet.v))
    }

    fn slope(&self, t: N) -> N {
        self.f.at(t).d
    }

    fn cluster(&mut self, lo: N, hi: N, t: N, kind: Kind, margin: Option<N>) {
        self.profile.mark(t, N::ZERO);
        self.clusters.push(Cluster {
            lo,
            hi,
            t,
            kind,
            margin,
        });
    }

    /// Isolates the roots in [a, b] in order, by halving with an explicit stack.
    fn piece(&mut self, a: N, b: N, most: u32) -> Result<(), Inseparable> {
        let whole = (a, b);
        let rough = self.f.roughly([a, b]);
        let mut stack = vec![whole];
        let mut halved = 0;
        while let Some((a, b)) = stack.pop() {
            let x = Interval { lo: a, hi: b };
            let small = b - a <= N::from_f64(SMALL) * (whole.1 - whole.0);
            let is_clear = rough.as_ref().is_some_and(|f| f.is_clear(x, self.reach));
            let jet = match is_clear {
                true => None,
                false => self.unclear(x, small),
            };
            if self.settles(x, jet) {
                continue;
            }
            if (a, b) == whole && self.vanishes(a, b) {
                self.cluster(a, b, x.mid(), Kind::Loose, Some(N::ZERO));
                continue;
            }
            halved += 1;
            if halved > most {
                return Err(Inseparable);
            }
            let all = halved >= SOME && halved.is_power_of_two();
            if all && !N::IS_DOUBLE && self.interpolated(a, whole.1) {
                return Ok(());
            }
            if halved > MANY && !N::IS_DOUBLE && self.interpolated(a, b) {
                continue;
            }
            stack.push((x.mid(), b));
            stack.push((a, x.mid()));
        }
        Ok(())
    }

    /// Isolates the roots in [a, b] by a polynomial model with an error far below the resolution.
    /// Returns false if there is no such model.
    fn interpolated(&mut self, a: N, b: N) -> bool {
        let Some(polynomial) =
            ChebyshevModel::new(self.f, [a, b], N::from_f64(FINE) * self.resolution)
        else {
            return false;
        };
        let mut stack = vec![(a, b)];
        while let Some((a, b)) = stack.pop() {
            let x = Interval { lo: a, hi: b };
            let jet = Some(polynomial.over(x)).filter(|jet| !self.is_clear(jet.v));
            if !self.settles(x, jet) {
                stack.push((x.mid(), b));
                stack.push((a, x.mid()));
            }
        }
        true
    }

    /// Whether the ranges over an interval classify it; the result is recorded. `jet` is `None`
    /// where no value is close to zero.
    fn settles(&mut self, x: Interval<N>, jet: Option<Jet<Interval<N>>>) -> bool {
        let (a, b, m) = (x.lo, x.hi, x.mid());
        let Some(jet) = jet else {
            self.profile.mark(m, N::INFINITY);
            return true;
        };
        let v = jet.v;
        let misses = v.lo > self.resolution || v.hi < -self.resolution;
        // Also beyond the reach: a function that is constant at the edge of the reach would be
        // halved without end.
        if misses && (v.magnitude() <= N::TWO * self.reach || b - a <= self.floor) {
            self.mark_miss(a, b);
        } else if v.magnitude() <= N::from_f64(FRINGE) * self.resolution {
            let level = !jet.d.has_zero();
            let kind = if level { Kind::Level } else { Kind::Loose };
            self.cluster(a, b, m, kind, Some(N::ZERO));
        } else if !jet.d.has_zero() {
            self.monotone(a, b);
        } else if !jet.dd.has_zero() {
            self.convex(a, b);
        } else if b - a <= self.floor || self.is_rounding(m, v) {
            self.cluster(a, b, m, Kind::Loose, Some(v.magnitude()));
        } else {
            return false;
        }
        true
    }

    /// Whether the range of the values is only their rounding, so that halving adds nothing.
    fn is_rounding(&self, middle: N, v: Interval<N>) -> bool {
        v.width() <= N::TWO * self.value_over(middle).width()
    }

    /// Whether the function is within the resolution over all of [a, b], by samples. Halving would
    /// find it, too, but halves a function that is zero down to the square root of the resolution.
    fn vanishes(&self, a: N, b: N) -> bool {
        probes().all(|part| self.value(a + (b - a) * part).abs() <= self.resolution)
    }

    /// Whether no value of the range is a root or a near miss.
    fn is_clear(&self, v: Interval<N>) -> bool {
        v.lo > self.reach || v.hi < -self.reach
    }

    /// The sign of a value: -1, 0 (within the resolution) or 1.
    fn sign(&self, value: N) -> i8 {
        if value.abs() <= self.resolution {
            0
        } else if value < N::ZERO {
            -1
        } else {
            1
        }
    }

    /// Records samples of an interval that is close to zero and has no root.
    fn mark_miss(&mut self, a: N, b: N) {
        let (da, db) = (self.slope(a), self.slope(b));
        let inside = if da * db < N::ZERO {
            bisect(a, b, da, |t| self.slope(t))
        } else {
            N::HALF * (a + b)
        };
        for t in [a, inside, b] {
            self.profile.mark(t, self.value(t));
        }
    }

    fn monotone(&mut self, a: N, b: N) {
        let (fa, fb) = (self.value(a), self.value(b));
        self.profile.mark(a, fa);
        match (self.sign(fa), self.sign(fb)) {
            (0, 0) => self.cluster(a, b, N::HALF * (a + b), Kind::Level, Some(N::ZERO)),
            (0, _) if fa * fb > N::ZERO => {
                let hi = self.limit(a, b);
                self.cluster(a, hi, a, Kind::Level, None);
            }
            (_, 0) if fa * fb > N::ZERO => {
                let lo = self.limit(b, a);
                self.cluster(lo, b, b, Kind::Level, None);
            }
            (0, _) => {
                let t = self.refine(a, b, fa);
                self.cluster(a, t, t, Kind::Simple, None);
            }
            (_, 0) => {
                let t = self.refine(a, b, fa);
                self.cluster(t, b, t, Kind::Simple, None);
            }
            (p, q) if p != q => {
                let t = self.refine(a, b, fa);
                self.cluster(t, t, t, Kind::Simple, None);
            }
            _ => {}
        }
        self.profile.mark(b, fb);
    }

    fn convex(&mut self, a: N, b: N) {
        let (da, db) = (self.slope(a), self.slope(b));
        if da * db >= N::ZERO {
            return self.monotone(a, b);
        }
        let t = bisect(a, b, da, |t| self.slope(t));
        let extremum = self.value(t);
        if self.sign(extremum) == 0 {
            let (lo, hi) = (self.limit(t, a), self.limit(t, b));
            return self.cluster(lo, hi, t, Kind::Extremum, Some(extremum.abs()));
        }
        self.monotone(a, t);
        self.monotone(t, b);
    }

    /// The point up to which the function stays within the resolution, from an extremum or an end
    /// towards `end`.
    fn limit(&self, extremum: N, end: N) -> N {
        let sign = self.value(end).signum();
        let beyond = |t: N| sign * self.value(t) - self.resolution;
        if beyond(end) <= N::ZERO {
            return end;
        }
        let (a, b) = (extremum.min(end), extremum.max(end));
        bisect(a, b, beyond(a), beyond)
    }

    /// The root in [a, b], for a monotone function of opposite signs at the ends.
    fn refine(&self, a: N, b: N, fa: N) -> N {
        bisect_newton(a, b, fa, |t| {
            let j = self.f.at(t);
            ValueAndSlope {
                value: j.v,
                slope: j.d,
            }
        })
    }

    /// Whether two clusters are one: they touch, or only rounding takes the function out of the
    /// resolution between them.
    fn is_one(&self, before: &Cluster<N>, after: &Cluster<N>) -> bool {
        before.hi >= after.lo
            || self.value(N::HALF * (before.hi + after.lo)).abs()
                <= N::from_f64(FRINGE) * self.resolution
    }

    fn finish(self, first: N, last: N) -> Roots<N> {
        let mut merged: Vec<Vec<Cluster<N>>> = Vec::new();
        for c in &self.clusters {
            match merged.last_mut() {
                Some(group) if group.last().is_some_and(|p| self.is_one(p, c)) => group.push(*c),
                _ => merged.push(vec![*c]),
            }
        }
        if let [only] = merged.as_slice()
            && only[0].lo <= first
            && only[only.len() - 1].hi >= last
            && last > first
        {
            return Roots::Everywhere;
        }
        let ends: Vec<[N; 2]> = merged
            .iter()
            .map(|g| [g[0].lo, g[g.len() - 1].hi])
            .collect();
        // The sign is unambiguous between clusters; beyond the ends of the range the function is
        // evaluated, too.
        let step = (last - first) * N::from_f64(OUTSIDE);
        let sign_between = |i: usize| {
            let left = if i == 0 { None } else { Some(ends[i - 1][1]) };
            let right = ends.get(i).map(|e| e[0]);
            let t = match (left, right) {
                (Some(l), Some(r)) => N::HALF * (l + r),
                (None, Some(r)) if r <= first => r - step,
                (None, Some(r)) => N::HALF * (first + r),
                (Some(l), None) if l >= last => l + step,
                (Some(l), None) => N::HALF * (l + last),
                (None, None) => N::HALF * (first + last),
            };
            self.value(t).signum()
        };
        let roots = merged.iter().enumerate().map(|(i, group)| {
            let crosses = sign_between(i) != sign_between(i + 1);
            self.root(group, crosses)
        });
        let roots = roots.collect();
        let turns = self.profile.turns(|t| self.value(t)).into_iter();
        let misses = turns
            .filter(|m| m.value.abs() > self.resolution && m.value.abs() < self.reach)
            .map(|Sample { t, value }| NearMiss { t, value });
        Roots::At {
            roots,
            misses: misses.collect(),
        }
    }

    /// The root of a group of adjacent clusters.
    fn root(&self, group: &[Cluster<N>], crosses: bool) -> Root<N> {
        let (lo, hi) = (group[0].lo, group[group.len() - 1].hi);
        let margin = group.iter().filter_map(|c| c.margin).reduce(N::min);
        let found = |t, contact| Root {
            t,
            lo,
            hi,
            contact,
            margin,
        };
        if crosses {
            let mut simple = group.iter().filter(|c| c.kind == Kind::Simple);
            return match (simple.next(), simple.next()) {
                (Some(c), None) => found(c.t, RootKind::Simple),
                _ if self.is_monotone(group) => found(self.crossing(lo, hi), RootKind::Simple),
                _ => found(self.inflection(lo, hi), RootKind::Inflected),
            };
        }
        let extremum = group.iter().find(|c| c.kind == Kind::Extremum);
        let t = extremum.map_or_else(|| self.balance(lo, hi, |j| j.d), |c| c.t);
        found(t, RootKind::Touching)
    }

    /// Whether the function is monotone over adjacent clusters.
    fn is_monotone(&self, group: &[Cluster<N>]) -> bool {
        let slope = |c: &Cluster<N>| self.slope(N::HALF * (c.lo + c.hi));
        let first = slope(&group[0]);
        let known = |c: &Cluster<N>| matches!(c.kind, Kind::Simple | Kind::Level);
        group.iter().all(|c| known(c) && slope(c) * first > N::ZERO)
    }

    /// The zero between the ends of a cluster; if there is none, the end with the smaller value.
    fn crossing(&self, lo: N, hi: N) -> N {
        let (a, b) = (self.value(lo), self.value(hi));
        if a * b <= N::ZERO {
            self.refine(lo, hi, a)
        } else if a.abs() < b.abs() {
            lo
        } else {
            hi
        }
    }

    /// The best estimate where a non-monotone function crosses zero in a cluster: the zero of its
    /// second derivative, if it is in the cluster.
    fn inflection(&self, lo: N, hi: N) -> N {
        let t = self.balance(lo, hi, |j| j.dd);
        if (lo..=hi).contains(&t) {
            return t;
        }
        self.crossing(lo, hi)
    }

    /// The zero of a derivative in or next to a cluster; if there is none, the point of its least
    /// absolute value.
    fn balance(&self, lo: N, hi: N, part: fn(Jet<N>) -> N) -> N {
        let g = |t: N| part(self.f.at(t));
        let middle = (N::HALF * (lo + hi), g(N::HALF * (lo + hi)));
        let mut least = middle;
        let (mut left, mut right) = ((lo, g(lo)), (hi, g(hi)));
        for _ in 0..WIDER {
            for pair in [[left, middle], [middle, right]] {
                let [(a, ga), (b, gb)] = pair;
                if ga * gb < N::ZERO {
                    return bisect(a, b, ga, g);
                }
                least = pair
                    .into_iter()
                    .fold(least, |l, m| if m.1.abs() < l.1.abs() { m } else { l });
            }
            let width = right.0 - left.0;
            left = (left.0 - width, g(left.0 - width));
            right = (right.0 + width, g(right.0 + width));
        }
        least.0
    }
}

/// How many times the surroundings of a cluster are tripled in search of a derivative's zero.
const WIDER: u32 = 4;

#[cfg(test)]
mod tests;
