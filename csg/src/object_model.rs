//! The topological object model (`premio.object/1`): five levels and two relations.
//!
//! The levels are: world; objects; faces; the surface and the boundaries of each face; arcs. The
//! relations are the edge relation (faces that share an arc) and the vertex relation (arcs that end
//! at a vertex). In addition it lists the touches, the non-manifold points in which the boundary
//! touches itself. Every entity is identified by its index in its list.

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

/// The first level: everything.
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
    /// The fourth level, together with each face's surface: closed sequences of arcs.
    pub boundaries: Vec<ModelBoundary>,
    /// The fifth level: pieces of curves.
    pub arcs: Vec<ModelArc>,
    /// Points where arcs end.
    pub vertices: Vec<Vertex>,
    /// The incidences.
    pub relations: Relations,
}

/// A connected solid.
#[derive(Clone, Debug, Serialize)]
pub struct Object {
    /// Its index in the list.
    pub id: LumpId,
    /// Its outer shell, then its voids.
    pub shells: Vec<ShellId>,
}

/// A connected closed surface.
#[derive(Clone, Debug, Serialize)]
pub struct ModelShell {
    /// Its index in the list.
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
    /// Its index in the list.
    pub id: FaceId,
    /// Its shell.
    pub shell: ShellId,
    /// Its surface.
    #[serde(serialize_with = "json::surface")]
    pub surface: Surface,
    /// Whether the solid lies on the inner side of the surface: below a plane, inside a curved one.
    pub inside: bool,
    /// Its Euler characteristic: 1 for a disc, minus 1 for each hole and 2 for each handle.
    pub euler: i32,
    /// Its boundaries; none if the face is a whole closed surface.
    pub boundaries: Vec<LoopId>,
}

/// A closed sequence of arcs around a face, which lies to its left as seen from outside the solid.
#[derive(Clone, Debug, Serialize)]
pub struct ModelBoundary {
    /// Its index in the list.
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
    /// Whether it runs in the arc's direction.
    pub forward: bool,
}

/// A piece of a curve.
#[derive(Clone, Debug, Serialize)]
pub struct ModelArc {
    /// Its index in the list.
    pub id: EdgeId,
    /// Its curve.
    #[serde(serialize_with = "json::curve")]
    pub curve: Curve,
    /// The range of the curve's parameter, increasing.
    pub range: [f64; 2],
    /// Its first and last vertex; null if it is closed without a vertex.
    pub ends: Option<[VertexId; 2]>,
    /// Whether the normal is continuous across it.
    pub smooth: bool,
}

/// A point where arcs end.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Vertex {
    /// Its index in the list.
    pub id: VertexId,
    /// The location.
    pub point: [f64; 3],
}

/// The incidences.
#[derive(Clone, Debug, Serialize)]
pub struct Relations {
    /// The faces that share each arc, in order around it.
    pub edge: Vec<EdgeRelation>,
    /// The arcs that end at each vertex.
    pub vertex: Vec<VertexRelation>,
    /// The entities that meet at each point in which the boundary touches itself.
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
    /// The arcs; an arc with both ends here occurs twice.
    pub arcs: Vec<EdgeId>,
}

/// A point at which the boundary touches itself. At least two of these meet there: a fan of faces
/// around a vertex, the interior of an arc, the interior of a face.
#[derive(Clone, Debug, Serialize)]
pub struct TouchRelation {
    /// The location.
    pub point: [f64; 3],
    /// The vertex there; null if no arc ends there.
    pub vertex: Option<VertexId>,
    /// The number of fans of faces at the vertex.
    pub fans: usize,
    /// The arcs that run through the point.
    pub arcs: Vec<EdgeId>,
    /// The faces that contain the point in their interior.
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
