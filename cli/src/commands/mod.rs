//! The commands.

pub mod advise;
pub mod check;
pub mod compare;
pub mod contours;
pub mod convert;
pub mod export;
pub mod fuzz;
pub mod info;
pub mod manual;
pub mod matching;
pub mod model;
pub mod predict;
pub mod render;
pub mod schema;
