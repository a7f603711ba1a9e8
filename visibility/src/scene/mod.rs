//! The scene: a part in front of a camera, with its boundary, the projection, and the location of
//! points in its faces.

pub(crate) mod face_box;
pub(crate) mod tolerance;

use crate::camera::projection::{Projection, ViewRay};
use face_box::{FaceBox, face_box};
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::locate::Locator;
use premio_kernel::brep::topology::{FaceId, Sense};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::number::predicates::{Compare, ROUNDING};
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};

/// A boundary in front of a camera.
#[derive(Debug)]
pub struct Scene<'a> {
    /// The part.
    pub(crate) brep: &'a Brep,
    /// The camera.
    pub projection: &'a Projection,
    /// The location of points in faces.
    pub(crate) locator: Locator<'a>,
    /// The resolution.
    pub(crate) resolution: f64,
    /// The sine of the angle between parallel sight and a direction along which the image of the
    /// whole part is no longer than the resolution.
    pub(crate) tilt: f64,
    pub(crate) tree: RTree<FaceBox>,
    bounds: Aabb,
}

/// The box of boxes.
fn hull(boxes: &[Aabb]) -> Aabb {
    boxes.iter().fold(Aabb::EMPTY, |a, b| a.hull(b))
}

impl<'a> Scene<'a> {
    /// The scene of a part seen by a camera; `resolution` is that of the part.
    pub fn new(brep: &'a Brep, projection: &'a Projection, resolution: f64) -> Self {
        let locator = Locator::new(brep, resolution);
        let boxes: Vec<Aabb> = brep
            .topology
            .face_ids()
            .map(|f| face_box(brep, &locator, f, resolution))
            .collect();
        let leaf = |(i, b): (usize, &Aabb)| {
            GeomWithData::new(Rectangle::from_corners(b.min, b.max), FaceId(i as u32))
        };
        let tree = RTree::bulk_load(boxes.iter().enumerate().map(leaf).collect());
        let bounds = hull(&boxes);
        let size = bounds.diagonal();
        Self {
            brep,
            projection,
            locator,
            resolution,
            tilt: (resolution / size).max(ROUNDING),
            tree,
            bounds,
        }
    }

    /// The box of the whole part.
    pub(crate) fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Whether the plane through `origin` with the unit `normal` is seen edge-on.
    pub(crate) fn edge_on(&self, origin: &Point3<f64>, normal: &Vector3<f64>) -> bool {
        match self.projection.sight {
            ViewRay::Eye(e) => (e - origin).dot(normal).is_within(self.resolution),
            ViewRay::Direction(d) => d.dot(normal).is_within(self.tilt),
        }
    }

    /// Whether a face's outward normal is its surface's.
    pub(crate) fn along(&self, face: FaceId) -> bool {
        self.brep.sense(face) == Sense::Along
    }
}
