use super::*;
use crate::geometry::curve::{Circle, Curve};
use crate::geometry::frame::Frame;
use crate::geometry::surface::Cylinder;
use crate::random::Random;
use std::f64::consts::TAU;

const RESOLUTION: f64 = 1e-11;

/// A circle of a plane, and the one around it.
struct Nested {
    centre: [f64; 2],
    radius: f64,
    depth: u32,
    around: Option<usize>,
}

/// Circles that do not intersect, in circles that do not intersect, at random places.
fn nested(seed: u64) -> Vec<Nested> {
    let mut random = Random::new(seed);
    let mut all = vec![Nested {
        centre: [0.0; 2],
        radius: 1.0,
        depth: 0,
        around: None,
    }];
    for _ in 0..2000 {
        let around = (random.uniform() * all.len() as f64) as usize;
        let outer = &all[around];
        let radius = outer.radius * (0.02 + 0.3 * random.uniform());
        let (turn, out) = (TAU * random.uniform(), outer.radius * random.uniform());
        let centre = [
            outer.centre[0] + out * turn.cos(),
            outer.centre[1] + out * turn.sin(),
        ];
        let apart =
            |other: &Nested| (other.centre[0] - centre[0]).hypot(other.centre[1] - centre[1]);
        let siblings = all.iter().filter(|other| other.around == Some(around));
        let is_free = radius > 1e-4
            && out + 1.01 * radius < outer.radius
            && siblings
                .into_iter()
                .all(|other| apart(other) > 1.01 * (other.radius + radius));
        if is_free {
            let depth = outer.depth + 1;
            all.push(Nested {
                centre,
                radius,
                depth,
                around: Some(around),
            });
        }
    }
    all
}

fn arc(curve: &Curve, sense: Sense) -> Vec<DirectedArc<'_>> {
    vec![DirectedArc {
        curve,
        range: [0.0, TAU],
        sense,
    }]
}

fn loops_of(found: Vec<Region>) -> Vec<Vec<usize>> {
    for region in &found {
        assert_eq!(region.euler, 2 - region.loops.len() as i32);
    }
    let mut loops: Vec<_> = found.into_iter().map(|region| region.loops).collect();
    loops.sort();
    loops
}

#[test]
fn islands_in_holes_in_islands_are_regions_of_their_own() {
    let z = Vector3::new(0.3, -0.4, 0.7).normalize();
    let frame = Frame::about(Point3::new(1.0, -2.0, 0.5), z);
    for seed in 0..6 {
        let circles = nested(seed);
        assert!(circles.len() > 100);
        let curves: Vec<Curve> = circles
            .iter()
            .map(|c| {
                let frame = frame.at(frame.point(c.centre[0], c.centre[1], 0.0));
                Curve::Circle(Circle {
                    frame,
                    radius: c.radius,
                })
            })
            .collect();
        // An island is counterclockwise, a hole clockwise.
        let sense = |depth: u32| match depth.is_multiple_of(2) {
            true => Sense::Along,
            false => Sense::Against,
        };
        let loops: Vec<_> = curves
            .iter()
            .zip(&circles)
            .map(|(curve, circle)| arc(curve, sense(circle.depth)))
            .collect();
        let mut expected: Vec<Vec<usize>> = Vec::new();
        for (i, island) in circles.iter().enumerate() {
            if island.depth.is_multiple_of(2) {
                let holes = (0..circles.len()).filter(|&k| circles[k].around == Some(i));
                expected.push([i].into_iter().chain(holes).collect());
            }
        }
        expected.sort();
        let plane = Surface::Plane(Plane { frame });
        let found = regions(&plane, Sense::Along, &loops, RESOLUTION);
        assert_eq!(loops_of(found.expect("clear")), expected, "seed {seed}");
    }
}

#[test]
fn bands_of_a_cylinder_are_regions_of_their_own() {
    let z = Vector3::new(0.3, -0.4, 0.7).normalize();
    let frame = Frame::about(Point3::new(1.0, -2.0, 0.5), z);
    let curves: Vec<Curve> = (0..80)
        .map(|i| {
            let frame = frame.at(frame.point(0.0, 0.0, f64::from(i)));
            Curve::Circle(Circle { frame, radius: 2.0 })
        })
        .collect();
    // The face is above a circle that runs counterclockwise.
    let senses = [Sense::Along, Sense::Against].into_iter().cycle();
    let loops: Vec<_> = curves
        .iter()
        .zip(senses)
        .map(|(curve, sense)| arc(curve, sense))
        .collect();
    let cylinder = Surface::Cylinder(Cylinder { frame, radius: 2.0 });
    let found = regions(&cylinder, Sense::Along, &loops, RESOLUTION).expect("clear");
    let expected: Vec<Vec<usize>> = (0..40).map(|i| vec![2 * i, 2 * i + 1]).collect();
    assert_eq!(loops_of(found), expected);
}
