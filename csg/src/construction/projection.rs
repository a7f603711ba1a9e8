//! Sections of solids with the plane z = 0, and their shadows on it.

use std::collections::BTreeMap;

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::Rational;

use super::ConstructionError;
use super::evaluated::PlaneFacedBoundary;
use super::frames::root;
use super::leaves::{Column, column};
use super::plane_faces::{corners, own_corners, polyhedron};
use crate::builder::{Builder, SolidId};
use crate::figure::{
    Disc, Figure, FigureEdge, FigureError, FigureExpression, FigureOperation, PlaneMap,
};
use crate::polyhedron::{Polyhedron, PolyhedronFace, SpacePoint, normal_of};
use crate::primitive::Primitive;
use crate::tree::{NodeId, Operation, PlacedPrimitive, Tree, TreeNode};

/// The section of a solid with the plane z = 0, just above it.
///
/// # Errors
/// The section is empty, or has other edges than segments and arcs.
pub fn section(builder: &Builder, solid: SolidId) -> Result<Figure, ConstructionError> {
    let tree = builder.finish(solid)?;
    let mut figures: Vec<Figure> = Vec::new();
    let mut expressions: Vec<Option<FigureExpression>> = vec![None; tree.nodes().len()];
    for (index, node) in tree.nodes().iter().enumerate().rev() {
        expressions[index] = match node {
            TreeNode::Leaf(placed) => match non_empty(section_of(placed))? {
                Some(figure) => {
                    figures.push(figure);
                    Some(FigureExpression::Leaf(figures.len() - 1))
                }
                None => None,
            },
            TreeNode::Operation { op, children } => {
                let operands = children.iter().map(|c| expressions[c.index()].clone());
                combined(*op, operands.collect())
            }
        };
    }
    let root = tree
        .root()
        .and_then(|root| expressions[root.index()].take());
    let root = root.ok_or(FigureError::Empty)?;
    Ok(Figure::evaluated(
        &figures.iter().collect::<Vec<_>>(),
        &root,
    )?)
}

/// The figure of a result, if it is not empty.
fn non_empty(made: Result<Figure, ConstructionError>) -> Result<Option<Figure>, ConstructionError> {
    match made {
        Ok(figure) => Ok(Some(figure)),
        Err(error) if error.is_empty() => Ok(None),
        Err(error) => Err(error),
    }
}

/// An operation on operands that may be empty.
fn combined(op: Operation, operands: Vec<Option<FigureExpression>>) -> Option<FigureExpression> {
    let (op, is_empty) = match op {
        Operation::Union => (FigureOperation::Union, false),
        Operation::Intersection => (
            FigureOperation::Intersection,
            operands.iter().any(Option::is_none),
        ),
        Operation::Difference => (
            FigureOperation::Difference,
            operands.first().is_none_or(Option::is_none),
        ),
    };
    let operands: Vec<FigureExpression> = operands.into_iter().flatten().collect();
    (!is_empty && !operands.is_empty()).then_some(FigureExpression::Combined(op, operands))
}

fn disc_at([x, y, _]: &SpacePoint, radius: &Rational) -> Result<Figure, ConstructionError> {
    let map = PlaneMap {
        offset: [x.clone(), y.clone()],
        ..PlaneMap::identity()
    };
    Ok(Figure::disc(radius)?.mapped(&map)?)
}

/// A ring about a point, or a disc where the inner radius is not positive.
fn ring_at(
    centre: &SpacePoint,
    outer: &Rational,
    inner: &Rational,
) -> Result<Figure, ConstructionError> {
    let disc = disc_at(centre, outer)?;
    if *inner <= Rational::ZERO {
        return Ok(disc);
    }
    let hole = disc_at(centre, inner)?;
    Ok(Figure::combined(
        FigureOperation::Difference,
        &[&disc, &hole],
    )?)
}

/// The section of a primitive.
fn section_of(placed: &PlacedPrimitive) -> Result<Figure, ConstructionError> {
    let empty = || ConstructionError::from(FigureError::Empty);
    let contains_zero =
        |range: &[Rational; 2]| range[0] <= Rational::ZERO && range[1] > Rational::ZERO;
    if let Some(column) = column(placed, &Motion::identity()) {
        return match contains_zero(&column.range) {
            true => Ok(column.figure),
            false => Err(empty()),
        };
    }
    if own_corners(&placed.primitive).is_some() {
        let own = polyhedron(&placed.primitive)?;
        let motion = &placed.motion;
        let placed = own.mapped(&motion.rotation_matrix(), motion.offset())?;
        return Ok(section_of_polyhedron(&placed)?);
    }
    let motion = &placed.motion;
    let (centre, turn) = (motion.offset(), motion.rotation_matrix());
    let [_, _, z] = centre;
    let up = &turn[2][2];
    let is_upright = up.is_one() || *up == -Rational::ONE;
    match &placed.primitive {
        Primitive::Sphere { radius } => {
            let square = radius * radius - z * z;
            match square > Rational::ZERO {
                true => disc_at(centre, &root(&square)),
                false => Err(empty()),
            }
        }
        Primitive::Frustum { base, top, height } if is_upright => {
            let at = -(z * up) / height;
            let range = [z.clone(), z + up * height];
            let range = [
                range[0].clone().min(range[1].clone()),
                range[0].clone().max(range[1].clone()),
            ];
            match contains_zero(&range) {
                true => disc_at(centre, &(base + (top - base) * at)),
                false => Err(empty()),
            }
        }
        Primitive::Torus { major, minor } if is_upright => {
            let square = minor * minor - z * z;
            if square <= Rational::ZERO {
                return Err(empty());
            }
            let half = root(&square);
            ring_at(centre, &(major + &half), &(major - &half))
        }
        Primitive::Cylinder { radius, height } if up.is_zero() => {
            let square = radius * radius - z * z;
            if square <= Rational::ZERO {
                return Err(empty());
            }
            lying(centre, &turn, &root(&square), height)
        }
        _ => Err(ConstructionError::NoProjection("section")),
    }
}

/// The rectangle of a cylinder that lies along the plane.
fn lying(
    centre: &SpacePoint,
    turn: &premio_kernel::motion::RationalMatrix,
    half: &Rational,
    height: &Rational,
) -> Result<Figure, ConstructionError> {
    let [u, v] = [turn[0][2].clone(), turn[1][2].clone()];
    let map = PlaneMap {
        matrix: [[u.clone(), -&v], [v.clone(), u.clone()]],
        offset: [&centre[0] + &v * half, &centre[1] - &u * half],
    };
    let rectangle = Figure::rectangle(&[height.clone(), half * Rational::from(2)])?;
    Ok(rectangle.mapped(&map)?)
}

/// The section of a polyhedron just above z = 0.
fn section_of_polyhedron(polyhedron: &Polyhedron) -> Result<Figure, FigureError> {
    let points = polyhedron.points();
    let is_above = |i: usize| points[i][2] > Rational::ZERO;
    let mut edges: Vec<FigureEdge> = Vec::new();
    for (index, face) in polyhedron.faces().iter().enumerate() {
        let normal = polyhedron.normal(index);
        // Along the section the material is on the left, and the normal points to the right.
        let along = |p: &[Rational; 2]| &p[1] * &normal[0] - &p[0] * &normal[1];
        let crossings = face.edges().filter(|&[i, j]| is_above(i) != is_above(j));
        let crossings = crossings.map(|[i, j]| {
            let (a, b) = (&points[i], &points[j]);
            let t = &a[2] / (&a[2] - &b[2]);
            [0, 1].map(|k| &a[k] + &t * (&b[k] - &a[k]))
        });
        let mut crossings: Vec<[Rational; 2]> = crossings.collect();
        crossings.sort_by_cached_key(along);
        for pair in crossings.chunks_exact(2) {
            if pair[0] != pair[1] {
                edges.push(FigureEdge::line(pair[0].clone(), pair[1].clone()));
            }
        }
    }
    Figure::from_segments(edges)
}

/// The shadow of a solid on the plane z = 0, by light along z.
///
/// # Errors
/// The solid is empty, or the shadow of a part of it is not known: of a primitive with other edges
/// than segments and arcs, or of a difference or an intersection of solids that are not columns and
/// have other than plane faces.
pub fn shadow(builder: &Builder, solid: SolidId) -> Result<Figure, ConstructionError> {
    let tree = builder.finish(solid)?;
    let unknown = || ConstructionError::NoProjection("shadow");
    let mut open: Vec<NodeId> = tree.root().into_iter().collect();
    let mut figures: Vec<Figure> = Vec::new();
    while let Some(id) = open.pop() {
        let shadow = match &tree[id] {
            TreeNode::Leaf(placed) => shadow_of(placed),
            TreeNode::Operation {
                op: Operation::Union,
                children,
            } => {
                open.extend(children.iter().rev());
                continue;
            }
            TreeNode::Operation { op, children } => {
                match shadow_of_columns(&tree, *op, children).transpose() {
                    Some(figure) => figure,
                    None => match PlaneFacedBoundary::of_tree(&tree.subtree(id))? {
                        Some(boundary) => shadow_of_faces(&boundary.points, &boundary.faces),
                        None => Err(unknown()),
                    },
                }
            }
        };
        figures.extend(non_empty(shadow)?);
    }
    let figures: Vec<&Figure> = figures.iter().collect();
    match figures[..] {
        [] => Err(FigureError::Empty.into()),
        [single] => Ok(single.clone()),
        _ => Ok(Figure::combined(FigureOperation::Union, &figures)?),
    }
}

/// The shadow of an intersection or a difference of columns of which the first is the shortest;
/// `None` if the operands are others.
fn shadow_of_columns(
    tree: &Tree,
    op: Operation,
    children: &[NodeId],
) -> Result<Option<Figure>, ConstructionError> {
    let columns = children.iter().map(|&c| match &tree[c] {
        TreeNode::Leaf(placed) => column(placed, &Motion::identity()),
        TreeNode::Operation { .. } => None,
    });
    let Some(columns) = columns.collect::<Option<Vec<Column>>>() else {
        return Ok(None);
    };
    let [first, others @ ..] = &columns[..] else {
        return Ok(None);
    };
    let passes =
        |other: &Column| other.range[0] <= first.range[0] && first.range[1] <= other.range[1];
    if !others.iter().all(passes) {
        return Ok(None);
    }
    let op = match op {
        Operation::Union => FigureOperation::Union,
        Operation::Intersection => FigureOperation::Intersection,
        Operation::Difference => FigureOperation::Difference,
    };
    let figures: Vec<&Figure> = columns.iter().map(|column| &column.figure).collect();
    Ok(Some(Figure::combined(op, &figures)?))
}

/// The shadow of a primitive.
fn shadow_of(placed: &PlacedPrimitive) -> Result<Figure, ConstructionError> {
    if let Some(column) = column(placed, &Motion::identity()) {
        return Ok(column.figure);
    }
    let motion = &placed.motion;
    let (centre, turn) = (motion.offset(), motion.rotation_matrix());
    let up = &turn[2][2];
    let is_upright = up.is_one() || *up == -Rational::ONE;
    match &placed.primitive {
        Primitive::Sphere { radius } => disc_at(centre, radius),
        Primitive::Frustum { base, top, .. } if is_upright => disc_at(centre, base.max(top)),
        Primitive::Torus { major, minor } if is_upright => {
            ring_at(centre, &(major + minor), &(major - minor))
        }
        Primitive::Cylinder { radius, height } if up.is_zero() => {
            lying(centre, &turn, radius, height)
        }
        Primitive::Block { .. } | Primitive::Wedge { .. } => {
            let points = corners(placed).ok_or(ConstructionError::NoProjection("shadow"))?;
            let points = points.into_iter().map(|[x, y, _]| Disc::point([x, y]));
            Ok(Figure::convex_hull(&points.collect::<Vec<_>>())?)
        }
        other => match own_corners(other) {
            Some(_) => {
                let solid = polyhedron(other)?.mapped(&turn, centre)?;
                shadow_of_faces(solid.points(), solid.faces())
            }
            None => Err(ConstructionError::NoProjection("shadow")),
        },
    }
}

/// The shadow of plane faces around a solid: the points about which the outlines of the lit ones
/// wind. The edges between lit faces cancel.
fn shadow_of_faces(
    points: &[SpacePoint],
    faces: &[PolyhedronFace],
) -> Result<Figure, ConstructionError> {
    let is_lit = |face: &&PolyhedronFace| {
        let [_, _, z] = normal_of(face, |i| &points[i]);
        z > Rational::ZERO
    };
    let mut senses: BTreeMap<[usize; 2], i32> = BTreeMap::new();
    for [i, j] in faces.iter().filter(is_lit).flat_map(|face| face.edges()) {
        let sense = if i < j { 1 } else { -1 };
        *senses.entry([i.min(j), i.max(j)]).or_default() += sense;
    }
    let flat = |i: usize| [0, 1].map(|k| points[i][k].clone());
    let mut outline = Vec::new();
    for ([i, j], sense) in senses {
        let segment = match sense > 0 {
            true => [flat(i), flat(j)],
            false => [flat(j), flat(i)],
        };
        outline.extend((0..sense.abs()).map(|_| segment.clone()));
    }
    Ok(Figure::wound(&outline)?)
}
