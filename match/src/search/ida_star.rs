//! Rounds of depth-first search with a falling threshold: IDA* (Korf, Artificial Intelligence 27,
//! 1985), and the same in steps.
//!
//! With real-valued scores nearly every bound is different, so IDA* opens the tree again for each.
//! A threshold that falls in steps, with each round completed, is as exact.

use super::State;
use super::path::Path;

/// The least decrease of the threshold per round, as a log-likelihood ratio.
pub const STEP: f64 = 1.0;

/// The result of a branch.
enum Branch {
    /// It was searched down to the threshold.
    Done,
    /// It contains the solution.
    Found,
    /// The limit was reached.
    Stopped,
}

/// Searches the tree; false if the limit is reached.
pub fn run(state: &mut State<'_>, step: Option<f64>) -> bool {
    let mut threshold = Path::new(state.terms).bound();
    loop {
        state.effort.rounds += 1;
        let mut next = f64::NEG_INFINITY;
        let mut path = Path::new(state.terms);
        let stops = step.is_none();
        match descend(state, &mut path, threshold, &mut next, stops) {
            Branch::Found => return true,
            Branch::Stopped => return false,
            Branch::Done if state.best.is_some() || next == f64::NEG_INFINITY => return true,
            Branch::Done => {}
        }
        threshold = step.map_or(next, |step| next.min(threshold - step));
    }
}

/// Extends a path by all choices whose bound is at least the threshold; `next` becomes the greatest
/// bound below it. With `stops` the first complete path is the solution, because no path has a
/// greater bound than the threshold.
fn descend(
    state: &mut State<'_>,
    path: &mut Path<'_>,
    threshold: f64,
    next: &mut f64,
    stops: bool,
) -> Branch {
    if path.is_complete() {
        state.keep(path);
        return if stops { Branch::Found } else { Branch::Done };
    }
    state.effort.nodes += 1;
    for choice in path.next() {
        if !state.open() {
            return Branch::Stopped;
        }
        path.push(choice);
        let bound = path.bound();
        let branch = if bound < threshold || bound <= state.incumbent() {
            state.effort.pruned += 1;
            *next = next.max(bound);
            Branch::Done
        } else {
            descend(state, path, threshold, next, stops)
        };
        path.pop();
        match branch {
            Branch::Done => {}
            other => return other,
        }
    }
    Branch::Done
}
