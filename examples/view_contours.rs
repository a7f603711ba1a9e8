//! Lists the contours of a part for a viewpoint: what is visible, what hides the rest, and where
//! contours end.
//!
//! `cargo run -p premio --example view_contours -- FOLDER`
#![allow(clippy::print_stdout, reason = "an example prints what it finds")]

use premio::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;

fn main() -> premio::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".to_owned()));

    let ring = torus(20, 6).translate([0, 0, 5]);
    let part = block(60, 60, 4).translate([-30, -30, -4]) + ring;
    let solid = part.evaluate()?;
    let camera = Camera::perspective([90.0, -120.0, 60.0], [0.0, 0.0, 3.0]).with_focal(50.0);
    let view = solid.view(&camera)?;

    for arc in view.visible() {
        let [from, to] = arc.range();
        let curve = arc.space_curve().name();
        println!("{:?}: {curve} from {from:.4} to {to:.4}", arc.kind());
    }
    for arc in view.hidden() {
        let by = arc.occluder().map(|face| face.surface().kind().name());
        let count = arc.quantitative_invisibility();
        println!(
            "hidden by {count} faces, the nearest a {}",
            by.unwrap_or("?")
        );
    }
    let mut junctions: BTreeMap<String, usize> = BTreeMap::new();
    for junction in view.junctions() {
        *junctions.entry(format!("{:?}", junction.kind)).or_default() += 1;
    }
    println!("junctions: {junctions:?}");
    view.write(folder.join("ring.svg"))?;
    view.write(folder.join("ring.json"))
}
