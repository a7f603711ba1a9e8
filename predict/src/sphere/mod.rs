//! Points on the illumination and viewing spheres (PREMIO, section 3.2.1), spread evenly over the
//! sphere or over cones of directions. Equal requests give equal points.

mod cone;
mod fibonacci;
mod icosahedron;

pub use cone::ViewCone;
use nalgebra::Vector3;
use premio_text::number;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The greatest number of points: far more views than any model has.
pub(crate) const MAX_POINTS: usize = 1 << 22;

/// The lattice of points on the sphere.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Lattice {
    /// A spiral, each point turned on from the last by the golden angle (Vogel, 1979; González,
    /// Mathematical Geosciences 42, 2010): any number of points, each with the same area of its
    /// own.
    #[default]
    Fibonacci,
    /// The vertices of an icosahedron whose faces are divided evenly and lifted to the sphere, 10f²
    /// + 2 for the frequency f: six neighbours to a point, and areas that differ by up to a half.
    Icosahedral,
}

/// The requested number or spacing of points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SphereSampling {
    /// A number of points within the cones: exactly this many on a Fibonacci lattice, at least this
    /// many on an icosahedral one.
    Count(usize),
    /// The angle between neighbours in degrees. On a Fibonacci lattice each point has an area of
    /// this angle squared, and the nearest neighbour is at about 0.87 of it; on an icosahedral one
    /// no edge is longer.
    Angle(f64),
}

/// Why there are no points.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SphereError {
    /// The requested number of points is zero.
    #[error("the number of points must be at least 1")]
    NoCount,
    /// The angle between neighbours is invalid.
    #[error("the angle between neighbours is {}°, and must be more than 0° and at most 180°", number(*.0))]
    Angle(f64),
    /// A cone has no direction.
    #[error("the axis of cone {0} has no direction")]
    Axis(usize),
    /// The half angle of a cone is invalid.
    #[error("the half angle of cone {cone} is {}°, and must be more than 0° and at most 180°", number(*angle))]
    HalfAngle {
        /// Which cone, counted from 0.
        cone: usize,
        /// Its half angle in degrees.
        angle: f64,
    },
    /// The request needs more points than the limit.
    #[error("more than {MAX_POINTS} points on the sphere would be needed")]
    TooMany,
    /// The lattice has no point within the cones.
    #[error("no point of the lattice is within the cones")]
    Empty,
}

/// The points of a lattice that lie in any of the cones, or on the whole sphere if there is no
/// cone: unit vectors, in an order that depends only on the request.
///
/// # Errors
/// The number of points or an angle is out of its range, a cone has no direction, or the cones
/// contain no point of the lattice.
pub fn points(
    lattice: Lattice,
    sampling: SphereSampling,
    cones: &[ViewCone],
) -> Result<Vec<Vector3<f64>>, SphereError> {
    match sampling {
        SphereSampling::Count(0) => return Err(SphereError::NoCount),
        SphereSampling::Count(n) if n > MAX_POINTS => return Err(SphereError::TooMany),
        SphereSampling::Angle(angle) if !is_angle(angle) => return Err(SphereError::Angle(angle)),
        _ => (),
    }
    let caps = cone::caps(cones)?;
    let found = match lattice {
        Lattice::Fibonacci => fibonacci::points(sampling, &caps)?,
        Lattice::Icosahedral => icosahedron::points(sampling, &caps)?,
    };
    if found.is_empty() {
        return Err(SphereError::Empty);
    }
    Ok(found)
}

/// Whether an angle in degrees is more than 0 and at most 180.
fn is_angle(degrees: f64) -> bool {
    degrees > 0.0 && degrees <= 180.0
}

#[cfg(test)]
mod tests;
