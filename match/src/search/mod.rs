//! The search for correspondences: it assigns each feature of the part to a candidate of the image,
//! or marks it as missed.
//!
//! A path through the tree assigns one feature after another, in order of detectability. Its score
//! is the log-likelihood ratio of its assignments against clutter. Its bound is the score plus, for
//! each remaining feature, the greatest score that it can add. That is maximised for each feature
//! by itself, given the assigned features, with the greatest scores of pairs of remaining ones, so
//! no completion scores more. Choices that no best assignment contains are eliminated before the
//! search. [`monitor`] receives the progress of a search and may stop it.

mod branch_and_bound;
mod dead_end_elimination;
mod ida_star;
pub mod monitor;
mod path;
mod potentials;
#[cfg(test)]
mod tests;

use crate::correspondence::problem::{Assignment, Problem};

use path::Path;
use potentials::Potentials;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The search strategy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Strategy {
    /// Depth-first branch and bound: a path is pruned where its bound is no more than the best
    /// score found.
    #[default]
    Bounded,
    /// IDA* (Korf 1985): rounds with a threshold, which falls to the greatest pruned bound.
    Deepening,
    /// Rounds with a threshold that falls in steps, each completed.
    Stepped,
}

/// The work of a search.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, JsonSchema, Serialize)]
pub struct SearchStats {
    /// Paths opened: a path with one more assignment.
    pub opened: u64,
    /// Of them, those that were pruned at once by their bound.
    pub pruned: u64,
    /// Paths that were extended.
    pub nodes: u64,
    /// Rounds.
    pub rounds: u64,
    /// Choices of features that were eliminated before the search.
    pub eliminated: u64,
}

impl SearchStats {
    /// Pruned over opened.
    pub(crate) fn ratio(&self) -> f64 {
        if self.opened == 0 {
            0.0
        } else {
            self.pruned as f64 / self.opened as f64
        }
    }
}

/// The best assignment.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Solution {
    /// By feature: the assigned candidate, or none if it is missed.
    pub assignment: Assignment,
    /// Its score.
    pub score: f64,
    /// The work of the search.
    pub effort: SearchStats,
    /// Whether it is proven to be the best; otherwise the limit was reached.
    pub complete: bool,
}

/// The best assignment of a problem. At most `most` paths are opened, and as many again by branch
/// and bound where rounds end without a result.
pub(crate) fn search(problem: &Problem, strategy: Strategy, most: u64) -> Solution {
    let mut terms = Potentials::new(problem);
    let effort = SearchStats {
        eliminated: dead_end_elimination::eliminate(&mut terms),
        ..SearchStats::default()
    };
    let mut state = State {
        terms: &terms,
        effort,
        most,
        best: None,
    };
    // Rounds that reach the limit have no result, so branch and bound follows with the same limit.
    let rounds = |state: &mut State<'_>, step: Option<f64>| {
        let complete = ida_star::run(state, step);
        state.most = state.most.saturating_add(most);
        complete || branch_and_bound::run(state)
    };
    let complete = match strategy {
        Strategy::Bounded => branch_and_bound::run(&mut state),
        Strategy::Deepening => rounds(&mut state, None),
        Strategy::Stepped => rounds(&mut state, Some(ida_star::STEP)),
    };
    // If the limit is reached before any path is complete, the greedy path is better than none.
    let best = state.best.take();
    let ScoredAssignment { score, assignment } =
        best.unwrap_or_else(|| ScoredAssignment::new(&Path::promising(&terms)));
    Solution {
        assignment,
        score,
        effort: state.effort,
        complete,
    }
}

/// The state of a search.
struct State<'a> {
    terms: &'a Potentials,
    effort: SearchStats,
    most: u64,
    best: Option<ScoredAssignment>,
}

/// An assignment of all features, and its score.
struct ScoredAssignment {
    score: f64,
    assignment: Assignment,
}

impl ScoredAssignment {
    fn new(path: &Path<'_>) -> Self {
        Self {
            score: path.score(),
            assignment: path.assignment(),
        }
    }
}

impl State<'_> {
    /// Counts an opened path; false if the limit is reached.
    fn open(&mut self) -> bool {
        let can = self.effort.opened < self.most;
        self.effort.opened += u64::from(can);
        can
    }

    /// Keeps a complete path if it is the best.
    fn keep(&mut self, path: &Path<'_>) {
        let score = path.score();
        if self.best.as_ref().is_none_or(|b| score > b.score) {
            self.best = Some(ScoredAssignment::new(path));
        }
    }

    fn incumbent(&self) -> f64 {
        self.best.as_ref().map_or(f64::NEG_INFINITY, |b| b.score)
    }
}
