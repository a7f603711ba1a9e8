//! Figures, prisms, revolutions, polyhedra and hulls in `.padl`.

use super::*;
use insta::assert_snapshot;
use proptest::prelude::*;

fn padl(text: &str) -> Tree {
    tree(text, Format::Padl)
}

fn refused(text: &str) -> String {
    message(text, Format::Padl)
}

#[test]
fn simple_figures_make_simple_solids() {
    let same = |swept: &str, simple: &str| {
        let read = |text: &str| padl(&format!("H = 4\nP = {text}"));
        assert_eq!(read(swept), read(simple), "{swept}");
    };
    same("PRI(SQU(X=2, Y=3), H=H)", "BLO(X=2, Y=3, Z=4)");
    same("PRI(SQU(Y=3, X=2), 4)", "BLO(X=2, Y=3, Z=4)");
    same("pri(H=4, FIGURE=squ(2, 3))", "BLO(X=2, Y=3, Z=4)");
    same(
        "PRI(CIR(R=2) AT (MOVX=1, MOVY=-1/3), H)",
        "CYL(R=2, H=4) AT (MOVX=1, MOVY=-1/3)",
    );
    same(
        "PRI(SQU(2, 3) AT (ROTZ=30, MOVX=1), H)",
        "BLO(X=2, Y=3, Z=4) AT (ROTZ=30, MOVX=1)",
    );
    same("PRI(CIR(R=2), H, TOP=1/2)", "CON(R=2, H=4, R2=1)");
    same("PRI(CIR(R=2), H, TOP=0)", "CON(R=2, H=4)");
    same(
        "REV(CIR(R=1) AT (MOVX=3, MOVY=5))",
        "TOR(RMAJ=3, RMIN=1) AT (MOVZ=5)",
    );
    same(
        "REV(CIR(R=1) AT (MOVX=3), ANGLE=360)",
        "TOR(RMAJ=3, RMIN=1)",
    );
}

#[test]
fn operations_of_the_plane_are_those_of_the_prisms() {
    let flat = "A = SQU(X=9, Y=9)\nB = CIR(R=2)\nC = CIR(R=3) AT (MOVX=9)\n";
    let high = "A = BLO(X=9, Y=9, Z=2)\nB = CYL(R=2, H=2)\nC = CYL(R=3, H=2) AT (MOVX=9)\n";
    for (plane, space) in [
        ("A DIF B UN C", "A DIF B UN C"),
        ("(A DIF B) DIF C", "A DIF B DIF C"),
        ("A INT (B UN C)", "A INT (B UN C)"),
        (
            "A DIF FOR i=1..3: B AT (MOVX=3*i)",
            "A DIF FOR i=1..3: B AT (MOVX=3*i)",
        ),
        ("FOR i=1..3: B AT (MOVX=3*i)", "FOR i=1..3: B AT (MOVX=3*i)"),
        ("A DIF FOR i=1..0: B", "A"),
        ("(FOR i=1..0: B) UN A", "A"),
    ] {
        let prism = padl(&format!("{flat}P = PRI({plane}, H=2)"));
        let solid = padl(&format!("{high}P = {space}"));
        assert_same_points(&prism, |p| inside(&solid, p));
    }
    // An empty figure makes an empty solid.
    let empty = "P = SPH(R=1) UN PRI(CIR(R=1) INT FOR i=1..0: CIR(R=2), H=1)";
    assert!(read_text(empty, Format::Padl).is_ok());
    assert!(padl("P = PRI(OFF(CIR(R=1), R=-2), H=1)").is_empty());
    assert!(padl("P = REV(FOR i=1..0: CIR(R=2))").is_empty());
}

#[test]
fn outlines_are_those_of_json() {
    let figure = "[[[0,0],[4,0],[4,3]],[[3,1],[3.5,1],[3.5,1.5]]]";
    let polygon = "PGN((0, 0), (4, 0), (4, 3); (3, 1), (3.5, 1), (7/2, 1.5))";
    let arcs = "[[[1,0,0,0,1],[0,1],[-3,1]]]";
    let rounded = "PGN((1, 0, 0, 0, 1), (0, 1), (-3, 1))";
    let json = |text: &str| tree(text, Format::Json);
    assert_eq!(
        padl(&format!("P = PRI({polygon}, H=2)")),
        json(&format!(r#"{{"prim":"prism","figure":{figure},"h":2}}"#)),
    );
    assert_eq!(
        padl(&format!("P = PRI({polygon}, H=2, TOP=0.5)")),
        json(&format!(
            r#"{{"prim":"prism","figure":{figure},"h":2,"top":0.5}}"#
        )),
    );
    assert_eq!(
        padl(&format!("P = PRI({rounded}, H=2)")),
        json(&format!(r#"{{"prim":"prism","figure":{arcs},"h":2}}"#)),
    );
    assert_eq!(
        padl(&format!("P = REV({polygon}, ANGLE=75)")),
        json(&format!(
            r#"{{"prim":"revolution","figure":{figure},"angle":75}}"#
        )),
    );
    assert_eq!(
        padl("P = POLY((0,0,0), (1,0,0), (0,1,0), (0,0,1); (0,2,1), (0,1,3), (1,2,3), (2,0,3))"),
        json(
            r#"{"prim":"polyhedron","points":[[0,0,0],[1,0,0],[0,1,0],[0,0,1]],
            "faces":[[0,2,1],[0,1,3],[1,2,3],[2,0,3]]}"#
        ),
    );
}

/// A square ring: its top and its bottom have a hole.
#[test]
fn faces_of_polyhedra_have_holes_after_semicolons() {
    let ring = padl(
        "T = 1
         P = POLY((-4,-4,0), (4,-4,0), (4,4,0), (-4,4,0), (-4,-4,T), (4,-4,T), (4,4,T), (-4,4,T),
           (-2,-2,0), (2,-2,0), (2,2,0), (-2,2,0), (-2,-2,T), (2,-2,T), (2,2,T), (-2,2,T);
           (3,2,1,0; 8,9,10,11), (4,5,6,7; 15,14,13,12),
           (0,1,5,4), (1,2,6,5), (2,3,7,6), (3,0,4,7),
           (12,13,9,8), (13,14,10,9), (14,15,11,10), (15,12,8,11))",
    );
    assert_same_points(&ring, |[x, y, z]| {
        let square = |r: f64| x.abs() < r && y.abs() < r;
        square(4.0) && !square(2.0) && (0.0..1.0).contains(&z)
    });
}

#[test]
fn loops_make_points() {
    let star = "PGN(FOR i=0..4: (4*cos(72*i), 4*sin(72*i)), FOR i=0..1: FOR j=1..2: (i/j, 9))";
    let listed = "PGN((4*cos(0), 4*sin(0)), (4*cos(72), 4*sin(72)), (4*cos(144), 4*sin(144)),
        (4*cos(216), 4*sin(216)), (4*cos(288), 4*sin(288)), (0, 9), (0/2, 9), (1, 9), (1/2, 9))";
    let prism = |figure: &str| padl(&format!("P = PRI({figure}, H=1)"));
    assert_eq!(prism(star), prism(listed));
    // Of a part with parameters, too.
    let text = "
        GEAR(N, R, D=1) = PGN(FOR i=0..N-1:
            ((R + D*(i - 2*FLOOR2(i)))*cos(360/N*i), (R + D*(i - 2*FLOOR2(i)))*sin(360/N*i)))
        P = PRI(GEAR(N=4, R=3), H=1)";
    let flat = text.replace("FLOOR2(i)", "0");
    let named = "P = PRI(PGN((3,0), (0,4), (-5,0), (0,-6)), H=1)";
    assert_eq!(padl(&flat), padl(named));
}

#[test]
fn hulls_and_offsets_are_those_of_openscad() {
    let csg = |text: &str| tree(text, Format::Csg);
    assert_eq!(
        padl("P = PRI(OFF(SQU(4, 2), R=1), H=2)"),
        csg("linear_extrude(height=2) offset(r=1, $fn=0) square(size=[4,2]);"),
    );
    assert_eq!(
        padl("P = PRI(OFF(PGN((0,0), (4,0), (0,3)), DELTA=0.5), H=2)"),
        csg("linear_extrude(height=2) offset(delta=0.5) polygon(points=[[0,0],[4,0],[0,3]]);"),
    );
    assert_eq!(
        padl("P = PRI(OFF(PGN((0,0), (4,0), (0,3)), CHAMFER=1/2), H=2)"),
        csg("linear_extrude(height=2) offset(delta=0.5, chamfer=true) \
             polygon(points=[[0,0],[4,0],[0,3]]);"),
    );
    let link = "linear_extrude(height=2) hull() { circle(r=2, $fn=0); \
                multmatrix([[1,0,0,6],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) circle(r=1, $fn=0); }";
    assert_eq!(
        padl("A = CIR(R=2)\nP = PRI(HULL(A, CIR(R=1) AT (MOVX=6)), 2)"),
        csg(link)
    );
    assert_eq!(
        padl("P = PRI(HULL(CIR(R=2) UN CIR(R=1) AT (MOVX=6)), 2)"),
        csg(link)
    );
    let capsule = csg("hull() { sphere(r=2, $fn=0); \
         multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,5],[0,0,0,1]]) sphere(r=2, $fn=0); }");
    let hull = padl("P = HULL(FOR i=0..1: SPH(R=2) AT (MOVZ=5*i))");
    assert_same_points(&hull, |p| inside(&capsule, p));
}

#[test]
fn a_name_of_the_file_takes_the_place_of_a_word() {
    assert_eq!(
        padl("HULL = SPH(R=1)\nREV = HULL AT (MOVX=3)\nPRI(R) = SPH(R=R)\nP = REV UN PRI(2)"),
        padl("P = SPH(R=1) AT (MOVX=3) UN SPH(R=2)"),
    );
}

#[test]
fn wrong_figures() {
    assert_snapshot!(refused("P = PRI(SPH(R=1), H=2)"), @"part:1:9: found a solid, expected a figure for `PRI`");
    assert_snapshot!(refused("P = PRI(CIR(R=1))"), @"part:1:17: found `)`, expected the argument `H` of `PRI`");
    assert_snapshot!(refused("P = PRI(CIR(R=1), H=2, 3)"), @"part:1:24: found an argument without a name after one with a name, expected an argument of `PRI`, one of `FIGURE`, `H`, `TOP`");
    assert_snapshot!(refused("P = PRI(CIR(R=1), 2, 3, 4)"), @"part:1:25: found one argument too many, expected an argument of `PRI`, one of `FIGURE`, `H`, `TOP`");
    assert_snapshot!(refused("P = PRI(CIR(R=1), H=-2)"), @"part:1:22: found the value -2, expected a height greater than zero");
    assert_snapshot!(refused("P = PRI(CIR(R=1) AT (MOVZ=1), H=2)"), @"part:1:27: found `MOVZ` for a figure, expected a motion in the plane, one of `MOVX`, `MOVY`, `ROTZ`");
    assert_snapshot!(refused("P = CIR(R=1) UN SPH(R=2)"), @"part:1:17: found a solid, expected a figure after `UN`");
    assert_snapshot!(refused("P = SPH(R=2) DIF FOR i=1..2: CIR(R=1)"), @"part:1:5: found a solid, expected a figure before `FOR` (`i` is 1)");
    assert_snapshot!(refused("P = CIR(R=1)"), @"part:1:13: found no solid in the file, expected a line such as `PART = BLO(X=1, Y=1, Z=1)`");
    assert_snapshot!(refused("P = CIR(R=0)"), @"part:1:11: found the value 0, expected a radius greater than zero");
    assert_snapshot!(refused("P = PRI(OFF(CIR(R=1)), H=2)"), @"part:1:9: found an offset without one distance, expected one of `R`, `DELTA` and `CHAMFER`");
    assert_snapshot!(refused("P = PRI(OFF(CIR(R=1), R=1, DELTA=2), H=2)"), @"part:1:9: found an offset without one distance, expected one of `R`, `DELTA` and `CHAMFER`");
    assert_snapshot!(refused("P = PRI(PGN(), H=2)"), @"part:1:13: found `)`, expected a tuple such as `(1, 2)`, or `FOR`");
    assert_snapshot!(refused("P = PRI(PGN((0,0), 3), H=2)"), @"part:1:20: found `3`, expected a tuple such as `(1, 2)`, or `FOR`");
    assert_snapshot!(refused("P = PRI(PGN((0,0), (1,2,3), (4,5)), H=2)"), @"part:1:20: found a tuple of 3 numbers, expected a corner `(x, y)`, or `(x, y, cx, cy, r)` where an arc begins");
    assert_snapshot!(refused("P = PRI(PGN((0,0), (1;2), (4,5)), H=2)"), @"part:1:20: found a tuple with semicolons, expected a corner `(x, y)`, or `(x, y, cx, cy, r)` where an arc begins");
    assert_snapshot!(refused("P = PRI(PGN((0,0), (1,0), (2,0)), H=2)"), @"part:1:9: found a figure without area, expected a figure of segments and arcs");
    assert_snapshot!(refused("P = PRI(PGN((0,0), (1,0) UN (2,0)), H=2)"), @"part:1:29: found a tuple of 2 numbers, expected a solid after `UN`");
    assert_snapshot!(refused("P = PRI(PGN((0,0), (SPH(R=1),0)), H=2)"), @"part:1:21: found a solid, expected a number of a tuple");
    assert_snapshot!(refused("P = PRI(PGN((0,0), (1,0"), @"part:1:24: found the end of the file, expected an operator or a closing `)` (the bracket opened on line 1 is not closed)");
    assert_snapshot!(refused("P = REV(CIR(R=1))"), @"part:1:9: found a figure that crosses the axis, expected a figure on one side of the axis");
    assert_snapshot!(refused("P = REV(CIR(R=1) AT (MOVX=2), ANGLE=400)"), @"part:1:37: found the value 400, expected an angle greater than 0, and at most 360 degrees");
    assert_snapshot!(refused("P = HULL()"), @"part:1:10: found `)`, expected a solid or a figure for `HULL`");
    assert_snapshot!(refused("P = HULL(SPH(R=1), CIR(R=2))"), @"part:1:10: found a solid, expected a figure for `HULL`, as another operand is one");
    assert_snapshot!(refused("P = HULL(BLO(X=1, Y=1, Z=1), TOR(RMAJ=3, RMIN=1))"), @"part:1:5: found a hull with faces that are on no plane, cylinder, cone, sphere or torus, expected shapes with plane faces, balls of one radius, shapes about one axis, or cylinders, cones and prisms with parallel axes");
    assert_snapshot!(refused("P = POLY((0,0,0), (1,0,0))"), @"part:1:5: found points without faces, expected points, `;` and faces");
    assert_snapshot!(refused("P = POLY((0,0,0), (1,0,0), (0,1,0); (0,1,3))"), @"part:1:42: found the number 3, expected the index of a point, from 0 to 2");
    assert_snapshot!(refused("P = POLY((0,0,0), (1,0,0), (0,1,0); (0,1,2))"), @"part:1:5: found an invalid polyhedron (the edge from point 0 to point 1 has no face on its other side), expected closed faces around a solid");
    assert_snapshot!(refused("F = CIR(R=1)\nP = F + 1"), @"part:2:5: found a figure, expected a number before `+`");
    assert_snapshot!(refused("P = PIR(CIR(R=1), H=2)"), @"part:1:5: found the unknown name `PIR`, expected a name set on an earlier line (did you mean `pi`?)");
}

/// Figures that double with every line are refused before the memory is full.
#[test]
fn copies_of_figures_are_counted() {
    let mut text = "F0 = CIR(R=1)\n".to_owned();
    for level in 1..60 {
        text += &format!("F{level} = F{0} UN F{0} AT (MOVX={level})\n", level - 1);
    }
    text += "P = PRI(F59, H=1)\n";
    assert_snapshot!(refused(&text), @"part:20:7: found edges of figures beyond the limit, expected at most 2000000, each counted as often as it is used");
    let text = "F = PGN(FOR i=0..9999: (i, i*i))\nP = FOR i=1..1000: PRI(F, H=i)\n";
    assert_snapshot!(refused(text), @"part:2:20: found edges of figures beyond the limit, expected at most 2000000, each counted as often as it is used (`i` is 200)");
    let text = "P = PRI(PGN(FOR i=1..1000: FOR j=1..10000: (i, j)), H=1)";
    assert_snapshot!(refused(text), @"part:1:13: found an expansion beyond the limit, expected at most 10000000 numbers and operations in all `FOR` and parts with parameters (`j` is 9841, `i` is 200)");
}

proptest! {
    /// Random words and brackets are read or refused, without a panic.
    #[test]
    fn random_words_of_figures_do_not_panic(words in prop::collection::vec(0..WORDS.len(), 0..24)) {
        let words: Vec<&str> = words.into_iter().map(|k| WORDS[k]).collect();
        let _ = read_text(&format!("F = CIR(R=1)\nP = {}", words.join(" ")), Format::Padl);
    }
}

const WORDS: [&str; 24] = [
    "PGN(",
    "POLY(",
    "PRI(",
    "REV(",
    "HULL(",
    "OFF(",
    "SQU(",
    "CIR(R=1)",
    "(",
    ")",
    ")",
    ",",
    ";",
    "1",
    "2",
    "F",
    "UN",
    "DIF",
    "AT (MOVX=1)",
    "FOR i=0..2:",
    "i",
    "SPH(R=1)",
    "H=2",
    "-",
];
