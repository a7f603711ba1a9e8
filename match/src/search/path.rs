//! A path from the root: the first features are assigned.

use super::potentials::{Potentials, SearchChoice};
use crate::correspondence::problem::Assignment;

/// A path, with its score and bound.
pub struct Path<'a> {
    terms: &'a Potentials,
    choices: Vec<SearchChoice>,
    /// By length: the score up to there.
    scores: Vec<f64>,
    /// By piece: whether an assignment uses it.
    used: Vec<bool>,
    /// By link and choice of its later member: the greatest score of the link.
    ceilings: Vec<Vec<f64>>,
    /// By remaining feature: an upper bound of its score.
    most: Vec<f64>,
    /// By length: the previous values of `most` of the features that the last assignment affects.
    before: Vec<Vec<f64>>,
}

impl<'a> Path<'a> {
    /// The path of length zero.
    pub fn new(terms: &'a Potentials) -> Self {
        let mut path = Self {
            terms,
            choices: Vec::new(),
            scores: vec![0.0],
            used: vec![false; terms.count],
            ceilings: terms.ceilings(),
            most: Vec::new(),
            before: Vec::new(),
        };
        let all = 0..terms.own.len();
        path.most = all.map(|feature| path.most(feature)).collect();
        path
    }

    /// The complete path of the greedy choices.
    pub fn promising(terms: &'a Potentials) -> Self {
        let mut path = Self::new(terms);
        while let Some(&choice) = path.next().first() {
            path.push(choice);
        }
        path
    }

    /// The assignments so far.
    pub fn assignment(&self) -> Assignment {
        self.choices.iter().map(|c| c.checked_sub(1)).collect()
    }

    /// Whether every feature is assigned.
    pub fn is_complete(&self) -> bool {
        self.choices.len() == self.terms.own.len()
    }

    /// The score so far.
    pub fn score(&self) -> f64 {
        self.scores.last().copied().unwrap_or_default()
    }

    /// An upper bound of the score of all completions.
    pub fn bound(&self) -> f64 {
        self.score() + self.most[self.choices.len()..].iter().sum::<f64>()
    }

    /// The upper bound of a remaining feature's score.
    fn most(&self, feature: usize) -> f64 {
        let free = |c: &&SearchChoice| self.is_free(feature, **c);
        let choices = self.terms.live[feature].iter().filter(free);
        let added = choices.map(|&c| self.added(feature, c));
        added.fold(f64::NEG_INFINITY, f64::max)
    }

    /// The choices for the next feature that use no piece twice, the highest-scoring first.
    pub fn next(&self) -> Vec<SearchChoice> {
        let feature = self.choices.len();
        let Some(live) = self.terms.live.get(feature) else {
            return Vec::new();
        };
        let free = live.iter().filter(|c| self.is_free(feature, **c));
        let mut all: Vec<(f64, SearchChoice)> =
            free.map(|&c| (self.added(feature, c), c)).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.into_iter().map(|a| a.1).collect()
    }

    fn is_free(&self, feature: usize, choice: SearchChoice) -> bool {
        let pieces = self.terms.pieces(feature, choice);
        pieces.iter().all(|&p| !self.used[p as usize])
    }

    /// The own score of a choice and its scores with earlier features; with unassigned ones, the
    /// greatest score.
    fn added(&self, feature: usize, choice: SearchChoice) -> f64 {
        let links = self.terms.closing[feature].iter().map(|&l| {
            let link = &self.terms.links[l];
            match self.choices.get(link.members[0]) {
                Some(&first) => link.score(first, choice),
                None => self.ceilings[l][choice],
            }
        });
        self.terms.own[feature][choice] + links.sum::<f64>()
    }

    /// Assigns the next feature.
    pub fn push(&mut self, choice: SearchChoice) {
        let terms = self.terms;
        let feature = self.choices.len();
        let added = self.added(feature, choice);
        self.scores.push(self.score() + added);
        self.uses(feature, choice, true);
        self.choices.push(choice);
        let others = &terms.others[feature];
        let before = others.iter().map(|&other| self.most[other]).collect();
        self.before.push(before);
        for &other in others {
            self.most[other] = self.most(other);
        }
    }

    /// Removes the last assignment.
    pub fn pop(&mut self) {
        let (Some(choice), Some(before)) = (self.choices.pop(), self.before.pop()) else {
            return;
        };
        self.scores.pop();
        let feature = self.choices.len();
        self.uses(feature, choice, false);
        for (&other, most) in self.terms.others[feature].iter().zip(before) {
            self.most[other] = most;
        }
    }

    fn uses(&mut self, feature: usize, choice: SearchChoice, used: bool) {
        for &piece in self.terms.pieces(feature, choice) {
            self.used[piece as usize] = used;
        }
    }
}
