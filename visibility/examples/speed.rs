//! How long a view takes: `cargo run --release -p premio-visibility --example speed`.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a measurement")]

#[path = "../tests/parts/mod.rs"]
mod parts;

use nalgebra::{Point3, Vector3};
use parts::{BAND, Builder, plate};
use premio_kernel::brep::Brep;
use premio_kernel::geometry::frame::Frame;
use premio_visibility::{ViewCamera, contours};
use std::time::Instant;

fn time(name: &str, part: &Brep, camera: &ViewCamera, runs: u32) {
    let c = contours(part, camera, BAND).unwrap();
    let pieces: usize = c.contours.iter().map(|c| c.pieces.len()).sum();
    let started = Instant::now();
    for _ in 0..runs {
        std::hint::black_box(contours(part, camera, BAND).unwrap());
    }
    println!(
        "{name}: {:.3} ms, {} contours, {pieces} pieces, {} junctions, {:?}",
        started.elapsed().as_secs_f64() * 1e3 / f64::from(runs),
        c.contours.len(),
        c.junctions.len(),
        c.seconds,
    );
}

fn main() {
    let mut b = Builder::default();
    b.block(
        &Frame::world(),
        [3.0; 3],
        &[(0.8, 0.8, 0.4), (2.0, 1.0, 0.5), (1.4, 2.3, 0.3)],
    );
    let e = Point3::new(9.0, 7.0, 8.0);
    let camera = ViewCamera::perspective(e, Point3::new(1.5, 1.5, 1.5), Vector3::z(), 1.0).unwrap();
    time("cube with three holes", &b.brep, &camera, 500);
    for n in [8, 16, 32, 64] {
        for thickness in [0.5, 3.0] {
            let part = plate(n, thickness);
            let s = f64::from(n);
            let e = Point3::new(1.3 * s, 1.7 * s, 1.5 * s);
            let centre = Point3::new(0.5 * s, 0.5 * s, 0.0);
            let camera = ViewCamera::perspective(e, centre, Vector3::z(), 1.0).unwrap();
            time(
                &format!("{} holes, {thickness} thick", n * n),
                &part,
                &camera,
                3,
            );
        }
    }
}
