//! Correspondences by search: which feature of the part is which line of the picture, or is missed.
//!
//! A path through the tree assigns one feature after another, in order of detectability. Its score is
//! the logarithm of how much more likely the picture is with its assignments than if all were clutter;
//! its bound is the score and, for each feature that is left, the best that it could add with those that
//! are assigned and the best of those that are not: each is maximised by itself, so no completion has
//! more. Choices that are in no best assignment are eliminated before.

mod branch_and_bound;
mod dead_end_elimination;
mod ida_star;
mod path;
mod potentials;
#[cfg(test)]
mod tests;

use crate::correspondence::problem::{Assignment, Problem};

use path::Path;
use potentials::Potentials;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the tree is searched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Strategy {
    /// Depth-first branch and bound: a path is cut where its bound is no more than the best found.
    #[default]
    Bounded,
    /// IDA* (Korf 1985): rounds with a threshold, which falls to the greatest bound that was cut.
    Deepening,
    /// Rounds with a threshold that falls in steps, each finished.
    Stepped,
}

/// What a search did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, JsonSchema, Serialize)]
pub struct SearchStats {
    /// Paths opened: a path with one more assignment.
    pub opened: u64,
    /// Of them, those that were cut at once by their bound.
    pub pruned: u64,
    /// Paths that were gone on from.
    pub nodes: u64,
    /// Rounds.
    pub rounds: u64,
    /// Choices of features that were eliminated before the search, as none of the best.
    pub eliminated: u64,
}

impl SearchStats {
    /// Pruned over opened.
    pub fn ratio(&self) -> f64 {
        if self.opened == 0 {
            0.0
        } else {
            self.pruned as f64 / self.opened as f64
        }
    }
}

/// The best assignment.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// By feature: the candidate that it is, or none if it is missed.
    pub assignment: Assignment,
    /// Its score.
    pub score: f64,
    /// What it took.
    pub effort: SearchStats,
    /// Whether it is known to be the best; else the work ran out.
    pub complete: bool,
}

/// The best assignment of a problem; at most so many paths are opened, and as many again where rounds
/// end without an answer.
pub fn search(problem: &Problem, strategy: Strategy, most: u64) -> Solution {
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
    // Rounds that run out of work have answered nothing: branch and bound has as much again.
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
    // Where the work runs out before any path is complete, the most promising one tells more than none.
    let (score, assignment) = state.best.take().unwrap_or_else(|| {
        let path = Path::promising(&terms);
        (path.score(), path.assignment())
    });
    Solution {
        assignment,
        score,
        effort: state.effort,
        complete,
    }
}

/// A search under way.
struct State<'a> {
    terms: &'a Potentials,
    effort: SearchStats,
    most: u64,
    best: Option<(f64, Assignment)>,
}

impl State<'_> {
    /// Counts a path that is opened; no if the work has run out.
    fn open(&mut self) -> bool {
        let can = self.effort.opened < self.most;
        self.effort.opened += u64::from(can);
        can
    }

    /// Keeps a complete path if it is the best.
    fn keep(&mut self, path: &Path<'_>) {
        let score = path.score();
        if self.best.as_ref().is_none_or(|b| score > b.0) {
            self.best = Some((score, path.assignment()));
        }
    }

    fn incumbent(&self) -> f64 {
        self.best.as_ref().map_or(f64::NEG_INFINITY, |b| b.0)
    }
}
