//! The combinatorics of a boundary: its incidences and their order, without coordinates.
//!
//! Every entity gets a colour, initially from its kind. Repeatedly each colour is combined with
//! those of the neighbours, in their order where there is one (Weisfeiler and Leman, 1968).
//! Boundaries that differ only in numbering end with the same colours; others hardly ever do.

use super::Brep;
use super::topology::{CoedgeId, EdgeId, Sense, Topology};
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};

/// The number of rounds of refinement.
const ROUNDS: usize = 12;

/// The combinatorics of a boundary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Signature {
    /// Solids, shells, faces, edges, vertices and touches.
    pub counts: [usize; 6],
    /// The colours of the coedges, and of the shells with their faces, in order.
    colours: [Vec<u64>; 2],
}

fn colour(of: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    of.hash(&mut hasher);
    hasher.finish()
}

fn sorted(colours: impl Iterator<Item = u64>) -> Vec<u64> {
    let mut all: Vec<u64> = colours.collect();
    all.sort_unstable();
    all
}

/// The colour of a cyclic sequence, independent of its starting point.
fn cycle(colours: &[u64]) -> u64 {
    let n = colours.len();
    let turned = |k: usize| -> Vec<u64> { (0..n).map(|i| colours[(i + k) % n]).collect() };
    colour((0..n).map(turned).min())
}

struct Colouring<'a> {
    topology: &'a Topology,
    coedges: Vec<u64>,
    faces: Vec<u64>,
    vertices: Vec<u64>,
}

impl Signature {
    /// The combinatorics of a boundary.
    pub fn new(brep: &Brep) -> Self {
        let topology = &brep.topology;
        let kind = |face| {
            let entity = topology.face(face);
            let shell = &topology.shells[entity.shell.index()];
            let surface = brep.surface(face).kind();
            colour((
                surface as u8,
                entity.euler,
                entity.loops.len(),
                shell.void,
                shell.genus,
            ))
        };
        let mut colouring = Colouring {
            topology,
            coedges: vec![0; topology.coedges.len()],
            faces: topology.face_ids().map(kind).collect(),
            vertices: vec![0; topology.vertices as usize],
        };
        for touch in &topology.touches {
            if let Some(v) = touch.vertex {
                colouring.vertices[v.index()] =
                    colour((touch.fans, touch.edges.len(), touch.faces.len()));
            }
        }
        for _ in 0..ROUNDS {
            colouring.spread();
        }
        let shells = topology.shells.iter().map(|shell| {
            let faces = shell.faces.iter().map(|f| colouring.faces[f.index()]);
            let siblings = topology.solids[shell.solid.index()].shells.len();
            colour((sorted(faces), shell.void, shell.genus, siblings))
        });
        Self {
            counts: [
                topology.solids.len(),
                topology.shells.len(),
                topology.faces.len(),
                topology.edges.len(),
                topology.vertices as usize,
                topology.touches.len(),
            ],
            colours: [sorted(colouring.coedges.iter().copied()), sorted(shells)],
        }
    }
}

impl Colouring<'_> {
    fn spread(&mut self) {
        let all = (0..self.coedges.len() as u32).map(|i| self.coedge(CoedgeId(i)));
        let coedges = all.collect();
        self.coedges = coedges;
        self.faces = self
            .topology
            .face_ids()
            .map(|f| {
                let face = self.topology.face(f);
                let loops = face.loops.iter().map(|&l| {
                    let ring = &self.topology.ring(l).coedges;
                    cycle(
                        &ring
                            .iter()
                            .map(|c| self.coedges[c.index()])
                            .collect::<Vec<_>>(),
                    )
                });
                colour((self.faces[f.index()], sorted(loops)))
            })
            .collect();
        let mut at: Vec<Vec<u64>> = vec![Vec::new(); self.vertices.len()];
        for i in 0..self.coedges.len() as u32 {
            if let Some([start, _]) = self.topology.run(CoedgeId(i)) {
                at[start.index()].push(self.coedges[i as usize]);
            }
        }
        for (vertex, out) in self.vertices.iter_mut().zip(at) {
            *vertex = colour((*vertex, sorted(out.into_iter())));
        }
    }

    fn coedge(&self, id: CoedgeId) -> u64 {
        let topology = self.topology;
        let coedge = topology.coedge(id);
        let ring = &topology.ring(coedge.owner).coedges;
        let n = ring.len();
        let place = ring.iter().position(|&c| c == id).unwrap_or(0);
        let next = self.coedges[ring[(place + 1) % n].index()];
        let before = self.coedges[ring[(place + n - 1) % n].index()];
        let ends = topology
            .run(id)
            .map(|ends| ends.map(|v| self.vertices[v.index()]));
        let around = self.around(coedge.edge, id);
        let smooth = topology.edge(coedge.edge).smooth;
        let face = self.faces[topology.face_of(id).index()];
        colour((
            self.coedges[id.index()],
            next,
            before,
            ends,
            around,
            smooth,
            face,
        ))
    }

    /// The colours of the coedges around an edge in their order, from one of them on. Coedges along
    /// the edge and against it see them in opposite orders.
    fn around(&self, edge: EdgeId, from: CoedgeId) -> Vec<u64> {
        let all = &self.topology.edge(edge).coedges;
        let n = all.len();
        let place = all.iter().position(|&c| c == from).unwrap_or(0);
        let step = match self.topology.coedge(from).sense {
            Sense::Along => 1,
            Sense::Against => n - 1,
        };
        (0..n)
            .map(|k| self.coedges[all[(place + k * step) % n].index()])
            .collect()
    }
}
