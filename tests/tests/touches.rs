//! Points where a boundary touches itself: a ball is placed against a known point of each
//! primitive.

use nalgebra::{Point3, Vector3};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use proptest::prelude::*;
use serde_json::{Value, json};
use std::f64::consts::TAU;

/// The entity that the ball touches.
#[derive(Clone, Copy, Debug)]
enum Place {
    /// The interior of a face.
    Face,
    /// The interior of an edge.
    Edge,
    /// The apex of a cone, or a corner of a block.
    Corner,
}

/// A primitive with a point of its boundary and a direction outwards, in its own frame.
fn spot(kind: usize, place: Place, u: f64, v: f64) -> Option<(Value, [f64; 3], [f64; 3])> {
    let (sin, cos) = (TAU * u).sin_cos();
    let (s, c) = (TAU * v).sin_cos();
    let diagonal = [0.6 * cos, 0.6 * sin, -0.8];
    Some(match (kind, place) {
        (0, Place::Face) => (
            json!({"prim": "block", "size": [4, 3, 2]}),
            [0.5 + 3.0 * u, 0.5 + 2.0 * v, 2.0],
            [0.0, 0.0, 1.0],
        ),
        (0, Place::Edge) => (
            json!({"prim": "block", "size": [4, 3, 2]}),
            [0.5 + 3.0 * u, 3.0, 2.0],
            [0.0, 0.8, 0.6],
        ),
        (0, Place::Corner) => (
            json!({"prim": "block", "size": [4, 3, 2]}),
            [4.0, 3.0, 2.0],
            [2.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0],
        ),
        (1, Place::Face) => (
            json!({"prim": "cylinder", "r": 2, "h": 3}),
            [2.0 * cos, 2.0 * sin, 0.5 + 2.0 * v],
            [cos, sin, 0.0],
        ),
        (1, Place::Edge) => (
            json!({"prim": "cylinder", "r": 2, "h": 3}),
            [2.0 * cos, 2.0 * sin, 0.0],
            diagonal,
        ),
        (2, Place::Face) => {
            let h = 0.5 + 3.0 * v;
            (
                json!({"prim": "cone", "r": 3, "h": 4}),
                [0.75 * (4.0 - h) * cos, 0.75 * (4.0 - h) * sin, h],
                [0.8 * cos, 0.8 * sin, 0.6],
            )
        }
        (2, Place::Edge) => (
            json!({"prim": "cone", "r": 3, "h": 4}),
            [3.0 * cos, 3.0 * sin, 0.0],
            diagonal,
        ),
        (2, Place::Corner) => (
            json!({"prim": "cone", "r": 3, "h": 4}),
            [0.0, 0.0, 4.0],
            [0.28 * cos, 0.28 * sin, 0.96],
        ),
        (3, Place::Face) => (
            json!({"prim": "sphere", "r": 2}),
            [2.0 * cos * c, 2.0 * sin * c, 2.0 * s],
            [cos * c, sin * c, s],
        ),
        // On the side of the hole a ball of this size would reach the opposite side.
        (4, Place::Face) if c > 0.0 => (
            json!({"prim": "torus", "R": 3, "r": 1}),
            [(3.0 + c) * cos, (3.0 + c) * sin, s],
            [cos * c, sin * c, s],
        ),
        _ => return None,
    })
}

fn places() -> impl Strategy<Value = Place> {
    prop_oneof![Just(Place::Face), Just(Place::Edge), Just(Place::Corner)]
}

/// The primitive and a ball at the distance `gap` from its point, rotated together.
fn part(solid: &Value, at: [f64; 3], out: [f64; 3], gap: f64, turn: f64) -> Evaluation {
    let r = 0.75;
    let centre: [f64; 3] = std::array::from_fn(|i| at[i] + out[i] * (r + gap));
    let ball = json!({"prim": "sphere", "r": r, "transform": [{"translate": centre}]});
    let both = json!({"op": "union", "children": [solid, ball],
        "transform": [{"rotate": [[1, 2, 3], turn]}]});
    let text = both.to_string();
    let read = read(
        "part",
        text.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    );
    evaluate(&read.unwrap().tree, &EvaluationOptions::default()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]
    #[test]
    fn a_ball_touches_in_one_point_or_not_at_all(
        kind in 0usize..5, place in places(), u in 0.0..1.0, v in 0.0..1.0, turn in 0.0..360.0,
    ) {
        let Some((solid, at, out)) = spot(kind, place, u, v) else {
            return Ok(());
        };
        let touching = part(&solid, at, out, 0.0, turn);
        let topology = &touching.brep.topology;
        prop_assert_eq!(topology.touches.len(), 1, "{} {:?}", solid, at);
        prop_assert_eq!(topology.solids.len(), 2);
        prop_assert!(touching.violations().is_empty());
        let touch = &topology.touches[0];
        let expected = match place {
            Place::Face => (0, 0, 2),
            Place::Edge => (0, 1, 1),
            // The apex of a cone is in the interior of its face.
            Place::Corner if kind == 2 => (0, 0, 2),
            Place::Corner => (1, 0, 1),
        };
        prop_assert_eq!((touch.fans, touch.edges.len(), touch.faces.len()), expected);
        let from = |p: &Point3<f64>| (p - Point3::origin()).norm();
        let far = Vector3::from(at).norm() - from(&touching.brep.geometry.touches[0]);
        prop_assert!(far.abs() < touching.resolution, "{far:e}");
        // With a small gap or overlap they are separate or one.
        for (gap, solids) in [(1e-3, 2), (-1e-3, 1)] {
            let moved = part(&solid, at, out, gap, turn);
            prop_assert_eq!(moved.brep.topology.solids.len(), solids);
            prop_assert!(moved.brep.topology.touches.is_empty());
            prop_assert!(moved.decisions.close_calls.is_empty());
        }
    }
}

/// Two tori touch at (3, 0, 0). The bottom of a cylinder ends close to that point, in a plane five
/// resolutions above. Its plane intersects both tori in one point, which is not on the boundary.
#[test]
fn what_lies_next_to_a_touch_is_no_other() {
    let torus =
        |x: f64| json!({"prim": "torus", "R": 2, "r": 1, "transform": [{"translate": [x, 0, 0]}]});
    let cylinder = json!({"prim": "cylinder", "r": 0.5, "h": 0.1,
        "transform": [{"translate": [3.4, 0.4, 7e-10]}]});
    let all = json!({"op": "union", "children": [torus(0.0), torus(6.0), cylinder]});
    let text = all.to_string();
    let read = read(
        "part",
        text.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    );
    let part = evaluate(&read.unwrap().tree, &EvaluationOptions::default()).unwrap();
    let places = &part.brep.geometry.touches;
    let [place] = places.as_slice() else {
        panic!("{places:?}")
    };
    assert!((place - Point3::new(3.0, 0.0, 0.0)).norm() < part.resolution);
    assert!(part.decisions.close_calls.is_empty());
}
