//! What a camera sees of a part: limbs, cusps, contours, junctions, quantitative invisibility and
//! drawings.

pub mod camera;
pub mod candidates;
pub mod contour;
pub mod correction;
pub mod crossing;
pub mod edgewise;
mod face_box;
mod facing;
pub mod graphs;
pub mod image;
pub mod image_box;
pub mod invisibility;
pub mod junction;
pub mod limb;
mod meeting;
pub mod polynomial;
pub mod projection;
mod seen;
mod shared;
pub mod sight;
pub mod strand;
pub mod stretch;
mod touches;
pub mod view;

pub use camera::Camera;
pub use contour::Contours;
pub use view::{ViewError, contours};
