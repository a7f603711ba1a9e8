//! Holes in the side of a cone, close to its apex. Most of such a loop lies above the hole, and
//! little of it below, where the face continues to the apex.

use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};

/// A cone with its base about the origin, rotated about y, and a cylinder of the given radius out
/// of its side. The distance of the apex from the cylinder's axis is the sine of the angle.
fn pierced(turn: f64, radius: f64) -> String {
    format!("P = CON(R=1, H=1) AT (ROTY={turn}) UN CYL(R={radius}, H=1)")
}

#[test]
fn a_hole_next_to_an_apex_is_no_face() {
    for turn in [14.0_f64, 15.0, 16.0, 17.0, 18.0, 19.0, 20.0] {
        for part in [0.7, 0.8, 0.85, 0.9, 0.95, 0.99, 0.999] {
            let text = pierced(turn, part * turn.to_radians().sin());
            let part = read(
                "part",
                text.as_bytes(),
                Format::Padl,
                &ReadOptions::default(),
            )
            .unwrap();
            let known = evaluate(&part.tree, &EvaluationOptions::default()).unwrap();
            assert_eq!(known.violations(), [], "{text}");
            // The bases of both, half of the cylinder's under the cone, its side twice.
            let counted = &known.brep.topology;
            assert_eq!(
                (counted.solids.len(), counted.faces.len()),
                (1, 6),
                "{text}"
            );
        }
    }
}
