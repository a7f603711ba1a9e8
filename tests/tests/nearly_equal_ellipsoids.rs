//! Ellipsoids that differ by 1e-9 to 1e-7: the volumes of their union, intersection and differences add
//! up, and agree with formulas to the first order.

use approx::assert_relative_eq;
use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use std::f64::consts::PI;

/// The precision of volumes.
const PRECISION: f64 = 1e-13;

fn volume(text: &str) -> f64 {
    let text = format!("P = {text}");
    let tree = read(
        "p.padl",
        text.as_bytes(),
        Format::Padl,
        &ReadOptions::default(),
    );
    let tree = tree.unwrap().tree;
    let evaluation = evaluate(&tree, &EvaluationOptions::default());
    evaluation.unwrap().mass().volume
}

/// The volume of the union; those of the intersection and the difference have to fit.
fn union(a: &str, b: &str) -> f64 {
    let of = |op: &str| volume(&format!("{a} {op} {b}"));
    let [union, common, rest] = [of("UN"), of("INT"), of("DIF")];
    assert_relative_eq!(
        union + common,
        volume(a) + volume(b),
        max_relative = PRECISION
    );
    assert_relative_eq!(rest + common, volume(a), max_relative = PRECISION);
    union
}

/// Both nearly touch at both poles, and cross elsewhere; the poles were taken for all that they have in
/// common. The second is 6 d (s² + √2 s cos v) of volume per solid angle outside the first, with d = 1e-7
/// and s = sin u for the polar angle u, and v about it from the direction of the shift.
#[test]
fn wider_by_less_than_it_is_off_the_axis() {
    let union = union(
        "ELL((2,0,0),(0,2,0),(0,0,3))",
        "ELL((2+1e-7,0,0),(0,2+1e-7,0),(0,0,3)) AT (MOVX=1e-7,MOVY=-1e-7)",
    );
    let count = 2000;
    let inner = |u: f64| {
        let s = u.sin();
        s * s * ((2.0 - s * s).sqrt() + s * (-s / 2.0_f64.sqrt()).acos())
    };
    let sum: f64 = (0..count)
        .map(|k| inner(PI * (f64::from(k) + 0.5) / f64::from(count)))
        .sum();
    let outside = 12e-7 * sum * PI / f64::from(count);
    assert_relative_eq!(union, 16.0 * PI + outside, max_relative = PRECISION);
}

/// Conics within the resolution of both, which cross at an angle of 1e-8, were far from the curve; the
/// union had the volume of the smaller one. By a quadrature of what is outside of the first.
#[test]
fn crossing_at_a_small_angle() {
    let union = union(
        "ELL((3,0,0),(0,3,0),(0,0,2))",
        "ELL((3,0,0),(0,2.999999996927655,0),(0,0,1.99999999)) AT (ROTZ=-5.729577951308232e-07, MOVY=1.876683720294865e-09, MOVZ=-1e-8)",
    );
    assert_relative_eq!(union, 24.0 * PI + 6.3913e-8, max_relative = PRECISION);
}

/// The curve runs over a cone whose apex is 2e16 radii away. The box of the curve rounded to f64 did not
/// hold it, so the edge was lost, and the union was the second one. As unit spheres they are 1/2 apart; the
/// second is smaller by 1e-8/4 along x and 1e-8/3 along y, and outside the first where cos u > -1/4.
#[test]
fn similar_and_apart() {
    let union = union(
        "ELL((4,0,0),(0,3,0),(0,0,2))",
        "ELL((3.99999999,0,0),(0,2.99999999,0),(0,0,2)) AT (MOVX=-1e-8, MOVY=6.103329907647106e-9, MOVZ=1)",
    );
    let smaller = 24.0 * 2.0 * PI * 1e-8 * (1.0 / 4.0 + 1.0 / 3.0) / 2.0;
    let cap = 2.0 / 3.0 + 1.0 / 4.0 - 1.0 / 192.0;
    assert_relative_eq!(union, 43.75 * PI - smaller * cap, max_relative = PRECISION);
}
