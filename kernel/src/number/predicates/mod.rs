//! The predicates: the only place that decides signs and coincidence.
//!
//! Every question that shapes topology is put as a distance between geometric objects, in the
//! part's unit, and is answered by an enum. Distances within the part's one resolution coincide.
//! Distances outside it are classified by their certified sign. A distance within a factor of 100
//! of the resolution, on either side, is a close call and is listed.
//!
//! A relation between two surfaces is a [`CertifiedDistance`], which can be evaluated to several
//! precisions. Its f64 range nearly always decides. Where the edge of the resolution lies in that
//! range, ranges of growing precision decide.
//!
//! Signs and limits of computed numbers are tested by [`Compare`] and [`Side::new`]. Code that
//! decides never compares numbers by operators.

mod classify;
mod compare;
mod distance;

pub use classify::{Decision, DecisionRule, Predicates};
pub use compare::Compare;
pub use distance::CertifiedDistance;

use super::float::Float;

/// The factor on either side of the resolution within which a decision is a close call.
pub(crate) const CLOSE: f64 = 100.0;

/// The default resolution, relative to the part's size.
pub const RELATIVE_RESOLUTION: f64 = 1e-11;

/// The finest resolutions of numbers of 106 and of 237 bits, relative to the part's size. Points of
/// surfaces that meet at very small angles are known to these. Descriptions give numbers to a few
/// dozen digits, so closer objects are one.
pub(super) const FINEST_OF_106_BITS: f64 = 1e-21;
pub(super) const FINEST_OF_237_BITS: f64 = 1e-45;

/// The precisions of points of tangency in f64 and in numbers of 106 and of 237 bits: square roots
/// of their rounding, with a margin.
pub(super) const TANGENCY: f64 = 1e-6;
pub(super) const TANGENCY_OF_106_BITS: f64 = 1e-12;
pub(super) const TANGENCY_OF_237_BITS: f64 = 3e-23;

/// The greatest distance by which rounding to f64 may move an edge off its faces for the part to have
/// views, relative to the part's size.
pub const GREATEST_ROUNDING_GAP: f64 = 1e-8;

/// The relative rounding error allowed to a short chain of operations on f64 values.
pub const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The side of a surface on which a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Side {
    /// Inside the surface: the negative side.
    Inside,
    /// On the surface, within the resolution.
    On,
    /// Outside the surface: the positive side.
    Outside,
}

impl Side {
    /// The side of a signed distance. A distance of at most `within` is on the surface, and so is
    /// NaN.
    #[inline]
    pub fn new<N: Float>(distance: N, within: N) -> Self {
        if distance > within {
            Self::Outside
        } else if distance < -within {
            Self::Inside
        } else {
            Self::On
        }
    }
}

/// What counts as zero.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum CoincidencePolicy {
    /// A value within the resolution.
    #[default]
    ByResolution,
    /// Only a value that is zero.
    Exact,
}

/// A decision within a factor of 100 of the resolution.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct CloseCall {
    /// The question.
    pub question: &'static str,
    /// Where, in the part's frame and unit.
    pub place: [f64; 3],
    /// The distance on which the decision was made, in the part's unit.
    pub distance: f64,
    /// Whether it concerns this place only, rather than the two objects as a whole.
    pub local: bool,
}

/// Statistics of the decisions of one evaluation.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct DecisionStats {
    /// Decided by f64 intervals.
    pub filtered: u64,
    /// Decided with more bits than f64 has, whatever the result.
    pub refined: u64,
    /// Decided by an exact zero test.
    pub exact: u64,
    /// Counted as coincident by the resolution.
    pub coincident: u64,
    /// Decisions within a factor of 100 of the resolution, in order of occurrence.
    pub close_calls: Vec<CloseCall>,
}

impl DecisionStats {
    /// Adds the decisions of another evaluation, after these.
    pub fn add(&mut self, other: &Self) {
        self.filtered += other.filtered;
        self.refined += other.refined;
        self.exact += other.exact;
        self.coincident += other.coincident;
        self.close_calls.extend_from_slice(&other.close_calls);
    }
}
