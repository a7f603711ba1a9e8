//! Common code of the tests across crates: random trees, and the examination of each.

pub mod cast;
pub mod examine;
pub mod formula;
pub mod identities;
pub mod mirror;
pub mod pairs;
pub mod parts;
pub mod random;
pub mod scenes;
