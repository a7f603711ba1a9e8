//! Finds the points where a boundary touches itself: a vertex with several fans of faces, and
//! points at which a vertex, an edge or a face meets the interior of another edge or face without
//! an edge there.
//!
//! All common points of curves or surfaces are known beforehand, with all surfaces through them.
//! Only the faces that contain them in their interior remain to be found.

use super::Brep;
use super::boundary_input::{BoundaryInput, Names};
use super::bounding_box::face_bounds;
use super::locate::{Locator, PointLocation};
use super::shells::Fans;
use super::topology::{EdgeId, FaceId, NonManifoldPoint};
use crate::geometry::bounds::Aabb;
use crate::geometry::vector::rounded;
use crate::hash::{HashMap, HashSet};
use crate::number::float::Float;
use crate::number::predicates::Predicates;
use nalgebra::Point3;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// A point at which a boundary touches itself, with its location.
pub(super) struct PlacedTouch<N: Float = f64> {
    pub place: Point3<N>,
    pub touch: NonManifoldPoint,
}

/// The points at which a boundary touches itself.
pub(super) fn touches<N: Float>(
    brep: &Brep<N>,
    raw: &BoundaryInput<N>,
    names: &Names,
    fans: &Fans,
    predicates: &Predicates,
) -> Vec<PlacedTouch<N>> {
    let edges = Edges::new(raw, names);
    let faces = Faces::new(brep, predicates.resolution());
    let mut found = Vec::new();
    for (point, at) in raw.points.iter().enumerate() {
        let vertex = names.vertex_of.get(&point).copied();
        let fans = vertex.map_or(0, |v| fans.at_vertex[v.index()]);
        let edges_through = edges.through.get(&point).cloned().unwrap_or_default();
        let bounded = fans + edges_through.len();
        // A face with an edge at the point does not contain it in its interior.
        let open = at.surfaces.iter().filter_map(|s| names.surface_of.get(s));
        let open = open.filter(|&&surface| {
            let on = PointOnSurface { point, surface };
            !edges.bounding.contains(&on)
        });
        if bounded + open.clone().count() < 2 {
            continue;
        }
        let held = open.filter_map(|&s| Some((s, faces.holding(s, &at.place)?)));
        let (surfaces, faces): (Vec<usize>, Vec<FaceId>) = held.unzip();
        if bounded + faces.len() < 2 {
            continue;
        }
        // Close to a touch of two faces other points also lie on both, within the resolution.
        let touching = |node: &[usize; 2]| {
            let named = |s| {
                names
                    .surface_of
                    .get(s)
                    .is_some_and(|s| surfaces.contains(s))
            };
            node.iter().all(named)
        };
        if bounded == 0 && !at.nodes.iter().any(touching) {
            continue;
        }
        let touch = NonManifoldPoint {
            vertex,
            fans,
            edges: edges_through,
            faces,
        };
        let place = at.place;
        found.push(PlacedTouch { place, touch });
    }
    found
}

/// The edges at points.
#[derive(Default)]
struct Edges {
    /// The edges through each point.
    through: HashMap<usize, Vec<EdgeId>>,
    /// The points, with the surfaces that have a face with an edge there.
    bounding: HashSet<PointOnSurface>,
}

/// A point of the input, and a surface.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct PointOnSurface {
    point: usize,
    surface: usize,
}

impl Edges {
    fn new<N: Float>(raw: &BoundaryInput<N>, names: &Names) -> Self {
        let mut found = Self::default();
        for (id, edge) in raw.edges.iter().enumerate() {
            for &point in &edge.passes {
                let through = found.through.entry(point).or_default();
                through.push(EdgeId(id as u32));
            }
            for &point in edge.ends.iter().flatten().chain(&edge.passes) {
                for face_use in &edge.face_uses {
                    let surface = names.surface_of[&face_use.surface];
                    found.bounding.insert(PointOnSurface { point, surface });
                }
            }
        }
        found
    }
}

/// The faces of each surface.
struct Faces<'a, N: Float = f64> {
    of_surface: Vec<SurfaceFaces>,
    locator: Locator<'a, N>,
}

/// The faces of a surface.
enum SurfaceFaces {
    /// In the order of their ids.
    Listed(Vec<FaceId>),
    /// In a tree of boxes, where they are many.
    Indexed(RTree<FaceBox>),
}

type FaceBox = GeomWithData<Rectangle<[f64; 3]>, FaceId>;

/// The number of faces of a surface above which a tree of boxes is built.
const FEW: usize = 12;

impl<'a, N: Float> Faces<'a, N> {
    fn new(brep: &'a Brep<N>, resolution: N) -> Self {
        let mut listed = vec![Vec::new(); brep.geometry.surfaces.len()];
        for (patch, face) in brep.geometry.patches.iter().zip(brep.topology.face_ids()) {
            listed[patch.surface].push(face);
        }
        let leaf = |face: FaceId| {
            let Aabb { min, max } = face_bounds(brep, face).grown(resolution);
            GeomWithData::new(Rectangle::from_corners(min, max), face)
        };
        let of_surface = listed.into_iter().map(|faces| match faces.len() > FEW {
            true => SurfaceFaces::Indexed(RTree::bulk_load(faces.into_iter().map(leaf).collect())),
            false => SurfaceFaces::Listed(faces),
        });
        Self {
            of_surface: of_surface.collect(),
            locator: Locator::new(brep, resolution),
        }
    }

    /// The face of a surface that contains a point in its interior.
    fn holding(&self, surface: usize, p: &Point3<N>) -> Option<FaceId> {
        let holds = |face: &FaceId| self.locator.place(*face, p) == PointLocation::Inside;
        match &self.of_surface[surface] {
            SurfaceFaces::Listed(faces) => faces.iter().copied().find(holds),
            SurfaceFaces::Indexed(tree) => {
                let at = AABB::from_point(rounded(p));
                let around = tree.locate_in_envelope_intersecting(at);
                let mut faces: Vec<FaceId> = around.map(|leaf| leaf.data).collect();
                faces.sort_unstable();
                faces.into_iter().find(holds)
            }
        }
    }
}
