//! The removal of complements by De Morgan's laws.

use super::half_space::half_space;
use super::{Builder, BuilderNode, SolidId, UnboundedNode};
use crate::polyhedron::HalfSpace;
use crate::primitive::UnboundedPrimitive;
use crate::tree::Operation;

/// A solid, or its complement.
#[derive(Debug, Clone, Copy)]
pub(super) struct SignedSolid {
    pub solid: SolidId,
    pub is_complement: bool,
}

impl SignedSolid {
    fn outside(self) -> Self {
        Self {
            is_complement: !self.is_complement,
            ..self
        }
    }

    /// The same, with the complement of a half-space as the half-space on the other side of its plane.
    fn reversed(self, builder: &mut Builder) -> Self {
        let draft = builder.draft_of(self.solid).filter(|_| self.is_complement);
        let Some(own) = draft.and_then(|draft| half_space(builder, draft)) else {
            return self;
        };
        let other = HalfSpace {
            normal: own.normal.map(|x| -x),
            offset: -own.offset,
        };
        builder
            .unbounded(UnboundedPrimitive::HalfSpace(other))
            .into()
    }
}

impl From<SolidId> for SignedSolid {
    fn from(solid: SolidId) -> Self {
        Self {
            solid,
            is_complement: false,
        }
    }
}

/// A copy of a draft without complements, in another builder.
pub(super) fn without_complements(from: &Builder, top: usize) -> (Builder, SignedSolid) {
    let mut to = Builder::new();
    let mut copies: Vec<SignedSolid> = Vec::with_capacity(top + 1);
    for (draft, is_used) in used(from, top).into_iter().enumerate() {
        if !is_used {
            copies.push(SolidId::EMPTY.into());
            continue;
        }
        to.set_colour(from.colours[draft]);
        let copy = match from.draft(draft) {
            BuilderNode::Leaf(primitive) => to.primitive(primitive.clone()).into(),
            BuilderNode::Unbounded(UnboundedNode::Leaf(primitive)) => {
                to.unbounded(primitive.clone()).into()
            }
            BuilderNode::Unbounded(UnboundedNode::Complement(child)) => {
                let child = child.map_or(SolidId::EMPTY.into(), |child| copies[child]);
                child.outside()
            }
            BuilderNode::Operation { op, children } => {
                let children: Vec<SignedSolid> =
                    children.iter().map(|&child| copies[child]).collect();
                combined(&mut to, *op, &children)
            }
            BuilderNode::Moved {
                child,
                placement,
                entry,
            } => {
                let inner = copies[*child];
                let placings = from.placings(*entry);
                SignedSolid {
                    solid: to.placed(inner.solid, placement.clone(), placings),
                    ..inner
                }
            }
        };
        copies.push(copy);
    }
    let whole = copies.pop().unwrap_or_else(|| SolidId::EMPTY.into());
    (to, whole)
}

/// Whether each draft is a component of one.
fn used(builder: &Builder, top: usize) -> Vec<bool> {
    let mut is_used = vec![false; top + 1];
    is_used[top] = true;
    // Components come before what they compose.
    for draft in (0..=top).rev() {
        if is_used[draft] {
            let children = builder.draft(draft).children();
            children.iter().for_each(|&child| is_used[child] = true);
        }
    }
    is_used
}

/// An operation on solids and complements.
fn combined(builder: &mut Builder, op: Operation, operands: &[SignedSolid]) -> SignedSolid {
    let operands = operands.iter().enumerate().map(|(i, &operand)| {
        // A - B is the intersection of A and the complement of B. A + B is the complement of the
        // intersection of the complements of A and B.
        match op {
            Operation::Intersection => operand,
            Operation::Difference if i == 0 => operand,
            Operation::Difference | Operation::Union => operand.outside(),
        }
    });
    let operands: Vec<SignedSolid> = operands.collect();
    let operands = operands
        .into_iter()
        .map(|operand| operand.reversed(builder));
    let (outside, inside): (Vec<SignedSolid>, Vec<SignedSolid>) =
        operands.partition(|o| o.is_complement);
    let [outside, inside] =
        [outside, inside].map(|all| all.iter().map(|o| o.solid).collect::<Vec<SolidId>>());
    let common = match inside.is_empty() {
        true => SignedSolid::from(builder.operation(Operation::Union, &outside)).outside(),
        false => {
            let common = builder.operation(Operation::Intersection, &inside);
            let all: Vec<SolidId> = [vec![common], outside].concat();
            builder.operation(Operation::Difference, &all).into()
        }
    };
    match op {
        Operation::Union => common.outside(),
        Operation::Intersection | Operation::Difference => common,
    }
}
