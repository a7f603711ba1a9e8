//! The one place that decides signs and coincidence.
//!
//! Every question that shapes topology ends here as a distance between geometric things, in the
//! part's unit, and leaves as an enum. What lies within the band of the part's one resolution
//! coincides; what lies outside is apart, by its certified sign. A distance within a hundred times
//! the band on either side of it is a close call and is listed.
//!
//! A relation between two surfaces is a [`Distance`] that is known to more than one precision: its
//! range in doubles tells nearly always; where the edge of the band lies in the range, ranges of
//! growing precision do.

use super::enclosure::Enclosure;
use super::interval::Interval;
use super::precision::Number;
use super::rational::{Rational, from_f64, to_f64};
use super::separation::Separation;
use dashu::base::BitTest;
use std::cell::RefCell;

/// The factor on either side of the band within which a decision is a close call.
pub(crate) const CLOSE: f64 = 100.0;

/// The default resolution: this times the size of the part.
pub const RELATIVE_RESOLUTION: f64 = 1e-11;

/// The finest resolution of numbers of 237 bits, in terms of the part's size: of what a description
/// says in numbers of a few dozen digits, what lies nearer is one.
pub const FINEST_RESOLUTION: f64 = 1e-45;

/// The relative rounding error allowed to a short chain of operations on doubles.
pub const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The side of something that a point lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Side {
    /// Within the surface: the negative side.
    Inside,
    /// On the surface, within the resolution.
    On,
    /// Outside the surface: the positive side.
    Outside,
}

impl Side {
    /// The side seen with the surface turned over.
    pub fn flipped(self) -> Self {
        match self {
            Self::Inside => Self::Outside,
            Self::On => Self::On,
            Self::Outside => Self::Inside,
        }
    }
}

/// What counts as zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Zeros {
    /// What lies within the resolution.
    #[default]
    ByResolution,
    /// What is zero, and nothing else.
    Exact,
}

/// A decision that was closer than a hundred to one.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct CloseCall {
    /// What was asked.
    pub question: &'static str,
    /// Where, in the part's frame and unit.
    pub place: [f64; 3],
    /// The distance that decided, in the part's unit.
    pub distance: f64,
    /// Whether it concerns nothing but the place: else all of what was asked about.
    pub local: bool,
}

/// How the decisions of one evaluation were made.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Decisions {
    /// Settled by intervals of doubles.
    pub filtered: u64,
    /// Settled with more bits than doubles have, either way.
    pub refined: u64,
    /// Settled by an exact zero test.
    pub exact: u64,
    /// Taken as coincident by the resolution.
    pub coincident: u64,
    /// Closer than a hundred to one, in the order met.
    pub close_calls: Vec<CloseCall>,
}

/// A signed distance between geometric things, in the part's unit.
pub trait Distance {
    /// A certified range, in doubles.
    fn range(&self) -> Interval;

    /// A certified range reckoned to so many bits; none where no more is known.
    fn refined(&self, bits: usize) -> Option<Enclosure>;

    /// The number of bits after the point from which on a distance that is still zero is zero; none
    /// where no such bound is known.
    fn separation(&self) -> Option<usize> {
        None
    }
}

/// A distance that is a construction's: taken at its word.
impl<N: Number> Distance for N {
    fn range(&self) -> Interval {
        Interval::point(self.rounded())
    }

    fn refined(&self, _bits: usize) -> Option<Enclosure> {
        None
    }
}

/// A distance that is known without rounding.
impl Distance for &Rational {
    fn range(&self) -> Interval {
        let nearest = to_f64(self);
        Interval::around(nearest, nearest.abs() * f64::EPSILON)
    }

    fn refined(&self, bits: usize) -> Option<Enclosure> {
        Some(Enclosure::exact((*self).clone(), bits))
    }

    fn separation(&self) -> Option<usize> {
        Separation::exact((*self).clone()).bits()
    }
}

/// The precisions that are tried, in bits.
const PRECISIONS: [usize; 4] = [128, 256, 512, 1024];

/// Zeros that would take more bits are not proven.
const PROVABLE: usize = 1 << 17;

/// How a decision was reached.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Effort {
    Filter,
    MoreBits,
    /// By the bits from which on it can be nothing but zero.
    Proof,
    /// A construction says so, which is proven where it is used.
    Construction,
    /// No more than that is known.
    Assumption,
}

/// The side of a distance in [lo, hi], where the range tells: `band` and `below` are the two edges of
/// the band.
fn side_of<N: PartialOrd>(lo: N, hi: N, band: N, below: N) -> Option<Side> {
    if lo > band {
        Some(Side::Outside)
    } else if hi < below {
        Some(Side::Inside)
    } else if lo >= below && hi <= band {
        Some(Side::On)
    } else {
        None
    }
}

/// The side of a distance within the band: on it only if it is zero, where that can be told.
fn proven_side(distance: &impl Distance) -> (Side, Effort) {
    let Some(bits) = distance.separation() else {
        return (Side::On, Effort::Construction);
    };
    if bits > PROVABLE {
        return (Side::On, Effort::Assumption);
    }
    let bounds = distance.refined(bits + GUARD);
    match bounds.as_ref().and_then(Enclosure::ends) {
        Some([lo, _]) if *lo > Rational::ZERO => (Side::Outside, Effort::MoreBits),
        Some([_, hi]) if *hi < Rational::ZERO => (Side::Inside, Effort::MoreBits),
        Some([lo, hi]) if is_below(&(hi - lo), bits) => (Side::On, Effort::Proof),
        _ => (Side::On, Effort::Assumption),
    }
}

/// Whether a number that is not negative is less than 2 to the power of -`bits`.
fn is_below(x: &Rational, bits: usize) -> bool {
    x.is_zero() || x.numerator().bit_len() + bits < x.denominator().bit_len()
}

/// The bits beyond a bound that rounding may take.
const GUARD: usize = 128;

/// Decides by the part's one resolution, and keeps count.
#[derive(Debug)]
pub struct Judge {
    band: f64,
    zeros: Zeros,
    decisions: RefCell<Decisions>,
    doubts: RefCell<Vec<CloseCall>>,
}

impl Judge {
    /// A judge whose resolution is `band`, a distance in the part's unit.
    pub fn new(band: f64) -> Self {
        Self {
            band,
            zeros: Zeros::ByResolution,
            decisions: RefCell::default(),
            doubts: RefCell::default(),
        }
    }

    /// A judge who has what lies within `band` proven to be zero.
    pub fn exact(band: f64) -> Self {
        Self {
            zeros: Zeros::Exact,
            ..Self::new(band)
        }
    }

    /// Whether zeros are proven.
    pub fn proves(&self) -> bool {
        self.zeros == Zeros::Exact
    }

    /// The resolution, a distance in the part's unit.
    pub fn band<N: Number>(&self) -> N {
        N::of(self.band)
    }

    /// What is no further apart than this coincides, or is a close call: only what is further apart
    /// need not be asked about.
    pub fn reach<N: Number>(&self) -> N {
        N::of(self.band * CLOSE)
    }

    /// The side on which the signed `distance` lies; `place` is where it was measured.
    pub fn side(&self, question: &'static str, distance: impl Distance, place: [f64; 3]) -> Side {
        let (side, call) = self.decide(question, distance, place);
        call.into_iter().for_each(|call| self.list(call));
        side
    }

    /// The same of a point that the two things may have in common: it concerns nothing else.
    pub fn contact(
        &self,
        question: &'static str,
        distance: impl Distance,
        place: [f64; 3],
    ) -> Side {
        let (side, call) = self.decide(question, distance, place);
        let local = |call| CloseCall {
            local: true,
            ..call
        };
        call.into_iter().for_each(|call| self.list(local(call)));
        side
    }

    /// The side, and the close call that it may be, counted but not yet listed: for who knows
    /// whether anything depends on it.
    pub fn decide(
        &self,
        question: &'static str,
        distance: impl Distance,
        place: [f64; 3],
    ) -> (Side, Option<CloseCall>) {
        let range = distance.range();
        let (mut side, mut effort) = match side_of(range.lo, range.hi, self.band, -self.band) {
            Some(side) => (side, Effort::Filter),
            None => (self.refined_side(&distance), Effort::MoreBits),
        };
        if side == Side::On && self.proves() {
            (side, effort) = proven_side(&distance);
            if side != Side::On {
                self.doubt(question, place, range.mid());
            }
        }
        self.count(side, effort);
        let distance = range.mid();
        let size = distance.abs();
        let is_close = size * CLOSE > self.band && size < self.reach();
        let call = is_close.then_some(CloseCall {
            question,
            place,
            distance,
            local: false,
        });
        (side, call)
    }

    /// Lists a close call.
    pub fn list(&self, call: CloseCall) {
        self.decisions.borrow_mut().close_calls.push(call);
    }

    /// Another judge of the same resolution, who has decided nothing yet.
    pub fn another(&self) -> Self {
        Self {
            zeros: self.zeros,
            ..Self::new(self.band)
        }
    }

    /// Notes what lies within the resolution and is proven to be apart.
    pub fn doubt(&self, question: &'static str, place: [f64; 3], distance: f64) {
        self.doubts.borrow_mut().push(CloseCall {
            question,
            place,
            distance,
            local: false,
        });
    }

    /// The first of what lies within the resolution and is proven to be apart.
    pub fn first_doubt(&self) -> Option<CloseCall> {
        self.doubts.borrow().first().cloned()
    }

    /// Counts zeros that were proven.
    pub fn count_proven(&self, zeros: u64) {
        self.decisions.borrow_mut().exact += zeros;
    }

    /// Counts zeros of which no more is known than the resolution.
    pub fn count_assumed(&self, zeros: u64) {
        self.decisions.borrow_mut().coincident += zeros;
    }

    /// Takes over what another judge has counted, and gives the close calls, not yet listed.
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
        distance: impl Distance,
        place: [f64; 3],
    ) -> bool {
        self.side(question, distance, place) == Side::On
    }

    /// The side by more bits. What cannot be told from the edge of the band lies on it, and
    /// coincides.
    fn refined_side(&self, distance: &impl Distance) -> Side {
        let Some(band) = from_f64(self.band) else {
            return Side::On;
        };
        let below = -band.clone();
        for bits in PRECISIONS {
            let enclosure = distance.refined(bits);
            let Some([lo, hi]) = enclosure.as_ref().and_then(Enclosure::ends) else {
                continue;
            };
            if let Some(side) = side_of(lo, hi, &band, &below) {
                return side;
            }
        }
        Side::On
    }

    /// Whether `distance` is within the band, without counting it: for searches that ask many
    /// times before one decision is made.
    pub fn within<N: Number>(&self, distance: N) -> bool {
        distance.abs() <= self.band()
    }

    /// Whether a decision made on `distance` would be a close call, or coincide: for a search that
    /// may look elsewhere.
    pub fn is_close<N: Number>(&self, distance: N) -> bool {
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

    /// The decisions so far; the close calls of one question at one place stand once.
    pub fn decisions(&self) -> Decisions {
        let mut decisions = self.decisions.borrow().clone();
        let mut kept: Vec<CloseCall> = Vec::new();
        for call in decisions.close_calls {
            let again = kept.iter().any(|k| {
                k.question == call.question
                    && k.place
                        .iter()
                        .zip(call.place)
                        .all(|(a, b)| (a - b).abs() <= CLOSE * self.band)
            });
            if !again {
                kept.push(call);
            }
        }
        decisions.close_calls = kept;
        decisions
    }
}
