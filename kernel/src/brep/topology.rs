//! Who meets whom: no coordinates here.

pub use crate::geometry::sense::Sense;

macro_rules! ids {
    ($($(#[$doc:meta])* $name:ident),*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
        pub struct $name(pub u32);

        impl $name {
            /// The place in the arena.
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
    /// Its uses, in the order in which their faces lie around it, counterclockwise as seen against
    /// the edge's direction; a pair (2i, 2i+1) encloses material.
    pub coedges: Vec<CoedgeId>,
    /// Whether it has two faces whose normals agree along it.
    pub smooth: bool,
}

/// The use of an edge by a loop: the face lies to the left, seen from outside the material.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coedge {
    /// The edge.
    pub edge: EdgeId,
    /// Whether it is run along its own direction.
    pub sense: Sense,
    /// The loop it belongs to.
    pub owner: LoopId,
}

/// A closed run of coedges.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loop {
    /// In order; the end of each is the start of the next.
    pub coedges: Vec<CoedgeId>,
    /// The face it bounds.
    pub face: FaceId,
}

/// A face: a maximal connected piece of one surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Face {
    /// Its loops; none where the face is a whole closed surface.
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
    /// Its genus: one less half its Euler characteristic.
    pub genus: i32,
    /// Whether the characteristic is odd, which no closed shell's is.
    pub odd: bool,
}

/// A lump: a connected solid with one outer shell, then its voids.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lump {
    /// The outer shell first.
    pub shells: Vec<ShellId>,
}

/// A point at which the boundary touches itself: the faces around it make no disc. What meets there
/// is two or more of: a fan of faces around a vertex, the inside of an edge, the inside of a face.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NonManifoldPoint {
    /// The vertex there, where edges end.
    pub vertex: Option<VertexId>,
    /// How many fans of faces meet in the vertex; none without one.
    pub fans: usize,
    /// The edges that run through the point.
    pub edges: Vec<EdgeId>,
    /// The faces that hold the point inside.
    pub faces: Vec<FaceId>,
}

/// The entities of a boundary.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Topology {
    /// How many vertices there are.
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

/// How many there are of each entity: what boundaries of one kind share.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EntityCounts {
    /// Vertices, edges, loops and faces.
    pub cells: [usize; 4],
    /// Of every shell the genus, in ascending order.
    pub genus: Vec<i32>,
    /// Solids.
    pub solids: usize,
    /// Points at which the boundary touches itself.
    pub touches: usize,
}

impl Topology {
    /// How many there are of each entity.
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
    pub fn edge(&self, id: EdgeId) -> &Edge {
        &self.edges[id.index()]
    }

    /// A coedge.
    pub fn coedge(&self, id: CoedgeId) -> &Coedge {
        &self.coedges[id.index()]
    }

    /// A loop.
    pub fn ring(&self, id: LoopId) -> &Loop {
        &self.loops[id.index()]
    }

    /// A face.
    pub fn face(&self, id: FaceId) -> &Face {
        &self.faces[id.index()]
    }

    /// The face on which a coedge lies.
    pub fn face_of(&self, id: CoedgeId) -> FaceId {
        self.ring(self.coedge(id).owner).face
    }

    /// The coedges of a face, as its loops run along them.
    pub fn coedges_of(&self, id: FaceId) -> impl Iterator<Item = CoedgeId> + '_ {
        let loops = self.face(id).loops.iter();
        loops.flat_map(|&l| self.ring(l).coedges.iter().copied())
    }

    /// The edges of a face, as its loops run along them: one twice, on whose both sides it lies.
    pub fn edges_of(&self, id: FaceId) -> impl Iterator<Item = EdgeId> + '_ {
        self.coedges_of(id).map(|c| self.coedge(c).edge)
    }

    /// The faces around an edge, in order.
    pub fn faces_of(&self, id: EdgeId) -> impl Iterator<Item = FaceId> + '_ {
        self.edge(id).coedges.iter().map(|&c| self.face_of(c))
    }

    /// How many edges bound more than two face corners: along them the boundary is no manifold.
    pub fn edges_of_many_faces(&self) -> usize {
        self.edges.iter().filter(|e| e.coedges.len() > 2).count()
    }

    /// Where a coedge starts and ends; none for a closed edge.
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
