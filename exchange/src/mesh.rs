//! Triangles for other programs: STL, OBJ, glTF and 3MF.
//!
//! The kernel's mesh approximates the boundary. `split_non_manifold` makes every side belong to
//! exactly two triangles. `remove_slivers` removes triangles whose area rounding has made zero. The
//! formats are written by the crates that implement them: binary STL, binary glTF and 3MF. OBJ is
//! written here, because no crate writes its f64 values.

mod f32_points;
pub mod glb;
pub mod obj;
mod remove_slivers;
mod split_non_manifold;
pub mod stl;
pub mod threemf;

use nalgebra::{Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::tessellation::{Accuracy, TessellationError, tessellate};

/// The default deviation of triangles from the boundary, relative to the part's size.
pub const DEVIATION: f64 = 1.0 / 2000.0;

/// The default angle, in degrees, by which normals turn along a triangle's side.
pub const ANGLE: f64 = 15.0;

/// A triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// Its corners among the points, counterclockwise as seen from outside.
    pub corners: [u32; 3],
    /// The outward normals of the face's surface at the corners.
    pub normals: [Vector3<f64>; 3],
    /// The face that it approximates.
    pub face: FaceId,
    /// The index of its solid.
    pub solid: usize,
}

/// The triangles of a part. Every side is a side of exactly one other triangle in the opposite
/// direction, and no triangle has zero area.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Facets {
    /// The corners. Where solids, or pieces of one, touch, each has its own.
    pub points: Vec<Point3<f64>>,
    /// The triangles, solid by solid, face by face.
    pub facets: Vec<Facet>,
    /// The points along each edge that is not smooth.
    pub lines: Vec<Vec<Point3<f64>>>,
    /// The greatest distance from a triangle to the surface.
    pub deviation: f64,
}

/// Why a part cannot be written as triangles.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is no solid.
    #[error("the part is empty: there is no solid to write")]
    Empty,
    /// The boundary cannot be tessellated.
    #[error(transparent)]
    Tessellation(#[from] TessellationError),
    /// More than two triangles share a side, and their pairing is ambiguous.
    #[error("triangles touch at ({:.9}, {:.9}, {:.9}), and their pairing is ambiguous", place[0], place[1], place[2])]
    Touching {
        /// An end of the side.
        place: [f64; 3],
    },
    /// The format's numbers cannot distinguish the points.
    #[error("the format's numbers are too coarse for triangles at ({:.9}, {:.9}, {:.9})", place[0], place[1], place[2])]
    Coarse {
        /// A point there.
        place: [f64; 3],
    },
    /// The format cannot contain so many triangles.
    #[error("{triangles} triangles are more than the format can represent")]
    TooMany {
        /// The number of triangles.
        triangles: usize,
    },
}

impl Facets {
    /// The triangles of a boundary; `resolution` is the part's.
    ///
    /// # Errors
    /// The boundary is empty or cannot be tessellated, or triangles touch where their pairing is
    /// ambiguous or numbers are too coarse.
    pub fn new(brep: &Brep, accuracy: &Accuracy, resolution: f64) -> Result<Self, MeshError> {
        if brep.topology.solids.is_empty() {
            return Err(MeshError::Empty);
        }
        let mesh = tessellate(brep, accuracy, resolution)?;
        let mut facets = split_non_manifold::facets(brep, &mesh)?;
        facets.deviation = accuracy.deviation;
        facets.facets.sort_by_key(|f| f.solid);
        let mended = remove_slivers::mend(&facets.points, &mut facets.facets);
        mended.map_err(|corner| facets.coarse(corner))?;
        Ok(facets)
    }

    /// The error that the format's numbers are too coarse at a corner.
    fn coarse(&self, corner: u32) -> MeshError {
        let place = self.points[corner as usize].into();
        MeshError::Coarse { place }
    }

    /// The triangles of each solid.
    pub(crate) fn solids(&self) -> impl Iterator<Item = &[Facet]> {
        self.facets.chunk_by(|a, b| a.solid == b.solid)
    }

    /// The corners of a triangle.
    pub fn corners(&self, facet: &Facet) -> [Point3<f64>; 3] {
        facet.corners.map(|c| self.points[c as usize])
    }
}
