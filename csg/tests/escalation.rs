//! Parts that f64 decides alone although their surfaces nearly coincide.

use approx::assert_relative_eq;
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use proptest::prelude::*;

/// A needle whose sides meet at angles below 0.01, turned by a matrix of six digits.
const NEEDLE: &str = "linear_extrude(height = 1) {
    multmatrix([[0.998478, 0.0551532, 0, 0], [-0.0551532, 0.998478, 0, 0], [0, 0, 1, 0],
            [0, 0, 0, 1]]) {
        polygon(points = [[0, 0], [-11.2534, 34.9259], [-11.2446, 34.8927],
            [-11.2073, 34.7516]]);
    }
}";

/// The boundary of a description for OpenSCAD.
fn evaluated(text: &str) -> Evaluation {
    let read = read("", text.as_bytes(), Format::Csg, &ReadOptions::default()).unwrap();
    evaluate(&read.tree, &EvaluationOptions::default()).unwrap()
}

/// The volume between radii that grow evenly from one height to another.
fn frustum(radii: [f64; 2], heights: [f64; 2]) -> f64 {
    let [a, b] = radii;
    std::f64::consts::PI / 3.0 * (heights[1] - heights[0]) * (a * a + a * b + b * b)
}

/// A hull of squares whose sides six digits moved 2e-6 apart: a cone with an apex 1e6 away
/// continues a cylinder.
#[test]
fn a_cone_that_is_nearly_a_cylinder_meets_the_wall_above() {
    let known = evaluated(
        "rotate_extrude() hull() {
            square(size = [1.12176, 0.0078125]);
            multmatrix([[1, 0, 0, 0.721762], [0, 1, 0, 1.99219], [0, 0, 1, 0], [0, 0, 0, 1]]) {
                square(size = [0.4, 0.4]);
            }
        }",
    );
    // 1e-11 of the size, not the finest resolution.
    assert!(known.resolution > 1e-12);
    let walls = frustum([1.12176, 1.121762], [0.0, 1.99219])
        + frustum([1.121762, 1.121762], [1.99219, 2.39219]);
    let notch = frustum([0.0, 0.721762], [0.0078125, 2.39219]);
    assert_relative_eq!(known.mass().volume, walls - notch, max_relative = 1e-9);
    assert_eq!(known.brep.topology.faces.len(), 5);
}

/// A side that ends where an arc begins, at an angle of 3e-7 to it: the line of the side
/// intersects the arc's circle again 5e-7 below.
#[test]
fn walls_that_are_nearly_tangent_end_where_their_edges_do() {
    let known = evaluated(
        "rotate_extrude() hull() {
            square(size = [2.77128, 0.0078125]);
            multmatrix([[1, 0, 0, 1.971281], [0, 1, 0, 3.19219], [0, 0, 1, 0], [0, 0, 0, 1]]) {
                intersection() {
                    circle($fn = 24, r = 0.8);
                    square(size = [0.8, 0.8]);
                }
            }
        }",
    );
    assert!(known.resolution > 1e-12);
    let wall = frustum([2.77128, 2.771281], [0.0, 3.19219]);
    // The section through the quarter of the tube, by Pappus.
    let (r, major) = (0.8f64, 1.971281);
    let (area, centre) = (
        r * r * std::f64::consts::FRAC_PI_4,
        4.0 * r / (3.0 * std::f64::consts::PI),
    );
    let quarter = std::f64::consts::TAU * area * (major + centre);
    let below = frustum([major, major], [3.19219, 3.99219]);
    let notch = frustum([0.0, major], [0.0078125, 3.99219]);
    let volume = wall + quarter + below - notch;
    assert_relative_eq!(known.mass().volume, volume, max_relative = 1e-9);
    assert_eq!(known.brep.topology.faces.len(), 4);
}

#[test]
fn where_merging_within_the_noise_contradicts_itself_f64_does_without() {
    let read = read("", NEEDLE.as_bytes(), Format::Csg, &ReadOptions::default()).unwrap();
    let options = EvaluationOptions {
        noise: read.digits,
        ..EvaluationOptions::default()
    };
    assert!(options.noise.is_some());
    let known = evaluate(&read.tree, &options).unwrap();
    assert_eq!(known.decisions.refined, 0, "f64 is enough");
    // The shoelace formula.
    assert_relative_eq!(known.mass().volume, 0.175690155, max_relative = 1e-9);
}

/// A pentagon that six digits moved from its plane, cut into a fan of three triangles at angles
/// of 4e-6, below an apex.
#[test]
fn a_fan_of_nearly_coplanar_facets_needs_f64_only() {
    let known = evaluated(
        "polyhedron(points = [[0, -2.75, 0.492188], [-0.0051056, -2.65746, 0.473752],
            [-0.00943391, -2.57901, 0.421252], [-0.012326, -2.52659, 0.342681],
            [-0.0133416, -2.50818, 0.25], [1, -2.75, 0.25]],
            faces = [[4, 3, 2, 1, 0], [0, 1, 5], [1, 2, 5], [2, 3, 5], [3, 4, 5], [4, 0, 5]]);",
    );
    assert!(known.resolution > 1e-12, "f64 is enough");
    // The sum of the determinants of the triangles, in rationals.
    let volume = 0.005_180_311_332_705_253;
    assert_relative_eq!(known.mass().volume, volume, max_relative = 1e-12);
    let topology = &known.brep.topology;
    assert_eq!((topology.faces.len(), topology.vertices), (8, 6));
}

/// A roof of which two facets meet at an angle of 2e-7 in an edge of 2e-5, in a frame 600 wide.
/// Over the whole width neither the ends of the edge nor the normals give its line to within the
/// resolution.
#[test]
fn a_short_edge_between_nearly_coplanar_facets_in_a_wide_part() {
    const ROOF: &str = "polyhedron(points = [
        [30.100000000000001, 20.199999999999999, 3.2999999999999998],
        [30.100015972710203, 20.200012036300464, 3.2999999999999998],
        [29.236714560971134, 23.007258612566041, 4.4721933854678211],
        [30.963285568360192, 17.39274121580549, 2.1278071208098481],
        [32.260758667003884, 22.317496823548531, 2.3794951465475593],
        [27.468945606720126, 18.706606684636242, 2.3794951465475593],
        [28.92426068431001, 21.760258770461927, -1.3025242672622017]
    ], faces = [[2,1,0], [1,3,0], [2,4,1], [4,3,1], [5,2,0], [3,5,0], [6,4,2], [6,3,4], [6,5,3], [6,2,5]]);";
    let frame = "difference() {
        multmatrix([[1,0,0,-300],[0,1,0,-300],[0,0,1,-50],[0,0,0,1]]) cube([600, 600, 100]);
        multmatrix([[1,0,0,-90],[0,1,0,-90],[0,0,1,-60],[0,0,0,1]]) cube([180, 180, 120]);
    }";
    let [roof, both] = ["", frame].map(|frame| evaluated(&format!("{ROOF} {frame}")));
    for known in [&roof, &both] {
        assert!(known.resolution > 1e-12, "f64 is enough");
    }
    // The sum of the determinants of the triangles.
    assert_relative_eq!(roof.mass().volume, 30.00002, max_relative = 1e-12);
    let whole = 32_760_000.0 + 30.00002;
    assert_relative_eq!(both.mass().volume, whole, max_relative = 1e-14);
    assert_eq!(both.brep.topology.solids.len(), 2);
}

/// Pyramids above and below a quadrilateral with one corner h above the plane of the others. One
/// is cut along a diagonal, the other along the other diagonal: between them lies a tetrahedron
/// of volume h/6, of which both consist. Their volumes are 1/3 and 1/3 + h/6.
#[test]
fn facets_of_two_polyhedra_at_one_edge_are_in_order() {
    for h in [1e-2, 1e-4, 1e-6, 1e-8] {
        let points = format!("[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, {h:.9}]");
        let above = format!(
            "polyhedron(points = [{points}, [0.5, 0.5, 1]], faces = [[0, 1, 2], [0, 2, 3],
                [1, 0, 4], [2, 1, 4], [3, 2, 4], [0, 3, 4]]);"
        );
        let below = format!(
            "polyhedron(points = [{points}, [0.5, 0.5, -1]], faces = [[3, 1, 0], [3, 2, 1],
                [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]);"
        );
        let both = evaluated(&format!("union() {{ {above} {below} }}"));
        assert!(both.resolution > 1e-12, "f64 is enough");
        assert_relative_eq!(both.mass().volume, 2.0 / 3.0, max_relative = 1e-12);
        let shared = evaluated(&format!("intersection() {{ {above} {below} }}"));
        assert_relative_eq!(shared.mass().volume, h / 6.0, max_relative = 1e-6);
        assert_eq!(shared.brep.topology.faces.len(), 4);
    }
}

/// A pyramid over or below a hexagon of which the corners are a few billionths above or below a
/// plane. OpenSCAD's faces run clockwise.
fn pyramid(heights: &[i32; 6], is_up: bool) -> String {
    const RIM: [[f64; 2]; 6] = [
        [4.0, 0.0],
        [2.0, 3.464102],
        [-2.0, 3.464102],
        [-4.0, 0.0],
        [-2.0, -3.464102],
        [2.0, -3.464102],
    ];
    let corner = |([x, y], h): (&[f64; 2], &i32)| format!("[{x}, {y}, {h}e-9]");
    let rim: Vec<String> = RIM.iter().zip(heights).map(corner).collect();
    let (rim, apex) = (rim.join(", "), if is_up { 3 } else { -3 });
    let side = |k: usize| match (k, (k + 1) % 6) {
        (i, j) if is_up => format!("[6, {j}, {i}]"),
        (i, j) => format!("[6, {i}, {j}]"),
    };
    let sides: Vec<String> = (0..6).map(side).collect();
    let base = if is_up {
        "[0, 1, 2, 3, 4, 5]"
    } else {
        "[5, 4, 3, 2, 1, 0]"
    };
    let sides = sides.join(", ");
    format!("polyhedron(points = [{rim}, [0.3, 0.2, {apex}]], faces = [{base}, {sides}]);")
}

/// The bases of the pyramids are cut into fans about different corners. With these heights a
/// diagonal of one base crosses a diagonal of the other, and a facet of one base is coplanar with a
/// facet of the other.
#[test]
fn diagonals_of_two_fans_cross() {
    assert_sums(&[1, 0, 1, 0, 0, 0]);
}

/// Asserts that the volumes of the operations on two pyramids over one hexagon add up.
fn assert_sums(heights: &[i32; 6]) {
    let [above, below] = [true, false].map(|is_up| pyramid(heights, is_up));
    let volume = |text: &str| evaluated(text).mass().volume;
    let both = |word: &str| volume(&format!("{word}() {{ {above} {below} }}"));
    let [a, b] = [&above, &below].map(|text| volume(text));
    let shared = both("intersection");
    assert_relative_eq!(both("union") + shared, a + b, max_relative = 1e-14);
    assert_relative_eq!(both("difference") + shared, a, max_relative = 1e-14);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn volumes_of_nearly_coplanar_fans_add_up(heights in prop::array::uniform6(-2..=2i32)) {
        assert_sums(&heights);
    }
}
