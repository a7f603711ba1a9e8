//! The library gives what the program gives: the same measures, and the same bytes of files.

use crate::common::{SETUP, SETUPS, folder, premio};
use ::premio::prelude::*;
use serde_json::Value;
use std::fs;

const EXPORTED: [&str; 6] = ["step", "stl", "obj", "glb", "3mf", "json"];

#[test]
fn the_same_part_has_the_same_measures_and_files() {
    let folder = folder(&[("setup.toml", SETUP), ("setups.toml", SETUPS)]);
    let path = folder.path();
    let run = |words: &str| {
        let output = premio(path, words);
        assert!(output.status.success(), "{words}: {output:?}");
        output.stdout
    };
    let part = block(6, 4, 2) - cylinder(1, 4).translate([3, 2, -1]);
    let read = ::premio::read(path.join("part.padl")).unwrap();
    assert_eq!(read.tree().unwrap(), part.tree().unwrap());
    let solid = part.evaluate().unwrap();

    let info: Value = serde_json::from_slice(&run("info part.padl --json")).unwrap();
    assert_eq!(info["volume"], solid.volume());
    assert_eq!(info["area"], solid.area());
    assert_eq!(
        info["centroid"],
        serde_json::to_value(solid.centroid()).unwrap()
    );
    assert_eq!(
        info["bounds"]["max"],
        serde_json::to_value(solid.bounds().max).unwrap()
    );
    assert_eq!(info["resolution"], solid.resolution());
    assert_eq!(info["faces"], solid.faces().count());

    for ending in EXPORTED {
        run(&format!("export part.padl -o part.{ending}"));
        let format = SolidFormat::from_path(format!("part.{ending}")).unwrap();
        let bytes = solid
            .to_bytes(format, &ExportSettings::new("part"))
            .unwrap();
        assert!(
            fs::read(path.join(format!("part.{ending}"))).unwrap() == bytes,
            "{ending}"
        );
    }

    let view = solid.view(&Camera::orthographic([1.0, -1.0, 1.0])).unwrap();
    let svg = run("contours part.padl --view iso --hidden --format svg");
    assert!(svg == view.to_svg().into_bytes());
    let dxf = run("contours part.padl --view iso --hidden --format dxf");
    assert!(dxf == view.to_dxf().into_bytes());
    let sheet = solid.sheet(
        &[StandardView::Front, StandardView::Top],
        &DrawingOptions::default(),
        SheetOptions::new("part"),
    );
    let svg = run("contours part.padl --views front,top,front --hidden --format svg");
    assert!(svg == ::premio::sheet_to_svg(&sheet.unwrap()).into_bytes());

    let setup = ::premio::read_setup(path.join("setup.toml")).unwrap();
    let predicted: Value =
        serde_json::from_slice(&run("predict part.padl --setup setup.toml")).unwrap();
    let prediction = solid.predict(&setup).unwrap();
    assert_eq!(predicted, serde_json::to_value(&prediction).unwrap());
    run("render part.padl --setup setup.toml -o part.png");
    let picture = solid.render(&setup, &Progress::new()).unwrap();
    assert_eq!(
        ::premio::read_picture(path.join("part.png")).unwrap(),
        picture
    );

    run("model part.padl --setups setups.toml -o part.model");
    let setups = ::premio::read_setups(path.join("setups.toml")).unwrap();
    let trained = Model::train(&solid, &setups, &Progress::new()).unwrap();
    let program = Model::read(path.join("part.model")).unwrap();
    let records = |model: &Model| -> Vec<String> {
        let records = model.text().lines().skip(1);
        records.map(str::to_owned).collect()
    };
    assert_eq!(records(&trained), records(&program));
    assert_eq!(trained.head().count, program.head().count);
    assert_eq!(program.solid().unwrap().volume(), solid.volume());
}
