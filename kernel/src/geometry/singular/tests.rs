//! Singular points of every kind, with branches derived by hand.

use crate::geometry::bivariate_trig_poly::BivariateTrigPoly;
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Cone, Surface, Torus};
use crate::geometry::trace::{Traced, trace};
use nalgebra::{Point3, Vector3};
use std::f64::consts::FRAC_PI_2;

const TORUS: Torus = Torus {
    frame: Frame {
        origin: Point3::new(0.0, 0.0, 0.0),
        x: Vector3::new(1.0, 0.0, 0.0),
        y: Vector3::new(0.0, 1.0, 0.0),
        z: Vector3::new(0.0, 0.0, 1.0),
    },
    major: 2.0,
    minor: 1.0,
};

/// The zero set of a function of the angles; every branch must be complete, with every point on it.
fn traced(f: impl Fn(f64, f64) -> f64) -> Traced {
    let form = BivariateTrigPoly::interpolate(&f);
    let traced = trace(&TORUS, &form, 1e-11, &|_| true).unwrap();
    for b in &traced.branches {
        for i in 0..10 * b.segments.len() {
            let [theta, phi] = b.angles(f64::from(i as u32) / 10.0);
            assert!(f(theta.v, phi.v).abs() < 1e-13, "{}", f(theta.v, phi.v));
        }
    }
    traced
}

/// The number of branches, and for each singular point the number of passages through it and of
/// those with a cusp there.
fn kinds(traced: &Traced) -> (usize, Vec<(usize, usize)>) {
    let kind = |s: &crate::geometry::trace::Singular| {
        let turns =
            s.on.iter()
                .filter(|on| traced.branches[on.branch].turns_back(on.t));
        (s.on.len(), turns.count())
    };
    (
        traced.branches.len(),
        traced.singular.iter().map(kind).collect(),
    )
}

/// With X = 1 - cos x and T = sin y the curve T = X runs from (0, 0) through (±π/2, π/2) to (0, π).
/// There X is x²/2 to lowest order, so (T - X)² + c Tᵃ Xᵇ (sin x)ᵈ is e² + c' x^(2a + 2b + d) at
/// both ends.
fn perturbed(c: f64, [a, b, d]: [i32; 3]) -> impl Fn(f64, f64) -> f64 {
    move |x, y| {
        let (t, v) = (y.sin(), 1.0 - x.cos());
        (t - v).powi(2) + c * t.powi(a) * v.powi(b) * x.sin().powi(d)
    }
}

#[test]
fn branches_touch_or_end_in_a_cusp_to_any_order() {
    // x⁵ (A4): for negative x two arcs run from one cusp to the other.
    assert_eq!(
        kinds(&traced(perturbed(0.5, [1, 1, 1]))),
        (1, vec![(1, 1), (1, 1)])
    );
    assert_eq!(
        kinds(&traced(perturbed(-0.5, [1, 1, 1]))),
        (1, vec![(1, 1), (1, 1)])
    );
    // x⁶ (A5): with c = -4 it is T - X = ±2 √T X. For the upper sign it turns back at T = 1; for
    // the lower one it crosses x = π, where T is (√6 - 2)². What is above on one side of x = 0 is
    // below on the other, so all of it is one branch.
    assert_eq!(
        kinds(&traced(perturbed(-4.0, [1, 2, 0]))),
        (1, vec![(2, 0), (2, 0)])
    );
    // Where the sum is definite the points are isolated.
    assert_eq!(
        kinds(&traced(perturbed(0.2, [1, 2, 0]))),
        (0, vec![(0, 0), (0, 0)])
    );
}

/// A cone that is tangent to the torus (2, 1) from inside at its top (0, 2, 1), along a ruling in
/// the direction of x. With its apex at the distance l from there its curvature is 1/(l tan α);
/// that of the tube is 1. For l = cot α only terms of degree three remain. With u = x and v = y - 2
/// the torus is z = 1 - (v + u²/4)²/2 and the cone z = 1 - v² (1 - u/l)/2 to that degree, so they
/// differ by u v (u/4 + v/(2 l)).
#[test]
fn a_cone_of_the_curvature_of_the_tube_meets_it_in_three_branches() {
    let (sin, cos) = (0.6, 0.8);
    let l = cos / sin;
    let apex = Point3::new(-l, 2.0, 1.0);
    let axis = Vector3::new(cos, 0.0, -sin);
    let cone = Surface::Cone(Cone {
        frame: Frame::about(apex, axis),
        sin,
        cos,
    });
    let torus = Surface::Torus(TORUS);
    let level = |theta, phi| {
        let q = cone.frame().coordinates(&torus.point(theta, phi));
        (q.x * q.x + q.y * q.y) * cos * cos - q.z * q.z * sin * sin
    };
    let traced = traced(level);
    let top = [FRAC_PI_2, FRAC_PI_2];
    let apart = |s: &[f64; 2]| (s[0] - top[0]).hypot(s[1] - top[1]);
    let [point] = &traced.singular[..] else {
        panic!("{:?}", traced.singular);
    };
    assert!(apart(&point.angles) < 1e-9);
    // u is -2 dθ and v is -dφ: the slopes dφ/dθ are zero, infinite, and from u/4 = -v/(2 l).
    let direction = |on: &crate::geometry::trace::BranchPosition| {
        let [theta, phi] = traced.branches[on.branch].angles(on.t + 1e-9);
        phi.d.atan2(theta.d)
    };
    let directions: Vec<f64> = point.on.iter().map(direction).collect();
    assert_eq!(directions.len(), 3);
    for expected in [0.0, FRAC_PI_2, -l.atan()] {
        let is_there = directions.iter().any(|d| (d - expected).sin().abs() < 1e-6);
        assert!(is_there, "{expected} of {directions:?}");
    }
}

/// The apex of a cone on the torus. The cosine between the torus's normal and the axis is 4/9, that
/// between the normal and a ruling at most 1/√5. Two rulings lie in the tangent plane, close to
/// each other.
#[test]
fn branches_of_nearly_one_direction_cross() {
    let torus = Surface::Torus(Torus {
        major: 2.5,
        minor: 1.5,
        ..TORUS
    });
    let apex = torus.point((-1.0f64 / 3.0).acos(), -(1.0f64 / 3.0).acos());
    let slant = 0.5f64.sqrt();
    let (sin, cos) = (0.2f64.sqrt(), 0.8f64.sqrt());
    let frame = Frame::about(apex, Vector3::new(0.0, slant, slant));
    let traced = traced(|theta, phi| {
        let q = frame.coordinates(&torus.point(theta, phi));
        (q.x * q.x + q.y * q.y) * cos * cos - q.z * q.z * sin * sin
    });
    let passes: Vec<usize> = traced.singular.iter().map(|s| s.on.len()).collect();
    assert_eq!(passes, [2]);
}

/// sin x sin y (1 + cos x - 2 cos y) is x y (y² - x²/2) close to (0, 0). The third curve turns back
/// at (π, ±π/2), on the line x = π; the lines cross in three more points.
#[test]
fn four_branches_cross_in_a_point() {
    let traced = traced(|x, y| x.sin() * y.sin() * (1.0 + x.cos() - 2.0 * y.cos()));
    let mut passes: Vec<usize> = traced.singular.iter().map(|s| s.on.len()).collect();
    passes.sort_unstable();
    assert_eq!(passes, [2, 2, 2, 2, 2, 4]);
}

/// sin x sin y (cos x - cos y) is x y (y² - x²)/2 close to (0, 0), and the same at (π, π): branches
/// along the diagonals of every evenly spaced grid.
#[test]
fn four_branches_cross_on_diagonals() {
    let traced = traced(|x, y| x.sin() * y.sin() * (x.cos() - y.cos()));
    let mut passes: Vec<usize> = traced.singular.iter().map(|s| s.on.len()).collect();
    passes.sort_unstable();
    assert_eq!(passes, [2, 2, 4, 4]);
}
