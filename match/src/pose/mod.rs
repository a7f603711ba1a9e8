//! The pose of a part in the camera's frame: minimal solvers that propose, and least squares that
//! decide.

pub mod chain;
pub mod circle;
mod equations;
pub mod limb;
pub mod lines;
pub mod points;
mod polynomial;
pub mod refine;
#[cfg(test)]
mod tests;
