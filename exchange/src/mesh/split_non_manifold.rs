//! Splits a mesh where more than two triangles share a side, or several fans of triangles a corner.
//!
//! The pairing is that of the boundary's edges: of the faces around an edge, those that enclose
//! material between them are paired. Each fan of triangles gets its own corner.

use super::{Facet, Facets, MeshError};
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{CoedgeId, EdgeId, FaceId, Sense};
use premio_kernel::tessellation::Mesh;
use std::collections::HashMap;

/// Side `3 t + k` runs from corner `k` of triangle `t` to the next corner.
type Side = usize;

/// The coedge on the other side of the same material.
fn partner(brep: &Brep, coedge: CoedgeId) -> Option<CoedgeId> {
    let around = &brep
        .topology
        .edge(brep.topology.coedge(coedge).edge)
        .coedges;
    let at = around.iter().position(|&c| c == coedge)?;
    around.get(at ^ 1).copied()
}

/// The triangles of a mesh, in its order.
pub(super) fn facets(brep: &Brep, mesh: &Mesh) -> Result<Facets, MeshError> {
    let twins = Sides { brep, mesh }.twins()?;
    let topology = &brep.topology;
    let mut facets = Facets::default();
    let mut corner = vec![None; twins.len()];
    for start in 0..twins.len() {
        if corner[start].is_some() {
            continue;
        }
        // Go around the corner: the twin of each side ends in it, and the next side starts there.
        let point = facets.points.len() as u32;
        let mut side = start;
        while corner[side].is_none() {
            corner[side] = Some(point);
            side = next(twins[side]);
        }
        let [from, _] = ends(mesh, start);
        facets.points.push(mesh.points[from as usize]);
    }
    for (triangle, corners) in mesh.triangles.iter().zip(corner.chunks_exact(3)) {
        let shell = topology.face(triangle.face).shell;
        facets.facets.push(Facet {
            corners: [0, 1, 2].map(|k: usize| corners[k].unwrap_or_default()),
            normals: mesh.normals(brep, triangle),
            face: triangle.face,
            solid: topology.shells[shell.index()].solid.index(),
        });
    }
    let lines = topology.edge_ids().zip(&mesh.lines);
    facets.lines = lines
        .filter(|(edge, _)| !topology.edge(*edge).smooth)
        .map(|(_, line)| line.iter().map(|&p| mesh.points[p as usize]).collect())
        .collect();
    Ok(facets)
}

/// The next side of the same triangle.
fn next(side: Side) -> Side {
    if side % 3 == 2 { side - 2 } else { side + 1 }
}

/// The points at the start and at the end of a side.
fn ends(mesh: &Mesh, side: Side) -> [u32; 2] {
    let corners = mesh.triangles[side / 3].corners;
    [corners[side % 3], corners[next(side) % 3]]
}

/// An edge along two consecutive points.
#[derive(Clone, Copy)]
struct DirectedEdge {
    edge: EdgeId,
    /// Its sense from the first point to the second.
    sense: Sense,
}

/// The sides of a mesh's triangles.
struct Sides<'a> {
    brep: &'a Brep,
    mesh: &'a Mesh,
}

impl Sides<'_> {
    /// For every side its twin.
    fn twins(&self) -> Result<Vec<Side>, MeshError> {
        let unordered = |side: &Side| {
            let [a, b] = ends(self.mesh, *side);
            [a.min(b), a.max(b)]
        };
        let mut sides: Vec<Side> = (0..3 * self.mesh.triangles.len()).collect();
        sides.sort_by_key(unordered);
        let mut twins = vec![0; sides.len()];
        let mut crowds = Vec::new();
        for group in sides.chunk_by(|a, b| unordered(a) == unordered(b)) {
            match *group {
                [a, b] if ends(self.mesh, a)[0] == ends(self.mesh, b)[1] => {
                    (twins[a], twins[b]) = (b, a);
                }
                _ => crowds.push(group),
            }
        }
        if crowds.is_empty() {
            return Ok(twins);
        }
        let edges = self.edges();
        for crowd in crowds {
            self.pair(crowd, &edges, &mut twins)?;
        }
        Ok(twins)
    }

    /// The edges along each pair of consecutive points.
    fn edges(&self) -> HashMap<[u32; 2], Vec<DirectedEdge>> {
        let mut edges: HashMap<_, Vec<_>> = HashMap::new();
        let mut add = |points: [u32; 2], edge: EdgeId, sense: Sense| {
            let directed = DirectedEdge { edge, sense };
            edges.entry(points).or_default().push(directed);
        };
        for (edge, line) in self.brep.topology.edge_ids().zip(&self.mesh.lines) {
            for pair in line.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                add([a, b], edge, Sense::Along);
                add([b, a], edge, Sense::Against);
            }
        }
        edges
    }

    /// Pairs the sides between two points, as the coedges along them are paired.
    fn pair(
        &self,
        crowd: &[Side],
        edges: &HashMap<[u32; 2], Vec<DirectedEdge>>,
        twins: &mut [Side],
    ) -> Result<(), MeshError> {
        let topology = &self.brep.topology;
        let untold = || {
            let [a, _] = ends(self.mesh, crowd[0]);
            let place = self.mesh.points[a as usize].into();
            MeshError::Touching { place }
        };
        let face = |side: Side| -> FaceId { self.mesh.triangles[side / 3].face };
        let mut side_of: HashMap<CoedgeId, Side> = HashMap::new();
        for &side in crowd {
            let along = edges.get(&ends(self.mesh, side)).into_iter().flatten();
            let mut fitting = along.flat_map(|&DirectedEdge { edge, sense }| {
                let around = topology.edge(edge).coedges.iter().copied();
                around.filter(move |&c| {
                    topology.coedge(c).sense == sense && topology.face_of(c) == face(side)
                })
            });
            let (Some(coedge), None) = (fitting.next(), fitting.next()) else {
                return Err(untold());
            };
            if side_of.insert(coedge, side).is_some() {
                return Err(untold());
            }
        }
        for (&coedge, &side) in &side_of {
            let other = partner(self.brep, coedge).and_then(|c| side_of.get(&c));
            twins[side] = *other.ok_or_else(untold)?;
        }
        Ok(())
    }
}
