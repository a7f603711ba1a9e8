use super::*;

/// A drawing of a box about the origin, with no strokes.
fn drawing(width: f64, height: f64) -> Drawing {
    let high = Point2::new(width / 2.0, height / 2.0);
    Drawing {
        strokes: Vec::new(),
        extent: [-high, high],
        distance: 1.0,
        tolerance: 0.0,
        to_scale: true,
    }
}

/// The views of a block of 60 by 40 by 20.
fn views() -> Vec<SheetView> {
    vec![
        named(StandardView::Front, drawing(60.0, 20.0)),
        named(StandardView::Top, drawing(60.0, 40.0)),
        named(StandardView::Right, drawing(40.0, 20.0)),
    ]
}

fn named(view: StandardView, drawing: Drawing) -> SheetView {
    let view = Some(view);
    SheetView { view, drawing }
}

fn options(angle: Angle) -> SheetOptions {
    SheetOptions {
        title: "block".to_owned(),
        unit: Unit::Millimetre,
        paper: Paper::A3,
        scale: None,
        angle,
    }
}

fn place(sheet: &Sheet, name: &str) -> Point2<f64> {
    let mut views = sheet.views.iter();
    views
        .find(|v| v.name == name)
        .map(|v| v.at)
        .unwrap_or_default()
}

#[test]
fn views_stand_where_the_angle_has_them() {
    for (angle, side) in [(Angle::First, -1.0), (Angle::Third, 1.0)] {
        let sheet = Sheet::new(views(), options(angle)).unwrap();
        let [front, top, right] = ["front", "top", "right"].map(|n| place(&sheet, n));
        assert_eq!(front.x, top.x);
        assert_eq!(front.y, right.y);
        assert!((top.y - front.y) * side > 30.0 * sheet.factor);
        assert!((right.x - front.x) * side > 50.0 * sheet.factor);
    }
}

/// 390 mm fit 100 mm and three gaps of 12 mm 3.5 times, 253 mm fit 60 mm 3.6 times.
#[test]
fn the_scale_is_the_greatest_with_room() {
    let sheet = Sheet::new(views(), options(Angle::First)).unwrap();
    assert_eq!(sheet.scale.map(|s| s.to_string()).as_deref(), Some("2:1"));
    assert_eq!(sheet.factor, 2.0);
    let metres = SheetOptions {
        unit: Unit::Metre,
        ..options(Angle::First)
    };
    let sheet = Sheet::new(views(), metres.clone()).unwrap();
    assert_eq!(sheet.scale.map(|s| s.to_string()).as_deref(), Some("1:500"));
    let too_large = SheetOptions {
        scale: Some(Scale {
            drawn: 1.0,
            of: 200.0,
        }),
        ..metres
    };
    let error = Sheet::new(views(), too_large).unwrap_err();
    assert!(matches!(error, SheetError::Room { width, .. } if width == 536.0));
}

/// A part that the optical axis does not pass through is still placed in the middle of the
/// paper.
#[test]
fn a_view_off_its_axis_has_the_paper_for_itself() {
    let off_axis = Drawing {
        extent: [Point2::new(1000.0, 0.0), Point2::new(1100.0, 10.0)],
        ..drawing(0.0, 0.0)
    };
    let view = SheetView {
        view: None,
        drawing: off_axis,
    };
    let sheet = Sheet::new(vec![view], options(Angle::First)).unwrap();
    assert_eq!(sheet.factor, 2.0);
    let middle = sheet.views[0].at.x + 1050.0 * sheet.factor;
    assert_eq!(middle, (FILING + 410.0) / 2.0);
}

#[test]
fn scales_are_those_of_the_standard() {
    for (ratio, expected) in [
        (1.0, "1:1"),
        (1.99, "1:1"),
        (7.0, "5:1"),
        (99.0, "50:1"),
        (0.99, "1:2"),
        (0.2, "1:5"),
        (0.0011, "1:1000"),
    ] {
        assert_eq!(Scale::at_most(ratio).to_string(), expected);
    }
}

#[test]
fn what_has_no_size_has_no_scale() {
    let point = vec![named(StandardView::Front, drawing(0.0, 0.0))];
    let error = Sheet::new(point, options(Angle::First)).unwrap_err();
    assert_eq!(error, SheetError::Size { size: 0.0 });
}
