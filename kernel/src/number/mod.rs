//! Exact numbers and what is computed from them.
pub mod rational;
