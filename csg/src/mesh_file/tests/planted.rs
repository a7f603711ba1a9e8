//! Random convex polyhedra, written in every format and read again.

use super::*;
use crate::polyhedron::SpacePoint;
use proptest::prelude::*;

/// Points with coordinates that single precision keeps.
fn points() -> impl Strategy<Value = Vec<[i32; 3]>> {
    let coordinate = -400..400;
    let point = [coordinate.clone(), coordinate.clone(), coordinate];
    prop::collection::vec(point, 4..20)
}

fn written(point: &SpacePoint) -> String {
    let words = point
        .each_ref()
        .map(|x| premio_kernel::number::rational::to_decimal(x).unwrap());
    words.join(" ")
}

fn sorted(polyhedron: &Polyhedron) -> Vec<SpacePoint> {
    let mut points = polyhedron.points().to_vec();
    points.sort();
    points
}

proptest! {
    #[test]
    fn a_convex_polyhedron_is_read_again(points in points()) {
        let points = points.iter().map(|point| point.map(|x| ratio(i64::from(x), 8)));
        let Ok(hull) = Polyhedron::convex_hull(&points.collect::<Vec<_>>()) else {
            return Ok(());
        };
        let points: Vec<String> = hull.points().iter().map(written).collect();
        let mut triangles = Vec::new();
        for face in hull.faces() {
            let corners: Vec<usize> = face.corners().collect();
            triangles.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
        }
        let mesh = Written {
            points: &points.iter().map(String::as_str).collect::<Vec<_>>(),
            triangles: &triangles,
        };
        let mut files: Vec<(Vec<u8>, MeshFormat)> = MeshFormat::ALL
            .into_iter()
            .map(|format| (mesh.bytes(format), format))
            .collect();
        files.push((mesh.binary_stl(), MeshFormat::Stl));
        for (bytes, format) in files {
            let found = polyhedra(&bytes, format).unwrap();
            prop_assert_eq!(found.len(), 1, "{}", format);
            prop_assert_eq!(found[0].sixfold_volume(), hull.sixfold_volume(), "{}", format);
            prop_assert_eq!(found[0].faces().len(), hull.faces().len(), "{}", format);
            prop_assert_eq!(sorted(&found[0]), sorted(&hull), "{}", format);
        }
    }
}
