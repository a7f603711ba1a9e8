//! Resource limits, and reproducibility.

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

/// A row of blocks, each over a third of the next one.
fn row(count: usize, y: i32) -> String {
    let block = |i: usize| {
        format!(
            "BLO(X=3, Y=3, Z={}) AT (MOVX={}, MOVY={y})",
            3 + i % 2,
            2 * i
        )
    };
    (0..count).map(block).collect::<Vec<_>>().join("\n UN ")
}

/// Each row has more curves and points than its share of the limit, and fewer than the limit.
#[test]
fn bodies_that_need_more_than_their_share_are_evaluated_one_by_one() {
    let rows = format!("P = ({}\n UN {})", row(24, 0), row(24, 10));
    let [few, most] = [6_000, 1 << 23].map(|limit| {
        let options = EvaluationOptions {
            entity_limit: Some(limit),
            ..EvaluationOptions::default()
        };
        let known = evaluated(&rows, Format::Padl, &options).unwrap();
        (known.brep.topology.census(), known.mass())
    });
    assert_eq!(few, most);
    assert_eq!(few.0.solids, 2);
    let least = EvaluationOptions {
        entity_limit: Some(100),
        ..EvaluationOptions::default()
    };
    let refused = evaluated(&rows, Format::Padl, &least).unwrap_err();
    assert!(
        matches!(refused, EvaluationError::EntityLimit { most: 100 }),
        "{refused}"
    );
}

#[test]
fn a_body_far_smaller_than_the_part_vanishes() {
    let text = "P = BLO(X=1, Y=1, Z=1) UN BLO(X=1e-60, Y=1e-60, Z=1e-60) AT (MOVX=3)";
    let known = evaluated(text, Format::Padl, &EvaluationOptions::default()).unwrap();
    assert_eq!(known.brep.topology.solids.len(), 1);
    assert!((known.mass().volume - 1.0).abs() < 1e-12);
}

/// Enough blocks that their boxes are sorted.
#[test]
fn sizes_and_resolutions_that_are_no_lengths_are_refused() {
    let blocks = row(40, 0);
    for resolution in [
        f64::NAN,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::MAX,
        -1.0,
        0.0,
    ] {
        let options = EvaluationOptions {
            resolution: Some(resolution),
            ..EvaluationOptions::default()
        };
        let refused = evaluated(&format!("P = ({blocks})"), Format::Padl, &options).unwrap_err();
        let is_named = matches!(refused, EvaluationError::Resolution { .. });
        assert!(is_named, "{resolution}: {refused}");
    }
    for exponent in ["e307", "e400", "e-320"] {
        let block = format!("BLO(X=3{exponent}, Y=3{exponent}, Z=3{exponent})");
        let at = |i: usize| format!("{block} AT (MOVX={}{exponent})", 4 * i);
        let all: Vec<String> = (0..40).map(at).collect();
        let text = format!("P = ({})", all.join("\n UN "));
        let refused = evaluated(&text, Format::Padl, &EvaluationOptions::default()).unwrap_err();
        assert!(
            matches!(refused, EvaluationError::Size),
            "{exponent}: {refused}"
        );
    }
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
