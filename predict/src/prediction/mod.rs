//! The prediction of an image: five levels with their relations (section 4.3 of the paper).

mod levels;
mod predicted_image;

pub use levels::{
    ArcGeometry, ArcLevel, ArcPiece, BoundaryLevel, Chances, ImageLevel, ImageSegment, ObjectLevel,
    Prediction, RegionLevel, SCHEMA, prediction,
};
pub(crate) use predicted_image::DetectionOutcome;
pub use predicted_image::{ImageEvidence, Memory, PredictedImage, with_draft};

/// The schema of [`Prediction`], as JSON Schema has it.
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(Prediction)
}
