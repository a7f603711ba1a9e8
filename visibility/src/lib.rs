//! What a camera sees of a part: limbs, cusps, contours, junctions and quantitative invisibility.
//!
//! The modules are stages; data flows down the list:
//!
//! 1. [`camera`]: the camera and its projection.
//! 2. [`image_curve`]: images of curves, their boxes and monotone arcs.
//! 3. [`scene`]: the part before the camera.
//! 4. [`contour_generator`]: edges and limbs with their cusps, as arcs with junctions at their
//!    ends.
//! 5. `junction`: where arcs cross in the image, and what a crossing changes.
//! 6. [`ray_casting`]: the faces between a point and the eye.
//! 7. [`invisibility`]: quantitative invisibility, counted once and propagated (Appel 1967, Loutrel
//!    1970).
//! 8. [`contours`](mod@contours): the contours of a part, cut into pieces of one visibility.

pub mod camera;
pub mod contour_generator;
pub mod contours;
pub mod image_curve;
pub mod invisibility;
mod junction;
pub mod ray_casting;
pub mod scene;

pub use camera::ViewCamera;
pub use contours::{Contours, ViewError, contours};
