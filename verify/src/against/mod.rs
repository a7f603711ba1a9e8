//! The comparison of another kernel's results with ours: the model as a file or as a program, the
//! measures that the kernel states or that its mesh has, and their differences from ours.
//!
//! Nothing of a result is trusted. An [`answer`] is a line of JSON with finite numbers, a [`mesh`]
//! or a STEP file ([`result_file`]) is closed, and [`comparison`] compares the measures within stated tolerances. [`template`] and
//! [`import`] turn models into programs, and descriptions into models. No process is started here.

pub mod answer;
pub mod comparison;
pub mod import;
pub mod mesh;
pub mod result_file;
pub mod template;
