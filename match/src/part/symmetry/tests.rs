//! The numbers of rotational symmetries, derived by hand.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use crate::part::SoughtPart;
use crate::part::detectability_prior::DetectabilityPrior;
use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use std::fmt::Write;

fn check(text: &str, turns: usize, circles: usize) {
    let tree = read(
        "part",
        text.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    )
    .unwrap();
    let evaluation = evaluate(&tree.tree, &EvaluationOptions::default()).unwrap();
    let part = SoughtPart::new(
        &evaluation.brep,
        evaluation.resolution,
        &DetectabilityPrior::nothing(),
    );
    let found = (part.symmetries.len(), part.circles.len());
    assert_eq!(found, (turns, circles), "{text}");
    for symmetry in &part.symmetries {
        let mut images = symmetry.images.clone();
        images.sort_unstable();
        assert!(images.into_iter().eq(0..part.strokes.len()), "{text}");
    }
}

fn at(primitive: &str, [x, y, z]: [f64; 3]) -> String {
    format!(r#"{{"prim": {primitive}, "transform": [{{"translate": [{x}, {y}, {z}]}}]}}"#)
}

fn block([x, y, z]: [f64; 3]) -> String {
    let middle = [-0.5 * x, -0.5 * y, -0.5 * z];
    at(&format!(r#""block", "size": [{x}, {y}, {z}]"#), middle)
}

fn cylinder(r: f64, h: f64, [x, y, z]: [f64; 3]) -> String {
    let primitive = format!(r#""cylinder", "r": {r}, "h": {h}"#);
    at(&primitive, [x, y, z - 0.5 * h])
}

fn less(body: &str, others: &[String]) -> String {
    of("difference", body, others)
}

fn of(op: &str, body: &str, others: &[String]) -> String {
    let mut text = format!(r#"{{"op": "{op}", "children": [{body}"#);
    for other in others {
        write!(text, ", {other}").unwrap();
    }
    text + "]}"
}

fn holes_about(count: u32) -> Vec<String> {
    let angle = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(count) + 0.3;
    let place = |k| [2.0 * angle(k).cos(), 2.0 * angle(k).sin(), 0.0];
    (0..count).map(|k| cylinder(0.4, 3.0, place(k))).collect()
}

#[test]
fn of_blocks() {
    check(&block([1.0, 2.0, 3.0]), 4, 0);
    check(&block([2.0, 2.0, 3.0]), 8, 0);
    check(&block([2.0, 2.0, 2.0]), 24, 0);
    // Two rims of a hole through the middle of the square sides.
    let hole = [cylinder(0.5, 9.0, [0.0; 3])];
    check(&less(&block([2.0, 2.0, 3.0]), &hole), 8, 1);
    // And off the middle.
    let hole = [cylinder(0.5, 9.0, [0.2, 0.1, 0.0])];
    check(&less(&block([2.0, 2.0, 3.0]), &hole), 1, 2);
    let hole = [cylinder(0.5, 9.0, [0.2, 0.0, 0.0])];
    check(&less(&block([2.0, 2.0, 3.0]), &hole), 2, 1);
}

/// Rows of nine holes have three kinds: the middle one, those at the corners and those between
/// them.
#[test]
fn of_plates_with_holes() {
    let places = [-1.0, 0.0, 1.0];
    let holes = places.map(|x| places.map(|y| cylinder(0.3, 9.0, [x, y, 0.0])));
    check(&less(&block([4.0, 4.0, 1.0]), &holes.concat()), 8, 3);
    let none_in_one_corner = &holes.concat()[1..];
    // The diagonal is an axis; eight holes on both sides, four of them on it.
    check(&less(&block([4.0, 4.0, 1.0]), none_in_one_corner), 2, 8);
}

/// A wedge has equal sides only where the two at the right angle have one length.
#[test]
fn of_wedges() {
    check(r#"{"prim": "wedge", "size": [1.0, 2.0, 3.0]}"#, 1, 0);
    check(r#"{"prim": "wedge", "size": [1.0, 3.0, 1.0]}"#, 2, 0);
}

/// Holes around an axis that is not the centre of the box.
#[test]
fn of_flanges() {
    let disc = cylinder(3.0, 1.0, [0.0; 3]);
    for count in [3, 4, 5, 6] {
        let holes = holes_about(count);
        check(&less(&disc, &holes), 2 * count as usize, 2);
        // With a boss on one side: both rims of holes and disc, and both edges of the boss.
        let boss = [cylinder(1.0, 2.0, [0.0, 0.0, 1.0])];
        let flange = of("union", &disc, &boss);
        check(&less(&flange, &holes), count as usize, 6);
    }
}

/// A part of revolution may be symmetric under a half turn across its axis.
#[test]
fn of_turned_parts() {
    let shaft = cylinder(1.0, 6.0, [0.0; 3]);
    check(&shaft, 2, 1);
    let collar = |z| [cylinder(2.0, 1.0, [0.0, 0.0, z])];
    check(&of("union", &shaft, &collar(0.0)), 2, 3);
    check(&of("union", &shaft, &collar(1.0)), 1, 6);
    // A hole across: its edges are no circles, and have their middles on a line with its own axis.
    let across = r#"{"prim": "cylinder", "r": 0.5, "h": 8, "transform": [{"translate": [0, 0, -4]}, {"rotate": [[1, 0, 0], 90]}]}"#;
    check(&less(&shaft, &[across.to_owned()]), 4, 1);
}

/// The sides differ only in the sense of a bulge: the edges alone do not distinguish them.
#[test]
fn of_a_bulge_and_a_hollow() {
    let ball = |z: f64| at(r#""sphere", "r": 1.0"#, [0.0, 0.0, z]);
    let both = of("union", &block([4.0, 4.0, 2.0]), &[ball(1.0), ball(-1.0)]);
    check(&both, 8, 1);
    let bulge = of("union", &block([4.0, 4.0, 4.0]), &[ball(2.0)]);
    check(&less(&bulge, &[ball(-2.0)]), 4, 2);
}

/// A ball or a ring next to a block has no edge, and is a part of the solid all the same.
#[test]
fn of_what_has_no_edges() {
    let lateral = [at(r#""sphere", "r": 0.5"#, [0.0, 5.0, 0.0])];
    check(&of("union", &block([2.0, 2.0, 3.0]), &lateral), 2, 0);
    let above = [at(r#""sphere", "r": 0.5"#, [0.0, 0.0, 5.0])];
    check(&of("union", &block([2.0, 2.0, 3.0]), &above), 4, 0);
    let ring = at(r#""torus", "R": 4.0, "r": 0.5"#, [0.0; 3]);
    check(&of("union", &block([2.0, 2.0, 3.0]), &[ring]), 8, 0);
    let shaft = cylinder(1.0, 4.0, [0.0; 3]);
    check(&of("union", &shaft, &above), 1, 2);
    // It is no longer a part of revolution, and the centroid of no edge determines the rotation.
    check(&of("union", &shaft, &lateral), 1, 2);
}

/// The largest and smallest units, and a hole that is off the middle by little more than the
/// tolerance.
#[test]
fn of_any_unit() {
    for unit in [1e-6, 1e6] {
        let block = block([2.0 * unit, 2.0 * unit, 3.0 * unit]);
        let hole = |x: f64| cylinder(0.5 * unit, 9.0 * unit, [x * unit, 0.0, 0.0]);
        check(&less(&block, &[hole(0.0)]), 8, 1);
        check(&less(&block, &[hole(1e-3)]), 2, 1);
    }
}
