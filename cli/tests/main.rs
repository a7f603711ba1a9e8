//! The tests of the program from outside, in one program: it is linked once, and its tests share the
//! cores.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

mod against;
mod book;
mod common;
mod descriptions;
mod fuzz;
mod hostile;
mod images;
mod library;
mod matching;
mod models;
mod names;
mod pictures;
mod program;
mod refusals;
mod scad;
mod snapshots;
mod unseen;
