//! What a camera sees of a part: limbs, cusps, contours, junctions, quantitative invisibility and
//! drawings.

pub mod broad_phase;
pub mod camera;
pub mod contour;
pub mod contour_arc;
pub mod correction;
pub mod edgewise;
mod face_box;
mod facing;
mod first_hit;
pub mod image_box;
pub mod image_curve;
pub mod intersect;
pub mod intersect_general;
mod intersections;
pub mod invisibility;
pub mod junction;
pub mod limb;
pub mod monotone_arc;
mod overlap;
pub mod polynomial;
pub mod projection;
pub mod ray_casting;
mod snap;
pub mod view;

pub use camera::ViewCamera;
pub use contour::Contours;
pub use view::{ViewError, contours};
