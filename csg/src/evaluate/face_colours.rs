//! The colours of faces: each has that of the primitive on whose boundary it lies.

use super::evaluation::Evaluation;
use super::halfspaces::{HalfSpaceModel, Solid};
use crate::tree::{NodeId, Tree};
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::locate::FaceLocator;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::colour::Colour;
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::Surface;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// The distance within which a point lies on a primitive, in multiples of the resolution.
const NEAR: f64 = 16.0;

/// The colour of every face of the boundary of a tree, in the order of the faces; empty if no primitive
/// has a colour.
///
/// A face of a difference has the colour of what was taken away. Where faces of primitives coincide, it
/// is that of the first primitive with the material of the face.
pub fn face_colours(tree: &Tree, evaluation: &Evaluation) -> Vec<Option<Colour>> {
    if tree.colours.is_empty() {
        return Vec::new();
    }
    let brep = &evaluation.brep;
    let solids = PlacedSolids::new(HalfSpaceModel::new(tree).all);
    let distance = NEAR * evaluation.f64_resolution();
    let faces = brep.topology.face_ids();
    let sources = faces.map(|face| source(brep, face, &solids, distance));
    sources.map(|leaf| tree.colour(leaf?)).collect()
}

/// The primitives, with a tree of their boxes.
struct PlacedSolids {
    all: Vec<Solid<f64>>,
    boxes: RTree<GeomWithData<Rectangle<[f64; 3]>, usize>>,
}

impl PlacedSolids {
    fn new(all: Vec<Solid<f64>>) -> Self {
        let boxes = all.iter().enumerate().map(|(i, solid)| {
            let Aabb { min, max } = solid.bounds;
            GeomWithData::new(Rectangle::from_corners(min, max), i)
        });
        Self {
            boxes: RTree::bulk_load(boxes.collect()),
            all,
        }
    }

    /// The primitives whose boxes are within a distance of a point, in the order of the leaves.
    fn near(&self, point: &Point3<f64>, distance: f64) -> Vec<&Solid<f64>> {
        let Aabb { min, max } = Aabb::new(point).grown(distance);
        let around = AABB::from_corners(min, max);
        let found = self.boxes.locate_in_envelope_intersecting(around);
        let mut found: Vec<usize> = found.map(|solid| solid.data).collect();
        found.sort_unstable();
        found.into_iter().map(|i| &self.all[i]).collect()
    }
}

/// The primitive on whose boundary a face lies.
fn source(brep: &Brep, face: FaceId, solids: &PlacedSolids, distance: f64) -> Option<NodeId> {
    let locator = FaceLocator::from_face(brep, face, distance / NEAR);
    let surface = brep.surface(face);
    let point = locator
        .interior(2.0 * distance)
        .unwrap_or_else(|| point_of_closed(surface));
    let normal = surface.normal(&point) * brep.sense(face).sign::<f64>();
    let on = solids
        .near(&point, distance)
        .into_iter()
        .filter_map(|solid| {
            let level = |at: &Point3<f64>| solid.level(at, 4.0 * distance);
            let [below, above] =
                [-1.0, 1.0].map(|side| level(&(point + normal * (side * distance))));
            (level(&point).abs() <= distance).then_some((solid.leaf, below < above))
        });
    let on: Vec<(NodeId, bool)> = on.collect();
    let first = on.iter().find(|(_, has_material)| *has_material);
    first.or(on.first()).map(|(leaf, _)| *leaf)
}

/// A point of a face that is all of a closed surface.
fn point_of_closed(surface: &Surface) -> Point3<f64> {
    let frame: &Frame = surface.frame();
    let along = Vector3::new(2.0, -3.0, 6.0) / 7.0;
    match surface {
        Surface::Sphere(s) => frame.origin + frame.vector(&along) * s.radius,
        Surface::Ellipsoid(s) => frame.origin + frame.vector(&s.image(&along)),
        Surface::Torus(s) => frame.origin + frame.x * (s.major + s.minor),
        _ => frame.origin,
    }
}
