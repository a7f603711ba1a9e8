//! The corners and faces of primitives with plane faces.

use std::sync::Arc;

use premio_kernel::number::rational::Rational;

use super::ConstructionError;
use crate::figure::FigureEdge;
use crate::polyhedron::{Polyhedron, PolyhedronError, PolyhedronFace, SpacePoint, index_loops};
use crate::primitive::Primitive;
use crate::tree::PlacedPrimitive;

/// The corners of a primitive with plane faces, in its own frame.
pub(super) fn own_corners(primitive: &Primitive) -> Option<Vec<SpacePoint>> {
    let zero = || Rational::ZERO;
    Some(match primitive {
        Primitive::Block { size } => {
            let corner = |k: usize| {
                std::array::from_fn(|i| match k >> i & 1 {
                    0 => zero(),
                    _ => size[i].clone(),
                })
            };
            (0..8).map(corner).collect()
        }
        Primitive::Wedge { size: [x, y, z] } => {
            let side = |y: &Rational| {
                [
                    [zero(), y.clone(), zero()],
                    [x.clone(), y.clone(), zero()],
                    [zero(), y.clone(), z.clone()],
                ]
            };
            [side(&zero()), side(y)].concat()
        }
        Primitive::Prism {
            figure,
            height,
            top,
        } if figure.is_polygon() => {
            let starts = figure.edges().iter().map(|edge| &edge.start);
            let ends = starts.flat_map(|[x, y]| {
                let base = [x.clone(), y.clone(), zero()];
                [base, [x * top, y * top, height.clone()]]
            });
            ends.collect()
        }
        Primitive::Polyhedron { polyhedron } => polyhedron.points().to_vec(),
        _ => return None,
    })
}

/// The corners of a placed primitive with plane faces.
pub(super) fn corners(placed: &PlacedPrimitive) -> Option<Vec<SpacePoint>> {
    let own = own_corners(&placed.primitive)?;
    Some(own.iter().map(|p| placed.motion.apply_point(p)).collect())
}

/// A primitive with plane faces as a polyhedron in its own frame.
pub(super) fn polyhedron(primitive: &Primitive) -> Result<Arc<Polyhedron>, ConstructionError> {
    Ok(match primitive {
        Primitive::Polyhedron { polyhedron } => Arc::clone(polyhedron),
        Primitive::Prism {
            figure,
            height,
            top,
        } if figure.is_polygon() => {
            let at = |z: &Rational, scale: &Rational| {
                let starts = figure.edges().iter().map(|edge| &edge.start);
                let points = starts.map(|[x, y]| [x * scale, y * scale, z.clone()]);
                points.collect::<Vec<SpacePoint>>()
            };
            let rings = [at(&Rational::ZERO, &Rational::ONE), at(height, top)];
            let lengths = figure.contours().map(<[FigureEdge]>::len);
            Arc::new(between(lengths, &rings.concat())?)
        }
        other => {
            let corners = own_corners(other).ok_or(ConstructionError::Elliptic)?;
            Arc::new(Polyhedron::convex_hull(&corners)?)
        }
    })
}

/// The polyhedron that a face sweeps along a segment.
pub(super) fn swept_face(
    polyhedron: &Polyhedron,
    face: usize,
    [from, to]: [&SpacePoint; 2],
) -> Result<Polyhedron, PolyhedronError> {
    let moved = |by: &SpacePoint| -> Vec<SpacePoint> {
        let corners = polyhedron.corners(face);
        let moved = corners.map(|p| std::array::from_fn(|i| &p[i] + &by[i]));
        moved.collect()
    };
    let lengths = polyhedron.faces()[face].loops.iter().map(Vec::len);
    between(lengths, &[moved(from), moved(to)].concat())
}

/// The polyhedron between a polygon and a copy of it, by the lengths of its loops and the corners of
/// both.
fn between(
    lengths: impl Iterator<Item = usize>,
    points: &[SpacePoint],
) -> Result<Polyhedron, PolyhedronError> {
    let count = points.len() / 2;
    let loops = index_loops(lengths);
    let mut faces = Vec::new();
    for corners in &loops {
        let next = corners.iter().cycle().skip(1);
        let wall = |(&i, &j): (&usize, &usize)| vec![i, j, j + count, i + count];
        faces.extend(
            corners
                .iter()
                .zip(next)
                .map(wall)
                .map(PolyhedronFace::simple),
        );
    }
    let backwards = |corners: &Vec<usize>| corners.iter().rev().copied().collect();
    let base = loops.iter().map(backwards).collect();
    let up = |corners: &Vec<usize>| corners.iter().map(|i| i + count).collect();
    let top = loops.iter().map(up).collect();
    faces.extend([base, top].map(|loops| PolyhedronFace { loops }));
    Ok(Polyhedron::from_faces(points, &faces)?.polyhedron)
}
