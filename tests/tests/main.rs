//! The tests that cross crates, in one program: it is linked once, and its tests share the cores.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

mod cases;
mod comparisons;
mod corpus;
mod dependencies;
mod exact;
mod half_spaces;
mod holes;
mod identities;
mod idioms;
mod layering;
mod limits;
mod matching;
mod names;
mod near;
mod nearly_equal_ellipsoids;
mod pairs;
mod predictions;
mod random;
mod recovery;
mod scale;
mod sheets;
mod slivers;
mod tee;
mod tessellation;
mod torus_views;
mod touches;
mod violations;
mod voids;
