//! Polyhedra: evaluated boundaries against values derived by hand, against the same solids made of
//! other primitives, and against rays.

use crate::common::{evaluated, n, shifted, tree_of, turned};
use nalgebra::Vector3;
use premio_csg::evaluate::{EvaluationError, EvaluationOptions, evaluate};
use premio_csg::figure::Figure;
use premio_csg::polyhedron::{Polyhedron, PolyhedronFace, SpacePoint};
use premio_csg::primitive::Primitive;
use premio_csg::ray_casting::{Ray, RayOracle};
use premio_csg::tree::Operation;
use premio_kernel::number::rational::{Rational, to_f64};
use proptest::prelude::*;
use std::sync::Arc;

fn points(all: &[[i32; 3]]) -> Vec<SpacePoint> {
    all.iter().map(|p| p.map(n)).collect()
}

fn face<const N: usize>(corners: [usize; N]) -> PolyhedronFace {
    PolyhedronFace::simple(corners.to_vec())
}

fn cube() -> Vec<SpacePoint> {
    let corner = |i: i32| [i & 1, (i >> 1) & 1, (i >> 2) & 1].map(|x| 2 * x);
    points(&(0..8).map(corner).collect::<Vec<_>>())
}

/// The faces of a cube whose corner `i` has the bits of `i` as coordinates.
const CUBE_FACES: [[usize; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

fn primitive(polyhedron: Polyhedron) -> Primitive {
    let polyhedron = Arc::new(polyhedron);
    Primitive::Polyhedron { polyhedron }
}

/// The sum of the tetrahedra between the origin and the triangles of simple faces.
fn volume_of(polyhedron: &Polyhedron) -> f64 {
    let at = |i: usize| Vector3::from(polyhedron.points()[i].each_ref().map(to_f64));
    let of = |face: &PolyhedronFace| -> f64 {
        let corners: Vec<_> = face.corners().map(at).collect();
        let fan = corners[1..].windows(2);
        fan.map(|side| corners[0].dot(&side[0].cross(&side[1])))
            .sum()
    };
    polyhedron.faces().iter().map(of).sum::<f64>() / 6.0
}

/// The polyhedron of an extruded polygon.
fn prism(figure: &Figure, height: i32) -> Polyhedron {
    let count = figure.edges().len();
    let at = |z: i32| {
        let starts = figure.edges().iter().map(|edge| edge.start.clone());
        starts.map(move |[x, y]| [x, y, n(z)])
    };
    let points: Vec<SpacePoint> = at(0).chain(at(height)).collect();
    let mut corners = 0..;
    let loops = figure
        .contours()
        .map(|edges| corners.by_ref().take(edges.len()).collect());
    let loops: Vec<Vec<usize>> = loops.collect();
    let wall = |of: &Vec<usize>| {
        let next = of.iter().cycle().skip(1);
        let walls = of.iter().zip(next);
        let walls = walls.map(|(&i, &j)| PolyhedronFace::simple(vec![i, j, j + count, i + count]));
        walls.collect::<Vec<_>>()
    };
    let mut faces: Vec<PolyhedronFace> = loops.iter().flat_map(wall).collect();
    let up = |of: &Vec<usize>| of.iter().map(|i| i + count).collect();
    let top = loops.iter().map(up).collect();
    faces.push(PolyhedronFace { loops: top });
    let down = |of: &Vec<usize>| of.iter().rev().copied().collect();
    let bottom = loops.iter().map(down).collect();
    faces.push(PolyhedronFace { loops: bottom });
    Polyhedron::from_faces(&points, &faces).unwrap().polyhedron
}

/// A polygon with a notch and a hole.
fn notched() -> Figure {
    let outline = [[0, 0], [8, 0], [8, 6], [4, 1], [0, 6]];
    let hole = [[1, 1], [2, 1], [1, 3]];
    let points = |all: &[[i32; 2]]| all.iter().map(|p| p.map(n)).collect();
    Figure::polygon(&[points(&outline), points(&hole)]).unwrap()
}

#[test]
fn a_polyhedron_of_a_prism_is_the_prism() {
    let figure = notched();
    for degrees in [0, 37] {
        let of = |part: Primitive| {
            tree_of(|builder| {
                let part = builder.primitive(part);
                turned(builder, part, degrees)
            })
        };
        let walls = evaluated(&of(Primitive::prism(figure.clone(), n(3)).unwrap()));
        let tree = of(primitive(prism(&figure, 3)));
        let facets = evaluated(&tree);
        assert_eq!(
            facets.brep.topology.census().cells,
            walls.brep.topology.census().cells
        );
        let (a, b) = (facets.mass(), walls.mass());
        assert!((a.volume - b.volume).abs() <= 1e-12 * b.volume);
        assert!((a.area - b.area).abs() <= 1e-12 * b.area);
        let rays = RayOracle::new(&tree).volume(4096, 1);
        assert!(rays.deviation(a.volume, 1e-9) < 6.0, "{rays:?}");
    }
}

#[test]
fn coplanar_triangles_are_one_face() {
    let square = cube();
    let faces = CUBE_FACES;
    let cut = |[a, b, c, d]: [usize; 4]| [face([a, b, c]), face([a, c, d])];
    let faces: Vec<PolyhedronFace> = faces.into_iter().flat_map(cut).collect();
    let made = Polyhedron::from_faces(&square, &faces).unwrap();
    let tree = tree_of(|builder| {
        let part = builder.primitive(primitive(made.polyhedron));
        turned(builder, part, 19)
    });
    let known = evaluated(&tree);
    assert_eq!(known.brep.topology.census().cells, [8, 12, 6, 6]);
    assert!((known.mass().volume - 8.0).abs() < 1e-12);
}

/// A star: a pyramid on every face of an octahedron.
fn star() -> Polyhedron {
    let mut corners = points(&[
        [2, 0, 0],
        [-2, 0, 0],
        [0, 2, 0],
        [0, -2, 0],
        [0, 0, 2],
        [0, 0, -2],
    ]);
    let mut faces = Vec::new();
    for signs in 0..8usize {
        let [x, y, z] = [0, 1, 2].map(|k| signs >> k & 1);
        let tip = corners.len();
        corners.push([x, y, z].map(|s| if s == 0 { n(3) } else { n(-3) }));
        let [a, b, c] = [x, 2 + y, 4 + z];
        let base = match (x + y + z) % 2 {
            0 => [a, b, c],
            _ => [a, c, b],
        };
        let side = |k: usize| face([base[k], base[(k + 1) % 3], tip]);
        faces.extend((0..3).map(side));
    }
    Polyhedron::from_faces(&corners, &faces).unwrap().polyhedron
}

#[test]
fn a_star_is_cut_like_any_solid() {
    let star = star();
    let volume = volume_of(&star);
    // An octahedron of 32/3, and eight pyramids on triangles of area 2 sqrt(3), 7/sqrt(3) high.
    assert!((volume - (32.0 / 3.0 + 8.0 * 14.0 / 3.0)).abs() < 1e-12);
    let whole = evaluated(&tree_of(|b| b.primitive(primitive(star.clone()))));
    assert_eq!(whole.brep.topology.census().cells, [14, 36, 24, 24]);
    assert!((whole.mass().volume - volume).abs() < 1e-11);
    for op in [
        Operation::Union,
        Operation::Intersection,
        Operation::Difference,
    ] {
        let tree = tree_of(|builder| {
            let star = builder.primitive(primitive(star.clone()));
            let ball = Primitive::sphere(Rational::from(5) / Rational::from(2)).unwrap();
            let ball = builder.primitive(ball);
            let part = builder.operation(op, &[star, ball]);
            turned(builder, part, 23)
        });
        let known = evaluated(&tree);
        let found = known.mass().volume;
        let rays = RayOracle::new(&tree).volume(1 << 14, 1);
        assert!(rays.deviation(found, 1e-9) < 6.0, "{op:?} {rays:?} {found}");
    }
}

/// The corners and faces of cubes with an edge of 2.
fn cubes(at: &[[i32; 3]]) -> Polyhedron {
    let (mut corners, mut faces) = (Vec::new(), Vec::new());
    for shift in at {
        let one = Polyhedron::convex_hull(&cube()).unwrap();
        let first = corners.len();
        let moved = one
            .points()
            .iter()
            .map(|p| [0, 1, 2].map(|i| &p[i] + n(shift[i])));
        corners.extend(moved);
        let shifted = one
            .faces()
            .iter()
            .map(|face| PolyhedronFace::simple(face.corners().map(|i| i + first).collect()));
        faces.extend(shifted);
    }
    Polyhedron::from_faces(&corners, &faces).unwrap().polyhedron
}

#[test]
fn faces_that_are_written_twice_count_once() {
    let tree = tree_of(|b| b.primitive(primitive(cubes(&[[0, 0, 0], [0, 0, 0]]))));
    let known = evaluated(&tree);
    assert!((known.mass().volume - 8.0).abs() < 1e-12);
    assert_eq!(known.brep.topology.census().cells, [8, 12, 6, 6]);
    let rays = RayOracle::new(&tree).volume(4096, 1);
    assert!(rays.deviation(8.0, 1e-9) < 6.0, "{rays:?}");
}

#[test]
fn faces_that_cross_are_refused() {
    for at in [[1, 1, 1], [1, 0, 0], [0, 1, 1]] {
        let tree = tree_of(|b| b.primitive(primitive(cubes(&[[0, 0, 0], at]))));
        let error = evaluate(&tree, &EvaluationOptions::default()).unwrap_err();
        // Where faces are coplanar no edge passes through the inside of one.
        let is_named = matches!(error, EvaluationError::SelfIntersection { .. });
        assert_eq!(is_named, at == [1, 1, 1], "{at:?}: {error}");
    }
    let touching = tree_of(|b| b.primitive(primitive(cubes(&[[0, 0, 0], [2, 0, 0]]))));
    assert!((evaluated(&touching).mass().volume - 16.0).abs() < 1e-12);
}

#[test]
fn stars_that_share_faces_join() {
    // The mirror image at a plane through tips: the stars touch along edges and in faces.
    for [x, y, z] in [[6, 0, 0], [3, 3, 0], [2, 2, 2], [4, 0, 0], [0, 0, 0]] {
        let tree = tree_of(|builder| {
            let one = builder.primitive(primitive(star()));
            let other = builder.mirrored_y(one);
            let other = shifted(builder, other, [x, y, z]);
            builder.operation(Operation::Union, &[one, other])
        });
        let known = evaluated(&tree);
        let found = known.mass().volume;
        let rays = RayOracle::new(&tree).volume(1 << 14, 1);
        assert!(
            rays.deviation(found, 1e-9) < 6.0,
            "{x} {y} {z} {rays:?} {found}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// The intervals of a line agree with the solid angles at points of it, also where the line
    /// passes through corners.
    #[test]
    fn lines_enter_and_leave(
        from in prop::array::uniform3(-4i32..=4),
        to in prop::array::uniform3(-4i32..=4),
        off in prop::bool::ANY,
    ) {
        prop_assume!(from != to);
        let tree = tree_of(|b| b.primitive(primitive(star())));
        let rays = RayOracle::new(&tree);
        let shift = if off { 1.0 / 64.0 } else { 0.0 };
        let at = |p: [i32; 3]| Vector3::from(p.map(f64::from)).add_scalar(shift);
        let (start, direction) = (at(from), at(to) - at(from));
        let origin = start.into();
        let inside = rays.intervals(&Ray { origin, direction }, 1e-9);
        for k in -64..=64 {
            let t = f64::from(k) / 16.0 + 1.0 / 37.0;
            let near = inside.iter().flatten().any(|end| (end - t).abs() < 1e-6);
            let held = inside.iter().any(|[lo, hi]| (*lo..=*hi).contains(&t));
            let point = (start + direction * t).into();
            prop_assert!(near || held == rays.contains(&point), "{} {:?}", t, inside);
        }
    }
    /// The hull of points is the intersection of the half spaces of its facets; here it is compared
    /// with the volume of the exact facets and with rays.
    #[test]
    fn hulls_have_their_volume(
        all in prop::collection::vec(prop::array::uniform3(-5i32..=5), 4..24),
        degrees in 0..90,
    ) {
        let Ok(hull) = Polyhedron::convex_hull(&points(&all)) else {
            return Ok(());
        };
        let volume = volume_of(&hull);
        let tree = tree_of(|builder| {
            let part = builder.primitive(primitive(hull.clone()));
            turned(builder, part, degrees)
        });
        let known = evaluated(&tree);
        prop_assert!((known.mass().volume - volume).abs() <= 1e-11 * volume);
        prop_assert_eq!(known.brep.topology.faces.len(), hull.faces().len());
    }
}

#[test]
fn a_straight_edge_may_have_corners_of_facets_in_its_middle() {
    // A wedge of two slices: four facets of two planes meet in a corner on its upright edge. The
    // determinants of its facets sum up to 6000.
    let all: Vec<SpacePoint> = [
        [20, 0, 0],
        [0, 10, 0],
        [0, -10, 0],
        [20, 0, 5],
        [0, 5, 5],
        [0, -5, 5],
        [20, 0, 10],
        [0, 0, 10],
    ]
    .map(|p| p.map(n))
    .to_vec();
    let faces = [
        [0, 1, 4],
        [0, 4, 3],
        [1, 2, 4],
        [2, 5, 4],
        [2, 0, 5],
        [0, 3, 5],
        [3, 4, 6],
        [4, 7, 6],
        [4, 5, 7],
        [5, 3, 6],
        [5, 6, 7],
        [2, 1, 0],
    ];
    for first in 0..3 {
        let turned = faces.map(|f| [0, 1, 2].map(|k| f[(k + first) % 3]).to_vec());
        let faces: Vec<PolyhedronFace> = turned.map(PolyhedronFace::simple).to_vec();
        let made = Polyhedron::from_faces(&all, &faces).unwrap().polyhedron;
        let tree = tree_of(|b| b.primitive(primitive(made)));
        assert!((evaluated(&tree).mass().volume - 1000.0).abs() < 1e-9);
    }
}
