//! Features of an image: arcs with their detections, and groups of arcs.

pub mod arc_raster;
pub mod contrast;
pub mod detected_arc;
pub mod group;
pub mod junction;
pub mod reason;

pub use detected_arc::{DetectedArc, DetectionState, Fragment};
pub use reason::Reason;
