//! Points in single precision.

use super::{Facet, Facets, MeshError, sound};
use nalgebra::Point3;

/// Triangles whose points are in single precision.
#[derive(Clone, Debug)]
pub(super) struct Single {
    /// The corners, from the origin of the file.
    pub points: Vec<[f32; 3]>,
    /// The triangles.
    pub facets: Vec<Facet>,
}

/// A point, rounded.
pub(super) fn rounded(p: &Point3<f64>, origin: &Point3<f64>) -> [f32; 3] {
    (p - origin).map(|x| x as f32).into()
}

impl Single {
    /// The triangles, where rounding does not take points farther than triangles may be off.
    pub fn of(facets: &Facets, origin: &Point3<f64>) -> Result<Self, MeshError> {
        let points: Vec<[f32; 3]> = facets.points.iter().map(|p| rounded(p, origin)).collect();
        let exact: Vec<Point3<f64>> = points.iter().map(|p| p.map(f64::from).into()).collect();
        let is_far = |(p, q): (&Point3<f64>, &Point3<f64>)| {
            let moved = (p - origin) - q.coords;
            moved.norm() > facets.deviation
        };
        if let Some(corner) = facets.points.iter().zip(&exact).position(is_far) {
            return Err(facets.coarse(corner as u32));
        }
        let mut single = Self {
            facets: facets.facets.clone(),
            points,
        };
        sound::mend(&exact, &mut single.facets).map_err(|corner| facets.coarse(corner))?;
        Ok(single)
    }

    /// The corners of a triangle.
    pub fn corners(&self, facet: &Facet) -> [[f32; 3]; 3] {
        facet.corners.map(|c| self.points[c as usize])
    }
}
