//! One scene, evaluated once: `scene NAME N [view]`. For profilers.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a report")]

use nalgebra::{Point3, Vector3};
use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_tests::parts::{cube_with_cuts, plate, tee};
use premio_tests::scenes::{self, HeapShape};
use premio_visibility::{ViewCamera, contours};
use std::time::Instant;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let name = arguments[1].as_str();
    let n: usize = arguments[2].parse().unwrap();
    let has_view = arguments.get(3).is_some();
    let (text, format) = match name {
        "plate" => (plate(n, 3.0).to_string(), Format::Json),
        "cuts" => (cube_with_cuts().to_string(), Format::Json),
        "tee" => (tee(n).to_string(), Format::Json),
        "stack" => (scenes::stack(n).to_string(), Format::Json),
        "comb" => (scenes::comb(n).to_string(), Format::Json),
        "boxes" => (scenes::heap(HeapShape::Boxes, n).to_string(), Format::Json),
        "balls" => (scenes::heap(HeapShape::Balls, n).to_string(), Format::Json),
        "rods" => (scenes::heap(HeapShape::Rods, n).to_string(), Format::Json),
        "cubes" => (scenes::separate_cubes(n), Format::Csg),
        "bearing" => (scenes::bearing(n).to_string(), Format::Json),
        "gear" => (scenes::gear(n), Format::Padl),
        "bores" => (scenes::cross_bores(n).to_string(), Format::Json),
        _ => (std::fs::read_to_string(name).unwrap(), Format::Csg),
    };
    if let Ok(file) = std::env::var("PREMIO_SCENE_OUT") {
        std::fs::write(file, &text).unwrap();
    }
    let start = Instant::now();
    let description = read("scene", text.as_bytes(), format, &ReadOptions::default()).unwrap();
    let read = start.elapsed();
    let options = EvaluationOptions {
        noise: description.digits,
        ..EvaluationOptions::default()
    };
    let start = Instant::now();
    let part = evaluate(&description.tree, &options).unwrap();
    println!(
        "{name} {n}: read {read:.1?} evaluate {:.1?} volume {} {:?}",
        start.elapsed(),
        part.mass().volume,
        part.brep.topology.census(),
    );
    if has_view {
        let bounds = part.mass().centroid;
        let target = Point3::from(bounds);
        let size = part.mass().volume.cbrt();
        let eye = target + Vector3::new(1.3, 1.7, 1.5) * (5.0 * size);
        let camera = ViewCamera::perspective(eye, target, Vector3::z(), 1.0).unwrap();
        let start = Instant::now();
        let seen = contours(&part.brep, &camera, part.resolution).unwrap();
        println!(
            "  view {:.1?} {} contours",
            start.elapsed(),
            seen.contours.len()
        );
    }
}
