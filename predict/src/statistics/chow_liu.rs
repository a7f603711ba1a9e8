//! The co-detection of features: the dependence tree that loses least of their joint distribution.

use super::Pairs;

/// The pseudo-count added to each count, so that states that never occurred are not taken for
/// impossible: one half, Jeffreys' prior of a distribution over states.
const PSEUDO_COUNT: f64 = 0.5;

/// A feature in the tree.
#[derive(Clone, Debug, PartialEq)]
pub struct DependenceNode<const K: usize> {
    /// The feature that it depends on; none of the root.
    pub parent: Option<usize>,
    /// Their mutual information in nats; 0 of the root.
    pub information: f64,
    /// The probability of each of its states.
    pub marginal: [f64; K],
    /// The probability of each of its states where the parent is in a state: by the parent's, then
    /// by its own. Of the root every row is the marginal.
    pub table: [[f64; K]; K],
}

/// The spanning tree of most mutual information (Chow and Liu, IEEE Transactions on Information
/// Theory 14, 1968): of all distributions in which each feature depends on one other, the one
/// nearest to the counts.
///
/// It is computed from counts; only counts can be merged. The root is the feature with the most
/// information about all others together. Among alternatives within 2^-40 nats, the feature of the
/// lower index is used: as the root, as the next to be joined, and as the parent.
#[derive(Clone, Debug, PartialEq)]
pub struct DependenceTree<const K: usize> {
    nodes: Vec<DependenceNode<K>>,
    order: Vec<usize>,
}

/// An information as an integer: equal counts give equal integers, in whatever order they are
/// summed.
fn rank(information: f64) -> u64 {
    (information * (1_u64 << 40) as f64).round() as u64
}

/// The probabilities of states from counts.
fn smoothed<const K: usize>(counts: [u32; K]) -> [f64; K] {
    let all: f64 = counts.iter().map(|&c| f64::from(c) + PSEUDO_COUNT).sum();
    counts.map(|c| (f64::from(c) + PSEUDO_COUNT) / all)
}

/// The feature that has the most information about all others.
fn root<const K: usize>(pairs: &Pairs<K>) -> Option<usize> {
    let features = 0..pairs.features();
    let about_others = |i: usize| {
        let others = features.clone().filter(|&j| j != i);
        others.fold(0_u64, |sum, j| {
            sum.saturating_add(rank(pairs.information(i, j)))
        })
    };
    // Of equals the last is the maximum.
    features.clone().rev().max_by_key(|&i| about_others(i))
}

impl<const K: usize> DependenceTree<K> {
    /// The tree of counts.
    pub fn new(pairs: &Pairs<K>) -> Self {
        let SpanningTree { parents, order } = spanning(pairs);
        let node = |(feature, &parent): (usize, &Option<usize>)| {
            let marginal = smoothed(pairs.counts(feature));
            DependenceNode {
                parent,
                information: parent.map_or(0.0, |p| pairs.information(p, feature)),
                marginal,
                table: parent.map_or([marginal; K], |p| pairs.table(p, feature).map(smoothed)),
            }
        };
        Self {
            nodes: parents.iter().enumerate().map(node).collect(),
            order,
        }
    }

    /// The features, by their index.
    pub fn nodes(&self) -> &[DependenceNode<K>] {
        &self.nodes
    }

    /// All features, each after its parent.
    pub fn order(&self) -> &[usize] {
        &self.order
    }
}

/// A tree of all features.
struct SpanningTree {
    /// By feature: its parent.
    parents: Vec<Option<usize>>,
    /// The features in the order in which they were joined to the tree.
    order: Vec<usize>,
}

/// The tree of the most information (Prim, 1957).
fn spanning<const K: usize>(pairs: &Pairs<K>) -> SpanningTree {
    let features = pairs.features();
    let mut parents = vec![None; features];
    let mut order = Vec::with_capacity(features);
    // By feature outside the tree: its greatest information with a feature in the tree.
    let mut bound = vec![(0_u64, None); features];
    let mut outside: Vec<usize> = (0..features).collect();
    let mut next = root(pairs);
    while let Some(joined) = next {
        outside.retain(|&i| i != joined);
        parents[joined] = bound[joined].1;
        order.push(joined);
        for &i in &outside {
            let (most, parent) = bound[i];
            let found = rank(pairs.information(joined, i));
            let better = parent.is_none_or(|p| found > most || found == most && joined < p);
            if better {
                bound[i] = (found, Some(joined));
            }
        }
        next = outside.iter().rev().copied().max_by_key(|&i| bound[i].0);
    }
    SpanningTree { parents, order }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Random;

    /// The planted tree: each feature's parent.
    const PLANTED: [Option<usize>; 8] = [
        Some(3),
        Some(0),
        Some(3),
        None,
        Some(2),
        Some(2),
        Some(0),
        Some(6),
    ];
    const ORDER: [usize; 8] = [3, 0, 2, 1, 4, 5, 6, 7];

    fn draw<const K: usize>(random: &mut Random) -> Vec<u8> {
        let mut states = vec![0; 8];
        for i in ORDER {
            let kept = PLANTED[i].filter(|_| random.uniform() < 0.7);
            states[i] = kept.map_or_else(|| (random.bits() % K as u64) as u8, |p| states[p]);
        }
        states
    }

    fn sampled<const K: usize>(n: usize) -> Pairs<K> {
        let mut random = Random::new(21);
        let mut pairs = Pairs::new(8);
        for _ in 0..n {
            pairs.observe(&draw::<K>(&mut random)).unwrap();
        }
        pairs
    }

    /// The edges of a tree, whatever its root.
    fn edges(parents: impl Iterator<Item = Option<usize>>) -> Vec<(usize, usize)> {
        let edge = |(i, p): (usize, Option<usize>)| p.map(|p| (i.min(p), i.max(p)));
        let mut edges: Vec<_> = parents.enumerate().filter_map(edge).collect();
        edges.sort_unstable();
        edges
    }

    fn recovers<const K: usize>() {
        let pairs = sampled::<K>(4000);
        let tree = DependenceTree::new(&pairs);
        let found = edges(tree.nodes().iter().map(|n| n.parent));
        assert_eq!(found, edges(PLANTED.into_iter()));
        let mut known = [false; 8];
        for &i in tree.order() {
            assert!(tree.nodes()[i].parent.is_none_or(|p| known[p]));
            known[i] = true;
            for row in tree.nodes()[i].table {
                assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            }
            if tree.nodes()[i].parent.is_some() {
                let kept = tree.nodes()[i].table[0][0];
                assert!((kept - (0.7 + 0.3 / K as f64)).abs() < 0.04, "{kept}");
            }
        }
        assert!(known.iter().all(|&k| k));
    }

    #[test]
    fn a_planted_tree_is_found() {
        recovers::<2>();
        recovers::<3>();
    }

    /// The probability of an observation of all features.
    fn probability(tree: &DependenceTree<2>, states: &[usize]) -> f64 {
        let of = |(node, &state): (&DependenceNode<2>, &usize)| match node.parent {
            Some(parent) => node.table[states[parent]][state],
            None => node.marginal[state],
        };
        tree.nodes().iter().zip(states).map(of).product()
    }

    #[test]
    fn a_tree_is_a_distribution() {
        let tree = DependenceTree::new(&sampled::<2>(100));
        let all: f64 = (0..256_usize)
            .map(|bits| (0..8).map(|i| bits >> i & 1).collect::<Vec<_>>())
            .map(|states| probability(&tree, &states))
            .sum();
        assert!((all - 1.0).abs() < 1e-12);
    }

    #[test]
    fn ties_go_to_the_lower_index() {
        let none = DependenceTree::new(&Pairs::<2>::new(3));
        let parents: Vec<_> = none.nodes().iter().map(|n| n.parent).collect();
        assert_eq!(parents, [None, Some(0), Some(0)]);
        assert_eq!(none.nodes()[1].table, [[0.5; 2]; 2]);
        // All alike.
        let mut pairs = Pairs::<2>::new(4);
        for state in [0, 1, 1, 0, 0] {
            pairs.observe(&[state; 4]).unwrap();
        }
        let tree = DependenceTree::new(&pairs);
        let parents: Vec<_> = tree.nodes().iter().map(|n| n.parent).collect();
        assert_eq!(parents, [None, Some(0), Some(0), Some(0)]);
        assert_eq!(tree.order()[0], 0);
        let row = tree.nodes()[1].table[0];
        assert_eq!(row, [3.5 / 4.0, 0.5 / 4.0]);
        let empty = DependenceTree::new(&Pairs::<2>::new(0));
        assert!(empty.order().is_empty());
    }

    #[test]
    fn the_tree_has_the_most_information_of_all() {
        // Against every spanning tree of five features, by their 125 Prüfer sequences.
        let mut random = Random::new(4);
        let mut pairs = Pairs::<2>::new(5);
        for _ in 0..60 {
            let states: Vec<u8> = (0..5).map(|_| (random.bits() & 1) as u8).collect();
            pairs.observe(&states).unwrap();
        }
        let tree = DependenceTree::new(&pairs);
        let found: f64 = tree.nodes().iter().map(|n| n.information).sum();
        let mut best = 0.0_f64;
        for code in 0..125 {
            let code = [code % 5, code / 5 % 5, code / 25];
            let mut degree = [1; 5];
            code.iter().for_each(|&c| degree[c] += 1);
            let mut sum = 0.0;
            for c in code {
                let leaf = (0..5).find(|&i| degree[i] == 1).unwrap();
                sum += pairs.information(leaf, c);
                degree[leaf] = 0;
                degree[c] -= 1;
            }
            let last: Vec<_> = (0..5).filter(|&i| degree[i] == 1).collect();
            best = best.max(sum + pairs.information(last[0], last[1]));
        }
        assert!((found - best).abs() < 1e-12, "{found} {best}");
    }
}
