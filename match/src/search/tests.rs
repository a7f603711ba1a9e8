//! Compares the searches with exhaustive enumeration.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use super::{Strategy, search};
use crate::correspondence::problem::{
    Assignment, Candidate, Problem, ProblemFeature, ProblemRelation,
};
use proptest::prelude::*;

const ALL: [Strategy; 3] = [Strategy::Bounded, Strategy::Deepening, Strategy::Stepped];

/// The score of an assignment. It does not check that no piece is used twice.
fn score(problem: &Problem, assignment: &[Option<usize>]) -> f64 {
    let own = problem.features.iter().zip(assignment).map(|(f, choice)| {
        let parent = f.parent.is_some_and(|p| assignment[p].is_some());
        f.score(*choice, parent)
    });
    let related = problem.relations.iter().map(|r| {
        let [a, b] = r.members.map(|m| assignment[m]);
        a.zip(b).map_or(0.0, |pair| r.score(pair))
    });
    own.sum::<f64>() + related.sum::<f64>()
}

/// The best score of all assignments that use no piece twice.
fn best(problem: &Problem) -> f64 {
    fn complete(problem: &Problem, path: &mut Assignment, best: &mut f64) {
        let Some(feature) = problem.features.get(path.len()) else {
            let mut used: Vec<u32> = Vec::new();
            for (feature, choice) in problem.features.iter().zip(path.iter()) {
                used.extend(choice.iter().flat_map(|c| &feature.candidates[*c].pieces));
            }
            let count = used.len();
            used.sort_unstable();
            used.dedup();
            if used.len() == count {
                *best = best.max(score(problem, path));
            }
            return;
        };
        for choice in (0..feature.candidates.len()).map(Some).chain([None]) {
            path.push(choice);
            complete(problem, path, best);
            path.pop();
        }
    }
    let mut best_score = f64::NEG_INFINITY;
    complete(problem, &mut Vec::new(), &mut best_score);
    best_score
}

fn feature(index: usize) -> impl Strategy2<Value = ProblemFeature> {
    let candidate = (-4.0..6.0f64, prop::collection::btree_set(0..7u32, 1..3));
    let candidates = prop::collection::vec(candidate, 0..4);
    let rates = prop::array::uniform2(0.02..0.98f64);
    let parent = prop::option::of(0..index.max(1));
    (candidates, rates, parent).prop_map(move |(candidates, rates, parent)| ProblemFeature {
        parent: parent.filter(|_| index > 0),
        found: rates.map(f64::ln),
        missed: rates.map(|r| (1.0 - r).ln()),
        candidates: candidates
            .into_iter()
            .map(|(score, pieces)| Candidate {
                score,
                pieces: pieces.into_iter().collect(),
            })
            .collect(),
    })
}

use proptest::strategy::Strategy as Strategy2;

fn problem() -> impl Strategy2<Value = Problem> {
    let features = (1..6usize).prop_flat_map(|n| (0..n).map(feature).collect::<Vec<_>>());
    let pair = (0..6usize, 0..6usize);
    let relation = (
        pair,
        prop::collection::btree_map((0..3usize, 0..3usize), -2.0..2.0f64, 0..5),
    );
    (features, prop::collection::vec(relation, 0..5)).prop_map(|(features, relations)| {
        let n = features.len();
        let relations = relations
            .into_iter()
            .map(|((a, b), scores)| ProblemRelation {
                members: [a.min(b) % n, a.max(b) % n],
                scores,
            })
            .filter(|r| r.members[0] < r.members[1])
            .collect();
        Problem {
            features,
            relations,
        }
    })
}

proptest! {
    #[test]
    fn every_search_finds_the_best_assignment(problem in problem()) {
        let best = best(&problem);
        for strategy in ALL {
            let found = search(&problem, strategy, u64::MAX);
            prop_assert!(found.complete);
            // Sums in another order differ in their last digits.
            prop_assert!((found.score - best).abs() < f64::from(f32::EPSILON), "{strategy:?}: {} {best}", found.score);
            let score = score(&problem, &found.assignment);
            prop_assert!((found.score - score).abs() < f64::from(f32::EPSILON));
        }
    }

    #[test]
    fn work_is_bounded(problem in problem(), most in 0..40u64) {
        for strategy in ALL {
            let found = search(&problem, strategy, most);
            let all = if strategy == Strategy::Bounded { most } else { 2 * most };
            prop_assert!(found.effort.opened <= all);
            prop_assert!(found.complete || found.effort.opened == all);
        }
    }
}

#[test]
fn a_piece_is_of_one_feature() {
    // Both can use piece 7; the second has no other candidate.
    let feature = |scores: &[(f64, u32)]| ProblemFeature {
        parent: None,
        found: [0.9f64.ln(); 2],
        missed: [0.1f64.ln(); 2],
        candidates: scores
            .iter()
            .map(|&(score, piece)| Candidate {
                score,
                pieces: vec![piece],
            })
            .collect(),
    };
    let problem = Problem {
        features: vec![feature(&[(3.0, 7), (2.5, 8)]), feature(&[(2.0, 7)])],
        relations: Vec::new(),
    };
    for strategy in ALL {
        let found = search(&problem, strategy, u64::MAX);
        assert_eq!(found.assignment, [Some(1), Some(0)]);
    }
}

#[test]
fn work_that_runs_out_leaves_the_most_promising_path() {
    let feature = ProblemFeature {
        parent: None,
        found: [0.9f64.ln(); 2],
        missed: [0.1f64.ln(); 2],
        candidates: vec![Candidate {
            score: 3.0,
            pieces: Vec::new(),
        }],
    };
    let problem = Problem {
        features: vec![feature; 3],
        relations: Vec::new(),
    };
    for strategy in ALL {
        let found = search(&problem, strategy, 1);
        assert_eq!(
            (found.assignment, found.complete),
            (vec![Some(0); 3], false)
        );
    }
}

#[test]
fn nothing_is_assigned_where_there_is_nothing() {
    for strategy in ALL {
        let found = search(&Problem::default(), strategy, 10);
        assert_eq!((found.score, found.complete), (0.0, true));
    }
}
