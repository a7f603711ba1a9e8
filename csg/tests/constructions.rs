//! Constructions against values derived by hand, and against rays.

use crate::common::{block, evaluated, n, rotated, shifted, turned, with_volume};
use premio_csg::builder::{Builder, SolidId};
use premio_csg::construction::{
    AffineMap, ConstructionError, ObliquePrism, convex_hull, mapped, minkowski_sum, section, shadow,
};
use premio_csg::figure::{Figure, FigureOperation, OffsetJoin, PlaneMap};
use premio_csg::primitive::Primitive;
use premio_csg::ray_casting::RayOracle;
use premio_csg::tree::Operation;
use proptest::prelude::*;
use std::f64::consts::PI;

fn ball(builder: &mut Builder, radius: i32, at: [i32; 3]) -> SolidId {
    let ball = builder.primitive(Primitive::sphere(n(radius)).unwrap());
    shifted(builder, ball, at)
}

fn cylinder(builder: &mut Builder, radius: i32, height: i32, at: [i32; 3]) -> SolidId {
    let part = builder.primitive(Primitive::cylinder(n(radius), n(height)).unwrap());
    shifted(builder, part, at)
}

/// Evaluates a solid, checks its volume and the rays', and returns the kinds of its surfaces.
#[track_caller]
fn check(builder: &Builder, part: SolidId, volume: f64) -> Vec<&'static str> {
    let tree = builder.finish(part).unwrap();
    let known = with_volume(&tree, volume);
    let faces = known.brep.topology.face_ids();
    let mut kinds: Vec<&str> = faces
        .map(|face| known.brep.surface(face).kind().name())
        .collect();
    kinds.sort_unstable();
    kinds.dedup();
    kinds
}

#[test]
fn a_hull_of_blocks_is_a_polytope() {
    let mut b = Builder::new();
    let low = block(&mut b, [4, 4, 1]);
    let high = block(&mut b, [2, 2, 1]);
    let high = shifted(&mut b, high, [1, 1, 4]);
    let hull = convex_hull(&mut b, &[low, high], 0.0).unwrap().solid;
    // The lower slab, and a frustum of a pyramid from there to the top of the upper one.
    let frustum = 4.0 / 3.0 * (16.0 + 4.0 + 8.0);
    assert_eq!(check(&b, hull, 16.0 + frustum), ["plane"]);
}

#[test]
fn balls_of_two_radii_have_a_cone_between_them() {
    let mut b = Builder::new();
    for [x, z] in [[30, 10], [3, 4], [0, -9]] {
        let one = ball(&mut b, 6, [1, 2, 3]);
        let two = ball(&mut b, 3, [1 + x, 2, 3 + z]);
        let hull = convex_hull(&mut b, &[one, two], 0.0).unwrap().solid;
        let (r, s, d) = (6.0, 3.0, f64::from(x).hypot(f64::from(z)));
        if d <= r - s {
            continue;
        }
        // Two caps and a frustum; the circles of contact lie at r sin and s sin, where sin = (r -
        // s) / d.
        let sin = (r - s) / d;
        let cos = (1.0 - sin * sin).sqrt();
        let height = d - (r - s) * sin;
        let frustum = PI * height / 3.0 * cos * cos * (r * r + r * s + s * s);
        let cap = |r: f64, h: f64| PI * h * h * (3.0 * r - h) / 3.0;
        let volume = frustum + cap(r, r * (1.0 + sin)) + cap(s, s * (1.0 - sin));
        assert_eq!(check(&b, hull, volume), ["cone", "sphere"]);
    }
}

#[test]
fn balls_of_one_radius_round_a_box() {
    for degrees in [0, 37] {
        let mut b = Builder::new();
        let corners = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2 & 1]);
        let balls: Vec<SolidId> = corners
            .map(|[x, y, z]| ball(&mut b, 1, [10 * x, 6 * y, 4 * z]))
            .collect();
        let union = b.operation(Operation::Union, &balls);
        let union = turned(&mut b, union, degrees);
        let hull = convex_hull(&mut b, &[union], 0.0).unwrap().solid;
        let volume = 240.0 + 2.0 * (60.0 + 40.0 + 24.0) + PI * (10.0 + 6.0 + 4.0) + 4.0 * PI / 3.0;
        assert_eq!(check(&b, hull, volume), ["cylinder", "plane", "sphere"]);
    }
}

#[test]
fn balls_in_a_plane_round_a_plate() {
    let mut b = Builder::new();
    let corners = [[0, 0, 0], [6, 0, 2], [0, 5, 0]];
    let balls = corners.map(|at| ball(&mut b, 1, at));
    let hull = convex_hull(&mut b, &balls, 0.0).unwrap().solid;
    let [a, c, d] = [40f64.sqrt(), 5.0, 65f64.sqrt()];
    let area = 0.5 * (10f64.powi(2) + 30f64.powi(2)).sqrt();
    let volume = 2.0 * area + PI / 2.0 * (a + c + d) + 4.0 * PI / 3.0;
    assert_eq!(check(&b, hull, volume), ["cylinder", "plane", "sphere"]);
}

#[test]
fn cylinders_between_two_planes_have_a_slot_as_hull() {
    for degrees in [0, 23] {
        let mut b = Builder::new();
        let one = cylinder(&mut b, 2, 3, [0, 0, 1]);
        let two = cylinder(&mut b, 2, 3, [9, 0, 1]);
        let union = b.operation(Operation::Union, &[one, two]);
        let union = turned(&mut b, union, degrees);
        let hull = convex_hull(&mut b, &[union], 0.0).unwrap().solid;
        assert_eq!(
            check(&b, hull, 3.0 * (36.0 + 4.0 * PI)),
            ["cylinder", "plane"]
        );
    }
    let mut b = Builder::new();
    let one = cylinder(&mut b, 2, 3, [0, 0, 1]);
    let two = cylinder(&mut b, 2, 4, [9, 0, 1]);
    let hull = convex_hull(&mut b, &[one, two], 0.0).unwrap().solid;
    // Above the lower end, a section is a slot of length 9 (1 - t).
    let volume = 3.0 * (36.0 + 4.0 * PI) + 18.0 + 4.0 * PI;
    let surfaces = ["cylinder", "elliptic cylinder", "plane"];
    assert_eq!(check(&b, hull, volume), surfaces);
}

/// A disc and a point off its axis: a cone whose height is that of the point, with an apex that is not
/// over the disc. A section at the height t is a disc of the radius 1 - t.
#[test]
fn a_disc_and_a_point_have_an_oblique_cone_as_hull() {
    let mut b = Builder::new();
    let plate = cylinder(&mut b, 3, 1, [0, 0, 0]);
    let tip = b.primitive(Primitive::frustum(n(2), n(0), n(6)).unwrap());
    let tip = shifted(&mut b, tip, [5, 0, 0]);
    let hull = convex_hull(&mut b, &[plate, tip], 0.0).unwrap().solid;
    let tree = b.finish(hull).unwrap();
    let known = evaluated(&tree);
    let rays = RayOracle::new(&tree).volume(1 << 15, 1);
    assert!(rays.deviation(known.mass().volume, 1e-9) < 6.0, "{rays:?}");
    // The disc of the plate's top lies in the cone over its bottom, where the apex is high enough.
    let apex = b.primitive(Primitive::block([1, 1, 1].map(n)).unwrap());
    let apex = shifted(&mut b, apex, [9, 0, 20]);
    let hull = convex_hull(&mut b, &[plate, apex], 0.0).unwrap().solid;
    let tree = b.finish(hull).unwrap();
    let known = evaluated(&tree);
    let rays = RayOracle::new(&tree).volume(1 << 15, 1);
    assert!(rays.deviation(known.mass().volume, 1e-9) < 6.0, "{rays:?}");
}

#[test]
fn what_is_round_about_an_axis_has_a_round_hull() {
    let mut b = Builder::new();
    let disc = cylinder(&mut b, 5, 1, [0, 0, 0]);
    let pin = cylinder(&mut b, 1, 1, [0, 0, 4]);
    let both = b.operation(Operation::Union, &[disc, pin]);
    let both = turned(&mut b, both, 61);
    let hull = convex_hull(&mut b, &[both], 0.0).unwrap().solid;
    // A disc, and a frustum from radius 5 at height 1 to the top of the pin.
    let frustum = PI * 4.0 / 3.0 * (25.0 + 5.0 + 1.0);
    assert_eq!(
        check(&b, hull, 25.0 * PI + frustum),
        ["cone", "cylinder", "plane"]
    );
}

#[test]
fn sums_with_a_ball() {
    let mut b = Builder::new();
    let unit = ball(&mut b, 1, [0, 0, 0]);
    let part = block(&mut b, [4, 3, 2]);
    let sum = minkowski_sum(&mut b, &[part, unit]).unwrap();
    let volume = 24.0 + 2.0 * (12.0 + 8.0 + 6.0) + PI * 9.0 + 4.0 * PI / 3.0;
    assert_eq!(check(&b, sum, volume), ["cylinder", "plane", "sphere"]);
    // A coin with a half round rim.
    let coin = cylinder(&mut b, 5, 2, [0, 0, 0]);
    let sum = minkowski_sum(&mut b, &[unit, coin]).unwrap();
    let rim = PI * PI * 5.0 + 4.0 / 3.0 * PI;
    let volume = 25.0 * PI * 4.0 + PI * (36.0 - 25.0) * 2.0 + rim;
    assert_eq!(check(&b, sum, volume), ["cylinder", "plane", "torus"]);
    let larger = ball(&mut b, 2, [7, 0, 0]);
    let sum = minkowski_sum(&mut b, &[unit, larger]).unwrap();
    assert_eq!(check(&b, sum, 36.0 * PI), ["sphere"]);
}

#[test]
fn a_bracket_is_rounded() {
    let corners = [[0, 0], [6, 0], [6, 2], [2, 2], [2, 6], [0, 6]].map(|p| p.map(n));
    let figure = Figure::polygon(&[corners.to_vec()]).unwrap();
    let mut b = Builder::new();
    let part = b.primitive(Primitive::prism(figure, n(3)).unwrap());
    let unit = ball(&mut b, 1, [0, 0, 0]);
    let sum = minkowski_sum(&mut b, &[part, unit]).unwrap();
    let tree = b.finish(sum).unwrap();
    let known = evaluated(&tree);
    let rays = RayOracle::new(&tree).volume(1 << 15, 1);
    assert!(rays.deviation(known.mass().volume, 1e-9) < 6.0, "{rays:?}");
}

#[test]
fn sums_of_columns_and_of_polytopes() {
    let mut b = Builder::new();
    let plate = block(&mut b, [50, 20, 6]);
    let tool = cylinder(&mut b, 4, 1, [0, 0, 0]);
    let sum = minkowski_sum(&mut b, &[plate, tool]).unwrap();
    let area = 1000.0 + 2.0 * 4.0 * 70.0 + 16.0 * PI;
    assert_eq!(check(&b, sum, 7.0 * area), ["cylinder", "plane"]);
    let tilted = block(&mut b, [1, 1, 1]);
    let tilted = turned(&mut b, tilted, 30);
    let plate = block(&mut b, [5, 4, 3]);
    let sum = minkowski_sum(&mut b, &[plate, tilted]).unwrap();
    let tree = b.finish(sum).unwrap();
    let known = evaluated(&tree);
    let rays = RayOracle::new(&tree).volume(1 << 14, 1);
    assert!(rays.deviation(known.mass().volume, 1e-9) < 6.0, "{rays:?}");
}

#[test]
fn plane_faces_take_any_scale() {
    let mut b = Builder::new();
    let part = block(&mut b, [1, 2, 3]);
    let tilted = turned(&mut b, part, 40);
    let scale = AffineMap::scale(&[2, 3, 5].map(n));
    for part in [part, tilted] {
        let image = mapped(&mut b, part, &scale).unwrap();
        assert_eq!(check(&b, image, 180.0), ["plane"]);
    }
    let post = cylinder(&mut b, 1, 2, [0, 0, 0]);
    let long = mapped(&mut b, post, &AffineMap::scale(&[2, 2, 5].map(n))).unwrap();
    assert_eq!(check(&b, long, 40.0 * PI), ["cylinder", "plane"]);
    let oval = mapped(&mut b, post, &AffineMap::scale(&[2, 1, 1].map(n))).unwrap();
    assert_eq!(check(&b, oval, 4.0 * PI), ["elliptic cylinder", "plane"]);
    let unit = ball(&mut b, 1, [0, 0, 0]);
    let scale = AffineMap::scale(&[2, 1, 3].map(n));
    let egg = mapped(&mut b, unit, &scale).unwrap();
    assert_eq!(check(&b, egg, 8.0 * PI), ["ellipsoid"]);
    // A ring of triangles about the axis: 2 pi times the distance 2 of the centroid times the area 2.
    let figure = Figure::polygon(&[vec![[n(1), n(0)], [n(3), n(0)], [n(2), n(2)]]]).unwrap();
    let ring = b.primitive(Primitive::revolution(figure, None).unwrap());
    let high = mapped(&mut b, ring, &AffineMap::scale(&[2, 2, 5].map(n))).unwrap();
    assert_eq!(check(&b, high, 160.0 * PI), ["cone", "plane"]);
    let oval = mapped(&mut b, ring, &AffineMap::scale(&[2, 3, 5].map(n)));
    assert_eq!(oval, Err(ConstructionError::Elliptic));
    let back = AffineMap::scale(&[3, 6, 2].map(n));
    let round = mapped(&mut b, egg, &back).unwrap();
    assert_eq!(check(&b, round, 288.0 * PI), ["sphere"]);
    let flat = mapped(&mut b, post, &AffineMap::scale(&[2, 1, 0].map(n)));
    assert!(flat.is_err_and(|error| error.is_empty()));
    let flat = mapped(&mut b, part, &AffineMap::scale(&[2, 1, 0].map(n)));
    assert!(flat.is_err_and(|error| error.is_empty()));
}

#[test]
fn sections_and_shadows() {
    let mut b = Builder::new();
    let plate = block(&mut b, [40, 30, 10]);
    let bore = cylinder(&mut b, 8, 20, [20, 15, -1]);
    let part = b.operation(Operation::Difference, &[plate, bore]);
    let area = 1200.0 - 64.0 * PI;
    let down = shifted(&mut b, part, [0, 0, -5]);
    let close = |found: f64, area: f64| assert!((found - area).abs() < 1e-9, "{found} {area}");
    close(section(&b, down).unwrap().area(), area);
    close(shadow(&b, down).unwrap().area(), area);
    let above = shifted(&mut b, part, [0, 0, 1]);
    assert!(section(&b, above).is_err_and(|error| error.is_empty()));
    let unit = ball(&mut b, 5, [0, 0, 3]);
    close(section(&b, unit).unwrap().area(), 16.0 * PI);
    close(shadow(&b, unit).unwrap().area(), 25.0 * PI);
    let cube = block(&mut b, [1, 1, 1]);
    let diagonal = turned(&mut b, cube, 0);
    close(shadow(&b, diagonal).unwrap().area(), 1.0);
    let wedge = b.primitive(Primitive::wedge([4, 3, 2].map(n)).unwrap());
    let low = shifted(&mut b, wedge, [0, 0, -1]);
    close(section(&b, low).unwrap().area(), 6.0);
    close(shadow(&b, low).unwrap().area(), 12.0);
}

/// A block of 4 by 4 by 4 without a corner of 2 by 2 by 2.
fn notched(b: &mut Builder) -> SolidId {
    let [whole, corner] = [4, 2].map(|size| block(b, [size; 3]));
    let corner = shifted(b, corner, [2; 3]);
    b.operation(Operation::Difference, &[whole, corner])
}

#[test]
fn differences_with_plane_faces_are_polyhedra() {
    for degrees in [0, 30] {
        let mut b = Builder::new();
        let part = notched(&mut b);
        let part = turned(&mut b, part, degrees);
        let hull = convex_hull(&mut b, &[part], 0.0).unwrap().solid;
        assert_eq!(check(&b, hull, 64.0 - 4.0 / 3.0), ["plane"]);
        // The sum fills one unit of the notch at its walls, and adds one unit at its mouth.
        let unit = block(&mut b, [1; 3]);
        let unit = turned(&mut b, unit, degrees);
        let sum = minkowski_sum(&mut b, &[part, unit]).unwrap();
        assert_eq!(check(&b, sum, 125.0 - 8.0), ["plane"]);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// A block of 4 by 4 by 4 less blocks of whole units, tilted, and its sum with a unit block. The
    /// volume is the number of unit cells.
    #[test]
    fn sums_of_notched_blocks_and_a_block(
        tools in prop::collection::vec(prop::array::uniform3((0i32..3, 1i32..3)), 1..4),
        degrees in prop::sample::select(vec![0, 30, 45]),
    ) {
        let mut b = Builder::new();
        let mut parts = vec![block(&mut b, [4; 3])];
        for tool in &tools {
            let part = block(&mut b, tool.map(|(_, size)| size));
            parts.push(shifted(&mut b, part, tool.map(|(at, _)| at)));
        }
        let part = b.operation(Operation::Difference, &parts);
        let unit = block(&mut b, [1; 3]);
        let [part, unit] = [part, unit].map(|part| turned(&mut b, part, degrees));
        let sum = minkowski_sum(&mut b, &[part, unit]).unwrap();
        let is_cut = |cell: [i32; 3]| {
            let within = |tool: &[(i32, i32); 3]| {
                (0..3).all(|i| (tool[i].0..tool[i].0 + tool[i].1).contains(&cell[i]))
            };
            tools.iter().any(within)
        };
        let has = |cell: [i32; 3]| cell.iter().all(|x| (0..4).contains(x)) && !is_cut(cell);
        let cells = (0..125).map(|k| [k % 5, k / 5 % 5, k / 25]);
        let sums = cells.filter(|[x, y, z]| {
            (0..8).any(|k| has([x - k % 2, y - k / 2 % 2, z - k / 4]))
        });
        let known = evaluated(&b.finish(sum).unwrap());
        let (found, count) = (known.mass().volume, sums.count() as f64);
        prop_assert!((found - count).abs() < 1e-9, "{} and not {}", found, count);
    }
}

/// A bracket as a difference of blocks has the same sum with a ball as its figure, extruded.
#[test]
fn a_difference_is_rounded() {
    let corners = [[0, 0], [6, 0], [6, 2], [2, 2], [2, 6], [0, 6]].map(|p| p.map(n));
    let figure = Figure::polygon(&[corners.to_vec()]).unwrap();
    let mut b = Builder::new();
    let prism = b.primitive(Primitive::prism(figure, n(3)).unwrap());
    let [whole, rest] = [[6, 6, 3], [5, 5, 5]].map(|size| block(&mut b, size));
    let rest = shifted(&mut b, rest, [2, 2, -1]);
    let bracket = b.operation(Operation::Difference, &[whole, rest]);
    let unit = ball(&mut b, 1, [0, 0, 0]);
    let [expected, sum] = [prism, bracket].map(|part| {
        let sum = minkowski_sum(&mut b, &[part, unit]).unwrap();
        evaluated(&b.finish(sum).unwrap())
    });
    let (expected, volume) = (expected.mass().volume, sum.mass().volume);
    assert!((volume - expected).abs() < 1e-10, "{volume} {expected}");
}

/// Through the window of a tilted plate less is seen than its size, and from an angle whose tangent
/// is 2 nothing.
#[test]
fn the_shadow_of_a_window() {
    let mut b = Builder::new();
    let [plate, window] = [[4, 4, 1], [2, 2, 3]].map(|size| block(&mut b, size));
    let window = shifted(&mut b, window, [1, 1, -1]);
    let part = b.operation(Operation::Difference, &[plate, window]);
    for (degrees, edges) in [(0, 8), (20, 8), (45, 8), (70, 4)] {
        let tilted = rotated(&mut b, part, [1, 0, 0], degrees);
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let area = 4.0 * (4.0 * cos + sin) - 2.0 * (2.0 * cos - sin).max(0.0);
        let found = shadow(&b, tilted).unwrap();
        let (error, count) = ((found.area() - area).abs(), found.edges().len());
        assert!(error < 1e-12 * area, "{degrees}: {error}");
        assert_eq!(count, edges, "{degrees}");
    }
}

/// A plate whose outline is an offset of a rectangle of 8 by 4.
fn rounded_plate(b: &mut Builder, radius: i32, height: i32, z: i32) -> SolidId {
    let core = Figure::rectangle(&[8, 4].map(n)).unwrap();
    let figure = core.offset(&n(radius), OffsetJoin::Round).unwrap();
    let plate = b.primitive(Primitive::prism(figure, n(height)).unwrap());
    shifted(b, plate, [0, 0, z])
}

#[test]
fn rounded_plates_have_cones_between_them() {
    for degrees in [0, 30] {
        let mut b = Builder::new();
        let low = rounded_plate(&mut b, 1, 1, 0);
        let high = rounded_plate(&mut b, 3, 1, 4);
        let both = b.operation(Operation::Union, &[low, high]);
        let both = turned(&mut b, both, degrees);
        let hull = convex_hull(&mut b, &[both], 0.0).unwrap();
        assert_eq!(hull.moved, 0.0);
        // The radius grows from 1 to 3 over a height of 4, and stays for 1. A section has the area
        // 32 + 24 r + pi r^2.
        let tapered = 4.0 * 32.0 + 24.0 * 8.0 + PI * 52.0 / 3.0;
        let straight = 32.0 + 72.0 + 9.0 * PI;
        let surfaces = ["cone", "cylinder", "plane"];
        assert_eq!(check(&b, hull.solid, tapered + straight), surfaces);
    }
    // Other axes: oblique cones. Each section is moved, and has the same area.
    let mut b = Builder::new();
    let low = rounded_plate(&mut b, 1, 1, 0);
    let high = rounded_plate(&mut b, 3, 1, 4);
    let high = shifted(&mut b, high, [1, 0, 0]);
    let hull = convex_hull(&mut b, &[low, high], 0.0).unwrap().solid;
    let volume = 4.0 * 32.0 + 24.0 * 8.0 + PI * 52.0 / 3.0 + 32.0 + 72.0 + 9.0 * PI;
    let surfaces = ["cylinder", "elliptic cone", "plane"];
    assert_eq!(check(&b, hull, volume), surfaces);
}

/// A figure with an outline of arcs, a hole and a notch, stretched and sheared: its volume is the
/// area of the figure times the determinant.
#[test]
fn stretched_figures_have_elliptic_walls() {
    let mut b = Builder::new();
    let core = Figure::rectangle(&[8, 4].map(n)).unwrap();
    let outline = core.offset(&n(2), OffsetJoin::Round).unwrap();
    let disc = |radius: i32, at: [i32; 2]| {
        let place = PlaneMap {
            offset: at.map(n),
            ..PlaneMap::identity()
        };
        Figure::disc(&n(radius)).unwrap().mapped(&place).unwrap()
    };
    let cut = [disc(1, [3, 2]), disc(2, [10, 2])];
    let all = [&outline, &cut[0], &cut[1]];
    let figure = Figure::combined(FigureOperation::Difference, &all).unwrap();
    let area = figure.area();
    let prism = b.primitive(Primitive::prism(figure, n(3)).unwrap());
    let map = AffineMap {
        matrix: [[2, 0, 1], [1, 1, 0], [0, 0, 1]].map(|row| row.map(n)),
        offset: [5, -7, 1].map(n),
    };
    let image = mapped(&mut b, prism, &map).unwrap();
    // The determinant is 2.
    assert_eq!(check(&b, image, 6.0 * area), ["elliptic cylinder", "plane"]);
}

/// A rounded rectangle scaled about a point outside: the volume is that of a pyramid without its
/// upper part.
#[test]
fn scaled_figures_have_oblique_cones() {
    let mut b = Builder::new();
    let figure = Figure::rectangle(&[8, 4].map(n)).unwrap();
    let figure = figure.offset(&n(1), OffsetJoin::Round).unwrap();
    let area = figure.area();
    for (top, part) in [
        (n(0), 1.0 / 3.0),
        (n(1) / n(2), 7.0 / 12.0),
        (n(2), 7.0 / 3.0),
    ] {
        let prism = ObliquePrism {
            plane: &PlaneMap::identity(),
            height: &n(6),
            top: &top,
            space: &AffineMap::identity(),
        };
        let solid = prism.solid(&mut b, &figure).unwrap();
        let known = check(&b, solid, 6.0 * area * part);
        // The corner next to the axis has a right cone.
        assert_eq!(known, ["cone", "elliptic cone", "plane"], "{top}");
    }
}
