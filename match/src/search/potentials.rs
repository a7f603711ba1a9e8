//! The score of a problem as a sum of unary and pairwise potentials, with the remaining choices.

use crate::correspondence::problem::{Candidate, Problem};
use std::collections::{BTreeMap, BTreeSet};

/// The number of a choice of a feature: 0 if it is missed, k + 1 for its candidate k.
pub type SearchChoice = usize;

/// A pairwise potential: the score of two features by the choices of both. It contains their
/// relations, and the effect of a parent's state on its child.
pub struct PairPotential {
    /// The features; the first comes before the second.
    pub members: [usize; 2],
    scores: Vec<f64>,
    columns: usize,
}

impl PairPotential {
    fn new(problem: &Problem, members: [usize; 2]) -> Self {
        let [rows, columns] = members.map(|f| problem.features[f].candidates.len() + 1);
        Self {
            members,
            scores: vec![0.0; rows * columns],
            columns,
        }
    }

    /// The score of a pair of choices.
    pub fn score(&self, first: SearchChoice, second: SearchChoice) -> f64 {
        self.scores[first * self.columns + second]
    }

    /// The score of a pair of choices, where `feature` is one of the members and its neighbour the
    /// other.
    pub fn between(&self, feature: usize, own: SearchChoice, other: SearchChoice) -> f64 {
        match self.members[0] == feature {
            true => self.score(own, other),
            false => self.score(other, own),
        }
    }

    /// The neighbour of a feature.
    pub fn other(&self, feature: usize) -> usize {
        self.members[usize::from(self.members[0] == feature)]
    }
}

/// The terms of a problem's score.
pub struct Potentials {
    /// By feature and choice: the unary score.
    pub own: Vec<Vec<f64>>,
    /// The pairwise potentials.
    pub links: Vec<PairPotential>,
    /// By feature: the indices of its links, and of those whose later member it is.
    pub all: Vec<Vec<usize>>,
    /// See `all`.
    pub closing: Vec<Vec<usize>>,
    /// By feature: the remaining choices.
    pub live: Vec<Vec<SearchChoice>>,
    /// By feature: the later features that its choice affects, by a link or by a piece that both
    /// can use.
    pub others: Vec<Vec<usize>>,
    /// How many pieces there are.
    pub count: usize,
    /// By feature and candidate: the pieces that it uses, numbered anew.
    pieces: Vec<Vec<Vec<u32>>>,
}

impl Potentials {
    /// The terms of a problem, with all choices.
    pub fn new(problem: &Problem) -> Self {
        let features = problem.features.len();
        let (mut links, mut own) = (BTreeMap::new(), Vec::with_capacity(features));
        for (f, feature) in problem.features.iter().enumerate() {
            let choices = 0..=feature.candidates.len();
            let score = |choice: SearchChoice, parent| feature.score(choice.checked_sub(1), parent);
            let Some(parent) = feature.parent else {
                own.push(choices.map(|c| score(c, false)).collect());
                continue;
            };
            own.push(vec![0.0; choices.end() + 1]);
            let link = links.entry([parent, f]);
            let link: &mut PairPotential =
                link.or_insert_with(|| PairPotential::new(problem, [parent, f]));
            for (i, added) in link.scores.iter_mut().enumerate() {
                *added += score(i % link.columns, i >= link.columns);
            }
        }
        for relation in &problem.relations {
            let link = links.entry(relation.members);
            let link = link.or_insert_with(|| PairPotential::new(problem, relation.members));
            // Pairs of candidates that do not exist are skipped.
            for (&(a, b), added) in relation.scores.iter().filter(|s| s.0.1 + 1 < link.columns) {
                if let Some(score) = link.scores.get_mut((a + 1) * link.columns + b + 1) {
                    *score += added;
                }
            }
        }
        let links: Vec<PairPotential> = links.into_values().collect();
        let mut all = vec![Vec::new(); features];
        let mut closing = vec![Vec::new(); features];
        for (i, link) in links.iter().enumerate() {
            closing[link.members[1]].push(i);
            for member in link.members {
                all[member].push(i);
            }
        }
        let live = own.iter().map(|o: &Vec<f64>| (0..o.len()).collect());
        let NumberedPieces { pieces, count } = NumberedPieces::new(problem);
        Self {
            live: live.collect(),
            others: others(&pieces, &links),
            pieces,
            count,
            own,
            links,
            all,
            closing,
        }
    }

    /// The pieces that a choice uses.
    pub fn pieces(&self, feature: usize, choice: SearchChoice) -> &[u32] {
        let candidates = &self.pieces[feature];
        choice.checked_sub(1).map_or(&[], |c| &candidates[c])
    }

    /// By link and choice of its later member: the greatest score of the link.
    pub fn ceilings(&self) -> Vec<Vec<f64>> {
        let ceiling = |link: &PairPotential| {
            let firsts = &self.live[link.members[0]];
            let most = |second| {
                let all = firsts.iter().map(|&first| link.score(first, second));
                all.fold(f64::NEG_INFINITY, f64::max)
            };
            (0..link.columns).map(most).collect()
        };
        self.links.iter().map(ceiling).collect()
    }
}

/// The pieces of a problem, renumbered from zero.
struct NumberedPieces {
    /// By feature and candidate: the pieces that it uses.
    pieces: Vec<Vec<Vec<u32>>>,
    /// The number of pieces.
    count: usize,
}

impl NumberedPieces {
    fn new(problem: &Problem) -> Self {
        let mut numbers = BTreeMap::new();
        let mut number = |piece: &u32| {
            let next = numbers.len() as u32;
            *numbers.entry(*piece).or_insert(next)
        };
        let mut of = |candidate: &Candidate| candidate.pieces.iter().map(&mut number).collect();
        let features = problem.features.iter();
        let pieces = features.map(|f| f.candidates.iter().map(&mut of).collect());
        Self {
            pieces: pieces.collect(),
            count: numbers.len(),
        }
    }
}

/// See [`Potentials::others`].
fn others(pieces: &[Vec<Vec<u32>>], links: &[PairPotential]) -> Vec<Vec<usize>> {
    let mut all = vec![BTreeSet::new(); pieces.len()];
    for link in links {
        all[link.members[0]].insert(link.members[1]);
    }
    let mut users: BTreeMap<u32, BTreeSet<usize>> = BTreeMap::new();
    for (feature, candidates) in pieces.iter().enumerate() {
        for &piece in candidates.iter().flatten() {
            users.entry(piece).or_default().insert(feature);
        }
    }
    for users in users.values() {
        for &first in users {
            all[first].extend(users.range(first + 1..));
        }
    }
    all.into_iter().map(|o| o.into_iter().collect()).collect()
}
