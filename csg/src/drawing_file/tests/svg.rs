//! Tests of SVG files.

use super::*;
use std::f64::consts::PI;

const PAGE: &str = r#"width="100mm" height="100mm" viewBox="0 0 100 100""#;

fn file(attributes: &str, elements: &str) -> String {
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
        xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" {attributes}>{elements}</svg>"#
    )
}

fn read(text: &str) -> Result<Drawing, DrawingFileError> {
    with_options(false, |options| read_svg(text.as_bytes(), options))
}

fn region(elements: &str) -> Figure {
    figure(&read(&file(PAGE, elements)).unwrap()).unwrap()
}

const RECTANGLE: &str = r#"<rect x="20" y="20" width="5" height="5"/>"#;

#[test]
fn a_rounded_rectangle_has_true_arcs() {
    let figure = region(r#"<rect x="10" y="20" width="30" height="20" rx="2.5"/>"#);
    assert_eq!(counts(&figure), [8, 4, 1]);
    assert!(is_close(figure.area(), 600.0 - (4.0 - PI) * 6.25));
    // The second axis points upwards.
    assert_eq!(figure.bounds(), [[10.0, 60.0], [40.0, 80.0]]);
    let figure = region(r#"<rect width="30" height="20" rx="50" ry="50"/>"#);
    // The radii are half the edges, so that the arcs are those of an ellipse.
    assert_eq!(counts(&figure), [36, 0, 1]);
}

#[test]
fn arcs_of_paths_are_true_arcs() {
    // Three quarters of a disc, clockwise on the page, and a half disc of which the radius grows.
    let pie = region(r#"<path d="M50 50 V40 A10 10 0 1 1 40 50 z"/>"#);
    assert_eq!(counts(&pie), [3, 1, 1]);
    assert!(is_close(pie.area(), 75.0 * PI));
    assert_eq!(pie.bounds(), [[40.0, 40.0], [60.0, 60.0]]);
    let half = region(r#"<path d="M 10 10 a 1 1 0 0 0 20 0 Z"/>"#);
    assert!(is_close(half.area(), 50.0 * PI));
    assert_eq!(half.bounds(), [[10.0, 80.0], [30.0, 90.0]]);
    // Flags without spaces, and an arc of radius zero.
    let compact = region(r#"<path d="M10 10a10 10 0 0020 0z"/>"#);
    assert_eq!(compact, half);
    let flat = region(r#"<path d="M0 0 A0 5 0 0 1 20 0 V10 z"/>"#);
    assert_eq!(flat.area(), 100.0);
    let faceted = with_options(true, |options| {
        let text = file(PAGE, r#"<path d="M 10 10 a 1 1 0 0 0 20 0 Z"/>"#);
        figure(&read_svg(text.as_bytes(), options).unwrap()).unwrap()
    });
    // OpenSCAD cuts half a turn into 14.
    assert_eq!(counts(&faceted), [15, 0, 1]);
}

#[test]
fn bezier_curves_are_cut_into_twenty() {
    let drawing = read(&file(PAGE, r#"<path d="M0 0 C0 10 10 10 10 0 z"/>"#)).unwrap();
    assert_eq!(drawing.approximated, 1);
    assert_eq!(counts(&figure(&drawing).unwrap()), [21, 0, 1]);
    // A smooth curve reflects the control point before.
    let smooth = region(r#"<path d="M0 10 C0 0 10 0 10 10 S20 20 20 10 L20 50 H0 z"/>"#);
    let written = region(r#"<path d="M0 10 c0-10 10-10 10 0 c0 10 10 10 10 0 v40 h-20 z"/>"#);
    assert_eq!(smooth, written);
    let smooth = region(r#"<path d="M0 10 Q5 0 10 10 T20 10 L20 50 H0 z"/>"#);
    let written = region(r#"<path d="M0 10 q5-10 10 0 q5 10 10 0 v40 h-20 z"/>"#);
    assert_eq!(smooth, written);
}

#[test]
fn transforms_apply_from_the_inside() {
    let bounds = |elements: &str| region(elements).bounds();
    let square = r#"<g transform="translate(10 20)"><rect width="5" height="5" transform="#;
    let turned = format!(r#"{square}"rotate(90) scale(2,1)"/></g>"#);
    assert_eq!(bounds(&turned), [[5.0, 70.0], [10.0, 80.0]]);
    let about = format!(r#"{square}"rotate(180, 5 5)"/></g>"#);
    assert_eq!(bounds(&about), [[15.0, 70.0], [20.0, 75.0]]);
    let matrix = format!(r#"{square}"matrix(1 0 1 1 3 4)"/></g>"#);
    assert_eq!(bounds(&matrix), [[13.0, 71.0], [23.0, 76.0]]);
    let skewed = format!(r#"{square}"translate(3,4)skewX(45)"/></g>"#);
    assert_eq!(region(&skewed), region(&matrix));
    // Circles remain circles where all lengths have one factor.
    let turned = region(r#"<circle r="1" transform="translate(50 50) rotate(30) scale(-2 2)"/>"#);
    assert_eq!(counts(&turned), [2, 2, 1]);
    assert!(is_close(turned.area(), 4.0 * PI));
    let flat = region(r#"<circle r="1" transform="scale(2 3)"/>"#);
    assert_eq!(counts(&flat), [40, 0, 1]);
}

#[test]
fn the_view_box_and_the_units_give_millimetres() {
    let bounds = |attributes: &str, dpi: i32, is_centred: bool| {
        with_options(false, |options| {
            options.dpi = Rational::from(dpi);
            options.is_centred = is_centred;
            let text = file(attributes, RECTANGLE);
            figure(&read_svg(text.as_bytes(), options).unwrap())
                .unwrap()
                .bounds()
        })
    };
    let square = |x: f64, y: f64, size: f64| [[x, y], [x + size, y + size]];
    // The numbers are those of OpenSCAD 2021.01.
    let cases = [
        ("", square(20.0, -25.0, 5.0)),
        (r#"width="96px" height="96px""#, square(20.0, 0.4, 5.0)),
        (r#"width="1in" height="72""#, square(20.0, 0.4, 5.0)),
        (
            r#"width="50mm" height="6cm" viewBox="10 20 100 60""#,
            square(5.0, 22.5, 2.5),
        ),
        (
            r#"width="5em" height="50%" viewBox="10 20 100 60""#,
            square(10.0, 15.0, 5.0),
        ),
        (
            r#"width="50mm" height="60mm" viewBox="0 0 100 60" preserveAspectRatio="xMinYMax slice""#,
            square(20.0, 35.0, 5.0),
        ),
        (
            r#"width="50mm" height="120mm" viewBox="0 0 100 60" preserveAspectRatio="none""#,
            [[10.0, 70.0], [12.5, 80.0]],
        ),
    ];
    for (attributes, expected) in cases {
        let found = bounds(attributes, 72, false);
        let pairs = found.iter().flatten().zip(expected.iter().flatten());
        assert!(
            pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12),
            "{attributes} {found:?}"
        );
    }
    let view = r#"width="254" height="254" viewBox="0 0 100 100""#;
    assert_eq!(bounds(view, 127, false), square(10.16, 38.1, 2.54));
    let view = r#"width="50mm" height="60mm" viewBox="10 20 50 60""#;
    assert_eq!(bounds(view, 72, true), square(-12.5, -22.5, 5.0));
}

#[test]
fn a_round_drawing_is_centred_exactly() {
    let text = file("", r#"<circle cx="0.7" cy="0.1" r="0.3"/>"#);
    let drawing = with_options(false, |options| {
        options.is_centred = true;
        read_svg(text.as_bytes(), options).unwrap()
    });
    let arc = drawing.shapes[0][0][0].arc.clone().unwrap();
    assert_eq!(arc.centre, [Rational::ZERO, Rational::ZERO]);
}

#[test]
fn elements_in_definitions_are_drawn_where_they_are_used() {
    let defs = r#"<defs><g id="a"><rect id="b" width="2" height="3"/></g></defs>"#;
    assert!(read(&file(PAGE, defs)).unwrap().shapes.is_empty());
    let used = format!(r##"{defs}<use xlink:href="#a" x="10" transform="translate(0 5)"/>"##);
    assert_eq!(region(&used).bounds(), [[10.0, 92.0], [12.0, 95.0]]);
    let used = format!(r##"<use href="#b" y="10"/>{defs}<use href="#b"/><use href="#c"/>"##);
    assert_eq!(region(&used).area(), 12.0);
}

#[test]
fn shapes_are_united_and_contours_of_one_are_not() {
    let rectangles = r#"<rect width="10" height="10"/><rect x="5" y="5" width="10" height="10"/>"#;
    assert_eq!(region(rectangles).area(), 175.0);
    let path = r#"<path d="M0 0H10V10H0z M5 5H15V15H5z"/>"#;
    assert_eq!(region(path).area(), 150.0);
    let ring = r#"<path d="M20 10 a5 5 0 0 0 -10 0 a5 5 0 0 0 10 0 z
        M17 10 a2 2 0 0 0 -4 0 a2 2 0 0 0 4 0 z"/>"#;
    let ring = region(ring);
    assert_eq!(counts(&ring), [4, 4, 2]);
    assert!(is_close(ring.area(), 21.0 * PI));
}

#[test]
fn open_paths_are_stroked() {
    let line = |style: &str| {
        let line = format!(r#"<line x1="10" x2="20" y1="10" y2="10" {style}/>"#);
        region(&line)
    };
    assert_eq!(line("").bounds(), [[9.5, 89.5], [20.5, 90.5]]);
    assert_eq!(
        line(r#"style="stroke-width:4;stroke-linecap:butt""#).area(),
        40.0
    );
    let round = line(r#"stroke-width="4" stroke-linecap="round""#);
    assert_eq!(counts(&round), [4, 2, 1]);
    assert!(is_close(round.area(), 40.0 + 4.0 * PI));
    let corner = |style: &str| {
        let points = "10,10 20,10 20,20";
        let text = format!(r#"<polyline points="{points}" stroke-width="2" {style}/>"#);
        region(&text).area()
    };
    // 11 by 2 twice, and the caps, with a corner of 2 by 2 in common.
    assert_eq!(corner(""), 44.0);
    assert!(is_close(
        corner(r#"stroke-linejoin="round""#),
        43.0 + PI / 4.0
    ));
    // OpenSCAD's bevel is a tangent of the arc.
    let bevel = 44.0 - (2.0 - 2.0f64.sqrt()).powi(2) / 2.0;
    assert!(is_close(corner(r#"stroke-linejoin="bevel""#), bevel));
    // A point is a square or a disc.
    let dot = |style: &str| {
        region(&format!(
            r#"<line x1="9" x2="9" stroke-width="2" {style}/>"#
        ))
    };
    assert_eq!(dot("").bounds(), [[8.0, 99.0], [10.0, 101.0]]);
    assert!(is_close(dot(r#"stroke-linejoin="round""#).area(), PI));
    // The last subpath is filled if another one is closed.
    let path = region(r#"<path d="M20 20H30V30z M0 0H10V10"/>"#);
    assert_eq!(path.area(), 100.0);
    let path = region(r#"<path d="M0 0H10V10 M20 20H30V30z"/>"#);
    assert_eq!(path.area(), 50.0 + 21.0);
}

#[test]
fn elements_are_selected_by_id_and_layer() {
    let elements = r#"<g inkscape:groupmode="layer" inkscape:label="one" id="a">
        <rect id="b" width="1" height="1"/><rect id="c" x="2" width="2" height="1"/></g>
        <g><rect id="d" x="10" width="4" height="1"/></g>"#;
    let text = file(PAGE, elements);
    let area = |id: Option<&'static str>, layer: Option<&'static str>| {
        with_options(false, |options| {
            (options.id, options.layer) = (id, layer);
            let drawing = read_svg(text.as_bytes(), options).unwrap();
            figure(&drawing).map_or(0.0, |figure| figure.area())
        })
    };
    assert_eq!(area(None, None), 7.0);
    assert_eq!(area(None, Some("")), 7.0);
    assert_eq!(area(None, Some("one")), 3.0);
    assert_eq!(area(None, Some("two")), 0.0);
    assert_eq!(area(Some("a"), None), 3.0);
    assert_eq!(area(Some("c"), Some("one")), 2.0);
    assert_eq!(area(Some("d"), Some("one")), 0.0);
}

#[test]
fn errors_have_lines() {
    let error = |elements: &str| read(&file(PAGE, elements)).unwrap_err().to_string();
    let path = error("\n<path d=\"M 0 0 L x\"/>");
    assert!(
        path.starts_with("line 3: the attribute `d` is malformed"),
        "{path}"
    );
    let transform = error(r#"<g transform="turn(3)"/>"#);
    assert!(
        transform.starts_with("line 2: the attribute `transform`"),
        "{transform}"
    );
    assert!(
        read("<svg")
            .unwrap_err()
            .to_string()
            .starts_with("no XML: ")
    );
    let bytes = with_options(false, |options| read_svg(&[0xff, 0xfe, 0, 0], options));
    assert_eq!(bytes, Err(DrawingFileError::Encoding));
}

#[test]
fn hostile_files_are_refused_quickly() {
    let circle = r##"<defs><g id="a"><use href="#a"/></g></defs><use href="#a"/>"##;
    assert!(matches!(
        read(&file(PAGE, circle)),
        Err(DrawingFileError::Nesting { .. })
    ));
    // Each element uses the one before ten times.
    let level = |i: i32| {
        let uses = format!(r##"<use href="#l{}"/>"##, i - 1).repeat(10);
        format!(r#"<g id="l{i}">{uses}</g>"#)
    };
    let levels: String = (1..30).map(level).collect();
    let bomb = format!(r##"<defs><g id="l0"/>{levels}</defs><use href="#l29"/>"##);
    assert_eq!(
        read(&file(PAGE, &bomb)),
        Err(DrawingFileError::TooManyEdges)
    );
    let entity = |i: i32| format!(r#"<!ENTITY e{i} "{}">"#, format!("&e{};", i - 1).repeat(10));
    let entities: String = (1..12).map(entity).collect();
    let laughs = format!("<!DOCTYPE svg [<!ENTITY e0 \"<g/>\">{entities}]><svg>&e11;</svg>");
    assert!(matches!(read(&laughs), Err(DrawingFileError::Xml { .. })));
    let deep = "<g transform='scale(1.234567890123456)'>".repeat(3000);
    let text = file(PAGE, &(deep + RECTANGLE + &"</g>".repeat(3000)));
    assert_eq!(read(&text), Err(DrawingFileError::Coordinate));
    for d in [
        "M0 0L1e300 1e300z",
        "M0 0L1e999 1z",
        "M0 0A1e-320 1e300 0 0 0 1 1z",
        "z",
        "M",
        "",
    ] {
        let text = file(PAGE, &format!(r#"<path d="{d}"/>"#));
        let _ = read(&text).map(|drawing| figure(&drawing));
    }
    for ends in ["1e300", "1e-200", "-0"] {
        let line = format!(r#"<line x2="{ends}" y2="{ends}"/>"#);
        let wide = format!(r#"<polyline points="0 0 {ends} 3 4 5" stroke-width="{ends}"/>"#);
        let _ = read(&file(PAGE, &line)).map(|drawing| figure(&drawing));
        let _ = read(&file(PAGE, &wide)).map(|drawing| figure(&drawing));
    }
    for view in ["0 0 0 0", "0 0 1e-300 1", "nan", "0 0 1e300 1e300", "1"] {
        let attributes = format!(r#"width="1e300" height="inf" viewBox="{view}""#);
        let _ = read(&file(&attributes, RECTANGLE)).map(|drawing| figure(&drawing));
    }
}

#[test]
fn many_shapes_are_united_quickly() {
    // Discs in rows: those of a row touch or overlap, the rows do not.
    let count = 3000;
    let disc = |i: i32| {
        let (x, y) = (i % 50, i / 50);
        format!(r#"<circle cx="{}" cy="{}" r="2"/>"#, 3 * x, 10 * y)
    };
    let discs: String = (0..count).map(disc).collect();
    let figure = region(&discs);
    assert_eq!(figure.contours().count(), 60);
    // A stroke along a spiral.
    let point = |i: i32| {
        let angle = 0.1 * f64::from(i);
        format!("{:.3},{:.3} ", angle * angle.cos(), angle * angle.sin())
    };
    let points: String = (0..600).map(point).collect();
    let spiral = region(&format!(r#"<polyline points="{points}"/>"#));
    assert_eq!(spiral.contours().count(), 1);
}
