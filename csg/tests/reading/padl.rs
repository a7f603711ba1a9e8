use super::*;

fn padl(text: &str) -> Tree {
    tree(text, Format::Padl)
}

/// The radius of the one sphere that a text makes: the value of an expression.
fn value(expression: &str) -> Rational {
    let tree = padl(&format!("A = 6\nb = 2\nP = SPH(R={expression})"));
    match &tree.leaves().next().unwrap().1.primitive {
        Primitive::Sphere { radius } => radius.clone(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn numbers_are_exact() {
    let ratio = |n: i64, d: u64| Rational::from_parts(n.into(), d.into());
    assert_eq!(value("1/3"), ratio(1, 3));
    assert_eq!(value("0.1 + 0.2"), ratio(3, 10));
    assert_eq!(value("2 + 3 * 4"), ratio(14, 1));
    assert_eq!(value("(2 + 3) * 4"), ratio(20, 1));
    assert_eq!(value("A / b / 2"), ratio(3, 2));
    assert_eq!(value("A - b - 1"), ratio(3, 1));
    assert_eq!(value("-A + -b * -8"), ratio(10, 1));
    assert_eq!(value("--1"), ratio(1, 1));
    assert_eq!(value("1e-3"), ratio(1, 1000));
    assert_eq!(value(".5"), ratio(1, 2));
}

#[test]
fn the_example_of_the_manual() {
    let text = "
L     = 60                       # a length
BASE  = BLO(X=L, Y=40, Z=20)
BORE  = CYL(R=8, H=30) AT (MOVX=L/2, MOVY=20, MOVZ=-5)
PART  = (BASE DIF BORE) AT (ROTZ=30, MOVX=5)
";
    let tree = padl(text);
    assert_eq!(tree.nodes().len(), 3);
    let places: Vec<_> = tree
        .leaves()
        .map(|(_, placed)| placed.motion.translation_f64())
        .collect();
    assert_eq!(places[0], nalgebra::Vector3::new(5.0, 0.0, 0.0));
    let (x, y) = (
        30.0 * 0.75f64.sqrt() - 10.0 + 5.0,
        15.0 + 20.0 * 0.75f64.sqrt(),
    );
    assert!((places[1] - nalgebra::Vector3::new(x, y, -5.0)).amax() < 1e-13);
}

#[test]
fn keywords_take_any_case_and_lines_go_on_in_brackets() {
    let text = "\u{feff}a = blo(x=1,\r\n  Y=2, # edge\n\n z=\n3\n)\r\nB = (a\nun Sph(r=1)\n) at (\nrotx=90)\n";
    assert_eq!(padl(text).leaves().count(), 2);
}

#[test]
fn motions_go_in_the_order_written() {
    let turned_last = padl("P = SPH(R=1) AT (MOVX=2, ROTZ=90)");
    let turned_first = padl("P = SPH(R=1) AT (ROTZ=90, MOVX=2)");
    assert!(inside(&turned_last, [0.0, 2.0, 0.0]) && !inside(&turned_last, [2.0, 0.0, 0.0]));
    assert!(inside(&turned_first, [2.0, 0.0, 0.0]) && !inside(&turned_first, [0.0, 2.0, 0.0]));
}

#[test]
fn set_operators_are_equal_in_rank() {
    let prefix = "A = SPH(R=1)\nB = SPH(R=2)\nC = SPH(R=3)\n";
    let left = padl(&format!("{prefix}P = C DIF B UN A"));
    let bracketed = padl(&format!("{prefix}P = C DIF (B UN A)"));
    assert!(inside(&left, [0.5, 0.0, 0.0]) && !inside(&left, [1.5, 0.0, 0.0]));
    assert!(!inside(&bracketed, [0.5, 0.0, 0.0]));
    let place_binds = padl("P = SPH(R=1) UN SPH(R=1) AT (MOVX=5)");
    assert!(inside(&place_binds, [0.0; 3]) && inside(&place_binds, [5.0, 0.0, 0.0]));
}

#[test]
fn every_primitive() {
    let tree = padl(
        "P = BLO(X=1,Y=1,Z=1) UN WED(X=1,Y=1,Z=1) UN CYL(H=1,R=1) UN CON(R=1,H=2) \
         UN CON(R=2,H=3,R2=1) UN CON(R=0,H=3,R2=1) UN CON(R=1,R2=1,H=3) UN SPH(R=1) UN TOR(RMAJ=3,RMIN=1)",
    );
    let mut names = tree
        .leaves()
        .map(|(_, placed)| format!("{:?}", placed.primitive));
    let expected = [
        "Block", "Wedge", "Cylinder", "Frustum", "Frustum", "Frustum", "Cylinder", "Sphere",
        "Torus",
    ];
    for name in expected {
        assert!(names.next().unwrap().starts_with(name));
    }
}

#[test]
fn the_part_is_the_last_solid_or_the_one_named() {
    let text = "A = SPH(R=1)\nB = A UN SPH(R=2)\nN = 5\n";
    assert_eq!(padl(text).leaves().count(), 2);
    let part = |name: &str| {
        let options = ReadOptions {
            part: Some(name.to_owned()),
            ..ReadOptions::default()
        };
        read("part", text.as_bytes(), Format::Padl, &options)
    };
    assert_eq!(part("A").unwrap().tree.leaves().count(), 1);
    assert!(part("N").is_err() && part("C").is_err());
}

#[test]
fn too_many_copies_are_a_limit() {
    let mut text = String::from("A0 = SPH(R=1)\n");
    for i in 0..40 {
        text += &format!("A{} = A{i} UN A{i}\n", i + 1);
    }
    let error = read_text(&text, Format::Padl).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Limit);
    let mut text = String::from("A0 = 3\n");
    for i in 0..40 {
        text += &format!("A{} = A{i} * A{i}\n", i + 1);
    }
    let error = read_text(&text, Format::Padl).unwrap_err();
    assert_eq!(error.kind, ErrorKind::Limit);
}
