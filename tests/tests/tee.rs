//! A pipe with k branches seen along its own axis, where many contours coincide.
#![allow(clippy::print_stdout, reason = "tests")]

use nalgebra::{Point3, Vector3};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_csg::tree::Tree;
use premio_tests::parts::tee;
use premio_verify::checks::Checker;
use premio_visibility::contours::contours_with;
use premio_visibility::invisibility::Method;
use premio_visibility::{ViewCamera, contours};
use serde_json::{Value, json};
use std::time::Instant;

fn main_tube(r: f64, from: f64, to: f64) -> Value {
    json!({"prim": "cylinder", "r": r, "h": to - from, "transform": [{"translate": [0.0, 0.0, from]}]})
}

fn branch(i: usize, r: f64, to: f64) -> Value {
    let z = 20.0 + 20.0 * i as f64;
    json!({"prim": "cylinder", "r": r, "h": to,
        "transform": [{"rotate": [[0.0, 1.0, 0.0], 90.0]}, {"translate": [0.0, 0.0, z]}]})
}

/// The union of pipes, each of which is hollow.
fn crossing(k: usize) -> Value {
    let hollow =
        |outer: Value, inner: Value| json!({"op": "difference", "children": [outer, inner]});
    let mut all = vec![hollow(
        main_tube(50.0, 0.0, 200.0),
        main_tube(48.0, -1.0, 201.0),
    )];
    all.extend((0..k).map(|i| hollow(branch(i, 6.0, 80.0), branch(i, 5.0, 81.0))));
    json!({"op": "union", "children": all})
}

fn part(json: &Value) -> (Tree, Evaluation) {
    let text = json.to_string();
    let tree = read(
        "tee",
        text.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    )
    .unwrap()
    .tree;
    let evaluation = evaluate(&tree, &EvaluationOptions::default()).unwrap();
    (tree, evaluation)
}

fn cameras() -> Vec<(&'static str, ViewCamera)> {
    let centre = Point3::new(0.0, 0.0, 100.0);
    let along = |z: f64| {
        let eye = Point3::new(0.0, 0.0, z);
        (eye, Vector3::y())
    };
    let (above, up) = along(600.0);
    let (below, _) = along(-400.0);
    let lateral = Point3::new(310.0, 270.0, 420.0);
    vec![
        (
            "along",
            ViewCamera::orthographic(above, centre, up).unwrap(),
        ),
        (
            "from below",
            ViewCamera::orthographic(below, centre, up).unwrap(),
        ),
        (
            "on the axis",
            ViewCamera::perspective(above, centre, up, 1.0).unwrap(),
        ),
        (
            "general",
            ViewCamera::orthographic(lateral, centre, Vector3::z()).unwrap(),
        ),
        (
            "general perspective",
            ViewCamera::perspective(lateral, centre, Vector3::z(), 1.0).unwrap(),
        ),
    ]
}

/// The shortest of several runs, in seconds.
fn time(part: &Evaluation, camera: &ViewCamera) -> f64 {
    let run = || {
        let started = Instant::now();
        std::hint::black_box(contours(&part.brep, camera, part.resolution).unwrap());
        started.elapsed().as_secs_f64()
    };
    (0..3).map(|_| run()).fold(f64::INFINITY, f64::min)
}

fn examine(name: &str, json: &Value) -> Vec<f64> {
    let (tree, part) = part(json);
    let checker = Checker::new(&tree, &part);
    let mut wrong = Vec::new();
    let mut times = Vec::new();
    for (view, camera) in cameras() {
        for check in checker.view(view, &camera) {
            println!("{name}: {check}");
            if !check.passes() {
                wrong.push(check.to_string());
            }
        }
        let seen = |method| contours_with(&part.brep, &camera, part.resolution, method).unwrap();
        let (a, b) = (seen(Method::Propagated), seen(Method::Recounted));
        for (a, b) in a.contours.iter().zip(&b.contours) {
            let differ = a
                .pieces
                .iter()
                .zip(&b.pieces)
                .any(|(a, b)| a.quantitative_invisibility != b.quantitative_invisibility);
            if differ {
                wrong.push(format!("{view}: contour {} is not as counted", a.id));
            }
        }
        times.push(time(&part, &camera));
        println!("{name}, {view}: {:.3} ms", 1e3 * times[times.len() - 1]);
    }
    assert!(wrong.is_empty(), "{name}: {}", wrong.join("\n"));
    times
}

#[test]
fn open_branches() {
    for k in [1, 4, 8] {
        examine(&format!("open {k}"), &tee(k));
    }
}

#[test]
fn crossing_pipes() {
    for k in [1, 4, 8] {
        examine(&format!("crossing {k}"), &crossing(k));
    }
}
