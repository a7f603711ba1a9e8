#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use super::HalfSpaceModel;
use crate::reader::{Format, ReadOptions, read};
use nalgebra::{Point3, Vector3};
use proptest::prelude::*;

/// Primitives of every kind, moved: walls that are slanted, surfaces with an apex, sections of less and
/// of more than half a turn.
const SOLIDS: &[(&str, Format)] = &[
    ("P = BLO(X=2, Y=3, Z=4) AT (ROTZ=30)", Format::Padl),
    ("P = WED(X=2, Y=3, Z=1) AT (ROTX=20)", Format::Padl),
    ("P = CYL(R=1, H=3) AT (ROTY=40)", Format::Padl),
    ("P = CON(R=2, H=1, R2=0.5) AT (MOVX=1)", Format::Padl),
    ("P = CON(R=0.2, H=3) AT (ROTX=50)", Format::Padl),
    ("P = SPH(R=2)", Format::Padl),
    ("P = TOR(RMAJ=2, RMIN=0.5) AT (ROTX=30)", Format::Padl),
    ("P = TOR(RMAJ=1, RMIN=2)", Format::Padl),
    ("cube(size = [1, 2, 3], center = true);", Format::Csg),
    (
        "multmatrix([[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0.5, 0], [0, 0, 0, 1]]) sphere($fn = 0, r = 2);",
        Format::Csg,
    ),
    (
        "multmatrix([[3, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) cylinder($fn = 0, h = 2, r1 = 1, r2 = 0.2);",
        Format::Csg,
    ),
    (
        "linear_extrude(height = 1, scale = 0.1) square(size = [8, 6], center = true);",
        Format::Csg,
    ),
    (
        "linear_extrude(height = 1, scale = 0) square(size = [8, 6], center = true);",
        Format::Csg,
    ),
    (
        "linear_extrude(height = 1, scale = 6) { circle($fn = 0, r = 1); multmatrix([[1, 0, 0, 0.5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) square(size = [2, 1]); }",
        Format::Csg,
    ),
    (
        "rotate_extrude(angle = 100, $fn = 0) { multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) square(size = [2, 1]); }",
        Format::Csg,
    ),
    (
        "rotate_extrude(angle = 260, $fn = 0) { multmatrix([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) square(size = [2, 1]); }",
        Format::Csg,
    ),
    (
        "polyhedron(points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 1]], faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]);",
        Format::Csg,
    ),
];

fn coordinate() -> impl Strategy<Value = f64> {
    -5.0..5.0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// No surface passes through the ball around a point whose radius is the level there: every point
    /// of the ball is on the same side.
    #[test]
    fn levels_are_no_more_than_distances(
        p in [coordinate(), coordinate(), coordinate()],
        towards in prop::collection::vec([coordinate(), coordinate(), coordinate()], 40),
        part in 0.5..1.0,
    ) {
        let p = Point3::from(p);
        for (text, format) in SOLIDS {
            let options = ReadOptions::default();
            let tree = read("part", text.as_bytes(), *format, &options).unwrap().tree;
            let model = HalfSpaceModel::<f64>::new(&tree);
            for solid in &model.all {
                for limit in [0.5, 100.0] {
                    let level = solid.level(&p, limit);
                    for &direction in &towards {
                        let direction = Vector3::from(direction);
                        let step = direction.normalize() * (0.999 * part * level.abs().min(limit));
                        let q = p + step;
                        let there = solid.level(&q, 100.0);
                        prop_assert!(there * level >= 0.0, "{text}: {level} at {p}, {there} at {q}");
                    }
                }
            }
        }
    }
}
