//! Verification: the log-likelihood ratio of a match against its alternatives, and the evidence
//! against it.
//!
//! [`residuals`] separates the systematic offset of features from the roughness of their edges.
//! [`shape_evidence`] evaluates how well edges determine the part's shape, and `axis_alignment`
//! how much runs along the image's rows and columns. `scoring` adds it all to a log-likelihood
//! ratio. [`part_match`] is the result.

pub(crate) mod axis_alignment;
pub mod part_match;
pub mod residuals;
pub mod score_weights;
pub mod scoring;
pub mod shape_evidence;
