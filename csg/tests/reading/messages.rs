//! The messages of the readers.

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
    assert_snapshot!(padl("BASE = SPH(R=1)\nP = BASF UN BASE"), @"part:2:5: found the unknown name `BASF`, expected a name set on an earlier line (did you mean `BASE`?)");
    assert_snapshot!(padl("P = Q"), @"part:1:5: found the unknown name `Q`, expected a name set on an earlier line");
    assert_snapshot!(padl("Q = 1\nQ = 2"), @"part:2:1: found `Q`, which is set already, expected a new name (it was set on line 1)");
    assert_snapshot!(padl("cyl = 3"), @"part:1:1: found the keyword `cyl`, expected a name that is not a keyword");
    assert_snapshot!(padl("= 3"), @"part:1:1: found `=`, expected a name to set, as in `NAME = value`");
    assert_snapshot!(padl("A 3"), @"part:1:3: found `3`, expected `=` after the name that is set");
}

#[test]
fn arguments() {
    assert_snapshot!(padl("P = BLO(X=1, Y=2)"), @"part:1:17: found `)`, expected the argument `Z` of `BLO`");
    assert_snapshot!(padl("P = BLO(X=1, Y=2, Q=3)"), @"part:1:19: found the unknown argument `Q`, expected one of `X`, `Y`, `Z`");
    assert_snapshot!(padl("P = BLO(X=1, X=2, Z=3)"), @"part:1:14: found `X` a second time, expected each argument once");
    assert_snapshot!(padl("P = SPH(R=-3/2)"), @"part:1:12: found the value -1.5, expected a radius greater than zero");
    assert_snapshot!(padl("P = TOR(RMAJ=2, RMIN=0)"), @"part:1:22: found the value 0, expected a minor radius greater than zero");
    assert_snapshot!(padl("P = CON(R=0, H=2)"), @"part:1:11: found the value 0, expected one radius greater than zero");
    assert_snapshot!(padl("P = BLO(1, 2, 3)"), @"part:1:9: found `1`, expected an argument, one of `X`, `Y`, `Z`");
    assert_snapshot!(padl("P = SPH R=1"), @"part:1:9: found `R`, expected `(` and the arguments of `SPH`");
    assert_snapshot!(padl("P = SPH(R=1) AT (MOVEX=1)"), @"part:1:18: found the unknown argument `MOVEX`, expected one of `MOVX`, `MOVY`, `MOVZ`, `ROTX`, `ROTY`, `ROTZ` (did you mean `MOVX`?)");
    assert_snapshot!(padl("P = SPH(R=1) AT ()"), @"part:1:18: found `)`, expected a motion, one of `MOVX`, `MOVY`, `MOVZ`, `ROTX`, `ROTY`, `ROTZ`");
}

#[test]
fn expressions() {
    assert_snapshot!(padl("A = 1 +"), @"part:1:8: found the end of the file, expected a number, a name, a primitive or `(`");
    assert_snapshot!(padl("A = 1 / (2 - 2)"), @"part:1:9: found a division by zero, expected a number other than zero");
    assert_snapshot!(padl("A = SPH(R=1)\nB = A + 1"), @"part:2:5: found a solid, expected a number before `+`");
    assert_snapshot!(padl("A = SPH(R=1) UN 2"), @"part:1:17: found the number 2, expected a solid after `UN`");
    assert_snapshot!(padl("P = SPH(R=(1 + 2)"), @"part:1:18: found the end of the file, expected an operator or a closing `)` (the bracket opened on line 1 is not closed)");
    assert_snapshot!(padl("P = (SPH(R=1)\nQ = SPH(R=2)\n"), @"part:2:1: found `Q`, expected an operator or the end of the value (the bracket opened on line 1 is not closed)");
    assert_snapshot!(padl("P = (SPH(R=1)\n"), @"part:2:1: found the end of the file, expected an operator or a closing `)` (the bracket opened on line 1 is not closed)");
    assert_snapshot!(padl("P = 2 AT (MOVX=1)"), @"part:1:5: found the number 2, expected a solid before `AT`");
    assert_snapshot!(padl("P = SPH(R=1) SPH(R=2)"), @"part:1:14: found `SPH`, expected an operator or the end of the value");
    assert_snapshot!(padl("P = 1)"), @"part:1:6: found `)`, expected an operator or the end of the line");
    assert_snapshot!(padl("A = 5X"), @"part:1:6: found `X`, expected an operator or the end of the value");
    assert_snapshot!(padl("A = 1e999"), @"part:1:5: found `1e999`, expected an exponent from -400 to 400");
    assert_snapshot!(padl("A = 1"), @"part:1:6: found no solid in the file, expected a line such as `PART = BLO(X=1, Y=1, Z=1)`");
    assert_snapshot!(padl("A = 1 ? 2"), @"part:1:7: found `?`, expected a name, a number or a symbol of the language");
}

#[test]
fn csg_nodes() {
    assert_snapshot!(csg("roof() { square(1); }"), @"part:1:1: found the node `roof`, expected a node that can be read (it is not a regularised set operation or a rigid motion)");
    assert_snapshot!(csg("offset() { cube(1); }"), @"part:1:12: found `cube` inside `offset`, expected a plane figure");
    assert_snapshot!(csg("offset() { square(1); }"), @"part:1:1: found `offset` without `r`, expected the argument `r`");
    assert_snapshot!(csg("group() { cubee(1); }"), @"part:1:11: found the unknown node `cubee`, expected a node that can be read (did you mean `cube`?)");
    assert_snapshot!(csg("translate([1, 0, 0]) cube(1);"), @"part:1:1: found the node `translate`, expected a node that can be read (this is not flattened: write the file with `openscad -o part.csg part.scad`)");
    assert_snapshot!(csg("cube(size = 1, centre = true);"), @"part:1:16: found the unknown argument `centre` of `cube`, expected one of `size`, `center` (did you mean `center`?)");
    assert_snapshot!(csg("sphere(r = undef);"), @"part:1:12: found `undef`, expected a value for `r`");
    assert_snapshot!(csg("sphere(r = nan);"), @"part:1:12: found a number that is not finite, expected a number");
    assert_snapshot!(csg("sphere();"), @"part:1:1: found `sphere` without `r`, expected the argument `r`");
    assert_snapshot!(csg("group() { cube(1);"), @"part:1:19: found the end of the file, expected `}` (the block opened on line 1 is not closed)");
    assert_snapshot!(csg("cube(1)"), @"part:1:8: found the end of the file, expected `;` after a primitive");
    assert_snapshot!(csg("}"), @"part:1:1: found `}`, expected a node");
    assert_snapshot!(csg("circle(r = 1);"), @"part:1:1: found a plane figure outside an extrusion, expected a solid");
    assert_snapshot!(csg("square(1); cube(1);"), @"part:1:1: found a plane figure outside an extrusion, expected a solid");
    assert_snapshot!(csg("group() { square(1); cube(1); }"), @"part:1:22: found `cube` beside a plane figure, expected a plane figure");
    assert_snapshot!(csg("rotate_extrude() { circle(r = 1); }"), @"part:1:20: found a figure that crosses the axis, expected a figure on one side of the axis");
    assert_snapshot!(csg("rotate_extrude(angle = 0) { circle(r = 1); }"), @"part:1:24: found the value 0, expected an angle other than 0");
    assert_snapshot!(csg("linear_extrude(height = 1, scale = [1, -2]) { square(1); }"), @"part:1:36: found a list, expected a `scale` of zero or more");
    assert_snapshot!(csg("hull() { sphere(r = 1); cube(1); }"), @"part:1:1: found a hull with faces that are on no plane, cylinder, cone, sphere or torus, expected shapes with plane faces, balls of one radius, shapes about one axis, or cylinders, cones and prisms with parallel axes (with `--facets all` circles are read as OpenSCAD's polygons)");
    assert_snapshot!(csg("hull() { difference() { cube(2); sphere(1); } }"), @"part:1:1: found a hull of a difference or an intersection, expected a union of shapes, or shapes with plane faces");
    assert_snapshot!(csg("minkowski() { cylinder(h = 1, r1 = 1, r2 = 2); cube(1); }"), @"part:1:1: found a Minkowski sum of these shapes, expected a ball with any shape, prisms and cylinders of one direction, or shapes with plane faces of which one is convex");
    assert_snapshot!(csg("projection() { intersection() { sphere(1); cube(1); } }"), @"part:1:1: found a shadow of these shapes, expected a result of segments and arcs (with `--facets all` circles are read as OpenSCAD's polygons)");
    assert_snapshot!(csg("polyhedron(points = [[0,0,0],[1,0,0],[0,1,0]], faces = [[0,1,2]]);"), @"part:1:1: found an invalid polyhedron (the edge from point 1 to point 0 has no face on its other side), expected closed faces around a solid");
    assert_snapshot!(csg("polyhedron(points = [[0,0,0],[1,0,0],[0,1,0]], faces = [[0,1,3]]);"), @"part:1:62: found the value 3, expected the index of a point");
}

#[test]
fn csg_matrices() {
    assert_snapshot!(csg("multmatrix([[1,0,0,0],[0,3,0,0],[0,0,1,0],[0,0,0,1]]) { rotate_extrude() { multmatrix([[1,0,0,3],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { circle(1); } } }"), @"part:1:12: found a map that changes the shape of revolutions, expected spheres, cylinders, cones, prisms or plane faces, or a scale equal in all directions (with `--facets all` circles are read as OpenSCAD's polygons)");
    assert_snapshot!(csg("multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,2]]) { cube(1); }"), @"part:1:43: found a list, expected the last row [0, 0, 0, 1] of an affine map");
    assert_snapshot!(csg("multmatrix([[1,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(1); }"), @"part:1:13: found a list of 3, expected a row of four numbers");
}

#[test]
fn json_values() {
    assert_snapshot!(json(r#"{"prim":"sphere","r":-1}"#), @"part:1:22: found the value -1, expected a radius greater than zero");
    assert_snapshot!(json(r#"{"prim":"block","size":[1,0,2]}"#), @"part:1:27: found the value 0, expected a size along y greater than zero");
    assert_snapshot!(json(r#"{"prim":"sphere","radius":1}"#), @"part:1:18: found the unknown key `radius`, expected one of `prim`, `transform`, `r` (did you mean `r`?)");
    assert_snapshot!(json(r#"{"prim":"spere","r":1}"#), @r#"part:1:9: found the text `spere`, expected one of "block", "wedge", "cylinder", "cone", "frustum", "sphere", "torus", "prism", "revolution", "polyhedron", "oblique_frustum", "ellipsoid", "half_space", "infinite_cylinder", "infinite_cone" (did you mean `sphere`?)"#);
    assert_snapshot!(json(r#"{"op":"union"}"#), @"part:1:14: found an object without `children`, expected the key `children`");
    assert_snapshot!(json(r#"{"op":"union","children":{}}"#), @"part:1:26: found an object, expected an array of solids");
    assert_snapshot!(json(r#"{"op":"union","children":[1]}"#), @"part:1:27: found the number `1`, expected a solid: an object with `op` or `prim`");
    assert_snapshot!(json(r#"{"prim":"sphere","op":"union"}"#), @"part:1:2: found `prim`, expected either `op` or `prim`, not both");
    assert_snapshot!(json(r#"{}"#), @"part:1:1: found an object without `op` or `prim`, expected `op` or `prim`");
    assert_snapshot!(json(r#"{"prim":"sphere","r":1,"r":2}"#), @"part:1:24: found the key `r` a second time, expected each key once");
    assert_snapshot!(json(r#"{"prim":"sphere","r":"1"}"#), @"part:1:22: found the text `1`, expected a number");
    assert_snapshot!(json(r#"{"prim":"sphere","r":01}"#), @"part:1:22: found `01`, expected a number as JSON writes it, such as `-0.5` or `1e-3`");
    assert_snapshot!(json(r#"{"prim":"sphere","r":1,"transform":[{"rotate":[[0,0,0],1]}]}"#), @"part:1:48: found an axis of length zero, expected an axis with a direction");
    assert_snapshot!(json(r#"{"prim":"sphere","r":1,"transform":[{"translate":[0,0]}]}"#), @"part:1:50: found an array of another length, expected an array of three numbers");
    assert_snapshot!(json(r#"{"prim":"sphere","r":1"#), @"part:1:23: found the end of the file, expected `,` or `}`");
    assert_snapshot!(json(r#"{"prim":"sphere" "r":1}"#), @r#"part:1:18: found `"r"`, expected `,` or `}`"#);
    assert_snapshot!(json(r#"[1,]"#), @"part:1:4: found `]`, expected a JSON value");
    assert_snapshot!(json(r#"{"prim":"sphere","r":1} x"#), @"part:1:25: found `x`, expected the end of the file");
}
