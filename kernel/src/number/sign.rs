//! The one place that decides signs and coincidence.
//!
//! Every question that shapes topology ends here as a distance between geometric things, in the
//! part's unit, and leaves as an enum. What lies within the band of the part's one resolution
//! coincides; what lies outside is apart, by its certified sign. A distance within a hundred times
//! the band on either side of it is a close call and is listed.

use std::cell::RefCell;

/// The factor on either side of the band within which a decision is a close call.
pub(crate) const CLOSE: f64 = 100.0;

/// The default resolution: this times the size of the part.
pub const RELATIVE_RESOLUTION: f64 = 1e-11;

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
    /// What is proven to be zero by exact arithmetic, and nothing else.
    Proven,
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
}

/// How the decisions of one evaluation were made.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Decisions {
    /// Settled by intervals of doubles.
    pub filtered: u64,
    /// Settled with more bits.
    pub refined: u64,
    /// Settled by an exact zero test.
    pub exact: u64,
    /// Taken as coincident by the resolution.
    pub coincident: u64,
    /// Closer than a hundred to one, in the order met.
    pub close_calls: Vec<CloseCall>,
}

/// Decides by the part's one resolution, and keeps count.
#[derive(Debug)]
pub struct Judge {
    band: f64,
    decisions: RefCell<Decisions>,
}

impl Judge {
    /// A judge whose resolution is `band`, a distance in the part's unit.
    pub fn new(band: f64) -> Self {
        Self {
            band,
            decisions: RefCell::default(),
        }
    }

    /// The resolution, a distance in the part's unit.
    pub fn band(&self) -> f64 {
        self.band
    }

    /// What is no further apart than this coincides, or is a close call: only what is further apart
    /// need not be asked about.
    pub fn reach(&self) -> f64 {
        self.band * CLOSE
    }

    /// The side on which the signed `distance` lies; `place` is where it was measured.
    pub fn side(&self, question: &'static str, distance: f64, place: [f64; 3]) -> Side {
        self.note(question, distance, place);
        if distance.abs() <= self.band {
            Side::On
        } else if distance < 0.0 {
            Side::Inside
        } else {
            Side::Outside
        }
    }

    /// Whether two things `distance` apart coincide.
    pub fn coincide(&self, question: &'static str, distance: f64, place: [f64; 3]) -> bool {
        self.note(question, distance, place);
        distance.abs() <= self.band
    }

    /// Whether `distance` is within the band, without counting it: for searches that ask many
    /// times before one decision is made.
    pub fn within(&self, distance: f64) -> bool {
        distance.abs() <= self.band
    }

    /// Whether a decision made on `distance` would be a close call, or coincide: for a search that
    /// may look elsewhere.
    pub fn is_close(&self, distance: f64) -> bool {
        distance.abs() < self.reach()
    }

    /// Counts one decision made on `distance`.
    pub fn note(&self, question: &'static str, distance: f64, place: [f64; 3]) {
        let size = distance.abs();
        let mut decisions = self.decisions.borrow_mut();
        if size <= self.band {
            decisions.coincident += 1;
        } else {
            decisions.filtered += 1;
        }
        if size * CLOSE > self.band && size < self.reach() {
            decisions.close_calls.push(CloseCall {
                question,
                place,
                distance,
            });
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
