//! Exact geometry: numbers and predicates, surfaces, curves and their intersections, and the
//! boundary representation built from them.

pub mod brep;
pub mod colour;
pub mod concurrency;
pub mod geometry;
pub mod hash;
pub mod motion;
pub mod number;
pub mod proof;
pub mod random;
pub mod tessellation;
pub mod unit;
