//! The triangles of a face: points are added inside until they follow the surface.

use super::charts::Chart;
use super::domain::{Corner, Domain, Side};
use super::fit::Fit;
use super::{Accuracy, LIMIT, Mesh, TessellationError, Triangle};
use crate::brep::Brep;
use crate::brep::topology::FaceId;
use crate::geometry::surface::Surface;
use nalgebra::{Point2, Point3};
use spade::Triangulation;
use spade::handles::{FixedFaceHandle, FixedVertexHandle, InnerTag};
use std::collections::HashSet;

/// Adds the triangles of a face to a mesh.
pub(super) fn triangles(
    brep: &Brep,
    face: FaceId,
    chart: &Chart,
    mut domain: Domain,
    accuracy: &Accuracy,
    mesh: &mut Mesh,
) -> Result<(), TessellationError> {
    let mirrored = chart.is_mirrored(brep.sense(face));
    loop {
        let inside = inside(&domain, mirrored).ok_or(TessellationError::Sides { face })?;
        let missing = missing(
            brep.surface(face),
            chart,
            &domain,
            &inside,
            accuracy,
            &mesh.points,
        );
        if missing.is_empty() {
            let inside = inside.into_iter().map(|triangle| {
                let corners = domain.net.face(triangle).vertices();
                corners.map(|v| v.data().point)
            });
            for mut corners in inside.chain(domain.cap) {
                if mirrored {
                    corners.swap(1, 2);
                }
                mesh.triangles.push(Triangle { corners, face });
            }
            return Ok(());
        }
        let before = domain.net.num_vertices();
        if before + missing.len() > LIMIT {
            return Err(TessellationError::TooMany { face, limit: LIMIT });
        }
        for at in missing {
            mesh.points.push(chart.lift(&at));
            let point = mesh.points.len() as u32 - 1;
            let added = domain.net.insert(Corner::new(at, point));
            if added.is_err() {
                return Err(TessellationError::Sides { face });
            }
        }
        // What is missing is there: the doubles of the chart are too coarse.
        if domain.net.num_vertices() == before {
            return Err(TessellationError::Crossing { face });
        }
    }
}

type Inner = FixedFaceHandle<InnerTag>;

/// The triangles inside a face, in order; none where its edges contradict one another. A region
/// that no edge bounds is inside.
fn inside(domain: &Domain, mirrored: bool) -> Option<Vec<Inner>> {
    let net = &domain.net;
    let count = net.num_all_faces();
    let mut region = vec![usize::MAX; count];
    let mut told: Vec<Option<bool>> = Vec::new();
    for start in net.fixed_inner_faces() {
        if region[start.index()] != usize::MAX {
            continue;
        }
        let number = told.len();
        told.push(None);
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
                    match told[number] {
                        Some(known) if known != here => return None,
                        _ => told[number] = Some(here),
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
    let holds = |t: &Inner| told[region[t.index()]].unwrap_or(domain.bounding.is_empty());
    Some(net.fixed_inner_faces().filter(holds).collect())
}

/// A side may be this part of the accuracy off: the middle of a triangle between three such sides
/// is off by four thirds of it.
const OF_SIDES: f64 = 0.75;

/// Where points are missing: where the longest side that leaves the surface does, of each triangle,
/// or in the middle of the triangle where only that does.
fn missing(
    surface: &Surface,
    chart: &Chart,
    domain: &Domain,
    inside: &[Inner],
    accuracy: &Accuracy,
    points: &[Point3<f64>],
) -> Vec<Point2<f64>> {
    if matches!(surface, Surface::Plane(_)) {
        return Vec::new();
    }
    let fit = |accuracy| Fit {
        surface,
        chart,
        accuracy,
    };
    let finer = accuracy.part(OF_SIDES);
    let (of_sides, of_triangles) = (fit(&finer), fit(accuracy));
    let point = |c: &Corner| points[c.point as usize];
    let mut divided: HashSet<Side> = HashSet::new();
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
        if !of_triangles.holds(&centre, &corners.map(|c| point(&c))) {
            found.push(centre);
        }
    }
    found
}
