//! The Fibonacci lattice.
//!
//! On a cap the spiral winds around its axis down to its border, so that it has exactly the
//! requested number of points, each with the same area. Several caps have a spiral each, all of one
//! density, without the points that lie in a larger cap. The density is raised until their number
//! is reached; surplus points are removed evenly.

use super::cone::Cap;
use super::{MAX_POINTS, SphereError, SphereSampling};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// The golden ratio's share of a turn: 2 − (1 + √5)/2.
fn golden_angle() -> f64 {
    PI * (3.0 - 5.0_f64.sqrt())
}

/// A number of points on a cap.
fn spiral(cap: &Cap, n: usize) -> impl Iterator<Item = Vector3<f64>> {
    let depth = 2.0 * cap.share;
    let turn = golden_angle();
    (0..n).map(move |i| {
        // In the middle of its band, so that the pole is not closer to its neighbours.
        let below = depth * (i as f64 + 0.5) / n as f64;
        cap.at(below, turn * i as f64)
    })
}

/// The points of all caps at a density per steradian.
fn at_density(caps: &[Cap], density: f64) -> Result<Vec<Vector3<f64>>, SphereError> {
    let mut found = Vec::new();
    for (i, cap) in caps.iter().enumerate() {
        let n = (density * cap.area()).round();
        if n > MAX_POINTS as f64 {
            return Err(SphereError::TooMany);
        }
        let larger = &caps[..i];
        let own = |p: &Vector3<f64>| !larger.iter().any(|cap| cap.contains(p));
        found.extend(spiral(cap, n as usize).filter(own));
    }
    Ok(found)
}

/// The requested points.
pub(super) fn points(
    sampling: SphereSampling,
    caps: &[Cap],
) -> Result<Vec<Vector3<f64>>, SphereError> {
    let Some(largest) = caps.first() else {
        return Ok(Vec::new());
    };
    match sampling {
        SphereSampling::Count(count) if caps.len() == 1 => Ok(spiral(largest, count).collect()),
        SphereSampling::Count(count) => counted(caps, largest, count),
        SphereSampling::Angle(degrees) => {
            let density = degrees.to_radians().powi(-2);
            // A cap smaller than the area of one point still has one.
            let least = 1.0 / largest.area();
            at_density(caps, density.max(least))
        }
    }
}

/// A number of points on several caps.
fn counted(caps: &[Cap], largest: &Cap, count: usize) -> Result<Vec<Vector3<f64>>, SphereError> {
    let wished = count as f64;
    let area: f64 = caps.iter().map(Cap::area).sum();
    // The density is between that of caps without overlap and that of the largest cap alone.
    let (mut low, mut high) = (wished / area, wished / largest.area());
    let mut best = at_density(caps, high)?;
    for _ in 0..40 {
        if best.len() == count {
            break;
        }
        let middle = 0.5 * (low + high);
        let found = at_density(caps, middle)?;
        if found.len() >= count {
            high = middle;
            best = found;
        } else {
            low = middle;
        }
    }
    let n = best.len();
    // Of n points those are kept at which the proportional count increases by one.
    let kept = |i: &usize| (i + 1) * count / n > i * count / n;
    Ok((0..n).filter(kept).map(|i| best[i]).collect())
}
