//! Classification of distances by the part's one resolution.

use super::{CLOSE, CertifiedDistance, CloseCall, CoincidencePolicy, DecisionStats, Side};
use crate::concurrency;
use crate::number::float::Float;
use crate::number::rational::{Rational, from_f64};
use crate::number::rational_interval::RationalInterval;
use dashu::base::BitTest;
use std::cell::RefCell;

/// The precisions tried in turn, in bits.
const PRECISIONS: [usize; 4] = [128, 256, 512, 1024];

/// The largest number of bits spent on proving a zero.
const PROVABLE: usize = 1 << 17;

/// How a decision was reached.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Effort {
    Filter,
    MoreBits,
    /// The separation bound proves that the value is zero.
    Proof,
    /// The value comes from a construction, which is proven where it is used.
    Construction,
    /// The value is within the resolution; nothing more is known.
    Assumption,
}

/// The side of a distance in [lo, hi], or `None` if the range is inconclusive. The resolution is
/// [below, resolution].
fn side_of<N: PartialOrd>(lo: N, hi: N, resolution: N, below: N) -> Option<Side> {
    if lo > resolution {
        Some(Side::Outside)
    } else if hi < below {
        Some(Side::Inside)
    } else if lo >= below && hi <= resolution {
        Some(Side::On)
    } else {
        None
    }
}

/// The side of a distance within the resolution: `On` only if it is zero, where that can be
/// determined.
fn proven_side(distance: &impl CertifiedDistance) -> SideByEffort {
    let Some(bits) = distance.separation() else {
        return SideByEffort::new(Side::On, Effort::Construction);
    };
    if bits > PROVABLE {
        return SideByEffort::new(Side::On, Effort::Assumption);
    }
    let bounds = distance.refined(bits + GUARD);
    match bounds.as_ref().and_then(RationalInterval::ends) {
        Some([lo, _]) if *lo > Rational::ZERO => SideByEffort::new(Side::Outside, Effort::MoreBits),
        Some([_, hi]) if *hi < Rational::ZERO => SideByEffort::new(Side::Inside, Effort::MoreBits),
        Some([lo, hi]) if is_below(&(hi - lo), bits) => SideByEffort::new(Side::On, Effort::Proof),
        _ => SideByEffort::new(Side::On, Effort::Assumption),
    }
}

/// A side, and what determined it.
struct SideByEffort {
    side: Side,
    effort: Effort,
}

impl SideByEffort {
    fn new(side: Side, effort: Effort) -> Self {
        Self { side, effort }
    }
}

/// A decision that is counted.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// The side.
    pub side: Side,
    /// The close call, if it is one.
    pub call: Option<CloseCall>,
}

/// Whether a non-negative number is less than 2^-`bits`.
fn is_below(x: &Rational, bits: usize) -> bool {
    x.is_zero() || x.numerator().bit_len() + bits < x.denominator().bit_len()
}

/// The bits beyond a separation bound that rounding may use up.
const GUARD: usize = 128;

/// Classifies distances by the part's one resolution, and counts the decisions.
#[derive(Debug)]
pub struct Predicates {
    resolution: f64,
    zeros: CoincidencePolicy,
    decisions: RefCell<DecisionStats>,
    doubts: RefCell<Vec<CloseCall>>,
}

/// What predicates decide by: the resolution and the coincidence policy. Unlike predicates it can be
/// shared by threads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DecisionRule {
    resolution: f64,
    zeros: CoincidencePolicy,
}

impl DecisionRule {
    /// Predicates without a decision.
    pub fn predicates(self) -> Predicates {
        Predicates {
            zeros: self.zeros,
            ..Predicates::new(self.resolution)
        }
    }
}

impl Predicates {
    /// The predicates with a resolution, a distance in the part's unit.
    pub fn new(resolution: f64) -> Self {
        Self {
            resolution,
            zeros: CoincidencePolicy::ByResolution,
            decisions: RefCell::default(),
            doubts: RefCell::default(),
        }
    }

    /// The predicates that require a proof of zero for what lies within `resolution`.
    pub fn exact(resolution: f64) -> Self {
        Self {
            zeros: CoincidencePolicy::Exact,
            ..Self::new(resolution)
        }
    }

    /// Whether zeros must be proven.
    pub fn is_exact(&self) -> bool {
        self.zeros == CoincidencePolicy::Exact
    }

    /// The resolution, a distance in the part's unit.
    pub fn resolution<N: Float>(&self) -> N {
        N::from_f64(self.resolution)
    }

    /// The close-call distance, 100 times the resolution. Pairs farther apart neither coincide nor
    /// are close calls, so they need no decision.
    pub fn reach<N: Float>(&self) -> N {
        N::from_f64(self.resolution * CLOSE)
    }

    /// The side on which the signed `distance` lies; `place` is where it was measured. Lists a
    /// close call.
    pub fn classify(
        &self,
        question: &'static str,
        distance: impl CertifiedDistance,
        place: [f64; 3],
    ) -> Side {
        let Decision { side, call } = self.decide(question, distance, place);
        call.into_iter().for_each(|call| self.list(call));
        side
    }

    /// Classifies as [`Self::classify`] does, for a point that two things may share. A close call
    /// concerns that point only.
    pub(crate) fn classify_at_point(
        &self,
        question: &'static str,
        distance: impl CertifiedDistance,
        place: [f64; 3],
    ) -> Side {
        let Decision { side, call } = self.decide(question, distance, place);
        let local = |call| CloseCall {
            local: true,
            ..call
        };
        call.into_iter().for_each(|call| self.list(local(call)));
        side
    }

    /// Decides without listing. The decision is counted, but a close call is not listed: the caller
    /// determines whether anything depends on it.
    pub fn decide(
        &self,
        question: &'static str,
        distance: impl CertifiedDistance,
        place: [f64; 3],
    ) -> Decision {
        let range = distance.range();
        let mut found = match side_of(range.lo, range.hi, self.resolution, -self.resolution) {
            Some(side) => SideByEffort::new(side, Effort::Filter),
            None => SideByEffort::new(self.refined_side(&distance), Effort::MoreBits),
        };
        if found.side == Side::On && self.is_exact() {
            found = proven_side(&distance);
            if found.side != Side::On {
                self.record_unproven(question, place, range.mid());
            }
        }
        let SideByEffort { side, effort } = found;
        self.count(side, effort);
        let distance = range.mid();
        let size = distance.abs();
        let is_close = size * CLOSE > self.resolution && size < self.reach();
        let call = is_close.then_some(CloseCall {
            question,
            place,
            distance,
            local: false,
        });
        Decision { side, call }
    }

    /// Lists a close call.
    pub fn list(&self, call: CloseCall) {
        self.decisions.borrow_mut().close_calls.push(call);
    }

    /// New predicates with the same resolution and no decisions.
    pub fn another(&self) -> Self {
        self.rule().predicates()
    }

    /// What they decide by.
    pub fn rule(&self) -> DecisionRule {
        DecisionRule {
            resolution: self.resolution,
            zeros: self.zeros,
        }
    }

    /// The results of `work` on every item, in order, as of [`concurrency::map`]. Each item has
    /// predicates of its own. The counts are added, and the close calls listed, in the order of the
    /// items.
    pub fn map<T: Sync, R: Send>(
        &self,
        items: &[T],
        grain: usize,
        work: impl Fn(&T, &Self) -> R + Sync,
    ) -> Vec<R> {
        let rule = self.rule();
        let results = concurrency::map(items, grain, |item| {
            let own = rule.predicates();
            (work(item, &own), own)
        });
        let taken = results.into_iter().map(|(result, own)| {
            self.take(own).into_iter().for_each(|call| self.list(call));
            result
        });
        taken.collect()
    }

    /// Records a pair within the resolution that is proven not to coincide.
    pub(crate) fn record_unproven(&self, question: &'static str, place: [f64; 3], distance: f64) {
        self.doubts.borrow_mut().push(CloseCall {
            question,
            place,
            distance,
            local: false,
        });
    }

    /// The first recorded pair within the resolution that is proven not to coincide.
    pub fn first_unproven(&self) -> Option<CloseCall> {
        self.doubts.borrow().first().cloned()
    }

    /// Adds to the count of proven zeros.
    pub fn count_proven(&self, zeros: u64) {
        self.decisions.borrow_mut().exact += zeros;
    }

    /// Adds to the count of zeros known to the resolution only.
    pub fn count_assumed(&self, zeros: u64) {
        self.decisions.borrow_mut().coincident += zeros;
    }

    /// Adds the counts of `other` and returns its close calls, not yet listed.
    pub fn take(&self, other: Self) -> Vec<CloseCall> {
        self.doubts.borrow_mut().extend(other.doubts.into_inner());
        let other = other.decisions.into_inner();
        let mut decisions = self.decisions.borrow_mut();
        decisions.filtered += other.filtered;
        decisions.refined += other.refined;
        decisions.exact += other.exact;
        decisions.coincident += other.coincident;
        other.close_calls
    }

    /// Whether two things `distance` apart coincide.
    pub fn coincide(
        &self,
        question: &'static str,
        distance: impl CertifiedDistance,
        place: [f64; 3],
    ) -> bool {
        self.classify(question, distance, place) == Side::On
    }

    /// The side by more bits. A distance that cannot be distinguished from the edge of the
    /// resolution counts as coincident.
    fn refined_side(&self, distance: &impl CertifiedDistance) -> Side {
        let Some(resolution) = from_f64(self.resolution) else {
            return Side::On;
        };
        let below = -resolution.clone();
        for bits in PRECISIONS {
            let enclosure = distance.refined(bits);
            let Some([lo, hi]) = enclosure.as_ref().and_then(RationalInterval::ends) else {
                continue;
            };
            if let Some(side) = side_of(lo, hi, &resolution, &below) {
                return side;
            }
        }
        Side::On
    }

    /// Whether `distance` is within the resolution, without counting: for searches that evaluate
    /// many candidates before one decision.
    pub fn within<N: Float>(&self, distance: N) -> bool {
        distance.abs() <= self.resolution()
    }

    /// Whether `distance` would coincide or be a close call: for searches that can choose another
    /// candidate.
    pub fn is_close<N: Float>(&self, distance: N) -> bool {
        distance.abs() < self.reach()
    }

    fn count(&self, side: Side, effort: Effort) {
        let mut decisions = self.decisions.borrow_mut();
        match (side, effort) {
            (_, Effort::Construction) => {}
            (_, Effort::Proof) => decisions.exact += 1,
            (_, Effort::MoreBits) => decisions.refined += 1,
            (Side::On, _) | (_, Effort::Assumption) => decisions.coincident += 1,
            (_, Effort::Filter) => decisions.filtered += 1,
        }
    }

    /// The decisions so far. Close calls of the same question at the same place are listed once.
    pub fn decisions(&self) -> DecisionStats {
        let mut decisions = self.decisions.borrow().clone();
        let mut kept: Vec<CloseCall> = Vec::new();
        for call in decisions.close_calls {
            let again = kept.iter().any(|k| {
                k.question == call.question
                    && k.place
                        .iter()
                        .zip(call.place)
                        .all(|(a, b)| (a - b).abs() <= CLOSE * self.resolution)
            });
            if !again {
                kept.push(call);
            }
        }
        decisions.close_calls = kept;
        decisions
    }
}
