//! Choices that no best assignment has, found before the search: dead ends (Goldstein, Biophysical
//! Journal 66, 1335, 1994).
//!
//! A choice is a dead end if another choice of its feature adds more whatever the others are. Where
//! choices are eliminated the others have fewer, so that more may follow.

use super::potentials::{Potentials, SearchChoice};
use std::collections::BTreeMap;

/// So many choices of a feature, those that add the most, are held against its others.
const RIVALS: usize = 3;

/// Leaves the choices of a problem that are no dead ends; tells how many were.
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

/// By piece: the features and choices that use it.
type Users = BTreeMap<u32, Vec<(usize, SearchChoice)>>;

fn users(terms: &Potentials) -> Users {
    let mut users = Users::new();
    for (feature, choices) in terms.live.iter().enumerate() {
        for &choice in choices {
            for &piece in terms.pieces(feature, choice) {
                users.entry(piece).or_default().push((feature, choice));
            }
        }
    }
    users
}

/// The choices of a feature that add the most by themselves and at best with others.
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

/// Whether a rival can take the place of a choice in any assignment: what it uses besides is used by no
/// other feature.
fn is_free(
    terms: &Potentials,
    users: &Users,
    feature: usize,
    choice: SearchChoice,
    rival: SearchChoice,
) -> bool {
    let own = terms.pieces(feature, choice);
    let besides = terms.pieces(feature, rival).iter();
    let mut others = besides.filter(|p| !own.contains(p)).flat_map(|p| &users[p]);
    others.all(|&(other, c)| other == feature || !terms.live[other].contains(&c))
}

/// How much more a rival adds than a choice, whatever the others are.
fn gain(terms: &Potentials, feature: usize, choice: SearchChoice, rival: SearchChoice) -> f64 {
    let own = terms.own[feature][rival] - terms.own[feature][choice];
    let pieces = terms.pieces(feature, choice);
    let links = terms.all[feature].iter().map(|&l| {
        let link = &terms.links[l];
        let neighbour = link.other(feature);
        // Next to the choice the neighbour uses none of its pieces.
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
