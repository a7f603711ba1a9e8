//! A triangle mesh of a boundary, watertight and within a stated distance of it.
//!
//! Every edge is divided once (`edges`), so that the faces on its sides share its points. Each face
//! is mapped to a plane (`charts`), where the divided edges are the constraints of a Delaunay
//! triangulation (`face_triangulation`). Where their chords cross there, the edges are divided
//! further. Points are then added inside until the triangles approximate the surface (`refine`).
//!
//! A mesh serves for display, for other programs and for checks. No other result depends on it.

mod charts;
mod chord_test;
mod edges;
mod face_triangulation;
mod refine;

use crate::brep::Brep;
use crate::brep::topology::FaceId;
use crate::hash::HashMap;
use charts::Chart;
use edges::{Division, Polylines};
use face_triangulation::FaceTriangulation;
use nalgebra::{Point3, Vector3};
use refine::Refiner;

/// The accuracy of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// The greatest distance from a triangle to the surface, in the part's unit.
    pub deviation: f64,
    /// The greatest angle between the normals at the ends of a triangle's side, in radians.
    pub angle: f64,
}

impl Accuracy {
    /// The accuracy for a fraction of this deviation. The deviation is proportional to the square
    /// of the angle.
    fn part(&self, part: f64) -> Self {
        Self {
            deviation: self.deviation * part,
            angle: self.angle * part.sqrt(),
        }
    }
}

/// A triangle of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangle {
    /// The indices of its corners, counterclockwise as seen from outside the material.
    pub corners: [u32; 3],
    /// The face it follows.
    pub face: FaceId,
}

/// A mesh of triangles. Every side of a triangle is a side of exactly one other in the opposite
/// direction, except along an edge of more than two faces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// The corners.
    pub points: Vec<Point3<f64>>,
    /// The triangles, face by face.
    pub triangles: Vec<Triangle>,
    /// The points along each edge of the boundary, in increasing order of its parameter. The first
    /// and the last of a closed edge are the same.
    pub lines: Vec<Vec<u32>>,
}

/// Why a boundary cannot be tessellated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TessellationError {
    /// The chords of a face's edges cross, however finely the edges are divided.
    #[error("the edges of face {} are too close to one another for triangles", face.0)]
    Crossing {
        /// The face.
        face: FaceId,
    },
    /// The edges of a face do not determine its inside.
    #[error("the edges of face {} do not determine which side is inside", face.0)]
    Sides {
        /// The face.
        face: FaceId,
    },
    /// The accuracy requires too many triangles.
    #[error("face {} takes more than {limit} points", face.0)]
    TooMany {
        /// The face.
        face: FaceId,
        /// The largest number of points of a face.
        limit: usize,
    },
}

/// The largest number of points of a face.
const LIMIT: usize = 1 << 20;

/// The number of nodes that the edges of a face may get where their chords cross. With more they are
/// too close to one another.
const DIVISIONS: usize = 1 << 16;

/// The number of times that the edges are divided further.
const ROUNDS: usize = 40;

/// The mesh of a boundary; `resolution` is the part's.
///
/// # Errors
/// The edges of a face are too close for triangles or do not determine its inside, or the accuracy
/// takes too many points.
pub fn tessellate(
    brep: &Brep,
    accuracy: &Accuracy,
    resolution: f64,
) -> Result<Mesh, TessellationError> {
    let mut lines = Polylines::new(brep, accuracy, resolution)?;
    let charts: Vec<Chart> = brep
        .topology
        .face_ids()
        .map(|face| Chart::new(brep, face, &lines, accuracy, resolution))
        .collect();
    let faces = brep.topology.face_ids();
    let nodes: Vec<usize> = faces.map(|face| lines.nodes_of(brep, face)).collect();
    if let Some(face) = nodes.iter().position(|&count| count > LIMIT) {
        let face = FaceId(face as u32);
        return Err(TessellationError::TooMany { face, limit: LIMIT });
    }
    let mut domains: Vec<Option<FaceTriangulation>> = charts.iter().map(|_| None).collect();
    for round in 0.. {
        let mut divisions: Vec<Division> = Vec::new();
        let mut settled = true;
        for face in brep.topology.face_ids() {
            let (chart, domain) = (&charts[face.index()], &mut domains[face.index()]);
            if domain.as_ref().is_some_and(|d| d.is_current(&lines)) {
                continue;
            }
            if round == ROUNDS {
                return Err(TessellationError::Crossing { face });
            }
            if lines.nodes_of(brep, face) > nodes[face.index()] + DIVISIONS {
                return Err(TessellationError::Crossing { face });
            }
            settled = false;
            match FaceTriangulation::new(brep, face, chart, accuracy, &mut lines) {
                Ok(found) => *domain = Some(found),
                Err(found) => divisions.extend(found),
            }
        }
        if settled {
            break;
        }
        lines.divide(brep, divisions);
    }
    let mut growth = Refiner::new(brep, accuracy, lines);
    for (face, domain) in brep.topology.face_ids().zip(domains.into_iter().flatten()) {
        growth.add(face, &charts[face.index()], domain)?;
    }
    let mut mesh = growth.mesh;
    mesh.drop_unused();
    Ok(mesh)
}

impl Mesh {
    /// Removes the points that no triangle and no edge uses.
    fn drop_unused(&mut self) {
        let mut used = vec![false; self.points.len()];
        let corners = self.triangles.iter().flat_map(|t| t.corners);
        for point in corners.chain(self.lines.iter().flatten().copied()) {
            used[point as usize] = true;
        }
        let mut place = vec![0; self.points.len()];
        let mut kept = Vec::new();
        for (i, &p) in self.points.iter().enumerate().filter(|(i, _)| used[*i]) {
            place[i] = kept.len() as u32;
            kept.push(p);
        }
        let corners = self.triangles.iter_mut().flat_map(|t| &mut t.corners);
        for point in corners.chain(self.lines.iter_mut().flatten()) {
            *point = place[*point as usize];
        }
        self.points = kept;
    }

    /// The outward unit normals of the face at the corners of a triangle. At a cone's apex or a
    /// torus's pole, that at the middle of the opposite side.
    ///
    /// # Panics
    /// The mesh has no such points, or the boundary no such face.
    pub fn normals(&self, brep: &Brep, triangle: &Triangle) -> [Vector3<f64>; 3] {
        let corners = triangle.corners.map(|c| self.points[c as usize]);
        [0, 1, 2].map(|k: usize| {
            let across = nalgebra::center(&corners[(k + 1) % 3], &corners[(k + 2) % 3]);
            let is_at = |apex: Point3<f64>| {
                let from = |p: &Point3<f64>| (p - apex).norm();
                from(&corners[k]) <= from(&across) * chord_test::APEX
            };
            let on = match brep.surface(triangle.face).apexes().any(is_at) {
                true => across,
                false => corners[k],
            };
            brep.outward(triangle.face, &on).normalize()
        })
    }

    /// The enclosed volume, by the divergence theorem.
    pub fn volume(&self) -> f64 {
        let corner = |i: u32| self.points[i as usize].coords;
        let six = self.triangles.iter().map(|t| {
            let [a, b, c] = t.corners.map(corner);
            a.dot(&b.cross(&c))
        });
        six.sum::<f64>() / 6.0
    }

    /// Whether every side of a triangle is a side of another in the opposite direction.
    pub fn is_watertight(&self) -> bool {
        let mut open: HashMap<[u32; 2], i32> = HashMap::default();
        for t in &self.triangles {
            for k in 0..3 {
                let (a, b) = (t.corners[k], t.corners[(k + 1) % 3]);
                let (side, run) = if a < b { ([a, b], 1) } else { ([b, a], -1) };
                *open.entry(side).or_default() += run;
            }
        }
        open.values().all(|&n| n == 0)
    }
}
