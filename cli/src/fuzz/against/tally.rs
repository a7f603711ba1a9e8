//! The counts and the findings of another program.

use super::verdict::{AgainstFailure, AgainstFindingKind, AgainstVerdict};
use crate::fuzz::finding::{Find, Finds};
use premio_verify::trial::reason;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The numbers of trees by verdict.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct AgainstCounts {
    /// Every stated measure is right.
    pub right: u64,
    /// A measure differs.
    pub wrong: u64,
    /// There is no result.
    pub refused: u64,
    /// A signal ended the program.
    pub crashed: u64,
    /// There is no answer within the limit of time.
    pub slow: u64,
    /// There is too little memory.
    pub memory: u64,
    /// The answer or the file cannot be read.
    pub unread: u64,
    /// Our own result is refused or wrong.
    pub unknown: u64,
}

impl AgainstCounts {
    /// The numbers of two sets of trees.
    pub fn plus(self, other: Self) -> Self {
        Self {
            right: self.right + other.right,
            wrong: self.wrong + other.wrong,
            refused: self.refused + other.refused,
            crashed: self.crashed + other.crashed,
            slow: self.slow + other.slow,
            memory: self.memory + other.memory,
            unread: self.unread + other.unread,
            unknown: self.unknown + other.unknown,
        }
    }

    /// The number of trees; none if it is beyond 64 bits.
    pub fn trees(&self) -> Option<u64> {
        let failed = [
            self.wrong,
            self.crashed,
            self.slow,
            self.memory,
            self.unread,
        ];
        let others = [self.right, self.refused, self.unknown];
        let mut all = failed.into_iter().chain(others);
        all.try_fold(0u64, u64::checked_add)
    }

    /// The number of trees on which the program failed; a refusal is no failure.
    pub fn failures(&self) -> u64 {
        self.wrong + self.crashed + self.slow + self.memory + self.unread
    }
}

/// The results of another program on the trees of a source.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct AgainstTally {
    /// The numbers of trees.
    pub counts: AgainstCounts,
    /// The refused ones, by reason.
    pub refusals: BTreeMap<String, Finds>,
    /// The other failures, by kind; one tree may be of several.
    pub faults: BTreeMap<AgainstFindingKind, Finds>,
    /// The durations of the compared trees.
    pub times: AgainstTimes,
}

/// The sums of durations, in seconds.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct AgainstTimes {
    /// Of the program, from its start to its end.
    pub program: f64,
    /// Of its computation as it states it; from start to end where it states none.
    pub stated: f64,
    /// Of our evaluation, on one thread.
    pub ours: f64,
}

/// The verdict on a tree, with the durations.
#[derive(Clone, Debug, PartialEq)]
pub struct AgainstOutcome {
    /// The verdict.
    pub verdict: AgainstVerdict,
    /// The durations.
    pub times: AgainstTimes,
}

impl AgainstTally {
    /// Counts a tree.
    pub fn record(&mut self, seed: u64, outcome: AgainstOutcome, file: Option<&str>) {
        let counts = &mut self.counts;
        let find = |text| Find::new(text, file);
        match outcome.verdict {
            AgainstVerdict::Unknown => {
                counts.unknown += 1;
                return;
            }
            AgainstVerdict::Right => counts.right += 1,
            AgainstVerdict::Wrong(differences) => {
                counts.wrong += 1;
                for difference in differences {
                    let kind = AgainstFindingKind::Measure(difference.measure);
                    let finds = self.faults.entry(kind).or_default();
                    finds.insert(seed, find(difference.to_string()));
                }
            }
            AgainstVerdict::Refused(words) => {
                counts.refused += 1;
                let finds = self.refusals.entry(reason(&words)).or_default();
                finds.insert(seed, find(words));
            }
            AgainstVerdict::Failed(failure, words) => {
                *match failure {
                    AgainstFailure::Crashed => &mut counts.crashed,
                    AgainstFailure::Slow => &mut counts.slow,
                    AgainstFailure::Memory => &mut counts.memory,
                    AgainstFailure::Unread => &mut counts.unread,
                } += 1;
                let finds = self
                    .faults
                    .entry(AgainstFindingKind::Failure(failure))
                    .or_default();
                finds.insert(seed, find(words));
            }
        }
        self.times.program += outcome.times.program;
        self.times.stated += outcome.times.stated;
        self.times.ours += outcome.times.ours;
    }
}
