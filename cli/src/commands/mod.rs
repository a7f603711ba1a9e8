//! The commands.

pub mod check;
pub mod contours;
pub mod export;
pub mod info;
