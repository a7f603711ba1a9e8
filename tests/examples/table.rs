//! The book's table of running times, from criterion's measurements: `cargo bench -p premio-tests
//! && cargo run --release -p premio-tests --example table`.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a report")]

use serde_json::Value;
use std::path::Path;

/// The label of each row, and the location of criterion's estimates.
const ROWS: &[(&str, &str)] = &[
    ("block with 16 through holes: boundary", "boundary/holes/16"),
    ("block with 64 through holes: boundary", "boundary/holes/64"),
    (
        "block with 256 through holes: boundary",
        "boundary/holes/256",
    ),
    (
        "block with 32 × 32 through holes: boundary",
        "boundary/holes/1024",
    ),
    (
        "block with 16 through holes: perspective view",
        "views/holes, thick/16",
    ),
    (
        "block with 64 through holes: perspective view",
        "views/holes, thick/64",
    ),
    (
        "block with 256 through holes: perspective view",
        "views/holes, thick/256",
    ),
    (
        "block with 32 × 32 through holes: perspective view",
        "views/holes, thick/1024",
    ),
    ("OpenSCAD's example019: boundary", "boundary/example019"),
    (
        "cube with three cuts: one view",
        "views/cube with three cuts",
    ),
    (
        "pipe with 1 branch: view along its axis",
        "views/tee, axis/1",
    ),
    (
        "pipe with 1 branch: view in general position",
        "views/tee, general/1",
    ),
    (
        "pipe with 4 branches: view along its axis",
        "views/tee, axis/4",
    ),
    (
        "pipe with 4 branches: view in general position",
        "views/tee, general/4",
    ),
    (
        "pipe with 8 branches: view along its axis",
        "views/tee, axis/8",
    ),
    (
        "pipe with 8 branches: view in general position",
        "views/tee, general/8",
    ),
    (
        "cube with three cuts: one prediction at 640 × 480",
        "predictions/cube with three cuts",
    ),
    (
        "cube with three cuts: its full render by rays",
        "predictions/cube with three cuts_ full render",
    ),
    (
        "block with 49 through holes: one prediction at 640 × 480",
        "predictions/block with 49 through holes",
    ),
    (
        "block with 49 through holes: its full render by rays",
        "predictions/block with 49 through holes_ full render",
    ),
];

/// The median, in nanoseconds.
fn median(folder: &Path) -> Option<f64> {
    let text = std::fs::read_to_string(folder.join("new/estimates.json")).ok()?;
    let estimates: Value = serde_json::from_str(&text).ok()?;
    estimates["median"]["point_estimate"].as_f64()
}

fn shown(nanoseconds: f64) -> String {
    let (value, unit) = match nanoseconds {
        n if n < 1e6 => (n / 1e3, "µs"),
        n if n < 1e9 => (n / 1e6, "ms"),
        n => (n / 1e9, "s"),
    };
    let digits = usize::from(value < 10.0) + usize::from(value < 100.0);
    format!("{value:.digits$} {unit}")
}

fn main() {
    let target = std::env::var("CARGO_TARGET_DIR")
        .unwrap_or_else(|_| format!("{}/../target", env!("CARGO_MANIFEST_DIR")));
    println!("| work | time |\n|---|---|");
    for (row, place) in ROWS {
        let found = median(&Path::new(&target).join("criterion").join(place));
        println!("| {row} | {} |", found.map_or("-".to_owned(), shown));
    }
}
