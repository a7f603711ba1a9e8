//! Constructed points: surfaces through them are proven to pass, surfaces that narrowly miss them
//! are not.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use super::{AlgebraicPoint, Polynomial, ZeroTest};
use crate::geometry::frame::Frame;
use crate::geometry::surface::of_every_kind;
use crate::geometry::surface_pair::Coefficients;
use crate::number::rational::Rational;
use nalgebra::Point3;
use proptest::prelude::*;

fn ratio(n: i64, d: u64) -> Rational {
    Rational::from_parts(n.into(), d.into())
}

fn whole(v: [i64; 3]) -> [Rational; 3] {
    v.map(|n| ratio(n, 1))
}

fn surface(kind: usize, point: [Rational; 3], direction: [i64; 3], size: Rational) -> Polynomial {
    let exact = Coefficients {
        point,
        direction: whole(direction),
        size,
        tube: ratio(1, 1),
        axes: None,
    };
    let kinds = of_every_kind(Frame::world(), 1.0, [2.0, 1.0]);
    Polynomial::new(&kinds[kind], &exact)
}

/// A plane, a cylinder, a cone, a sphere or a torus with a tube of radius one.
const PLANE: usize = 0;
const CYLINDER: usize = 1;
const CONE: usize = 2;
const SPHERE: usize = 3;
const TORUS: usize = 4;

fn origin() -> [Rational; 3] {
    whole([0; 3])
}

#[test]
fn a_rational_point_of_planes() {
    let planes = [
        surface(PLANE, whole([3, 0, 0]), [1, 0, 0], ratio(0, 1)),
        surface(PLANE, whole([0, 4, 0]), [0, 1, 0], ratio(0, 1)),
        surface(PLANE, whole([0; 3]), [1, 1, 2], ratio(0, 1)),
    ];
    let near = Point3::new(3.0, 4.0, -3.5);
    let mut point = AlgebraicPoint::next_to(&planes, &near).unwrap();
    let through = |kind, direction, size| surface(kind, origin(), direction, size);
    let along = [
        (CYLINDER, [0, 0, 1], ratio(5, 1)),
        (CONE, [0, 0, -1], ratio(10, 7)),
    ];
    for (kind, direction, size) in along {
        assert_eq!(
            point.is_zero_of(&through(kind, direction, size)),
            ZeroTest::Zero
        );
    }
    let little = Rational::from_parts(1.into(), dashu::integer::UBig::ONE << 400);
    let missed = through(CYLINDER, [0, 0, 1], ratio(5, 1) + little);
    assert_eq!(point.is_zero_of(&missed), ZeroTest::Apart);
}

#[test]
fn an_irrational_point() {
    // x = y on the unit cylinder at z = 0, and on the unit sphere, and on a torus of 1 + 1 about y
    // - x.
    let base = [
        surface(CYLINDER, origin(), [0, 0, 1], ratio(1, 1)),
        surface(PLANE, origin(), [1, -1, 0], ratio(0, 1)),
        surface(PLANE, origin(), [0, 0, 1], ratio(0, 1)),
    ];
    let half = 0.5_f64.sqrt();
    let mut point = AlgebraicPoint::next_to(&base, &Point3::new(half, half, 0.0)).unwrap();
    let sphere = surface(SPHERE, origin(), [0, 0, 1], ratio(1, 1));
    let torus = surface(TORUS, origin(), [1, -1, 0], ratio(2, 1));
    assert_eq!(point.is_zero_of(&sphere), ZeroTest::Zero);
    assert_eq!(point.is_zero_of(&torus), ZeroTest::Zero);
    let tiny = ratio(1, 1 << 62);
    let tiny = &tiny * &tiny * &tiny;
    let missed = surface(
        SPHERE,
        [tiny, ratio(0, 1), ratio(0, 1)],
        [0, 0, 1],
        ratio(1, 1),
    );
    assert_eq!(point.is_zero_of(&missed), ZeroTest::Apart);
}

#[test]
fn a_touch_and_an_apex() {
    let plane = surface(PLANE, whole([0, 0, 1]), [0, 0, 1], ratio(0, 1));
    let ball = surface(SPHERE, origin(), [0, 0, 1], ratio(1, 1));
    let touching = plane.touching(&ball);
    let all = std::iter::once(&plane).chain(&touching);
    let mut point = AlgebraicPoint::next_to(all, &Point3::new(0.0, 0.0, 1.0)).unwrap();
    assert_eq!(point.is_zero_of(&ball), ZeroTest::Zero);
    // The gradient of a cone vanishes at its apex.
    let cone = surface(CONE, whole([1, 2, 3]), [1, 2, 2], ratio(3, 4));
    let gradient = cone.gradient();
    let mut apex = AlgebraicPoint::next_to(&gradient, &Point3::new(1.0, 2.0, 3.0)).unwrap();
    assert_eq!(apex.is_zero_of(&cone), ZeroTest::Zero);
    assert_eq!(apex.is_zero_of(&ball), ZeroTest::Apart);
}

#[test]
fn dependent_surfaces_have_no_point_of_their_own() {
    let plane = |z| surface(PLANE, whole([0, 0, z]), [0, 0, 1], ratio(0, 1));
    let side = surface(PLANE, origin(), [1, 0, 0], ratio(0, 1));
    let middle = Point3::new(0.0, 0.0, 0.0);
    assert!(AlgebraicPoint::next_to(&[plane(0), plane(0), side], &middle).is_none());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    /// Spheres through a rational point, at a distance that is rational by Euclid's formula.
    #[test]
    fn spheres_through_a_planted_point(
        at in prop::array::uniform3((-999i64..1000, 1u64..50)),
        ways in prop::array::uniform4((1i64..20, 1i64..20, 1i64..20, 1i64..9)),
        power in 60usize..500,
    ) {
        let p = at.map(|(n, d)| ratio(n, d));
        let spheres = ways.map(|(m, n, k, scale)| {
            // (2mk, 2nk, m² + n² - k²) has the length m² + n² + k².
            let v = [2 * m * k, 2 * n * k, m * m + n * n - k * k];
            let centre = [0, 1, 2].map(|i| &p[i] + ratio(v[i] * scale, 7));
            (centre, ratio((m * m + n * n + k * k) * scale, 7))
        });
        let [a, b, c, d] = spheres.clone().map(|(o, r)| surface(SPHERE, o, [0, 0, 1], r));
        let near = Point3::from(p.each_ref().map(crate::number::rational::to_f64));
        let base = [a, b, c];
        if let Some(mut point) = AlgebraicPoint::next_to(&base, &near) {
            prop_assert_eq!(point.is_zero_of(&d), ZeroTest::Zero);
            let little = Rational::from_parts(1.into(), dashu::integer::UBig::ONE << power);
            let (o, r) = spheres[3].clone();
            let missed = surface(SPHERE, o, [0, 0, 1], r + little);
            prop_assert_eq!(point.is_zero_of(&missed), ZeroTest::Apart);
        }
    }
}
