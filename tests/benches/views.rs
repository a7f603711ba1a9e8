//! How long views take: a cube with three cuts, and blocks with through holes.
#![allow(clippy::unwrap_used, missing_docs, reason = "a bench fails by it")]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::{Point3, Vector3};
use premio_csg::boundary::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, Options, read};
use premio_visibility::{Camera, contours};
use serde_json::{Value, json};
use std::time::Duration;

fn part(json: &Value) -> Evaluation {
    let text = json.to_string();
    let tree = read("part", text.as_bytes(), Format::Json, &Options::default()).unwrap();
    evaluate(&tree.tree, &EvaluationOptions::default()).unwrap()
}

fn bore(r: f64, h: f64, at: [f64; 3]) -> Value {
    json!({"prim": "cylinder", "r": r, "h": h, "transform": [{"translate": at}]})
}

fn cube() -> Value {
    json!({"op": "difference", "children": [
        {"prim": "block", "size": [3.0, 3.0, 3.0]},
        {"prim": "block", "size": [1.0, 4.0, 1.0], "transform": [{"translate": [1.0, -0.5, 2.5]}]},
        bore(0.5, 4.0, [0.8, 0.8, -0.5]),
        {"prim": "wedge", "size": [1.0, 4.0, 1.0], "transform": [{"translate": [-0.1, -0.5, -0.1]}]},
    ]})
}

/// A block with n by n through holes, one unit apart.
fn plate(n: usize, thickness: f64) -> Value {
    let side = n as f64;
    let mut all = vec![json!({"prim": "block", "size": [side, side, thickness]})];
    for i in 0..n * n {
        let (x, y) = ((i % n) as f64 + 0.5, (i / n) as f64 + 0.5);
        all.push(bore(0.3, thickness + 2.0, [x, y, -1.0]));
    }
    json!({"op": "difference", "children": all})
}

fn camera(eye: Point3<f64>, target: Point3<f64>) -> Camera {
    Camera::perspective(eye, target, Vector3::z(), 1.0).unwrap()
}

fn views(c: &mut Criterion) {
    let mut group = c.benchmark_group("views");
    group
        .measurement_time(Duration::from_secs(3))
        .sample_size(10);
    let cuts = part(&cube());
    let near = camera(Point3::new(9.0, 7.0, 8.0), Point3::new(1.5, 1.5, 1.5));
    group.bench_function("cube with three cuts", |b| {
        b.iter(|| contours(&cuts.brep, &near, cuts.resolution).unwrap());
    });
    for n in [4, 8, 16, 32] {
        for (name, thickness) in [("thin", 0.5), ("thick", 3.0)] {
            let block = part(&plate(n, thickness));
            let s = n as f64;
            let eye = Point3::new(1.3 * s, 1.7 * s, 1.5 * s);
            let far = camera(eye, Point3::new(0.5 * s, 0.5 * s, 0.0));
            group.bench_function(BenchmarkId::new(format!("holes, {name}"), n * n), |b| {
                b.iter(|| contours(&block.brep, &far, block.resolution).unwrap());
            });
        }
    }
    group.finish();
}

criterion_group!(benches, views);
criterion_main!(benches);
