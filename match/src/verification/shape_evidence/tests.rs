//! The number of shape parameters that a match determines, derived by hand. Each counts the
//! logarithm of the ratio of a carrier's deviation from thing to thing and from part to part.
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
/// The evidence of one fully determined shape parameter.
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

/// The evidence of the edges of one part at a pose, assigned to another part.
fn evidence(seen: &Evaluation, taken: &Evaluation, pose: &Isometry3<f64>) -> ShapeEvidence {
    let learned = DetectabilityPrior::nothing();
    let [seen, taken] = [seen, taken].map(|e| SoughtPart::new(&e.brep, e.resolution, &learned));
    let [there, here] = [&seen, &taken].map(|p| arcs(p, &CAMERA, pose, SIZE).unwrap());
    assert_eq!(there.len(), here.len());
    let features: Vec<(ArcSource, Vec<PointToLine>)> = here
        .iter()
        .zip(&there)
        .map(|(a, b)| {
            // The point at the same share of the length, which is close enough along an edge.
            let at = |k: usize| b.points[k * b.points.len() / a.points.len()].image.at;
            let weight = (2.0 + a.length / 24.0) / a.points.len() as f64;
            let pulls = a.points.iter().enumerate().map(|(k, sample)| PointToLine {
                point: sample.point,
                target: at(k),
                normal: sample.image.normal,
                weight,
            });
            (a.source, pulls.collect())
        })
        .collect();
    let all: Vec<PointToLine> = features.iter().flat_map(|f| f.1.clone()).collect();
    let pose = refine(&CAMERA, pose, &all, 64.0, 20).unwrap().pose;
    let features = features.iter().map(|(source, pulls)| FittedFeature {
        source: *source,
        pulls,
    });
    ShapeEvidence::from_edges(&taken, &CAMERA, &pose, features)
}

/// The unit of length is no shape parameter.
#[test]
fn the_size_of_a_block_does_not_change_its_evidence() {
    for unit in [1e-9, 1.0, 1e9] {
        let block = block([2.0, 1.5, 1.0].map(|side| side * unit));
        let mut pose = turned(0.6, 0.7);
        pose.translation.vector *= unit;
        let shape = evidence(&block, &block, &pose);
        assert!(
            (shape.determined - 2.0 * NUMBER).abs() < 0.1,
            "{unit}: {shape:?}"
        );
        assert!(shape.relief > 0.25, "{unit}: {shape:?}");
    }
}

/// A sphere's limb is that of a sphere of any radius at some distance.
#[test]
fn a_limb_does_not_determine_a_sphere() {
    let sphere = evaluated(r#"{"prim": "sphere", "r": 1.0}"#);
    let shape = evidence(&sphere, &sphere, &turned(0.6, 0.7));
    assert!(shape.determined.abs() < 0.1 * NUMBER, "{shape:?}");
    assert!(shape.denied < 1e-6, "{shape:?}");
}

/// Six planes have six parameters. The position takes three and the size one. Two remain: the
/// ratios of the sides.
#[test]
fn three_faces_determine_two_parameters_of_a_block() {
    let block = block([2.0, 1.5, 1.0]);
    let shape = evidence(&block, &block, &turned(0.6, 0.7));
    assert!((shape.determined - 2.0 * NUMBER).abs() < 0.1, "{shape:?}");
    assert!(shape.denied < 1e-6, "{shape:?}");
    assert!(shape.relief > 0.25, "{shape:?}");
}

/// Of five planes one parameter remains: the ratio of length to width.
#[test]
fn a_face_determines_one_parameter_of_a_block() {
    let block = block([2.0, 1.5, 1.0]);
    let shape = evidence(&block, &block, &turned(0.0, 0.0));
    assert!((shape.determined - NUMBER).abs() < 0.1, "{shape:?}");
    assert!(shape.relief < 0.01, "{shape:?}");
}

/// The circle is that of a cylinder of any radius at some distance.
#[test]
fn a_circle_does_not_determine_a_cylinder() {
    let cylinder = evaluated(r#"{"prim": "cylinder", "r": 1.0, "h": 1.0}"#);
    let shape = evidence(&cylinder, &cylinder, &turned(0.0, 0.0));
    assert!(shape.determined.abs() < 0.1 * NUMBER, "{shape:?}");
    assert!(shape.relief < 0.01, "{shape:?}");
}

/// A face with a hole: besides the block's own parameter, the hole's position has two, its radius
/// one, and its far rim gives the thickness of the plate.
#[test]
fn a_flat_figure_determines_its_own_parameters() {
    let plate = evaluated(
        r#"{"op": "difference", "children": [
            {"prim": "block", "size": [2.0, 1.5, 0.2], "transform": [{"translate": [-1.0, -0.75, 0.0]}]},
            {"prim": "cylinder", "r": 0.3, "h": 2.0, "transform": [{"translate": [0.3, 0.2, -1.0]}]}
        ]}"#,
    );
    let shape = evidence(&plate, &plate, &turned(0.0, 0.0));
    assert!((shape.determined - 5.0 * NUMBER).abs() < 0.1, "{shape:?}");
}

/// The edges are evidence against a block that is longer by as much as things differ, and not
/// against one that is longer by as much as parts differ.
#[test]
fn edges_of_another_block_count_against_this_one() {
    let (pose, this) = (turned(0.6, 0.7), block([2.0, 1.5, 1.0]));
    let alike = evidence(&block([2.005, 1.5, 1.0]), &this, &pose);
    assert!(
        alike.denied < 1.0 && alike.ratio() > 1.5 * NUMBER,
        "{alike:?}"
    );
    let another = evidence(&block([2.3, 1.5, 1.0]), &this, &pose);
    assert!(
        another.denied > 10.0 && another.ratio() < 0.0,
        "{another:?}"
    );
}

/// A block with a rod on it has six planes, a plane at the rod's end, and the rod's cylinder. From
/// a corner the block's visible edges belong to all six planes, because outlines also belong to
/// faces turned away. The rod's limbs and rims belong to its two carriers and to the face that it
/// stands on.
#[test]
fn carriers_of_visible_features_are_counted() {
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
