//! Pairs that touch exactly, and the same with a small gap or overlap. Distances below the
//! close-call limit are listed on either side, and nothing else is.

use approx::assert_relative_eq;
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_kernel::number::predicates::CloseCall;
use premio_tests::random::tree;

/// A pair in PADL at the distance `D`, and its number of solids when separate, touching and
/// overlapping.
type Family = (&'static str, &'static str, [usize; 3]);

#[rustfmt::skip]
const FAMILIES: &[Family] = &[
    ("ball on block", "BLO(X=4,Y=4,Z=2) UN (SPH(R=1) AT (MOVX=2,MOVY=2,MOVZ=3+D))", [2, 2, 1]),
    ("block on block", "BLO(X=4,Y=4,Z=2) UN (BLO(X=1,Y=1,Z=1) AT (MOVX=1,MOVY=1,MOVZ=2+D))", [2, 1, 1]),
    ("block beside block", "BLO(X=4,Y=4,Z=2) UN (BLO(X=1,Y=1,Z=1) AT (MOVX=4+D,MOVY=1,MOVZ=1))", [2, 1, 1]),
    ("edge along edge", "BLO(X=4,Y=4,Z=2) UN (BLO(X=1,Y=4,Z=1) AT (MOVX=4+D,MOVY=1,MOVZ=2))", [2, 2, 1]),
    ("vertex at vertex", "BLO(X=4,Y=4,Z=2) UN (BLO(X=1,Y=4,Z=1) AT (MOVX=4+D,MOVY=4+D,MOVZ=2+D))", [2, 2, 1]),
    ("cylinder lying on block", "BLO(X=4,Y=4,Z=2) UN (CYL(R=1,H=2) AT (ROTX=90,MOVX=2,MOVY=3,MOVZ=3+D))", [2, 2, 1]),
    ("cylinder standing on block", "BLO(X=4,Y=4,Z=2) UN (CYL(R=1,H=2) AT (MOVX=2,MOVY=2,MOVZ=2+D))", [2, 1, 1]),
    ("balls", "SPH(R=1) UN (SPH(R=2) AT (MOVX=3+D))", [2, 2, 1]),
    ("parallel cylinders", "CYL(R=1,H=4) UN (CYL(R=1,H=4) AT (MOVX=2+D))", [2, 2, 1]),
    ("skew cylinders", "CYL(R=1,H=4) UN (CYL(R=1,H=4) AT (ROTX=90,MOVX=2+D,MOVY=2,MOVZ=2))", [2, 2, 1]),
    ("apex on block", "BLO(X=4,Y=4,Z=2) UN (CON(R=1,H=2) AT (ROTX=180,MOVX=2,MOVY=2,MOVZ=4+D))", [2, 2, 1]),
    ("apex on ball", "SPH(R=1) UN (CON(R=1,H=2) AT (ROTX=180,MOVZ=3+D))", [2, 2, 1]),
    ("torus lying on block", "(BLO(X=8,Y=8,Z=2) AT (MOVX=-4,MOVY=-4,MOVZ=-2)) UN (TOR(RMAJ=2,RMIN=1) AT (MOVZ=1+D))", [2, 2, 1]),
    ("torus standing on block", "(BLO(X=8,Y=8,Z=2) AT (MOVX=-4,MOVY=-4,MOVZ=-2)) UN (TOR(RMAJ=2,RMIN=1) AT (ROTX=90,MOVZ=3+D))", [2, 2, 1]),
    ("tori side by side", "TOR(RMAJ=2,RMIN=1) UN (TOR(RMAJ=2,RMIN=1) AT (MOVX=6+D))", [2, 2, 1]),
    ("edge on ball", "(BLO(X=4,Y=2,Z=2) AT (MOVX=-2)) UN (SPH(R=1) AT (MOVY=-0.6-D*0.6,MOVZ=2.8+D*0.8))", [2, 2, 1]),
    ("vertex on face", "(BLO(X=4,Y=4,Z=4) AT (MOVX=-2,MOVY=-2,MOVZ=-4)) UN (WED(X=1,Y=1,Z=1) AT (ROTY=-45,ROTX=35,MOVZ=D))", [2, 2, 1]),
    ("edge across edge", "(BLO(X=4,Y=1,Z=1) AT (MOVX=-2,MOVY=-0.5,MOVZ=-0.5,ROTX=45)) UN (BLO(X=4,Y=1,Z=1) AT (MOVX=-2,MOVY=-0.5,MOVZ=-0.5,ROTX=45,ROTZ=90,MOVZ=1.4142135623730951+D))", [2, 2, 1]),
    ("ball in bore", "CYL(R=2,H=4) DIF (SPH(R=1) AT (MOVX=1-D,MOVZ=2))", [1, 1, 1]),
    ("void at wall", "BLO(X=4,Y=4,Z=4) DIF (SPH(R=1) AT (MOVX=2,MOVY=2,MOVZ=3-D))", [1, 1, 1]),
    ("vertex on cylinder", "CYL(R=1,H=4) UN (WED(X=1,Y=1,Z=1) AT (ROTZ=30,ROTY=20,MOVX=1+D,MOVZ=2))", [1, 1, 1]),
    ("blocks, turned", "(BLO(X=4,Y=4,Z=2) UN (BLO(X=1,Y=1,Z=1) AT (MOVX=1,MOVY=1,MOVZ=2+D))) AT (ROTX=17,ROTZ=31)", [2, 1, 1]),
    ("ball on block, turned", "(BLO(X=4,Y=4,Z=2) UN (SPH(R=1) AT (MOVX=2,MOVY=2,MOVZ=3+D))) AT (ROTX=17,ROTZ=31)", [2, 2, 1]),
];

/// The pair with the given gap.
fn part(pair: &str, gap: &str) -> Evaluation {
    let text = format!("D = {gap}\nP = {pair}\n");
    let tree = read(
        "part",
        text.as_bytes(),
        Format::Padl,
        &ReadOptions::default(),
    );
    evaluate(&tree.unwrap().tree, &EvaluationOptions::default()).unwrap()
}

#[test]
fn near_misses_are_close_calls_on_either_side() {
    let gaps = [
        ("0.0001", 0, false),
        ("0.000000001", 0, true),
        ("0", 1, false),
        ("-0.000000001", 2, true),
        ("-0.0001", 2, false),
    ];
    let mut wrong = Vec::new();
    for (name, pair, solids) in FAMILIES {
        for (gap, column, close) in gaps {
            let part = part(pair, gap);
            let found = &part.brep.topology.solids.len();
            if *found != solids[column] {
                wrong.push(format!("{name} at {gap}: {found} solids"));
            }
            if part.decisions.close_calls.is_empty() == close {
                wrong.push(format!("{name} at {gap}: {:?}", part.decisions.close_calls));
            }
            for defect in part.violations() {
                wrong.push(format!("{name} at {gap}: {defect:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Random trees in which nothing of the boundary is close, with what seems to be.
const CLEAR: [(u64, &str); 21] = [
    (22960, "a curve that leaves a plane with the fourth power"),
    (26981, "a curve next to the ruling along which it touches"),
    (27750, "a curve that touches a ruling"),
    (
        21101,
        "a rim on the circle along which a torus touches its disc, taken away",
    ),
    (
        22334,
        "a rim on the ruling along which a cylinder touches it, within others",
    ),
    (
        22594,
        "a face on the ruling along which a cylinder touches it, one of them covered",
    ),
    (22793, "a torus on a disc, where two others hold both"),
    (23364, "a torus on the plane of a face beyond the face"),
    (
        23531,
        "a torus on a disc next to another disc's plane, all covered",
    ),
    (
        25153,
        "a torus on a wedge, next to another torus, within others",
    ),
    (26149, "a face next to the rim of a frustum that is covered"),
    (26229, "a torus on the planes of two faces beyond them"),
    (26393, "a torus on a disc that is taken away"),
    (
        27670,
        "a sphere on the plane of a wedge that lies elsewhere",
    ),
    (11615, "a torus on the plane of a block beyond its face"),
    (12973, "a torus on the face of a wedge that is taken away"),
    (10662, "a torus on the plane of a wedge beyond its face"),
    (8228, "a torus on a wedge's edge, taken away"),
    (9448, "a torus on the plane of a block beyond its face"),
    (
        26380,
        "short edges beside a disc that they leave where a torus touches it",
    ),
    (
        9188,
        "short edges beside a torus that they leave where a disc touches it",
    ),
];

/// The close calls of a random tree.
fn calls(seed: u64) -> Vec<CloseCall> {
    let text = tree(seed).to_string();
    let read = read(
        "tree",
        text.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    );
    let part = evaluate(&read.unwrap().tree, &EvaluationOptions::default()).unwrap();
    part.decisions.close_calls
}

#[test]
fn what_cannot_change_the_boundary_is_no_close_call() {
    for (seed, what) in CLEAR {
        let calls = calls(seed);
        assert!(calls.is_empty(), "seed {seed}, {what}: {calls:?}");
    }
}

/// Two tori touch at a point from above and below. A sphere passes at a distance of 1.3e-4, so its
/// edge on one torus is above the other by the gap between them there.
#[test]
fn a_gap_that_narrows_towards_a_touch_is_a_close_call() {
    let calls = calls(21819);
    let [call] = calls.as_slice() else {
        panic!("{calls:?}")
    };
    assert!((call.distance - 5.370_408_9e-9).abs() < 1e-15, "{call:?}");
}

#[test]
fn a_near_miss_counts_where_both_have_faces() {
    let block = "BLO(X=4,Y=4,Z=2)";
    let ball = |x: &str, y: &str, r: &str, z: &str| {
        format!("{block} UN (SPH(R={r}) AT (MOVX={x},MOVY={y},MOVZ={z}+D))")
    };
    let cover = "(BLO(X=1.6,Y=1.6,Z=1.5) AT (MOVX=1.2,MOVY=1.2,MOVZ=1.3))";
    let slot = "(BLO(X=0.1,Y=4,Z=5) AT (MOVX=1.95))";
    let on_top = ball("2", "2", "1", "3");
    #[rustfmt::skip]
    let parts = [
        (on_top.clone(), true),
        // Above the plane of the face, but not above the face.
        (ball("4.8", "4.8", "1.5", "3.5"), false),
        // Covered, subtracted, intersected, cut out.
        (format!("({on_top}) UN {cover}"), false),
        (format!("({on_top}) DIF {cover}"), false),
        (format!("({on_top}) INT {cover}"), true),
        (format!("({on_top}) DIF {slot}"), false),
        // Above the plane 2e-5 beyond the edge, which is 2e-10 farther away.
        (ball("4.00002", "2", "1", "3"), true),
        // The same beyond a corner, and at a sufficient distance.
        (ball("4.00002", "4.00002", "1", "3"), true),
        (ball("4.001", "2", "1", "3"), false),
    ];
    for (pair, is_close) in parts {
        for gap in ["0.000000001", "-0.000000001"] {
            let calls = part(&pair, gap).decisions.close_calls;
            assert_eq!(calls.is_empty(), !is_close, "{pair} at {gap}: {calls:?}");
        }
    }
}

/// The close-call distance, a billionth of the size, is the length of an edge here. A curve at just
/// that distance from a surface over its whole length was halved without end.
#[test]
fn what_runs_along_a_surface_at_the_reach_comes_to_an_end() {
    let far = part(
        "BLO(X=1,Y=1,Z=1) UN BLO(X=1,Y=1,Z=1) AT (MOVX=D)",
        "1000000000",
    );
    assert_eq!(far.brep.topology.solids.len(), 2);
    assert_relative_eq!(far.mass().volume, 2.0, max_relative = 1e-10);
}
