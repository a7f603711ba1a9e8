//! The boundary of several bodies that have no point in common.

use super::Brep;
use super::topology::{
    Coedge, CoedgeId, Edge, EdgeId, Face, FaceId, Loop, LoopId, Lump, LumpId, NonManifoldPoint,
    Shell, ShellId, Topology, TouchId, VertexId,
};
use super::{EdgeGeometry, FaceGeometry};
use crate::number::float::Float;

/// The ids that the entities of one boundary have in another one, to which it was appended.
#[derive(Clone, Copy, Debug)]
pub struct Renumbering {
    vertices: u32,
    edges: u32,
    coedges: u32,
    loops: u32,
    faces: u32,
    shells: u32,
    solids: u32,
    touches: u32,
}

impl Renumbering {
    /// The ids of entities that follow those of a boundary.
    fn after(topology: &Topology) -> Self {
        Self {
            vertices: topology.vertices,
            edges: topology.edges.len() as u32,
            coedges: topology.coedges.len() as u32,
            loops: topology.loops.len() as u32,
            faces: topology.faces.len() as u32,
            shells: topology.shells.len() as u32,
            solids: topology.solids.len() as u32,
            touches: topology.touches.len() as u32,
        }
    }

    /// The id of a vertex.
    pub fn vertex(&self, id: VertexId) -> VertexId {
        VertexId(id.0 + self.vertices)
    }

    /// The id of an edge.
    pub fn edge(&self, id: EdgeId) -> EdgeId {
        EdgeId(id.0 + self.edges)
    }

    /// The id of a coedge.
    pub fn coedge(&self, id: CoedgeId) -> CoedgeId {
        CoedgeId(id.0 + self.coedges)
    }

    /// The id of a loop.
    pub fn ring(&self, id: LoopId) -> LoopId {
        LoopId(id.0 + self.loops)
    }

    /// The id of a face.
    pub fn face(&self, id: FaceId) -> FaceId {
        FaceId(id.0 + self.faces)
    }

    /// The id of a shell.
    pub fn shell(&self, id: ShellId) -> ShellId {
        ShellId(id.0 + self.shells)
    }

    /// The id of a solid.
    pub fn solid(&self, id: LumpId) -> LumpId {
        LumpId(id.0 + self.solids)
    }

    /// The id of a touch.
    pub fn touch(&self, id: TouchId) -> TouchId {
        TouchId(id.0 + self.touches)
    }
}

/// Every id of a list, renumbered.
fn all<Id: Copy>(ids: &[Id], renumbered: impl Fn(Id) -> Id) -> Vec<Id> {
    ids.iter().map(|&id| renumbered(id)).collect()
}

impl Topology {
    /// Appends the entities of a boundary that has no point in common with this one.
    fn append(&mut self, other: &Self) -> Renumbering {
        let ids = Renumbering::after(self);
        self.vertices += other.vertices;
        self.edges.extend(other.edges.iter().map(|edge| Edge {
            ends: edge.ends.map(|ends| ends.map(|end| ids.vertex(end))),
            coedges: all(&edge.coedges, |id| ids.coedge(id)),
            smooth: edge.smooth,
        }));
        self.coedges
            .extend(other.coedges.iter().map(|coedge| Coedge {
                edge: ids.edge(coedge.edge),
                sense: coedge.sense,
                owner: ids.ring(coedge.owner),
            }));
        self.loops.extend(other.loops.iter().map(|ring| Loop {
            coedges: all(&ring.coedges, |id| ids.coedge(id)),
            face: ids.face(ring.face),
        }));
        self.faces.extend(other.faces.iter().map(|face| Face {
            loops: all(&face.loops, |id| ids.ring(id)),
            shell: ids.shell(face.shell),
            euler: face.euler,
        }));
        self.shells.extend(other.shells.iter().map(|shell| Shell {
            faces: all(&shell.faces, |id| ids.face(id)),
            solid: ids.solid(shell.solid),
            ..*shell
        }));
        self.solids.extend(other.solids.iter().map(|solid| Lump {
            shells: all(&solid.shells, |id| ids.shell(id)),
        }));
        self.touches
            .extend(other.touches.iter().map(|touch| NonManifoldPoint {
                vertex: touch.vertex.map(|vertex| ids.vertex(vertex)),
                fans: touch.fans,
                edges: all(&touch.edges, |id| ids.edge(id)),
                faces: all(&touch.faces, |id| ids.face(id)),
            }));
        ids
    }
}

impl<N: Float> Brep<N> {
    /// Appends a boundary that has no point in common with this one, and returns the ids of its
    /// entities. Its surfaces and curves are not compared with those of this one.
    pub fn append(&mut self, other: &Self) -> Renumbering {
        let ids = self.topology.append(&other.topology);
        let (own, new) = (&mut self.geometry, &other.geometry);
        let (surfaces, curves) = (own.surfaces.len(), own.curves.len());
        own.surfaces.extend_from_slice(&new.surfaces);
        own.curves.extend_from_slice(&new.curves);
        own.points.extend_from_slice(&new.points);
        own.arcs.extend(new.arcs.iter().map(|arc| EdgeGeometry {
            curve: arc.curve + curves,
            range: arc.range,
        }));
        own.patches
            .extend(new.patches.iter().map(|patch| FaceGeometry {
                surface: patch.surface + surfaces,
                sense: patch.sense,
            }));
        own.touches.extend_from_slice(&new.touches);
        ids
    }
}
