//! Meshes as solids.

use std::collections::HashMap;

use premio_kernel::number::rational::Rational;

use super::{MeshFaces, MeshFile};
use crate::polyhedron::{MAX_CORNERS, Polyhedron, PolyhedronError, PolyhedronFace, SpacePoint};

impl MeshFile<Rational> {
    /// The polyhedra whose union is the mesh. Each object has its own; what its shells bound,
    /// [`Polyhedron::from_shells`] says. An object without volume is nothing.
    ///
    /// # Errors
    /// There are too many corners, the faces of an object are not closed, or nothing has a volume.
    pub(crate) fn polyhedra(&self) -> Result<Vec<Polyhedron>, PolyhedronError> {
        let count = self.objects.iter().map(|faces| faces.corners().len()).sum();
        if !(0..=MAX_CORNERS).contains(&count) {
            return Err(PolyhedronError::TooManyCorners { count });
        }
        let mut all = Vec::new();
        for faces in &self.objects {
            match self.object(faces) {
                Err(PolyhedronError::Empty) => {}
                own => all.extend(own?),
            }
        }
        match all.is_empty() {
            true => Err(PolyhedronError::Empty),
            false => Ok(all),
        }
    }

    fn object(&self, faces: &MeshFaces) -> Result<Vec<Polyhedron>, PolyhedronError> {
        // Each object takes its own points only: there may be as many objects as points.
        let mut used: Vec<usize> = Vec::new();
        let mut known: HashMap<usize, usize> = HashMap::new();
        let own = |corners: &[usize]| {
            let own = corners.iter().map(|point| {
                *known.entry(*point).or_insert_with(|| {
                    used.push(*point);
                    used.len() - 1
                })
            });
            PolyhedronFace::simple(own.collect())
        };
        let faces: Vec<PolyhedronFace> = faces.iter().map(own).collect();
        let points: Vec<SpacePoint> = used.iter().map(|i| self.points[*i].clone()).collect();
        let made = Polyhedron::from_shells(&points, &faces);
        made.map_err(|error| match error {
            PolyhedronError::Open { from, to } => PolyhedronError::Open {
                from: used[from],
                to: used[to],
            },
            error => error,
        })
    }
}
