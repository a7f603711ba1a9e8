//! Binary STL: triangles in single precision, each with its corners and its normal.
//!
//! The format has no unit. Readers merge what touches in a point or along an edge.

use super::f32_points::F32Points;
use super::{Facets, MeshError};
use nalgebra::{Point3, Vector3};
use stl_io::{Normal, Triangle, Vertex, write_stl};

/// The bytes of a file.
///
/// # Errors
/// Points are too close for f32, or there are too many triangles.
pub fn write(facets: &Facets) -> Result<Vec<u8>, MeshError> {
    let single = F32Points::new(facets, &Point3::origin())?;
    if let Some(corner) = single.closed_gap(&facets.points) {
        return Err(facets.coarse(corner));
    }
    if u32::try_from(single.facets.len()).is_err() {
        let triangles = single.facets.len();
        return Err(MeshError::TooMany { triangles });
    }
    let triangles = single.facets.iter().map(|facet| {
        let corners = single.corners(facet);
        let [a, b, c] = corners.map(|p| Vector3::from(p.map(f64::from)));
        let normal = (b - a).cross(&(c - a)).normalize();
        Triangle {
            normal: Normal::new(normal.map(|x| x as f32).into()),
            vertices: corners.map(Vertex::new),
        }
    });
    let mut bytes = Vec::new();
    // Writing to memory does not fail.
    let _ = write_stl(&mut bytes, triangles);
    Ok(bytes)
}
