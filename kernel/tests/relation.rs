//! Relations between surfaces that f64 cannot decide, and more bits can.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::ellipsoid::Ellipsoid;
use premio_kernel::geometry::elliptic_surface::{EllipticCone, EllipticCylinder};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::region_of_interest::RegionOfInterest;
use premio_kernel::geometry::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};
use premio_kernel::geometry::surface_pair::{Carrier, Coefficients, PairMeasure, SurfacePair};
use premio_kernel::number::predicates::RELATIVE_RESOLUTION;
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
        axes: None,
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
            axes: None,
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
        let touch = pair.how(PairMeasure::PlaneOnBall);
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
        4 => Surface::Torus(Torus {
            frame,
            major: size,
            minor: tube,
        }),
        _ => {
            let axes = c.axes.as_ref().expect("an elliptic surface has axes");
            let axes = axes
                .each_ref()
                .map(|axis| axis.each_ref().map(to_f64).into());
            let o = frame.origin;
            match kind {
                5 => Surface::EllipticCylinder(EllipticCylinder::with_axes(o, axes)),
                6 => Surface::EllipticCone(EllipticCone::with_axes(o, axes)),
                _ => Surface::Ellipsoid(Ellipsoid::with_axes(o, axes)),
            }
        }
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
            axes: None,
        }
    })
}

/// The numbers with conjugate axes in place of the size, of which the third is the direction.
fn with_axes(c: &Coefficients<Rational>, shear: [Rational; 2]) -> Coefficients<Rational> {
    let [x, y, z] = c.direction.clone();
    let zero = Rational::ZERO;
    // Perpendicular to the direction, unless it is along z.
    let across = match (x.is_zero(), y.is_zero()) {
        (true, true) => [Rational::ONE, zero.clone(), zero],
        _ => [-y.clone(), x.clone(), zero],
    };
    let [a, b, d] = &across;
    let third = [&y * d - &z * b, &z * a - &x * d, &x * b - &y * a];
    let sheared = |v: &[Rational; 3], by: &Rational| {
        [0, 1, 2].map(|i| &v[i] * &c.size + &c.direction[i] * by)
    };
    let axes = [
        sheared(&across, &shear[0]),
        sheared(&third, &shear[1]),
        c.direction.clone(),
    ];
    Coefficients {
        size: Rational::ONE,
        tube: Rational::ZERO,
        axes: Some(Box::new(axes)),
        ..c.clone()
    }
}

/// The largest coordinate of a point, a direction or an axis.
fn largest(c: &Coefficients<Rational>) -> f64 {
    let axes = c.axes.iter().flat_map(|axes| axes.iter());
    let all = [&c.point, &c.direction].into_iter().chain(axes).flatten();
    all.map(|x| to_f64(x).abs()).fold(1.0, f64::max)
}

const OF_TWO: &[PairMeasure] = &[
    PairMeasure::Drift,
    PairMeasure::Lean,
    PairMeasure::Between,
    PairMeasure::Height,
    PairMeasure::OffAxis,
    PairMeasure::BetweenAxes,
    PairMeasure::OffLine,
    PairMeasure::PlaneOnBall,
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
        a in numbers(), b in numbers(), kinds in (1usize..8, 1usize..8),
        shear in prop::array::uniform2(-3i32..3),
        relation in prop_oneof![prop::sample::select(OF_TWO), prop::sample::select(OF_TORUS)],
    ) {
        let first = if OF_TORUS.contains(&relation) { 4 } else { kinds.0 };
        // The direction of a sheared cone is not its axis.
        let of_cone = [
            PairMeasure::Between,
            PairMeasure::PlaneOnRuling,
            PairMeasure::PointOnQuadric,
        ];
        let is_cone = first == 6 || kinds.1 == 6;
        prop_assume!(!is_cone || of_cone.contains(&relation));
        // An ellipsoid's direction is that of no axis in particular.
        let of_ellipsoid = [
            PairMeasure::Between,
            PairMeasure::PlaneOnBall,
            PairMeasure::PointOnQuadric,
        ];
        let is_ellipsoid = first == 7 || kinds.1 == 7;
        prop_assume!(!is_ellipsoid || of_ellipsoid.contains(&relation));
        // The first surface of these two is a plane.
        let of_plane = [PairMeasure::PlaneOnRuling, PairMeasure::PlaneOnBall];
        prop_assume!(first < 6 || !of_plane.contains(&relation));
        // The axes of a sheared cylinder are no conjugate axes of its section.
        let of_no_cylinder = [PairMeasure::PlaneOnRuling, PairMeasure::PlaneOnBall];
        prop_assume!(kinds.1 != 5 || !of_no_cylinder.contains(&relation));
        let shear = shear.map(|k| Rational::from_parts(k.into(), 3u8.into()));
        let prepared = |kind: usize, c: &Coefficients<Rational>| match kind > 4 {
            true => with_axes(c, shear.clone()),
            false => c.clone(),
        };
        let (a, b) = (prepared(first, &a), prepared(kinds.1, &b));
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
        // Both are narrower than the resolution of a part of this size.
        let resolution = RELATIVE_RESOLUTION * largest(&a).max(largest(&b));
        prop_assert!(range.width() < resolution, "{relation:?} {range:?}");
        let estimate = pair.estimate(relation);
        prop_assert!((estimate - to_f64(lo)).abs() < resolution, "{relation:?}");
    }
}
