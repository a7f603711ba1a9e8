//! Refinement of a face's triangulation: points are added inside until the triangles approximate
//! the surface.

use super::charts::Chart;
use super::chord_test::ChordTest;
use super::edges::Polylines;
use super::face_triangulation::{Corner, FaceTriangulation, Side};
use super::{Accuracy, LIMIT, Mesh, TessellationError, Triangle};
use crate::brep::Brep;
use crate::brep::topology::FaceId;
use crate::geometry::surface::Surface;
use crate::hash::HashSet;
use nalgebra::{Point2, Point3};
use spade::Triangulation;
use spade::handles::{FixedFaceHandle, FixedVertexHandle, InnerTag};

/// A mesh to which faces are added.
pub(super) struct Refiner<'a> {
    brep: &'a Brep,
    accuracy: &'a Accuracy,
    /// The mesh so far.
    pub mesh: Mesh,
    /// The first point that belongs to one face only.
    shared: u32,
    /// The sides between shared points: chords of edges, and inner sides of the faces added so far.
    taken: HashSet<[u32; 2]>,
}

impl<'a> Refiner<'a> {
    /// A mesh with the points of the divided edges and no triangle.
    pub fn new(brep: &'a Brep, accuracy: &'a Accuracy, lines: Polylines) -> Self {
        let along = |edge| lines.nodes(edge).iter().map(|n| n.point).collect();
        let mesh = Mesh {
            lines: brep.topology.edge_ids().map(along).collect(),
            points: lines.points,
            triangles: Vec::new(),
        };
        let chords = mesh.lines.iter().flat_map(|line| line.windows(2));
        Self {
            brep,
            accuracy,
            shared: mesh.points.len() as u32,
            taken: chords.map(|pair| unordered([pair[0], pair[1]])).collect(),
            mesh,
        }
    }

    /// Adds the triangles of a face.
    pub fn add(
        &mut self,
        face: FaceId,
        chart: &Chart,
        mut domain: FaceTriangulation,
    ) -> Result<(), TessellationError> {
        let mirrored = chart.is_mirrored(self.brep.sense(face));
        loop {
            let inside = inside(&domain, mirrored).ok_or(TessellationError::Sides { face })?;
            let surface = self.brep.surface(face);
            let points = &self.mesh.points;
            let mut missing = missing(surface, chart, &domain, &inside, self.accuracy, points);
            if missing.is_empty() {
                missing = self.doubled(&domain, &inside);
            }
            if missing.is_empty() {
                self.take(&domain, &inside);
                self.finish(face, &domain, inside, mirrored);
                return Ok(());
            }
            self.insert(face, chart, &mut domain, missing)?;
        }
    }

    /// Adds points to a face.
    fn insert(
        &mut self,
        face: FaceId,
        chart: &Chart,
        domain: &mut FaceTriangulation,
        missing: Vec<Point2<f64>>,
    ) -> Result<(), TessellationError> {
        let before = domain.net.num_vertices();
        if before + missing.len() > LIMIT {
            return Err(TessellationError::TooMany { face, limit: LIMIT });
        }
        let points = &mut self.mesh.points;
        for at in missing {
            points.push(chart.lift(&at));
            let added = domain.net.insert(Corner::new(at, points.len() as u32 - 1));
            if added.is_err() {
                return Err(TessellationError::Sides { face });
            }
        }
        // The points to be added exist already: the f64 resolution of the chart is exhausted.
        if domain.net.num_vertices() == before {
            return Err(TessellationError::Crossing { face });
        }
        Ok(())
    }

    /// The middles of sides that already exist, on an edge, on another face or across a seam.
    /// Otherwise four triangles would share one side, as at the tip of a wedge of two faces.
    fn doubled(&self, domain: &FaceTriangulation, inside: &[Inner]) -> Vec<Point2<f64>> {
        // Except at seams, a point of the face has one position in its chart.
        let mut own: HashSet<[u32; 2]> = on_seams(domain).collect();
        let has_seams = !domain.glued.is_empty();
        let sides = free_sides(domain, inside).into_iter();
        let doubled = sides.filter(|side| {
            self.taken.contains(&side.points) || (has_seams && !own.insert(side.points))
        });
        let middles = doubled.map(|FreeSide { ends: [a, b], .. }| nalgebra::center(&a.at, &b.at));
        middles.collect()
    }

    /// Records the sides between points that other faces may share.
    fn take(&mut self, domain: &FaceTriangulation, inside: &[Inner]) {
        let free = free_sides(domain, inside)
            .into_iter()
            .map(|side| side.points);
        let all = free.chain(on_seams(domain));
        let shared = self.shared;
        self.taken.extend(all.filter(|[_, last]| *last < shared));
    }

    /// Adds the triangles of a finished face.
    fn finish(
        &mut self,
        face: FaceId,
        domain: &FaceTriangulation,
        inside: Vec<Inner>,
        mirrored: bool,
    ) {
        let inside = inside.into_iter().map(|triangle| {
            let corners = domain.net.face(triangle).vertices();
            corners.map(|v| v.data().point)
        });
        for mut corners in inside.chain(domain.cap.iter().copied()) {
            if mirrored {
                corners.swap(1, 2);
            }
            self.mesh.triangles.push(Triangle { corners, face });
        }
    }
}

/// The two ends of a side, the lower first.
fn unordered([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// An inner side of a face that may be divided.
struct FreeSide {
    /// The points at its ends, the lower first.
    points: [u32; 2],
    ends: [Corner; 2],
}

/// The inner sides of a face that may be divided.
fn free_sides(domain: &FaceTriangulation, inside: &[Inner]) -> Vec<FreeSide> {
    let free = inside.iter().flat_map(|&triangle| {
        let edges = domain.net.face(triangle).adjacent_edges();
        edges.into_iter().filter(|edge| {
            let side = (edge.from().fix().index(), edge.to().fix().index());
            !edge.is_constraint_edge() && !domain.glued.contains_key(&side)
        })
    });
    let mut seen = HashSet::default();
    let once = free.filter(|edge| seen.insert(edge.as_undirected().fix()));
    let ends = once.map(|edge| edge.vertices().map(|v| *v.data()));
    ends.map(|ends| FreeSide {
        points: unordered(ends.map(|c| c.point)),
        ends,
    })
    .collect()
}

/// The sides of a face's seams.
fn on_seams(domain: &FaceTriangulation) -> impl Iterator<Item = [u32; 2]> {
    let point = |i: usize| {
        let vertex = domain.net.vertex(FixedVertexHandle::from_index(i));
        vertex.data().point
    };
    let sides = domain.glued.keys();
    sides.map(move |&(from, to)| unordered([point(from), point(to)]))
}

type Inner = FixedFaceHandle<InnerTag>;

/// The triangles inside a face, in order; `None` if its edges contradict each other. A region that
/// no edge bounds is inside.
fn inside(domain: &FaceTriangulation, mirrored: bool) -> Option<Vec<Inner>> {
    let net = &domain.net;
    let count = net.num_all_faces();
    let mut region = vec![usize::MAX; count];
    let mut sides: Vec<Option<bool>> = Vec::new();
    for start in net.fixed_inner_faces() {
        if region[start.index()] != usize::MAX {
            continue;
        }
        let number = sides.len();
        sides.push(None);
        region[start.index()] = number;
        let mut waiting = vec![start];
        while let Some(triangle) = waiting.pop() {
            for edge in net.face(triangle).adjacent_edges() {
                let side = (edge.from().fix().index(), edge.to().fix().index());
                let back = (side.1, side.0);
                let (left, right) = if mirrored { (back, side) } else { (side, back) };
                let on_left = domain.bounding.contains(&left);
                let on_right = domain.bounding.contains(&right);
                if on_left || on_right {
                    // A slit has the face on both sides.
                    let here = on_left;
                    match sides[number] {
                        Some(known) if known != here => return None,
                        _ => sides[number] = Some(here),
                    }
                    continue;
                }
                let beyond = match domain.glued.get(&side) {
                    Some(&(from, to)) => {
                        let vertex = FixedVertexHandle::from_index;
                        net.get_edge_from_neighbors(vertex(from), vertex(to))?
                            .face()
                    }
                    None => edge.rev().face(),
                };
                if let Some(next) = beyond.as_inner()
                    && region[next.fix().index()] == usize::MAX
                {
                    region[next.fix().index()] = number;
                    waiting.push(next.fix());
                }
            }
        }
    }
    let holds = |t: &Inner| sides[region[t.index()]].unwrap_or(domain.bounding.is_empty());
    Some(net.fixed_inner_faces().filter(holds).collect())
}

/// The accuracy of sides relative to that of triangles. The middle of a triangle deviates four
/// thirds as much as its three sides.
const OF_SIDES: f64 = 0.75;

/// The positions where points are missing: for each triangle, on the longest side that leaves the
/// surface; if only its middle leaves the surface, there.
fn missing(
    surface: &Surface,
    chart: &Chart,
    domain: &FaceTriangulation,
    inside: &[Inner],
    accuracy: &Accuracy,
    points: &[Point3<f64>],
) -> Vec<Point2<f64>> {
    if matches!(surface, Surface::Plane(_)) {
        return Vec::new();
    }
    let fit = |accuracy| ChordTest {
        surface,
        chart,
        accuracy,
    };
    let finer = accuracy.part(OF_SIDES);
    let (of_sides, of_triangles) = (fit(&finer), fit(accuracy));
    let point = |c: &Corner| points[c.point as usize];
    let mut divided: HashSet<Side> = HashSet::default();
    let mut found = Vec::new();
    for &triangle in inside {
        let triangle = domain.net.face(triangle);
        let free = triangle.adjacent_edges().into_iter().filter(|edge| {
            let side = (edge.from().fix().index(), edge.to().fix().index());
            !edge.is_constraint_edge() && !domain.glued.contains_key(&side)
        });
        let off = free.filter_map(|edge| {
            let ends = [edge.from(), edge.to()];
            let [a, b] = ends.map(|v| *v.data());
            let points = [point(&a), point(&b)];
            let place = of_sides.leaves([a.at, b.at], &points)?;
            let [i, j] = ends.map(|v| v.fix().index());
            let side = (i.min(j), i.max(j));
            Some((side, (points[0] - points[1]).norm(), place))
        });
        if let Some((side, _, place)) = off.max_by(|x, y| x.1.total_cmp(&y.1)) {
            if divided.insert(side) {
                found.push(place);
            }
            continue;
        }
        let corners = triangle.vertices().map(|v| *v.data());
        let sum = corners
            .iter()
            .fold(Point2::origin(), |c, k| c + k.at.coords);
        let centre = sum / 3.0;
        if !of_triangles.contains(&centre, &corners.map(|c| point(&c))) {
            found.push(centre);
        }
    }
    found
}
