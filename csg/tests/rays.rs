//! Rays through solids, against intervals and volumes by hand.

use crate::common::tree;
use nalgebra::{Point3, Vector3};
use premio_csg::builder::Builder;
use premio_csg::ray_casting::*;
use premio_csg::reader::Format;
use premio_kernel::geometry::bounds::Aabb;
use std::f64::consts::PI;

fn material(padl: &str) -> RayOracle {
    RayOracle::new(&tree(padl, Format::Padl))
}

fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
    Ray {
        origin: origin.into(),
        direction: direction.into(),
    }
}

fn assert_volume(padl: &str, volume: f64) {
    let estimate = material(padl).volume(20_000, 1);
    let deviation = estimate.deviation(volume, 1e-9 * volume);
    assert!(
        deviation < 5.0 && estimate.standard_error < 2e-3 * volume,
        "{padl}: {estimate:?} for {volume}"
    );
}

#[test]
fn volumes_of_primitives() {
    assert_volume("P = BLO(X=2, Y=3, Z=4)", 24.0);
    assert_volume("P = WED(X=2, Y=3, Z=4)", 12.0);
    assert_volume("P = CYL(R=2, H=3)", 12.0 * PI);
    assert_volume("P = CON(R=2, H=3)", 4.0 * PI);
    assert_volume("P = CON(R=2, R2=1, H=3)", 7.0 * PI);
    assert_volume("P = SPH(R=2)", 32.0 / 3.0 * PI);
    assert_volume("P = TOR(RMAJ=3, RMIN=1)", 6.0 * PI * PI);
    assert_volume("P = TOR(RMAJ=3, RMIN=2.9)", 2.0 * PI * PI * 3.0 * 2.9 * 2.9);
}

#[test]
fn volumes_of_operations() {
    let moved = "AT (ROTX=17, ROTZ=30, MOVX=5, MOVY=-3)";
    let drilled = "(BLO(X=4, Y=4, Z=4) DIF CYL(R=1, H=9) AT (MOVX=2, MOVY=2, MOVZ=-2))";
    assert_volume(&format!("P = {drilled} {moved}"), 64.0 - 4.0 * PI);
    let steinmetz = "CYL(R=1, H=4) AT (MOVZ=-2) INT CYL(R=1, H=4) AT (MOVZ=-2, ROTX=90)";
    assert_volume(&format!("P = ({steinmetz}) {moved}"), 16.0 / 3.0);
    let touching = "BLO(X=1, Y=1, Z=1) UN BLO(X=1, Y=1, Z=1) AT (MOVX=1)";
    assert_volume(&format!("P = ({touching}) {moved}"), 2.0);
    assert_volume("P = SPH(R=2) DIF SPH(R=1)", 28.0 / 3.0 * PI);
}

/// Small balls, two of them in the box: rays through the box of all of them hit none.
#[test]
fn small_parts_of_large_trees_are_measured() {
    let balls = material(
        "P = SPH(R=0.01) UN SPH(R=0.01) AT (MOVX=0.03) UN SPH(R=0.01) AT (MOVX=5, MOVY=5, MOVZ=5)",
    );
    let ball = 4e-6 / 3.0 * PI;
    let part = Aabb {
        min: [-0.01, -0.01, -0.01],
        max: [0.04, 0.01, 0.01],
    };
    assert_eq!(balls.volume(1000, 1).value, 0.0);
    let about = balls.volume_about(&part, 20_000, 1);
    assert!(about.deviation(2.0 * ball, 0.0) < 5.0, "{about:?}");
    assert!(about.standard_error < 1e-2 * ball, "{about:?}");
}

/// The parts inside and outside a box add up to the whole.
#[test]
fn volumes_about_a_box_are_whole() {
    let part = material("P = CYL(R=2, H=3) DIF SPH(R=1)");
    let volume = 12.0 * PI - 2.0 / 3.0 * PI;
    for (min, max) in [
        ([-1.0, -1.0, -1.0], [1.0, 0.5, 2.0]),
        ([-3.0, -3.0, -3.0], [3.0, 3.0, 5.0]),
        ([5.0, 5.0, 5.0], [6.0, 6.0, 6.0]),
    ] {
        let about = part.volume_about(&Aabb { min, max }, 20_000, 1);
        assert!(about.deviation(volume, 0.0) < 5.0, "{about:?}");
        assert!(about.standard_error < 2e-3 * volume, "{about:?}");
    }
}

#[test]
fn nothing_is_nothing() {
    let empty = material("P = SPH(R=1) INT SPH(R=1) AT (MOVX=3)");
    assert_eq!(empty.volume(1000, 1), Estimate::default());
    let builder = Builder::new();
    let none = RayOracle::new(&builder.finish(premio_csg::builder::SolidId::EMPTY).unwrap());
    assert_eq!(none.volume(1000, 1), Estimate::default());
    assert!(!none.contains(&Point3::origin()));
    assert!(
        none.intervals(&ray([0.0; 3], [1.0, 0.0, 0.0]), 0.0)
            .is_empty()
    );
}

fn assert_intervals(found: &[[f64; 2]], expected: &[[f64; 2]]) {
    let same = found.len() == expected.len()
        && found
            .iter()
            .flatten()
            .zip(expected.iter().flatten())
            .all(|(a, b)| (a - b).abs() < 1e-14);
    assert!(same, "{found:?} for {expected:?}");
}

#[test]
fn lines_through_a_torus() {
    let torus = material("P = TOR(RMAJ=3, RMIN=1)");
    let across = torus.intervals(&ray([-10.0, 0.0, 0.0], [1.0, 0.0, 0.0]), 0.0);
    assert_intervals(&across, &[[6.0, 8.0], [12.0, 14.0]]);
    let off_centre = torus.intervals(&ray([2.5, 0.0, 0.0], [0.0, 1.0, 0.0]), 0.0);
    let far = (16.0f64 - 6.25).sqrt();
    assert_intervals(&off_centre, &[[-far, far]]);
    let above = torus.intervals(&ray([0.0, 0.0, 5.0], [0.0, 0.0, -1.0]), 0.0);
    assert_intervals(&above, &[]);
    let tube = torus.intervals(&ray([3.0, 0.0, 5.0], [0.0, 0.0, -2.0]), 0.0);
    assert_intervals(&tube, &[[2.0, 3.0]]);
}

#[test]
fn lines_through_a_cone() {
    let cone = material("P = CON(R=1, H=1)");
    let at = |z: f64| cone.intervals(&ray([-2.0, 0.0, z], [1.0, 0.0, 0.0]), 0.0);
    assert_intervals(&at(0.25), &[[1.25, 2.75]]);
    assert_intervals(&at(1.5), &[]);
    // Along a generator's direction the equation is linear.
    let slanted = cone.intervals(&ray([0.0, 0.0, 0.0], [1.0, 0.0, 1.0]), 0.0);
    assert_intervals(&slanted, &[[0.0, 0.5]]);
    let axis = cone.intervals(&ray([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]), 0.0);
    assert_intervals(&axis, &[[1.0, 2.0]]);
}

#[test]
fn points_agree_with_lines() {
    let part = material(
        "A = BLO(X=4, Y=4, Z=4) DIF TOR(RMAJ=2, RMIN=1) AT (ROTX=30, MOVX=2, MOVY=2)
         B = A UN (CON(R=2, H=3) INT WED(X=2, Y=2, Z=2)) AT (MOVZ=3)",
    );
    for k in 0..500 {
        let at = |s: f64| f64::from(k) * s % 5.0;
        let origin = [at(0.7548) - 0.3, at(0.5698) - 0.3, at(0.3819) - 0.6];
        let found = part.intervals(&ray(origin, [0.3, 0.5, -0.2]), 0.0);
        let inside = found.iter().any(|i| i[0] < 0.0 && 0.0 < i[1]);
        assert_eq!(part.contains(&origin.into()), inside, "{origin:?}");
    }
}

#[test]
fn gaps_are_closed() {
    let part = material("P = BLO(X=1, Y=1, Z=1) UN BLO(X=1, Y=1, Z=1) AT (MOVX=1.001)");
    let line = ray([-1.0, 0.5, 0.5], [1.0, 0.0, 0.0]);
    assert_eq!(part.intervals(&line, 0.0).len(), 2);
    assert_intervals(&part.intervals(&line, 0.01), &[[1.0, 3.001]]);
}

/// The faces in front of a point of a part of the given size, seen from far above.
fn from_above(part: &RayOracle, size: f64, point: [f64; 3]) -> SightEvidence {
    let up = |_: &Point3<f64>| SightSegment {
        towards: Vector3::z(),
        length: f64::INFINITY,
    };
    let clearance = Clearance {
        sliver: 1e-9,
        lateral: 1e-6,
        shift: 0.0,
        size,
    };
    part.invisibility(&point.into(), up, &clearance)
}

#[test]
fn faces_before_a_point() {
    let part =
        material("P = BLO(X=2, Y=2, Z=2) UN BLO(X=1, Y=1, Z=1) AT (MOVX=0.5, MOVY=0.5, MOVZ=4)");
    let count = |x, y, z| from_above(&part, 6.0, [x, y, z]);
    // On the upper and the lower block's top edges, on the lower block's bottom.
    assert_eq!(count(0.5, 0.7, 5.0), SightEvidence::Count(0));
    assert_eq!(count(0.2, 0.0, 2.0), SightEvidence::Count(0));
    assert_eq!(count(0.2, 0.2, 0.0), SightEvidence::Count(1));
    assert_eq!(count(0.7, 0.7, 0.0), SightEvidence::Count(2));
    // Below the upper block's edge; along the lower block's side.
    assert_eq!(count(0.5, 0.7, 2.0), SightEvidence::Mixed);
    assert_eq!(count(0.0, 0.7, 0.0), SightEvidence::Mixed);
}

#[test]
fn a_fold_next_to_a_point_is_not_told_from_its_own() {
    let part = material("P = CYL(R=1, H=2) AT (ROTY=90)");
    let count = |x, y, z| from_above(&part, 4.0, [x, y, z]);
    // On the limb; 1e-18 from it in the image, below it; well below it; on top.
    assert_eq!(count(1.0, 1.0, 0.0), SightEvidence::Fold(0));
    assert_eq!(count(1.0, 1.0, -1e-9), SightEvidence::Fold(0));
    assert_eq!(count(1.0, 0.8, -0.6), SightEvidence::Count(1));
    assert_eq!(count(1.0, 0.8, 0.6), SightEvidence::Count(0));
}

/// A cone that stands on a second one with the same rim, 1e-5 below. Lines of sight inside the rim
/// leave the lower one right above the point, and the upper one right above that.
#[test]
fn a_face_behind_an_own_one_is_close() {
    let part = material("P = CON(R=0.5, H=3) UN CON(R=0.5, H=1.5) AT (MOVZ=-0.00001)");
    let below = from_above(&part, 4.0, [0.5 + 1e-12, 0.0, -1e-5]);
    assert_eq!(below, SightEvidence::Close);
    let above = from_above(&part, 4.0, [0.5 + 1e-12, 0.0, 0.0]);
    assert_eq!(above, SightEvidence::Count(0));
}

#[test]
fn a_thousand_primitives() {
    let balls: Vec<String> = (0..1000)
        .map(|i| {
            let (x, y, z) = (i % 10, i / 10 % 10, i / 100);
            format!("SPH(R=0.4) AT (MOVX={x}, MOVY={y}, MOVZ={z})")
        })
        .collect();
    let volume = 1000.0 * 4.0 / 3.0 * PI * 0.064;
    assert_volume(&format!("P = {}", balls.join(" UN ")), volume);
}
