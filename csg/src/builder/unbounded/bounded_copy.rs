//! The copy of a part with bounded solids in place of unbounded ones.

use super::clipping::{clipped, polytope};
use super::enclosure::Ball;
use super::half_space::half_space;
use super::region::Region;
use super::{Builder, BuilderNode, SolidId, UnboundedNode};
use crate::polyhedron::HalfSpace;
use crate::tree::Operation;
use std::collections::BTreeMap;

/// The operands of an intersection, with those of the intersections among them.
#[derive(Debug, Default)]
struct FlatIntersection {
    half_spaces: Vec<HalfSpace>,
    /// The drafts of the other operands.
    rest: Vec<usize>,
}

impl FlatIntersection {
    fn new(builder: &Builder, children: &[usize]) -> Self {
        let mut flat = Self::default();
        let mut open: Vec<usize> = children.iter().rev().copied().collect();
        while let Some(child) = open.pop() {
            match builder.draft(child) {
                BuilderNode::Operation {
                    op: Operation::Intersection,
                    children,
                } if builder.has_unbounded_part[child] => open.extend(children.iter().rev()),
                _ => match half_space(builder, child) {
                    Some(half_space) => flat.half_spaces.push(half_space),
                    None => flat.rest.push(child),
                },
            }
        }
        flat
    }
}

/// The drafts that a part without complements consists of, and what its intersections are.
fn components(builder: &Builder, top: usize) -> BTreeMap<usize, Option<FlatIntersection>> {
    let mut found = BTreeMap::new();
    let mut open = vec![top];
    while let Some(draft) = open.pop() {
        if found.contains_key(&draft) {
            continue;
        }
        let flat = match builder.draft(draft) {
            BuilderNode::Operation {
                op: Operation::Intersection,
                children,
            } if builder.has_unbounded_part[draft] => {
                Some(FlatIntersection::new(builder, children))
            }
            _ => None,
        };
        match &flat {
            Some(flat) => open.extend(&flat.rest),
            None => open.extend(builder.draft(draft).children()),
        }
        found.insert(draft, flat);
    }
    found
}

/// A copy of a draft without complements that is the same inside a ball, and bounded; `None` if numbers
/// are beyond the range of f64.
pub(super) fn bounded_copy(
    from: &Builder,
    top: usize,
    region: &Region,
    ball: &Ball,
) -> Option<(Builder, SolidId)> {
    let mut to = Builder::new();
    let mut copies: BTreeMap<usize, SolidId> = BTreeMap::new();
    // Components come before what they compose.
    for (draft, flat) in components(from, top) {
        to.set_colour(from.colours[draft]);
        let all = |drafts: &[usize]| -> Vec<SolidId> {
            let known = drafts.iter().filter_map(|draft| copies.get(draft));
            known.copied().collect()
        };
        let local = || region.local_ball(draft, ball);
        let copy = match (from.draft(draft), flat) {
            (BuilderNode::Operation { op, .. }, Some(flat)) => {
                let mut operands = all(&flat.rest);
                if !flat.half_spaces.is_empty() {
                    operands.push(polytope(&mut to, &flat.half_spaces, &local()?)?);
                }
                to.operation(*op, &operands)
            }
            (BuilderNode::Operation { op, children }, None) => to.operation(*op, &all(children)),
            (BuilderNode::Leaf(primitive), _) => to.primitive(primitive.clone()),
            (BuilderNode::Unbounded(UnboundedNode::Leaf(primitive)), _) => {
                clipped(&mut to, primitive, &local()?)?
            }
            (BuilderNode::Unbounded(UnboundedNode::Complement(_)), _) => SolidId::EMPTY,
            (
                BuilderNode::Moved {
                    child,
                    placement,
                    entry,
                },
                _,
            ) => {
                let inner = copies.get(child).copied().unwrap_or(SolidId::EMPTY);
                to.placed(inner, placement.clone(), from.placings(*entry))
            }
        };
        copies.insert(draft, copy);
    }
    let copy = copies.get(&top).copied();
    Some((to, copy.unwrap_or(SolidId::EMPTY)))
}
