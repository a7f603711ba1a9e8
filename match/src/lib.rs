//! A part found in a picture, and where it is.
//!
//! What the detector finds in a picture ([`image_features`]) is matched with what is predicted of a part
//! ([`part`]).

mod axis_alignment;
pub mod camera;
pub mod clutter;
pub mod correspondence;
pub mod detectability_prior;
pub mod edge_score;
mod endpoints;
pub mod explain;
pub mod from_ellipses;
pub mod hypotheses;
pub mod image_features;
pub mod matcher;
pub mod part;
pub mod pose;
pub mod predicted_contours;
pub mod report;
pub mod residuals;
pub mod scoring;
pub mod search;
pub mod search_result;
pub mod shape_evidence;
pub mod tracker;
