//! The laws of set algebra hold for boundaries, and motions change only their position.

use premio_tests::identities::broken_by;
use premio_tests::mirror;
use rayon::prelude::*;

/// Seeds of three random trees each that once violated a law, with what is hard about them.
const MENDED: [(u64, &str); 6] = [
    (
        104,
        "a cone's face with edges through the apex, measured from elsewhere",
    ),
    (
        163,
        "two faces of a torus that share the arc along which it touches a disc",
    ),
    (200, "the same cone within others"),
    (
        261,
        "a closed curve cut three times at one corner, next to its seam",
    ),
    (
        343,
        "a torus and a cone that touch along an arc, cut by a block and joined again",
    ),
    (
        486,
        "a contact along a ruling, and a very short line across its end",
    ),
];

fn holds(seeds: impl Iterator<Item = (u64, &'static str)>) {
    let seeds: Vec<_> = seeds.collect();
    let each = seeds.into_par_iter().flat_map_iter(|(seed, what)| {
        let say = move |law| format!("{seed} {what}: {law}");
        broken_by(seed).into_iter().map(say)
    });
    let broken: Vec<String> = each.collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn laws_hold_for_random_trees() {
    holds((0..10).map(|seed| (seed, "")));
}

#[test]
fn laws_hold_for_trees_that_broke_them() {
    holds(MENDED.into_iter());
}

#[test]
fn views_of_mirrored_trees_are_mirrored() {
    let seeds = (0..40u64).into_par_iter();
    let broken: Vec<String> = seeds.flat_map_iter(mirror::broken_by).collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}
