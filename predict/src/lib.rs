//! Prediction of what a sensor and a detector find of a part.
//!
//! A [`PreparedPart`](prepared_part::PreparedPart) stands in front of a camera and under lights
//! ([`setup`]). The visible contours, the boundaries of cast shadows ([`image_arcs`]) and the outlines
//! of highlights divide the image into regions. Pixels next to these get their grey levels
//! ([`image`]). The detector ([`premio_detect`]) finds edges in them, and [`feature`] assigns each
//! edge to its feature.

pub mod feature;
mod highlight;
pub mod image;
pub mod image_arcs;
pub mod model;
pub mod overlay;
pub mod prediction;
pub mod prediction_score;
pub mod prepared_part;
pub mod reflectance;
pub mod render;
pub mod sensor_planning;
pub mod setup;
pub mod sphere;
mod statistics;
