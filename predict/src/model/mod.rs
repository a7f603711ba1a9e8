//! The model of a part: the summary of hundreds of predictions over the viewing and the
//! illumination sphere (section 5 of the paper).
//!
//! Each setup is one [`Observation`], written as a line; a
//! [`Summary`](summary::Summary) reads the lines, as often as it needs, and keeps sums only.

pub mod consistency;
pub mod file;
pub(crate) mod information;
pub mod observation;
pub mod record;
pub mod summary;

pub use observation::{Observation, observe};
