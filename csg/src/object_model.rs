//! The topological object model (`premio.object/1`): five levels and two relations.
//!
//! World, objects, faces, each with its surface and its boundaries, and arcs; the edge relation
//! (faces that share an arc) and the vertex relation (arcs that meet at a vertex); next to them the
//! touches, where the boundary meets itself in a point and is no manifold. Every entity is named by
//! its place in its list.

use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{
    CoedgeId, EdgeId, FaceId, LoopId, LumpId, Sense, ShellId, VertexId,
};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::json;
use premio_kernel::geometry::surface::Surface;
use serde::Serialize;

/// The name of the format.
pub const SCHEMA: &str = "premio.object/1";

/// The first level: all there is.
#[derive(Clone, Debug, Serialize)]
pub struct ObjectModel {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// The second level: connected solids.
    pub objects: Vec<Object>,
    /// The shells that bound the objects.
    pub shells: Vec<ModelShell>,
    /// The third level: maximal pieces of one surface.
    pub faces: Vec<ModelFace>,
    /// The fourth level, next to each face's surface: closed runs of arcs.
    pub boundaries: Vec<ModelBoundary>,
    /// The fifth level: pieces of curves.
    pub arcs: Vec<ModelArc>,
    /// Points where arcs end.
    pub vertices: Vec<Vertex>,
    /// Who meets whom.
    pub relations: Relations,
}

/// A connected solid.
#[derive(Clone, Debug, Serialize)]
pub struct Object {
    /// Its place in the list.
    pub id: LumpId,
    /// Its outer shell, then its voids.
    pub shells: Vec<ShellId>,
}

/// A connected closed surface.
#[derive(Clone, Debug, Serialize)]
pub struct ModelShell {
    /// Its place in the list.
    pub id: ShellId,
    /// The object it bounds.
    pub object: LumpId,
    /// Whether it bounds a void.
    pub void: bool,
    /// Its genus.
    pub genus: i32,
    /// Its faces.
    pub faces: Vec<FaceId>,
}

/// A maximal piece of one surface.
#[derive(Clone, Debug, Serialize)]
pub struct ModelFace {
    /// Its place in the list.
    pub id: FaceId,
    /// Its shell.
    pub shell: ShellId,
    /// Its surface.
    #[serde(serialize_with = "json::surface")]
    pub surface: Surface,
    /// Whether the solid lies on the inside of the surface: below a plane, within a round one.
    pub inside: bool,
    /// Its Euler characteristic: 1 for a disc, less 1 for each hole and 2 for each handle.
    pub euler: i32,
    /// Its boundaries; none where the face is a whole closed surface.
    pub boundaries: Vec<LoopId>,
}

/// A closed run of arcs around a face, which lies to its left as seen from outside the solid.
#[derive(Clone, Debug, Serialize)]
pub struct ModelBoundary {
    /// Its place in the list.
    pub id: LoopId,
    /// The face it bounds.
    pub face: FaceId,
    /// The arcs, in order.
    pub arcs: Vec<ArcUse>,
}

/// The use of an arc by a boundary.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ArcUse {
    /// The arc.
    pub arc: EdgeId,
    /// Whether it is run along its own direction.
    pub forward: bool,
}

/// A piece of a curve.
#[derive(Clone, Debug, Serialize)]
pub struct ModelArc {
    /// Its place in the list.
    pub id: EdgeId,
    /// Its curve.
    #[serde(serialize_with = "json::curve")]
    pub curve: Curve,
    /// The range of the curve's parameter, increasing.
    pub range: [f64; 2],
    /// Its first and its last vertex; null where it is closed without a vertex.
    pub ends: Option<[VertexId; 2]>,
    /// Whether the normal does not jump across it.
    pub smooth: bool,
}

/// A point where arcs end.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Vertex {
    /// Its place in the list.
    pub id: VertexId,
    /// Where it is.
    pub point: [f64; 3],
}

/// Who meets whom.
#[derive(Clone, Debug, Serialize)]
pub struct Relations {
    /// The faces that share each arc, in order around it.
    pub edge: Vec<EdgeRelation>,
    /// The arcs that end at each vertex.
    pub vertex: Vec<VertexRelation>,
    /// What meets in each point at which the boundary touches itself.
    pub touch: Vec<TouchRelation>,
}

/// The faces that share an arc.
#[derive(Clone, Debug, Serialize)]
pub struct EdgeRelation {
    /// The arc.
    pub arc: EdgeId,
    /// The faces, in order around it, counterclockwise as seen against its direction.
    pub faces: Vec<FaceId>,
}

/// The arcs that end at a vertex.
#[derive(Clone, Debug, Serialize)]
pub struct VertexRelation {
    /// The vertex.
    pub vertex: VertexId,
    /// The arcs; twice where both ends are here.
    pub arcs: Vec<EdgeId>,
}

/// A point at which the boundary touches itself: two or more of a fan of faces around a vertex, the
/// inside of an arc and the inside of a face.
#[derive(Clone, Debug, Serialize)]
pub struct TouchRelation {
    /// Where it is.
    pub point: [f64; 3],
    /// The vertex there; null where no arc ends.
    pub vertex: Option<VertexId>,
    /// How many fans of faces meet in the vertex.
    pub fans: usize,
    /// The arcs that run through the point.
    pub arcs: Vec<EdgeId>,
    /// The faces that hold the point inside.
    pub faces: Vec<FaceId>,
}

impl ObjectModel {
    /// The model of a boundary.
    pub fn new(brep: &Brep) -> Self {
        Self {
            schema: SCHEMA,
            objects: objects(brep),
            shells: shells(brep),
            faces: brep.topology.face_ids().map(|f| face(brep, f)).collect(),
            boundaries: boundaries(brep),
            arcs: brep.topology.edge_ids().map(|e| arc(brep, e)).collect(),
            vertices: vertices(brep),
            relations: Relations {
                edge: edge_relation(brep),
                vertex: vertex_relation(brep),
                touch: touch_relation(brep),
            },
        }
    }
}

fn objects(brep: &Brep) -> Vec<Object> {
    let solids = (0..).map(LumpId).zip(&brep.topology.solids);
    solids
        .map(|(id, solid)| Object {
            id,
            shells: solid.shells.clone(),
        })
        .collect()
}

fn shells(brep: &Brep) -> Vec<ModelShell> {
    let shells = (0..).map(ShellId).zip(&brep.topology.shells);
    shells
        .map(|(id, shell)| ModelShell {
            id,
            object: shell.solid,
            void: shell.void,
            genus: shell.genus,
            faces: shell.faces.clone(),
        })
        .collect()
}

fn face(brep: &Brep, id: FaceId) -> ModelFace {
    let face = brep.topology.face(id);
    ModelFace {
        id,
        shell: face.shell,
        surface: *brep.surface(id),
        inside: brep.sense(id) == Sense::Along,
        euler: face.euler,
        boundaries: face.loops.clone(),
    }
}

fn boundaries(brep: &Brep) -> Vec<ModelBoundary> {
    let used = |&coedge: &CoedgeId| {
        let coedge = brep.topology.coedge(coedge);
        ArcUse {
            arc: coedge.edge,
            forward: coedge.sense == Sense::Along,
        }
    };
    let loops = (0..).map(LoopId).zip(&brep.topology.loops);
    loops
        .map(|(id, ring)| ModelBoundary {
            id,
            face: ring.face,
            arcs: ring.coedges.iter().map(used).collect(),
        })
        .collect()
}

fn arc(brep: &Brep, id: EdgeId) -> ModelArc {
    let edge = brep.topology.edge(id);
    ModelArc {
        id,
        curve: brep.curve(id).clone(),
        range: brep.range(id),
        ends: edge.ends,
        smooth: edge.smooth,
    }
}

fn vertices(brep: &Brep) -> Vec<Vertex> {
    let points = (0..).map(VertexId).zip(&brep.geometry.points);
    points
        .map(|(id, &point)| Vertex {
            id,
            point: point.into(),
        })
        .collect()
}

fn edge_relation(brep: &Brep) -> Vec<EdgeRelation> {
    let relation = |arc| EdgeRelation {
        arc,
        faces: brep.topology.faces_of(arc).collect(),
    };
    brep.topology.edge_ids().map(relation).collect()
}

fn vertex_relation(brep: &Brep) -> Vec<VertexRelation> {
    let vertices = (0..brep.topology.vertices).map(VertexId);
    let mut relation: Vec<VertexRelation> = vertices
        .map(|vertex| VertexRelation {
            vertex,
            arcs: Vec::new(),
        })
        .collect();
    for arc in brep.topology.edge_ids() {
        for end in brep.topology.edge(arc).ends.into_iter().flatten() {
            if let Some(at) = relation.get_mut(end.index()) {
                at.arcs.push(arc);
            }
        }
    }
    relation
}

fn touch_relation(brep: &Brep) -> Vec<TouchRelation> {
    let touches = brep.topology.touches.iter().zip(&brep.geometry.touches);
    touches
        .map(|(touch, &point)| TouchRelation {
            point: point.into(),
            vertex: touch.vertex,
            fans: touch.fans,
            arcs: touch.edges.clone(),
            faces: touch.faces.clone(),
        })
        .collect()
}
