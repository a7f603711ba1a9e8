//! Planted poses of a wire part, and edges with noise of a known standard deviation.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use super::*;
use nalgebra::Translation3;
use premio_kernel::random::Random as Bits;
use std::f64::consts::{PI, TAU};

const CAMERA: Pinhole = Pinhole {
    focal: [1400.0, 1350.0],
    centre: [630.0, 470.0],
    skew: 1.5,
};

/// The standard deviation of edges, in pixels.
const SIGMA: f64 = 0.4;

/// Reproducible random numbers.
struct Random(Bits);

impl Random {
    /// From 0 to 1.
    fn next(&mut self) -> f64 {
        self.0.uniform()
    }

    fn within(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.next()
    }

    /// Of mean zero and standard deviation one (Box and Muller).
    fn normal(&mut self) -> f64 {
        let (a, b) = (1.0 - self.next(), self.next());
        (-2.0 * a.ln()).sqrt() * (TAU * b).cos()
    }

    fn direction(&mut self) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.normal()).normalize()
    }

    fn pose(&mut self) -> Isometry3<f64> {
        let turn = self.direction() * self.within(0.0, PI);
        let z = self.within(6.0, 12.0);
        let shift = Vector3::new(self.within(-0.2, 0.2) * z, self.within(-0.2, 0.2) * z, z);
        Isometry3::from_parts(
            Translation3::from(shift),
            UnitQuaternion::from_scaled_axis(turn),
        )
    }

    /// A pose that differs by five degrees and five hundredths of the distance.
    fn perturbed(&mut self, pose: &Isometry3<f64>) -> Isometry3<f64> {
        let turn = self.direction() * 5.0f64.to_radians();
        let shift = self.direction() * (0.05 * pose.translation.vector.norm());
        moved(
            pose,
            &Vector6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z),
        )
    }
}

/// Points and tangents of a wire part: a block's edges, and a circle on one face.
fn wire() -> Vec<(Point3<f64>, Vector3<f64>)> {
    let half = Vector3::new(1.0, 0.7, 0.5);
    let mut all = Vec::new();
    for axis in 0..3 {
        for [a, b] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
            for k in 0..8 {
                let mut p = Vector3::zeros();
                p[axis] = (k as f64 - 3.5) / 4.0;
                p[(axis + 1) % 3] = a;
                p[(axis + 2) % 3] = b;
                all.push((
                    Point3::from(p.component_mul(&half)),
                    Vector3::ith(axis, 1.0),
                ));
            }
        }
    }
    for k in 0..24 {
        let (sin, cos) = (TAU * k as f64 / 24.0).sin_cos();
        all.push((
            Point3::new(0.4 * cos, 0.4 * sin, 0.5),
            Vector3::new(-sin, cos, 0.0),
        ));
    }
    all
}

/// Noisy edges of the images of the wire at a pose.
fn pulls(pose: &Isometry3<f64>, random: &mut Random, sigma: f64) -> Vec<PointToLine> {
    let pull = |(point, tangent): (Point3<f64>, Vector3<f64>)| {
        let at = CAMERA.project(&(pose * point));
        let along = CAMERA.project(&(pose * (point + tangent * 1e-4))) - at;
        let normal = Vector2::new(-along.y, along.x).normalize();
        let target = at + normal * (sigma * random.normal());
        PointToLine {
            point,
            target,
            normal,
            weight: 1.0,
        }
    };
    wire().into_iter().map(pull).collect()
}

/// The step from a pose to another: the rotation in the camera's axes, and the translation.
fn step(from: &Isometry3<f64>, to: &Isometry3<f64>) -> Vector6<f64> {
    let turn = (to.rotation * from.rotation.inverse()).scaled_axis();
    let shift = to.translation.vector - from.translation.vector;
    Vector6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z)
}

/// The squared Mahalanobis error of a pose: chi-squared with six degrees of freedom.
fn squared_error(planted: &Isometry3<f64>, refined: &Refined) -> f64 {
    let e = step(planted, &refined.pose);
    e.dot(&(refined.information * e)) / (SIGMA * SIGMA)
}

/// Chi-squared with six degrees of freedom exceeds this once in ten million times.
const NEVER: f64 = 43.0;

/// Refines from coarse to fine, with a number of rounds at each scale.
fn refined(
    start: &Isometry3<f64>,
    pulls: &[PointToLine],
    scales: &[f64],
    rounds: usize,
) -> Refined {
    let (first, rest) = scales.split_first().unwrap();
    let mut found = refine(&CAMERA, start, pulls, *first, rounds).unwrap();
    for scale in rest {
        found = refine(&CAMERA, &found.pose, pulls, *scale, rounds).unwrap();
    }
    found
}

#[test]
fn what_has_no_noise_is_found_to_the_last_digits() {
    let mut random = Random(Bits::new(1));
    for _ in 0..100 {
        let planted = random.pose();
        let pulls = pulls(&planted, &mut random, 0.0);
        let found = refined(&random.perturbed(&planted), &pulls, &[1000.0], 30);
        assert!(step(&planted, &found.pose).norm() < 1e-9);
    }
}

#[test]
fn a_perturbed_pose_is_recovered() {
    let mut random = Random(Bits::new(2));
    for _ in 0..100 {
        let planted = random.pose();
        let pulls = pulls(&planted, &mut random, SIGMA);
        let found = refined(&random.perturbed(&planted), &pulls, &[1000.0], 30);
        assert!(squared_error(&planted, &found) < NEVER);
    }
}

#[test]
fn a_perturbed_pose_is_recovered_with_a_fifth_of_outliers() {
    let mut random = Random(Bits::new(3));
    for _ in 0..100 {
        let planted = random.pose();
        let mut pulls = pulls(&planted, &mut random, SIGMA);
        for pull in &mut pulls {
            if random.next() < 0.2 {
                pull.target += pull.normal * random.within(-60.0, 60.0);
            }
        }
        let start = random.perturbed(&planted);
        let found = refined(&start, &pulls, &[200.0, 50.0, 12.0, 12.0 * SIGMA], 20);
        assert!(squared_error(&planted, &found) < NEVER);
    }
}

/// The normalised estimation error squared (Y. Bar-Shalom, X. Li, T. Kirubarajan, Estimation with
/// Applications to Tracking and Navigation, 2001, section 5.4.2).
#[test]
fn errors_are_as_great_as_they_are_said_to_be() {
    const TRIALS: usize = 400;
    let mut random = Random(Bits::new(4));
    let mut sum = 0.0;
    for _ in 0..TRIALS {
        let planted = random.pose();
        let pulls = pulls(&planted, &mut random, SIGMA);
        let found = refined(&planted, &pulls, &[20.0 * SIGMA], 30);
        sum += squared_error(&planted, &found);
    }
    // Chi-squared with this many degrees of freedom is nearly normal: 99 of 100 values lie within
    // the limit.
    let freedom = 6.0 * TRIALS as f64;
    let limit = 2.576 * (2.0 * freedom).sqrt();
    assert!((sum - freedom).abs() < limit, "{}", sum / TRIALS as f64);
}
