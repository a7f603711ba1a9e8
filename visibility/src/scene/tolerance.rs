//! The distances within which points from two computations are equal, in multiples of the
//! resolution.
//!
//! A position takes a few more operations than the distances that the resolution is applied to.

/// Points in space.
pub const SPACE_TOLERANCE: f64 = 16.0;

/// Points of contours in the image.
pub const IMAGE_TOLERANCE: f64 = 8.0;
