//! Prisms and revolutions: evaluated boundaries against values derived by hand, and against rays.

use crate::common::{evaluated, n, shifted, tree_of, turned, with_volume};
use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::figure::{ContourCorner, Figure, FigureArc, FigureError, FigurePoint, PlaneMap};
use premio_csg::primitive::{Primitive, RevolutionAngle};
use premio_csg::ray_casting::RayOracle;
use premio_csg::tree::Operation;
use premio_kernel::number::rational::{Rational, to_f64};
use proptest::prelude::*;
use std::f64::consts::PI;

const SQUARE: &[[i32; 2]] = &[[0, 0], [4, 0], [4, 4], [0, 4]];

fn points(list: &[[i32; 2]]) -> Vec<FigurePoint> {
    list.iter().map(|p| p.map(n)).collect()
}

fn polygon(contours: &[&[[i32; 2]]]) -> Result<Figure, FigureError> {
    let contours: Vec<Vec<FigurePoint>> = contours.iter().map(|c| points(c)).collect();
    Figure::polygon(&contours)
}

/// Evaluates a primitive in a general position, checks its volume and the rays', and returns the
/// numbers of its vertices, edges, loops and faces.
fn check(primitive: Primitive, volume: f64) -> [usize; 4] {
    let mut counts = [0; 4];
    for turn in [0, 37] {
        let tree = tree_of(|builder| {
            let part = builder.primitive(primitive.clone());
            turned(builder, part, turn)
        });
        let known = with_volume(&tree, volume);
        counts = known.brep.topology.census().cells;
    }
    counts
}

fn prism(contours: &[&[[i32; 2]]], height: i32) -> Primitive {
    Primitive::prism(polygon(contours).unwrap(), n(height)).unwrap()
}

#[test]
fn a_prism_has_a_face_for_every_edge_of_its_figure() {
    let bracket = prism(&[&[[0, 0], [6, 0], [6, 1], [1, 1], [1, 4], [0, 4]]], 2);
    assert_eq!(check(bracket, 18.0), [12, 18, 8, 8]);
    let frame = prism(&[SQUARE, &[[1, 1], [3, 1], [3, 3], [1, 3]]], 3);
    assert_eq!(check(frame, 36.0), [16, 24, 12, 10]);
    // A comb: the lines of its edges cross it everywhere.
    let comb = prism(
        &[&[
            [0, 0],
            [9, 0],
            [8, 5],
            [7, 5],
            [6, 1],
            [5, 1],
            [5, 5],
            [4, 5],
            [3, 1],
            [2, 6],
            [1, 6],
        ]],
        1,
    );
    let [_, _, _, faces] = check(
        comb.clone(),
        match &comb {
            Primitive::Prism { figure, .. } => figure.area(),
            _ => 0.0,
        },
    );
    assert_eq!(faces, 13);
}

#[test]
fn a_hole_may_touch_the_outline() {
    // The common corner is an edge of four faces.
    let touching = prism(&[SQUARE, &[[0, 0], [3, 1], [1, 3]]], 1);
    assert_eq!(check(touching, 12.0), [12, 20, 9, 9]);
    let inside_edge = prism(&[SQUARE, &[[0, 2], [2, 1], [2, 3]]], 1);
    // The hole's corner divides the wall that it touches.
    let [_, _, _, faces] = check(inside_edge, 14.0);
    assert_eq!(faces, 10);
}

fn corner(x: i32, y: i32) -> ContourCorner {
    ContourCorner {
        point: [n(x), n(y)],
        arc: None,
    }
}

fn arc(x: i32, y: i32, centre: [i32; 2], radius: i32) -> ContourCorner {
    ContourCorner {
        point: [n(x), n(y)],
        arc: Some(FigureArc::from_signed_radius(centre.map(n), n(radius))),
    }
}

fn extruded(corners: &[ContourCorner], height: i32) -> Primitive {
    let figure = Figure::from_contours(&[corners.to_vec()]).unwrap();
    Primitive::prism(figure, n(height)).unwrap()
}

#[test]
fn arcs_join_segments_smoothly() {
    // A slot: two segments and two half circles.
    let slot = extruded(
        &[
            corner(0, -1),
            arc(5, -1, [5, 0], 1),
            corner(5, 1),
            arc(0, 1, [0, 0], 1),
        ],
        2,
    );
    assert_eq!(check(slot, 2.0 * (10.0 + PI)), [8, 12, 6, 6]);
    // A block with one rounded corner and one fillet.
    let rounded = extruded(
        &[
            corner(0, 0),
            corner(6, 0),
            corner(6, 1),
            arc(3, 1, [3, 3], -2),
            corner(1, 3),
            corner(1, 5),
            corner(0, 5),
        ],
        1,
    );
    // The arms, and the square at the fillet without a quarter of a disc.
    let [_, _, _, faces] = check(rounded, 6.0 + 4.0 + 4.0 - PI);
    assert_eq!(faces, 9);
    // An arc that meets its segment at a right angle, on either side.
    let convex = extruded(&[arc(2, 0, [0, 0], 2), corner(-2, 0)], 1);
    assert_eq!(check(convex, 2.0 * PI), [4, 6, 4, 4]);
    let concave = extruded(
        &[
            corner(-4, 0),
            arc(-4, -3, [0, -3], -4),
            corner(4, -3),
            corner(4, 3),
            corner(-4, 3),
        ],
        1,
    );
    let [_, _, _, faces] = check(concave, 48.0 - 8.0 * PI);
    assert_eq!(faces, 6);
}

#[test]
fn a_scaled_prism_has_an_apex_or_a_smaller_top() {
    let square = || Figure::polygon(&[points(&[[-2, -2], [2, -2], [2, 2], [-2, 2]])]).unwrap();
    let pyramid = Primitive::scaled_prism(square(), n(3), n(0)).unwrap();
    assert_eq!(check(pyramid, 16.0), [5, 8, 5, 5]);
    let half = Rational::ONE / n(2);
    let frustum = Primitive::scaled_prism(square(), n(3), half.clone()).unwrap();
    assert_eq!(check(frustum, 28.0), [8, 12, 6, 6]);
    // A figure away from the axis leans.
    let away = Figure::polygon(&[points(&[[1, 1], [3, 1], [3, 4], [2, 2], [1, 4]])]).unwrap();
    let area = away.area();
    let leaning = Primitive::scaled_prism(away, n(2), n(3)).unwrap();
    check(leaning, area * 2.0 / 3.0 * 13.0);
    let disc = Figure::disc(&n(2)).unwrap();
    let cone = Primitive::scaled_prism(disc, n(3), half).unwrap();
    assert_eq!(check(cone, 7.0 * PI), [0, 2, 4, 3]);
}

fn revolution(contours: &[&[[i32; 2]]], degrees: Option<i32>) -> Primitive {
    let angle = degrees.map(|degrees| RevolutionAngle::new(n(degrees)).unwrap());
    Primitive::revolution(polygon(contours).unwrap(), angle).unwrap()
}

#[test]
fn a_revolution_has_a_face_for_every_edge_off_the_axis() {
    let pulley: &[[i32; 2]] = &[
        [4, 0],
        [25, 0],
        [25, 2],
        [18, 6],
        [18, 8],
        [25, 12],
        [25, 14],
        [8, 14],
        [8, 20],
        [4, 20],
    ];
    // Pappus: twice pi times the first moment of the area.
    let next = pulley.iter().cycle().skip(1);
    let moment = |(p, q): (&[i32; 2], &[i32; 2])| {
        let [[a, b], [c, d]] = [p, q].map(|p| p.map(f64::from));
        (a * d - c * b) * (a + c) / 6.0
    };
    let moment: f64 = pulley.iter().zip(next).map(moment).sum();
    assert_eq!(
        check(revolution(&[pulley], None), 2.0 * PI * moment),
        [0, 10, 20, 10]
    );
    for degrees in [60, 90, 180, 270, 300] {
        let part = revolution(&[pulley], Some(degrees));
        let volume = f64::from(degrees) / 180.0 * PI * moment;
        assert_eq!(check(part, volume), [20, 30, 12, 12], "{degrees}");
    }
    // A solid with an apex and the axis inside it: a cone on a cylinder.
    let pencil: &[[i32; 2]] = &[[0, 0], [2, 0], [2, 5], [0, 8]];
    assert_eq!(check(revolution(&[pencil], None), 24.0 * PI), [0, 2, 4, 3]);
    for degrees in [90, 180, 270] {
        let volume = 24.0 * PI * f64::from(degrees) / 360.0;
        let [_, _, _, faces] = check(revolution(&[pencil], Some(degrees)), volume);
        assert_eq!(faces, if degrees == 180 { 4 } else { 5 });
    }
}

#[test]
fn arcs_revolve_to_spheres_and_tori() {
    let half = [arc(0, -3, [0, 0], 3), corner(0, 3)];
    let ball = Primitive::revolution(Figure::from_contours(&[half.to_vec()]).unwrap(), None);
    assert_eq!(check(ball.unwrap(), 36.0 * PI), [0, 0, 0, 1]);
    // A disc with a rounded rim.
    let rim = [
        corner(0, -1),
        arc(4, -1, [4, 0], 1),
        corner(4, 1),
        corner(0, 1),
    ];
    let figure = Figure::from_contours(&[rim.to_vec()]).unwrap();
    let area = 4.0 * 4.0 * 2.0 * PI + 2.0 * PI * (PI / 2.0 * 4.0 + 2.0 / 3.0);
    assert_eq!(
        check(Primitive::revolution(figure, None).unwrap(), area),
        [0, 2, 4, 3]
    );
    // A groove in a shaft.
    let groove = [
        corner(0, -4),
        corner(5, -4),
        corner(5, -1),
        arc(5, -1, [5, 0], -1),
        corner(5, 1),
        corner(5, 4),
        corner(0, 4),
    ];
    let figure = Figure::from_contours(&[groove.to_vec()]).unwrap();
    let groove = 2.0 * PI * (PI / 2.0 * 5.0 - 2.0 / 3.0);
    let part = Primitive::revolution(figure, None).unwrap();
    let [_, _, _, faces] = check(part, 200.0 * PI - groove);
    assert_eq!(faces, 5);
}

/// The volume swept by the part beyond the axis of a disc of radius 5 about a point at a distance
/// from the axis, which is negative on the other side: 2 pi times the integral of
/// 2 x sqrt(25 - (x - d)²).
fn swept_disc(distance: f64) -> f64 {
    let half: f64 = (25.0 - distance * distance).sqrt();
    let area = 25.0 * (PI / 2.0 + (distance / 5.0).asin()) + distance * half;
    2.0 * PI * (distance * area + 2.0 / 3.0 * half.powi(3))
}

#[test]
fn arcs_may_reach_the_axis() {
    // A lemon, and an apple with a core.
    let lemon = Figure::from_contours(&[vec![arc(0, -4, [-3, 0], 5), corner(0, 4)]]).unwrap();
    let lemon = Primitive::revolution(lemon, None).unwrap();
    assert_eq!(check(lemon, swept_disc(-3.0)), [0, 0, 0, 1]);
    let apple = Figure::from_contours(&[vec![arc(0, -4, [3, 0], 5), corner(0, 4)]]).unwrap();
    let quarter = RevolutionAngle::new(n(90)).unwrap();
    let whole = Primitive::revolution(apple.clone(), None).unwrap();
    assert_eq!(check(whole, swept_disc(3.0)), [0, 0, 0, 1]);
    let quarter = Primitive::revolution(apple, Some(quarter)).unwrap();
    assert_eq!(check(quarter, swept_disc(3.0) / 4.0), [2, 3, 3, 3]);
    // A disc that touches the axis, and the half of it above.
    let disc = Figure::disc(&n(5)).unwrap();
    let map = PlaneMap {
        offset: [n(5), n(0)],
        ..PlaneMap::identity()
    };
    let touching = disc.mapped(&map).unwrap();
    let horn = Primitive::revolution(touching, None).unwrap();
    assert_eq!(check(horn, 250.0 * PI * PI), [0, 0, 0, 1]);
    let above = [arc(10, 0, [5, 0], 5), corner(0, 0)];
    let above = Figure::from_contours(&[above.to_vec()]).unwrap();
    let above = Primitive::revolution(above, None).unwrap();
    let [_, _, _, faces] = check(above, 125.0 * PI * PI);
    assert_eq!(faces, 2);
}

#[test]
fn sections_combine_with_other_solids() {
    // A hole through a wall, at the corner of an L, and half outside.
    let tree = tree_of(|builder| {
        let part = builder.primitive(prism(
            &[&[[0, 0], [6, 0], [6, 2], [2, 2], [2, 4], [0, 4]]],
            2,
        ));
        let hole = Primitive::cylinder(n(1), n(4)).unwrap();
        let hole = builder.primitive(hole);
        let hole = shifted(builder, hole, [2, 2, -1]);
        builder.operation(Operation::Difference, &[part, hole])
    });
    let known = evaluated(&tree);
    let volume = 2.0 * (16.0 - 0.75 * PI);
    assert!((known.mass().volume - volume).abs() < 1e-10);
    // The other half of the same figure: the common faces vanish.
    let both = tree_of(|builder| {
        let left = builder.primitive(prism(&[&[[0, 0], [4, 0], [2, 2], [4, 4], [0, 4]]], 2));
        let right = builder.primitive(prism(&[&[[8, 0], [8, 4], [4, 4], [2, 2], [4, 0]]], 2));
        builder.operation(Operation::Union, &[left, right])
    });
    let known = evaluated(&both);
    assert_eq!(known.brep.topology.census().cells, [8, 12, 6, 6]);
    assert!((known.mass().volume - 64.0).abs() < 1e-10);
}

#[test]
fn a_disc_is_a_cylinder() {
    // Pieces of curves have their middles on the chord of the disc's arcs, and where these join.
    let disc = || Primitive::prism(Figure::disc(&n(2)).unwrap(), n(2)).unwrap();
    let cylinder = || Primitive::cylinder(n(2), n(2)).unwrap();
    let triangle = Figure::polygon(&[points(&[[9, 8], [9, 9], [2, 0]])]).unwrap();
    let half = Rational::ONE / n(2);
    let leaning = Primitive::scaled_prism(triangle, n(4), half).unwrap();
    let [a, b] = [disc(), cylinder()].map(|round| {
        let tree = tree_of(|builder| {
            let round = builder.primitive(round);
            let round = shifted(builder, round, [6, 4, 0]);
            let other = builder.primitive(leaning.clone());
            builder.operation(Operation::Difference, &[round, other])
        });
        let known = evaluated(&tree);
        (known.mass().volume, known.brep.topology.census().cells)
    });
    assert_eq!(a.1, b.1);
    assert!((a.0 - b.0).abs() < 1e-10);
}

#[test]
fn a_mirror_image_is_mirrored() {
    let shapes = [
        prism(&[&[[0, 0], [6, 0], [6, 1], [1, 1], [1, 4], [0, 4]]], 2),
        revolution(&[&[[1, 0], [3, 0], [2, 4]]], Some(100)),
    ];
    for primitive in shapes {
        let plain = tree_of(|builder| builder.primitive(primitive.clone()));
        let mirrored = tree_of(|builder| {
            let part = builder.primitive(primitive.clone());
            builder.mirrored_y(part)
        });
        let [a, b] = [&plain, &mirrored].map(|tree| evaluated(tree).mass());
        assert!((a.volume - b.volume).abs() < 1e-9 * a.volume);
        assert!((a.centroid.x - b.centroid.x).abs() < 1e-9);
        assert!((a.centroid.y + b.centroid.y).abs() < 1e-9);
        let [plain, mirrored] = [plain, mirrored].map(|tree| RayOracle::new(&tree));
        for k in 0..500 {
            let f = |a: f64| (f64::from(k) * a).fract();
            let at = |y: f64| nalgebra::Point3::new(8.0 * f(0.754) - 2.0, y, 5.0 * f(0.569));
            let y = 8.0 * f(0.412) - 3.987;
            assert_eq!(
                plain.contains(&at(y)),
                mirrored.contains(&at(-y)),
                "{k} {y}"
            );
        }
    }
}

#[test]
fn exact_evaluation_agrees() {
    let options = EvaluationOptions {
        zeros: premio_kernel::number::predicates::CoincidencePolicy::Exact,
        ..EvaluationOptions::default()
    };
    let parts = [
        prism(&[SQUARE, &[[1, 1], [3, 1], [2, 3]]], 3),
        revolution(&[&[[1, 0], [3, 0], [2, 4]]], None),
    ];
    for (part, volume) in parts.into_iter().zip([42.0, 16.0 * PI]) {
        let tree = tree_of(|builder| builder.primitive(part));
        let known = evaluate(&tree, &options).unwrap();
        assert!((known.mass().volume - volume).abs() < 1e-10);
    }
}

#[test]
fn a_gear_with_a_bore_is_evaluated() {
    let teeth = 250;
    let corners: Vec<FigurePoint> = (0..4 * teeth)
        .map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(4 * teeth);
            let radius = if i % 4 < 2 { 50.0 } else { 48.0 };
            let (sin, cos) = angle.sin_cos();
            [radius * cos, radius * sin]
                .map(|x| premio_kernel::number::rational::from_f64(x).unwrap())
        })
        .collect();
    let figure = Figure::polygon(&[corners]).unwrap();
    let area = figure.area();
    let tree = tree_of(|builder| {
        let gear = builder.primitive(Primitive::prism(figure, n(10)).unwrap());
        let bore = builder.primitive(Primitive::cylinder(n(8), n(12)).unwrap());
        let bore = shifted(builder, bore, [0, 0, -1]);
        builder.operation(Operation::Difference, &[gear, bore])
    });
    let known = evaluated(&tree);
    let volume = 10.0 * (area - 64.0 * PI);
    assert!((known.mass().volume - volume).abs() < 1e-9 * volume);
    assert_eq!(known.brep.topology.faces.len(), 1003);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// The volume of a prism is the area of its figure times the height, by the shoelace formula,
    /// whatever the polygon.
    #[test]
    fn random_prisms_have_the_volume_of_their_figure(
        corners in prop::collection::vec(prop::array::uniform2(0i32..9), 3..12),
    ) {
        let Ok(figure) = polygon(&[&corners]) else { return Ok(()) };
        let area = figure.area();
        let tree = tree_of(|b| b.primitive(Primitive::prism(figure, n(2)).unwrap()));
        let known = evaluate(&tree, &EvaluationOptions::default())
            .map_err(|error| TestCaseError::fail(format!("{corners:?}: {error}")))?;
        prop_assert!((known.mass().volume - 2.0 * area).abs() < 1e-9, "{:?}", corners);
        let rays = RayOracle::new(&tree).volume(1024, 1);
        prop_assert!(rays.deviation(2.0 * area, 1e-9) < 7.0);
    }

    /// The volume of a revolution is by Pappus that of its figure's first moment.
    #[test]
    fn random_revolutions_follow_pappus(
        corners in prop::collection::vec(prop::array::uniform2(0i32..7), 3..8),
        degrees in prop::option::of(1i32..360),
    ) {
        let Ok(figure) = polygon(&[&corners]) else { return Ok(()) };
        let moment: f64 = figure.edges().iter().map(|edge| {
            let [[a, b], [c, d]] = [&edge.start, &edge.end].map(|p| p.each_ref().map(to_f64));
            (a * d - c * b) * (a + c) / 6.0
        }).sum();
        let angle = degrees.map(|degrees| RevolutionAngle::new(n(degrees)).unwrap());
        let turn = degrees.map_or(2.0 * PI, |degrees| f64::from(degrees).to_radians());
        let primitive = Primitive::revolution(figure, angle).unwrap();
        let tree = tree_of(|b| b.primitive(primitive));
        let known = evaluate(&tree, &EvaluationOptions::default())
            .map_err(|error| TestCaseError::fail(format!("{corners:?} {degrees:?}: {error}")))?;
        let volume = turn * moment;
        prop_assert!((known.mass().volume - volume).abs() < 1e-8, "{:?} {:?}", corners, degrees);
        let rays = RayOracle::new(&tree).volume(1024, 1);
        prop_assert!(rays.deviation(volume, 1e-9) < 7.0);
    }
}
