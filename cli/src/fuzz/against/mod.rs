//! Runs of another program on each tree, and the comparison of its measures with ours.
//!
//! [`command`] has the words of the program. [`launch`] starts it with limits, [`process`] waits for
//! it and ends it. [`verdict`] has what becomes of a tree, [`examiner`] brings about the verdicts,
//! and [`tally`] counts them.

pub mod command;
pub mod examiner;
pub mod launch;
pub mod process;
pub mod tally;
pub mod verdict;
