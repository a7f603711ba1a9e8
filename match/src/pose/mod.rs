//! The pose of a part in the camera's frame: minimal solvers propose poses, and least squares
//! refines them.

pub(crate) mod circle;
mod equations;
pub(crate) mod p2p2l;
pub mod p3l;
pub mod p3p;
mod polynomial;
pub(crate) mod refine;
#[cfg(test)]
mod tests;
