//! Meshes that are written by hand, in every format.

use super::*;
use premio_kernel::number::rational::to_f64;

#[test]
fn a_tetrahedron_in_every_format() {
    let mut files: Vec<(Vec<u8>, MeshFormat)> = MeshFormat::ALL
        .into_iter()
        .map(|format| (TETRAHEDRON.bytes(format), format))
        .collect();
    files.push((TETRAHEDRON.binary_stl(), MeshFormat::Stl));
    for (bytes, format) in files {
        let mesh = read(&bytes, format).unwrap();
        assert_eq!(mesh.points.len(), 4, "{format}");
        assert_eq!(mesh.objects.len(), 1, "{format}");
        let found = mesh.polyhedra().unwrap();
        let [tetrahedron] = &found[..] else {
            panic!("{format}: {found:?}");
        };
        assert_eq!(tetrahedron.sixfold_volume(), Rational::ONE, "{format}");
        assert_eq!(tetrahedron.faces().len(), 4, "{format}");
        let rounded = MeshFile::<f64>::read(&bytes, format, &options(ObjectPlacement::Build));
        let rounded = rounded.unwrap();
        assert_eq!(rounded.objects, mesh.objects, "{format}");
        let exact = mesh.points.iter().map(|point| point.each_ref().map(to_f64));
        assert_eq!(rounded.points, exact.collect::<Vec<_>>(), "{format}");
    }
}

/// Decimals are exact: 0.1 is a tenth, and not the f64 next to it.
#[test]
fn decimals_are_exact() {
    let text = TETRAHEDRON.off().replace("1 0 0\n", "1e-1 0 0\n");
    let found = polyhedra(text.as_bytes(), MeshFormat::Off).unwrap();
    assert_eq!(sixfold_volume(&found), ratio(1, 10));
}

/// A pyramid of height 3 on a square of side 2: a polygon with four corners, and `//` in OBJ.
#[test]
fn polygons_stay_polygons() {
    let off = "OFF 5 5 8\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n1 1 3\n\
        4 0 3 2 1 0.5 0.5 0.5\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n";
    let obj = "# a pyramid\no a\nv 0 0 0\nv 2 0 0\nv 2 2 0\nvn 0 0 1\nv 0 2 0\nv 1 1 3 1.0\n\
        f 1/1/1 4//1 3 2/2\nf -5 -4 -1\ns off\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
    for (text, format) in [(off, MeshFormat::Off), (obj, MeshFormat::Obj)] {
        let mesh = read(text.as_bytes(), format).unwrap();
        let lengths: Vec<usize> = mesh.objects[0].iter().map(<[usize]>::len).collect();
        assert_eq!(lengths, [4, 3, 3, 3, 3], "{format}");
        let found = mesh.polyhedra().unwrap();
        assert_eq!(sixfold_volume(&found), ratio(24, 1), "{format}");
        assert_eq!(found[0].faces().len(), 5, "{format}");
    }
}

/// A cube of quads in OBJ, with a hole through it: 27 - 3 of side 1.
#[test]
fn a_cube_of_quads_with_a_hole() {
    let mut text = String::new();
    for z in [0, 3] {
        for [x, y] in [
            [0, 0],
            [3, 0],
            [3, 3],
            [0, 3],
            [1, 1],
            [2, 1],
            [2, 2],
            [1, 2],
        ] {
            text += &format!("v {x} {y} {z}\n");
        }
    }
    for k in 0..4 {
        let next = (k + 1) % 4;
        let quad = |corners: [usize; 4]| {
            let [a, b, c, d] = corners.map(|corner| corner + 1);
            format!("f {a} {b} {c} {d}\n")
        };
        text += &quad([k, next, 8 + next, 8 + k]);
        text += &quad([4 + next, 4 + k, 12 + k, 12 + next]);
        text += &quad([8 + k, 8 + next, 12 + next, 12 + k]);
        text += &quad([next, k, 4 + k, 4 + next]);
    }
    let found = polyhedra(text.as_bytes(), MeshFormat::Obj).unwrap();
    assert_eq!(sixfold_volume(&found), ratio(6 * (27 - 3), 1));
    // The four parts of the top are one face with a hole.
    assert_eq!(found[0].faces().len(), 10);
}

/// Corners of STL at one point are one, also where a zero is negative.
#[test]
fn equal_points_of_stl_are_one() {
    let text = TETRAHEDRON
        .text_stl()
        .replacen("vertex 0 0 0", "vertex -0 0.0 0e3", 1);
    for points in [
        read(text.as_bytes(), MeshFormat::Stl).unwrap().points.len(),
        MeshFile::<f64>::read(
            text.as_bytes(),
            MeshFormat::Stl,
            &options(ObjectPlacement::Build),
        )
        .unwrap()
        .points
        .len(),
    ] {
        assert_eq!(points, 4);
    }
}

/// Triangles without area are no faces.
#[test]
fn triangles_without_area_are_dropped() {
    let text = TETRAHEDRON.off().replace("4 4 0", "4 5 0") + "3 1 1 2\n";
    let found = polyhedra(text.as_bytes(), MeshFormat::Off).unwrap();
    assert_eq!(sixfold_volume(&found), Rational::ONE);
}

#[test]
fn an_open_mesh_is_an_error_at_the_points_of_the_file() {
    let text = TETRAHEDRON.off().replace("4 4 0", "4 3 0");
    // The triangle 1 2 3 is missing.
    let error = polyhedra(text.as_bytes(), MeshFormat::Off).unwrap_err();
    assert!(matches!(error, PolyhedronError::Open { from, to } if from != 0 && to != 0));
    let turned = TETRAHEDRON.off().replace("3 0 2 1", "3 0 1 2");
    assert!(polyhedra(turned.as_bytes(), MeshFormat::Off).is_err());
    assert_eq!(polyhedra(b"", MeshFormat::Obj), Err(PolyhedronError::Empty));
}

/// A mesh that is inside out is turned.
#[test]
fn a_mesh_that_is_inside_out_is_turned() {
    let triangles = TETRAHEDRON.triangles.iter().map(|[a, b, c]| [*a, *c, *b]);
    let turned = Written {
        triangles: &triangles.collect::<Vec<_>>(),
        ..TETRAHEDRON
    };
    let found = polyhedra(&turned.bytes(MeshFormat::Stl), MeshFormat::Stl).unwrap();
    assert_eq!(sixfold_volume(&found), Rational::ONE);
}
