//! Triangulation of the boundary.

use crate::topology::FaceRef;
use crate::{Error, Result, Solid};
use premio_exchange::mesh::{self, Facets};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::tessellation::Accuracy;
use std::fmt;

/// Triangles of a solid, within a stated distance of its boundary. Every side of a triangle is also
/// a side, in the opposite direction, of exactly one other triangle.
///
/// # Examples
///
/// ```
/// let ball = premio::sphere(10).evaluate()?;
/// let mesh = ball.mesh(0.01)?;
/// assert!(mesh.points().iter().all(|[x, y, z]| (x * x + y * y + z * z - 100.0).abs() < 1e-9));
/// assert_eq!(mesh.points().len() + mesh.triangles().len(), mesh.triangles().len() * 3 / 2 + 2);
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone)]
pub struct TriangleMesh {
    solid: Solid,
    facets: Facets,
}

/// Shows the counts of its points and triangles.
impl fmt::Debug for TriangleMesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TriangleMesh")
            .field("points", &self.facets.points.len())
            .field("triangles", &self.facets.facets.len())
            .finish_non_exhaustive()
    }
}

impl TriangleMesh {
    /// The corners.
    ///
    /// # Examples
    ///
    /// ```
    /// assert_eq!(premio::block(1, 2, 3).evaluate()?.mesh(0.1)?.points().len(), 8);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn points(&self) -> Vec<[f64; 3]> {
        self.facets.points.iter().map(|p| (*p).into()).collect()
    }

    /// The corners of each triangle among the points, counterclockwise as seen from outside.
    ///
    /// # Examples
    ///
    /// ```
    /// assert_eq!(premio::block(1, 2, 3).evaluate()?.mesh(0.1)?.triangles().len(), 12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        self.facets.facets.iter().map(|f| f.corners).collect()
    }

    /// The outward unit normals of the surface at the corners of each triangle.
    ///
    /// # Examples
    ///
    /// ```
    /// let mesh = premio::block(1, 2, 3).evaluate()?.mesh(0.1)?;
    /// assert!(mesh.normals().iter().all(|[a, b, c]| a == b && b == c));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn normals(&self) -> Vec<[[f64; 3]; 3]> {
        let facets = self.facets.facets.iter();
        facets.map(|f| f.normals.map(Into::into)).collect()
    }

    /// The face that each triangle approximates.
    ///
    /// # Examples
    ///
    /// ```
    /// let mesh = premio::block(1, 2, 3).evaluate()?.mesh(0.1)?;
    /// assert!((0..6).all(|k| mesh.faces().filter(|face| face.index() == k).count() == 2));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn faces(&self) -> impl Iterator<Item = FaceRef<'_>> {
        let facets = self.facets.facets.iter();
        facets.map(|f| FaceRef::new(self.solid.brep(), f.face))
    }

    /// The volume that the triangles enclose.
    ///
    /// # Examples
    ///
    /// ```
    /// let ball = premio::sphere(1).evaluate()?;
    /// let volume = ball.mesh(0.001)?.volume();
    /// assert!(volume < ball.volume() && volume > 0.995 * ball.volume());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn volume(&self) -> f64 {
        let corners = self.facets.facets.iter().map(|f| self.facets.corners(f));
        let six = corners.map(|[a, b, c]| a.coords.dot(&b.coords.cross(&c.coords)));
        six.sum::<f64>() / 6.0
    }
}

/// The finest triangulation: relative to the solid's size, and in degrees. A circle then has some
/// thousand chords.
const FINEST_DEVIATION: f64 = 1.0 / 16_777_216.0;
const FINEST_ANGLE: f64 = 1.0 / 16.0;

/// The fineness of a triangulation.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let fine = Fineness { angle: Some(5.0), ..Fineness::default() };
/// let ball = sphere(1).evaluate()?;
/// let (fine, usual) = (ball.mesh_with(&fine)?, ball.mesh_with(&Fineness::default())?);
/// assert!(fine.triangles().len() > usual.triangles().len());
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Fineness {
    /// The greatest distance from a triangle to the boundary, in the solid's unit; by default a
    /// two-thousandth of its size.
    pub deviation: Option<f64>,
    /// The greatest angle between the normals at the ends of a side, in degrees; by default 15.
    pub angle: Option<f64>,
}

impl Solid {
    /// Triangles within a distance of the boundary, in the solid's unit.
    ///
    /// # Errors
    /// The solid is empty, the distance is too small, or the boundary cannot be followed.
    ///
    /// # Examples
    ///
    /// ```
    /// let mesh = premio::cylinder(1, 2).evaluate()?.mesh(0.01)?;
    /// assert!((mesh.volume() - std::f64::consts::TAU).abs() < 0.1);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn mesh(&self, deviation: f64) -> Result<TriangleMesh> {
        let deviation = Some(deviation);
        let angle = None;
        self.mesh_with(&Fineness { deviation, angle })
    }

    /// Triangles of a fineness.
    ///
    /// # Errors
    /// As [`Solid::mesh`].
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let mesh = cylinder(1, 2).evaluate()?.mesh_with(&Fineness::default())?;
    /// assert!(mesh.triangles().len() > 40);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn mesh_with(&self, fineness: &Fineness) -> Result<TriangleMesh> {
        let solid = self.clone();
        let facets = self.facets(fineness)?;
        Ok(TriangleMesh { solid, facets })
    }

    /// The triangles that are written to files.
    pub(crate) fn facets(&self, fineness: &Fineness) -> Result<Facets> {
        let size = self.extent().size;
        self.check_fineness(fineness, size)?;
        let accuracy = Accuracy {
            deviation: fineness.deviation.unwrap_or(mesh::DEVIATION * size),
            angle: fineness.angle.unwrap_or(mesh::ANGLE).to_radians(),
        };
        let resolution = self.evaluation().f64_resolution();
        Ok(Facets::new(self.brep(), &accuracy, resolution)?)
    }

    /// Refuses a fineness that would take far too many triangles; flat faces take few at any
    /// fineness.
    fn check_fineness(&self, fineness: &Fineness, size: f64) -> Result<()> {
        let mut faces = self.faces();
        if faces.all(|face| matches!(face.surface(), Surface::Plane(_))) {
            return Ok(());
        }
        let asked = [
            ("deviation", fineness.deviation, FINEST_DEVIATION * size),
            ("angle", fineness.angle, FINEST_ANGLE),
        ];
        for (what, asked, least) in asked {
            match asked {
                Some(asked) if asked.is_nan() || asked < least => {
                    return Err(Error::Fineness { what, asked, least });
                }
                _ => (),
            }
        }
        Ok(())
    }
}
