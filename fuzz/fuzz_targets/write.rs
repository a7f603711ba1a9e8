//! Small parts under arbitrary names, in every format: files are read again, by other programs'
//! readers where there are any, and describe the same part.
#![no_main]

use libfuzzer_sys::fuzz_target;
use premio_csg::object_model::ObjectModel;
use premio_drawing::sheet::{self, Sheet, SheetView, StandardView};
use premio_drawing::{Drawing, dxf, svg};
use premio_exchange::FaceColours;
use premio_exchange::mesh::{Facets, glb, obj, stl, threemf};
use premio_exchange::step::{self, Protocol};
use premio_fuzz::{Part, Recipe, Sight};
use premio_kernel::tessellation::Accuracy;
use premio_kernel::unit::Unit;
use premio_text::escape::is_unsafe;
use premio_visibility::contours;
use std::io::{Cursor, Read};

/// The number of bytes at the beginning that are the name.
const NAME: usize = 16;

fuzz_target!(|bytes: &[u8]| {
    let (name, rest) = bytes.split_at(bytes.len().min(NAME));
    let name = String::from_utf8_lossy(name);
    let mut recipe = Recipe::new(rest);
    let sight = recipe.sight();
    let Some(part) = Part::new(&recipe.model()) else {
        return;
    };
    boundary(&part, &name);
    meshes(&part, &name);
    drawings(&part, &sight, &name);
});

fn boundary(part: &Part, name: &str) {
    let known = &part.evaluation;
    let text =
        serde_json::to_string(&ObjectModel::new(&known.brep)).expect("a boundary is written");
    let value: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
    assert!(value.is_object(), "{text}");
    let size = known.bounds.diagonal();
    let how = step::StepOptions {
        name: name.to_owned(),
        protocol: Protocol::Ap242,
        unit: Unit::Millimetre,
        accuracy: 1e-6 * size,
        resolution: known.f64_resolution(),
        colours: FaceColours::default(),
    };
    if let Ok(text) = step::write(&known.brep, &how) {
        exchange(&text);
    }
}

/// Checks rules of ISO 10303-21: the alphabet, terminated strings, existing instances.
fn exchange(text: &str) {
    assert!(text.starts_with("ISO-10303-21;") && text.trim_end().ends_with("END-ISO-10303-21;"));
    let is_letter = |b: u8| matches!(b, b'\n' | b'\r' | b' '..=b'~');
    assert!(text.bytes().all(is_letter), "{text}");
    // A quote in a string is two of them.
    assert_eq!(text.matches('\'').count() % 2, 0, "{text}");
    let outside: String = text.split('\'').step_by(2).collect();
    let mut known = std::collections::HashSet::new();
    let mut used = std::collections::HashSet::new();
    for line in outside.lines() {
        let number = |text: &str| -> Option<u32> {
            let end = text
                .find(|c: char| !c.is_ascii_digit())
                .unwrap_or(text.len());
            text[..end].parse().ok()
        };
        let mut numbers = line.split('#').skip(1).filter_map(number);
        if line.starts_with('#') {
            let own = numbers.next().expect("an instance has a number");
            assert!(known.insert(own), "#{own} is there twice");
        }
        used.extend(numbers);
    }
    assert!(used.is_subset(&known), "an instance is missing\n{text}");
}

fn meshes(part: &Part, name: &str) {
    let known = &part.evaluation;
    let size = known.bounds.diagonal();
    let accuracy = Accuracy {
        deviation: size / 100.0,
        angle: 0.5,
    };
    let Ok(facets) = Facets::new(&known.brep, &accuracy, known.f64_resolution()) else {
        return;
    };
    let count = facets.facets.len();
    if let Ok(bytes) = stl::write(&facets) {
        let read = stl_io::read_stl(&mut Cursor::new(&bytes)).expect("it is STL");
        assert!(read.faces.len() <= count, "{}", part.text);
    }
    if let Ok(bytes) = glb::write(&facets, &FaceColours::default(), name, Unit::Millimetre) {
        let read = gltf::Gltf::from_slice(&bytes).expect("it is glTF");
        let node = read.nodes().next().expect("there is a node");
        assert_eq!(node.name(), Some(name));
    }
    if let Ok(bytes) = threemf::write(&facets, &FaceColours::default(), name, Unit::Millimetre) {
        package(&bytes, count);
    }
    wavefront(&obj::write(&facets, name), count);
}

/// A 3MF package: every part of it is XML, and the model has the triangles.
fn package(bytes: &[u8], count: usize) {
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).expect("it is a package");
    let mut triangles = 0;
    for index in 0..archive.len() {
        let mut file = archive.by_index(index).expect("it is there");
        let mut text = String::new();
        file.read_to_string(&mut text).expect("it is a text");
        triangles += document(&text, "triangle");
    }
    assert_eq!(triangles, count);
}

/// How many elements of a name an XML document has.
fn document(text: &str, name: &str) -> usize {
    assert!(
        !text.contains(|c: char| c != '\n' && is_unsafe(c)),
        "{text:?}"
    );
    let document = roxmltree::Document::parse(text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let elements = document.descendants();
    elements.filter(|e| e.tag_name().name() == name).count()
}

fn wavefront(text: &str, count: usize) {
    assert!(
        !text.contains(|c: char| c != '\n' && is_unsafe(c)),
        "{text:?}"
    );
    let of = |kind: &str| {
        text.lines()
            .filter(|l| l.split(' ').next() == Some(kind))
            .count()
    };
    let (points, normals) = (of("v"), of("vn"));
    assert_eq!(of("f"), count);
    for corner in text
        .lines()
        .filter_map(|l| l.strip_prefix("f "))
        .flat_map(|l| l.split(' '))
    {
        let (point, normal) = corner.split_once("//").expect("a point and a normal");
        let index = |text: &str| text.parse::<usize>().expect("a number");
        assert!((1..=points).contains(&index(point)), "{corner}");
        assert!((1..=normals).contains(&index(normal)), "{corner}");
    }
}

fn drawings(part: &Part, sight: &Sight, name: &str) {
    let Some(resolution) = part.evaluation.view_resolution() else {
        return;
    };
    let Some(camera) = part.camera(sight) else {
        return;
    };
    let Ok(seen) = contours(&part.evaluation.brep, &camera, resolution) else {
        return;
    };
    let json = serde_json::to_string(&seen).expect("contours are written");
    let _: serde_json::Value = serde_json::from_str(&json).expect("it is JSON");
    let how = premio_drawing::DrawingOptions {
        hidden: true,
        smooth: true,
        ..premio_drawing::DrawingOptions::default()
    };
    let view = || Drawing::new(&seen, &how);
    document(&svg::write(&view()), "path");
    groups(&dxf::write(&view()));
    let titled = sheet::SheetOptions {
        title: name.to_owned(),
        unit: Unit::Millimetre,
        paper: sheet::Paper::A3,
        scale: None,
        angle: sheet::Angle::First,
    };
    let views = vec![SheetView {
        view: Some(StandardView::Front),
        drawing: view(),
    }];
    if let Ok(sheet) = Sheet::new(views, titled) {
        document(&svg::write_sheet(&sheet), "path");
        groups(&dxf::write_sheet(&sheet));
    }
}

/// The groups of a DXF: a code and a value, each in its line, up to the end.
fn groups(text: &str) {
    assert!(
        text.bytes().all(|b| matches!(b, b'\n' | b' '..=b'~')),
        "{text:?}"
    );
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len() % 2, 0);
    for pair in lines.chunks(2) {
        assert!(pair[0].trim().parse::<u32>().is_ok(), "{pair:?}");
    }
    assert_eq!(&lines[lines.len() - 2..], ["  0", "EOF"]);
}
