//! Ray casting on the tree as a point set: an oracle that is independent of the boundary
//! representation.
//!
//! The intersection of a line with every primitive is a set of intervals in closed form, in f64.
//! The intervals are combined up the tree. Nothing here is certified; the boundary is checked
//! against it.

mod crossing;
mod ellipsoid;
mod facets;
mod oblique;
mod polynomial;
mod section;
mod shape;
mod sight;
mod volume;

pub use crossing::{SurfaceCrossing, Surfaces};
pub use sight::{Clearance, SightEvidence, SightSegment};
pub use volume::Estimate;

use crate::tree::{NodeId, Operation, PlacedPrimitive, Tree, TreeNode};
use nalgebra::{Matrix3, Point3, Vector3};
use premio_kernel::geometry::bounds::Aabb;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, Envelope, RTree, SelectionFunction};
use shape::Shape;

/// A line with a parameter, in the part's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point of parameter zero.
    pub origin: Point3<f64>,
    /// The direction; parameters are in units of its length.
    pub direction: Vector3<f64>,
}

/// A primitive in its position.
#[derive(Clone, Debug)]
struct Leaf {
    node: NodeId,
    shape: Shape,
    turn: Matrix3<f64>,
    offset: Vector3<f64>,
}

/// The rule by which a node follows from its children.
#[derive(Clone, Copy, Debug)]
enum Rule {
    Leaf,
    Union,
    Intersection(usize),
    Difference,
}

/// A node's parent, and whether the node is its first child.
#[derive(Clone, Copy, Debug)]
struct Above {
    parent: usize,
    first: bool,
}

/// The number of children of a node that contain the current point.
#[derive(Clone, Copy, Debug, Default)]
struct Held {
    first: bool,
    others: usize,
}

/// A point at which a line enters or leaves a primitive.
#[derive(Clone, Copy, Debug)]
struct Event {
    at: f64,
    leaf: usize,
    enters: bool,
}

type LeafBox = GeomWithData<Rectangle<[f64; 3]>, usize>;

/// A tree prepared for queries of which points, and which parts of a line, are material.
#[derive(Debug)]
pub struct RayOracle {
    leaves: Vec<Leaf>,
    rules: Vec<Rule>,
    above: Vec<Option<Above>>,
    index: RTree<LeafBox>,
    bounds: Aabb,
}

/// Buffers for one line, reused for the next.
#[derive(Debug)]
struct Scratch {
    held: Vec<Held>,
    spans: Vec<[f64; 2]>,
    events: Vec<Event>,
}

impl Leaf {
    fn new(node: NodeId, placed: &PlacedPrimitive) -> Self {
        Self {
            node,
            shape: Shape::new(&placed.primitive),
            turn: placed.motion.rotation_f64(),
            offset: placed.motion.translation_f64(),
        }
    }

    /// The bounding box in the part's frame.
    fn bounds(&self) -> Aabb {
        let [lo, hi] = self.shape.bounds().map(Vector3::from);
        let centre = self.turn * ((lo + hi) * 0.5) + self.offset;
        let reach = self.turn.abs() * ((hi - lo) * 0.5);
        Aabb {
            min: (centre - reach).into(),
            max: (centre + reach).into(),
        }
    }

    fn local_point(&self, p: &Point3<f64>) -> Vector3<f64> {
        self.turn.tr_mul(&(p.coords - self.offset))
    }

    fn spans(&self, ray: &Ray, spans: &mut Vec<[f64; 2]>) {
        let direction = self.turn.tr_mul(&ray.direction);
        self.shape
            .spans(&self.local_point(&ray.origin), &direction, spans);
    }
}

impl RayOracle {
    /// Prepares a tree.
    pub fn new(tree: &Tree) -> Self {
        let leaves: Vec<Leaf> = tree.leaves().map(|(n, p)| Leaf::new(n, p)).collect();
        let boxes = leaves.iter().enumerate().map(|(i, leaf)| {
            let b = leaf.bounds();
            LeafBox::new(Rectangle::from_corners(b.min, b.max), i)
        });
        Self {
            index: RTree::bulk_load(boxes.collect()),
            rules: tree.nodes().iter().map(rule).collect(),
            above: parents(tree),
            bounds: bounds(tree, &leaves),
            leaves,
        }
    }

    /// A box that contains the material.
    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }

    fn scratch(&self) -> Scratch {
        Scratch {
            held: vec![Held::default(); self.rules.len()],
            spans: Vec::new(),
            events: Vec::new(),
        }
    }

    /// Whether a point is material. On the boundary rounding decides.
    pub fn contains(&self, point: &Point3<f64>) -> bool {
        let mut scratch = self.scratch();
        let at: [f64; 3] = (*point).into();
        let near = self
            .index
            .locate_in_envelope_intersecting(AABB::from_point(at));
        let mut inside = false;
        for found in near {
            let leaf = &self.leaves[found.data];
            if leaf.shape.contains(&leaf.local_point(point)) {
                inside ^= self.flip(&mut scratch.held, leaf.node, true);
            }
        }
        inside
    }

    /// The intervals of a line's parameter in which it is in material, in order. Gaps, then
    /// slivers, of length up to `least` are closed.
    pub fn intervals(&self, ray: &Ray, least: f64) -> Vec<[f64; 2]> {
        let mut found = Vec::new();
        self.cross(ray, &mut self.scratch(), |span| found.push(span));
        let mut joined: Vec<[f64; 2]> = Vec::new();
        for [lo, hi] in found {
            match joined.last_mut() {
                Some(last) if lo - last[1] <= least => last[1] = hi,
                _ => joined.push([lo, hi]),
            }
        }
        joined.retain(|[lo, hi]| hi - lo > least);
        joined
    }

    /// Passes the intervals of material along a line to `found`, in order.
    fn cross(&self, ray: &Ray, scratch: &mut Scratch, mut found: impl FnMut([f64; 2])) {
        self.cross_leaves(ray, scratch, |ends| found(ends.map(|e| e.at)));
    }

    /// The same, with the primitives at which the intervals end.
    fn cross_leaves(&self, ray: &Ray, scratch: &mut Scratch, mut found: impl FnMut([Event; 2])) {
        let Scratch {
            held,
            spans,
            events,
        } = scratch;
        events.clear();
        for near in self.index.locate_with_selection_function(Touches::new(ray)) {
            let leaf = &self.leaves[near.data];
            spans.clear();
            leaf.spans(ray, spans);
            for &[lo, hi] in spans.iter() {
                let leaf = near.data;
                for (at, enters) in [(lo, true), (hi, false)] {
                    events.push(Event { at, leaf, enters });
                }
            }
        }
        events.sort_by(|a, b| a.at.total_cmp(&b.at));
        let mut since: Option<Event> = None;
        for event in events.iter() {
            if self.flip(held, self.leaves[event.leaf].node, event.enters) {
                since = match since {
                    None => Some(*event),
                    Some(start) => {
                        if event.at > start.at {
                            found([start, *event]);
                        }
                        None
                    }
                };
            }
        }
    }

    /// Enters or leaves a leaf, and updates its ancestors. Returns whether the root changes.
    fn flip(&self, held: &mut [Held], leaf: NodeId, enters: bool) -> bool {
        let (mut node, mut enters) = (leaf.index(), enters);
        while let Some(Above { parent, first }) = self.above[node] {
            let count = &mut held[parent];
            let before = self.decide(parent, count);
            match (first, enters) {
                (true, _) => count.first = enters,
                (false, true) => count.others += 1,
                (false, false) => count.others = count.others.saturating_sub(1),
            }
            let after = self.decide(parent, count);
            if before == after {
                return false;
            }
            (node, enters) = (parent, after);
        }
        true
    }

    fn decide(&self, node: usize, held: &Held) -> bool {
        match self.rules[node] {
            Rule::Leaf => held.first,
            Rule::Union => held.first || held.others > 0,
            Rule::Intersection(children) => held.first && held.others + 1 == children,
            Rule::Difference => held.first && held.others == 0,
        }
    }
}

fn rule(node: &TreeNode) -> Rule {
    match node {
        TreeNode::Leaf(_) => Rule::Leaf,
        TreeNode::Operation { op, children } => match op {
            Operation::Union => Rule::Union,
            Operation::Intersection => Rule::Intersection(children.len()),
            Operation::Difference => Rule::Difference,
        },
    }
}

fn parents(tree: &Tree) -> Vec<Option<Above>> {
    let mut above = vec![None; tree.nodes().len()];
    for (parent, node) in tree.nodes().iter().enumerate() {
        if let TreeNode::Operation { children, .. } = node {
            for (k, child) in children.iter().enumerate() {
                let first = k == 0;
                above[child.index()] = Some(Above { parent, first });
            }
        }
    }
    above
}

/// The bounding box of the root, computed from the leaves upwards.
fn bounds(tree: &Tree, leaves: &[Leaf]) -> Aabb {
    let mut boxes = vec![Aabb::EMPTY; tree.nodes().len()];
    for leaf in leaves {
        boxes[leaf.node.index()] = leaf.bounds();
    }
    for (i, node) in tree.nodes().iter().enumerate().rev() {
        if let TreeNode::Operation { op, children } = node {
            let mut each = children.iter().map(|c| boxes[c.index()]);
            let first = each.next().unwrap_or(Aabb::EMPTY);
            boxes[i] = match op {
                Operation::Union => each.fold(first, |a, b| a.hull(&b)),
                Operation::Intersection => each.fold(first, common),
                Operation::Difference => first,
            };
        }
    }
    tree.root().map_or(Aabb::EMPTY, |root| boxes[root.index()])
}

fn common(a: Aabb, b: Aabb) -> Aabb {
    let both = Aabb {
        min: std::array::from_fn(|i| a.min[i].max(b.min[i])),
        max: std::array::from_fn(|i| a.max[i].min(b.max[i])),
    };
    if (0..3).any(|i| both.min[i] > both.max[i]) {
        return Aabb::EMPTY;
    }
    both
}

/// Selects the boxes through which a line passes.
struct Touches {
    origin: [f64; 3],
    direction: [f64; 3],
}

impl Touches {
    fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.into(),
            direction: ray.direction.into(),
        }
    }

    fn passes(&self, b: &AABB<[f64; 3]>) -> bool {
        let (lower, upper) = (b.lower(), b.upper());
        // The box is enlarged slightly: it is rounded, and a face in its side must not be missed.
        let size = (0..3).fold(0.0, |s, i| lower[i].abs().max(upper[i].abs()).max(s));
        let slack = size * premio_kernel::number::predicates::ROUNDING;
        let mut range = [f64::NEG_INFINITY, f64::INFINITY];
        (0..3).all(|i| {
            let (o, d) = (self.origin[i], self.direction[i]);
            shape::clip(&mut range, lower[i] - slack - o, -d)
                && shape::clip(&mut range, o - upper[i] - slack, d)
        })
    }
}

impl SelectionFunction<LeafBox> for Touches {
    fn should_unpack_parent(&self, envelope: &AABB<[f64; 3]>) -> bool {
        !envelope.is_empty_box() && self.passes(envelope)
    }
}

/// Whether an envelope is empty, as that of the root of an empty index is.
trait EmptyBox {
    fn is_empty_box(&self) -> bool;
}

impl EmptyBox for AABB<[f64; 3]> {
    fn is_empty_box(&self) -> bool {
        *self == AABB::new_empty()
    }
}
