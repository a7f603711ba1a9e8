//! Runs of another program on each tree, and the comparison of its measures with ours.
//!
//! [`command`] has the words of the program. [`launch`] starts it with limits, [`process`] waits for
//! it and ends it. [`verdict`] has what becomes of a tree, and [`tally`] counts the verdicts.

pub mod command;
pub mod launch;
pub mod process;
pub mod tally;
pub mod verdict;
