//! The peak memory of the boundary and a view of a block with 32 by 32 through holes: `cargo run
//! --release -p premio-tests --example memory`. It reads VmHWM, so it runs on Linux only.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a report")]

use nalgebra::{Point3, Vector3};
use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_tests::parts::plate;
use premio_visibility::{ViewCamera, contours};

/// The peak memory of this process so far, in MiB.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|l| l.starts_with("VmHWM:")).unwrap();
    let kib: f64 = line.split_whitespace().nth(1).unwrap().parse().unwrap();
    kib / 1024.0
}

fn main() {
    let n = std::env::args().nth(1).map_or(32, |n| n.parse().unwrap());
    let text = plate(n, 3.0).to_string();
    let tree = read(
        "plate",
        text.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    )
    .unwrap();
    let part = evaluate(&tree.tree, &EvaluationOptions::default()).unwrap();
    println!("boundary of {} holes: {:.0} MiB", n * n, peak());
    let s = n as f64;
    let eye = Point3::new(1.3 * s, 1.7 * s, 1.5 * s);
    let target = Point3::new(0.5 * s, 0.5 * s, 0.0);
    let camera = ViewCamera::perspective(eye, target, Vector3::z(), 1.0).unwrap();
    let seen = contours(&part.brep, &camera, part.resolution).unwrap();
    println!(
        "with a view of {} contours: {:.0} MiB",
        seen.contours.len(),
        peak()
    );
}
