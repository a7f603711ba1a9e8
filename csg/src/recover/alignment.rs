//! Numbers along one direction that the rounding made different: they become equal again.
//!
//! Notation: node i has the unknown position p_i, written as x_i with the error e_i, and features at
//! p_i + c. A relation of features of nodes i and j is p_i + c = p_j + d. Related nodes are a
//! component: p_i = b + q_i with one unknown b and exact q_i. The component is possible if some b
//! lies within e_i of x_i - q_i for all of its nodes.

use crate::recover::PrimitiveRelation;
use crate::recover::features::{Feature, FeatureKind};
use premio_kernel::number::rational::{Rational, from_decimal, from_f64, to_f64};

/// A primitive along a direction.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// The position as written, or as determined before.
    pub position: Rational,
    /// Its largest error; zero for a position that is determined.
    pub error: f64,
    /// Its numbers, relative to the position.
    pub features: Vec<Feature>,
}

/// The result for one direction.
#[derive(Debug, Clone, Default)]
pub(super) struct Alignment {
    /// By node: its new position, if relations determine it.
    pub positions: Vec<Option<Rational>>,
    /// The recovered relations.
    pub relations: Vec<PrimitiveRelation>,
    /// The number of relations that contradict others.
    pub contradictory: usize,
}

/// The error, relative to a number, of differences in f64.
const PRECISION: f64 = 16.0 * f64::EPSILON;

/// The number of next greater numbers with which a number is compared. Many primitives may have the
/// same one, and neighbours connect them.
const NEIGHBOURS: usize = 16;

/// Two features within the rounding.
#[derive(Debug, Clone)]
struct Candidate {
    nodes: [usize; 2],
    offsets: [Rational; 2],
    kinds: [FeatureKind; 2],
    /// The difference of their numbers as written.
    difference: Rational,
}

impl Candidate {
    /// Relations of the same kind of feature first, then the closest.
    fn order(&self) -> (bool, f64) {
        let is_mixed = self.kinds[0] != self.kinds[1] || self.kinds[0] == FeatureKind::Tangent;
        (is_mixed, to_f64(&self.difference).abs())
    }
}

/// Aligns nodes along a direction.
pub(super) fn aligned(nodes: &[Node]) -> Alignment {
    let mut candidates = candidates(nodes);
    candidates.sort_by(|a, b| {
        let ((a, x), (b, y)) = (a.order(), b.order());
        a.cmp(&b).then(x.total_cmp(&y))
    });
    let mut components = Components::new(nodes);
    let mut alignment = Alignment::default();
    let mut touched = vec![false; nodes.len()];
    for candidate in &candidates {
        if !components.unite(candidate) {
            alignment.contradictory += 1;
        } else if !candidate.difference.is_zero() {
            let [a, b] = candidate.kinds;
            alignment.relations.push(a.relation(b));
            for i in candidate.nodes {
                touched[i] = true;
            }
        }
    }
    alignment.positions = components.positions(nodes, &touched);
    alignment
}

/// The pairs of neighbouring features of different nodes within the rounding, at least one of which
/// may move.
fn candidates(nodes: &[Node]) -> Vec<Candidate> {
    let all = nodes.iter().enumerate();
    let mut numbers: Vec<(f64, usize, &Feature)> = all
        .flat_map(|(i, node)| {
            let number = |f: &Feature| to_f64(&(&node.position + &f.offset));
            node.features.iter().map(move |f| (number(f), i, f))
        })
        .collect();
    numbers.sort_by(|a, b| a.0.total_cmp(&b.0));
    let widest = nodes.iter().map(|node| node.error).fold(0.0, f64::max);
    let mut found = Vec::new();
    for (k, &(x, i, f)) in numbers.iter().enumerate() {
        let near = numbers[k + 1..].iter();
        let near = near.take_while(|(y, ..)| y - x <= 2.0 * widest + PRECISION * y.abs());
        for &(y, j, g) in near.take(NEIGHBOURS) {
            let error = nodes[i].error + nodes[j].error;
            if i != j && error > 0.0 && y - x <= error + PRECISION * y.abs() {
                let positions = [i, j].map(|i| &nodes[i].position);
                let difference = (positions[0] + &f.offset) - (positions[1] + &g.offset);
                found.push(Candidate {
                    nodes: [i, j],
                    offsets: [f.offset.clone(), g.offset.clone()],
                    kinds: [f.kind, g.kind],
                    difference,
                });
            }
        }
    }
    found
}

/// The components of related nodes, as a forest: a node's position is its parent's plus an offset.
struct Components {
    parents: Vec<usize>,
    offsets: Vec<Rational>,
    /// By root: the possible positions.
    possible: Vec<[f64; 2]>,
    /// By root: the position, if a node of the component is determined.
    determined: Vec<Option<Rational>>,
    /// By root: the number of nodes.
    sizes: Vec<usize>,
}

impl Components {
    fn new(nodes: &[Node]) -> Self {
        let interval = |node: &Node| {
            let x = to_f64(&node.position);
            let error = node.error + PRECISION * x.abs();
            [x - error, x + error]
        };
        let determined = |node: &Node| (node.error <= 0.0).then(|| node.position.clone());
        Self {
            parents: (0..nodes.len()).collect(),
            offsets: vec![Rational::ZERO; nodes.len()],
            possible: nodes.iter().map(interval).collect(),
            determined: nodes.iter().map(determined).collect(),
            sizes: vec![1; nodes.len()],
        }
    }

    /// The root of a node, and the node's position relative to it.
    fn root(&self, mut node: usize) -> (usize, Rational) {
        let mut offset = Rational::ZERO;
        while self.parents[node] != node {
            offset += &self.offsets[node];
            node = self.parents[node];
        }
        (node, offset)
    }

    /// Makes the two numbers of a candidate equal; false if that contradicts other relations, or
    /// moves a node beyond its error.
    fn unite(&mut self, candidate: &Candidate) -> bool {
        let [(a, p), (b, q)] = candidate.nodes.map(|node| self.root(node));
        let [c, d] = &candidate.offsets;
        // The position of root b relative to root a.
        let shift = (p + c) - (q + d);
        match a == b {
            true => shift.is_zero(),
            false if self.sizes[a] < self.sizes[b] => self.attach(b, a, -shift),
            false => self.attach(a, b, shift),
        }
    }

    /// Attaches root b to root a at a relative position; false if no position is possible then.
    fn attach(&mut self, a: usize, b: usize, shift: Rational) -> bool {
        let by = to_f64(&shift);
        let [lo, hi] = self.possible[b].map(|x| x - by);
        let both = [self.possible[a][0].max(lo), self.possible[a][1].min(hi)];
        let theirs = self.determined[b].as_ref().map(|x| x - &shift);
        let agree = match (&self.determined[a], &theirs) {
            (Some(x), Some(y)) => x == y,
            _ => true,
        };
        if both[0] > both[1] || !agree {
            return false;
        }
        self.parents[b] = a;
        self.sizes[a] += self.sizes[b];
        self.offsets[b] = shift;
        self.possible[a] = both;
        self.determined[a] = self.determined[a].take().or(theirs);
        true
    }

    /// The positions of nodes in components with a relation that is not exact yet.
    fn positions(&self, nodes: &[Node], touched: &[bool]) -> Vec<Option<Rational>> {
        let roots: Vec<(usize, Rational)> = (0..nodes.len()).map(|i| self.root(i)).collect();
        let mut moves = vec![false; nodes.len()];
        for (i, (root, _)) in roots.iter().enumerate() {
            moves[*root] |= touched[i];
        }
        let base = |root: usize| {
            let shortest = || shortest_between(self.possible[root]);
            self.determined[root].clone().or_else(shortest)
        };
        let bases: Vec<Option<Rational>> = (0..nodes.len())
            .map(|i| moves[i].then(|| base(i)).flatten())
            .collect();
        let position = |(root, offset): &(usize, Rational)| Some(bases[*root].as_ref()? + offset);
        roots.iter().map(position).collect()
    }
}

/// The decimal with the fewest digits between two numbers, near their middle.
pub(super) fn shortest_between([lo, hi]: [f64; 2]) -> Option<Rational> {
    let middle = 0.5 * (lo + hi);
    let rounded = (0..=17).filter_map(|digits| {
        let text = format!("{middle:.digits$}");
        let value: f64 = text.parse().ok()?;
        (lo <= value && value <= hi).then(|| from_decimal(&text).ok())?
    });
    rounded.into_iter().next().or_else(|| from_f64(middle))
}
