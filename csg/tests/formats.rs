//! Descriptions written in another language describe the same solid.

use crate::common::{evaluated, tree};
use premio_csg::reader::{Format, ReadOptions, parse};
use premio_csg::writer::write;

/// OpenSCAD revolves no figure that crosses the axis, so the disc of a spindle torus is clipped.
#[test]
fn tori_that_cross_their_axis_are_clipped_for_openscad() {
    let text = "P = TOR(RMAJ=3, RMIN=5)";
    let options = ReadOptions::default();
    let source = parse("part", text.as_bytes(), Format::Padl, &options).unwrap();
    let scad = write(&source.builder, source.part, Format::Csg).unwrap();
    let original = evaluated(&tree(text, Format::Padl));
    let known = evaluated(&tree(&scad, Format::Csg));
    let [found, expected] = [&known, &original].map(|known| known.mass().volume);
    assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    assert_eq!(
        known.brep.topology.census(),
        original.brep.topology.census()
    );
}
