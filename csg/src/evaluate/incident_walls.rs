//! The walls around a point.

use nalgebra::Vector3;
use premio_kernel::number::float::Float;

/// A wall through a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct IncidentWall<N: Float> {
    /// The index among the primitive's sides.
    pub side: usize,
    /// Whether the material is on the positive side of the surface.
    pub is_concave: bool,
    /// The direction in which the wall extends from the point; `None` if it does on both sides.
    pub away: Option<Vector3<N>>,
}

/// The walls around a point.
#[derive(Debug)]
pub(super) struct RegionLook<N: Float> {
    /// The chosen walls through the point.
    pub walls: Vec<IncidentWall<N>>,
    /// Whether the point is inside, if there are none.
    pub is_inside: bool,
    /// The distance of the closest other wall, if it is close.
    pub margin: N,
}
