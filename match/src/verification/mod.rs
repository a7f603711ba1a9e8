//! Verification: how much likelier a match is than chance, and what denies it.
//!
//! [`residuals`] separates the systematic offset of features from their random distances, [`shape_evidence`]
//! weighs what edges determine of the part's shape, [`axis_alignment`] what runs along the image's rows and
//! columns, and [`scoring`] adds it all to a log-likelihood ratio. [`part_match`] is the result.

pub mod axis_alignment;
pub mod part_match;
pub mod residuals;
pub mod scoring;
pub mod shape_evidence;
