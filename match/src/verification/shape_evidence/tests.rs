//! How many numbers of a shape are told, by hand: each by the logarithm of how much more carriers vary
//! from thing to thing than from part to part.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use super::*;
use crate::correspondence::predicted_contours::arcs;
use crate::part::detectability_prior::DetectabilityPrior;
use crate::pose::refine::refine;
use nalgebra::{Rotation3, Translation3, UnitQuaternion};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};

const CAMERA: Pinhole = Pinhole {
    focal: [2000.0, 2000.0],
    centre: [1023.5, 1023.5],
    skew: 0.0,
};
const SIZE: [usize; 2] = [2048, 2048];
/// What a number of a shape tells that is known as well as can be.
const NUMBER: f64 = 3.912;

fn evaluated(text: &str) -> Evaluation {
    let tree = read(
        "part",
        text.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    )
    .unwrap();
    evaluate(&tree.tree, &EvaluationOptions::default()).unwrap()
}

fn block(size: [f64; 3]) -> Evaluation {
    let [x, y, z] = size.map(|s| -0.5 * s);
    evaluated(&format!(
        r#"{{"prim": "block", "size": {size:?}, "transform": [{{"translate": [{x}, {y}, {z}]}}]}}"#
    ))
}

fn turned(x: f64, y: f64) -> Isometry3<f64> {
    let turn = Rotation3::from_euler_angles(x, y, 0.25);
    Isometry3::from_parts(
        Translation3::new(0.1, -0.2, 8.0),
        UnitQuaternion::from_rotation_matrix(&turn),
    )
}

/// What the edges of one part at a pose tell, taken for those of another.
fn told(seen: &Evaluation, taken: &Evaluation, pose: &Isometry3<f64>) -> ShapeEvidence {
    let learned = DetectabilityPrior::nothing();
    let [seen, taken] = [seen, taken].map(|e| SoughtPart::new(&e.brep, e.resolution, &learned));
    let [there, here] = [&seen, &taken].map(|p| arcs(p, &CAMERA, pose, SIZE).unwrap());
    assert_eq!(there.len(), here.len());
    let features: Vec<(ArcSource, Vec<PointToLine>)> = here
        .iter()
        .zip(&there)
        .map(|(a, b)| {
            // By share of its length, which is as near along an edge as is needed.
            let at = |k: usize| b.points[k * b.points.len() / a.points.len()].1.at;
            let weight = (2.0 + a.length / 24.0) / a.points.len() as f64;
            let pulls = a
                .points
                .iter()
                .enumerate()
                .map(|(k, (point, image))| PointToLine {
                    point: *point,
                    target: at(k),
                    normal: image.normal,
                    weight,
                });
            (a.source, pulls.collect())
        })
        .collect();
    let all: Vec<PointToLine> = features.iter().flat_map(|f| f.1.clone()).collect();
    let pose = refine(&CAMERA, pose, &all, 64.0, 20).unwrap().pose;
    let features = features.iter().map(|(s, p)| (*s, p.as_slice()));
    ShapeEvidence::told_by(&taken, &CAMERA, &pose, features)
}

/// How large its unit is, is no number of a shape.
#[test]
fn a_block_of_any_size_tells_as_much() {
    for unit in [1e-9, 1.0, 1e9] {
        let block = block([2.0, 1.5, 1.0].map(|side| side * unit));
        let mut pose = turned(0.6, 0.7);
        pose.translation.vector *= unit;
        let shape = told(&block, &block, &pose);
        assert!(
            (shape.determined - 2.0 * NUMBER).abs() < 0.1,
            "{unit}: {shape:?}"
        );
        assert!(shape.relief > 0.25, "{unit}: {shape:?}");
    }
}

/// A sphere's limb is that of any sphere, at some distance.
#[test]
fn a_limb_tells_nothing_of_a_sphere() {
    let sphere = evaluated(r#"{"prim": "sphere", "r": 1.0}"#);
    let shape = told(&sphere, &sphere, &turned(0.6, 0.7));
    assert!(shape.determined.abs() < 0.1 * NUMBER, "{shape:?}");
    assert!(shape.denied < 1e-6, "{shape:?}");
}

/// Six planes are six numbers, less three for where it is and one for how large: of its three sides
/// two, by that to the third.
#[test]
fn three_faces_tell_two_numbers_of_a_block() {
    let block = block([2.0, 1.5, 1.0]);
    let shape = told(&block, &block, &turned(0.6, 0.7));
    assert!((shape.determined - 2.0 * NUMBER).abs() < 0.1, "{shape:?}");
    assert!(shape.denied < 1e-6, "{shape:?}");
    assert!(shape.relief > 0.25, "{shape:?}");
}

/// Of five planes one: how long it is by how wide.
#[test]
fn a_face_tells_one_number_of_a_block() {
    let block = block([2.0, 1.5, 1.0]);
    let shape = told(&block, &block, &turned(0.0, 0.0));
    assert!((shape.determined - NUMBER).abs() < 0.1, "{shape:?}");
    assert!(shape.relief < 0.01, "{shape:?}");
}

/// It is that of any cylinder, at some distance.
#[test]
fn a_circle_tells_nothing_of_a_cylinder() {
    let cylinder = evaluated(r#"{"prim": "cylinder", "r": 1.0, "h": 1.0}"#);
    let shape = told(&cylinder, &cylinder, &turned(0.0, 0.0));
    assert!(shape.determined.abs() < 0.1 * NUMBER, "{shape:?}");
    assert!(shape.relief < 0.01, "{shape:?}");
}

/// A face with a hole in it: besides the block's own number where the hole is, by two, its radius, and by
/// its far rim how thick the plate is.
#[test]
fn a_flat_figure_tells_as_much_as_it_has() {
    let plate = evaluated(
        r#"{"op": "difference", "children": [
            {"prim": "block", "size": [2.0, 1.5, 0.2], "transform": [{"translate": [-1.0, -0.75, 0.0]}]},
            {"prim": "cylinder", "r": 0.3, "h": 2.0, "transform": [{"translate": [0.3, 0.2, -1.0]}]}
        ]}"#,
    );
    let shape = told(&plate, &plate, &turned(0.0, 0.0));
    assert!((shape.determined - 5.0 * NUMBER).abs() < 0.1, "{shape:?}");
}

/// Its edges deny a block that is longer by as much as things differ, and not by as much as parts do.
#[test]
fn edges_of_another_block_deny_this_one() {
    let (pose, this) = (turned(0.6, 0.7), block([2.0, 1.5, 1.0]));
    let alike = told(&block([2.005, 1.5, 1.0]), &this, &pose);
    assert!(
        alike.denied < 1.0 && alike.ratio() > 1.5 * NUMBER,
        "{alike:?}"
    );
    let another = told(&block([2.3, 1.5, 1.0]), &this, &pose);
    assert!(
        another.denied > 10.0 && another.ratio() < 0.0,
        "{another:?}"
    );
}

/// A block with a rod upon it has six planes, one at the rod's end, and the rod's own carrier. From a
/// corner the block's edges are of all its six, outlines being of faces that are turned away, too; the
/// rod's limbs and rims are of its two, and of the face that it stands on.
#[test]
fn carriers_are_counted_that_features_are_of() {
    let part = evaluated(
        r#"{"op": "union", "children": [
            {"prim": "block", "size": [2.0, 1.5, 1.0], "transform": [{"translate": [-1.0, -0.75, -0.5]}]},
            {"prim": "cylinder", "r": 0.3, "h": 1.0, "transform": [{"translate": [0.0, 0.0, 0.0]}]}
        ]}"#,
    );
    let learned = DetectabilityPrior::nothing();
    let part = SoughtPart::new(&part.brep, part.resolution, &learned);
    let all = arcs(&part, &CAMERA, &turned(2.2, 0.3), SIZE).unwrap();
    let visible: Vec<ArcSource> = all.iter().map(|arc| arc.source).collect();
    let count = |is: &dyn Fn(&[FaceId]) -> bool| {
        let there = visible.iter().filter(|s| is(&faces(&part, **s)));
        carriers(&part, there.copied()).len()
    };
    let is_flat = |f: &FaceId| matches!(part.brep.surface(*f), Surface::Plane(_));
    assert_eq!(count(&|_| true), 8);
    assert_eq!(count(&|f| f.iter().all(is_flat)), 6);
    assert_eq!(count(&|f| !f.iter().all(is_flat)), 3);
}
