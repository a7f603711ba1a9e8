//! Tests of the writers: written text is read as the same tree.

use crate::common::tree;
use insta::assert_snapshot;
use premio_csg::builder::Builder;
use premio_csg::primitive::Primitive;
use premio_csg::reader::{Format, Program, ReadOptions, parse};
use premio_csg::transform::{Transform, TransformStep};
use premio_csg::tree::{Operation, Tree};
use premio_csg::writer::write;
use premio_kernel::number::rational::{Rational, whole};

fn parsed(text: &str, format: Format) -> Program {
    parse("part", text.as_bytes(), format, &ReadOptions::default()).unwrap()
}

fn written(text: &str, from: Format, to: Format) -> String {
    let source = parsed(text, from);
    write(&source.builder, source.part, to).unwrap()
}

/// Asserts that a text written in another language, and written there again, gives the same tree.
fn assert_same(text: &str, from: Format, to: Format) {
    let other = written(text, from, to);
    let original = tree(text, from);
    assert!(tree(&other, to) == original, "{text}\n{other}");
    let back = written(&other, to, from);
    assert!(tree(&back, from) == original, "{text}\n{other}\n{back}");
}

const PADL: &str = "L = 60
BASE = BLO(X=L, Y=40, Z=20/3)
BORE = CYL(R=8, H=30) AT (MOVX=L/4, MOVY=20, MOVZ=-5, ROTX=12.5)
TWO = BORE UN BORE AT (MOVX=30, ROTZ=-31.7)
RING = TOR(RMAJ=9, RMIN=1e-3) AT (ROTY=90)
PART = (BASE DIF TWO DIF TWO AT (ROTZ=180)) UN (RING INT WED(X=1, Y=2, Z=3)) AT (ROTX=7, ROTZ=8)
";

const PLAIN: &str = "PART = (BLO(X=1, Y=2, Z=3) AT (ROTX=30, MOVX=1.5, ROTZ=-90)
 DIF CON(R=2, H=1) AT (MOVZ=-1) UN CON(R=1, H=1, R2=0.5) INT SPH(R=2) AT (ROTY=-12.25, MOVY=3)) AT (ROTZ=45)
";

#[test]
fn padl_and_json_hold_the_same() {
    assert_same(PLAIN, Format::Padl, Format::Json);
    assert_same(PADL, Format::Padl, Format::Padl);
    // Two thirds have no finite decimal.
    let json = written(PADL, Format::Padl, Format::Json);
    assert!(tree(&json, Format::Json) != tree(PADL, Format::Padl));
    let halves = PADL.replace("20/3", "20/8");
    assert_same(&halves, Format::Padl, Format::Json);
}

#[test]
fn csg_holds_quarters_of_degrees() {
    assert_same(PLAIN, Format::Padl, Format::Csg);
    assert_same(PLAIN, Format::Padl, Format::Csg);
}

const FIGURES: &str =
    "WALL = PGN((-4, -3), (4, -3, 4, 0, 3), (4, 3), (-4, 3); (1, 0, 0, 0, 1), (-1, 0, 0, 0, 1))
CUP = REV(PGN((0, 0), (3, 0), (4, 5), (3, 1), (0, 1)), ANGLE=75.5)
TENT = POLY((0,0,0), (1,0,0), (0,1,0), (0,0,1); (0,2,1), (0,1,3), (1,2,3), (2,0,3))
PART = (PRI(WALL, H=2.5) UN PRI(PGN((0,0), (4,1), (1,4)), H=2, TOP=0.25) AT (MOVX=9, ROTX=30)
 DIF CUP AT (ROTY=15) INT TENT)
";

#[test]
fn elliptic_solids_are_held() {
    let text = "PART = (OBL((4, 0, 0), (1, 3, 0), (0.5, 1, 6, 0.25)) DIF OBL((1, 0, 0), (0, 2, 0), (0, 1, 6))
 UN ELL((4, 0, 0), (1, 3, 0), (0.5, -1, 2)) AT (ROTX=30, MOVX=1))";
    assert_same(text, Format::Padl, Format::Json);
    assert_same(text, Format::Padl, Format::Padl);
    // OpenSCAD has motions as matrices, so the axes are moved ones.
    let text =
        "PART = ELL((4, 0, 0), (1, 3, 0), (0.5, -1, 2)) UN OBL((1, 0, 0), (0, 2, 0), (0, 1, 6))";
    assert_same(text, Format::Padl, Format::Csg);
}

#[test]
fn figures_and_polyhedra_are_held() {
    assert_same(FIGURES, Format::Padl, Format::Json);
    assert_same(FIGURES, Format::Padl, Format::Padl);
    // A cup that is mirrored starts where it ended.
    let mirror = "multmatrix([[1,0,0,0],[0,-1,0,0],[0,0,1,0],[0,0,0,1]])";
    let cup = "rotate_extrude(angle=75.5) polygon(points=[[1,0],[3,0],[2,2]]);";
    assert_same(&format!("{mirror} {cup}"), Format::Csg, Format::Padl);
    assert_snapshot!(written(FIGURES, Format::Padl, Format::Padl), @"
    PART = (
      (
        (
          PRI(PGN((-4, -3), (4, -3, 4, 0, 3), (4, 3), (-4, 3); (1, 0, 0, 0, -1), (-1, 0, 0, 0, -1)), H=2.5)
          UN PRI(PGN((0, 0), (4, 1), (1, 4)), H=2, TOP=0.25) AT (MOVX=9, ROTX=30)
        )
        DIF REV(PGN((0, 0), (3, 0), (4, 5), (3, 1), (0, 1)), ANGLE=75.5) AT (ROTY=15)
      )
      INT POLY((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1); (0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
    )
    ");
}

#[test]
fn a_part_used_twice_has_a_name() {
    assert_snapshot!(written(PADL, Format::Padl, Format::Padl), @"
    P1 = (
      CYL(R=8, H=30) AT (MOVX=15, MOVY=20, MOVZ=-5, ROTX=12.5)
      UN CYL(R=8, H=30) AT (MOVX=15, MOVY=20, MOVZ=-5, ROTX=12.5, MOVX=30, ROTZ=-31.7)
    )
    PART = (
      (
        BLO(X=60, Y=40, Z=20/3)
        DIF P1
        DIF P1 AT (ROTZ=180)
      )
      UN (
        TOR(RMAJ=9, RMIN=0.001) AT (ROTY=90)
        INT WED(X=1, Y=2, Z=3)
      ) AT (ROTX=7, ROTZ=8)
    )
    ");
}

#[test]
fn languages() {
    assert_snapshot!(written(PLAIN, Format::Padl, Format::Json), @r#"
    {"op":"intersection","children":[
      {"op":"union","children":[
        {"op":"difference","children":[
          {"prim":"block","size":[1,2,3],"transform":[{"rotate":[[1,0,0],30]},{"translate":[1.5,0,0]},{"rotate":[[0,0,1],-90]}]},
          {"prim":"cone","r":2,"h":1,"transform":[{"translate":[0,0,-1]}]}
        ]},
        {"prim":"frustum","r1":1,"r2":0.5,"h":1}
      ]},
      {"prim":"sphere","r":2,"transform":[{"rotate":[[0,1,0],-12.25]},{"translate":[0,3,0]}]}
    ],"transform":[{"rotate":[[0,0,1],45]}]}
    "#);
    assert_snapshot!(written(PLAIN, Format::Padl, Format::Csg), @"
    multmatrix([[0.7071067811865476, -0.7071067811865475, 0, 0], [0.7071067811865475, 0.7071067811865476, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { intersection() {
      union() {
        difference() {
          multmatrix([[0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { multmatrix([[1, 0, 0, 1.5], [0, 0.8660254037844387, -0.5, 0], [0, 0.5, 0.8660254037844387, 0], [0, 0, 0, 1]]) { cube(size = [1, 2, 3], center = false); } }
          multmatrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -1], [0, 0, 0, 1]]) { cylinder($fn = 0, $fa = 12, $fs = 2, h = 1, r1 = 2, r2 = 0, center = false); }
        }
        cylinder($fn = 0, $fa = 12, $fs = 2, h = 1, r1 = 1, r2 = 0.5, center = false);
      }
      multmatrix([[0.9772311064626789, 0, -0.21217767215644626, 0], [0, 1, 0, 3], [0.21217767215644626, 0, 0.9772311064626789, 0], [0, 0, 0, 1]]) { sphere($fn = 0, $fa = 12, $fs = 2, r = 2); }
    } }
    ");
}

#[test]
fn mirrors_and_scales_are_written_at_the_primitives() {
    let mut b = Builder::new();
    let block = Primitive::block([2, 3, 4].map(Rational::from)).unwrap();
    let shift = |by: [i32; 3]| {
        let mut moves = Transform::new();
        moves
            .push(TransformStep::Shift(by.map(Rational::from)))
            .unwrap();
        moves
    };
    let mut moves = shift([1, 10, 1]);
    let turn = TransformStep::Turn {
        axis: [1, 0, 0].map(Rational::from),
        degrees: 30.into(),
    };
    moves.push(turn).unwrap();
    let part = b.primitive(block);
    let part = b.moved(part, moves);
    let part = b.scaled(part, Rational::from(2));
    let part = b.mirrored_y(part);
    let part = b.moved(part, shift([0, 0, 7]));
    let both = b.operation(Operation::Union, &[part, part]);
    let expected = b.finish(both).unwrap();
    for format in [Format::Padl, Format::Csg, Format::Json] {
        let text = write(&b, both, format).unwrap();
        assert!(tree(&text, format) == expected, "{text}");
    }
    assert_snapshot!(write(&b, part, Format::Padl).unwrap(), @"PART = BLO(X=4, Y=6, Z=8) AT (MOVX=2, MOVY=-26, MOVZ=2, ROTX=-30, MOVZ=7)");
}

#[test]
fn any_turn_is_held_by_json() {
    let text = r#"{"prim":"block","size":[1,2,3],"transform":[
        {"quaternion":[3,-1,0.25,7]},{"translate":[1,2,3]},{"rotate":[[1,2,3],17.5]}]}"#;
    assert_same(text, Format::Json, Format::Json);
    assert_snapshot!(written(text, Format::Json, Format::Json), @r#"{"prim":"block","size":[1,2,3],"transform":[{"quaternion":[12,-4,1,28]},{"translate":[1,2,3]},{"rotate":[[1,2,3],17.5]}]}"#);
    // Rotations about other axes are written by their nearest angles.
    let padl = written(text, Format::Json, Format::Padl);
    let (near, exact) = (tree(&padl, Format::Padl), tree(text, Format::Json));
    let matrix = |tree: &Tree| tree.leaves().next().unwrap().1.motion.rotation_f64();
    assert!((matrix(&near) - matrix(&exact)).amax() < 1e-15, "{padl}");
}

/// Rotations by more than 90 degrees about y are given by the other angles.
#[test]
fn turns_beyond_a_right_angle_are_found_again() {
    let padl = "PART = BLO(X=1, Y=2, Z=3) AT (ROTX=93.21, ROTY=184.059, ROTZ=145.776)";
    let json = with_quaternion(padl);
    let known = tree(padl, Format::Padl);
    assert!(tree(&json, Format::Json) == known);
    let written = written(&json, Format::Json, Format::Padl);
    assert_eq!(written.matches("ROT").count(), 3, "{written}");
    assert!(tree(&written, Format::Padl) == known, "{written}");
}

#[test]
fn turns_by_decimals_about_three_axes_are_found_again() {
    let text = "P = BLO(X=1, Y=2, Z=3) AT (ROTX=12.5, ROTY=-3.75, ROTZ=100.125)";
    let json = with_quaternion(text);
    assert!(tree(&json, Format::Json) == tree(text, Format::Padl));
    let padl = written(&json, Format::Json, Format::Padl);
    assert!(
        padl.contains("ROTX=12.5, ROTY=-3.75, ROTZ=100.125"),
        "{padl}"
    );
}

/// The block of 1 by 2 by 3 of a text, with its rotation as a quaternion of integers.
fn with_quaternion(text: &str) -> String {
    let tree = tree(text, Format::Padl);
    let (_, placed) = tree.leaves().next().unwrap();
    let matrix = placed.motion.rotation_matrix();
    let m = |i: usize, j: usize| matrix[i][j].clone();
    let w = Rational::ONE + m(0, 0) + m(1, 1) + m(2, 2);
    let all = [w, m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)];
    let [w, x, y, z] = whole(&all);
    format!(r#"{{"prim":"block","size":[1,2,3],"transform":[{{"quaternion":[{w},{x},{y},{z}]}}]}}"#)
}
