//! Tests of figures.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use super::*;
use proptest::prelude::*;

fn points(list: &[[i32; 2]]) -> Vec<FigurePoint> {
    list.iter().map(|p| p.map(Rational::from)).collect()
}

fn polygon(contours: &[&[[i32; 2]]]) -> Result<Figure, FigureError> {
    let contours: Vec<Vec<FigurePoint>> = contours.iter().map(|c| points(c)).collect();
    Figure::polygon(&contours)
}

fn counts(figure: &Figure) -> [usize; 2] {
    [figure.edges().len(), figure.contours().count()]
}

const SQUARE: &[[i32; 2]] = &[[0, 0], [4, 0], [4, 4], [0, 4]];

#[test]
fn a_contour_is_turned_to_have_the_material_on_its_left() {
    let mut backwards = SQUARE.to_vec();
    backwards.reverse();
    for square in [SQUARE, &backwards] {
        assert_eq!(polygon(&[square]).unwrap().area(), 16.0);
        let hole = polygon(&[square, &[[1, 1], [2, 1], [2, 3], [1, 3]]]).unwrap();
        assert_eq!(hole.area(), 14.0);
        assert_eq!(counts(&hole), [8, 2]);
    }
}

#[test]
fn corners_in_line_are_no_corners() {
    let figure = polygon(&[&[[0, 0], [2, 0], [4, 0], [4, 4], [4, 4], [0, 4], [0, 1]]]).unwrap();
    assert_eq!(counts(&figure), [4, 1]);
    assert_eq!(figure.area(), 16.0);
}

#[test]
fn common_edges_cancel() {
    // A hole with an edge on the outline is a notch.
    let notch = polygon(&[SQUARE, &[[1, 0], [3, 0], [3, 2], [1, 2]]]).unwrap();
    assert_eq!(counts(&notch), [8, 1]);
    assert_eq!(notch.area(), 12.0);
    // Two neighbours are one, and a figure twice is none.
    let both = polygon(&[SQUARE, &[[4, 0], [8, 0], [8, 4], [4, 4]]]).unwrap();
    assert_eq!(counts(&both), [4, 1]);
    assert_eq!(both.area(), 32.0);
    assert_eq!(polygon(&[SQUARE, SQUARE]), Err(FigureError::Empty));
    // A spike has no area.
    let spike = polygon(&[&[[0, 0], [4, 0], [8, 0], [4, 0], [4, 4], [0, 4]]]).unwrap();
    assert_eq!(counts(&spike), [4, 1]);
}

#[test]
fn crossing_edges_follow_the_even_odd_rule() {
    let bow = polygon(&[&[[0, 0], [4, 4], [4, 0], [0, 4]]]).unwrap();
    assert_eq!(bow.area(), 8.0);
    assert_eq!(counts(&bow), [6, 2]);
    let cross = polygon(&[SQUARE, &[[2, 2], [6, 2], [6, 6], [2, 6]]]).unwrap();
    assert_eq!(cross.area(), 24.0);
}

#[test]
fn a_hole_may_touch_the_outline_in_a_corner() {
    let figure = polygon(&[SQUARE, &[[0, 2], [2, 1], [2, 3]]]).unwrap();
    assert_eq!(figure.area(), 14.0);
    assert_eq!(counts(&figure), [7, 2]);
}

#[test]
fn a_disc_has_the_area_of_its_radius() {
    let disc = Figure::disc(&Rational::from(2)).unwrap();
    assert!((disc.area() - 4.0 * std::f64::consts::PI).abs() < 8.0 * f64::EPSILON * 4.0);
    assert_eq!(disc.bounds(), [[-2.0; 2], [2.0; 2]]);
    let moved = PlaneMap {
        matrix: [[0, -3], [-3, 0]].map(|row| row.map(Rational::from)),
        offset: [1, 2].map(Rational::from),
    };
    let image = disc.mapped(&moved).unwrap();
    assert_eq!(image.bounds(), [[-5.0, -4.0], [7.0, 8.0]]);
    assert!(image.area() > 0.0);
    let wide = PlaneMap {
        matrix: [[2, 0], [0, 1]].map(|row| row.map(Rational::from)),
        ..PlaneMap::identity()
    };
    assert_eq!(disc.mapped(&wide), Err(FigureError::Elliptic));
}

/// Twice the signed area of a polygon.
fn shoelace(points: &[[i32; 2]]) -> i64 {
    let next = points.iter().cycle().skip(1);
    let twice = |(p, q): (&[i32; 2], &[i32; 2])| {
        i64::from(p[0]) * i64::from(q[1]) - i64::from(p[1]) * i64::from(q[0])
    };
    points.iter().zip(next).map(twice).sum()
}

/// The number of edges that the ray from a point of half numbers towards +x crosses.
fn crossed(points: &[[i32; 2]], at: [i32; 2]) -> usize {
    let next = points.iter().cycle().skip(1);
    let pairs = points.iter().zip(next);
    let twice = |p: &[i32; 2]| p.map(|x| 4 * x);
    pairs
        .filter(|(p, q)| {
            let ([px, py], [qx, qy]) = (twice(p), twice(q));
            let up = i64::from(qx - px) * i64::from(at[1] - py)
                - i64::from(qy - py) * i64::from(at[0] - px);
            (py > at[1]) != (qy > at[1]) && (up > 0) == (qy > py)
        })
        .count()
}

/// A point of the plane's quarters as rounded numbers, and whether a figure has it by its edges.
fn contains(figure: &Figure, at: [i32; 2]) -> bool {
    let p = at.map(|x| f64::from(x) / 4.0);
    let crossed = figure.edges().iter().filter(|edge| {
        let [s, e] = [&edge.start, &edge.end].map(|p| p.each_ref().map(to_f64));
        let x = s[0] + (p[1] - s[1]) / (e[1] - s[1]) * (e[0] - s[0]);
        (s[1] > p[1]) != (e[1] > p[1]) && x > p[0]
    });
    crossed.count() % 2 == 1
}

proptest! {
    #[test]
    fn random_polygons_follow_the_even_odd_rule(
        corners in prop::collection::vec(prop::array::uniform2(0i32..8), 3..9),
    ) {
        let figure = match polygon(&[&corners]) {
            Ok(figure) => figure,
            Err(FigureError::Empty) => {
                prop_assert_eq!(shoelace(&corners) % 2, 0);
                return Ok(());
            }
            Err(error) => return Err(TestCaseError::fail(error.to_string())),
        };
        // Quarter points at odd heights are on few lines; those on one are skipped.
        for x in (1..32).step_by(2) {
            for y in (1..32).step_by(2) {
                let at = [x, y];
                let next = corners.iter().cycle().skip(1);
                let on = corners.iter().zip(next).any(|(p, q)| {
                    let ([px, py], [qx, qy]) = (p.map(|x| 4 * x), q.map(|x| 4 * x));
                    (qx - px) * (y - py) == (qy - py) * (x - px)
                });
                if !on {
                    prop_assert_eq!(contains(&figure, at), crossed(&corners, at) % 2 == 1);
                }
            }
        }
        prop_assert!(figure.area() > 0.0);
    }

    /// Triangles that run counterclockwise have their union about them, those that run clockwise
    /// take as much away as others add.
    #[test]
    fn winding_numbers_of_random_triangles(
        triangles in prop::collection::vec(prop::array::uniform3(prop::array::uniform2(0i32..8)), 1..7),
    ) {
        let sides = |corners: &[[i32; 2]; 3]| [0, 1, 2].map(|k| [corners[k], corners[(k + 1) % 3]]);
        let all: Vec<[[i32; 2]; 2]> = triangles.iter().flat_map(sides).collect();
        let segments: Vec<[FigurePoint; 2]> = all
            .iter()
            .map(|[p, q]| [p, q].map(|p| p.map(Rational::from)))
            .collect();
        let figure = Figure::wound(&segments).ok();
        for x in (1..32).step_by(2) {
            for y in (1..32).step_by(2) {
                let at = [x, y];
                let on = all.iter().any(|[p, q]| {
                    let ([px, py], [qx, qy]) = (p.map(|x| 4 * x), q.map(|x| 4 * x));
                    (qx - px) * (y - py) == (qy - py) * (x - px)
                });
                if on {
                    continue;
                }
                let windings = triangles.iter().map(|corners| {
                    shoelace(corners).signum() * (crossed(corners, at) % 2) as i64
                });
                let is_about = windings.sum::<i64>() > 0;
                let is_in = figure.as_ref().is_some_and(|figure| contains(figure, at));
                prop_assert_eq!(is_in, is_about);
            }
        }
    }
}

#[test]
fn a_hull_of_discs_and_points() {
    let disc = |x: i32, y: i32, r: i32| Disc {
        centre: [x, y].map(Rational::from),
        radius: Rational::from(r),
    };
    let pi = std::f64::consts::PI;
    let area = |discs: &[Disc]| Figure::convex_hull(discs).unwrap();
    let near = |figure: Figure, area: f64| {
        assert!(
            (figure.area() - area).abs() < 64.0 * f64::EPSILON * area,
            "{figure:?}"
        );
    };
    near(area(&[disc(0, 0, 1), disc(6, 0, 1)]), 12.0 + pi);
    // Four equal corners of a plate, and discs inside.
    let plate = [
        disc(0, 0, 1),
        disc(6, 0, 1),
        disc(6, 4, 1),
        disc(0, 4, 1),
        disc(3, 2, 1),
    ];
    let rounded = area(&plate);
    assert_eq!(counts(&rounded), [8, 1]);
    near(rounded, 24.0 + 20.0 + pi);
    // A big disc between points on either side is passed twice.
    let lens = area(&[disc(0, 0, 3), disc(5, 0, 0), disc(-5, 0, 0)]);
    assert_eq!(counts(&lens), [6, 1]);
    near(
        lens,
        4.0 * 6.0 + 2.0 * 9.0 * (pi / 2.0 - (4.0f64 / 3.0).atan()),
    );
    // Points only, some of them in line.
    let points = [
        disc(0, 0, 0),
        disc(2, 0, 0),
        disc(4, 0, 0),
        disc(4, 4, 0),
        disc(1, 1, 0),
    ];
    let hull = area(&points);
    assert_eq!(counts(&hull), [3, 1]);
    near(hull, 8.0);
    assert_eq!(Figure::convex_hull(&points[..2]), Err(FigureError::Empty));
    near(area(&[disc(1, 1, 2), disc(1, 1, 1)]), 4.0 * pi);
}

/// Where the arcs of a disc start decides nothing about its part on the right of the axis.
#[test]
fn the_right_of_a_disc_is_half_of_it() {
    let quarter = |k: usize| [[1, 0], [0, 1], [-1, 0], [0, -1]][k % 4].map(Rational::from);
    let turns = (0..4).map(|k| [quarter(k), quarter(k + 1)]);
    let skew = [[3, 4], [-4, 3]].map(|row| row.map(|x| Rational::from(x) / Rational::from(5)));
    for [u, v] in turns.chain([skew]) {
        let [[a, b], [c, d]] = [u, v];
        let map = PlaneMap {
            matrix: [[a, c], [b, d]],
            offset: [Rational::ZERO, Rational::from(7)],
        };
        let disc = Figure::disc(&Rational::from(2)).unwrap();
        let turned = disc.mapped(&map).unwrap();
        let right = turned.right_of_axis().unwrap().unwrap();
        assert!((right.area() - 2.0 * std::f64::consts::PI).abs() < 1e-12);
    }
}

/// A disc of radius 5 about a point 3 from the axis, on either side: half of the disc and the
/// segment next to it, or less that segment.
#[test]
fn arcs_are_clipped_at_the_axis() {
    let map = PlaneMap {
        offset: [Rational::from(3), Rational::ZERO],
        ..PlaneMap::identity()
    };
    let disc = Figure::disc(&Rational::from(5)).unwrap();
    let disc = disc.mapped(&map).unwrap();
    let segment = 25.0 * 0.6f64.asin() + 3.0 * 4.0;
    for (disc, sign, reach) in [(&disc, 1.0, 8.0), (&disc.mirrored_x(), -1.0, 2.0)] {
        let kept = disc.right_of_axis().unwrap().unwrap();
        let [lo, hi] = kept.bounds();
        assert!(lo[0].abs() < 1e-12 && (hi[0] - reach).abs() < 1e-12);
        let area = 12.5 * std::f64::consts::PI + sign * segment;
        assert!((kept.area() - area).abs() < 1e-12, "{}", kept.area());
    }
}
