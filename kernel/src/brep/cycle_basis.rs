//! A cycle basis of an undirected graph by Welch's method (J. ACM 13(2), 1966): a spanning forest,
//! and for each edge outside it the cycle that it closes.
//!
//! The loops of a face are found from the order of edges around vertices. Here they are checked to
//! be sums (modulo two) of such cycles. Gibbs (1969) showed that Welch's enumeration of all cycles
//! from the basis is wrong; the basis itself is correct, and only it is used.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// An edge of the graph between two vertices; an edge from a vertex to itself is a cycle.
pub type GraphEdge = [usize; 2];

/// Whether a set of edges is a sum of cycles.
pub fn is_sum_of_cycles(links: &[GraphEdge], edges: &BTreeSet<usize>) -> bool {
    let forest = Forest::new(links);
    let mut sum = BTreeSet::new();
    for &e in edges.iter().filter(|e| !forest.edges.contains(e)) {
        for part in forest.closed_by(links, e) {
            if !sum.remove(&part) {
                sum.insert(part);
            }
        }
    }
    sum == *edges
}

/// A spanning forest.
struct Forest {
    edges: BTreeSet<usize>,
    /// By vertex: the way to its parent, if it has one.
    up: BTreeMap<usize, Upwards>,
    /// By vertex: its depth.
    depth: BTreeMap<usize, usize>,
}

/// The way from a vertex of a forest to its parent.
#[derive(Clone, Copy)]
struct Upwards {
    parent: usize,
    edge: usize,
}

impl Forest {
    fn new(links: &[GraphEdge]) -> Self {
        let mut around: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (e, [a, b]) in links.iter().enumerate() {
            around.entry(*a).or_default().push(e);
            around.entry(*b).or_default().push(e);
        }
        let mut forest = Self {
            edges: BTreeSet::new(),
            up: BTreeMap::new(),
            depth: BTreeMap::new(),
        };
        for &root in around.keys() {
            if forest.depth.contains_key(&root) {
                continue;
            }
            forest.depth.insert(root, 0);
            let mut queue = VecDeque::from([root]);
            while let Some(v) = queue.pop_front() {
                for &e in &around[&v] {
                    let [a, b] = links[e];
                    let w = if a == v { b } else { a };
                    if !forest.depth.contains_key(&w) {
                        forest.depth.insert(w, forest.depth[&v] + 1);
                        forest.up.insert(w, Upwards { parent: v, edge: e });
                        forest.edges.insert(e);
                        queue.push_back(w);
                    }
                }
            }
        }
        forest
    }

    /// The cycle that an edge outside the forest closes.
    fn closed_by(&self, links: &[GraphEdge], edge: usize) -> BTreeSet<usize> {
        let [mut a, mut b] = links[edge];
        let mut cycle = BTreeSet::from([edge]);
        while a != b {
            let deeper = if self.depth[&a] >= self.depth[&b] {
                &mut a
            } else {
                &mut b
            };
            let Upwards { parent, edge } = self.up[deeper];
            cycle.insert(edge);
            *deeper = parent;
        }
        cycle
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cycles_of_a_square_with_a_diagonal_are_sums() {
        let links = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]];
        assert!(is_sum_of_cycles(&links, &BTreeSet::from([0, 1, 2, 3])));
        assert!(is_sum_of_cycles(&links, &BTreeSet::from([0, 1, 4])));
        assert!(!is_sum_of_cycles(&links, &BTreeSet::from([0, 1, 2])));
    }

    #[test]
    fn an_edge_from_a_vertex_to_itself_is_a_cycle() {
        let links = [[5, 5], [5, 6]];
        assert!(is_sum_of_cycles(&links, &BTreeSet::from([0])));
        assert!(!is_sum_of_cycles(&links, &BTreeSet::from([0, 1])));
    }
}
