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
        let written = crate::writer::write(&program.builder, program.part, Format::Json);
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
