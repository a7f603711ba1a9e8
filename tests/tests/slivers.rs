//! The volumes of slivers in f64, against closed forms. They are accurate as far as the rounding of
//! coordinates permits for the thickness.

use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use std::error::Error;
use std::f64::consts::PI;

/// A sliver in PADL with the thickness `D`, its size, and its volume as a function of the
/// thickness.
type Sliver = (&'static str, f64, fn(f64) -> f64);

#[rustfmt::skip]
const SLIVERS: [Sliver; 13] = [
    ("BLO(X=3,Y=2,Z=D)", 3.0, |d| 6.0 * d),
    ("(CYL(R=2,H=4)) INT (BLO(X=4,Y=4,Z=4) AT (MOVX=2-D,MOVY=-2))", 4.0, |d| 4.0 * segment(2.0, d)),
    ("(CYL(R=1+D,H=2)) DIF (CYL(R=1,H=2))", 3.0, |d| 2.0 * PI * (2.0 + d) * d),
    ("(CON(R=1,H=1)) DIF (CON(R=1,H=1-D))", 2.0, |d| PI / 3.0 * d),
    ("(CON(R=1,H=1)) INT (CYL(R=1,H=D) AT (MOVZ=0.5))", 2.0, |d| PI * d * (0.25 - 0.5 * d + d * d / 3.0)),
    ("(SPH(R=2)) INT (BLO(X=4,Y=4,Z=4) AT (MOVX=-2,MOVY=-2,MOVZ=2-D))", 4.0, |d| PI / 3.0 * d * d * (6.0 - d)),
    ("(SPH(R=2)) INT (BLO(X=4,Y=4,Z=D) AT (MOVX=-2,MOVY=-2,MOVZ=1))", 4.0, |d| PI * d * (3.0 - d - d * d / 3.0)),
    ("(SPH(R=2+D)) DIF (SPH(R=2))", 4.0, |d| 4.0 / 3.0 * PI * (12.0 + 6.0 * d + d * d) * d),
    ("(SPH(R=2)) INT (SPH(R=2) AT (MOVX=4-D))", 4.0, |d| PI / 12.0 * d * d * (12.0 - d)),
    ("(TOR(RMAJ=3,RMIN=1)) INT (BLO(X=20,Y=20,Z=4) AT (MOVX=-10,MOVY=-10,MOVZ=1-D))", 8.0, |d| 6.0 * PI * segment(1.0, d)),
    ("(TOR(RMAJ=3,RMIN=1)) DIF (CYL(R=4-D,H=4) AT (MOVZ=-2))", 8.0, |d| 6.0 * PI * segment(1.0, d) + 4.0 / 3.0 * PI * (2.0 * d - d * d).powf(1.5)),
    ("(TOR(RMAJ=3,RMIN=1)) INT (CYL(R=2+D,H=4) AT (MOVZ=-2))", 8.0, |d| 6.0 * PI * segment(1.0, d) - 4.0 / 3.0 * PI * (2.0 * d - d * d).powf(1.5)),
    ("(TOR(RMAJ=3,RMIN=1+D)) DIF (TOR(RMAJ=3,RMIN=1))", 8.0, |d| 6.0 * PI * PI * (2.0 + d) * d),
];

/// The area of the segment of a circle, from its height.
fn segment(radius: f64, height: f64) -> f64 {
    // A power series of θ − sin θ in the angle θ, so that nothing cancels.
    let half = (height / (2.0 * radius)).sqrt().asin();
    let angle = 4.0 * half;
    let mut term = angle.powi(3) / 6.0;
    let mut sum = 0.0;
    for k in 2..40 {
        sum += term;
        let n = f64::from(2 * k);
        term *= -angle * angle / (n * (n + 1.0));
    }
    0.5 * radius * radius * sum
}

#[test]
fn slivers_have_their_volume() -> Result<(), Box<dyn Error>> {
    for (solid, size, volume) in SLIVERS {
        for digits in 2..=9 {
            let thickness = 10_f64.powi(-digits);
            let text = format!("D = {thickness:.10}\nP = {solid}\n");
            let tree = read(
                "part",
                text.as_bytes(),
                Format::Padl,
                &ReadOptions::default(),
            )?
            .tree;
            let part = evaluate(&tree, &EvaluationOptions::default())?;
            let known = volume(thickness);
            let off = (part.mass().volume / known - 1.0).abs();
            let rounding = f64::EPSILON * size / thickness;
            assert!(off < rounding, "{solid} by {thickness:e}: {off:e}");
        }
    }
    Ok(())
}
