//! The tests that evaluate boundaries, in one program. Unit tests evaluate none, so that they compile
//! in a fraction of the time: the evaluation is half of the code of a build, and is linked here.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

mod common;
mod components;
mod constructions;
mod escalation;
mod face_colours;
mod formats;
mod openscad;
mod polyhedra;
mod swept_figures;
