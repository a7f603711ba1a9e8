//! The solid to which a void belongs, and the points that solids contain.

use nalgebra::Point3;
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_kernel::brep::point_in_solid::contains;
use premio_kernel::geometry::surface::Surface;

fn evaluated(text: &str) -> Evaluation {
    let part = read(
        "part",
        text.as_bytes(),
        Format::Padl,
        &ReadOptions::default(),
    )
    .unwrap();
    evaluate(&part.tree, &EvaluationOptions::default()).unwrap()
}

/// The radius of a shell that consists of one sphere.
fn radius(known: &Evaluation, shell: usize) -> f64 {
    let [face] = *known.brep.topology.shells[shell].faces else {
        panic!("a sphere is one face");
    };
    let Surface::Sphere(sphere) = known.brep.surface(face) else {
        panic!("no sphere");
    };
    sphere.radius
}

/// A ball has no edge that limits the length of a ray from its hollow.
#[test]
fn a_hollow_ball_beside_a_ball() {
    for balls in [
        "SPH(R=1) AT (MOVX=-9) UN (SPH(R=4) DIF SPH(R=2))",
        "(SPH(R=4) DIF SPH(R=2)) UN SPH(R=1) AT (MOVX=-9)",
    ] {
        let known = evaluated(&format!("P = {balls}"));
        let solids = known.brep.topology.solids.iter();
        let mut radii: Vec<Vec<f64>> = solids
            .map(|s| s.shells.iter().map(|s| radius(&known, s.index())).collect())
            .collect();
        radii.sort_by_key(Vec::len);
        assert_eq!(radii, [vec![1.0], vec![4.0, 2.0]], "{balls}");
    }
}

#[test]
fn points_of_a_hollow_ball_and_a_ball() {
    let known = evaluated("P = SPH(R=1) AT (MOVX=-9) UN (SPH(R=4) DIF SPH(R=2))");
    let held = |x: f64| contains(&known.brep, &Point3::new(x, 0.1, 0.2), known.resolution);
    let places = [-20.0, -9.0, -6.0, -3.0, 0.0, 1.5, 3.0, 5.0].map(held);
    let expected = [false, true, false, true, false, false, true, false];
    assert_eq!(places, expected.map(Some));
}

/// The box of the frame contains the hollow of the block in its hole, but the frame does not, and
/// its volume is smaller.
#[test]
fn a_hollow_block_in_a_frame_in_a_hollow_block() {
    let known = evaluated(
        "P = (BLO(X=20, Y=20, Z=20) AT (MOVX=-10, MOVY=-10, MOVZ=-10)
             DIF BLO(X=16, Y=16, Z=16) AT (MOVX=-8, MOVY=-8, MOVZ=-8)
             UN (BLO(X=14, Y=14, Z=3) AT (MOVX=-7, MOVY=-7, MOVZ=-1.5)
                 DIF BLO(X=13, Y=13, Z=4) AT (MOVX=-6.5, MOVY=-6.5, MOVZ=-2))
             UN (BLO(X=12, Y=12, Z=12) AT (MOVX=-6, MOVY=-6, MOVZ=-6)
                 DIF BLO(X=1, Y=1, Z=1)))",
    );
    let solids = known.brep.topology.solids.iter();
    let mut shells: Vec<usize> = solids.map(|s| s.shells.len()).collect();
    shells.sort_unstable();
    assert_eq!(shells, [1, 2, 2]);
}
