#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by it")]
use super::*;
use proptest::prelude::*;

mod neighbours;
mod shells;

fn points(all: &[[i32; 3]]) -> Vec<SpacePoint> {
    all.iter().map(|p| p.map(Rational::from)).collect()
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

/// Six times the volume, in whole numbers.
fn sixfold(polyhedron: &Polyhedron) -> f64 {
    to_f64(&polyhedron.sixfold_volume())
}

#[test]
fn the_hull_of_a_cube_has_six_squares() {
    let mut all = cube();
    // Midpoints of edges and faces, the centre, and corners again.
    all.extend(points(&[
        [1, 0, 0],
        [1, 1, 0],
        [1, 1, 1],
        [2, 2, 2],
        [0, 1, 2],
    ]));
    let hull = Polyhedron::convex_hull(&all).unwrap();
    assert_eq!(hull.points().len(), 8);
    assert_eq!(hull.faces().len(), 6);
    assert!(hull.faces().iter().all(|face| face.corners().count() == 4));
    assert_eq!(sixfold(&hull), 48.0);
}

#[test]
fn a_hull_without_volume_is_empty() {
    let flat = points(&[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]);
    for count in 0..=4 {
        let hull = Polyhedron::convex_hull(&flat[..count]);
        assert_eq!(hull, Err(PolyhedronError::Empty));
    }
    let line = points(&[[0, 0, 0], [1, 2, 3], [2, 4, 6], [3, 6, 9]]);
    assert_eq!(Polyhedron::convex_hull(&line), Err(PolyhedronError::Empty));
    let upright = points(&[[0, 0, 0], [0, 0, 3], [0, 1, 1], [0, 2, 5]]);
    assert_eq!(
        Polyhedron::convex_hull(&upright),
        Err(PolyhedronError::Empty)
    );
}

#[test]
fn faces_turn_outwards() {
    let corners = points(&[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    let inwards = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]].map(face);
    let made = Polyhedron::from_faces(&corners, &inwards).unwrap();
    assert!(made.is_turned);
    assert_eq!(sixfold(&made.polyhedron), 1.0);
    let outwards = made.polyhedron.faces().to_vec();
    let again = Polyhedron::from_faces(made.polyhedron.points(), &outwards).unwrap();
    assert!(!again.is_turned);
    assert_eq!(again.polyhedron, made.polyhedron);
}

#[test]
fn faces_that_are_not_plane_are_triangulated() {
    let mut corners = cube();
    corners[7] = [2, 2, 3].map(Rational::from);
    let faces = CUBE_FACES;
    let made = Polyhedron::from_faces(&corners, &faces.map(face)).unwrap();
    assert_eq!((made.triangulated, made.polyhedron.faces().len()), (1, 7));
}

#[test]
fn open_faces_are_refused_with_an_edge() {
    let corners = points(&[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]);
    let open = [[0, 2, 1], [0, 1, 3], [0, 3, 2]].map(face);
    let Err(PolyhedronError::Open { from, to }) = Polyhedron::from_faces(&corners, &open) else {
        panic!("it is open");
    };
    assert_eq!(
        [from.min(to), from.max(to)].map(|i| i > 0),
        [true, true],
        "{from} {to}"
    );
    let missing = Polyhedron::from_faces(&corners, &[face([0, 1, 9])]);
    assert!(matches!(
        missing,
        Err(PolyhedronError::NoPoint {
            face: 0,
            point: 9,
            count: 4
        })
    ));
}

proptest! {
    /// Every point is on the inner side of every facet, and every facet's plane passes through its
    /// corners.
    #[test]
    fn hulls_contain_their_points(all in prop::collection::vec(prop::array::uniform3(-4i32..=4), 4..40)) {
        let all = points(&all);
        let Ok(hull) = Polyhedron::convex_hull(&all) else {
            return Ok(());
        };
        let edges: usize = hull.faces().iter().map(|face| face.corners().count()).sum();
        prop_assert_eq!(hull.points().len() + hull.faces().len(), edges / 2 + 2);
        for face in 0..hull.faces().len() {
            let normal = hull.normal(face);
            let level = dot(&normal, hull.corners(face).next().unwrap());
            for corner in hull.corners(face) {
                prop_assert_eq!(&dot(&normal, corner), &level);
            }
            for point in &all {
                prop_assert!(dot(&normal, point) <= level);
            }
        }
        let again = Polyhedron::convex_hull(hull.points()).unwrap();
        prop_assert_eq!(again.sixfold_volume(), hull.sixfold_volume());
    }
}

#[test]
fn faces_of_one_plane_are_one_face() {
    // A cube of triangles, whose sides are halved by a square of points between its base and lid.
    let mut all = cube();
    all.extend(points(&[[0, 0, 1], [2, 0, 1], [2, 2, 1], [0, 2, 1]]));
    let base = [[0, 1, 3], [0, 3, 2]].map(|[a, b, c]| face([c, b, a]));
    let lid = [[4, 5, 7], [4, 7, 6]].map(face);
    let rings = [[0, 1, 3, 2], [8, 9, 10, 11], [4, 5, 7, 6]];
    let mut faces = [base, lid].concat();
    for ring in rings.windows(2) {
        for k in 0..4 {
            let [i, j] = [k, (k + 1) % 4];
            let corners = [ring[0][i], ring[0][j], ring[1][j], ring[1][i]];
            faces.push(face([corners[0], corners[1], corners[2]]));
            faces.push(face([corners[0], corners[2], corners[3]]));
        }
    }
    let made = Polyhedron::from_faces(&all, &faces).unwrap();
    assert_eq!(made.polyhedron.faces().len(), 6);
    assert_eq!(sixfold(&made.polyhedron), 48.0);
    let corners = made.polyhedron.faces().iter();
    let corners: Vec<usize> = corners.map(|face| face.corners().count()).collect();
    assert_eq!(corners.iter().sum::<usize>(), 2 * 4 + 4 * 6);
}
