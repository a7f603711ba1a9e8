//! What a camera sees of a part: limbs, cusps, contours, junctions, quantitative invisibility and
//! drawings.

pub mod camera;
pub mod image;
pub mod limb;
pub mod projection;
pub mod sight;
