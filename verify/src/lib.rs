//! Verification: the self-checks of a part, the random and realistic parts that they are run on, and the
//! trial that one such part is put through.
//!
//! A [`generator`] makes a part of a profile and a seed. The [`checks`] hold a boundary, its views, its
//! drawings and its files against independent computations. A [`trial`] evaluates a part and runs the checks.

pub mod checks;
pub mod generator;
pub mod trial;
