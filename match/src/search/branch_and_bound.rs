//! Depth-first branch and bound.

use super::State;
use super::path::Path;

/// Searches the tree; false if the limit is reached.
pub fn run(state: &mut State<'_>) -> bool {
    state.effort.rounds += 1;
    let mut path = Path::new(state.terms);
    descend(state, &mut path)
}

fn descend(state: &mut State<'_>, path: &mut Path<'_>) -> bool {
    if path.is_complete() {
        state.keep(path);
        return true;
    }
    state.effort.nodes += 1;
    for choice in path.next() {
        if !state.open() {
            return false;
        }
        path.push(choice);
        let done = if path.bound() <= state.incumbent() {
            state.effort.pruned += 1;
            true
        } else {
            descend(state, path)
        };
        path.pop();
        if !done {
            return false;
        }
    }
    true
}
