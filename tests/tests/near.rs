//! Pairs that touch exactly, and the same a little apart or into one another: what is nearer than a
//! close call is listed on either side, and nothing else is.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use premio_csg::boundary::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, Options, read};
use premio_kernel::brep::check::check;
use premio_tests::random::tree;

/// A pair in PADL, `D` apart, and the number of its solids where it is apart, touches, overlaps.
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

/// The pair, apart by the given text.
fn part(pair: &str, gap: &str) -> Evaluation {
    let text = format!("D = {gap}\nP = {pair}\n");
    let tree = read("part", text.as_bytes(), Format::Padl, &Options::default());
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
            for defect in check(&part.brep, part.resolution) {
                wrong.push(format!("{name} at {gap}: {defect:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Random trees in which nothing is near, with what seems to be.
const CLEAR: [(u64, &str); 3] = [
    (22960, "a curve that leaves a plane with the fourth power"),
    (26981, "a curve next to the ruling along which it touches"),
    (27750, "a curve that touches a ruling"),
];

#[test]
fn what_leads_on_to_a_contact_is_no_close_call() {
    for (seed, what) in CLEAR {
        let text = tree(seed).to_string();
        let read = read("tree", text.as_bytes(), Format::Json, &Options::default());
        let part = evaluate(&read.unwrap().tree, &EvaluationOptions::default()).unwrap();
        let calls = &part.decisions.close_calls;
        assert!(calls.is_empty(), "seed {seed}, {what}: {calls:?}");
    }
}
