//! What the tests across crates share: random trees, and what is asked of each.

pub mod cast;
pub mod examine;
pub mod formula;
pub mod identities;
pub mod mirror;
pub mod pairs;
pub mod parts;
pub mod random;
