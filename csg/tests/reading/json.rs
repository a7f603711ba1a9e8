use super::*;

fn json(text: &str) -> Tree {
    tree(text, Format::Json)
}

#[test]
fn operations_and_primitives() {
    let tree = json(
        r#"{"op":"difference","children":[
            {"prim":"block","size":[1,2,3]},
            {"op":"union","children":[{"prim":"cone","r":1,"h":2},{"prim":"frustum","r1":0,"r2":1,"h":1}]},
            {"op":"intersection","children":[{"prim":"torus","R":3,"r":1},{"prim":"sphere","r":1},
             {"prim":"cylinder","r":1,"h":0.1e1},{"prim":"wedge","size":[1,1,1]}]}
        ],"transform":[{"translate":[1,0,0]}]}"#,
    );
    assert_eq!(tree.leaves().count(), 7);
    assert_eq!(
        tree.leaves().next().unwrap().1.motion.translation_f64(),
        nalgebra::Vector3::new(1.0, 0.0, 0.0)
    );
}

/// The normal has the length 3, so the plane is at the distance 1.
#[test]
fn solids_without_a_bound() {
    let tree = json(
        r#"{"op":"intersection","children":[
            {"prim":"sphere","r":2},
            {"prim":"half_space","normal":[2,2,1],"offset":3},
            {"op":"complement","children":[{"prim":"infinite_cylinder","r":1},
             {"prim":"infinite_cone","slope":2,"transform":[{"translate":[0,0,1]}]}]}
        ]}"#,
    );
    assert_same_points(&tree, |[x, y, z]| {
        let across = x.hypot(y);
        let is_taken = across < 1.0 || (z > 1.0 && across < 2.0 * (z - 1.0));
        x * x + y * y + z * z < 4.0 && (2.0 * x + 2.0 * y + z) < 3.0 && !is_taken
    });
}

#[test]
fn numbers_are_exact() {
    let tree = json(r#"{"prim":"sphere","r":0.1}"#);
    let tenth = Rational::from_parts(1.into(), 10u8.into());
    assert_eq!(
        tree.leaves().next().unwrap().1.primitive,
        Primitive::sphere(tenth).unwrap()
    );
}

#[test]
fn a_transform_goes_in_the_order_written() {
    let tree = json(
        r#"{"prim":"sphere","r":1,"transform":[{"translate":[2,0,0]},{"rotate":[[0,0,2],90]}]}"#,
    );
    assert!(inside(&tree, [0.0, 2.0, 0.0]));
}

#[test]
fn no_children_are_the_empty_solid() {
    assert!(json(r#"{"op":"union","children":[]}"#).is_empty());
    assert!(json(r#"{"op":"difference","children":[]}"#).is_empty());
}

#[test]
fn figures_are_read_and_written() {
    let slot = r#"{"prim":"prism","figure":[[[0,-1],[5,-1,5,0,1],[5,1],[0,1,0,0,1]]],"h":2}"#;
    let tree = tree(slot, Format::Json);
    assert_same_points(&tree, |[x, y, z]| {
        let away = (x - x.clamp(0.0, 5.0)).hypot(y);
        (0.0..=2.0).contains(&z) && away <= 1.0
    });
    for text in [
        slot,
        r#"{"prim":"prism","figure":[[[1,0],[3,0],[2,2]]],"h":2,"top":0.5}"#,
        r#"{"prim":"revolution","figure":[[[1,0],[3,0],[2,2]]],"angle":90}"#,
        r#"{"prim":"revolution","figure":[[[0,-2,0,0,2],[0,2]]]}"#,
    ] {
        let program = parse(
            "part",
            text.as_bytes(),
            Format::Json,
            &ReadOptions::default(),
        );
        let program = program.unwrap();
        let written = premio_csg::writer::write(&program.builder, program.part, Format::Json);
        assert_eq!(written.unwrap().trim(), text);
    }
    for (text, expected) in [
        (
            r#"{"prim":"prism","figure":[[[0,0],[1,0]]],"h":1}"#,
            "a figure without area",
        ),
        (
            r#"{"prim":"prism","figure":[[[0,0],[1,0,1],[1,1]]],"h":1}"#,
            "an array of 3",
        ),
        (
            r#"{"prim":"prism","figure":[[[0,0],[1,0,9,9,1],[1,1]]],"h":1}"#,
            "not on its circle",
        ),
        (
            r#"{"prim":"revolution","figure":[[[-1,0],[1,0],[1,1]]]}"#,
            "one side of the axis",
        ),
        (
            r#"{"prim":"revolution","figure":[[[1,0],[2,0],[1,1]]],"angle":0}"#,
            "0 and 360",
        ),
    ] {
        let found = message(text, Format::Json);
        assert!(found.contains(expected), "{found}");
    }
}

/// Expressions of figures are those of PADL.
#[test]
fn figures_are_expressions() {
    let padl = |text: &str| tree(text, Format::Padl);
    for (json_text, padl_text) in [
        (
            r#"{"prim":"prism","figure":{"prim":"square","size":[4,2]},"h":3}"#,
            "P = PRI(SQU(X=4, Y=2), H=3)",
        ),
        (
            r#"{"prim":"prism","h":3,"figure":{"op":"difference","children":[
                {"prim":"circle","r":5},
                {"prim":"square","size":[4,2],"transform":[{"rotate":30},{"translate":[1,0.5]}]}]}}"#,
            "P = PRI(CIR(R=5) DIF SQU(X=4, Y=2) AT (ROTZ=30, MOVX=1, MOVY=0.5), H=3)",
        ),
        (
            r#"{"prim":"prism","h":3,"top":0.5,"figure":{"op":"offset","delta":1,
                "figure":{"prim":"polygon","contours":[[[0,0],[4,0],[0,3]]]}}}"#,
            "P = PRI(OFF(PGN((0,0), (4,0), (0,3)), DELTA=1), H=3, TOP=0.5)",
        ),
        (
            r#"{"prim":"revolution","angle":90,"figure":{"op":"hull","children":[
                {"prim":"circle","r":1,"transform":[{"translate":[3,0]}]},
                {"prim":"circle","r":1,"transform":[{"translate":[5,1]}]}]}}"#,
            "P = REV(HULL(CIR(R=1) AT (MOVX=3), CIR(R=1) AT (MOVX=5, MOVY=1)), ANGLE=90)",
        ),
        (
            r#"{"op":"hull","transform":[{"translate":[0,0,1]}],"children":[
                {"prim":"sphere","r":1},
                {"prim":"sphere","r":1,"transform":[{"translate":[4,0,0]}]}]}"#,
            "P = HULL(SPH(R=1), SPH(R=1) AT (MOVX=4)) AT (MOVZ=1)",
        ),
    ] {
        assert_eq!(json(json_text), padl(padl_text), "{json_text}");
    }
    let empty = r#"{"prim":"prism","h":1,"figure":{"op":"intersection","children":[
        {"prim":"circle","r":1},{"prim":"circle","r":1,"transform":[{"translate":[3,0]}]}]}}"#;
    assert!(json(empty).leaves().count() == 2 || json(empty).is_empty());
    assert!(json(r#"{"prim":"prism","h":1,"figure":{"op":"union","children":[]}}"#).is_empty());
    // An offset inwards of all of a figure.
    let vanished = r#"{"prim":"prism","h":1,"figure":{"op":"offset","r":-2,
        "figure":{"prim":"circle","r":1}}}"#;
    assert!(json(vanished).is_empty());
}

#[test]
fn wrong_expressions_of_figures_are_named() {
    let prism = |figure: &str| format!(r#"{{"prim":"prism","h":1,"figure":{figure}}}"#);
    for (figure, expected) in [
        (r#"{"prim":"circle","r":0}"#, "a radius greater than zero"),
        (r#"{"prim":"cricle","r":1}"#, "(did you mean `circle`?)"),
        (
            r#"{"prim":"square","size":[1,2,3]}"#,
            "an array of two numbers",
        ),
        (
            r#"{"op":"offset","figure":{"prim":"circle","r":1}}"#,
            "one of `r`, `delta` and `chamfer`",
        ),
        (
            r#"{"op":"offset","r":1,"delta":1,"figure":{"prim":"circle","r":1}}"#,
            "one of `r`, `delta` and `chamfer`",
        ),
        (
            r#"{"op":"union","children":[7]}"#,
            "a figure: an object with `op` or `prim`",
        ),
        (
            r#"{"prim":"circle","r":1,"transform":[{"translate":[1,2,3]}]}"#,
            "an array of two numbers",
        ),
        (r#"{"radius":1}"#, "`op` or `prim`"),
        ("7", "an array of contours, or a figure as an object"),
    ] {
        let found = message(&prism(figure), Format::Json);
        assert!(found.contains(expected), "{figure}: {found}");
    }
    let flat = r#"{"prim":"prism","h":0,"figure":{"prim":"circle","r":1}}"#;
    assert!(message(flat, Format::Json).contains("a height greater than zero"));
    let hull =
        r#"{"op":"hull","children":[{"prim":"sphere","r":1},{"prim":"block","size":[1,1,1]}]}"#;
    assert!(message(hull, Format::Json).contains("balls of one radius"));
}
