//! Tests of BRL-CAD's database as text.

use super::*;
use insta::assert_snapshot;

fn asc(text: &str) -> String {
    message(text, Format::Asc)
}

/// The only primitive of a solid, and its position.
fn solid(put: &str) -> PlacedPrimitive {
    let tree = tree(&format!("put {{s}} {put}\n"), Format::Asc);
    let (_, placed) = tree.leaves().next().unwrap();
    placed.clone()
}

fn n<const N: usize>(values: [i32; N]) -> [Rational; N] {
    values.map(Rational::from)
}

#[test]
fn round_solids() {
    let ball = solid("ell V {1 2 3} A {0 4 0} B {-4 0 0} C {0 0 4}");
    assert_eq!(ball.primitive, Primitive::sphere(4.into()).unwrap());
    assert_eq!(ball.motion.offset(), &n([1, 2, 3]));
    let egg = solid("ell V {1 2 3} A {0 4 0} B {-2 0 0} C {0 1 4}");
    let radii = [[0, 4, 0], [-2, 0, 0], [0, 1, 4]].map(n);
    assert_eq!(egg.primitive, Primitive::ellipsoid(radii).unwrap());
    assert_eq!(egg.motion.offset(), &n([1, 2, 3]));
    let rod = solid("tgc V {1 0 0} H {-10 0 0} A {0 3 0} B {0 0 3} C {0 3 0} D {0 0 3}");
    assert_eq!(
        rod.primitive,
        Primitive::cylinder(3.into(), 10.into()).unwrap()
    );
    assert_eq!(rod.motion.apply_point(&n([0, 0, 10])), n([-9, 0, 0]));
    let cone = solid("tgc V {0 0 0} H {0 3 4} A {2 0 0} B {0 1.6 -1.2} C {1 0 0} D {0 0.8 -.6}");
    let frustum = Primitive::frustum(2.into(), 1.into(), 5.into()).unwrap();
    assert_eq!(cone.primitive, frustum);
    assert_eq!(cone.motion.apply_point(&n([0, 0, 5])), n([0, 3, 4]));
    let ring = solid("tor V {0 0 5} H {0 1 0} r_a 7 r_h 2");
    assert_eq!(
        ring.primitive,
        Primitive::torus(7.into(), 2.into()).unwrap()
    );
    assert_eq!(ring.motion.apply_vector(&n([0, 0, 1])), n([0, 1, 0]));
}

#[test]
fn half_spaces() {
    let text = "put {h} half N {0 0.6 0.8} d 5\nput {s} ell V {0 0 0} A {7 0 0} B {0 7 0} C {0 0 7}
        put {c} comb region yes tree {n {l s} {l h}}\n";
    assert_same_points(&tree(text, Format::Asc), |[x, y, z]| {
        x * x + y * y + z * z < 49.0 && 0.6 * y + 0.8 * z < 5.0
    });
}

/// Whether a solid of eight corners contains exactly the points of a given test.
fn check(corners: [[i32; 3]; 8], inside: impl Fn([f64; 3]) -> bool) {
    let names = (1..=8).zip(corners);
    let vectors = names.map(|(k, [x, y, z])| format!("V{k} {{{x} {y} {z}}}"));
    let put = format!("put s arb8 {}\n", vectors.collect::<Vec<_>>().join(" "));
    assert_same_points(&tree(&put, Format::Asc), inside);
}

#[test]
fn blocks() {
    let low = [[1, 2, 3], [5, 2, 3], [5, 5, 3], [1, 5, 3]];
    let high = low.map(|[x, y, _]| [x, y, 4]);
    let within = |v: f64, least: f64, greatest: f64| v > least && v < greatest;
    let inside = |[x, y, z]: [f64; 3]| within(x, 1., 5.) && within(y, 2., 5.) && within(z, 3., 4.);
    check([low, high].concat().try_into().unwrap(), inside);
    // In the opposite order.
    check([high, low].concat().try_into().unwrap(), inside);
    let turned = [[0, 0, 0], [4, 3, 0], [1, 7, 0], [-3, 4, 0]];
    let high = turned.map(|[x, y, _]| [x, y, 2]);
    check([turned, high].concat().try_into().unwrap(), |[x, y, z]| {
        let (u, v) = (0.8 * x + 0.6 * y, -0.6 * x + 0.8 * y);
        within(u, 0., 5.) && within(v, 0., 5.) && within(z, 0., 2.)
    });
}

#[test]
fn wedges() {
    // A base of four corners, and an edge above its near side.
    let base = [[0, 0, 0], [6, 0, 0], [6, 4, 0], [0, 4, 0]];
    let edge = [[0, 0, 3], [6, 0, 3], [6, 0, 3], [0, 0, 3]];
    let inside = |[x, y, z]: [f64; 3]| x > 0. && x < 6. && y > 0. && z > 0. && y / 4. + z / 3. < 1.;
    check([base, edge].concat().try_into().unwrap(), inside);
    // The same as two triangles.
    let near = [[0, 0, 0], [0, 4, 0], [0, 0, 3], [0, 0, 3]];
    let far = near.map(|[_, y, z]| [6, y, z]);
    check([near, far].concat().try_into().unwrap(), inside);
    check([far, near].concat().try_into().unwrap(), inside);
}

#[test]
fn combinations() {
    let text = "title {A title; with {braces}}
units mm
attr set {_GLOBAL} regionid_colortable {}
# A comment
put {big ball} ell V {0 0 0} A {5 0 0} B {0 5 0} C {0 0 5}
put rod tgc V {0 0 -9} H {0 0 18} A {2 0 0} B {0 2 0} C {2 0 0} D {0 2 0}
put {bored.r} comb region yes tree {- {l {big ball}} \\
   {l rod {1 0 0 1  0 1 0 0  0 0 1 0  0 0 0 1}}}; put lens comb tree {n {l bored.r} {l bored.r {1 0 0 0 0 1 0 3 0 0 1 0 0 0 0 1}}}
put top comb region no tree {^ {l lens} {l rod}}
";
    let ball = |[x, y, z]: [f64; 3]| x * x + y * y + z * z < 25.0;
    let rod = |[x, y, z]: [f64; 3]| x * x + y * y < 4.0 && z.abs() < 9.0;
    let bored = |p: [f64; 3]| ball(p) && !rod([p[0] - 1.0, p[1], p[2]]);
    let lens = |p: [f64; 3]| bored(p) && bored([p[0], p[1] - 3.0, p[2]]);
    assert_same_points(&tree(text, Format::Asc), |p| lens(p) != rod(p));
    let options = ReadOptions {
        part: Some("bored.r".to_owned()),
        ..ReadOptions::default()
    };
    let part = read("part", text.as_bytes(), Format::Asc, &options).unwrap();
    assert_same_points(&part.tree, bored);
}

#[test]
fn matrices() {
    let with = |matrix: &str| {
        let text = format!(
            "put b arb8 V1 {{0 0 0}} V2 {{1 0 0}} V3 {{1 2 0}} V4 {{0 2 0}} \
             V5 {{0 0 3}} V6 {{1 0 3}} V7 {{1 2 3}} V8 {{0 2 3}}
             put c comb tree {{l b {{{matrix}}}}}"
        );
        read_text(&text, Format::Asc)
    };
    let first = |matrix: &str| {
        let tree = with(matrix).unwrap().tree;
        let (_, placed) = tree.leaves().next().unwrap();
        placed.clone()
    };
    // The last number divides all others.
    let twice = first("1 0 0 4  0 1 0 5  0 0 1 6  0 0 0 0.5");
    assert_eq!(twice.primitive, Primitive::block(n([2, 4, 6])).unwrap());
    assert_eq!(twice.motion.offset(), &n([8, 10, 12]));
    let thrice = first("0 -3 0 0  3 0 0 0  0 0 3 0  0 0 0 1");
    assert_eq!(thrice.primitive, Primitive::block(n([3, 6, 9])).unwrap());
    assert_eq!(thrice.motion.apply_point(&n([1, 0, 0])), n([0, 1, 0]));
    // A mirror in x takes the block to the other side.
    let mirrored = first("-1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1");
    let corner = mirrored.motion.apply_point(&n([1, 2, 3]));
    let origin = mirrored.motion.apply_point(&n([0, 0, 0]));
    let least: [Rational; 3] = std::array::from_fn(|i| corner[i].clone().min(origin[i].clone()));
    assert_eq!(least, n([-1, 0, 0]));
    // Six digits are read as the rotation that they represent, with a remark.
    let turned = with("0.866025 -0.5 0 0 0.5 0.866025 0 0 0 0 1 0 0 0 0 1").unwrap();
    assert_eq!(turned.notes.len(), 1);
    assert!(turned.digits.is_some());
    // All digits of an f64 give no remark.
    let turned =
        with("0.8660254037844386468 -0.5 0 0 0.5 0.8660254037844386468 0 0 0 0 1 0 0 0 0 1")
            .unwrap();
    assert_eq!((turned.notes.len(), turned.digits), (0, None));
}

#[test]
fn elliptic_and_oblique_cones() {
    let parts = [
        (
            "V {1 2 3} H {0 0 4} A {3 0 0} B {0 2 0} C {3 0 0} D {0 2 0}",
            [1.0, 3.9, 3.1],
            [1.0, 4.1, 3.1],
        ),
        (
            "V {0 0 0} H {2 0 4} A {1 0 0} B {0 1 0} C {1 0 0} D {0 1 0}",
            [2.9, 0.0, 3.9],
            [-0.5, 0.0, 3.9],
        ),
        (
            "V {0 0 0} H {0 0 4} A {1 0 0} B {0 2 0} C {2 0 0} D {0 4 0}",
            [0.0, 3.9, 3.99],
            [0.0, 2.1, 0.01],
        ),
    ];
    for (numbers, within, outside) in parts {
        let tree = tree(&format!("put {{s}} tgc {numbers}\n"), Format::Asc);
        assert!(
            super::inside(&tree, within) && !super::inside(&tree, outside),
            "{numbers}"
        );
    }
}

#[test]
fn what_is_not_ours() {
    assert_snapshot!(asc("put e ell V {0 0 0} A {1 0 0} B {0 2 0} C {1 2 0}"), @"part:1:7: found `e`, a solid of wrong size: three axes must not lie in one plane, expected a solid of positive size");
    assert_snapshot!(asc("put e tgc V {0 0 0} H {0 0 1} A {1 0 0} B {0 2 0} C {1 0 0} D {0 1 0}"), @"part:1:7: found `e`, a cone whose ends are not similar, expected similar ellipses at both ends");
    assert_snapshot!(asc("put t tor V {0 0 0} H {0 0 1} r_a 1 r_h 0"), @"part:1:7: found `t`, a solid of wrong size: the minor radius must be greater than zero, expected a solid of positive size");
    assert_snapshot!(asc("put a arb8 V1 {0 0 0} V2 {1 0 0} V3 {1 1 0} V4 {0 1 0} V5 {0 0 1} V6 {1 0 1} V7 {1 1 2} V8 {0 1 1}"), @"part:1:7: found `a`, a polyhedron of eight corners, expected a block or a right-angled wedge");
    assert_snapshot!(asc("put h half N {0 0 1} d 5"), @"part:1:5: found a part that is unbounded toward +x, expected solids that bound it on every side");
    assert_snapshot!(asc("put h half N {0 0 0} d 5"), @"part:1:7: found the normal (0, 0, 0), expected a normal of some length");
    assert_snapshot!(asc("put h extrude V {0 0 0}"), @"part:1:7: found `h`, an object of type `extrude`, expected `comb` or a solid that is exact here: arb8, ell, half, sph, tgc, rec, tor");
    assert_snapshot!(asc("put b ell V {0 0 0} A {1 0 0} B {0 1 0} C {0 0 1}\nput c comb tree {l b {2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1}}"), @"part:2:23: found a matrix that changes proportions or angles, expected a rigid motion, perhaps mirrored, perhaps the same scale in all directions");
    assert_snapshot!(asc("I 1 v4\nA title\n"), @"part:1:1: found a database of BRL-CAD's version 4, expected one of version 5 (`asc2g` and then `g2asc` of a newer BRL-CAD make one of the other)");
    // Objects outside the part may be anything.
    let text = "put h half N {0 0 1} d 5\nput b ell V {0 0 0} A {1 0 0} B {0 1 0} C {0 0 1}\nput c comb tree {l b}";
    let read = read_text(text, Format::Asc).unwrap();
    assert_eq!(read.tree.leaves().count(), 1);
    assert_eq!(read.notes[0].text, "`c` is read; it does not contain `h`");
}

#[test]
fn messages() {
    assert_snapshot!(asc(""), @"part:1:1: found no object in the file, expected a `put` of a solid");
    assert_snapshot!(asc("put a"), @"part:1:5: found `a`, expected `put NAME TYPE`, and the attributes of the object");
    assert_snapshot!(asc("puts a"), @"part:1:1: found the unknown command `puts`, expected one of `put`, `title`, `units`, `attr`, `color` (did you mean `put`?)");
    assert_snapshot!(asc("put a comb tree {l b}"), @"part:1:20: found the unknown name `b`, expected the name of an object in the file");
    assert_snapshot!(asc("put ab comb tree {l bb}\nput bb comb tree {l ab}"), @"part:1:5: found combinations that contain one another, expected an object that no other contains");
    assert_snapshot!(asc("put top comb tree {l ab}\nput ab comb tree {l bb}\nput bb comb tree {l ab}"), @"part:3:21: found `ab`, which contains itself, expected no cycle of combinations");
    assert_snapshot!(asc("put a ell V {0 0 0} A {1 0 0} B {0 1 0}"), @"part:1:5: found the ell `a` without `C`, expected the attribute `C`");
    assert_snapshot!(asc("put a ell V {0 0} A {1 0 0} B {0 1 0} C {0 0 1}"), @"part:1:14: found `0 0`, expected three numbers");
    assert_snapshot!(asc("put a ell V {0 0 0} A {1 0 0} B {0 1 0} C {0 0 1}\nput b tor"), @"part:2:5: found several objects that no other contains: `a`, `b`, expected one, or `--part` and the name of the one to read");
    assert_snapshot!(asc("put a comb tree {u {l b}}"), @"part:1:18: found `u {l b}`, expected an operator and its two operands");
    assert_snapshot!(asc("put a comb tree {x {l b} {l c}}"), @"part:1:18: found `x`, expected a member `l NAME` or an operation: `u`, `n`, `-` or `^` and two operands");
    assert_snapshot!(asc("put a comb tree {l b"), @"part:1:17: found a brace without an end, expected a closing `}`");
    assert_snapshot!(asc("put $a comb"), @"part:1:5: found `$` outside braces, expected words as they are, without substitutions");
    assert_snapshot!(asc("put a comb}"), @"part:1:11: found a closing `}`, expected an opening `{` before it");
}
