//! Three equations in three unknowns: proposed starts converge to roots, and equal roots are
//! merged.

use super::polynomial::{across, descent};
use nalgebra::{Matrix3, Vector3};

/// The greatest residual of a root.
const SOLVED: f64 = 1.0 / (1u64 << 42) as f64;
/// A residual below this is rounding error.
const ROUNDED: f64 = 1.0 / (1u64 << 51) as f64;
/// The factor by which rounding may change a residual.
const NOISE: f64 = 4.0;
/// Unknowns with a greater difference than this are never the same.
pub const DISTINCT: f64 = 1.0 / (1 << 10) as f64;
/// Steps of Newton's method: at a double root each gains one binary digit.
const ROUNDS: usize = 64;

/// The values of three equations, and their derivatives by a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linearised {
    /// The values.
    pub value: Vector3<f64>,
    /// The derivatives.
    pub slope: Matrix3<f64>,
}

/// Three equations.
pub trait Equations {
    /// The type of the unknowns.
    type Unknown: Clone;

    /// The values that are to be zero, and their derivatives by a step.
    fn value(&self, at: &Self::Unknown) -> Linearised;

    /// The residual, scaled so that [`SOLVED`] applies to all equations.
    fn miss(&self, at: &Self::Unknown) -> f64;

    /// The unknowns after a step is subtracted.
    fn stepped(&self, at: &Self::Unknown, step: &Vector3<f64>) -> Self::Unknown;

    /// The midpoint of two unknowns that may be the same root; none for two that are not.
    fn middle(&self, a: &Self::Unknown, b: &Self::Unknown) -> Option<Self::Unknown>;

    /// The root near a start, if there is one.
    fn solution(&self, start: Self::Unknown) -> Option<Self::Unknown> {
        let mut at = start;
        let mut known = self.value(&at);
        let mut damping = None;
        for _ in 0..ROUNDS {
            let Some(step) = descent(&known.slope, &known.value, &mut damping) else {
                break;
            };
            let next = self.stepped(&at, &step);
            let stepped = self.value(&next);
            if stepped.value.norm() < known.value.norm() {
                (at, known, damping) = (next, stepped, None);
            }
        }
        (self.miss(&at) <= SOLVED).then_some(at)
    }

    /// Adds a root, unless it equals a known one. Two roots are equal if the equations are
    /// satisfied as well between them.
    fn add(&self, root: Self::Unknown, found: &mut Vec<Self::Unknown>) {
        for other in found.iter_mut() {
            let Some(middle) = self.middle(other, &root) else {
                continue;
            };
            let Linearised { value, slope } = self.value(&middle);
            let middle = self.stepped(&middle, &across(&slope, &value));
            let ends = [self.miss(other), self.miss(&root)];
            let between = self.miss(&middle);
            if between > NOISE * ends[0].max(ends[1]).max(ROUNDED) {
                continue;
            }
            // If rounding has split a double root, the midpoint is nearest to it.
            if between <= NOISE * ends[0].min(ends[1]).max(ROUNDED) {
                *other = middle;
            } else if ends[1] < ends[0] {
                *other = root;
            }
            return;
        }
        found.push(root);
    }
}
