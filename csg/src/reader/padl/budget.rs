//! The limit of what loops and parts with parameters expand to.

use std::ops::Range;

use super::super::error::SpannedError;

/// The largest number of solids that loops and uses of parts with parameters make.
pub(super) const MAX_SOLIDS: u64 = 250_000;

/// The largest number of other steps, in which a long number counts for several.
pub(super) const MAX_STEPS: u64 = 10_000_000;

/// The largest number of edges of figures, each counted as often as it is handled.
pub(super) const MAX_EDGES: usize = 2_000_000;

/// The length of a number that counts for one step, in bits.
const STEP_BITS: usize = 256;

/// The number of steps that the value of a function counts for.
const FUNCTION_STEPS: u64 = 32;

/// What has been expanded so far.
#[derive(Debug, Default)]
pub(super) struct Budget {
    solids: u64,
    steps: u64,
    edges: usize,
}

impl Budget {
    /// Counts a step.
    pub(super) fn count_step(&mut self, place: &Range<usize>) -> Result<(), SpannedError> {
        self.steps += 1;
        self.check(place)
    }

    /// Counts a solid: a primitive, a motion or a set operation.
    pub(super) fn count_solid(&mut self, place: &Range<usize>) -> Result<(), SpannedError> {
        self.solids += 1;
        self.check(place)
    }

    /// Counts edges of figures that are moved, combined or swept.
    pub(super) fn count_edges(
        &mut self,
        count: usize,
        place: &Range<usize>,
    ) -> Result<(), SpannedError> {
        self.edges = self.edges.saturating_add(count);
        if self.edges <= MAX_EDGES {
            return Ok(());
        }
        let found = "edges of figures beyond the limit";
        let expected = format!("at most {MAX_EDGES}, each counted as often as it is used");
        Err(SpannedError::limit(place.clone(), found, expected))
    }

    /// Counts the value of a function, by the length of its argument.
    pub(super) fn count_function(&mut self, bits: usize) {
        self.steps += FUNCTION_STEPS;
        self.count_bits(bits);
    }

    /// Counts the length of a number.
    pub(super) fn count_bits(&mut self, bits: usize) {
        self.steps += (bits / STEP_BITS) as u64;
    }

    /// Checks that a range alone is within the limit.
    pub(super) fn check_rounds(
        rounds: Option<u64>,
        place: &Range<usize>,
    ) -> Result<u64, SpannedError> {
        rounds
            .filter(|&rounds| rounds <= MAX_SOLIDS)
            .ok_or_else(|| {
                let found = match rounds {
                    Some(rounds) => format!("a range of {rounds} numbers"),
                    None => "a range of more than 1e19 numbers".to_owned(),
                };
                SpannedError::limit(place.clone(), found, most_solids())
            })
    }

    fn check(&self, place: &Range<usize>) -> Result<(), SpannedError> {
        let expected = if self.solids > MAX_SOLIDS {
            most_solids()
        } else if self.steps > MAX_STEPS {
            format!("at most {MAX_STEPS} numbers and operations in {EXPANSIONS}")
        } else {
            return Ok(());
        };
        let found = "an expansion beyond the limit";
        Err(SpannedError::limit(place.clone(), found, expected))
    }
}

/// What is limited.
const EXPANSIONS: &str = "all `FOR` and parts with parameters";

fn most_solids() -> String {
    format!("at most {MAX_SOLIDS} primitives, motions and set operations in {EXPANSIONS}")
}
