//! A path from the root: the first features are assigned.

use super::problem::Assignment;
use super::terms::{Choice, Terms};
use std::collections::BTreeSet;

/// A path, with its score and bound.
pub struct Path<'a> {
    terms: &'a Terms<'a>,
    choices: Vec<Choice>,
    /// By length: the score up to there.
    scores: Vec<f64>,
    used: BTreeSet<u32>,
    /// By link and choice of its later member: the most that it can add.
    ceilings: Vec<Vec<f64>>,
}

impl<'a> Path<'a> {
    /// The path of length zero.
    pub fn new(terms: &'a Terms<'a>) -> Self {
        Self {
            terms,
            choices: Vec::new(),
            scores: vec![0.0],
            used: BTreeSet::new(),
            ceilings: terms.ceilings(),
        }
    }

    /// The complete path of the most promising choices, one after another.
    pub fn promising(terms: &'a Terms<'a>) -> Self {
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

    /// What no completion has more than.
    pub fn bound(&self) -> f64 {
        let left = self.choices.len()..self.terms.own.len();
        let most = left.map(|feature| {
            let free = |c: &&Choice| self.is_free(feature, **c);
            let choices = self.terms.live[feature].iter().filter(free);
            let added = choices.map(|&c| self.added(feature, c));
            added.fold(f64::NEG_INFINITY, f64::max)
        });
        self.score() + most.sum::<f64>()
    }

    /// The choices for the next feature that use no piece twice, the most promising first.
    pub fn next(&self) -> Vec<Choice> {
        let feature = self.choices.len();
        let Some(live) = self.terms.live.get(feature) else {
            return Vec::new();
        };
        let free = live.iter().filter(|c| self.is_free(feature, **c));
        let mut all: Vec<(f64, Choice)> = free.map(|&c| (self.added(feature, c), c)).collect();
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        all.into_iter().map(|a| a.1).collect()
    }

    fn is_free(&self, feature: usize, choice: Choice) -> bool {
        let pieces = self.terms.pieces(feature, choice);
        pieces.iter().all(|p| !self.used.contains(p))
    }

    /// What a choice adds by itself and with the features before it; with those that are not assigned,
    /// the most that it can.
    fn added(&self, feature: usize, choice: Choice) -> f64 {
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
    pub fn push(&mut self, choice: Choice) {
        let feature = self.choices.len();
        let added = self.added(feature, choice);
        self.scores.push(self.score() + added);
        self.used.extend(self.terms.pieces(feature, choice));
        self.choices.push(choice);
    }

    /// Takes the last assignment back.
    pub fn pop(&mut self) {
        self.scores.pop();
        let Some(choice) = self.choices.pop() else {
            return;
        };
        for piece in self.terms.pieces(self.choices.len(), choice) {
            self.used.remove(piece);
        }
    }
}
