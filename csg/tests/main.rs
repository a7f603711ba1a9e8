//! The tests that evaluate boundaries or read descriptions, in one program. Unit tests do neither, so
//! that they compile in a fraction of the time: the evaluation, which readers need for projections, is
//! half of the code of a build, and is linked here.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

mod common;
mod components;
mod constructions;
mod contradictions;
mod escalation;
mod face_colours;
mod formats;
mod openscad;
mod pinched_tori;
mod polyhedra;
mod rays;
mod reading;
mod rounding;
mod swept_figures;
mod writing;
