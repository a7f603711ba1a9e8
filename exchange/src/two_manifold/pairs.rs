//! Splits edges into pairs of faces that enclose material, and vertices into fans.

use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{CoedgeId, EdgeId, FaceId, Sense, VertexId};
use premio_kernel::geometry::surface::Surface;
use std::collections::{HashMap, HashSet};

/// The edges and vertices of a boundary without seams, each edge between two sides of faces.
#[derive(Debug, Default)]
pub(super) struct Pairs {
    /// The two coedges of each edge.
    pub edges: Vec<[CoedgeId; 2]>,
    /// The edge of each coedge that remains.
    pub edge_of: HashMap<CoedgeId, usize>,
    /// The loops of each face, without slits.
    pub rings: Vec<Vec<Vec<CoedgeId>>>,
    /// The vertices at the ends of each edge; none if it is closed.
    pub ends: Vec<Option<[usize; 2]>>,
    /// The original vertex of each fan of faces.
    pub fans: Vec<VertexId>,
}

impl Pairs {
    pub fn new(brep: &Brep) -> Self {
        let topology = &brep.topology;
        let mut pairs = Self::default();
        let mut partner = HashMap::new();
        for edge in topology.edge_ids() {
            for pair in topology.edge(edge).coedges.chunks_exact(2) {
                let (a, b) = (pair[0], pair[1]);
                partner.extend([(a, b), (b, a)]);
                if topology.face_of(a) != topology.face_of(b) {
                    pairs.edge_of.extend([a, b].map(|c| (c, pairs.edges.len())));
                    pairs.edges.push([a, b]);
                }
            }
        }
        for face in topology.face_ids() {
            let rings = pairs.rings_of(brep, face, &partner);
            pairs.rings.push(match brep.surface(face) {
                // Loops around a torus close where the face touches itself, and not before.
                Surface::Torus(_) => rings,
                _ => rings.into_iter().flat_map(|r| simple(brep, r)).collect(),
            });
        }
        pairs.ends = vec![None; pairs.edges.len()];
        pairs.find_fans(brep, &partner);
        pairs
    }

    /// The loops of a face without slits. Where an edge has the same face on both sides of the
    /// material, the face continues.
    fn rings_of(
        &self,
        brep: &Brep,
        face: FaceId,
        partner: &HashMap<CoedgeId, CoedgeId>,
    ) -> Vec<Vec<CoedgeId>> {
        let topology = &brep.topology;
        let loops = &topology.face(face).loops;
        let all = || loops.iter().map(|&l| topology.ring(l).coedges.clone());
        if topology
            .coedges_of(face)
            .all(|c| self.edge_of.contains_key(&c))
        {
            return all().collect();
        }
        let mut next: HashMap<CoedgeId, CoedgeId> = HashMap::new();
        for ring in all() {
            let after = ring.iter().cycle().skip(1);
            next.extend(ring.iter().copied().zip(after.copied()));
        }
        let kept = |c: &CoedgeId| self.edge_of.contains_key(c);
        let follow = |c: CoedgeId| {
            let mut to = next[&c];
            while !kept(&to) {
                to = next[&partner[&to]];
            }
            to
        };
        let mut rings = Vec::new();
        let mut seen = HashSet::new();
        for start in topology.coedges_of(face).filter(kept) {
            let mut ring = Vec::new();
            let mut at = start;
            while seen.insert(at) {
                ring.push(at);
                at = follow(at);
            }
            rings.extend((!ring.is_empty()).then_some(ring));
        }
        rings
    }

    /// An edge of a loop that encloses nothing: the loop runs along the same edges in both
    /// directions, with only the face's outside in between.
    pub fn crack(&self, brep: &Brep) -> Option<EdgeId> {
        let mut cracks = self
            .rings
            .iter()
            .flatten()
            .filter(|ring| is_crack(brep, ring));
        let first = cracks.find_map(|ring| ring.first());
        first.map(|c| brep.topology.coedge(*c).edge)
    }

    /// Assigns vertices to every edge: around a fan, each edge's other side continues to the next
    /// edge.
    fn find_fans(&mut self, brep: &Brep, partner: &HashMap<CoedgeId, CoedgeId>) {
        let mut next: HashMap<CoedgeId, CoedgeId> = HashMap::new();
        for ring in self.rings.iter().flatten() {
            let after = ring.iter().cycle().skip(1);
            next.extend(ring.iter().copied().zip(after.copied()));
        }
        let mut fan_of: HashMap<CoedgeId, usize> = HashMap::new();
        for start in self.edges.clone().into_iter().flatten() {
            let Some([vertex, _]) = brep.topology.run(start) else {
                continue;
            };
            if fan_of.contains_key(&start) {
                continue;
            }
            let fan = self.fans.len();
            self.fans.push(vertex);
            let mut at = start;
            while fan_of.insert(at, fan).is_none() {
                at = next[&partner[&at]];
            }
        }
        for (ends, coedges) in self.ends.iter_mut().zip(&self.edges) {
            let starts = coedges.map(|c| fan_of.get(&c).copied());
            if let [Some(a), Some(b)] = starts {
                // Each side starts where the other ends.
                let along = brep.topology.coedge(coedges[0]).sense;
                *ends = Some(match along {
                    Sense::Along => [a, b],
                    Sense::Against => [b, a],
                });
            }
        }
    }
}

/// Whether a loop runs along all of its edges twice.
fn is_crack(brep: &Brep, ring: &[CoedgeId]) -> bool {
    let edge = |c: &CoedgeId| brep.topology.coedge(*c).edge;
    ring.iter().all(|c| {
        let mut others = ring.iter().filter(|other| *other != c);
        others.any(|other| edge(other) == edge(c))
    })
}

/// Splits a loop where it passes a vertex twice, so that the face touches itself there. Other
/// kernels accept simple loops only.
fn simple(brep: &Brep, mut ring: Vec<CoedgeId>) -> Vec<Vec<CoedgeId>> {
    let mut loops = Vec::new();
    let mut places: HashMap<VertexId, usize> = HashMap::new();
    let mut k = 0;
    while k < ring.len() {
        let Some([vertex, _]) = brep.topology.run(ring[k]) else {
            return vec![ring];
        };
        let visited = places.insert(vertex, k);
        let rest = |first: usize| [&ring[..first], &ring[k..]].concat();
        match visited.filter(|&f| !is_crack(brep, &ring[f..k]) && !is_crack(brep, &rest(f))) {
            Some(first) => {
                loops.push(ring.drain(first..k).collect());
                places.retain(|_, place| *place < first);
                k = first;
            }
            None => k += 1,
        }
    }
    loops.push(ring);
    loops
}
