//! Models as text: padl, csg (as OpenSCAD flattens) and json. Numbers are written with all their
//! digits, and never with an exponent.

use super::model::{Axis, Kind, Model, NodeId, Operation, Primitive, Step, Visit};
use nalgebra::{Matrix3, Rotation3, Vector3};
use premio_csg::reader::{self, Description, Options, ReadError};
use std::fmt::Write;

pub use premio_csg::reader::Format;

/// The ending of a format's files.
pub fn ending(format: Format) -> &'static str {
    match format {
        Format::Padl => "padl",
        Format::Csg => "csg",
        Format::Json => "json",
    }
}

/// A model's description.
///
/// What is read from padl and json is the same tree. A csg has matrices, which the reader makes
/// turns by whole quarters of a degree where six digits allow that, and else rigid to the last
/// digits: other turns are read as near as doubles are, and turns by less than a millionth as none.
pub fn write(model: &Model, format: Format) -> String {
    let mut text = String::new();
    match format {
        Format::Padl => {
            text.push_str("PART = (");
            model.walk(|visit| padl(model, visit, &mut text));
            text.push_str(")\n");
        }
        Format::Csg => model.walk(|visit| csg(model, visit, &mut text)),
        Format::Json => model.walk(|visit| json(model, visit, &mut text)),
    }
    text
}

/// Reads a text that [`write()`] made.
pub fn read(text: &str, format: Format) -> Result<Description, ReadError> {
    reader::read("model", text.as_bytes(), format, &Options::default())
}

/// What a node needs: its kind and its steps.
fn node(model: &Model, id: NodeId) -> (&Kind, &[Step]) {
    let node = &model.nodes()[id];
    (&node.kind, &node.steps)
}

fn push(text: &mut String, written: std::fmt::Arguments<'_>) {
    // A string takes everything.
    let _ = text.write_fmt(written);
}

fn list(v: &[f64; 3]) -> String {
    format!("[{},{},{}]", v[0], v[1], v[2])
}

fn padl(model: &Model, visit: Visit, text: &mut String) {
    match visit {
        Visit::Enter(id) => match node(model, id) {
            (Kind::Leaf(primitive), steps) => {
                text.push_str(&padl_primitive(primitive));
                padl_steps(steps, text);
            }
            (Kind::Operation(..), _) => text.push('('),
        },
        // A line that ends inside brackets goes on.
        Visit::Between(id) => text.push_str(match node(model, id).0 {
            Kind::Operation(Operation::Union, _) => "\n UN ",
            Kind::Operation(Operation::Intersection, _) => "\n INT ",
            Kind::Operation(Operation::Difference, _) | Kind::Leaf(_) => "\n DIF ",
        }),
        Visit::Leave(id) => {
            text.push(')');
            padl_steps(node(model, id).1, text);
        }
    }
}

fn padl_primitive(primitive: &Primitive) -> String {
    match primitive {
        Primitive::Block([x, y, z]) => format!("BLO(X={x}, Y={y}, Z={z})"),
        Primitive::Wedge([x, y, z]) => format!("WED(X={x}, Y={y}, Z={z})"),
        Primitive::Cylinder { r, h } => format!("CYL(R={r}, H={h})"),
        Primitive::Frustum { r1, r2, h } if *r2 == 0.0 => format!("CON(R={r1}, H={h})"),
        Primitive::Frustum { r1, r2, h } => format!("CON(R={r1}, H={h}, R2={r2})"),
        Primitive::Sphere(r) => format!("SPH(R={r})"),
        Primitive::Torus { major, minor } => format!("TOR(RMAJ={major}, RMIN={minor})"),
    }
}

fn padl_steps(steps: &[Step], text: &mut String) {
    let mut words = Vec::new();
    for step in steps {
        match step {
            Step::Shift(by) => {
                let moved = by.iter().zip(["MOVX", "MOVY", "MOVZ"]);
                words.extend(
                    moved
                        .filter(|(by, _)| **by != 0.0)
                        .map(|(by, word)| format!("{word}={by}")),
                );
            }
            Step::Turn(axis, degrees) => {
                let word = ["ROTX", "ROTY", "ROTZ"][axis.index()];
                words.push(format!("{word}={degrees}"));
            }
        }
    }
    if !words.is_empty() {
        push(text, format_args!(" AT ({})", words.join(", ")));
    }
}

fn json(model: &Model, visit: Visit, text: &mut String) {
    match visit {
        Visit::Enter(id) => match node(model, id) {
            (Kind::Leaf(primitive), steps) => {
                push(text, format_args!("{{{}", json_primitive(primitive)));
                json_steps(steps, text);
            }
            (Kind::Operation(op, _), _) => {
                let name = match op {
                    Operation::Union => "union",
                    Operation::Intersection => "intersection",
                    Operation::Difference => "difference",
                };
                push(text, format_args!(r#"{{"op":"{name}","children":["#));
            }
        },
        Visit::Between(_) => text.push(','),
        Visit::Leave(id) => {
            text.push(']');
            json_steps(node(model, id).1, text);
        }
    }
}

fn json_primitive(primitive: &Primitive) -> String {
    match primitive {
        Primitive::Block(size) => format!(r#""prim":"block","size":{}"#, list(size)),
        Primitive::Wedge(size) => format!(r#""prim":"wedge","size":{}"#, list(size)),
        Primitive::Cylinder { r, h } => format!(r#""prim":"cylinder","r":{r},"h":{h}"#),
        Primitive::Frustum { r1, r2, h } => {
            format!(r#""prim":"frustum","r1":{r1},"r2":{r2},"h":{h}"#)
        }
        Primitive::Sphere(r) => format!(r#""prim":"sphere","r":{r}"#),
        Primitive::Torus { major, minor } => {
            format!(r#""prim":"torus","R":{major},"r":{minor}"#)
        }
    }
}

/// The transform, where there is one, and the end of the object.
fn json_steps(steps: &[Step], text: &mut String) {
    let one = |step: &Step| match step {
        Step::Shift(by) => format!(r#"{{"translate":{}}}"#, list(by)),
        Step::Turn(axis, degrees) => {
            format!(r#"{{"rotate":[{},{degrees}]}}"#, list(&axis.vector(1.0)))
        }
    };
    if !steps.is_empty() {
        let all: Vec<String> = steps.iter().map(one).collect();
        push(text, format_args!(r#","transform":[{}]"#, all.join(",")));
    }
    text.push('}');
}

/// As OpenSCAD writes a smooth surface.
const SMOOTH: &str = "$fn = 0, $fa = 12, $fs = 2";

fn csg(model: &Model, visit: Visit, text: &mut String) {
    match visit {
        Visit::Enter(id) => {
            let (kind, steps) = node(model, id);
            for step in steps.iter().rev() {
                push(text, format_args!("multmatrix({}) {{ ", matrix(step)));
            }
            match kind {
                Kind::Leaf(primitive) => {
                    text.push_str(&csg_primitive(primitive));
                    csg_close(steps, text);
                }
                Kind::Operation(op, _) => text.push_str(match op {
                    Operation::Union => "union() {\n",
                    Operation::Intersection => "intersection() {\n",
                    Operation::Difference => "difference() {\n",
                }),
            }
        }
        Visit::Between(_) => {}
        Visit::Leave(id) => {
            text.push('}');
            csg_close(node(model, id).1, text);
        }
    }
}

fn csg_close(steps: &[Step], text: &mut String) {
    text.push_str(&" }".repeat(steps.len()));
    text.push('\n');
}

fn csg_primitive(primitive: &Primitive) -> String {
    match primitive {
        Primitive::Block(size) => format!("cube(size = {}, center = false);", list(size)),
        Primitive::Wedge([x, y, z]) => {
            // Raised along z from a triangle in x and y: turned, z becomes -y and y becomes z.
            format!(
                "multmatrix([[1,0,0,0],[0,0,-1,{y}],[0,1,0,0],[0,0,0,1]]) {{ \
                 linear_extrude(height = {y}, center = false) {{ \
                 polygon(points = [[0,0],[{x},0],[0,{z}]]); }} }}"
            )
        }
        Primitive::Cylinder { r, h } => {
            format!("cylinder({SMOOTH}, h = {h}, r1 = {r}, r2 = {r}, center = false);")
        }
        Primitive::Frustum { r1, r2, h } => {
            format!("cylinder({SMOOTH}, h = {h}, r1 = {r1}, r2 = {r2}, center = false);")
        }
        Primitive::Sphere(r) => format!("sphere({SMOOTH}, r = {r});"),
        Primitive::Torus { major, minor } => format!(
            "rotate_extrude(angle = 360, {SMOOTH}) {{ \
             multmatrix([[1,0,0,{major}],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {{ \
             circle({SMOOTH}, r = {minor}); }} }}"
        ),
    }
}

fn matrix(step: &Step) -> String {
    let (turn, [x, y, z]) = match step {
        Step::Shift(by) => (Matrix3::identity(), *by),
        Step::Turn(axis, degrees) => (turn(*axis, *degrees), [0.0; 3]),
    };
    let row = |i: usize, t: f64| {
        let [a, b, c] = [0, 1, 2].map(|j| turn[(i, j)]);
        format!("[{a},{b},{c},{t}]")
    };
    format!("[{},{},{},[0,0,0,1]]", row(0, x), row(1, y), row(2, z))
}

/// The matrix of a turn; of zeros and ones for quarter turns.
fn turn(axis: Axis, degrees: f64) -> Matrix3<f64> {
    let along = Vector3::from(axis.vector(1.0));
    let scaled = along * degrees.to_radians();
    let turn = *Rotation3::from_scaled_axis(scaled).matrix();
    match degrees % 90.0 == 0.0 {
        // Without a minus before a zero.
        true => turn.map(|x| x.round() + 0.0),
        false => turn,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::profile::Profile;
    use premio_csg::boundary::evaluate;

    fn volume(description: &Description) -> f64 {
        let part = evaluate(&description.tree, &Default::default()).unwrap();
        part.mass().volume
    }

    #[test]
    fn padl_and_json_are_the_same_tree() {
        for profile in Profile::ALL {
            for seed in 0..25 {
                let model = profile.model(seed);
                let [padl, json] = [Format::Padl, Format::Json].map(|f| {
                    let text = write(&model, f);
                    read(&text, f).expect(&text).tree
                });
                assert!(padl == json, "{profile} {seed}");
            }
        }
    }

    #[test]
    fn csg_is_the_same_tree_where_turns_are_of_quarter_degrees() {
        for seed in 0..200 {
            let model = Profile::Grid.model(seed);
            let [csg, json] = [Format::Csg, Format::Json].map(|f| {
                let text = write(&model, f);
                read(&text, f).expect(&text).tree
            });
            assert!(csg == json, "seed {seed}");
        }
    }

    #[test]
    fn csg_has_the_same_volume() {
        for profile in [Profile::Tangent, Profile::Near] {
            for seed in 0..12 {
                let model = profile.model(seed);
                let [csg, json] = [Format::Csg, Format::Json]
                    .map(|f| read(&write(&model, f), f).unwrap())
                    .map(|description| volume(&description));
                // The reader takes a turn by less than a millionth for none.
                let off = if profile == Profile::Near { 1e-4 } else { 1e-9 };
                assert!((csg - json).abs() < off, "{profile} {seed}: {csg} {json}");
            }
        }
    }

    #[test]
    fn small_numbers_have_no_exponent() {
        let step = Step::Shift([2f64.powi(-60), 0.0, -1e-9]);
        let model = Model::of(Primitive::Sphere(0.5), vec![step]);
        for format in [Format::Padl, Format::Csg, Format::Json] {
            let text = write(&model, format);
            assert!(text.contains("0.000000000000000000867"), "{text}");
            assert!(!text.contains("e-"), "{text}");
        }
    }
}
