//! Coincidences, and the same missed by powers of two either way: what the operations give has the
//! volumes that add up.

use premio_tests::pairs::{PAIRS, Pose, faults, gap};

/// By which powers of two a coincidence is missed; more by the example of this name.
const POWERS: [i32; 6] = [10, 18, 22, 26, 36, 50];

/// What is not mended yet: the volume of a sliver is below rounding, so that its shell is called turned
/// over. What starts to pass must be taken off.
const KNOWN: &[(&str, Pose, &[&str], &[i32])] = &[
    ("torus standing on block", Pose::Straight, &["-"], &[26]),
    ("edge on ball", Pose::Turned, &["-"], &[26]),
    ("torus standing on block", Pose::Turned, &["-"], &[26]),
];

fn is_known(name: &str, pose: Pose, sign: &str, power: i32) -> bool {
    KNOWN.iter().any(|known| {
        (known.0, known.1) == (name, pose) && known.2.contains(&sign) && known.3.contains(&power)
    })
}

fn holds(pose: Pose) {
    let mut wrong = Vec::new();
    for pair in PAIRS {
        for (sign, power) in POWERS.iter().flat_map(|&power| [("", power), ("-", power)]) {
            let found = faults(pair, &gap(sign, power), pose);
            if found.is_empty() == is_known(pair.name, pose, sign, power) {
                wrong.push(format!("{} by {sign}2^-{power}: {found:?}", pair.name));
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
fn coincidences_turned() {
    holds(Pose::Turned);
}
