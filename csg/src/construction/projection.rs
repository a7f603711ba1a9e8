//! Sections of solids with the plane z = 0, and their shadows on it.

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::Rational;

use super::ConstructionError;
use super::frames::root;
use super::leaves::{column, corners, own_corners, polyhedron};
use crate::builder::{Builder, SolidId};
use crate::figure::{
    Disc, Figure, FigureEdge, FigureError, FigureExpression, FigureOperation, PlaneMap,
};
use crate::polyhedron::{Polyhedron, SpacePoint};
use crate::primitive::Primitive;
use crate::tree::{Operation, PlacedPrimitive, Tree, TreeNode};

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
            let [outer, inner] = [major + &half, major - &half].map(|r| disc_at(centre, &r));
            Ok(Figure::combined(
                FigureOperation::Difference,
                &[&outer?, &inner?],
            )?)
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
/// The solid is empty, the shadow has other edges than segments and arcs, or the solid is a
/// difference other than of columns from a column that they pass through.
pub fn shadow(builder: &Builder, solid: SolidId) -> Result<Figure, ConstructionError> {
    let tree = builder.finish(solid)?;
    let mut figures: Vec<Option<Figure>> = vec![None; tree.nodes().len()];
    for (index, node) in tree.nodes().iter().enumerate().rev() {
        figures[index] = match node {
            TreeNode::Leaf(placed) => match shadow_of(placed) {
                Err(ConstructionError::NoProjection(_)) => None,
                made => Some(made?),
            },
            TreeNode::Operation { op, children } => {
                let each: Vec<usize> = children.iter().map(|c| c.index()).collect();
                combined_shadow(&tree, *op, &each, &figures)?
            }
        };
    }
    let root = tree.root().ok_or(FigureError::Empty)?;
    let shadow = figures[root.index()].take();
    shadow.ok_or(ConstructionError::NoProjection("shadow"))
}

/// The shadow of an operation; `None` if it is not known.
fn combined_shadow(
    tree: &Tree,
    op: Operation,
    children: &[usize],
    figures: &[Option<Figure>],
) -> Result<Option<Figure>, ConstructionError> {
    let each = children.iter().map(|&c| figures[c].as_ref());
    let Some(each) = each.collect::<Option<Vec<&Figure>>>() else {
        return Ok(None);
    };
    let op = match op {
        Operation::Union => FigureOperation::Union,
        Operation::Intersection | Operation::Difference => {
            let columns = children.iter().map(|&c| match &tree.nodes()[c] {
                TreeNode::Leaf(placed) => column(placed, &Motion::identity()),
                TreeNode::Operation { .. } => None,
            });
            let Some(columns) = columns.collect::<Option<Vec<_>>>() else {
                return Ok(None);
            };
            let [first, others @ ..] = &columns[..] else {
                return Ok(None);
            };
            let passes = |other: &super::leaves::Column| {
                other.range[0] <= first.range[0] && first.range[1] <= other.range[1]
            };
            if !others.iter().all(passes) {
                return Ok(None);
            }
            match op {
                Operation::Intersection => FigureOperation::Intersection,
                _ => FigureOperation::Difference,
            }
        }
    };
    Ok(Some(Figure::combined(op, &each)?))
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
            let [outer, inner] = [major + minor, major - minor].map(|r| disc_at(centre, &r));
            Ok(Figure::combined(
                FigureOperation::Difference,
                &[&outer?, &inner?],
            )?)
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
            Some(_) => shadow_of_polyhedron(&polyhedron(other)?.mapped(&turn, centre)?),
            None => Err(ConstructionError::NoProjection("shadow")),
        },
    }
}

/// The union of the shadows of all faces that are lit.
fn shadow_of_polyhedron(polyhedron: &Polyhedron) -> Result<Figure, ConstructionError> {
    let is_lit = |face: &usize| polyhedron.normal(*face)[2] > Rational::ZERO;
    let outline = |face: usize| {
        let loops = polyhedron.faces()[face].loops.iter();
        let flat = |corners: &Vec<usize>| {
            let points = corners.iter().map(|&i| &polyhedron.points()[i]);
            points.map(|[x, y, _]| [x.clone(), y.clone()]).collect()
        };
        Figure::polygon(&loops.map(flat).collect::<Vec<_>>())
    };
    let lit = (0..polyhedron.faces().len()).filter(is_lit);
    let faces: Vec<Figure> = lit.map(outline).collect::<Result<_, _>>()?;
    let faces: Vec<&Figure> = faces.iter().collect();
    Ok(Figure::combined(FigureOperation::Union, &faces)?)
}
