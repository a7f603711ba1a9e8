//! Relations between surfaces that f64 cannot decide, and more bits can.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::region_of_interest::RegionOfInterest;
use premio_kernel::geometry::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};
use premio_kernel::geometry::surface_pair::{Carrier, Coefficients, PairMeasure, SurfacePair};
use premio_kernel::number::predicates::{CertifiedDistance, Predicates, Side};
use premio_kernel::number::rational::{Rational, from_f64, to_f64};
use proptest::prelude::*;

const EXTENT: RegionOfInterest = RegionOfInterest {
    centre: Point3::new(0.5, -0.25, 1.0),
    radius: 8.0,
};

fn exact(x: f64) -> Rational {
    from_f64(x).unwrap()
}

/// Two to the power of -k.
fn tiny(k: usize) -> Rational {
    Rational::from_parts(1.into(), dashu::integer::UBig::ONE << k)
}

#[test]
fn the_edge_of_the_band_is_told_by_more_bits() {
    let (resolution, radius) = (exact(0.5f64.powi(30)), exact(1.25));
    // A normal of length 7/3; no component of the unit normal is an f64.
    let third = |n: i32| Rational::from_parts(n.into(), 3u8.into());
    let (normal, length) = ([2, 3, 6].map(third), third(7));
    let plane = Coefficients {
        point: [0.0; 3].map(exact),
        direction: normal.clone(),
        size: exact(0.0),
        tube: exact(0.0),
    };
    for (beyond, side) in [
        (tiny(80), Side::Outside),
        (-tiny(80), Side::On),
        (exact(0.0), Side::On),
    ] {
        let height = &radius + &resolution * (exact(1.0) + beyond);
        let sphere = Coefficients {
            point: normal.each_ref().map(|c| c * &height / &length),
            direction: [0.0, 0.0, 1.0].map(exact),
            size: radius.clone(),
            tube: exact(0.0),
        };
        let [p, s] = [&plane, &sphere].map(rounded);
        let p = Surface::Plane(Plane { frame: p });
        let s = Surface::Sphere(Sphere {
            frame: s,
            radius: to_f64(&radius),
        });
        let (of_plane, of_sphere) = (|| plane.clone(), || sphere.clone());
        let pair = SurfacePair::new(
            Carrier::rounded(&p, &of_plane),
            Carrier::rounded(&s, &of_sphere),
            &EXTENT,
        );
        let predicates = Predicates::new(to_f64(&resolution));
        let touch = pair.how(PairMeasure::PlaneOnSphere);
        assert_eq!(
            predicates.classify("plane on sphere", touch, [0.0; 3]),
            side
        );
        let decisions = predicates.decisions();
        assert_eq!((decisions.filtered, decisions.coincident), (0, 0));
        assert_eq!(decisions.refined, 1);
        assert_eq!(decisions.close_calls.len(), 1);
    }
}

fn rounded(c: &Coefficients<Rational>) -> Frame {
    let [x, y, z] = c.point.each_ref().map(to_f64);
    let axis = Vector3::from(c.direction.each_ref().map(to_f64)).normalize();
    Frame::about(Point3::new(x, y, z), axis)
}

/// A surface of some kind, and the exact numbers from which it was rounded.
fn surface(kind: usize, c: &Coefficients<Rational>) -> Surface {
    let frame = rounded(c);
    let (size, tube) = (to_f64(&c.size), to_f64(&c.tube));
    match kind {
        0 => Surface::Plane(Plane { frame }),
        1 => Surface::Cylinder(Cylinder {
            frame,
            radius: size,
        }),
        2 => Surface::Cone(Cone {
            frame,
            sin: size / size.hypot(1.0),
            cos: 1.0 / size.hypot(1.0),
        }),
        3 => Surface::Sphere(Sphere {
            frame,
            radius: size,
        }),
        _ => Surface::Torus(Torus {
            frame,
            major: size,
            minor: tube,
        }),
    }
}

fn numbers() -> impl Strategy<Value = Coefficients<Rational>> {
    let third = |n: i32| Rational::from_parts(n.into(), 3u8.into());
    let triple = || prop::array::uniform3(-9i32..=9);
    (triple(), triple(), 5i32..9, 1i32..5).prop_map(move |(point, direction, size, tube)| {
        let direction = if direction == [0; 3] {
            [1, 2, 2]
        } else {
            direction
        };
        Coefficients {
            point: point.map(third),
            direction: direction.map(third),
            size: third(size),
            tube: third(tube),
        }
    })
}

const OF_TWO: &[PairMeasure] = &[
    PairMeasure::Drift,
    PairMeasure::Lean,
    PairMeasure::Between,
    PairMeasure::Height,
    PairMeasure::OffAxis,
    PairMeasure::BetweenAxes,
    PairMeasure::OffLine,
    PairMeasure::PlaneOnSphere,
    PairMeasure::PlaneOnCylinder,
    PairMeasure::PlaneAcrossCylinder,
    PairMeasure::PlaneOnRuling,
    PairMeasure::PlaneAlongRuling(false),
    PairMeasure::PlaneAlongRuling(true),
    PairMeasure::AdjacentSpheres,
    PairMeasure::SphereInSphere,
    PairMeasure::AdjacentCylinders,
    PairMeasure::CylinderInCylinder,
    PairMeasure::PointOnQuadric,
];

const OF_TORUS: &[PairMeasure] = &[
    PairMeasure::Tilt,
    PairMeasure::Upright,
    PairMeasure::PlaneOnBothSides,
    PairMeasure::SizeOfTube,
    PairMeasure::LineOnTube,
    PairMeasure::BetweenTubes,
    PairMeasure::NextToTube,
    PairMeasure::InTube,
];

proptest! {
    #[test]
    fn ranges_hold_what_more_bits_give(
        a in numbers(), b in numbers(), kinds in (1usize..5, 1usize..5),
        relation in prop_oneof![prop::sample::select(OF_TWO), prop::sample::select(OF_TORUS)],
    ) {
        let first = if OF_TORUS.contains(&relation) { 4 } else { kinds.0 };
        let surfaces = [surface(first, &a), surface(kinds.1, &b)];
        let (of_a, of_b) = (|| a.clone(), || b.clone());
        let pair = SurfacePair::new(
            Carrier::rounded(&surfaces[0], &of_a),
            Carrier::rounded(&surfaces[1], &of_b),
            &EXTENT,
        );
        let how = pair.how(relation);
        let (range, fine) = (how.range(), how.refined(256).unwrap());
        let [lo, hi] = fine.ends().unwrap();
        prop_assert!(hi - lo < tiny(150));
        prop_assert!(range.lo <= to_f64(lo) && to_f64(hi) <= range.hi, "{relation:?} {range:?}");
        prop_assert!(range.width() < 1e-11, "{relation:?} {range:?}");
        let estimate = pair.estimate(relation);
        prop_assert!((estimate - to_f64(lo)).abs() < 1e-11, "{relation:?}");
    }
}
