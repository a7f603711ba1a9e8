//! The placed primitives of a union, and their columns.

use std::sync::Arc;

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::Rational;

use super::ConstructionError;
use super::evaluated::PlaneFacedBoundary;
use crate::builder::{Builder, SolidId};
use crate::figure::{Figure, PlaneMap};
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
