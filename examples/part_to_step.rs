//! Makes a part, measures it, and writes it as STEP and as a drawing of three views.
//!
//! `cargo run -p premio --example part_to_step -- FOLDER`
#![allow(clippy::print_stdout, reason = "an example prints what it finds")]

use premio::prelude::*;
use std::path::PathBuf;

fn main() -> premio::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".to_owned()));

    // A flange: a disc, a hub, a bore and six holes. Lengths are exact: 17.5 is 35/2.
    let hole = cylinder(5, 12).translate([40, 0, 0]);
    let holes: Expression = (0..6).map(|k| hole.clone().rotate_z(60 * k)).sum();
    let hub = frustum(25, 20, 30);
    let flange = cylinder(55, 12) + hub - cylinder(17.5, 30) - holes;

    let solid = flange.evaluate()?;
    println!("volume {:.3}, area {:.3}", solid.volume(), solid.area());
    println!(
        "{} faces, {} edges",
        solid.faces().count(),
        solid.edges().count()
    );
    for call in solid.close_calls() {
        println!("close: {} at {:?}", call.question, call.place);
    }
    solid.write_step(folder.join("flange.step"))?;

    let views = [
        StandardView::Front,
        StandardView::Top,
        StandardView::Isometric,
    ];
    let options = SheetOptions {
        paper: Paper::A4,
        ..SheetOptions::new("flange")
    };
    let sheet = solid.sheet(&views, &DrawingOptions::default(), options)?;
    println!(
        "scale {}",
        sheet
            .scale
            .map_or("none".to_owned(), |scale| scale.to_string())
    );
    let svg = folder.join("flange.svg");
    premio::files::write_whole(premio::sheet_to_svg(&sheet), &svg)
        .map_err(|source| premio::Error::File { path: svg, source })
}
