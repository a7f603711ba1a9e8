//! What a sensor and a detector will find of a part.
//!
//! A [`PreparedPart`](prepared_part::PreparedPart) is put before a camera and under lights ([`setup`]); the visible
//! contours, the boundaries of cast shadows and the outlines of highlights divide the image into
//! regions ([`image_arcs`]); pixels next to these get their grey levels ([`image`]); the detector
//! ([`premio_detect`]) finds edges in them, and these are told to what they are the image of
//! ([`feature`]).

pub mod feature;
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
pub mod statistics;
