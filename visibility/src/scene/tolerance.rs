//! How far apart points may be that two computations give for one, in multiples of the resolution.
//!
//! A position comes out of a few more operations than the distances that the resolution was applied to.

/// Points in space.
pub const SPACE_TOLERANCE: f64 = 16.0;

/// Points of contours in the image.
pub const IMAGE_TOLERANCE: f64 = 8.0;
