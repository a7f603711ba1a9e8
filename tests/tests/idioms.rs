//! The idioms of OpenSCAD files, from the folder `scad` of the corpus that PREMIO_CORPUS names: volume,
//! area, and the kinds of the surfaces.

use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_kernel::geometry::surface::SurfaceKind;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Debug, Deserialize)]
struct Idiom {
    file: String,
    volume: f64,
    area: f64,
    /// The error of the volume.
    error: f64,
    surfaces: BTreeSet<String>,
}

/// The word of the corpus for a kind of surface.
fn word(kind: SurfaceKind) -> &'static str {
    match kind {
        SurfaceKind::EllipticCylinder | SurfaceKind::EllipticCone | SurfaceKind::Ellipsoid => {
            "quadric"
        }
        other => other.name(),
    }
}

impl Idiom {
    /// What is wrong with a file.
    fn fault(&self, folder: &Path) -> Option<String> {
        let text = fs::read(folder.join(&self.file)).unwrap();
        let options = ReadOptions::default();
        let description = match read(&self.file, &text, Format::Csg, &options) {
            Ok(description) => description,
            Err(error) => return Some(error.to_string()),
        };
        let known = match evaluate(&description.tree, &EvaluationOptions::default()) {
            Ok(known) => known,
            Err(error) => return Some(error.to_string()),
        };
        let mass = known.mass();
        let relative = self.error / self.volume;
        let brep = &known.brep;
        let kinds = brep
            .topology
            .face_ids()
            .map(|f| word(brep.surface(f).kind()));
        let kinds: BTreeSet<String> = kinds.map(str::to_owned).collect();
        if (mass.volume - self.volume).abs() > self.error {
            return Some(format!(
                "the volume is {}, not {}",
                mass.volume, self.volume
            ));
        }
        if (mass.area / self.area - 1.0).abs() > relative {
            return Some(format!("the area is {}, not {}", mass.area, self.area));
        }
        (!self.surfaces.is_subset(&kinds)).then(|| format!("{kinds:?}, not {:?}", self.surfaces))
    }
}

#[test]
fn idioms_of_openscad_are_exact() {
    let Some(folder) = std::env::var_os("PREMIO_CORPUS").map(PathBuf::from) else {
        return;
    };
    let folder = folder.join("scad");
    let cases = fs::read_to_string(folder.join("cases.json")).unwrap();
    let idioms: Vec<Idiom> = serde_json::from_str(&cases).unwrap();
    let fault = |idiom: &Idiom| Some(format!("{}: {}", idiom.file, idiom.fault(&folder)?));
    let faults: Vec<String> = idioms.iter().filter_map(fault).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
