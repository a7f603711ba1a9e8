//! Contour generators: the curves in space whose images are contours. These are edges, limbs with
//! their cusps, and the arcs of both beyond the camera's near plane, with the junctions at their
//! ends.

pub(crate) mod contour_arc;
pub(crate) mod facing;
pub mod junctions;
mod limb;
pub mod limb_arcs;
