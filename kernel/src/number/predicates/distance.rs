//! Signed distances with certified ranges.

use crate::number::float::Float;
use crate::number::interval::Interval;
use crate::number::rational::{Rational, to_f64};
use crate::number::rational_interval::RationalInterval;
use crate::number::separation_bound::SeparationBound;

/// A signed distance between geometric objects, in the part's unit.
pub trait CertifiedDistance {
    /// A certified range, in f64.
    fn range(&self) -> Interval;

    /// A certified range computed to so many bits; `None` if no more is known.
    fn refined(&self, bits: usize) -> Option<RationalInterval>;

    /// The separation bound: the number of bits after the binary point that prove a value to be
    /// zero. `None` if no bound is known.
    fn separation(&self) -> Option<usize> {
        None
    }
}

/// A distance computed by a construction: it is taken as exact.
impl<N: Float> CertifiedDistance for N {
    fn range(&self) -> Interval {
        Interval::point(self.rounded())
    }

    fn refined(&self, _bits: usize) -> Option<RationalInterval> {
        None
    }
}

/// An exact distance.
impl CertifiedDistance for &Rational {
    fn range(&self) -> Interval {
        let nearest = to_f64(self);
        Interval::around(nearest, nearest.abs() * f64::EPSILON)
    }

    fn refined(&self, bits: usize) -> Option<RationalInterval> {
        Some(RationalInterval::exact((*self).clone(), bits))
    }

    fn separation(&self) -> Option<usize> {
        SeparationBound::exact((*self).clone()).bits()
    }
}
