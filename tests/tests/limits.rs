//! Resource limits, and reproducibility.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use nalgebra::Vector3;
use premio_csg::evaluate::{Evaluation, EvaluationError, EvaluationOptions, evaluate};
use premio_csg::object_model::ObjectModel;
use premio_csg::reader::{Format, ReadOptions, read};
use premio_tests::random;
use premio_visibility::{ViewCamera, contours};

fn evaluated(
    text: &str,
    format: Format,
    options: &EvaluationOptions,
) -> Result<Evaluation, EvaluationError> {
    let part = read("part", text.as_bytes(), format, &ReadOptions::default()).unwrap();
    evaluate(&part.tree, options)
}

#[test]
fn more_places_than_the_limit_are_refused_by_name() {
    // Six faces each: more than ten pairs, and fewer than a thousand.
    let blocks = "P = BLO(X=2,Y=2,Z=2) UN BLO(X=2,Y=2,Z=2) AT (MOVX=1,MOVY=1,MOVZ=1)";
    let within = |entities| {
        let options = EvaluationOptions {
            entity_limit: Some(entities),
            ..EvaluationOptions::default()
        };
        evaluated(blocks, Format::Padl, &options)
    };
    for most in [0, 10, 30, 50] {
        let refused = within(most).unwrap_err();
        let is_named = matches!(&refused, EvaluationError::EntityLimit { most: reported } if *reported == most);
        assert!(is_named, "{refused}");
        assert!(refused.to_string().contains(&most.to_string()));
    }
    assert_eq!(within(1000).unwrap().brep.topology.faces.len(), 12);
}

/// If each were paired with each, there would be four hundred million pairs.
#[test]
fn equal_primitives_are_held_against_others_once() {
    let many = vec!["CYL(R=1, H=2)"; 20_000].join("\n UN ");
    let text = format!("P = (({many})\n UN BLO(X=2, Y=2, Z=1))");
    let known = evaluated(&text, Format::Padl, &EvaluationOptions::default()).unwrap();
    assert_eq!(known.brep.topology.solids.len(), 1);
    assert_eq!(known.brep.topology.faces.len(), 8);
}

/// The object model and a view of it, as written.
fn written(seed: u64) -> [String; 2] {
    let text = random::tree(seed).to_string();
    let known = evaluated(&text, Format::Json, &EvaluationOptions::default()).unwrap();
    let target = nalgebra::center(&known.bounds.min.into(), &known.bounds.max.into());
    let eye = target + Vector3::new(1.7, -2.1, 1.3) * known.bounds.diagonal();
    let camera = ViewCamera::perspective(eye, target, Vector3::z(), 1.0).unwrap();
    let seen = contours(&known.brep, &camera, known.resolution).unwrap();
    let drawn = (&seen.contours, &seen.junctions);
    [
        serde_json::to_string(&ObjectModel::new(&known.brep)).unwrap(),
        serde_json::to_string(&drawn).unwrap(),
    ]
}

/// Hashing has a new seed in every thread.
#[test]
fn what_is_written_is_the_same_in_every_thread_and_run() {
    let all = || (0..12).map(written).collect::<Vec<_>>();
    let here = all();
    let there: Vec<_> = (0..3).map(|_| std::thread::spawn(all)).collect();
    for run in there {
        assert!(run.join().unwrap() == here);
    }
}
