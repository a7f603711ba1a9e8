//! Contour generators: the curves in space that are seen as contours. Edges, limbs with their cusps, and
//! the arcs of both before the camera's near plane, with the junctions at their ends.

pub mod contour_arc;
pub(crate) mod facing;
pub mod junctions;
pub mod limb;
pub mod limb_arcs;
