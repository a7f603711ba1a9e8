//! Benchmarks of predictions: a cube with three cuts at 640 × 480, compared with a full render by
//! ray casting, and a part with a hundred faces.
#![allow(clippy::unwrap_used, missing_docs, reason = "a bench fails by it")]

use criterion::{Criterion, criterion_group, criterion_main};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_predict::prediction::{Memory, prediction, with_draft};
use premio_predict::prepared_part::PreparedPart;
use premio_predict::render;
use premio_predict::setup::Setup;
use premio_tests::parts::{cube_with_cuts, plate};
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

/// A camera and a light about a part of some size, both from above.
fn setup(size: f64) -> Setup {
    let [x, y, z] = [3.0 * size, 2.3 * size, 2.7 * size];
    let text = format!(
        "[camera]\neye = [{x}, {y}, {z}]\n[[light]]\nposition = [{}, {}, {}]\n[detector]\nthreshold = 8\n",
        1.3 * size,
        3.3 * size,
        4.7 * size
    );
    Setup::from_toml(&text).unwrap()
}

fn predictions(c: &mut Criterion) {
    let mut group = c.benchmark_group("predictions");
    group
        .measurement_time(Duration::from_secs(3))
        .sample_size(10);
    for (name, json, size) in [
        ("cube with three cuts", cube_with_cuts(), 3.0),
        ("block with 49 through holes", plate(7, 2.0), 7.0),
    ] {
        let part = part(&json);
        let subject = PreparedPart::new(&part.brep, part.resolution).unwrap();
        let setup = setup(size);
        let mut memory = Memory::default();
        group.bench_function(name, |b| {
            b.iter(|| {
                with_draft(&subject, None, &setup, &mut memory, |draft| {
                    prediction(draft, &setup)
                })
                .unwrap()
            });
        });
        group.bench_function(format!("{name}: full render"), |b| {
            b.iter(|| {
                with_draft(&subject, None, &setup, &mut memory, |draft| {
                    let [width, height] = setup.conditions.sensor.resolution;
                    render::rows(&draft.shading, width, 0..height)
                })
                .unwrap()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, predictions);
criterion_main!(benches);
