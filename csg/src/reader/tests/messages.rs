//! What the readers say.

use super::*;
use insta::assert_snapshot;

fn padl(text: &str) -> String {
    message(text, Format::Padl)
}

fn csg(text: &str) -> String {
    message(text, Format::Csg)
}

fn json(text: &str) -> String {
    message(text, Format::Json)
}

#[test]
fn names() {
    assert_snapshot!(padl("BASE = SPH(R=1)\nP = BASF UN BASE"), @"");
    assert_snapshot!(padl("P = Q"), @"");
    assert_snapshot!(padl("Q = 1\nQ = 2"), @"");
    assert_snapshot!(padl("cyl = 3"), @"");
    assert_snapshot!(padl("= 3"), @"");
    assert_snapshot!(padl("A 3"), @"");
}

#[test]
fn arguments() {
    assert_snapshot!(padl("P = BLO(X=1, Y=2)"), @"");
    assert_snapshot!(padl("P = BLO(X=1, Y=2, Q=3)"), @"");
    assert_snapshot!(padl("P = BLO(X=1, X=2, Z=3)"), @"");
    assert_snapshot!(padl("P = SPH(R=-3/2)"), @"");
    assert_snapshot!(padl("P = TOR(RMAJ=2, RMIN=2)"), @"");
    assert_snapshot!(padl("P = CON(R=0, H=2)"), @"");
    assert_snapshot!(padl("P = BLO(1, 2, 3)"), @"");
    assert_snapshot!(padl("P = SPH R=1"), @"");
    assert_snapshot!(padl("P = SPH(R=1) AT (MOVEX=1)"), @"");
    assert_snapshot!(padl("P = SPH(R=1) AT ()"), @"");
}

#[test]
fn expressions() {
    assert_snapshot!(padl("A = 1 +"), @"");
    assert_snapshot!(padl("A = 1 / (2 - 2)"), @"");
    assert_snapshot!(padl("A = SPH(R=1)\nB = A + 1"), @"");
    assert_snapshot!(padl("A = SPH(R=1) UN 2"), @"");
    assert_snapshot!(padl("P = SPH(R=(1 + 2)"), @"");
    assert_snapshot!(padl("P = (SPH(R=1)\n"), @"");
    assert_snapshot!(padl("P = 2 AT (MOVX=1)"), @"");
    assert_snapshot!(padl("P = SPH(R=1) SPH(R=2)"), @"");
    assert_snapshot!(padl("P = 1)"), @"");
    assert_snapshot!(padl("A = 5X"), @"");
    assert_snapshot!(padl("A = 1e999"), @"");
    assert_snapshot!(padl("A = 1"), @"");
    assert_snapshot!(padl("A = 1 ? 2"), @"");
}

#[test]
fn csg_nodes() {
    assert_snapshot!(csg("hull() { cube(1); }"), @"");
    assert_snapshot!(csg("group() { cubee(1); }"), @"");
    assert_snapshot!(csg("translate([1, 0, 0]) cube(1);"), @"");
    assert_snapshot!(csg("cube(size = [1, -2, 3]);"), @"");
    assert_snapshot!(csg("cube(size = 1, centre = true);"), @"");
    assert_snapshot!(csg("sphere($fn = 5, r = 1);"), @"");
    assert_snapshot!(csg("sphere(r = undef);"), @"");
    assert_snapshot!(csg("sphere(r = nan);"), @"");
    assert_snapshot!(csg("sphere();"), @"");
    assert_snapshot!(csg("group() { cube(1);"), @"");
    assert_snapshot!(csg("cube(1)"), @"");
    assert_snapshot!(csg("}"), @"");
    assert_snapshot!(csg("circle(r = 1);"), @"");
    assert_snapshot!(csg("rotate_extrude() { circle(r = 1); }"), @"");
    assert_snapshot!(csg("rotate_extrude(angle = 90) { circle(r = 1); }"), @"");
    assert_snapshot!(csg("linear_extrude(height = 1) { polygon(points = [[0, 0], [1, 0], [1, 2], [0, 1]]); }"), @"");
    assert_snapshot!(csg("linear_extrude(height = 1, twist = 90) { square(1); }"), @"");
}

#[test]
fn csg_matrices() {
    assert_snapshot!(csg("multmatrix([[2,0,0,0],[0,2,0,0],[0,0,2,0],[0,0,0,1]]) { cube(1); }"), @"");
    assert_snapshot!(csg("multmatrix([[1,0,0,0],[0,3,0,0],[0,0,1,0],[0,0,0,1]]) { cube(1); }"), @"");
    assert_snapshot!(csg("multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,2]]) { cube(1); }"), @"");
    assert_snapshot!(csg("multmatrix([[1,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(1); }"), @"");
}

#[test]
fn json_values() {
    assert_snapshot!(json(r#"{"prim":"sphere","r":-1}"#), @"");
    assert_snapshot!(json(r#"{"prim":"block","size":[1,0,2]}"#), @"");
    assert_snapshot!(json(r#"{"prim":"sphere","radius":1}"#), @"");
    assert_snapshot!(json(r#"{"prim":"spere","r":1}"#), @"");
    assert_snapshot!(json(r#"{"op":"union"}"#), @"");
    assert_snapshot!(json(r#"{"op":"union","children":{}}"#), @"");
    assert_snapshot!(json(r#"{"op":"union","children":[1]}"#), @"");
    assert_snapshot!(json(r#"{"prim":"sphere","op":"union"}"#), @"");
    assert_snapshot!(json(r#"{}"#), @"");
    assert_snapshot!(json(r#"{"prim":"sphere","r":1,"r":2}"#), @"");
    assert_snapshot!(json(r#"{"prim":"sphere","r":"1"}"#), @"");
    assert_snapshot!(json(r#"{"prim":"sphere","r":01}"#), @"");
    assert_snapshot!(json(r#"{"prim":"sphere","r":1,"transform":[{"rotate":[[0,0,0],1]}]}"#), @"");
    assert_snapshot!(json(r#"{"prim":"sphere","r":1,"transform":[{"translate":[0,0]}]}"#), @"");
    assert_snapshot!(json(r#"{"prim":"sphere","r":1"#), @"");
    assert_snapshot!(json(r#"{"prim":"sphere" "r":1}"#), @"");
    assert_snapshot!(json(r#"[1,]"#), @"");
    assert_snapshot!(json(r#"{"prim":"sphere","r":1} x"#), @"");
}
