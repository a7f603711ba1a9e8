//! Points in single precision.

use super::{Facet, Facets, MeshError, remove_slivers};
use nalgebra::Point3;
use std::collections::HashMap;

/// Triangles whose points are in single precision.
#[derive(Clone, Debug)]
pub(super) struct F32Points {
    /// The corners, relative to the file's origin.
    pub points: Vec<[f32; 3]>,
    /// The triangles.
    pub facets: Vec<Facet>,
}

/// A point, rounded.
pub(super) fn rounded(p: &Point3<f64>, origin: &Point3<f64>) -> [f32; 3] {
    (p - origin).map(|x| x as f32).into()
}

impl F32Points {
    /// The triangles. Fails if rounding moves points farther than triangles may deviate.
    pub fn new(facets: &Facets, origin: &Point3<f64>) -> Result<Self, MeshError> {
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
        remove_slivers::mend(&exact, &mut single.facets).map_err(|corner| facets.coarse(corner))?;
        Ok(single)
    }

    /// A corner at which rounding moves a side of triangles onto another, while the exact `points`
    /// keep them separate. Readers, which join corners by their coordinates, would merge the two.
    pub fn closed_gap(&self, points: &[Point3<f64>]) -> Option<u32> {
        // Adding zero merges the two signs of zero.
        let place = |c: u32| self.points[c as usize].map(|x| (x + 0.0).to_bits());
        let exact = |c: u32| points[c as usize];
        let mut sides = HashMap::with_capacity(3 * self.facets.len());
        let mut all = self.facets.iter().flat_map(remove_slivers::sides_of);
        let is_laid_on_another = |&[a, b]: &[u32; 2]| {
            let ends = [exact(a), exact(b)];
            let other = sides.entry([place(a), place(b)]).or_insert(ends);
            *other != ends
        };
        all.find(is_laid_on_another).map(|[a, _]| a)
    }

    /// The corners of a triangle.
    pub fn corners(&self, facet: &Facet) -> [[f32; 3]; 3] {
        facet.corners.map(|c| self.points[c as usize])
    }
}
