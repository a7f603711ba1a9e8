//! Dead-end elimination: removes choices that no best assignment contains (Goldstein, Biophysical
//! Journal 66, 1335, 1994).
//!
//! A choice is a dead end if another choice of its feature adds more for all choices of the other
//! features. Each elimination leaves the other features fewer choices, so more may follow.

use super::potentials::{Potentials, SearchChoice};
use std::collections::BTreeMap;

/// The number of a feature's highest-scoring choices that are compared with its others.
const RIVALS: usize = 3;

/// Removes the dead ends of a problem and returns their number.
pub fn eliminate(terms: &mut Potentials) -> u64 {
    let users = users(terms);
    let mut eliminated = 0;
    loop {
        let before = eliminated;
        for feature in 0..terms.live.len() {
            for rival in rivals(terms, feature) {
                let choices = terms.live[feature].clone();
                let dead = |&c: &SearchChoice| {
                    c != rival && is_free(terms, &users, feature, c, rival) && {
                        gain(terms, feature, c, rival) > 0.0
                    }
                };
                let dead: Vec<SearchChoice> = choices.into_iter().filter(dead).collect();
                terms.live[feature].retain(|c| !dead.contains(c));
                eliminated += dead.len() as u64;
            }
        }
        if eliminated == before {
            return eliminated;
        }
    }
}

/// A choice of a feature that uses a piece.
struct PieceUser {
    feature: usize,
    choice: SearchChoice,
}

/// By piece: the choices that use it.
type Users = BTreeMap<u32, Vec<PieceUser>>;

fn users(terms: &Potentials) -> Users {
    let mut users = Users::new();
    for (feature, choices) in terms.live.iter().enumerate() {
        for &choice in choices {
            for &piece in terms.pieces(feature, choice) {
                let user = PieceUser { feature, choice };
                users.entry(piece).or_default().push(user);
            }
        }
    }
    users
}

/// The choices of a feature with the greatest own score plus the greatest scores of pairs.
fn rivals(terms: &Potentials, feature: usize) -> Vec<SearchChoice> {
    let most = |own: SearchChoice| {
        let links = terms.all[feature].iter().map(|&l| {
            let link = &terms.links[l];
            let others = terms.live[link.other(feature)].iter();
            let scores = others.map(|&other| link.between(feature, own, other));
            scores.fold(f64::NEG_INFINITY, f64::max)
        });
        terms.own[feature][own] + links.sum::<f64>()
    };
    let mut all: Vec<(f64, SearchChoice)> =
        terms.live[feature].iter().map(|&c| (most(c), c)).collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    all.into_iter().take(RIVALS).map(|a| a.1).collect()
}

/// Whether a rival can replace a choice in any assignment: no other feature uses the additional
/// pieces of the rival.
fn is_free(
    terms: &Potentials,
    users: &Users,
    feature: usize,
    choice: SearchChoice,
    rival: SearchChoice,
) -> bool {
    let own = terms.pieces(feature, choice);
    let pieces = terms.pieces(feature, rival).iter();
    let mut others = pieces.filter(|p| !own.contains(p)).flat_map(|p| &users[p]);
    others
        .all(|other| other.feature == feature || !terms.live[other.feature].contains(&other.choice))
}

/// The least gain of a rival over a choice, for all choices of the other features.
fn gain(terms: &Potentials, feature: usize, choice: SearchChoice, rival: SearchChoice) -> f64 {
    let own = terms.own[feature][rival] - terms.own[feature][choice];
    let pieces = terms.pieces(feature, choice);
    let links = terms.all[feature].iter().map(|&l| {
        let link = &terms.links[l];
        let neighbour = link.other(feature);
        // Together with the choice, the neighbour uses none of its pieces.
        let others = terms.live[neighbour].iter().filter(|&&other| {
            let used = terms.pieces(neighbour, other);
            !used.iter().any(|piece| pieces.contains(piece))
        });
        let more = others.map(|&other| {
            link.between(feature, rival, other) - link.between(feature, choice, other)
        });
        more.fold(f64::INFINITY, f64::min)
    });
    own + links.sum::<f64>()
}
