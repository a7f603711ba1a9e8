//! Three equations in three unknowns: how what is proposed is drawn to a root, and which roots are one.

use super::polynomial::{across, descent};
use nalgebra::{Matrix3, Vector3};

/// A root is where equations miss by no more.
const SOLVED: f64 = 1.0 / (1u64 << 42) as f64;
/// Equations that are right to this are so but for rounding.
const ROUNDED: f64 = 1.0 / (1u64 << 51) as f64;
/// By how much rounding changes what equations miss.
const NOISE: f64 = 4.0;
/// Unknowns farther apart than this are never the same.
pub const DISTINCT: f64 = 1.0 / (1 << 10) as f64;
/// Steps of Newton's method: at a double root each gains one binary digit.
const ROUNDS: usize = 64;

/// Three equations.
pub trait Equations {
    /// What they are to be solved for.
    type Unknown: Clone;

    /// What is to be zero, and its derivatives by a step.
    fn value(&self, at: &Self::Unknown) -> (Vector3<f64>, Matrix3<f64>);

    /// How much they miss, in units of rounding that make [`SOLVED`] one for all.
    fn miss(&self, at: &Self::Unknown) -> f64;

    /// What is reached by going a step back.
    fn stepped(&self, at: &Self::Unknown, step: &Vector3<f64>) -> Self::Unknown;

    /// What is in the middle of two that may be the same; none of two that are not.
    fn middle(&self, a: &Self::Unknown, b: &Self::Unknown) -> Option<Self::Unknown>;

    /// The root near a start, if there is one.
    fn solution(&self, start: Self::Unknown) -> Option<Self::Unknown> {
        let mut at = start;
        let (mut value, mut slope) = self.value(&at);
        let mut damping = None;
        for _ in 0..ROUNDS {
            let Some(step) = descent(&slope, &value, &mut damping) else {
                break;
            };
            let next = self.stepped(&at, &step);
            let (v, s) = self.value(&next);
            if v.norm() < value.norm() {
                (at, value, slope, damping) = (next, v, s, None);
            }
        }
        (self.miss(&at) <= SOLVED).then_some(at)
    }

    /// Adds a root, if it is none of those known: between two the equations do not hold as well.
    fn add(&self, root: Self::Unknown, found: &mut Vec<Self::Unknown>) {
        for other in found.iter_mut() {
            let Some(middle) = self.middle(other, &root) else {
                continue;
            };
            let (value, slope) = self.value(&middle);
            let middle = self.stepped(&middle, &across(&slope, &value));
            let ends = [self.miss(other), self.miss(&root)];
            let between = self.miss(&middle);
            if between > NOISE * ends[0].max(ends[1]).max(ROUNDED) {
                continue;
            }
            // The middle of what rounding has split is nearest to a double root.
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
