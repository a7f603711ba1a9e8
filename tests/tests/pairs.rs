//! Coincidences, and the same missed by powers of two in either direction: the volumes of the
//! operations must add up.

use premio_tests::pairs::{PAIRS, Pose, changes, faults, gap};

/// The powers of two by which a coincidence is missed; the example of this name tests more.
const POWERS: [i32; 6] = [10, 18, 22, 26, 36, 50];

fn holds(pose: Pose) {
    let mut wrong = Vec::new();
    for pair in PAIRS {
        let missed = POWERS.map(|power| ["", "-"].map(|sign| gap(sign, power)));
        for gap in missed.as_flattened().iter().chain([&"0".to_owned()]) {
            let found = faults(pair, gap, pose);
            if !found.is_empty() {
                wrong.push(format!("{} by {gap}: {found:?}", pair.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn coincidences_and_what_is_next_to_them() {
    holds(Pose::Straight);
}

#[test]
fn coincidences_along_other_axes() {
    holds(Pose::Swapped);
}

#[test]
fn coincidences_turned() {
    holds(Pose::Turned);
}

#[test]
fn coincidences_tilted_by_next_to_nothing() {
    holds(Pose::Tilted);
}

#[test]
fn coincidences_far_from_the_origin() {
    holds(Pose::Far);
}

/// The powers of two by which a coincidence is missed in exact evaluation.
const EXACT_POWERS: [i32; 2] = [10, 60];

/// Pairs that take a minute in 237 bits once they are rotated; the example of the same name tests
/// them.
const LONG_TURNED: [&str; 2] = ["torus on a torus, cut open", "torus in a bore, cut across"];

/// On one side of a coincidence the exact boundaries are alike, however close they are to it.
fn alike(sign: &str, pose: Pose) {
    let is_asked = |name| pose == Pose::Straight || !LONG_TURNED.contains(&name);
    let changed: Vec<String> = PAIRS
        .iter()
        .filter(|pair| is_asked(pair.name))
        .flat_map(|pair| changes(pair, sign, &EXACT_POWERS, pose))
        .collect();
    assert!(changed.is_empty(), "{}", changed.join("\n"));
}

#[test]
fn exactly_alike_on_one_side() {
    alike("", Pose::Straight);
}

#[test]
fn exactly_alike_on_the_other_side() {
    alike("-", Pose::Straight);
}

#[test]
fn exactly_alike_turned_on_one_side() {
    alike("", Pose::Turned);
}

#[test]
fn exactly_alike_turned_on_the_other_side() {
    alike("-", Pose::Turned);
}
