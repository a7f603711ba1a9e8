//! The assignment problem.

use std::collections::BTreeMap;

/// By feature: the assigned candidate, or none if it is missed.
pub type Assignment = Vec<Option<usize>>;

/// A candidate of a feature in the image.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The log-likelihood ratio of its attributes as the feature's against clutter.
    pub score: f64,
    /// The pieces of edges that it uses. A piece can belong to one feature only.
    pub pieces: Vec<u32>,
}

/// A feature of the part that should be visible.
#[derive(Clone, Debug, PartialEq)]
pub struct ProblemFeature {
    /// The feature that its detection depends on; it comes before.
    pub parent: Option<usize>,
    /// The log-probabilities that it is found, where the parent is missed and where it is found.
    pub found: [f64; 2],
    /// The log-probabilities that it is missed, in the same cases.
    pub missed: [f64; 2],
    /// Its candidates.
    pub candidates: Vec<Candidate>,
}

/// A relation of two features that are both found.
#[derive(Clone, Debug, PartialEq)]
pub struct ProblemRelation {
    /// The features; the first comes before the second.
    pub members: [usize; 2],
    /// By pair of their candidates, in order: its score; zero for pairs that are not listed.
    pub scores: BTreeMap<(usize, usize), f64>,
}

/// The features of a part at a pose, in the order in which they are assigned, with their
/// candidates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Problem {
    /// The features.
    pub features: Vec<ProblemFeature>,
    /// Their relations.
    pub relations: Vec<ProblemRelation>,
}

impl ProblemFeature {
    /// Its score as a candidate or missed, where its parent is missed or found.
    pub fn score(&self, choice: Option<usize>, parent: bool) -> f64 {
        let parent = usize::from(parent);
        match choice {
            Some(c) => self.found[parent] + self.candidates[c].score,
            None => self.missed[parent],
        }
    }
}

impl ProblemRelation {
    /// Its score for two candidates.
    pub fn score(&self, pair: (usize, usize)) -> f64 {
        self.scores.get(&pair).copied().unwrap_or_default()
    }
}
