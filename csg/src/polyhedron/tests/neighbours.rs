//! Tests of which faces touch at corners only.

use super::*;

#[test]
fn faces_of_a_cube_touch_along_their_edges() {
    let faces = CUBE_FACES.map(face);
    let cube = Polyhedron::from_faces(&cube(), &faces).unwrap().polyhedron;
    for (index, neighbours) in cube.neighbours().iter().enumerate() {
        // The opposite face has no common corner.
        assert_eq!(neighbours.len(), 4, "face {index}: {neighbours:?}");
        assert!(!neighbours.contains(&index));
    }
}

/// A double pyramid over a quadrilateral of which two sides cross: the triangles over these have
/// only the apex in common, and cross along a line through it.
#[test]
fn faces_that_cross_are_no_neighbours() {
    let points = points(&[
        [0, 0, 0],
        [3, 2, 0],
        [2, 0, 0],
        [0, 1, 0],
        [1, 1, 3],
        [1, 1, -1],
    ]);
    let sides = [[0, 1], [1, 2], [2, 3], [3, 0]];
    let up = sides.map(|[i, j]| face([i, j, 4]));
    let down = sides.map(|[i, j]| face([j, i, 5]));
    let made = Polyhedron::from_faces(&points, &[up, down].concat()).unwrap();
    let polyhedron = made.polyhedron;
    let over = |ends: [usize; 2]| {
        let corners = |face: &PolyhedronFace| face.corners().collect::<BTreeSet<usize>>();
        let wanted = BTreeSet::from([ends[0], ends[1], 4]);
        let faces = polyhedron.faces().iter();
        faces
            .map(corners)
            .position(|found| found == wanted)
            .unwrap()
    };
    let neighbours = polyhedron.neighbours();
    assert!(!neighbours[over([0, 1])].contains(&over([2, 3])));
    assert!(neighbours[over([0, 1])].contains(&over([1, 2])));
    // Over the other two sides, which do not cross.
    assert!(neighbours[over([1, 2])].contains(&over([0, 3])));
}

proptest! {
    /// The triangles of a fan whose rim is moved a little from a plane have the hub in common, and
    /// are neighbours, each of all others.
    #[test]
    fn triangles_of_a_fan_are_neighbours(
        heights in prop::collection::vec(-1000..1000i32, 8),
    ) {
        let rim: [[i32; 2]; 8] =
            [[9, 0], [7, 6], [1, 9], [-5, 7], [-9, 1], [-7, -6], [0, -9], [6, -7]];
        let mut all: Vec<SpacePoint> = rim
            .iter()
            .zip(&heights)
            .map(|([x, y], z)| {
                let z = Rational::from(*z) / Rational::from(1_000_000_000);
                [Rational::from(*x), Rational::from(*y), z]
            })
            .collect();
        all.extend(points(&[[0, 0, 0], [0, 0, -20]]));
        let around = |k: usize| [k, (k + 1) % 8];
        let fan = (0..8).map(|k| PolyhedronFace::simple([&around(k)[..], &[8]].concat()));
        let below = (0..8).map(|k| {
            let [i, j] = around(k);
            face([j, i, 9])
        });
        let faces: Vec<PolyhedronFace> = fan.chain(below).collect();
        let polyhedron = Polyhedron::from_faces(&all, &faces).unwrap().polyhedron;
        prop_assume!(polyhedron.faces().len() == 16);
        let neighbours = polyhedron.neighbours();
        for (k, face) in polyhedron.faces().iter().enumerate() {
            if face.corners().any(|corner| corner == 8) {
                let fan = neighbours[k].iter().filter(|&&other| {
                    polyhedron.faces()[other].corners().any(|corner| corner == 8)
                });
                prop_assert_eq!(fan.count(), 7);
            }
        }
    }
}
