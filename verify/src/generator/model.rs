//! A model: a tree of operations on primitives as a description writes it, in f64.
//!
//! The nodes lie in one arena, children before their parents and the root last, so that models of
//! any depth can be created, traversed, changed and dropped without recursion.

use super::figure::ModelSweep;
pub use super::operation::ModelOperation;
use super::random::RandomChoices;
use serde::{Deserialize, Serialize};

/// A primitive as a description gives it; lengths in the model's unit.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub enum ModelPrimitive {
    /// A block with a corner at the origin and these edges along x, y and z.
    Block([f64; 3]),
    /// The half of that block where x/X + z/Z <= 1.
    Wedge([f64; 3]),
    /// A cylinder along z with its base at the origin.
    Cylinder {
        /// The radius.
        r: f64,
        /// The height.
        h: f64,
    },
    /// A frustum of a cone along z with its base at the origin; a cone where `r2` is zero.
    Frustum {
        /// The radius at the base.
        r1: f64,
        /// The radius at the top.
        r2: f64,
        /// The height.
        h: f64,
    },
    /// A sphere about the origin with this radius.
    Sphere(f64),
    /// A torus about the origin with axis z.
    Torus {
        /// The radius of the circle along which the tube runs.
        major: f64,
        /// The tube's radius.
        minor: f64,
    },
    /// An oblique frustum with its base about the origin.
    ObliqueFrustum {
        /// Conjugate radii of the base, and the centre of the top.
        axes: [[f64; 3]; 3],
        /// The size of the top relative to the base.
        top: f64,
    },
    /// An ellipsoid about the origin with these conjugate radii.
    Ellipsoid([[f64; 3]; 3]),
}

/// A coordinate axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum ModelAxis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

/// A step of a transform, in the frame of the surroundings.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub enum ModelStep {
    /// A translation along x, y and z.
    Shift([f64; 3]),
    /// A rotation about an axis through the origin, in degrees.
    Turn(ModelAxis, f64),
}

/// A construction from solids, as OpenSCAD has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum ModelConstruction {
    /// The convex hull.
    Hull,
    /// The Minkowski sum.
    Minkowski,
}

/// The index of a node in its model.
pub type ModelNodeId = usize;

/// The kind of a node.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub enum ModelNodeKind {
    /// A primitive.
    Leaf(ModelPrimitive),
    /// A solid that a figure sweeps.
    Sweep(ModelSweep),
    /// An operation on one child or more.
    Operation(ModelOperation, Vec<ModelNodeId>),
    /// A construction from one child or more.
    Construction(ModelConstruction, Vec<ModelNodeId>),
}

/// A node.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct ModelNode {
    /// The kind.
    pub kind: ModelNodeKind,
    /// Its placement: steps in order.
    pub steps: Vec<ModelStep>,
}

/// The exact number that a length or an angle of a model represents.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum Notation {
    /// The exact value of the f64.
    #[default]
    Binary,
    /// The shortest decimal that is read as the f64, as a person would write it.
    Decimal,
}

/// A tree. Every node but the root, which is the last one, is the child of exactly one other.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, Serialize)]
pub struct PartModel {
    nodes: Vec<ModelNode>,
    /// The meaning of its numbers.
    #[serde(default)]
    pub notation: Notation,
}

impl ModelNodeKind {
    /// The nodes of which this one is made.
    pub fn children(&self) -> &[ModelNodeId] {
        match self {
            Self::Leaf(_) | Self::Sweep(_) => &[],
            Self::Operation(_, children) | Self::Construction(_, children) => children,
        }
    }

    fn children_mut(&mut self) -> &mut [ModelNodeId] {
        match self {
            Self::Leaf(_) | Self::Sweep(_) => &mut [],
            Self::Operation(_, children) | Self::Construction(_, children) => children,
        }
    }
}

impl ModelAxis {
    /// The axes.
    pub const ALL: [Self; 3] = [Self::X, Self::Y, Self::Z];

    /// A random one.
    pub(crate) fn any(random: &mut RandomChoices) -> Self {
        random.choose(&Self::ALL)
    }

    /// Its index, from 0.
    pub(crate) fn index(self) -> usize {
        match self {
            Self::X => 0,
            Self::Y => 1,
            Self::Z => 2,
        }
    }

    /// A vector along it.
    pub(crate) fn vector(self, length: f64) -> [f64; 3] {
        std::array::from_fn(|i| if i == self.index() { length } else { 0.0 })
    }
}

impl PartModel {
    /// A model of one primitive.
    #[cfg(test)]
    pub(crate) fn new(primitive: ModelPrimitive, steps: Vec<ModelStep>) -> Self {
        let mut model = Self::default();
        model.leaf(primitive, steps);
        model
    }

    /// An empty model.
    pub(crate) fn with_notation(notation: Notation) -> Self {
        let nodes = Vec::new();
        Self { nodes, notation }
    }

    /// Adds a primitive.
    pub fn leaf(&mut self, primitive: ModelPrimitive, steps: Vec<ModelStep>) -> ModelNodeId {
        let kind = ModelNodeKind::Leaf(primitive);
        self.nodes.push(ModelNode { kind, steps });
        self.nodes.len() - 1
    }

    /// Adds a solid that a figure sweeps.
    pub fn sweep(&mut self, sweep: ModelSweep, steps: Vec<ModelStep>) -> ModelNodeId {
        let kind = ModelNodeKind::Sweep(sweep);
        self.nodes.push(ModelNode { kind, steps });
        self.nodes.len() - 1
    }

    /// Adds a construction from existing nodes that have no parent yet.
    pub fn construction(
        &mut self,
        construction: ModelConstruction,
        of: Vec<ModelNodeId>,
    ) -> ModelNodeId {
        let kind = ModelNodeKind::Construction(construction, of);
        let steps = Vec::new();
        self.nodes.push(ModelNode { kind, steps });
        self.nodes.len() - 1
    }

    /// Whether the model has figures, hulls or Minkowski sums, which `.csg` can represent only.
    pub fn has_figures(&self) -> bool {
        let has_figures = |node: &ModelNode| {
            matches!(
                node.kind,
                ModelNodeKind::Sweep(_) | ModelNodeKind::Construction(..)
            )
        };
        self.nodes.iter().any(has_figures)
    }

    /// Adds an operation on existing nodes that have no parent yet.
    pub fn operation(
        &mut self,
        op: ModelOperation,
        of: Vec<ModelNodeId>,
        steps: Vec<ModelStep>,
    ) -> ModelNodeId {
        let kind = ModelNodeKind::Operation(op, of);
        self.nodes.push(ModelNode { kind, steps });
        self.nodes.len() - 1
    }

    /// An operation on whole models.
    pub(crate) fn join(op: ModelOperation, models: &[&Self], steps: Vec<ModelStep>) -> Self {
        let mut all = Self::with_notation(
            models
                .first()
                .map_or_else(Notation::default, |m| m.notation),
        );
        let roots = models.iter().map(|model| all.take_in(model)).collect();
        all.operation(op, roots, steps);
        all
    }

    /// Adds the nodes of another model and returns the new index of its root.
    fn take_in(&mut self, other: &Self) -> ModelNodeId {
        let before = self.nodes.len();
        self.nodes.extend(other.nodes.iter().cloned());
        for node in &mut self.nodes[before..] {
            let children = node.kind.children_mut();
            children.iter_mut().for_each(|child| *child += before);
        }
        self.nodes.len() - 1
    }

    /// All nodes, children before their parents.
    pub fn nodes(&self) -> &[ModelNode] {
        &self.nodes
    }

    /// A node for modification; its children must not change.
    pub(crate) fn node_mut(&mut self, id: ModelNodeId) -> Option<&mut ModelNode> {
        self.nodes.get_mut(id)
    }

    /// The root; `None` for an empty model.
    pub(crate) fn root(&self) -> Option<ModelNodeId> {
        self.nodes.len().checked_sub(1)
    }

    /// The nodes that are primitives or swept by figures.
    pub(crate) fn leaves(&self) -> impl Iterator<Item = ModelNodeId> {
        let is_leaf = |id: &ModelNodeId| {
            matches!(
                self.nodes[*id].kind,
                ModelNodeKind::Leaf(_) | ModelNodeKind::Sweep(_)
            )
        };
        (0..self.nodes.len()).filter(is_leaf)
    }

    /// The subtrees below the root; empty for a primitive.
    pub(crate) fn children(&self) -> Vec<Self> {
        let root = self.nodes.last();
        let children = root.map_or(&[][..], |root| root.kind.children());
        children.iter().map(|&child| self.subtree(child)).collect()
    }

    /// The subtree below a node.
    pub(crate) fn subtree(&self, root: ModelNodeId) -> Self {
        let mut wanted = vec![false; self.nodes.len()];
        wanted[root] = true;
        for id in (0..=root).rev() {
            if wanted[id] {
                let children = self.nodes[id].kind.children();
                children.iter().for_each(|&child| wanted[child] = true);
            }
        }
        let mut part = Self::with_notation(self.notation);
        let mut new_id = vec![0; self.nodes.len()];
        for (id, node) in self.nodes.iter().enumerate().filter(|&(id, _)| wanted[id]) {
            new_id[id] = part.nodes.len();
            let mut node = node.clone();
            let children = node.kind.children_mut();
            children
                .iter_mut()
                .for_each(|child| *child = new_id[*child]);
            part.nodes.push(node);
        }
        part
    }

    /// The model without some of its leaves. Operations without children are removed, too, and
    /// those with one child are replaced by it.
    pub(crate) fn without(&self, gone: impl Fn(ModelNodeId) -> bool) -> Self {
        let mut fewer = Self::with_notation(self.notation);
        let mut new_id: Vec<Option<ModelNodeId>> = vec![None; self.nodes.len()];
        for (id, node) in self.nodes.iter().enumerate() {
            let steps = node.steps.clone();
            let children = node.kind.children().iter();
            let left: Vec<ModelNodeId> = children.filter_map(|&child| new_id[child]).collect();
            new_id[id] = match (&node.kind, left.as_slice()) {
                (ModelNodeKind::Leaf(_) | ModelNodeKind::Sweep(_), _) if gone(id) => None,
                (ModelNodeKind::Leaf(primitive), _) => Some(fewer.leaf(*primitive, steps)),
                (ModelNodeKind::Sweep(sweep), _) => Some(fewer.sweep(sweep.clone(), steps)),
                (_, []) => None,
                (_, &[only]) => {
                    fewer.nodes[only].steps.extend(steps);
                    Some(only)
                }
                (ModelNodeKind::Operation(op, _), _) => Some(fewer.operation(*op, left, steps)),
                (ModelNodeKind::Construction(construction, _), _) => {
                    let id = fewer.construction(*construction, left);
                    fewer.nodes[id].steps = steps;
                    Some(id)
                }
            };
        }
        fewer
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn three() -> PartModel {
        let ball = |r| PartModel::new(ModelPrimitive::Sphere(r), Vec::new());
        let two = PartModel::join(ModelOperation::Union, &[&ball(1.0), &ball(2.0)], Vec::new());
        PartModel::join(ModelOperation::Difference, &[&two, &ball(3.0)], Vec::new())
    }

    #[test]
    fn parts_of_a_model() {
        let model = three();
        let [two, ball] = model.children().try_into().unwrap();
        assert_eq!((two.nodes().len(), ball.nodes().len()), (3, 1));
        assert_eq!(model.subtree(2), two);
        assert_eq!(model.leaves().collect::<Vec<_>>(), [0, 1, 3]);
        // An operation on one child is that child; one without children is removed.
        let fewer = model.without(|id| id == 0);
        assert_eq!((fewer.nodes().len(), fewer.leaves().count()), (3, 2));
        let fewer = model.without(|id| id < 2);
        assert_eq!((fewer.nodes().len(), fewer.leaves().count()), (1, 1));
        assert_eq!(model.without(|_| true), PartModel::default());
    }
}
