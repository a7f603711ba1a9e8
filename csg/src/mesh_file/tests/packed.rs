//! 3MF and AMF: objects, where they are placed, and packages.

use super::*;

/// The cube from the origin to (1, 1, 1).
const CUBE: Written<'_> = Written {
    points: &[
        "0 0 0", "1 0 0", "1 1 0", "0 1 0", "0 0 1", "1 0 1", "1 1 1", "0 1 1",
    ],
    triangles: &[
        [0, 2, 1],
        [0, 3, 2],
        [4, 5, 6],
        [4, 6, 7],
        [0, 1, 5],
        [0, 5, 4],
        [1, 2, 6],
        [1, 6, 5],
        [2, 3, 7],
        [2, 7, 6],
        [3, 0, 4],
        [3, 4, 7],
    ],
};

fn object(id: u32, content: &str) -> String {
    format!("<object id='{id}' type='model'>{content}</object>")
}

/// The cube is a component at x = 1 of an object that the build turns by 90 degrees about z, doubles
/// and lifts. In inches (1, 0, 0) to (2, 1, 1) becomes (-2, 2, 5) to (0, 4, 7).
#[test]
fn a_cube_in_inches_is_placed() {
    let resources = object(7, &CUBE.three_mf_mesh())
        + &object(
            9,
            "<components><component objectid='7' transform='1 0 0 0 1 0 0 0 1 1 0 0'/></components>",
        );
    let build = "<item objectid='9' transform='0 2 0 -2 0 0 0 0 2 0 0 5'/>";
    let bytes = three_mf(&model("inch", &resources, build));
    let found = polyhedra(&bytes, MeshFormat::ThreeMf).unwrap();
    let inch = ratio(254, 10);
    let volume = Rational::from(8) * &inch * &inch * &inch;
    assert_eq!(sixfold_volume(&found), volume * Rational::from(6));
    let [low, high] = found[0].bounds();
    assert_eq!(low, [-50.8, 50.8, 127.0]);
    assert_eq!(high, [0.0, 101.6, 177.8]);
    // As OpenSCAD 2021.01 reads it.
    let as_written = options(ObjectPlacement::AsWritten);
    let mesh = MeshFile::<Rational>::read(&bytes, MeshFormat::ThreeMf, &as_written).unwrap();
    let found = mesh.polyhedra().unwrap();
    assert_eq!(found[0].bounds(), [[0.0; 3], [1.0; 3]]);
}

/// A mirror image is no void.
#[test]
fn a_mirror_image_looks_outwards() {
    let build = "<item objectid='1' transform='-1 0 0 0 1 0 0 0 1 0 0 0'/>";
    let bytes = three_mf(&model("meter", &object(1, &CUBE.three_mf_mesh()), build));
    let options = options(ObjectPlacement::Build);
    let mesh = MeshFile::<f64>::read(&bytes, MeshFormat::ThreeMf, &options).unwrap();
    let mut volume = 0.0;
    for corners in mesh.objects[0].iter() {
        let [a, b, c] = [0, 1, 2].map(|k| mesh.points[corners[k]]);
        volume += a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    assert_eq!(volume, 6e9);
}

/// Each placed object is a solid of its own, although they overlap: 1 + 1, of which half is common.
#[test]
fn objects_are_united() {
    let build = "<item objectid='1'/><item objectid='1' transform='1 0 0 0 1 0 0 0 1 .5 0 0'/>";
    let bytes = three_mf(&model(
        "millimeter",
        &object(1, &CUBE.three_mf_mesh()),
        build,
    ));
    assert_eq!(polyhedra(&bytes, MeshFormat::ThreeMf).unwrap().len(), 2);
    let text = amf(&(CUBE.amf_object() + &TETRAHEDRON.amf_object()));
    let found = polyhedra(text.as_bytes(), MeshFormat::Amf).unwrap();
    assert_eq!(found.len(), 2);
    assert_eq!(sixfold_volume(&found), Rational::from(7));
}

/// The volumes of an AMF object are one set of faces; edges and normals are not read.
#[test]
fn volumes_share_the_points_of_an_amf_object() {
    let text = amf(&TETRAHEDRON.amf_object());
    let text = text.replacen("</triangle>\n", "</triangle></volume><volume>", 1);
    let edge = "<vertex><normal><nx>1</nx></normal></vertex><edge><v1>7</v1><dx1>1</dx1></edge>";
    let faulty = text.replacen("</vertices>", &format!("{edge}</vertices>"), 1);
    for text in [&text, &faulty] {
        let found = polyhedra(text.as_bytes(), MeshFormat::Amf).unwrap();
        assert_eq!(sixfold_volume(&found), Rational::ONE);
    }
}

#[test]
fn amf_may_be_packed() {
    let text = amf(&TETRAHEDRON.amf_object());
    let named = archive(&[("readme", ""), ("part.AMF", &text)]);
    let alone = archive(&[("part", &text)]);
    for bytes in [named, alone] {
        let found = polyhedra(&bytes, MeshFormat::Amf).unwrap();
        assert_eq!(sixfold_volume(&found), Rational::ONE);
    }
    let two = archive(&[("a.amf", &text), ("b.amf", &text)]);
    assert!(message(&two, MeshFormat::Amf).contains("one AMF file"));
}

#[test]
fn a_package_without_a_model_is_an_error() {
    for parts in [
        &[("3D/a.model", "<model/>")][..],
        &[("_rels/.rels", RELATIONSHIPS)],
        &[
            ("_rels/.rels", "<Relationships/>"),
            ("3D/a.model", "<model/>"),
        ],
    ] {
        assert!(message(&archive(parts), MeshFormat::ThreeMf).contains("an archive with"));
    }
    assert!(message(b"PK\x03\x04", MeshFormat::ThreeMf).contains("zip archive"));
}

#[test]
fn errors_of_xml_have_lines() {
    let written = TETRAHEDRON.three_mf_model();
    for (from, to, line) in [
        ("x='0' y='1'", "x='0' y='inf'", 6),
        ("v2='2' v3='3'", "v2='2' v3='4'", 12),
        ("objectid='3'", "objectid='4'", 13),
        ("objectid='3'", "objectid='3' transform='1 0 0'", 13),
        ("objectid='3'", "objectid='3' p:path='/3D/b.model'", 13),
        ("millimeter", "mile", 3),
        ("</model>", "", 13),
        ("</build>", "</item>", 13),
        ("<model ", "<!DOCTYPE model [<!ENTITY a 'a'>]><model ", 3),
    ] {
        let changed = written.replace(from, to);
        assert_ne!(changed, written);
        let found = message(&three_mf(&changed), MeshFormat::ThreeMf);
        assert!(
            found.starts_with(&format!("line {line}: expected")),
            "{to}: {found}"
        );
    }
    let written = amf(&TETRAHEDRON.amf_object());
    for (from, to) in [
        ("<v1>0</v1>", "<v1>4</v1>"),
        ("<v1>0</v1>", ""),
        ("<x>0</x>", ""),
        ("<x>0</x>", "<x>&a;</x>"),
        ("<x>0</x>", "<x>1e999</x>"),
        ("<amf ", "<a "),
        ("</amf>", ""),
    ] {
        let changed = written.replace(from, to);
        assert_ne!(changed, written);
        let found = message(changed.as_bytes(), MeshFormat::Amf);
        assert!(found.contains("expected"), "{to}: {found}");
    }
}
