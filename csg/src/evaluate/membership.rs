//! Decides whether a choice of sides is material. The tree is a function of the primitives that
//! contain a point. Only those are named; the point is outside all others.

use crate::tree::{NodeId, Operation, Tree, TreeNode};
use std::collections::{BTreeMap, BinaryHeap};

/// The tree with links to the parents, so that a few leaves can be followed upwards.
pub(super) struct Membership<'a> {
    tree: &'a Tree,
    /// By node: the link to its parent.
    parents: Vec<Option<ParentLink>>,
    /// By node: whether a point that is in it and in no node apart from it is in the solid.
    suffices: Vec<bool>,
}

/// The link from a node to its parent.
#[derive(Clone, Copy)]
struct ParentLink {
    parent: NodeId,
    /// The index of the node among the parent's children.
    place: usize,
}

/// What is known of a node so far.
struct Count {
    node: NodeId,
    first: bool,
    others: usize,
}

impl Count {
    /// One child contains the point: the first, or another.
    fn new(node: NodeId, first: bool) -> Self {
        let others = usize::from(!first);
        Self {
            node,
            first,
            others,
        }
    }

    fn add(&mut self, other: Self) {
        self.first |= other.first;
        self.others += other.others;
    }
}

/// The children of an operation that contain a point, and those that may contain it.
#[derive(Default)]
struct Choice {
    first: Option<Hold>,
    /// The number of other children that contain the point.
    held: usize,
    /// The number of other children that may contain the point.
    open: usize,
}

impl Choice {
    /// The number of children that contain the point or may contain it.
    fn present(&self) -> usize {
        usize::from(self.first.is_some()) + self.held + self.open
    }
}

/// What is known of a point from the primitives that contain it and those that may contain it. No other
/// primitive contains it.
#[derive(Default)]
pub(super) struct Surroundings {
    /// The choices of the operations above these primitives, up to the top.
    choices: BTreeMap<NodeId, Choice>,
    /// The lowest node above all of them; `None` if none contains the point in any case.
    top: Option<NodeId>,
}

/// Where a point certainly is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Containment {
    Inside,
    Outside,
}

/// Whether a set certainly contains a point.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Hold {
    Held,
    Open,
}

impl<'a> Membership<'a> {
    /// Builds the links to the parents.
    pub fn new(tree: &'a Tree) -> Self {
        let mut parents = vec![None; tree.nodes().len()];
        for (i, node) in tree.nodes().iter().enumerate() {
            if let TreeNode::Operation { children, .. } = node {
                for (k, child) in children.iter().enumerate() {
                    parents[child.index()] = Some(ParentLink {
                        parent: NodeId(i),
                        place: k,
                    });
                }
            }
        }
        let mut suffices: Vec<bool> = Vec::with_capacity(parents.len());
        for link in &parents {
            // Parents precede their children.
            suffices.push(link.is_none_or(|ParentLink { parent, place }| {
                let TreeNode::Operation { op, .. } = &tree[parent] else {
                    return false;
                };
                let passes = match op {
                    Operation::Union => true,
                    Operation::Intersection => false,
                    Operation::Difference => place == 0,
                };
                passes && suffices[parent.index()]
            }));
        }
        Self {
            tree,
            parents,
            suffices,
        }
    }

    /// Whether a point in exactly the given primitives (by leaf) is in the solid. Parents precede
    /// their children, so the greatest index can always be decided.
    pub fn contains(&self, leaves: &[NodeId]) -> bool {
        // The operations above the primitives that contain the point, and whether the child below
        // is their first.
        let mut waiting: BinaryHeap<(NodeId, bool)> = BinaryHeap::new();
        for leaf in leaves {
            match self.parents[leaf.index()] {
                Some(link) => waiting.push((link.parent, link.place == 0)),
                None => return true,
            }
        }
        while let Some((node, first)) = waiting.pop() {
            let mut count = Count::new(node, first);
            while let Some(&(same, first)) = waiting.peek().filter(|w| w.0 == node) {
                count.add(Count::new(same, first));
                waiting.pop();
            }
            // Continue upwards from there as long as no other node must be decided first.
            let mut ready = Some(count);
            while let Some(count) = ready.take().filter(|count| self.decide(count)) {
                let Some(ParentLink { parent, place }) = self.parents[count.node.index()] else {
                    return true;
                };
                match waiting
                    .peek()
                    .is_some_and(|(next, _)| next.index() >= parent.index())
                {
                    true => waiting.push((parent, place == 0)),
                    false => ready = Some(Count::new(parent, place == 0)),
                }
            }
        }
        false
    }

    fn decide(&self, count: &Count) -> bool {
        match &self.tree[count.node] {
            TreeNode::Leaf(_) => true,
            TreeNode::Operation {
                op: Operation::Union,
                ..
            } => true,
            TreeNode::Operation {
                op: Operation::Intersection,
                children,
            } => count.first && count.others + 1 == children.len(),
            TreeNode::Operation {
                op: Operation::Difference,
                ..
            } => count.first && count.others == 0,
        }
    }

    /// The primitives of `open` on which membership of the point depends. The point may be inside
    /// or outside each of `open`; it is inside those in `held` and outside all others. Every
    /// primitive occurs once in the tree, so all choices are independent.
    pub fn deciding(&self, held: &[NodeId], open: &[NodeId]) -> Vec<NodeId> {
        let around = self.around(held, open);
        let decides = |leaf: &NodeId| {
            let mut node = *leaf;
            while Some(node) != around.top {
                let Some(ParentLink { parent, place }) = self.parents[node.index()] else {
                    return false;
                };
                let choice = around.choices.get(&parent);
                if !choice.is_some_and(|c| self.follows(parent, place, c)) {
                    return false;
                }
                node = parent;
            }
            true
        };
        match self.may_contain(&around) {
            true => open.iter().copied().filter(decides).collect(),
            false => Vec::new(),
        }
    }

    /// What is known of a point that only the primitives `open` may contain.
    pub fn surroundings(&self, open: &[NodeId]) -> Surroundings {
        self.around(&[], open)
    }

    /// Whether the point may be in the solid.
    pub fn may_contain(&self, around: &Surroundings) -> bool {
        around.top.is_some_and(|top| self.suffices[top.index()])
    }

    /// Whether membership is the same for all choices of the other primitives, where the point is
    /// inside or outside one of them. False if that is not determined.
    pub fn is_constant(&self, around: &Surroundings, leaf: NodeId, side: Containment) -> bool {
        let (mut node, mut inside) = (leaf, side == Containment::Inside);
        while Some(node) != around.top {
            let Some(ParentLink { parent, place }) = self.parents[node.index()] else {
                return false;
            };
            let (TreeNode::Operation { op, .. }, Some(choice)) =
                (&self.tree[parent], around.choices.get(&parent))
            else {
                return false;
            };
            // Where the parent contains nothing whatever the leaf does, the leaf does not matter.
            if self.hold(parent, choice).is_none() {
                return false;
            }
            let is_determined = match (op, inside) {
                (Operation::Union, true) | (Operation::Intersection, false) => true,
                (Operation::Union, false) => choice.present() == 1,
                (Operation::Intersection, true) => false,
                (Operation::Difference, true) => place > 0 || choice.open == 0,
                (Operation::Difference, false) => place == 0,
            };
            if !is_determined {
                return false;
            }
            inside &= place == 0 || *op != Operation::Difference;
            node = parent;
        }
        true
    }

    /// What is known of a point that the primitives `held` contain and `open` may contain.
    fn around(&self, held: &[NodeId], open: &[NodeId]) -> Surroundings {
        let mut around = Surroundings::default();
        let mut waiting: BTreeMap<NodeId, Choice> = BTreeMap::new();
        let named = |list: &[NodeId], hold| list.iter().map(move |&n| (n, hold)).collect();
        let mut found: Vec<(NodeId, Hold)> = named(held, Hold::Held);
        found.extend::<Vec<_>>(named(open, Hold::Open));
        loop {
            for (node, hold) in found.drain(..) {
                let Some(ParentLink { parent, place }) = self.parents[node.index()] else {
                    around.top = Some(node);
                    continue;
                };
                let choice = waiting.entry(parent).or_default();
                match (place, hold) {
                    (0, _) => choice.first = Some(hold),
                    (_, Hold::Held) => choice.held += 1,
                    (_, Hold::Open) => choice.open += 1,
                }
            }
            let Some((node, choice)) = waiting.pop_last() else {
                return around;
            };
            let hold = self.hold(node, &choice);
            around.choices.insert(node, choice);
            if waiting.is_empty() {
                around.top = hold.map(|_| node);
                return around;
            }
            found.extend(hold.map(|hold| (node, hold)));
        }
    }

    /// Whether a point is in an operation's result; `None` if it certainly is not.
    fn hold(&self, node: NodeId, choice: &Choice) -> Option<Hold> {
        let TreeNode::Operation { op, children } = &self.tree[node] else {
            return None;
        };
        let first_held = choice.first == Some(Hold::Held);
        let present = choice.present();
        let (possible, sure) = match op {
            Operation::Union => (present > 0, first_held || choice.held > 0),
            Operation::Intersection => {
                let all = present == children.len();
                (all, first_held && choice.open == 0)
            }
            Operation::Difference => {
                let left = choice.first.is_some() && choice.held == 0;
                (left, first_held && choice.open == 0)
            }
        };
        possible.then_some(if sure { Hold::Held } else { Hold::Open })
    }

    /// Whether the others can be chosen such that an operation's result equals an open child or its
    /// complement.
    fn follows(&self, node: NodeId, place: usize, choice: &Choice) -> bool {
        let TreeNode::Operation { op, children } = &self.tree[node] else {
            return false;
        };
        match op {
            Operation::Union => choice.first != Some(Hold::Held) && choice.held == 0,
            Operation::Intersection => choice.present() == children.len(),
            Operation::Difference => choice.held == 0 && (place == 0 || choice.first.is_some()),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests {
    use super::*;
    use crate::builder::{Builder, SolidId};
    use crate::primitive::Primitive;
    use premio_kernel::number::rational::Rational;

    /// The deciding primitives among the open ones of a part, by their positions in the text.
    fn deciding(part: &str, held: &[usize], open: &[usize]) -> Vec<usize> {
        let tree = tree(part);
        let leaves: Vec<NodeId> = tree.leaves().map(|leaf| leaf.0).collect();
        let named = |list: &[usize]| -> Vec<NodeId> { list.iter().map(|&i| leaves[i]).collect() };
        let found = Membership::new(&tree).deciding(&named(held), &named(open));
        let place = |id| leaves.iter().position(|l| *l == id).unwrap();
        found.into_iter().map(place).collect()
    }

    /// The same from the root downwards.
    fn is_in(tree: &Tree, node: NodeId, held: &[NodeId]) -> bool {
        match &tree[node] {
            TreeNode::Leaf(_) => held.contains(&node),
            TreeNode::Operation { op, children } => {
                let mut of = children.iter().map(|&child| is_in(tree, child, held));
                match op {
                    Operation::Union => of.any(|held| held),
                    Operation::Intersection => of.all(|held| held),
                    Operation::Difference => of.next() == Some(true) && !of.any(|held| held),
                }
            }
        }
    }

    #[test]
    fn every_choice_of_sides_is_told() {
        for part in PARTS {
            let tree = tree(part);
            let leaves: Vec<NodeId> = tree.leaves().map(|leaf| leaf.0).collect();
            let membership = Membership::new(&tree);
            for choice in 0_u32..1 << leaves.len() {
                let named = leaves.iter().enumerate();
                let held: Vec<NodeId> = named
                    .filter(|(i, _)| choice & (1 << i) != 0)
                    .map(|(_, leaf)| *leaf)
                    .collect();
                let contained = membership.contains(&held);
                assert_eq!(
                    contained,
                    is_in(&tree, NodeId(0), &held),
                    "{part} {choice:b}"
                );
            }
        }
    }

    const PARTS: [&str; 7] = [
        "A",
        "A UN A INT A",
        "A DIF (A DIF (A DIF (A UN A)))",
        "(A UN A) DIF (A INT A) UN (A DIF A)",
        "((A INT A) UN (A INT A)) INT ((A DIF A) UN (A DIF A))",
        "(((((A UN A) DIF A) UN A) DIF A) INT (A UN A)) DIF A",
        "((A INT A) UN A) INT A",
    ];

    /// The tree of an expression on spheres, from left to right.
    fn tree(part: &str) -> Tree {
        let spaced = part.replace('(', "( ").replace(')', " )");
        let mut builder = Builder::new();
        let part = expression(&mut spaced.split_whitespace(), &mut builder);
        builder.finish(part).unwrap()
    }

    fn expression<'t>(words: &mut impl Iterator<Item = &'t str>, builder: &mut Builder) -> SolidId {
        let mut known = operand(words, builder);
        while let Some(op) = words.next() {
            let op = match op {
                "UN" => Operation::Union,
                "INT" => Operation::Intersection,
                "DIF" => Operation::Difference,
                _ => return known,
            };
            let other = operand(words, builder);
            known = builder.operation(op, &[known, other]);
        }
        known
    }

    fn operand<'t>(words: &mut impl Iterator<Item = &'t str>, builder: &mut Builder) -> SolidId {
        match words.next() {
            Some("A") => builder.primitive(Primitive::sphere(Rational::from(1)).unwrap()),
            _ => expression(words, builder),
        }
    }

    /// Every set of leaves that may contain a point, every one of them, and both answers for it.
    #[test]
    fn constant_membership_is_the_same_for_all_choices() {
        let mut constant = 0;
        for part in PARTS {
            let tree = tree(part);
            let leaves: Vec<NodeId> = tree.leaves().map(|leaf| leaf.0).collect();
            let membership = Membership::new(&tree);
            let chosen = |set: u32| -> Vec<NodeId> {
                let named = leaves.iter().enumerate();
                let of_set = named.filter(|(i, _)| set & (1 << i) != 0);
                of_set.map(|(_, leaf)| *leaf).collect()
            };
            for open in 1_u32..1 << leaves.len() {
                let around = membership.surroundings(&chosen(open));
                let subsets = || (0..=open).filter(|set| set & !open == 0);
                let any = subsets().any(|set| membership.contains(&chosen(set)));
                assert_eq!(membership.may_contain(&around), any, "{part} {open:b}");
                if !any {
                    continue;
                }
                for (i, &leaf) in leaves.iter().enumerate() {
                    for side in [Containment::Outside, Containment::Inside] {
                        let inside = side == Containment::Inside;
                        let fixed = |set: &u32| (set & (1 << i) != 0) == inside;
                        let is_open = open & (1 << i) != 0;
                        if !is_open || !membership.is_constant(&around, leaf, side) {
                            continue;
                        }
                        constant += 1;
                        let mut answers = subsets()
                            .filter(fixed)
                            .map(|set| membership.contains(&chosen(set)));
                        let first = answers.next().unwrap();
                        let of = format!("{part} {open:b} {i} {side:?}");
                        assert!(answers.all(|answer| answer == first), "{of}");
                    }
                }
            }
        }
        assert!(constant > 100, "{constant}");
    }

    #[test]
    fn membership_is_constant_inside_a_member_of_a_union() {
        let tree = tree("A UN A UN (A DIF A)");
        let leaves: Vec<NodeId> = tree.leaves().map(|leaf| leaf.0).collect();
        let membership = Membership::new(&tree);
        let around = membership.surroundings(&leaves);
        let constant = |side| -> Vec<bool> {
            let leaves = leaves.iter();
            let constant = leaves.map(|&leaf| membership.is_constant(&around, leaf, side));
            constant.collect()
        };
        assert_eq!(constant(Containment::Inside), [true, true, false, false]);
        assert_eq!(constant(Containment::Outside), [false; 4]);
        // Away from what is taken away, the minuend is a member.
        let around = membership.surroundings(&leaves[..3]);
        assert!(membership.is_constant(&around, leaves[2], Containment::Inside));
    }

    #[test]
    fn what_the_others_cover_does_not_decide() {
        assert_eq!(deciding("A UN A", &[], &[0, 1]), [0, 1]);
        assert!(deciding("A UN A", &[0], &[1]).is_empty());
        assert_eq!(deciding("A INT A", &[0], &[1]), [1]);
        assert!(deciding("A INT A", &[], &[1]).is_empty());
        assert_eq!(deciding("A DIF A", &[], &[0, 1]), [0, 1]);
        assert!(deciding("A DIF A", &[1], &[0]).is_empty());
        assert!(deciding("A DIF A", &[], &[1]).is_empty());
        // A difference from what is added to.
        assert!(deciding("(A DIF A) UN A", &[2], &[0, 1]).is_empty());
        assert_eq!(deciding("(A DIF A) UN A", &[1], &[0, 2]), [2]);
        assert_eq!(deciding("(A DIF A) UN A", &[0], &[1, 2]), [1, 2]);
        assert_eq!(deciding("(A UN A) INT A", &[0], &[1, 2]), [2]);
    }
}
