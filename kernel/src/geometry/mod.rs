//! Surfaces and curves: what hangs on the entities of a boundary.

pub mod bitrig;
pub mod bounds;
pub mod chart;
pub mod curve;
pub mod cut;
mod doubles;
pub mod frame;
pub mod intersect;
pub mod quartic;
pub mod relation;
mod restriction;
pub mod section;
pub mod serial;
mod singular;
pub mod surface;
pub mod toric;
pub mod trace;
pub mod trigonometric;
pub mod vector;
