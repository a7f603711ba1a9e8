//! A part and its camera scaled by a power of two. Rounding is unchanged, so every number is scaled
//! by that power and every decision is the same.
#![allow(clippy::unwrap_used, missing_docs, reason = "a test fails by it")]

use nalgebra::{Point3, Vector3};
use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_visibility::{ViewCamera, contours};

/// Lengths in S.
const PARTS: [&str; 2] = [
    "BLO(X=2*S, Y=2*S, Z=S) DIF CYL(R=S/2, H=3*S) AT (MOVX=S, MOVY=S, MOVZ=-S) UN TOR(RMAJ=3*S/2, RMIN=S/4) AT (MOVZ=S/2)",
    "CON(R=S, H=2*S) UN SPH(R=S) AT (MOVX=S, MOVZ=S) DIF CYL(R=S/2, H=4*S) AT (ROTX=30, MOVX=S/4, MOVZ=-S)",
];

/// The volume in units of the scaled unit, and the invisibility of every piece in two views.
type Observed = (f64, Vec<u32>);

fn observed(part: &str, exponent: i32) -> Observed {
    let size = 2.0_f64.powi(exponent);
    let power = 1_u128 << exponent.unsigned_abs();
    let scale = match exponent < 0 {
        true => format!("1/{power}"),
        false => power.to_string(),
    };
    let text = format!("S = {scale}\nP = {part}");
    let read = read(
        "part",
        text.as_bytes(),
        Format::Padl,
        &ReadOptions::default(),
    )
    .unwrap();
    let known = evaluate(&read.tree, &EvaluationOptions::default()).unwrap();
    let at = |x: f64, y: f64, z: f64| Point3::new(size * x, size * y, size * z);
    let (eye, target) = (at(2.5, 5.5, -0.75), at(0.125, 0.125, 0.5));
    let cameras = [
        ViewCamera::orthographic(eye, target, Vector3::z()).unwrap(),
        ViewCamera::perspective(eye, target, Vector3::z(), 1.0).unwrap(),
    ];
    let pieces = cameras.iter().flat_map(|camera| {
        let seen = contours(&known.brep, camera, known.resolution).unwrap();
        let pieces = seen.contours.into_iter().flat_map(|c| c.pieces);
        pieces
            .map(|p| p.quantitative_invisibility)
            .collect::<Vec<_>>()
    });
    (known.mass().volume / size.powi(3), pieces.collect())
}

fn alike((volume, pieces): &Observed, (other, others): &Observed) -> bool {
    (volume - other).abs() <= volume / f64::from(1 << 30) && pieces == others
}

#[test]
fn views_do_not_depend_on_the_unit() {
    for part in PARTS {
        let unscaled = observed(part, 0);
        assert!(
            unscaled
                .1
                .iter()
                .any(|&quantitative_invisibility| quantitative_invisibility > 0),
            "{part}"
        );
        for exponent in [-100, -41, -20, 20, 41, 100] {
            let scaled = observed(part, exponent);
            assert!(alike(&unscaled, &scaled), "{part} by 2^{exponent}");
        }
    }
}
