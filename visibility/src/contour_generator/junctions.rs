//! The junctions in which arcs of contours end or are cut, and the entity of the boundary that each
//! lies on.

use crate::camera::projection::Projection;
use crate::image_curve::flat_of;
use nalgebra::Point3;
use premio_kernel::brep::topology::{EdgeId, VertexId};
use serde::Serialize;

/// Where pieces of contours end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum JunctionKind {
    /// A vertex of the part, or the apex of a cone.
    Vertex,
    /// Two contours cross in the image, one in front of the other in space (definition 4.4).
    T,
    /// The line of sight is along the limb (definition 4.5).
    Cusp,
    /// A limb ends on the boundary of its face.
    Limb,
    /// A limb crosses itself in space.
    #[serde(rename = "node")]
    SelfCrossing,
    /// The image of the curve turns back on itself.
    #[serde(rename = "turn")]
    ImageTurn,
    /// The near plane cuts the contour.
    #[serde(rename = "cut")]
    NearPlane,
}

/// A point where pieces of contours end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Junction {
    /// Its index in the list.
    pub id: u32,
    /// Its kind.
    pub kind: JunctionKind,
    /// Its position in the image, in the camera's unit.
    #[serde(rename = "point2")]
    pub image_point: [f64; 2],
    /// Its position in space; at a T-junction, on the farther contour.
    #[serde(rename = "point3")]
    pub space_point: [f64; 3],
    /// The contours there; at a T-junction the nearer one first.
    pub contours: Vec<u32>,
}

/// The entity of the boundary that a junction lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum JunctionSupport {
    /// A vertex.
    Vertex(VertexId),
    /// The inside of an edge.
    Edge(EdgeId),
    /// The inside of a face, or no common entity.
    Alone,
}

/// The data of a junction that the view does not report.
#[derive(Clone, Copy, Debug)]
struct Known {
    site: JunctionSupport,
    /// Its image at depth one.
    image: [f64; 2],
    /// Whether another contour passes in front of it or next to it in the image.
    crowded: bool,
}

/// All junctions.
#[derive(Debug)]
pub struct Junctions<'p> {
    projection: &'p Projection,
    /// By their ids.
    pub(crate) list: Vec<Junction>,
    /// By junction: the data that the view does not report.
    known: Vec<Known>,
    vertices: Vec<Option<u32>>,
}

impl<'p> Junctions<'p> {
    /// An empty list, for a part with a number of vertices.
    pub fn new(projection: &'p Projection, vertices: usize) -> Self {
        Self {
            projection,
            list: Vec::with_capacity(2 * vertices),
            known: Vec::with_capacity(2 * vertices),
            vertices: vec![None; vertices],
        }
    }

    /// A new junction.
    pub(crate) fn add(
        &mut self,
        kind: JunctionKind,
        site: JunctionSupport,
        p: &Point3<f64>,
    ) -> u32 {
        let id = self.list.len() as u32;
        self.list.push(Junction {
            id,
            kind,
            image_point: self.projection.project(p).into(),
            space_point: (*p).into(),
            contours: Vec::new(),
        });
        self.known.push(Known {
            site,
            image: flat_of(self.projection, p),
            crowded: false,
        });
        id
    }

    /// The entity that a junction lies on.
    pub(crate) fn site(&self, id: u32) -> JunctionSupport {
        self.known[id as usize].site
    }

    /// Its image at depth one.
    pub(crate) fn image(&self, id: u32) -> [f64; 2] {
        self.known[id as usize].image
    }

    /// Its kind.
    pub(crate) fn kind(&self, id: u32) -> JunctionKind {
        self.list[id as usize].kind
    }

    /// Marks a junction that another contour passes in the image.
    pub(crate) fn mark_ambiguous(&mut self, id: u32) {
        self.known[id as usize].crowded = true;
    }

    /// Whether another contour passes it in the image.
    pub(crate) fn is_ambiguous(&self, id: u32) -> bool {
        self.known[id as usize].crowded
    }

    /// The junction at a vertex.
    pub(crate) fn vertex(&mut self, vertex: VertexId, p: &Point3<f64>) -> u32 {
        if let Some(id) = self.vertices[vertex.index()] {
            return id;
        }
        let id = self.add(JunctionKind::Vertex, JunctionSupport::Vertex(vertex), p);
        self.vertices[vertex.index()] = Some(id);
        id
    }
}
