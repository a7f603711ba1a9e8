//! Shells: what is inside them is derived by hand, and compared with OpenSCAD 2021.01 where it
//! says.

use super::*;

/// The faces of the cube from `low` to `low + size`, outwards.
struct Cubes {
    points: Vec<SpacePoint>,
    faces: Vec<PolyhedronFace>,
}

impl Cubes {
    fn new() -> Self {
        let (points, faces) = (Vec::new(), Vec::new());
        Self { points, faces }
    }

    fn with(mut self, low: [i32; 3], size: i32, is_inward: bool) -> Self {
        let first = self.points.len();
        let corner = |i: i32| [i & 1, (i >> 1) & 1, (i >> 2) & 1];
        let all = (0..8).map(|i| {
            let at = corner(i);
            std::array::from_fn(|k| low[k] + size * at[k])
        });
        self.points.extend(points(&all.collect::<Vec<_>>()));
        for quad in CUBE_FACES {
            let face = face(quad.map(|k| first + k));
            self.faces.push(match is_inward {
                true => face.reversed(),
                false => face,
            });
        }
        self
    }

    /// The numbers of faces and the volumes of the polyhedra.
    fn solids(&self) -> Vec<(usize, f64)> {
        let solids = Polyhedron::from_shells(&self.points, &self.faces).unwrap();
        let measures = |solid: &Polyhedron| (solid.faces().len(), sixfold(solid) / 6.0);
        let mut all: Vec<_> = solids.iter().map(measures).collect();
        all.sort_by(|a, b| a.1.total_cmp(&b.1));
        all
    }
}

#[test]
fn shells_apart_are_one_polyhedron() {
    let cubes = Cubes::new().with([0; 3], 2, false).with([5; 3], 1, false);
    assert_eq!(cubes.solids(), [(12, 9.0)]);
}

/// OpenSCAD: the same.
#[test]
fn an_inward_shell_is_a_void() {
    let cubes = Cubes::new().with([1; 3], 2, true).with([0; 3], 4, false);
    assert_eq!(cubes.solids(), [(12, 56.0)]);
    // With a solid within the void.
    let cubes = Cubes::new()
        .with([0; 3], 9, false)
        .with([1; 3], 7, true)
        .with([2; 3], 5, false)
        .with([3; 3], 3, true);
    assert_eq!(cubes.solids(), [(12, 98.0), (12, 386.0)]);
}

/// OpenSCAD: the same.
#[test]
fn an_inward_shell_in_the_open_is_turned() {
    let cubes = Cubes::new().with([0; 3], 4, false).with([9; 3], 1, true);
    assert_eq!(cubes.solids(), [(12, 65.0)]);
    let all = Cubes::new().with([0; 3], 4, true).with([1; 3], 1, false);
    assert_eq!(all.solids(), [(12, 63.0)]);
    // Within the box of a solid, and not within the solid: 27 cubes without the middle column.
    let mut ring = Cubes::new();
    for [x, y] in [
        [0, 0],
        [2, 0],
        [4, 0],
        [4, 2],
        [4, 4],
        [2, 4],
        [0, 4],
        [0, 2],
    ] {
        ring = ring.with([x, y, 0], 2, false);
    }
    assert_eq!(ring.solids(), [(ring_faces(), 64.0)]);
    let filled = ring.with([3, 3, 1], 1, true);
    let solids = filled.solids();
    assert_eq!(solids.iter().map(|(_, volume)| volume).sum::<f64>(), 65.0);
}

/// A ring has four outer and four inner sides, and two ends.
fn ring_faces() -> usize {
    10
}

/// The union has the volume of the outer one. OpenSCAD makes a void of the inner one.
#[test]
fn outward_shells_are_united() {
    let nested = Cubes::new().with([0; 3], 4, false).with([1; 3], 1, false);
    assert_eq!(nested.solids(), [(6, 1.0), (6, 64.0)]);
    let crossing = Cubes::new().with([0; 3], 2, false).with([1; 3], 2, false);
    assert_eq!(crossing.solids(), [(6, 8.0), (6, 8.0)]);
}

/// Two cubes with a common face are one block.
#[test]
fn a_face_and_its_opposite_are_nothing() {
    let cubes = Cubes::new()
        .with([0; 3], 2, false)
        .with([2, 0, 0], 2, false);
    assert_eq!(cubes.solids(), [(6, 16.0)]);
    let none = Cubes::new().with([0; 3], 2, false).with([0; 3], 2, true);
    let found = Polyhedron::from_shells(&none.points, &none.faces);
    assert_eq!(found, Err(PolyhedronError::Empty));
}

/// OpenSCAD: the same.
#[test]
fn a_shell_that_is_there_twice_is_there_once() {
    let cubes = Cubes::new().with([0; 3], 2, false).with([0; 3], 2, false);
    assert_eq!(cubes.solids(), [(6, 8.0)]);
}

#[test]
fn many_inward_shells_are_limited() {
    let mut cubes = Cubes::new().with([-1; 3], 3000, false);
    for k in 0..10_001 {
        cubes = cubes.with([3 * (k % 100), 3 * (k / 100), 0], 1, true);
    }
    let found = Polyhedron::from_shells(&cubes.points, &cubes.faces);
    assert_eq!(found, Err(PolyhedronError::TooManyShells { count: 10_001 }));
}

proptest! {
    /// A point is within a cube, wherever the ray leaves through: also through edges and corners.
    #[test]
    fn windings_count_edges_once(at in [0i32..5, 0i32..5, 0i32..5]) {
        let inner = Cubes::new().with([0; 3], 4, false).with(at.map(|x| x - 1), 1, true);
        let is_within = at.iter().all(|x| (1..5).contains(x));
        // A cube of side 1 at the outside or on the outside of one side.
        let solids = inner.solids();
        let volume: f64 = solids.iter().map(|(_, volume)| volume).sum();
        prop_assert_eq!(volume, if is_within { 63.0 } else { 65.0 });
    }
}
