//! Set operations as operators.

use super::Expression;
use premio_csg::tree::Operation;
use std::iter::Sum;
use std::ops::{Add, BitAnd, Sub};

/// The union.
impl Add for Expression {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::operation(Operation::Union, [self, other])
    }
}

/// The difference.
impl Sub for Expression {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::operation(Operation::Difference, [self, other])
    }
}

/// The intersection.
impl BitAnd for Expression {
    type Output = Self;

    fn bitand(self, other: Self) -> Self {
        Self::operation(Operation::Intersection, [self, other])
    }
}

/// The union of all.
impl Sum for Expression {
    fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
        Self::operation(Operation::Union, parts)
    }
}
