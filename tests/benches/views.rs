//! Benchmarks of views: a cube with three cuts, blocks with through holes, and a pipe with branches
//! along its own axis.
#![allow(clippy::unwrap_used, missing_docs, reason = "a bench fails by it")]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::{Point3, Vector3};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_tests::parts::{cube_with_cuts, plate, tee};
use premio_visibility::{ViewCamera, contours};
use serde_json::Value;
use std::time::Duration;

fn part(json: &Value) -> Evaluation {
    let text = json.to_string();
    let tree = read(
        "part",
        text.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    )
    .unwrap();
    evaluate(&tree.tree, &EvaluationOptions::default()).unwrap()
}

fn camera(eye: Point3<f64>, target: Point3<f64>) -> ViewCamera {
    ViewCamera::perspective(eye, target, Vector3::z(), 1.0).unwrap()
}

fn views(c: &mut Criterion) {
    let mut group = c.benchmark_group("views");
    group
        .measurement_time(Duration::from_secs(3))
        .sample_size(10);
    let cuts = part(&cube_with_cuts());
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
    let centre = Point3::new(0.0, 0.0, 100.0);
    let orthographic = |eye, up| ViewCamera::orthographic(eye, centre, up).unwrap();
    for k in [1, 4, 8] {
        let pipe = part(&tee(k));
        for (name, camera) in [
            (
                "tee, axis",
                orthographic(Point3::new(0.0, 0.0, 600.0), Vector3::y()),
            ),
            (
                "tee, general",
                orthographic(Point3::new(310.0, 270.0, 420.0), Vector3::z()),
            ),
        ] {
            group.bench_function(BenchmarkId::new(name, k), |b| {
                b.iter(|| contours(&pipe.brep, &camera, pipe.resolution).unwrap());
            });
        }
    }
    group.finish();
}

criterion_group!(benches, views);
criterion_main!(benches);
