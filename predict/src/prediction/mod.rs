//! The prediction of an image: five levels with their relations (section 4.3 of the paper).

mod draft;
mod levels;

pub use draft::{Draft, Memory, Outcome, with_draft};
pub use levels::{
    ArcLevel, BoundaryLevel, Chances, Geometry, ImageLevel, ObjectLevel, Piece, Prediction,
    RegionLevel, SCHEMA, Segment, prediction,
};

/// The schema of [`Prediction`], as JSON Schema has it.
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(Prediction)
}
