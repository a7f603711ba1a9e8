//! Holds another kernel against realistic parts, and makes what it gets wrong as small as it still is
//! wrong.
//!
//! The kernel here measures volumes by points on a grid. Put your own in the place of [`by_points`]: it
//! gets an expression, which it may take as a tree or as a description.
//!
//! `cargo run -p premio --example fuzz_your_kernel`
#![allow(clippy::print_stdout, reason = "an example prints what it finds")]

use premio::fuzz::{KernelMeasures, KernelTrial, Profile};
use premio::prelude::*;

/// The points of the grid along each axis.
const POINTS: u32 = 10;

/// The volume by the share of the points of a grid that are in the material.
fn by_points(part: &Expression) -> Result<KernelMeasures, String> {
    let solid = part.evaluate().map_err(|error| error.to_string())?;
    let bounds = solid.bounds();
    let at = |axis: usize, k: u32| {
        let (min, max) = (bounds.min[axis], bounds.max[axis]);
        min + (max - min) * (f64::from(k) + 0.5) / f64::from(POINTS)
    };
    let mut inside = 0u32;
    for i in 0..POINTS {
        for j in 0..POINTS {
            for k in 0..POINTS {
                inside += u32::from(solid.contains([at(0, i), at(1, j), at(2, k)]));
            }
        }
    }
    let all: f64 = (0..3)
        .map(|axis| bounds.max[axis] - bounds.min[axis])
        .product();
    let volume = all * f64::from(inside) / f64::from(POINTS.pow(3));
    Ok(KernelMeasures::from_volume(volume))
}

fn main() -> premio::Result<()> {
    // The grid is coarse: a fifth more or less passes, what is farther off does not.
    let trial = KernelTrial {
        tolerance: 0.2,
        tries: 4,
        ..KernelTrial::new(Profile::Grid)
    };
    let report = trial.run(0..6, by_points, &Progress::new())?;
    let (agreed, skipped) = (report.agreed, report.skipped);
    println!(
        "{agreed} parts agree, {skipped} are skipped, {} differ",
        report.failures.len()
    );
    for failure in &report.failures {
        println!("{failure}\n{}", failure.part.to_description(Format::Padl)?);
    }
    Ok(())
}
