//! Files with known answers, from the folder that `PREMIO_CORPUS` names.

use super::*;
use std::path::PathBuf;

fn corpus() -> Option<PathBuf> {
    let folder = std::env::var_os("PREMIO_CORPUS").map(PathBuf::from);
    if folder.is_none() {
        // To the test's own output, which is shown on demand only.
        #[expect(clippy::print_stderr, reason = "says why a test tests nothing")]
        {
            eprintln!("PREMIO_CORPUS is not set: the corpus is not read");
        }
    }
    folder
}

fn file(name: &str, options: &ReadOptions) -> Option<Result<Description, ReadError>> {
    let path = corpus()?.join("openscad").join(name);
    let bytes = std::fs::read(path).unwrap();
    Some(read(name, &bytes, Format::Csg, options))
}

#[test]
fn flattened_files_are_read() {
    let counts = [
        ("CSG.csg", 6),
        ("cube-tests.csg", 3),
        ("example001.csg", 4),
        ("example002.csg", 6),
        ("example003.csg", 7),
        ("example005.csg", 10),
        ("example014.csg", 4),
        ("nullspace-difference.csg", 2),
    ];
    for (name, count) in counts {
        let Some(read) = file(name, &ReadOptions::default()) else {
            return;
        };
        let description = read.unwrap();
        assert_eq!(description.tree.leaves().count(), count, "{name}");
        assert_eq!(
            description.digits.is_some(),
            name == "example014.csg",
            "{name}"
        );
    }
    for name in ["example019.csg", "example022.csg", "for-nested-tests.csg"] {
        let Some(read) = file(name, &ReadOptions::default()) else {
            return;
        };
        assert!(read.unwrap().tree.leaves().count() > 20, "{name}");
    }
}

#[test]
fn polygons_and_elliptic_cones_are_read() {
    let Some(polygons) = file("sphere-tests.csg", &ReadOptions::default()) else {
        return;
    };
    let polygons = polygons.unwrap();
    assert!(
        polygons
            .notes
            .iter()
            .any(|note| note.text.contains("polygons"))
    );
    let options = ReadOptions {
        facets: FacetLimit::None,
        ..ReadOptions::default()
    };
    let Some(smooth) = file("sphere-tests.csg", &options) else {
        return;
    };
    assert!(smooth.is_ok());
    let Some(scaled) = file("transform-tests.csg", &ReadOptions::default()) else {
        return;
    };
    let tree = scaled.unwrap().tree;
    let is_oblique =
        |placed: &PlacedPrimitive| matches!(placed.primitive, Primitive::ObliqueFrustum { .. });
    assert_eq!(tree.leaves().filter(|leaf| is_oblique(leaf.1)).count(), 2);
}

#[test]
fn the_cases_are_read() {
    let Some(folder) = corpus() else { return };
    let text = std::fs::read_to_string(folder.join("cases.json")).unwrap();
    let cases: serde_json::Value = serde_json::from_str(&text).unwrap();
    for case in cases.as_array().unwrap() {
        let read = read_text(&case["tree"].to_string(), Format::Json);
        assert!(read.is_ok(), "{}: {read:?}", case["id"]);
    }
}
