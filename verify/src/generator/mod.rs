//! Random and realistic parts: a [`profile`] makes a [`model`] of a seed, [`mod@write`] turns it into a
//! description, and [`mod@shrink`] makes one that fails smaller.

pub mod model;
pub mod profile;
mod random;
pub mod shrink;
pub mod write;
