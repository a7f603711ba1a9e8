//! The topology: incidences of entities, without coordinates.

pub use crate::geometry::sense::Sense;

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident),*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
        pub struct $name(pub u32);

        impl $name {
            /// The index in the arena.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}

ids! {
    /// A vertex.
    VertexId,
    /// An edge.
    EdgeId,
    /// The use of an edge by a loop.
    CoedgeId,
    /// A loop of coedges around a face.
    LoopId,
    /// A face.
    FaceId,
    /// A connected shell of faces.
    ShellId,
    /// A lump: a connected solid.
    LumpId,
    /// A point at which the boundary touches itself.
    TouchId
}

/// An edge: a piece of a curve where faces meet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Its first and its last vertex; none for a closed edge.
    pub ends: Option<[VertexId; 2]>,
    /// Its uses, in the order of their faces around it, counterclockwise as seen against the edge's
    /// direction. A pair (2i, 2i+1) encloses material.
    pub coedges: Vec<CoedgeId>,
    /// Whether it has two faces whose normals agree along it.
    pub smooth: bool,
}

/// The use of an edge by a loop: the face lies to the left, seen from outside the material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coedge {
    /// The edge.
    pub edge: EdgeId,
    /// Whether it runs in the edge's direction.
    pub sense: Sense,
    /// The loop it belongs to.
    pub owner: LoopId,
}

/// A closed sequence of coedges.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loop {
    /// The coedges in order; the end of each is the start of the next.
    pub coedges: Vec<CoedgeId>,
    /// The face it bounds.
    pub face: FaceId,
}

/// A face: a maximal connected piece of one surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Face {
    /// Its loops; none if the face is a whole closed surface.
    pub loops: Vec<LoopId>,
    /// Its shell.
    pub shell: ShellId,
    /// Its Euler characteristic.
    pub euler: i32,
}

/// A connected shell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shell {
    /// Its faces.
    pub faces: Vec<FaceId>,
    /// The solid it bounds.
    pub solid: LumpId,
    /// Whether it bounds a void.
    pub void: bool,
    /// Its genus: one minus half its Euler characteristic.
    pub genus: i32,
    /// Whether the characteristic is odd, which is impossible for a closed shell.
    pub odd: bool,
}

/// A lump: a connected solid with one outer shell, then its voids.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lump {
    /// The outer shell first.
    pub shells: Vec<ShellId>,
}

/// A point at which the boundary touches itself, so that the faces around it do not form a disc. At
/// least two of these meet there: a fan of faces around a vertex, the interior of an edge, the
/// interior of a face.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NonManifoldPoint {
    /// The vertex there, where edges end.
    pub vertex: Option<VertexId>,
    /// The number of fans of faces at the vertex; zero without a vertex.
    pub fans: usize,
    /// The edges that run through the point.
    pub edges: Vec<EdgeId>,
    /// The faces that contain the point in their interior.
    pub faces: Vec<FaceId>,
}

/// The entities of a boundary.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Topology {
    /// The number of vertices.
    pub vertices: u32,
    /// The edges, by id.
    pub edges: Vec<Edge>,
    /// The coedges, by id.
    pub coedges: Vec<Coedge>,
    /// The loops, by id.
    pub loops: Vec<Loop>,
    /// The faces, by id.
    pub faces: Vec<Face>,
    /// The shells, by id.
    pub shells: Vec<Shell>,
    /// The solids, by id.
    pub solids: Vec<Lump>,
    /// The points at which the boundary touches itself, by id.
    pub touches: Vec<NonManifoldPoint>,
}

/// The number of each kind of entity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EntityCounts {
    /// Vertices, edges, loops and faces.
    pub cells: [usize; 4],
    /// The genus of every shell, in ascending order.
    pub genus: Vec<i32>,
    /// Solids.
    pub solids: usize,
    /// Points at which the boundary touches itself.
    pub touches: usize,
}

impl Topology {
    /// Counts the entities of each kind.
    pub fn census(&self) -> EntityCounts {
        let mut genus: Vec<i32> = self.shells.iter().map(|s| s.genus).collect();
        genus.sort_unstable();
        let vertices = self.vertices as usize;
        EntityCounts {
            cells: [
                vertices,
                self.edges.len(),
                self.loops.len(),
                self.faces.len(),
            ],
            genus,
            solids: self.solids.len(),
            touches: self.touches.len(),
        }
    }

    /// An edge.
    ///
    /// # Panics
    /// The boundary has no such edge.
    pub fn edge(&self, id: EdgeId) -> &Edge {
        &self.edges[id.index()]
    }

    /// A coedge.
    ///
    /// # Panics
    /// The boundary has no such coedge.
    pub fn coedge(&self, id: CoedgeId) -> &Coedge {
        &self.coedges[id.index()]
    }

    /// A loop.
    ///
    /// # Panics
    /// The boundary has no such loop.
    pub fn ring(&self, id: LoopId) -> &Loop {
        &self.loops[id.index()]
    }

    /// A face.
    ///
    /// # Panics
    /// The boundary has no such face.
    pub fn face(&self, id: FaceId) -> &Face {
        &self.faces[id.index()]
    }

    /// The face on which a coedge lies.
    ///
    /// # Panics
    /// The boundary has no such coedge.
    pub fn face_of(&self, id: CoedgeId) -> FaceId {
        self.ring(self.coedge(id).owner).face
    }

    /// The coedges of a face, in the order of its loops.
    ///
    /// # Panics
    /// The boundary has no such face.
    pub fn coedges_of(&self, id: FaceId) -> impl Iterator<Item = CoedgeId> + '_ {
        let loops = self.face(id).loops.iter();
        loops.flat_map(|&l| self.ring(l).coedges.iter().copied())
    }

    /// The edges of a face, in the order of its loops. An edge with the face on both sides occurs
    /// twice.
    ///
    /// # Panics
    /// The boundary has no such face.
    pub fn edges_of(&self, id: FaceId) -> impl Iterator<Item = EdgeId> + '_ {
        self.coedges_of(id).map(|c| self.coedge(c).edge)
    }

    /// The faces around an edge, in order.
    ///
    /// # Panics
    /// The boundary has no such edge.
    pub fn faces_of(&self, id: EdgeId) -> impl Iterator<Item = FaceId> + '_ {
        self.edge(id).coedges.iter().map(|&c| self.face_of(c))
    }

    /// The number of edges that bound more than two face corners, along which the boundary is not a
    /// manifold.
    pub fn edges_of_many_faces(&self) -> usize {
        self.edges.iter().filter(|e| e.coedges.len() > 2).count()
    }

    /// The start and end of a coedge; none for a closed edge.
    ///
    /// # Panics
    /// The boundary has no such coedge.
    pub fn run(&self, id: CoedgeId) -> Option<[VertexId; 2]> {
        let c = self.coedge(id);
        let [a, b] = self.edge(c.edge).ends?;
        Some(match c.sense {
            Sense::Along => [a, b],
            Sense::Against => [b, a],
        })
    }

    /// The ids of all edges.
    pub fn edge_ids(&self) -> impl Iterator<Item = EdgeId> + use<> {
        (0..self.edges.len() as u32).map(EdgeId)
    }

    /// The ids of all faces.
    pub fn face_ids(&self) -> impl Iterator<Item = FaceId> + use<> {
        (0..self.faces.len() as u32).map(FaceId)
    }
}
