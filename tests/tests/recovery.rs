//! Parts whose primitives lie at rounded coordinates are as they were meant.

use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::Format;
use premio_csg::recover::recovered;
use premio_csg::tree::Tree;
use premio_verify::generator::model::PartModel;
use premio_verify::generator::profile::Profile;
use premio_verify::generator::profile::rounded::{CoordinateRounding, meant};
use premio_verify::generator::write::{read, write};
use rayon::prelude::*;

fn tree(model: &PartModel) -> Tree {
    read(&write(model, Format::Json), Format::Json)
        .unwrap()
        .tree
}

fn evaluated(tree: &Tree) -> Evaluation {
    evaluate(tree, &EvaluationOptions::default()).unwrap()
}

/// The largest difference of volumes that a rounding explains, relative to area times unit.
const LAYERS: f64 = 3.0;

/// What differs between a part at rounded coordinates and the part that was meant.
fn difference(seed: u64) -> Option<String> {
    let meant = evaluated(&tree(&meant(seed)));
    let written = tree(&Profile::Rounded.model(seed));
    let Some(recovery) = recovered(&written) else {
        return Some(format!("{seed}: nothing is recovered"));
    };
    let found = evaluated(&recovery.tree);
    let counts = |part: &Evaluation| {
        let topology = &part.brep.topology;
        (
            topology.faces.len(),
            topology.edges.len(),
            topology.solids.len(),
        )
    };
    if counts(&found) != counts(&meant) {
        return Some(format!(
            "{seed}: {:?}, meant {:?}",
            counts(&found),
            counts(&meant)
        ));
    }
    // The farthest coordinate has the coarsest digits.
    let reach = meant.bounds.diagonal();
    let unit = 10f64.powi(-(CoordinateRounding::new(seed).decimals(reach) as i32));
    let [known, volume] = [&meant, &found].map(|part| part.mass().volume);
    let most = LAYERS * meant.mass().area * unit + 1e-9 * known;
    let is_off = (volume - known).abs() > most;
    is_off.then(|| format!("{seed}: volume {volume}, meant {known}"))
}

/// Parts of few primitives may have too few coordinates for a rounding.
#[test]
fn rounded_parts_are_as_they_were_meant() {
    let seeds: Vec<u64> = (0..240).collect();
    let large = |seed: &u64| tree(&Profile::Rounded.model(*seed)).leaves().count() >= 8;
    let seeds: Vec<u64> = seeds.into_par_iter().filter(large).collect();
    assert!(seeds.len() > 80, "{} parts", seeds.len());
    let differences: Vec<String> = seeds.into_par_iter().filter_map(difference).collect();
    assert!(differences.is_empty(), "{differences:#?}");
}
