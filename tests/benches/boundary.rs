//! Benchmarks of boundaries: blocks with through holes, and OpenSCAD's example019.
#![allow(clippy::unwrap_used, missing_docs, reason = "a bench fails by it")]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_csg::tree::Tree;
use premio_tests::parts::plate;
use std::path::PathBuf;
use std::time::Duration;

fn tree(text: &[u8], format: Format) -> (Tree, EvaluationOptions) {
    let description = read("part", text, format, &ReadOptions::default()).unwrap();
    let how = EvaluationOptions {
        noise: description.digits,
        ..EvaluationOptions::default()
    };
    (description.tree, how)
}

fn boundaries(c: &mut Criterion) {
    let mut group = c.benchmark_group("boundary");
    group
        .measurement_time(Duration::from_secs(3))
        .sample_size(10);
    for n in [4, 8, 16, 32] {
        let (plate, how) = tree(plate(n, 3.0).to_string().as_bytes(), Format::Json);
        group.bench_function(BenchmarkId::new("holes", n * n), |b| {
            b.iter(|| evaluate(&plate, &how).unwrap());
        });
    }
    // The file is not ours and is read from the folder that PREMIO_CORPUS names.
    if let Some(folder) = std::env::var_os("PREMIO_CORPUS").map(PathBuf::from) {
        let text = std::fs::read(folder.join("openscad/example019.csg")).unwrap();
        let (example, how) = tree(&text, Format::Csg);
        group.bench_function("example019", |b| {
            b.iter(|| evaluate(&example, &how).unwrap());
        });
    }
    group.finish();
}

criterion_group!(benches, boundaries);
criterion_main!(benches);
