//! Random and realistic parts. A [`profile`] makes a [`model`] from a seed, [`mod@write`] converts
//! it to a description, and [`mod@shrink`] reduces a failing one.

pub mod figure;
pub mod model;
mod openscad;
mod operation;
pub mod profile;
mod random;
pub mod shrink;
pub mod write;
