//! The named cases: a folder for each, with a description, the reason why it is hard, and values
//! derived by hand.
//!
//! `answer.toml` contains formulas, not computed numbers; see `premio_tests::formula`. A case may
//! use the same description with several values of its parameters.

use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Description, Format, ReadOptions, read};
use premio_csg::tree::Tree;
use premio_tests::examine::within;
use premio_tests::formula::Definitions;
use premio_verify::checks::{Checker, ViewChecks, views};
use rayon::prelude::*;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Models that fail today. A model that starts to pass must be removed from the list.
const KNOWN_FAILURES: &[&str] = &[];

/// The relative precision of volumes and areas.
const PRECISION: f64 = 1e-9;

/// The time after which a model counts as without an end: far beyond what any takes, also on a loaded
/// machine.
const LIMIT: Duration = Duration::from_secs(300);

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    /// The reason why it is hard, in a line.
    why: String,
    /// Its origin.
    source: String,
    /// Definitions used by the formulas.
    #[serde(default)]
    given: Vec<String>,
    /// The expected answers.
    model: Vec<Answer>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    /// Values of the description's parameters that replace its own.
    #[serde(default)]
    set: BTreeMap<String, String>,
    /// The expected text of the reader's refusal, if it refuses.
    refused: Option<String>,
    volume: Option<String>,
    /// The volume by ray casting and five times its standard error, if no closed form is known.
    measured: Option<[f64; 2]>,
    area: Option<String>,
    /// The corners of the box.
    corners: Option<[[String; 3]; 2]>,
    solids: Option<usize>,
    shells: Option<usize>,
    faces: Option<usize>,
    edges: Option<usize>,
    loops: Option<usize>,
    vertices: Option<usize>,
    /// The number of edges that bound more than two face corners.
    #[serde(default)]
    edges_of_many_faces: usize,
    /// The number of points at which the boundary touches itself.
    #[serde(default)]
    touches: usize,
    /// The genus of each shell, in ascending order.
    genus: Option<Vec<i32>>,
    /// Whether a decision is within a factor of 100 of the resolution.
    #[serde(default)]
    close_calls: bool,
    /// Whether the views of `premio check` are checked.
    #[serde(default)]
    views: bool,
}

fn folders() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let entries = fs::read_dir(root).unwrap();
    let mut all: Vec<PathBuf> = entries.map(|e| e.unwrap().path()).collect();
    all.sort();
    all
}

/// The description with other values of its parameters. `NAME = value` is on a line of its own.
fn with_values(text: &str, set: &BTreeMap<String, String>) -> String {
    let mut used = BTreeSet::new();
    let lines = text.lines().map(|line| {
        let name = line.split('=').next().unwrap_or_default().trim();
        match set.get(name) {
            Some(value) => {
                used.insert(name);
                format!("{name} = {value}\n")
            }
            None => format!("{line}\n"),
        }
    });
    let text = lines.collect();
    assert_eq!(used.len(), set.len(), "{set:?} in {text}");
    text
}

/// The faults of a model; empty if there are none.
fn examine(case: &Case, answer: &Answer, text: &str) -> Vec<String> {
    let text = with_values(text, &answer.set);
    let options = ReadOptions::default();
    match read("model.padl", text.as_bytes(), Format::Padl, &options) {
        Ok(_) if answer.refused.is_some() => vec!["is not refused".to_owned()],
        Ok(description) => compare(case, answer, &description),
        Err(error) => match &answer.refused {
            Some(why) if error.to_string().contains(why) => Vec::new(),
            _ => vec![error.to_string()],
        },
    }
}

fn compare(case: &Case, answer: &Answer, description: &Description) -> Vec<String> {
    let evaluation = match evaluate(&description.tree, &EvaluationOptions::default()) {
        Ok(evaluation) => evaluation,
        Err(error) => return vec![error.to_string()],
    };
    let mut wrong = measures(case, answer, &evaluation);
    wrong.extend(counts(answer, &evaluation));
    let violations = evaluation.violations();
    wrong.extend(violations.iter().map(ToString::to_string));
    let calls = &evaluation.decisions.close_calls;
    if calls.is_empty() == answer.close_calls {
        wrong.push(format!("close calls: {calls:?}"));
    }
    if answer.views {
        wrong.extend(unlike_rays(&description.tree, &evaluation));
    }
    wrong
}

/// The checks of the views of `premio check` that disagree with rays.
fn unlike_rays(tree: &Tree, evaluation: &Evaluation) -> Vec<String> {
    let checker = Checker::new(tree, evaluation);
    let seen = views::around(&evaluation.bounds);
    let checks = seen
        .iter()
        .flat_map(|v| checker.view_with(&v.name, &v.camera, ViewChecks::ALL));
    let failed = checks.filter(|c| !c.passes());
    failed.map(|c| c.to_string()).collect()
}

fn measures(case: &Case, answer: &Answer, evaluation: &Evaluation) -> Vec<String> {
    let mut known = Definitions::default();
    for (name, value) in &answer.set {
        known.define(&format!("{name} = {value}")).unwrap();
    }
    for definition in &case.given {
        known.define(definition).unwrap();
    }
    let found = evaluation.mass();
    let mut wrong = Vec::new();
    let mut near = |what: &str, found: f64, expected: f64, slack: f64| {
        let off = (found - expected).abs();
        if off.is_nan() || off > slack {
            wrong.push(format!("{what} {found} for {expected}, {off:e} off"));
        }
    };
    for (what, found, formula) in [
        ("volume", found.volume, &answer.volume),
        ("area", found.area, &answer.area),
    ] {
        if let Some(formula) = formula {
            let expected = known.value(formula).unwrap();
            near(what, found, expected, PRECISION * expected.abs());
        }
    }
    if let Some([expected, slack]) = answer.measured {
        near("volume", found.volume, expected, slack);
    }
    let size = evaluation.tight_bounds();
    let corners = answer.corners.iter().flatten();
    for (formulas, found) in corners.zip([size.min, size.max]) {
        for (formula, found) in formulas.iter().zip(found) {
            near(
                "box",
                found,
                known.value(formula).unwrap(),
                evaluation.f64_resolution(),
            );
        }
    }
    let room: f64 = (0..3)
        .map(|i| (size.max[i] - size.min[i]).max(0.0))
        .product();
    if room < found.volume * (1.0 - PRECISION) {
        wrong.push(format!("the box {size:?} is too small"));
    }
    wrong
}

fn counts(answer: &Answer, evaluation: &Evaluation) -> Vec<String> {
    let t = &evaluation.brep.topology;
    let mut wrong = Vec::new();
    for (what, found, expected) in [
        ("solids", t.solids.len(), answer.solids),
        ("shells", t.shells.len(), answer.shells),
        ("faces", t.faces.len(), answer.faces),
        ("edges", t.edges.len(), answer.edges),
        ("loops", t.loops.len(), answer.loops),
        ("vertices", t.vertices as usize, answer.vertices),
        (
            "edges of many faces",
            t.edges_of_many_faces(),
            Some(answer.edges_of_many_faces),
        ),
        ("touches", t.touches.len(), Some(answer.touches)),
    ] {
        if expected.is_some_and(|e| e != found) {
            wrong.push(format!("{found} {what} for {}", expected.unwrap()));
        }
    }
    let mut genus: Vec<i32> = t.shells.iter().map(|s| s.genus).collect();
    genus.sort_unstable();
    if answer.genus.as_ref().is_some_and(|g| *g != genus) {
        wrong.push(format!("genus {genus:?} for {:?}", answer.genus));
    }
    wrong
}

#[test]
fn every_case_is_as_a_hand_derived_it() {
    let folders = folders();
    assert!(folders.len() > 60);
    let known: BTreeSet<&str> = KNOWN_FAILURES.iter().copied().collect();
    let mut tasks = Vec::new();
    for folder in &folders {
        let name = folder.file_name().unwrap().to_string_lossy().into_owned();
        let text = fs::read_to_string(folder.join("answer.toml")).unwrap();
        let case: Case = toml::from_str(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        assert!(!case.why.is_empty() && !case.source.is_empty(), "{name}");
        assert!(!case.model.is_empty(), "{name}");
        let model = fs::read_to_string(folder.join("model.padl")).unwrap();
        for answer in &case.model {
            let values: Vec<String> = answer.set.iter().map(|(n, v)| format!("{n}={v}")).collect();
            let name = [vec![name.clone()], values].concat().join(" ");
            tasks.push((name, (case.clone(), answer.clone(), model.clone())));
        }
    }
    let names: BTreeSet<String> = tasks.iter().map(|(name, _)| name.clone()).collect();
    let complaint = |(name, work): (String, (Case, Answer, String))| {
        let outcome = within(LIMIT, move || examine(&work.0, &work.1, &work.2));
        let wrong = outcome.unwrap_or_else(|| vec!["a panic, or no end".to_owned()]);
        match (wrong.is_empty(), known.contains(name.as_str())) {
            (true, true) => Some(format!("{name}: passes now: take it off the list")),
            (false, false) => Some(format!("{name}: {}", wrong.join("; "))),
            _ => None,
        }
    };
    let complaints: Vec<String> = tasks.into_par_iter().filter_map(complaint).collect();
    let gone: Vec<_> = known.iter().filter(|n| !names.contains(**n)).collect();
    assert!(gone.is_empty(), "no such case: {gone:?}");
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
