//! Tests of DXF files.

use super::*;
use proptest::prelude::*;

/// A file with the entities of two sections.
fn file(blocks: &str, entities: &str) -> String {
    format!(
        "0\nSECTION\n2\nBLOCKS\n{blocks}0\nENDSEC\n0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n"
    )
}

fn line(ends: [[&str; 2]; 2], layer: &str) -> String {
    let [[a, b], [c, d]] = ends;
    format!("0\nLINE\n8\n{layer}\n10\n{a}\n20\n{b}\n11\n{c}\n21\n{d}\n")
}

fn polyline(points: &[[i32; 2]], layer: &str) -> String {
    let points = points.iter().map(|[x, y]| format!("10\n{x}\n20\n{y}\n"));
    let points: String = points.collect();
    format!("0\nLWPOLYLINE\n8\n{layer}\n70\n1\n{points}")
}

fn circle(centre: [i32; 2], radius: i32) -> String {
    let [x, y] = centre;
    format!("0\nCIRCLE\n8\n0\n10\n{x}\n20\n{y}\n40\n{radius}\n")
}

fn arc(centre: [i32; 2], radius: i32, angles: [i32; 2]) -> String {
    let [x, y] = centre;
    let [from, to] = angles;
    format!("0\nARC\n8\n0\n10\n{x}\n20\n{y}\n40\n{radius}\n50\n{from}\n51\n{to}\n")
}

fn insert(name: &str, scales: [i32; 2], angle: i32) -> String {
    let [x, y] = scales;
    format!("0\nINSERT\n8\n0\n2\n{name}\n10\n100\n20\n50\n41\n{x}\n42\n{y}\n50\n{angle}\n")
}

fn block(name: &str, entities: &str) -> String {
    format!("0\nBLOCK\n8\n0\n2\n{name}\n{entities}0\nENDBLK\n")
}

fn read(text: &str) -> Result<Drawing, DrawingFileError> {
    with_options(false, |options| read_dxf(text.as_bytes(), options))
}

fn region(text: &str) -> Figure {
    figure(&read(text).unwrap()).unwrap()
}

const SQUARE: &[[i32; 2]] = &[[0, 0], [10, 0], [10, 10], [0, 10]];

#[test]
fn a_polyline_in_another_one_is_a_hole() {
    let hole = polyline(&[[2, 2], [5, 2], [5, 5], [2, 5]], "0");
    let figure = region(&file("", &(polyline(SQUARE, "0") + &hole)));
    assert_eq!(counts(&figure), [8, 0, 2]);
    assert_eq!(figure.area(), 91.0);
    // Contours that cross leave what is inside an odd number of them.
    let other = polyline(&[[5, 5], [15, 5], [15, 15], [5, 15]], "0");
    let figure = region(&file("", &(polyline(SQUARE, "0") + &other)));
    assert_eq!(figure.area(), 150.0);
    let twice = file("", &(polyline(SQUARE, "0") + &polyline(SQUARE, "0")));
    let empty = super::super::figure(&read(&twice).unwrap());
    assert_eq!(empty, Err(crate::figure::FigureError::Empty));
}

#[test]
fn coordinates_keep_their_digits() {
    let corners = [["0.1", "0"], ["0.3000000000000000001", "0"], ["0.3", "1e1"]];
    let [a, b, c] = corners;
    let text = file(
        "",
        &[[a, b], [c, b], [c, a]]
            .map(|ends| line(ends, "0"))
            .concat(),
    );
    let figure = region(&text);
    let mut ends: Vec<_> = figure
        .edges()
        .iter()
        .map(|edge| edge.start.clone())
        .collect();
    ends.sort();
    let mut expected = corners.map(|point| point.map(number)).to_vec();
    expected.sort();
    assert_eq!(ends, expected);
}

#[test]
fn arcs_and_segments_are_joined_to_a_slot() {
    // A slot of length 10 and radius 5, its second segment from the wrong end.
    let text = arc([10, 5], 5, [-90, 90])
        + &line([["0", "0"], ["10", "0"]], "0")
        + &arc([0, 5], 5, [90, 270])
        + &line([["0", "10"], ["10", "10"]], "0");
    let figure = region(&file("", &text));
    assert_eq!(counts(&figure), [4, 2, 1]);
    assert!(is_close(figure.area(), 100.0 + 25.0 * std::f64::consts::PI));
    let polygon = with_options(true, |options| {
        figure_of(read_dxf(file("", &text).as_bytes(), options))
    });
    // Radius 5 has 16 sides: half a turn has 8.
    assert_eq!(counts(&polygon), [18, 0, 1]);
}

fn figure_of(drawing: Result<Drawing, DrawingFileError>) -> Figure {
    figure(&drawing.unwrap()).unwrap()
}

#[test]
fn circles_that_cross_follow_the_even_odd_rule() {
    let area = region(&file("", &(circle([0, 0], 5) + &circle([5, 0], 5)))).area();
    // Two discs without the lens twice.
    let lens = 50.0 * (std::f64::consts::FRAC_PI_3 - 0.75f64.sqrt() / 2.0);
    assert!(
        is_close(area, 50.0 * std::f64::consts::PI - 2.0 * lens),
        "{area}"
    );
    let twice = file("", &(circle([0, 0], 5) + &circle([0, 0], 5)));
    assert_eq!(read(&twice).unwrap().shapes, [DrawingShape::new()]);
}

#[test]
fn contours_that_touch_are_joined_where_there_are_arcs() {
    // Two squares with a common edge, and a hole in one of them.
    let other = polyline(&[[10, 0], [20, 0], [20, 10], [10, 10]], "0");
    let text = polyline(SQUARE, "0") + &other + &circle([5, 5], 2);
    let figure = region(&file("", &text));
    assert_eq!(counts(&figure), [6, 2, 2]);
    assert!(is_close(figure.area(), 200.0 - 4.0 * std::f64::consts::PI));
    // The hole crosses the common edge.
    let text = polyline(SQUARE, "0") + &other + &circle([10, 5], 2);
    let figure = region(&file("", &text));
    assert_eq!(counts(&figure), [6, 2, 2]);
    assert!(is_close(figure.area(), 200.0 - 4.0 * std::f64::consts::PI));
}

#[test]
fn a_block_is_inserted_with_scales_and_turned() {
    let blocks = block("B", &polyline(SQUARE, "0"));
    let figure = region(&file(&blocks, &insert("B", [2, 3], 90)));
    assert_eq!(figure.bounds(), [[70.0, 50.0], [100.0, 70.0]]);
    assert_eq!(figure.area(), 600.0);
    // OpenSCAD 2021.01 gives these bounds, too.
    let text = file(&blocks, &insert("B", [2, 3], 90));
    let figure = with_options(false, |options| {
        options.origin = [1, 2].map(Rational::from);
        options.scale = Rational::from(2);
        figure_of(read_dxf(text.as_bytes(), options))
    });
    assert_eq!(figure.bounds(), [[138.0, 96.0], [198.0, 136.0]]);
}

#[test]
fn a_block_of_a_block_is_inserted() {
    let inner = block("B", &circle([0, 0], 1));
    let outer = block("C", &insert("B", [2, 2], 0));
    let text = file(&(inner.clone() + &outer), &insert("C", [-1, 1], 30));
    let figure = region(&text);
    assert_eq!(counts(&figure), [2, 2, 1]);
    assert!(is_close(figure.area(), 4.0 * std::f64::consts::PI));
    // Circles with different scales along the axes are cut.
    let drawing = read(&file(&inner, &insert("B", [2, 3], 0))).unwrap();
    assert_eq!(drawing.approximated, 2);
    // A block that is defined later has no effect.
    let drawing = read(&file(&(outer + &inner), &insert("C", [1, 1], 0))).unwrap();
    assert_eq!(drawing.shapes, [DrawingShape::new()]);
}

#[test]
fn a_layer_is_read_alone() {
    let text = file("", &(polyline(SQUARE, "a") + &circle([30, 30], 1)));
    let area = |layer| {
        with_options(false, |options| {
            options.layer = layer;
            figure_of(read_dxf(text.as_bytes(), options)).area()
        })
    };
    assert_eq!(area(Some("a")), 100.0);
    assert!(is_close(area(Some("0")), std::f64::consts::PI));
    assert!(is_close(area(Some("")), 100.0 + std::f64::consts::PI));
    assert!(is_close(area(None), 100.0 + std::f64::consts::PI));
}

#[test]
fn open_paths_are_closed_and_others_passed_over() {
    let open = line([["0", "0"], ["10", "0"]], "0") + &line([["10", "10"], ["10", "0"]], "0");
    let bulge = polyline(SQUARE, "0") + "42\n0.5\n";
    let spline = "0\nSPLINE\n8\n0\n10\n0\n20\nx\n";
    let drawing = read(&file("", &(open + &bulge + spline))).unwrap();
    assert_eq!((drawing.completed, drawing.passed_over), (1, 2));
    assert_eq!(figure_of(Ok(drawing)).area(), 50.0);
    // Ends within a thousandth are one.
    let near = line([["0", "0"], ["10", "0"]], "0") + &line([["10.0005", "0"], ["5", "10"]], "0");
    let drawing = read(&file("", &near)).unwrap();
    assert_eq!(drawing.shapes[0].len(), 1);
}

#[test]
fn an_ellipse_is_cut_like_in_openscad() {
    let text =
        "0\nELLIPSE\n8\n0\n10\n0\n20\n0\n11\n10\n21\n0\n40\n0.5\n41\n0\n42\n6.283185307179586\n";
    let drawing = read(&file("", text)).unwrap();
    assert_eq!(drawing.approximated, 1);
    // 30 sides of an ellipse with the half axes 10 and 5.
    let expected = 30.0 / 2.0 * (std::f64::consts::TAU / 30.0).sin() * 50.0;
    assert!(is_close(figure_of(Ok(drawing)).area(), expected));
}

#[test]
fn errors_have_lines() {
    let error = |text: &str| read(text).unwrap_err().to_string();
    assert_eq!(error("0\nSECTION\nx\n1\n"), "line 3: `x` is no group code");
    let comma = file("", &line([["0,5", "0"], ["1", "0"]], "0"));
    assert_eq!(error(&comma), "line 16: `0,5` is no number");
    let short = file("", "0\nLINE\n8\n0\n10\n1\n20\n2\n");
    assert_eq!(error(&short), "line 12: `LINE` has too few coordinates");
}

#[test]
fn hostile_files_are_refused_quickly() {
    // Each insertion of a block in itself doubles its edges.
    let doubling = polyline(SQUARE, "0") + &insert("B", [1, 1], 0).repeat(40);
    let text = file(&block("B", &doubling), "");
    assert_eq!(read(&text), Err(DrawingFileError::TooManyEdges));
    let digits = file("", &line([["1e300", "0"], ["1", "0"]], "0"));
    assert_eq!(read(&digits), Err(DrawingFileError::Coordinate));
    for value in ["nan", "inf", "1e999", "-", "", "0x10"] {
        let text = file("", &line([[value, "0"], ["1", "0"]], "0"));
        assert!(
            matches!(read(&text), Err(DrawingFileError::Number { .. })),
            "{value}"
        );
    }
    let wide = "0\nARC\n8\n0\n10\n0\n20\n0\n40\n1\n50\n1e300\n51\n-1e300\n";
    assert!(read(&file("", wide)).is_ok());
    for text in [
        "",
        "0",
        "0\n",
        "\n\n",
        "0\nLINE",
        "\u{0}\n\u{0}",
        "10\n5\n20\n5\n0\nEOF\n",
    ] {
        let _ = read(text);
    }
    let garbage: Vec<u8> = (0..=255).cycle().take(5000).collect();
    assert!(with_options(false, |options| read_dxf(&garbage, options)).is_err());
}

#[test]
fn many_segments_are_joined_in_linear_time() {
    // A comb, its segments in a stride through the file.
    let count = 20_000;
    let corner = |i: usize| [(i / 2).to_string(), (i % 2 + 1).to_string()];
    let mut corners: Vec<[String; 2]> = (0..count).map(corner).collect();
    corners.push([(count / 2).to_string(), "0".to_owned()]);
    corners.push(["0".to_owned(), "0".to_owned()]);
    let total = corners.len();
    let segment = |i: usize| {
        let [a, b] = [i, i + 1].map(|k| corners[k % total].each_ref().map(String::as_str));
        line([a, b], "0")
    };
    let text: String = (0..total).map(|i| segment(i * 7919 % total)).collect();
    let drawing = read(&file("", &text)).unwrap();
    assert_eq!(drawing.shapes[0].len(), 1);
    assert_eq!(drawing.shapes[0][0].len(), total);
}

proptest! {
    #[test]
    fn a_shuffled_outline_is_found_again(
        size in (3i32..50, 3i32..50),
        order in Just((0..8usize).collect::<Vec<_>>()).prop_shuffle(),
        is_reversed in proptest::collection::vec(any::<bool>(), 8),
    ) {
        // A rectangle with corners rounded by 1.
        let (w, h) = size;
        let segment = |ends: [[i32; 2]; 2], is_reversed: bool| {
            let ends = ends.map(|point| point.map(|x| x.to_string()));
            let [a, b] = ends.each_ref().map(|point| point.each_ref().map(String::as_str));
            line(if is_reversed { [b, a] } else { [a, b] }, "0")
        };
        let text: String = order.iter().map(|&i| match i {
            0 => segment([[1, 0], [w - 1, 0]], is_reversed[i]),
            1 => segment([[w, 1], [w, h - 1]], is_reversed[i]),
            2 => segment([[w - 1, h], [1, h]], is_reversed[i]),
            3 => segment([[0, h - 1], [0, 1]], is_reversed[i]),
            4 => arc([1, 1], 1, [180, 270]),
            5 => arc([w - 1, 1], 1, [270, 360]),
            6 => arc([w - 1, h - 1], 1, [0, 90]),
            _ => arc([1, h - 1], 1, [90, 180]),
        }).collect();
        let figure = region(&file("", &text));
        prop_assert_eq!(counts(&figure), [8, 4, 1]);
        let expected = f64::from(w * h) - 4.0 + std::f64::consts::PI;
        prop_assert!(is_close(figure.area(), expected));
    }
}
