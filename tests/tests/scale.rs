//! A part and its camera scaled by a power of two. Rounding is unchanged, so every number is scaled
//! by that power and every decision is the same.

use nalgebra::{Point3, Vector3};
use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_visibility::{ViewCamera, contours};

/// Lengths in S.
const PARTS: [&str; 4] = [
    "BLO(X=2*S, Y=2*S, Z=S) DIF CYL(R=S/2, H=3*S) AT (MOVX=S, MOVY=S, MOVZ=-S) UN TOR(RMAJ=3*S/2, RMIN=S/4) AT (MOVZ=S/2)",
    "CON(R=S, H=2*S) UN SPH(R=S) AT (MOVX=S, MOVZ=S) DIF CYL(R=S/2, H=4*S) AT (ROTX=30, MOVX=S/4, MOVZ=-S)",
    // A ball and a tube of one radius that miss each other's centre by a little.
    "(TOR(RMAJ=2*S, RMIN=S/2) UN SPH(R=S/2) AT (MOVX=2*S+S/1048576)) DIF CYL(R=S/4, H=2*S) AT (ROTX=31, MOVY=7*S/4)",
    "BLO(X=2*S, Y=2*S, Z=S) UN CYL(R=S/2, H=3*S) AT (MOVX=S/2+S/1073741824, MOVY=S) DIF SPH(R=S) AT (ROTX=10, MOVX=S, MOVY=S, MOVZ=2*S-S/1099511627776)",
];

/// What is the same in every unit.
struct Observed {
    /// The volume, the area and the centroid, in units of the scaled unit.
    measures: [f64; 5],
    /// The invisibility of every piece in two views.
    pieces: Vec<u32>,
}

fn observed(part: &str, exponent: i32) -> Observed {
    let size = 2.0_f64.powi(exponent);
    let power = 2.0_f64.powi(exponent.abs());
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
    let mass = known.mass();
    let [x, y, z] = mass.centroid.map(|x| x / size).coords.into();
    Observed {
        measures: [
            mass.volume / size.powi(3),
            mass.area / size.powi(2),
            x,
            y,
            z,
        ],
        pieces: pieces.collect(),
    }
}

fn alike(a: &Observed, b: &Observed) -> bool {
    let measures = a.measures.iter().zip(b.measures);
    let close = |(a, b): (&f64, f64)| (a - b).abs() <= 1.0 / f64::from(1 << 30);
    measures.into_iter().all(close) && a.pieces == b.pieces
}

#[test]
fn views_do_not_depend_on_the_unit() {
    for part in PARTS {
        let unscaled = observed(part, 0);
        assert!(
            unscaled
                .pieces
                .iter()
                .any(|&quantitative_invisibility| quantitative_invisibility > 0),
            "{part}"
        );
        for exponent in [-160, -100, -41, -20, 20, 41, 100, 160] {
            let scaled = observed(part, exponent);
            assert!(alike(&unscaled, &scaled), "{part} by 2^{exponent}");
        }
    }
}
