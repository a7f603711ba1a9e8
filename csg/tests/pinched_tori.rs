//! Tori whose tube reaches their axis, cut by blocks with corners at the poles and next to them.

use crate::common::{evaluated, tree};
use premio_csg::reader::Format;
use proptest::prelude::*;

/// The radii, and half the distance of the poles: horn tori and spindle tori.
const TORI: [([f64; 2], f64); 4] = [
    ([2.0, 2.0], 0.0),
    ([0.5, 0.5], 0.0),
    ([1.5, 2.5], 2.0),
    ([3.0, 5.0], 4.0),
];

/// The volume of a torus less a block, and that of their intersection, make up the whole torus.
fn assert_additive(radii: [f64; 2], block: &str) {
    let [major, minor] = radii;
    let torus = format!("TOR(RMAJ={major}, RMIN={minor})");
    let volume = |part: &str| {
        let known = evaluated(&tree(&format!("P = {part}\n"), Format::Padl));
        known.mass().volume
    };
    let whole = volume(&torus);
    let parts = ["DIF", "INT"].map(|op| volume(&format!("{torus} {op} {block}")));
    let off = parts.iter().sum::<f64>() - whole;
    assert!(
        off.abs() <= 1e-9 * whole,
        "{torus}, {block}: {parts:?} of {whole}"
    );
}

/// A face of the block crosses the torus in an edge around the pole that is shorter than the resolution.
#[test]
fn blocks_that_end_next_to_a_pole() {
    let below = "BLO(X=0.5, Y=1.5, Z=0.5) AT (MOVZ=-0.00000001)";
    assert_additive([2.0, 2.0], below);
    let above = "BLO(X=0.5, Y=1, Z=1.5) AT (MOVY=-0.5, MOVZ=0.5, MOVZ=0.0000000001)";
    assert_additive([1.5, 2.5], above);
}

/// Edges in planes through the axis are tangent to it at the pole. Only their curvature shows the angles at
/// which they leave it.
#[test]
fn a_block_with_a_corner_at_the_pole_may_be_rotated() {
    assert_additive([2.0, 2.0], "BLO(X=1, Y=1, Z=1) AT (ROTZ=-30)");
}

/// A torus lies in another one except for a sliver along their largest parallel. The sliver is 1e-12 thick, and
/// planes of a wedge pass through it. Edges in those planes are not edges of the sliver where the tori count
/// as tangent.
#[test]
fn a_sliver_between_tangent_tori_has_no_slits() {
    let part = "P = (
        TOR(RMAJ=2, RMIN=2)
        DIF WED(X=1.5, Y=1, Z=1) AT (ROTY=-90, MOVY=1, MOVZ=-1.5)
        DIF TOR(RMAJ=1.5, RMIN=2.5) AT (MOVZ=0.000001)
        ) UN TOR(RMAJ=2.5, RMIN=1)\n";
    let volume = evaluated(&tree(part, Format::Padl)).mass().volume;
    let ring = 5.0 * std::f64::consts::PI.powi(2);
    assert!((volume - ring).abs() < 1e-9, "{volume} of {ring}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn a_torus_less_a_block_and_their_intersection_make_up_the_torus(
        torus in 0..TORI.len(),
        size in [1..6, 1..6, 1..6],
        corner in [-2..2, -2..2, -2..2],
        at_pole in any::<bool>(),
        rotation in prop::sample::select(vec!["0", "-30", "17"]),
        off in prop::sample::select(vec!["0", "0.00001", "0.00000001", "-0.00000001", "0.0000000001"]),
    ) {
        let (radii, pole) = TORI[torus];
        let half = |k: i32| f64::from(k) / 2.0;
        let [x, y, z] = size.map(half);
        let [a, b, c] = corner.map(half);
        let c = if at_pole { c + pole } else { c };
        let block = format!("BLO(X={x}, Y={y}, Z={z}) AT (MOVX={a}, MOVY={b}, MOVZ={c}, MOVZ={off}, ROTZ={rotation})");
        assert_additive(radii, &block);
    }
}
