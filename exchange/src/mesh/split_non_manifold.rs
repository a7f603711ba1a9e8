//! A mesh taken apart where more than two of its triangles share a side, or fans of them a corner.
//!
//! As the edges of the boundary are: of the faces around an edge those go together that enclose
//! material between them, and a corner is one within a fan of triangles.

use super::{Facet, Facets, MeshError};
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{CoedgeId, EdgeId, FaceId, Sense};
use premio_kernel::tessellation::Mesh;
use std::collections::HashMap;

/// The side from corner `k` of triangle `t` to the next is number `3 t + k`.
type Side = usize;

/// Which two coedges lie on both sides of the same material.
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
        // Around the corner: the other side of each side ends in it, and the next one starts there.
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

/// The side after a side, in its triangle.
fn next(side: Side) -> Side {
    if side % 3 == 2 { side - 2 } else { side + 1 }
}

/// The points at the start and at the end of a side.
fn ends(mesh: &Mesh, side: Side) -> [u32; 2] {
    let corners = mesh.triangles[side / 3].corners;
    [corners[side % 3], corners[next(side) % 3]]
}

/// The sides of a mesh's triangles.
struct Sides<'a> {
    brep: &'a Brep,
    mesh: &'a Mesh,
}

impl Sides<'_> {
    /// Of every side the one that it is glued to.
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

    /// The edges along each pair of neighbouring points, with the sense of the first to the second.
    fn edges(&self) -> HashMap<[u32; 2], Vec<(EdgeId, Sense)>> {
        let mut edges: HashMap<_, Vec<_>> = HashMap::new();
        for (edge, line) in self.brep.topology.edge_ids().zip(&self.mesh.lines) {
            for pair in line.windows(2) {
                let (a, b) = (pair[0], pair[1]);
                edges.entry([a, b]).or_default().push((edge, Sense::Along));
                edges
                    .entry([b, a])
                    .or_default()
                    .push((edge, Sense::Against));
            }
        }
        edges
    }

    /// Glues the sides between two points to one another, as the coedges that they lie along are.
    fn pair(
        &self,
        crowd: &[Side],
        edges: &HashMap<[u32; 2], Vec<(EdgeId, Sense)>>,
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
            let mut fitting = along.flat_map(|&(edge, sense)| {
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
