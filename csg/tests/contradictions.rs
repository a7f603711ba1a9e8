//! Boundaries that contradict a tree.

use crate::common::{evaluated, tree};
use premio_csg::reader::Format;
use premio_csg::tree::Tree;

const PARTS: [[&str; 2]; 4] = [
    ["BLO(X=2, Y=2, Z=2)", "CYL(R=0.5, H=3) AT (MOVX=1, MOVY=1)"],
    ["TOR(RMAJ=2, RMIN=0.5)", "BLO(X=3, Y=3, Z=3)"],
    ["CON(R=1, H=2)", "SPH(R=0.7) AT (MOVZ=0.5, MOVX=0.3)"],
    ["SPH(R=1)", "WED(X=1, Y=1, Z=1)"],
];

const OPERATIONS: [&str; 3] = ["UN", "INT", "DIF"];

#[test]
fn another_operation_on_the_same_primitives_contradicts_a_boundary() {
    for part in PARTS {
        let with = |op: &str| {
            tree(
                &format!("PART = {} {op} {}\n", part[0], part[1]),
                Format::Padl,
            )
        };
        for op in OPERATIONS {
            let known = evaluated(&with(op));
            for other in OPERATIONS {
                let is_found = known.contradiction(&with(other)).unwrap().is_some();
                assert_eq!(is_found, op != other, "{part:?}: {op} for {other}");
            }
        }
    }
}

#[test]
fn an_empty_tree_contradicts_a_boundary() {
    let ball = "PART = SPH(R=1) INT BLO(X=1, Y=1, Z=1)\n";
    let known = evaluated(&tree(ball, Format::Padl));
    assert!(known.contradiction(&Tree::default()).unwrap().is_some());
}
