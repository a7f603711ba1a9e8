use super::super::*;
use super::*;
use premio_kernel::number::rational::{Rational, from_f64};
use proptest::prelude::*;
use std::f64::consts::PI;

fn n(x: i32) -> Rational {
    Rational::from(x)
}

fn moved(figure: &Figure, x: i32, y: i32) -> Figure {
    let map = PlaneMap {
        offset: [n(x), n(y)],
        ..PlaneMap::identity()
    };
    figure.mapped(&map).unwrap()
}

fn square(size: i32) -> Figure {
    Figure::rectangle(&[n(size), n(size)]).unwrap()
}

fn disc(radius: i32) -> Figure {
    Figure::disc(&n(radius)).unwrap()
}

#[track_caller]
fn assert_area(figure: &Figure, area: f64) {
    let found = figure.area();
    assert!(
        (found - area).abs() <= 1e-12 * area,
        "{found} and not {area}"
    );
}

const ALL: [FigureOperation; 3] = [
    FigureOperation::Union,
    FigureOperation::Intersection,
    FigureOperation::Difference,
];

#[test]
fn squares_that_share_an_edge_are_one_rectangle() {
    let [a, b] = [square(2), moved(&square(2), 2, 0)];
    let whole = Figure::combined(FigureOperation::Union, &[&a, &b]).unwrap();
    assert_area(&whole, 8.0);
    assert_eq!(whole.edges().len(), 4);
    let common = Figure::combined(FigureOperation::Intersection, &[&a, &b]);
    assert_eq!(common, Err(FigureError::Empty));
    let rest = Figure::combined(FigureOperation::Difference, &[&a, &b]).unwrap();
    assert_area(&rest, 4.0);
}

#[test]
fn a_disc_is_cut_from_a_square() {
    let plate = Figure::combined(FigureOperation::Difference, &[&square(4), &disc(1)]).unwrap();
    assert_area(&plate, 16.0 - PI / 4.0);
    assert_eq!(plate.edges().len(), 5);
    let hole = moved(&disc(1), 2, 2);
    let plate = Figure::combined(FigureOperation::Difference, &[&square(4), &hole]).unwrap();
    assert_area(&plate, 16.0 - PI);
    assert_eq!(plate.contours().count(), 2);
    // The hole touches all four edges from the inside.
    let hole = moved(&disc(2), 2, 2);
    let corners = Figure::combined(FigureOperation::Difference, &[&square(4), &hole]).unwrap();
    assert_area(&corners, 16.0 - 4.0 * PI);
    assert_eq!(corners.contours().count(), 4);
    let whole = Figure::combined(FigureOperation::Union, &[&square(4), &hole]).unwrap();
    assert_area(&whole, 16.0);
}

#[test]
fn equal_discs_are_one_and_touching_ones_are_two() {
    let one = Figure::combined(FigureOperation::Union, &[&disc(2), &disc(2)]).unwrap();
    assert_area(&one, 4.0 * PI);
    let two =
        Figure::combined(FigureOperation::Union, &[&disc(2), &moved(&disc(1), 3, 0)]).unwrap();
    assert_area(&two, 5.0 * PI);
    let crescent = Figure::combined(
        FigureOperation::Difference,
        &[&disc(2), &moved(&disc(1), 1, 0)],
    )
    .unwrap();
    assert_area(&crescent, 3.0 * PI);
    let lens = Figure::combined(
        FigureOperation::Intersection,
        &[&disc(2), &moved(&disc(2), 2, 0)],
    )
    .unwrap();
    assert_area(&lens, 8.0 * PI / 3.0 - 12f64.sqrt());
}

#[test]
fn offsets_round_miter_and_chamfer_corners() {
    let plate = square(10);
    let root = 2f64.sqrt();
    for (join, growth, edges) in [
        (OffsetJoin::Round, PI, 8),
        (OffsetJoin::Miter, 4.0, 4),
        // A corner loses a right triangle with the height (root - 1).
        (OffsetJoin::Chamfer, 4.0 - 4.0 * (root - 1.0).powi(2), 8),
    ] {
        let grown = plate.offset(&n(1), join).unwrap();
        assert_area(&grown, 140.0 + growth);
        assert_eq!(grown.edges().len(), edges, "{join:?}");
        let shrunk = plate.offset(&n(-1), join).unwrap();
        assert_area(&shrunk, 64.0);
        assert_eq!(shrunk.edges().len(), 4);
        let nothing = plate.offset(&n(-5), join);
        assert_eq!(nothing, Err(FigureError::Empty));
        let hole = moved(&square(2), 4, 4);
        let frame = Figure::combined(FigureOperation::Difference, &[&plate, &hole]).unwrap();
        let closed = frame.offset(&n(1), join).unwrap();
        assert_area(&closed, 140.0 + growth);
        assert_eq!(closed.contours().count(), 1);
    }
}

#[test]
fn a_hole_stays_however_small() {
    let ring = Figure::combined(FigureOperation::Difference, &[&disc(10), &disc(5)]).unwrap();
    for zeros in [3, 6, 9] {
        let gap = Rational::ONE / Rational::from(10u64.pow(zeros));
        let grown = ring.offset(&(n(5) - &gap), OffsetJoin::Round).unwrap();
        assert_eq!(grown.contours().count(), 2, "1e-{zeros}");
    }
    let filled = ring.offset(&n(5), OffsetJoin::Round).unwrap();
    assert_eq!(filled.contours().count(), 1);
    let least = Rational::ONE / Rational::from(10u64.pow(9));
    let grown = square(10).offset(&least, OffsetJoin::Round).unwrap();
    assert_eq!(grown.edges().len(), 8);
}

#[test]
fn an_offset_polygon_has_one_edge_for_each() {
    let corner = |k: u32| direction(&(n(72) * Rational::from(k)));
    let pentagon = Figure::polygon(&[(0..5).map(corner).collect()]).unwrap();
    let by = Rational::ONE / n(10);
    let grown = |join| pentagon.offset(&by, join).unwrap().edges().len();
    assert_eq!(grown(OffsetJoin::Miter), 5);
    assert_eq!(grown(OffsetJoin::Chamfer), 10);
    assert_eq!(grown(OffsetJoin::Round), 10);
    let shrunk = pentagon.offset(&-by, OffsetJoin::Round).unwrap();
    assert_eq!(shrunk.edges().len(), 5);
}

#[test]
fn a_fillet_is_an_offset_back_and_forth() {
    let ell = Figure::polygon(&[[[0, 0], [6, 0], [6, 2], [2, 2], [2, 6], [0, 6]]
        .map(|p| p.map(n))
        .to_vec()])
    .unwrap();
    let corner = 1.0 - PI / 4.0;
    // The inner corner gets a fillet, and the five outer ones are rounded.
    let grown = ell.offset(&n(1), OffsetJoin::Round).unwrap();
    let filled = grown.offset(&n(-2), OffsetJoin::Round).unwrap();
    let filled = filled.offset(&n(1), OffsetJoin::Round);
    assert_eq!(filled.err(), None);
    let shrunk = grown.offset(&n(-1), OffsetJoin::Round).unwrap();
    assert_area(&shrunk, 20.0 + corner);
    assert_eq!(shrunk.edges().len(), 7);
}

#[test]
fn minkowski_sums() {
    let [plate, tool] = [square(4), square(2)];
    let sum = plate.minkowski_sum(&tool).unwrap();
    assert_area(&sum, 36.0);
    assert_eq!(sum.edges().len(), 4);
    let rounded = plate.minkowski_sum(&moved(&disc(1), 5, 5)).unwrap();
    assert_area(&rounded, 32.0 + PI);
    let slot = plate.offset(&n(1), OffsetJoin::Round).unwrap();
    let both = slot.minkowski_sum(&tool).unwrap();
    assert_area(&both, 36.0 + 24.0 + PI);
    let ring = Figure::combined(
        FigureOperation::Difference,
        &[&square(12), &moved(&square(6), 3, 3)],
    )
    .unwrap();
    let thick = ring.minkowski_sum(&tool).unwrap();
    assert_area(&thick, 14.0 * 14.0 - 16.0);
}

#[test]
fn hulls_of_figures_with_arcs() {
    let half = Figure::combined(
        FigureOperation::Intersection,
        &[&disc(2), &moved(&square(8), -4, 0)],
    )
    .unwrap();
    assert_area(&half, 2.0 * PI);
    let own = Figure::hull_of(&[&half]).unwrap();
    assert_area(&own, 2.0 * PI);
    assert_eq!(own.edges().len(), 2);
    // Below the half disc the hull is a trapezium between the diameter and the square: the tangents
    // of the whole circle, which is not there, would give it other corners.
    let with_square = Figure::hull_of(&[&half, &moved(&square(1), 0, -3)]).unwrap();
    assert_area(&with_square, 2.0 * PI + 7.5);
    assert_eq!(with_square.edges().len(), 4);
    // The lowest points are in line; those between the ends are passed at the start only.
    let row = [
        moved(&square(1), 2, 0),
        moved(&square(1), 5, 0),
        square(1),
        moved(&disc(1), 3, 7),
    ];
    let row = Figure::hull_of(&row.iter().collect::<Vec<_>>()).unwrap();
    assert_eq!(
        row.edges().iter().filter(|edge| edge.arc.is_none()).count(),
        5
    );
    let slot = Figure::hull_of(&[&disc(1), &moved(&disc(1), 4, 0)]).unwrap();
    assert_area(&slot, 8.0 + PI);
    let again = Figure::hull_of(&[&slot]).unwrap();
    assert_area(&again, 8.0 + PI);
}

fn shapes() -> impl Strategy<Value = Figure> {
    let quarter = |x: i32| Rational::from(x) / Rational::from(4);
    let polygon = prop::collection::vec(prop::array::uniform2(-12i32..12), 3..8);
    let polygon = polygon.prop_filter_map("without area", move |points| {
        Figure::polygon(&[points.into_iter().map(|p| p.map(quarter)).collect()]).ok()
    });
    let disc = (1i32..9, -8i32..8, -8i32..8).prop_map(move |(r, x, y)| {
        let map = PlaneMap {
            offset: [x, y].map(quarter),
            ..PlaneMap::identity()
        };
        Figure::disc(&quarter(r)).unwrap().mapped(&map).unwrap()
    });
    prop_oneof![polygon, disc]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// |A| + |B| = |A or B| + |A and B|, and |A| = |A and B| + |A less B|.
    #[test]
    fn areas_add_up(a in shapes(), b in shapes(), degrees in 0..90) {
        let turn = direction(&n(degrees));
        let [cos, sin] = turn;
        let map = PlaneMap {
            matrix: [[cos.clone(), -&sin], [sin, cos]],
            ..PlaneMap::identity()
        };
        let b = b.mapped(&map).unwrap_or(b);
        let area = |op| match Figure::combined(op, &[&a, &b]) {
            Ok(figure) => Ok(figure.area()),
            Err(FigureError::Empty) => Ok(0.0),
            Err(error) => Err(error),
        };
        let [union, common, rest] = ALL.map(area);
        let (union, common, rest) = (union.unwrap(), common.unwrap(), rest.unwrap());
        let slack = 1e-10;
        prop_assert!((a.area() + b.area() - union - common).abs() < slack);
        prop_assert!((a.area() - common - rest).abs() < slack);
    }

    /// A point is in an offset if it is within the distance of the figure.
    #[test]
    fn offsets_are_distances(
        a in shapes(),
        by in prop_oneof![1i32..12, -12i32..-1],
        points in prop::collection::vec(prop::array::uniform2(-5.0f64..5.0), 24),
    ) {
        let distance = Rational::from(by) / n(8);
        let grown = match a.offset(&distance, OffsetJoin::Round) {
            Ok(grown) => Some(grown),
            Err(FigureError::Empty) => None,
            Err(error) => panic!("{error}"),
        };
        let (own, grown) = (Outline::new(&a), grown.as_ref().map(Outline::new));
        for p in points {
            let at = p.map(F106::from_f64);
            let exact = p.map(|x| from_f64(x).unwrap());
            let away = a.edges().iter().map(|edge| {
                SupportedEdge::new(edge).distance(carrier::nearest(&exact)).rounded()
            });
            let away = away.fold(f64::INFINITY, f64::min);
            let inside = own.contains(at, F106::ZERO).unwrap_or(true);
            let level = if inside { -away } else { away };
            let expected = level - to_f64(&distance);
            if expected.abs() > 1e-9 {
                let found = grown.as_ref().is_some_and(|g| g.contains(at, F106::ZERO) == Some(true));
                prop_assert_eq!(found, expected < 0.0, "{:?} {}", p, expected);
            }
        }
    }
}
