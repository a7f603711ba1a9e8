//! The placed primitives of a union, their corners and their columns.

use std::sync::Arc;

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::Rational;

use super::ConstructionError;
use super::evaluated::PlaneFacedBoundary;
use crate::builder::{Builder, SolidId};
use crate::figure::{Figure, FigureEdge, PlaneMap};
use crate::polyhedron::{Polyhedron, PolyhedronError, PolyhedronFace, SpacePoint, index_loops};
use crate::primitive::Primitive;
use crate::tree::{NodeId, Operation, PlacedPrimitive, TreeNode};

/// The primitives of a solid that is a union. A difference or an intersection of solids with plane
/// faces counts as a polyhedron.
pub(super) fn of_union(
    builder: &Builder,
    solid: SolidId,
    what: &'static str,
) -> Result<Vec<PlacedPrimitive>, ConstructionError> {
    let tree = builder.finish(solid)?;
    let mut found = Vec::new();
    let mut open: Vec<NodeId> = tree.root().into_iter().collect();
    while let Some(id) = open.pop() {
        match &tree[id] {
            TreeNode::Leaf(placed) => found.push(placed.clone()),
            TreeNode::Operation {
                op: Operation::Union,
                children,
            } => open.extend(children.iter().rev()),
            TreeNode::Operation { .. } => {
                let boundary = PlaneFacedBoundary::of_tree(&tree.subtree(id))?;
                let boundary = boundary.ok_or(ConstructionError::NotUnion(what))?;
                if !boundary.faces.is_empty() {
                    let polyhedron = Arc::new(boundary.polyhedron()?);
                    found.push(PlacedPrimitive {
                        primitive: Primitive::Polyhedron { polyhedron },
                        motion: Motion::identity(),
                    });
                }
            }
        }
    }
    Ok(found)
}

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

/// A figure between two heights.
#[derive(Debug, Clone)]
pub(super) struct Column {
    pub figure: Figure,
    pub range: [Rational; 2],
}

/// A primitive as a column along z, if it is one in a frame.
pub(super) fn column(placed: &PlacedPrimitive, frame: &Motion) -> Option<Column> {
    let (figure, height) = match &placed.primitive {
        Primitive::Cylinder { radius, height } => (Figure::disc(radius).ok()?, height),
        Primitive::Block { size } => return block_column(size, &placed.motion.then(frame)),
        Primitive::Prism {
            figure,
            height,
            top,
        } if top.is_one() => ((**figure).clone(), height),
        _ => return None,
    };
    let motion = placed.motion.then(frame);
    let turn = motion.rotation_matrix();
    if turn[2][2] != Rational::ONE && turn[2][2] != -Rational::ONE {
        return None;
    }
    let [x, y, z] = motion.offset().clone();
    let [[a, b, _], [c, d, _], [_, _, up]] = turn;
    let map = PlaneMap {
        matrix: [[a, b], [c, d]],
        offset: [x, y],
    };
    let end = &z + up * height;
    Some(Column {
        figure: figure.mapped(&map).ok()?,
        range: [z.clone().min(end.clone()), z.max(end)],
    })
}

/// A block as a column: one of its edges is along z.
fn block_column(size: &[Rational; 3], motion: &Motion) -> Option<Column> {
    let turn = motion.rotation_matrix();
    let up = (0..3).find(|&k| turn[2][k].is_one() || turn[2][k] == -Rational::ONE)?;
    let [u, v] = [(up + 1) % 3, (up + 2) % 3];
    let [x, y, z] = motion.offset().clone();
    let end = &z + &turn[2][up] * &size[up];
    let map = PlaneMap {
        matrix: [0, 1].map(|i| [turn[i][u].clone(), turn[i][v].clone()]),
        offset: [x, y],
    };
    let figure = Figure::rectangle(&[size[u].clone(), size[v].clone()]).ok()?;
    Some(Column {
        figure: figure.mapped(&map).ok()?,
        range: [z.clone().min(end.clone()), z.max(end)],
    })
}
