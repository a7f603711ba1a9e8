//! Expands a builder's solids to a tree: motions are pushed down to the leaves, and solids used
//! several times are copied.

use super::*;

/// A node of the builder that is still to be expanded.
struct Task {
    draft: usize,
    placement: Rc<Placement>,
    parent: Option<NodeId>,
    /// Whether this is the first child of a difference.
    minuend: bool,
}

/// An expansion in progress.
pub(super) struct Expansion<'a> {
    builder: &'a Builder,
    pub(super) tree: Tree,
    tasks: Vec<Task>,
}

impl<'a> Expansion<'a> {
    pub(super) fn new(builder: &'a Builder) -> Self {
        Self {
            builder,
            tree: Tree::default(),
            tasks: Vec::new(),
        }
    }

    pub(super) fn run(&mut self, top: usize, placement: Placement) -> Result<(), TreeError> {
        self.tasks.push(Task {
            draft: top,
            placement: Rc::new(placement),
            parent: None,
            minuend: false,
        });
        while let Some(task) = self.tasks.pop() {
            self.expand(task)?;
        }
        Ok(())
    }

    fn expand(&mut self, task: Task) -> Result<(), TreeError> {
        match &self.builder.drafts[task.draft] {
            BuilderNode::Leaf(primitive) => {
                let leaf = self.expand_leaf(primitive, &task);
                if let Some(colour) = self.builder.colours[task.draft] {
                    self.tree.colours.insert(leaf, colour);
                }
            }
            BuilderNode::Unbounded(_) => {
                return Err(TreeError::Unbounded(UnboundedSide::Everywhere));
            }
            BuilderNode::Operation { op, children } => self.expand_operation(*op, children, &task),
            BuilderNode::Moved {
                child, placement, ..
            } => {
                let outer = placement.then(&task.placement);
                let bits = outer.bits().max(placement.bits());
                if bits > MAX_MOTION_BITS {
                    return Err(TreeError::NumbersTooLong { bits });
                }
                self.tasks.push(Task {
                    draft: *child,
                    placement: Rc::new(outer),
                    ..task
                });
            }
        }
        Ok(())
    }

    fn expand_leaf(&mut self, primitive: &Primitive, task: &Task) -> NodeId {
        let Placement {
            motion,
            mirrored,
            factor,
        } = &*task.placement;
        let primitive = match factor {
            Some(factor) => primitive.scaled(factor),
            None => primitive.clone(),
        };
        let (primitive, motion) = if *mirrored {
            let image = primitive.mirrored_y();
            (image.primitive, image.motion.then(motion))
        } else {
            (primitive, motion.clone())
        };
        self.attach(
            TreeNode::Leaf(PlacedPrimitive { primitive, motion }),
            task.parent,
        )
    }

    fn expand_operation(&mut self, op: Operation, children: &[usize], task: &Task) {
        let parent = match task.parent {
            Some(parent) if self.merges(op, parent, task.minuend) => parent,
            other => self.attach(
                TreeNode::Operation {
                    op,
                    children: Vec::new(),
                },
                other,
            ),
        };
        for (index, &draft) in children.iter().enumerate().rev() {
            self.tasks.push(Task {
                draft,
                placement: Rc::clone(&task.placement),
                parent: Some(parent),
                minuend: op == Operation::Difference && index == 0,
            });
        }
    }

    /// Whether the children of an operation may replace it below its parent: (A + B) + C = A + B +
    /// C, the same for intersection, (A - B) - C = A - B - C, A - (B + C) = A - B - C.
    fn merges(&self, op: Operation, parent: NodeId, minuend: bool) -> bool {
        let TreeNode::Operation { op: above, .. } = &self.tree.nodes[parent.0] else {
            return false;
        };
        match above {
            Operation::Union | Operation::Intersection => op == *above,
            Operation::Difference if minuend => op == Operation::Difference,
            Operation::Difference => op == Operation::Union,
        }
    }

    fn attach(&mut self, node: TreeNode, parent: Option<NodeId>) -> NodeId {
        let id = NodeId(self.tree.nodes.len());
        self.tree.nodes.push(node);
        match parent {
            None => self.tree.root = Some(id),
            Some(parent) => {
                if let TreeNode::Operation { children, .. } = &mut self.tree.nodes[parent.0] {
                    children.push(id);
                }
            }
        }
        id
    }
}
