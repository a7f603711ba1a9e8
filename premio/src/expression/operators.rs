//! Set operations as operators.

use super::{Expression, Node};
use premio_csg::tree::Operation;
use std::iter::Sum;
use std::ops::{Add, BitAnd, Not, Sub};

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

/// The complement: everything outside. Other solids must bound the whole.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// // The outside of a bore, in a plate.
/// let plate = block(6, 4, 2) & !infinite_cylinder(1).translate([3, 2, 0]);
/// assert_eq!(plate.evaluate()?.genus(), [1]);
/// assert!((!sphere(1)).evaluate().is_err());
/// # Ok::<(), premio::Error>(())
/// ```
impl Not for Expression {
    type Output = Self;

    fn not(self) -> Self {
        self.map(|inner| Ok(Node::Complement(inner)))
    }
}

/// The union of all.
impl Sum for Expression {
    fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
        Self::operation(Operation::Union, parts)
    }
}
