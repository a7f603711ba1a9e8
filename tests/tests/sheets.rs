//! Views along the axes, with line lengths computed by hand from the dimensions. A missing line
//! makes the sum too small; a line drawn twice, or hidden under a visible one, makes it too large.

use nalgebra::Point2;
use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_drawing::sheet::StandardView;
use premio_drawing::{Drawing, Layer};
use premio_visibility::Contours;
use premio_visibility::contours;
use premio_visibility::contours::ImageCurve;
use std::f64::consts::PI;

fn seen(part: &str, view: StandardView) -> Contours {
    let text = format!("P = {part}");
    let read = read(
        "part",
        text.as_bytes(),
        Format::Padl,
        &ReadOptions::default(),
    )
    .unwrap();
    let known = evaluate(&read.tree, &EvaluationOptions::default()).unwrap();
    let bounds = known.tight_bounds();
    let camera = view.camera(bounds.centre(), bounds.diagonal()).unwrap();
    contours(&known.brep, &camera, known.resolution).unwrap()
}

fn drawn(part: &str, view: StandardView, smooth: bool) -> Drawing {
    let options = premio_drawing::DrawingOptions {
        smooth,
        ..premio_drawing::DrawingOptions::default()
    };
    Drawing::new(&seen(part, view), &options)
}

/// The lengths of the selected strokes: visible, and hidden.
fn lengths(drawing: &Drawing, suits: impl Fn(Layer) -> bool) -> [f64; 2] {
    [true, false].map(|visible| {
        let mine = drawing.strokes.iter();
        let mine = mine.filter(|s| s.visible == visible && suits(s.layer));
        mine.map(|s| s.shape.length()).sum()
    })
}

fn assert_lengths(part: &str, view: StandardView, expected: [f64; 2]) {
    let found = lengths(&drawn(part, view, false), |_| true);
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            (found - expected).abs() < 1e-6,
            "{view:?} {found} for {expected}"
        );
    }
}

/// A plate of 70 by 30 by 8 with corners of radius 5.
const PLATE: &str = "BLO(X=60,Y=30,Z=8) AT (MOVX=5) UN BLO(X=70,Y=20,Z=8) AT (MOVY=5) \
     UN CYL(R=5,H=8) AT (MOVX=5,MOVY=5) UN CYL(R=5,H=8) AT (MOVX=65,MOVY=5) \
     UN CYL(R=5,H=8) AT (MOVX=5,MOVY=25) UN CYL(R=5,H=8) AT (MOVX=65,MOVY=25)";

#[test]
fn a_plate_with_rounded_corners_is_closed() {
    assert_lengths(PLATE, StandardView::Front, [2.0 * (70.0 + 8.0), 0.0]);
    assert_lengths(PLATE, StandardView::Right, [2.0 * (30.0 + 8.0), 0.0]);
    assert_lengths(
        PLATE,
        StandardView::Top,
        [2.0 * (60.0 + 20.0) + 10.0 * PI, 0.0],
    );
}

/// From the front they are at 5 and at 65; those at 0 and at 70 are the outline.
#[test]
fn smooth_edges_are_drawn_where_they_are_not_the_outline() {
    let drawing = drawn(PLATE, StandardView::Front, true);
    let [visible, hidden] = lengths(&drawing, |layer| layer == Layer::Smooth);
    assert!(
        (visible - 16.0).abs() < 1e-9 && hidden == 0.0,
        "{visible} {hidden}"
    );
    let [visible, _] = lengths(&drawing, |layer| layer != Layer::Smooth);
    assert!((visible - 156.0).abs() < 1e-9, "{visible}");
}

/// A box of 20 by 30 by 40 with a radius of 5 at every edge: only limbs are drawn.
#[test]
fn a_rounded_box_has_its_outline() {
    let mut part =
        "BLO(X=20,Y=20,Z=30) AT (MOVY=5,MOVZ=5) UN BLO(X=10,Y=30,Z=30) AT (MOVX=5,MOVZ=5) \
         UN BLO(X=10,Y=20,Z=40) AT (MOVX=5,MOVY=5)"
            .to_owned();
    let [xs, ys, zs] = [[5, 15], [5, 25], [5, 35]];
    for a in 0..2 {
        for b in 0..2 {
            let (x, y, z) = (xs[a], ys[b], zs[b]);
            part += &format!(" UN CYL(R=5,H=30) AT (MOVX={x},MOVY={y},MOVZ=5)");
            part += &format!(" UN CYL(R=5,H=20) AT (ROTX=-90,MOVX={x},MOVY=5,MOVZ={z})");
            part += &format!(
                " UN CYL(R=5,H=10) AT (ROTY=90,MOVX=5,MOVY={},MOVZ={z})",
                ys[a]
            );
            for z in zs {
                part += &format!(" UN SPH(R=5) AT (MOVX={x},MOVY={y},MOVZ={z})");
            }
        }
    }
    let round = 10.0 * PI;
    assert_lengths(
        &part,
        StandardView::Front,
        [2.0 * (10.0 + 30.0) + round, 0.0],
    );
    assert_lengths(
        &part,
        StandardView::Right,
        [2.0 * (20.0 + 30.0) + round, 0.0],
    );
    assert_lengths(&part, StandardView::Top, [2.0 * (10.0 + 20.0) + round, 0.0]);
}

/// The dome's edge on the cylinder is its outline from above, and is not drawn from the front.
#[test]
fn a_dome_has_an_outline() {
    let part = "CYL(R=10,H=10) UN SPH(R=10) AT (MOVZ=10)";
    assert_lengths(
        part,
        StandardView::Front,
        [10.0 + 10.0 + 20.0 + 10.0 * PI, 0.0],
    );
    assert_lengths(part, StandardView::Top, [20.0 * PI, 0.0]);
    assert_lengths(part, StandardView::Bottom, [20.0 * PI, 0.0]);
}

/// The floor of a blind hole of radius 8, 12 deep, is a line of 16 between two of 12.
#[test]
fn the_floor_of_a_blind_hole_is_drawn() {
    let part = "BLO(X=60,Y=40,Z=20) DIF CYL(R=8,H=20) AT (MOVX=30,MOVY=20,MOVZ=8)";
    assert_lengths(part, StandardView::Front, [160.0, 12.0 + 12.0 + 16.0]);
    assert_lengths(part, StandardView::Top, [200.0 + 16.0 * PI, 0.0]);
}

/// Lines across at 0, 10, 14 and 30; sides of 10 and 16 at radius 10, and of 4 at radius 8.
#[test]
fn a_groove_is_drawn_once() {
    let part = "CYL(R=10,H=30) DIF (CYL(R=12,H=4) DIF CYL(R=8,H=4)) AT (MOVZ=10)";
    let across = 4.0 * 20.0;
    assert_lengths(
        part,
        StandardView::Front,
        [across + 2.0 * (10.0 + 16.0 + 4.0), 0.0],
    );
    assert_lengths(part, StandardView::Top, [20.0 * PI, 16.0 * PI]);
}

/// A cylinder of radius 4 across one of radius 10: the mouths are x² - z² = 84, and those behind
/// coincide with those in front.
#[test]
fn curves_without_a_closed_form_are_drawn_once() {
    let part = "CYL(R=10,H=60) DIF CYL(R=4,H=40) AT (ROTY=90,MOVX=-20,MOVZ=30)";
    let steps = 20_000;
    let at = |k: i32| {
        let z = -4.0 + 8.0 * f64::from(k) / f64::from(steps);
        ((84.0 + z * z).sqrt(), z)
    };
    let mouth: f64 = (0..steps)
        .map(|k| (at(k + 1).0 - at(k).0).hypot(at(k + 1).1 - at(k).1))
        .sum();
    let drawing = drawn(part, StandardView::Front, false);
    let [visible, hidden] = lengths(&drawing, |_| true);
    // Curves drawn by polylines have the length of these.
    let expected = 2.0 * 20.0 + 2.0 * (60.0 - 8.0) + 2.0 * mouth;
    assert!(
        (visible - expected).abs() < 1e-3,
        "{visible} for {expected}"
    );
    assert!((hidden - 40.0).abs() < 1e-6, "{hidden}");
}

/// An edge seen end-on is a point behind the face in which it ends towards the eye, however sharp
/// it is, and gives no stroke.
#[test]
fn edges_seen_end_on_are_hidden_points() {
    for part in [
        "BLO(X=2,Y=3,Z=4)",
        "WED(X=2,Y=3,Z=4)",
        "WED(X=80,Y=3,Z=1)",
        "BLO(X=4,Y=3,Z=4) DIF BLO(X=2,Y=5,Z=2) AT (MOVX=2,MOVY=-1,MOVZ=2)",
    ] {
        for view in [StandardView::Front, StandardView::Back] {
            let seen = seen(part, view);
            let is_point = |c: &ImageCurve| matches!(c, ImageCurve::Point { .. });
            let points = seen.contours.iter().filter(|c| is_point(&c.image_curve));
            let pieces: Vec<_> = points.flat_map(|c| &c.pieces).collect();
            assert!(pieces.len() >= 3, "{part}");
            let are_hidden = pieces
                .iter()
                .all(|p| p.quantitative_invisibility == 1 && !p.visible);
            assert!(are_hidden, "{part} {view:?} {pieces:?}");
        }
    }
    assert_lengths("BLO(X=2,Y=3,Z=4)", StandardView::Front, [12.0, 0.0]);
}

/// The cone r = 2 - z cut along x + z = 1 is bounded from above by y² = 1 + 2 x, a parabola of
/// length 2 √3 + asinh √3 with its chord, and by two thirds of a circle. Tilted by a millionth of a
/// degree and less, the parabola is a hyperbola or an ellipse with half axes up to 1e9 times the
/// part.
#[test]
fn conics_that_are_nearly_parabolas_are_drawn_where_they_are() {
    let root = 3_f64.sqrt();
    let expected = 2.0 * root + 2.0 * root + root.asinh() + 8.0 * PI / 3.0;
    for angle in [
        "45",
        "45.0001",
        "44.999999",
        "45.000001",
        "44.99999",
        "45.00001",
        "44.999995",
        "45.000005",
        "44.9999999",
        "45.00000001",
        "44.9999999999",
        "45.0000000001",
    ] {
        let part = format!(
            "CON(R=2,H=2) DIF BLO(X=9,Y=9,Z=9) AT (MOVX=-4.5,MOVY=-4.5,ROTY={angle},MOVX=1)"
        );
        let drawing = drawn(&part, StandardView::Top, false);
        let [visible, hidden] = lengths(&drawing, |_| true);
        assert!(
            (visible - expected).abs() < 1e-3,
            "{angle} {visible} for {expected}"
        );
        assert!(hidden < 1e-3, "{angle} {hidden}");
        // The circle, the chord and the parabola end at the same two points.
        let ends: Vec<_> = drawing
            .strokes
            .iter()
            .flat_map(|s| [0.0, 1.0].map(|end| s.shape.point(end)))
            .collect();
        let is_shared =
            |p: &Point2<f64>| ends.iter().filter(|q| (*q - p).norm() < 1e-5).count() > 2;
        assert!(ends.iter().all(is_shared), "{angle} {ends:?}");
    }
}

/// A cylinder of radius 10 and height 5, tilted by a millionth of a degree towards the eye and away
/// from it: one rim is seen all around, as an ellipse 3e-7 wide.
#[test]
fn a_circle_seen_nearly_edge_on_is_one_line() {
    for tilt in ["0.000001", "-0.000001"] {
        let part = format!("CYL(R=10,H=5) AT (ROTX={tilt})");
        assert_lengths(&part, StandardView::Front, [2.0 * (20.0 + 5.0), 0.0]);
    }
}
