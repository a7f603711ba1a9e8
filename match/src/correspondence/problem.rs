//! What is to be assigned.

use std::collections::BTreeMap;

/// By feature: the candidate that it is, or none if it is missed.
pub type Assignment = Vec<Option<usize>>;

/// Something of the picture that a feature can be.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The logarithm of how much more likely its attributes are as the feature's than as clutter.
    pub score: f64,
    /// The pieces of edges that it is made of: each can be of one feature only.
    pub pieces: Vec<u32>,
}

/// A feature of the part that should be visible.
#[derive(Clone, Debug, PartialEq)]
pub struct ProblemFeature {
    /// The feature that its detection depends on; it comes before.
    pub parent: Option<usize>,
    /// The logarithms of how likely it is found, where the parent is missed, and where it is found.
    pub found: [f64; 2],
    /// The same of how likely it is missed.
    pub missed: [f64; 2],
    /// What it can be.
    pub candidates: Vec<Candidate>,
}

/// A relation of two features that are both found.
#[derive(Clone, Debug, PartialEq)]
pub struct ProblemRelation {
    /// The features; the first comes before the second.
    pub members: [usize; 2],
    /// By pair of their candidates, in order, what it adds; nothing for pairs that are not listed.
    pub scores: BTreeMap<(usize, usize), f64>,
}

/// The features of a part at a pose, in the order in which they are assigned, and what they can be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Problem {
    /// The features.
    pub features: Vec<ProblemFeature>,
    /// Their relations.
    pub relations: Vec<ProblemRelation>,
}

impl ProblemFeature {
    /// What it adds as a candidate, or missed, where its parent is missed or found.
    pub fn score(&self, choice: Option<usize>, parent: bool) -> f64 {
        let parent = usize::from(parent);
        match choice {
            Some(c) => self.found[parent] + self.candidates[c].score,
            None => self.missed[parent],
        }
    }
}

impl ProblemRelation {
    /// What it adds for two candidates.
    pub fn score(&self, pair: (usize, usize)) -> f64 {
        self.scores.get(&pair).copied().unwrap_or_default()
    }
}

impl Problem {
    /// The score of an assignment; it may use a piece twice, which no search does.
    pub fn score(&self, assignment: &[Option<usize>]) -> f64 {
        let own = self.features.iter().zip(assignment).map(|(f, choice)| {
            let parent = f.parent.is_some_and(|p| assignment[p].is_some());
            f.score(*choice, parent)
        });
        let related = self.relations.iter().map(|r| {
            let [a, b] = r.members.map(|m| assignment[m]);
            a.zip(b).map_or(0.0, |pair| r.score(pair))
        });
        own.sum::<f64>() + related.sum::<f64>()
    }
}
