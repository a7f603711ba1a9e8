//! The region in which surfaces are intersected.

use crate::number::float::Float;
use nalgebra::Point3;

/// The ball that contains the part. Intersections outside it are not computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionOfInterest<N: Float = f64> {
    /// The centre.
    pub centre: Point3<N>,
    /// The radius.
    pub radius: N,
}
