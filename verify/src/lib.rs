//! Verification: the self-checks of a part, the random and realistic parts on which they are run,
//! and the trial of one such part.
//!
//! A [`generator`] makes a part from a profile and a seed. The [`checks`] compare a boundary, its
//! views, its drawings and its files with independent computations. A [`trial`] evaluates a part
//! and runs the checks. [`against`] compares the results of another kernel with ours.

pub mod against;
pub mod checks;
pub mod generator;
pub mod trial;
