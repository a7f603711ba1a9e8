use super::*;

fn csg(text: &str) -> Tree {
    tree(text, Format::Csg)
}

#[test]
fn primitives_are_placed_as_openscad_places_them() {
    assert_same_points(
        &csg("cube(size = [2, 3, 4], center = true);"),
        |[x, y, z]| x.abs() <= 1.0 && y.abs() <= 1.5 && z.abs() <= 2.0,
    );
    assert_same_points(
        &csg("cylinder($fn = 0, $fa = 12, $fs = 2, h = 4, r1 = 1, r2 = 3, center = true);"),
        |[x, y, z]| z.abs() <= 2.0 && x.hypot(y) <= 2.0 + z / 2.0,
    );
    assert_same_points(&csg("sphere(d = 6);"), |[x, y, z]| {
        x.hypot(y).hypot(z) <= 3.0
    });
    assert_same_points(&csg("cube(3);"), |p| {
        p.iter().all(|x| (0.0..=3.0).contains(x))
    });
}

#[test]
fn extrusions_make_tori_and_wedges() {
    let moved =
        "multmatrix([[1,0,0,-3],[0,1,0,1],[0,0,1,0],[0,0,0,1]]) { circle($fn = 0, r = 1); }";
    let torus = csg(&format!(
        "rotate_extrude(angle = 360, convexity = 2, $fn = 0) {{ {moved} }}"
    ));
    assert_same_points(&torus, |[x, y, z]| (x.hypot(y) - 3.0).hypot(z - 1.0) <= 1.0);
    for (u, v) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
        for order in ["[[0,1,2]]", "[[2,1,0]]", "[[1,2,0]]", "undef"] {
            let text = format!(
                "linear_extrude(height = 4, center = true, scale = [1, 1]) {{
                   polygon(points = [[{u}, 1], [{}, 1], [{u}, {}]], paths = {order}, convexity = 1); }}",
                u + 3.0 * u,
                1.0 + 2.0 * v,
            );
            assert_same_points(&csg(&text), |[x, y, z]| {
                let (a, b) = ((x - u) * u / 3.0, (y - 1.0) * v / 2.0);
                a >= 0.0 && b >= 0.0 && a + b <= 1.0 && z.abs() <= 2.0
            });
        }
    }
    let plate = csg("linear_extrude(height = 1) difference() { square([4, 2]); circle(r = 1); }");
    assert_same_points(&plate, |[x, y, z]| {
        (0.0..=4.0).contains(&x)
            && (0.0..=2.0).contains(&y)
            && (0.0..=1.0).contains(&z)
            && x.hypot(y) > 1.0
    });
}

#[test]
fn mirrors_become_motions() {
    let wedge = "linear_extrude(height = 2) { polygon(points = [[0, 0], [3, 0], [0, 2]]); }";
    let inner = format!(
        "multmatrix([[0,-1,0,1],[1,0,0,0],[0,0,1,0.5],[0,0,0,1]]) {{ {wedge} cube(size = [1, 2, 3]); }}"
    );
    let unmoved = csg(&inner);
    for mirror in [
        [-1.0, 1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, -1.0],
        [-1.0, -1.0, -1.0],
    ] {
        let [a, b, c] = mirror;
        let text =
            format!("multmatrix([[{a},0,0,0.5],[0,{b},0,0],[0,0,{c},0],[0,0,0,1]]) {{ {inner} }}");
        assert_same_points(&csg(&text), |[x, y, z]| {
            inside(&unmoved, [a * (x - 0.5), b * y, c * z])
        });
    }
}

#[test]
fn six_digits_become_an_exact_rotation() {
    let text = "multmatrix([[0.866025, -0.5, 0, 0], [0.5, 0.866025, 0, 1], [0, 0, 1, 0], [0, 0, 0, 1]]) { sphere(r = 1); }";
    let description = read_text(text, Format::Csg).unwrap();
    assert_eq!(description.digits, Some(1e-6));
    assert_eq!(description.notes.len(), 1);
    let turn = description
        .tree
        .leaves()
        .next()
        .unwrap()
        .1
        .motion
        .rotation_f64();
    assert!((turn[(0, 0)] - 0.75f64.sqrt()).abs() < 1e-15);
    let exact = read_text("sphere(r = 1);", Format::Csg).unwrap();
    assert_eq!((exact.digits, exact.notes.len()), (None, 0));
}

#[test]
fn modifiers() {
    let count = |text: &str| csg(text).leaves().count();
    assert_eq!(
        count("cube(1); %cube(2); *group() { hull() { cube(3); } } #cube(4);"),
        2
    );
    assert_eq!(count("difference() { %cube(1); cube(2); }"), 1);
    assert_eq!(
        count("hull(); multmatrix([[2]]) { cube(1); !union() { cube(1); sphere(r = 1); } }"),
        2
    );
}

#[test]
fn what_has_no_size_adds_nothing() {
    assert!(
        csg("cube(size = [0, 1, 1]); sphere(r = 0); cylinder(h = 0, r1 = 1, r2 = 1);").is_empty()
    );
    assert!(csg("intersection() { cube(1); group(); }").is_empty());
    assert!(csg("difference() { group() { } cube(1); }").is_empty());
    assert!(csg("").is_empty());
}

#[test]
fn small_numbers_of_sides_are_polygons() {
    for (sides, corners) in [(3, 6), (12, 72)] {
        let text = format!("sphere($fn = {sides}, r = 5);");
        let ball = csg(&text);
        let (_, leaf) = ball.leaves().next().unwrap();
        let Primitive::Polyhedron { polyhedron } = &leaf.primitive else {
            panic!("a polyhedron");
        };
        assert_eq!(polyhedron.points().len(), corners);
        let options = ReadOptions {
            facets: FacetLimit::None,
            ..ReadOptions::default()
        };
        let round = read("part", text.as_bytes(), Format::Csg, &options).unwrap();
        let (_, leaf) = round.tree.leaves().next().unwrap();
        assert!(matches!(leaf.primitive, Primitive::Sphere { .. }));
    }
    let options = ReadOptions {
        facets: FacetLimit::All,
        ..ReadOptions::default()
    };
    let all = read("part", b"circle(r = 2);", Format::Csg, &options);
    assert!(all.is_err());
    let all = b"linear_extrude(height = 1) { circle($fn = 0, $fa = 12, $fs = 2, r = 2); }";
    let all = read("part", all, Format::Csg, &options).unwrap().tree;
    let (_, leaf) = all.leaves().next().unwrap();
    let Primitive::Prism { figure, .. } = &leaf.primitive else {
        panic!("a prism");
    };
    // 2 pi 2 / 2 is above 6.
    assert_eq!(figure.edges().len(), 7);
    // An offset by an arc of a quarter turn takes two chords, and one of a width of 60 thirty sides.
    let square = "offset(r = 1, $fn = 8) { square([4, 4]); }";
    let plate = csg(&format!("linear_extrude(height = 1) {{ {square} }}"));
    let (_, leaf) = plate.leaves().next().unwrap();
    let Primitive::Prism { figure, .. } = &leaf.primitive else {
        panic!("a prism");
    };
    assert_eq!(figure.edges().len(), 12);
    let wide = b"rotate_extrude($fn = 0, $fa = 12, $fs = 2) { square([60, 1]); }";
    let wide = read("part", wide, Format::Csg, &options).unwrap().tree;
    let (_, leaf) = wide.leaves().next().unwrap();
    let Primitive::Polyhedron { polyhedron } = &leaf.primitive else {
        panic!("a polyhedron");
    };
    // Two faces with thirty sides, and thirty walls.
    assert_eq!(polyhedron.faces().len(), 32);
    let ring = "multmatrix([[1,0,0,3],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { circle(r = 1); }";
    let polygonal = format!("rotate_extrude($fn = 8) {{ {ring} }}");
    assert!(read_text(&polygonal, Format::Csg).is_err());
    for sides in ["0", "13", "16.5", "-3"] {
        csg(&format!("sphere($fn = {sides}, r = 5);"));
    }
    // A square on its corner, a pyramid, and one on its apex.
    let post = csg("cylinder($fn = 4, h = 2, r1 = 3, r2 = 3, center = true);");
    assert_same_points(&post, |[x, y, z]| {
        x.abs() + y.abs() <= 3.0 && z.abs() <= 1.0
    });
    let pyramid = csg("cylinder($fn = 4, h = 3, r1 = 3, r2 = 0, center = false);");
    assert_same_points(&pyramid, |[x, y, z]| {
        x.abs() + y.abs() <= 3.0 - z && z >= 0.0
    });
    let funnel = csg("cylinder($fn = 4, h = 3, r1 = 0, r2 = 3, center = false);");
    assert_same_points(&funnel, |[x, y, z]| x.abs() + y.abs() <= z && z <= 3.0);
}

#[test]
fn polygons_become_prisms() {
    let notched =
        "polygon(points = [[0,0],[4,0],[4,4],[2,1],[0,4]], paths = undef, convexity = 1);";
    let is_inside = |x: f64, y: f64| {
        (0.0..=4.0).contains(&x) && y >= 0.0 && y <= 4.0 - 1.5 * (2.0 - (x - 2.0).abs())
    };
    let text = format!("linear_extrude(height = 2, center = true) {{ {notched} }}");
    assert_same_points(&csg(&text), |[x, y, z]| z.abs() <= 1.0 && is_inside(x, y));
    // Moved, mirrored and stretched in the plane, and scaled on the way up.
    let moved = format!(
        "linear_extrude(height = 2, scale = [0.5, 0.5]) {{
           multmatrix([[-2, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {{ {notched} }} }}"
    );
    assert_same_points(&csg(&moved), |[x, y, z]| {
        let scale = 1.0 - z / 4.0;
        (0.0..=2.0).contains(&z) && is_inside((x / scale - 1.0) / -2.0, y / scale)
    });
    let holed = "linear_extrude(height = 1) polygon(
        points = [[0,0],[5,0],[5,5],[0,5],[1,1],[1,4],[4,4],[4,1]], paths = [[0,1,2,3],[4,5,6,7]]);";
    assert_same_points(&csg(holed), |[x, y, z]| {
        let within = |lo: f64, hi: f64| lo <= x && x <= hi && lo <= y && y <= hi;
        (0.0..=1.0).contains(&z) && within(0.0, 5.0) && !within(1.0, 4.0)
    });
}

#[test]
fn figures_are_revolved() {
    let text = "rotate_extrude(angle = 90) { polygon(points = [[1, 0], [4, 0], [4, 2], [2, 3]]); }";
    assert_same_points(&csg(text), |[x, y, z]| {
        let r = x.hypot(y);
        x >= 0.0 && y >= 0.0 && z >= 0.0 && z <= 3.0 * (r - 1.0) && r <= 4.0 && z <= 4.0 - r / 2.0
    });
    // What a difference removes may lie beyond the axis.
    let text = "rotate_extrude() difference() { circle(r = 4);
        multmatrix([[1,0,0,-9],[0,1,0,-9],[0,0,1,0],[0,0,0,1]]) { square([9, 18]); }
        square(size = [2, 2], center = true); }";
    assert_same_points(&csg(text), |[x, y, z]| {
        let r = x.hypot(y);
        r.hypot(z) <= 4.0 && !(r <= 1.0 && z.abs() <= 1.0)
    });
}

#[test]
fn hulls_of_discs_have_tangents() {
    let moved = |x: i32, node: &str| {
        format!("multmatrix([[1,0,0,{x}],[0,1,0,0],[0,0,1,1],[0,0,0,1]]) {{ {node} }}")
    };
    // Two discs: the tangents touch where the sine of their slope is the difference of the radii.
    let small = moved(5, "cylinder(h = 2, r1 = 1, r2 = 1);");
    let big = moved(0, "cylinder(h = 2, r1 = 4, r2 = 4);");
    assert_same_points(&csg(&format!("hull() {{ {small} {big} }}")), |[x, y, z]| {
        let (sin, cos) = (3.0 / 5.0, 4.0 / 5.0);
        let beyond = x * sin + y.abs() * cos - 4.0;
        let along = x * cos - y.abs() * sin;
        let band = beyond <= 0.0 && (0.0..=4.0).contains(&along);
        (1.0..=3.0).contains(&z) && (band || x.hypot(y) <= 4.0 || (x - 5.0).hypot(y) <= 1.0)
    });
    // A disc and a point in the plane, and a disc that is covered.
    let drop = "linear_extrude(height = 1) hull() { circle(r = 3); circle(r = 1);
        multmatrix([[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { polygon(points = [[0,0],[-9,0],[-9,0]]);
        square(size = [0.0000001, 0.0000001]); } }";
    assert_same_points(&csg(drop), |[x, y, z]| {
        let cone = 3.0 * x + 4.0 * y.abs() <= 15.0 && 4.0 * x >= 3.0 * y.abs();
        (0.0..=1.0).contains(&z) && (cone || x.hypot(y) <= 3.0)
    });
}

#[test]
fn uniform_scales_are_applied() {
    let text = "multmatrix([[0, -2, 0, 1], [-2, 0, 0, 0], [0, 0, 2, 0], [0, 0, 0, 1]]) {
        cube(size = [1, 2, 3]); }";
    assert_same_points(&csg(text), |[x, y, z]| {
        (-3.0..=1.0).contains(&x) && (-2.0..=0.0).contains(&y) && (0.0..=6.0).contains(&z)
    });
}

#[test]
fn comments_texts_and_blocks_without_braces() {
    let tree = csg(
        "// one\n/* two */ color([1, 0, 0, 1]) group() cube(size = 1); color(\"red\") { cube(2); };",
    );
    assert_eq!(tree.leaves().count(), 2);
}

#[test]
fn texts_are_polygons() {
    let sign = |text: &str| {
        let text = format!("linear_extrude(height = 1) {{ text(text = \"{text}\", size = 10); }}");
        let program = parse(
            "part",
            text.as_bytes(),
            Format::Csg,
            &ReadOptions::default(),
        );
        let program = program.unwrap();
        assert_eq!(program.standalone, StandaloneText::AsRead);
        program
            .tree("part", text.as_bytes())
            .unwrap()
            .leaves()
            .count()
    };
    assert_eq!(sign("PREMIO"), 6);
    assert_eq!(sign("a b"), 2);
    assert_eq!(sign(" "), 0);
    let other = csg_notes("linear_extrude(height = 1) { text(text = \"x\", font = \"No Font\"); }");
    assert_eq!(
        other,
        ["there is no font No Font; Liberation Sans is taken instead"]
    );
}

#[test]
fn negative_sizes_are_nothing() {
    let notes = csg_notes("cube(size = 1); cube(size = [1, -2, 3]);");
    assert_eq!(notes, ["a negative size counts as zero"]);
    assert_eq!(csg("cube(size = 1); sphere(r = -1);").leaves().count(), 1);
    let shrunk = "linear_extrude(height = 1) { offset(r = -1) { square(size = [4, 4]); } }";
    assert!(csg_notes(shrunk).is_empty());
}

/// The notes on a text.
fn csg_notes(text: &str) -> Vec<String> {
    let read = read(
        "part",
        text.as_bytes(),
        Format::Csg,
        &ReadOptions::default(),
    );
    let notes = read.unwrap().notes.into_iter();
    notes.map(|note| note.text).collect()
}
