//! Rounds of depth-first search with a falling threshold: IDA* (Korf, Artificial Intelligence 27,
//! 1985), and the same in steps.
//!
//! With real scores nearly every bound is another one, so that plain IDA* opens the tree again for each;
//! a threshold that falls in steps, each round of which is finished, is as exact.

use super::State;
use super::path::Path;

/// How far the threshold falls from round to round at least: the logarithm of a probability ratio.
pub const STEP: f64 = 1.0;

/// What became of a branch.
enum Branch {
    /// It was searched as far as the threshold.
    Done,
    /// It holds the answer.
    Found,
    /// The work ran out.
    Stopped,
}

/// Searches the tree; no if the work ran out.
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

/// Goes through the paths from one on whose bound is at least the threshold; `next` becomes the
/// greatest bound below it. With `stops` the first complete path is the answer: none has a higher
/// bound than the threshold allowed for.
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
