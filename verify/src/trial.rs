//! The trial of one tree. It is evaluated; the boundary must keep its rules, its volume must agree
//! with ray casting, nothing may be outside the box, and the volumes of unions and intersections
//! must add up. If requested, views are recounted and searched for missing contours.

use crate::checks::{Check, CheckReport, CheckSubject, Checker, Finding, ViewChecks, views};
use crate::generator::model::{ModelNodeKind, ModelOperation, PartModel};
use crate::generator::write::description;
use premio_csg::evaluate::{Arithmetic, Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::ErrorKind;
use premio_csg::recover::recovered;
use premio_csg::tree::Tree;
use premio_kernel::brep::signature::Signature;
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;

/// The views that are recounted: a perspective, a general orthographic one, and those along the
/// axes, where limbs coincide with edges and with one another.
pub const VIEWS: [&str; 5] = [
    "perspective 3",
    "orthographic 1",
    "along x",
    "along y",
    "along z",
];

/// The configuration of a trial.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct TrialConfig {
    /// The resolution, in the model's unit; the default is 1e-11 of its size.
    pub resolution: Option<f64>,
    /// Whether close calls are refused.
    pub strict: bool,
    /// Whether views are recounted.
    pub views: bool,
    /// Whether sheets of views are read back.
    #[serde(default)]
    pub sheets: bool,
    /// Whether STEP files and meshes are written and read back.
    #[serde(default)]
    pub step: bool,
    /// Whether the tree is evaluated once more with no decision made in f64.
    #[serde(default)]
    pub unfiltered: bool,
    /// The number of rays that measure the volume.
    pub rays: u32,
}

/// What can be wrong with a result.
#[derive(Clone, Copy, Debug, Deserialize, Eq, Ord, PartialEq, PartialOrd, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum FailureKind {
    /// The boundary breaks a rule.
    Topology,
    /// The volume disagrees with ray casting.
    Volume,
    /// Rays hit material outside the box.
    Bounds,
    /// The volumes of A ∪ B, A ∩ B, A \ B, A and B do not add up.
    Sums,
    /// With no decision made in f64 the boundary differs, or there is none.
    Filter,
    /// A piece of a view has a wrong number of faces in front of it.
    View,
    /// A contour of a view is missing.
    Contours,
    /// The boundary of the part's shadow in a view is not drawn.
    Outline,
    /// A sheet, read back, disagrees with the contours.
    Sheet,
    /// The STEP file breaks a rule.
    Step,
    /// A mesh breaks a rule.
    Mesh,
    /// The evaluation, or a check, panicked.
    Panic,
    /// The process ended without a result: its stack or memory overflowed, or it was aborted.
    Crash,
    /// There was no result within the time limit.
    Time,
    /// The generated description cannot be read.
    Input,
}

impl FailureKind {
    /// The name, as it is written in the summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Topology => "topology",
            Self::Volume => "volume",
            Self::Bounds => "bounds",
            Self::Sums => "sums",
            Self::Filter => "filter",
            Self::View => "view",
            Self::Contours => "contours",
            Self::Outline => "outline",
            Self::Sheet => "sheet",
            Self::Step => "step",
            Self::Mesh => "mesh",
            Self::Panic => "panic",
            Self::Crash => "crash",
            Self::Time => "time",
            Self::Input => "input",
        }
    }
}

/// A fault, with the measured values.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Fault {
    /// The kind.
    pub kind: FailureKind,
    /// The description of the fault.
    pub text: String,
}

/// The measures of a solid.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct TrialMeasures {
    /// The volume, in cubic units.
    pub volume: f64,
    /// The area, in square units.
    pub area: f64,
    /// The least and the greatest coordinates; none for an empty solid.
    pub bounds: Option<[[f64; 3]; 2]>,
    /// The number of connected solids.
    pub solids: usize,
}

/// The end of a trial.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// All checks passed.
    Right(TrialMeasures),
    /// There is no result, for this reason.
    Refused(String),
    /// The result, or its absence, is wrong in these ways.
    Wrong(Vec<Fault>),
}

/// The outcome of a trial.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct TrialOutcome {
    /// The verdict.
    pub verdict: Verdict,
    /// The number of close decisions.
    pub close_calls: usize,
    /// The undetermined checks.
    #[serde(default)]
    pub undetermined: Vec<String>,
    /// The duration of reading and evaluating the tree, without the checks, in seconds.
    #[serde(default)]
    pub seconds: f64,
}

impl TrialOutcome {
    /// An outcome with one fault.
    pub fn wrong(kind: FailureKind, text: impl Into<String>) -> Self {
        let text = text.into();
        Self {
            verdict: Verdict::Wrong(vec![Fault { kind, text }]),
            close_calls: 0,
            undetermined: Vec::new(),
            seconds: 0.0,
        }
    }
}

/// The text of a refusal without locations and other numbers, which identifies its kind.
pub fn reason(text: &str) -> String {
    let mut kind = String::new();
    let mut rest = text;
    while let Some(at) = rest.find(|c: char| c.is_ascii_digit()) {
        // A sign belongs to the number, and so does an exponent.
        let start = rest[..at].trim_end_matches(['-', '+', '.']).len();
        let number = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | '-' | '+');
        let end = rest[at..]
            .find(|c| !number(c))
            .map_or(rest.len(), |n| at + n);
        // A full stop at the end of a sentence is not part of the number.
        let end = at + rest[at..end].trim_end_matches(['.', '-', '+', 'e']).len();
        kind += &rest[..start];
        kind.push('#');
        rest = &rest[end..];
    }
    kind += rest;
    kind.replace("(#, #, #)", "a point")
}

/// Runs the trial of a tree; a panic is reported as a fault.
pub fn guarded(model: &PartModel, terms: &TrialConfig) -> TrialOutcome {
    catch_unwind(AssertUnwindSafe(|| examine(model, terms)))
        .unwrap_or_else(|panic| TrialOutcome::wrong(FailureKind::Panic, message(&*panic)))
}

/// The message of a panic.
pub fn message(panic: &(dyn Any + Send)) -> &str {
    match (panic.downcast_ref::<&str>(), panic.downcast_ref::<String>()) {
        (Some(text), _) => text,
        (None, Some(text)) => text,
        (None, None) => "of an unknown kind",
    }
}

/// Runs the trial of a tree.
pub(crate) fn examine(model: &PartModel, terms: &TrialConfig) -> TrialOutcome {
    let started = Instant::now();
    let description = match description(model) {
        Ok(description) => description,
        // Not all figures have solids with exact boundaries.
        Err(error) if error.kind == ErrorKind::Limit || model.has_figures() => {
            return refused(error.to_string(), 0);
        }
        Err(error) => return TrialOutcome::wrong(FailureKind::Input, error.to_string()),
    };
    // As the program does: the relations that the rounding of coordinates destroyed are recovered.
    let options = options(terms);
    let recovery = options.recovers().then(|| recovered(&description.tree));
    let recovery = recovery.flatten();
    let tree = recovery.as_ref().map_or(&description.tree, |r| &r.tree);
    let evaluation = match evaluate(tree, &options) {
        Ok(evaluation) => evaluation,
        Err(error) => return refused(error.to_string(), 0),
    };
    let seconds = started.elapsed().as_secs_f64();
    let close_calls = evaluation.decisions.close_calls.len();
    if terms.strict && close_calls > 0 {
        let text = "decisions close to the resolution, under --strict";
        return refused(text.to_owned(), close_calls);
    }
    let checker = Checker::new(tree, &evaluation);
    let mut report = checker.solid(terms.rays as usize);
    let checks_wanted = ViewChecks {
        contours: terms.views,
        drawing: terms.sheets,
    };
    if report.passes() && (checks_wanted.contours || checks_wanted.drawing) {
        let all = views::around(&evaluation.bounds);
        for view in all.iter().filter(|v| VIEWS.contains(&v.name.as_str())) {
            let checks = checker.view_with(&view.name, &view.camera, checks_wanted);
            report.checks.extend(checks);
        }
    }
    if terms.step && report.passes() {
        report.checks.extend([checker.step(), checker.mesh()]);
    }
    let mut faults = faults(&report);
    // Of moved primitives subtrees have other volumes than as written.
    if recovery.is_none() {
        faults.extend(sums(model, &evaluation, terms));
    }
    if terms.unfiltered {
        faults.extend(filtered_wrongly(tree, &evaluation, terms));
    }
    let verdict = match faults.is_empty() {
        true => Verdict::Right(measures(&evaluation)),
        false => Verdict::Wrong(faults),
    };
    let undetermined = report
        .checks_with(Finding::Undetermined)
        .map(text)
        .collect();
    TrialOutcome {
        verdict,
        close_calls,
        undetermined,
        seconds,
    }
}

fn refused(text: String, close_calls: usize) -> TrialOutcome {
    TrialOutcome {
        verdict: Verdict::Refused(text),
        close_calls,
        undetermined: Vec::new(),
        seconds: 0.0,
    }
}

fn options(terms: &TrialConfig) -> EvaluationOptions {
    EvaluationOptions {
        resolution: terms.resolution,
        ..EvaluationOptions::default()
    }
}

fn faults(report: &CheckReport) -> Vec<Fault> {
    let fault = |check: &Check| {
        let kind = match check.subject {
            CheckSubject::Topology => FailureKind::Topology,
            CheckSubject::Volume => FailureKind::Volume,
            CheckSubject::Bounds => FailureKind::Bounds,
            CheckSubject::View(_) => FailureKind::View,
            CheckSubject::Contours(_) => FailureKind::Contours,
            CheckSubject::Outline(_) => FailureKind::Outline,
            CheckSubject::Sheet(_) => FailureKind::Sheet,
            CheckSubject::Step => FailureKind::Step,
            CheckSubject::Mesh => FailureKind::Mesh,
        };
        let text = text(check);
        Fault { kind, text }
    };
    report.checks_with(Finding::Fails).map(fault).collect()
}

fn text(check: &Check) -> String {
    format!("{}: {}", check.subject, check.detail)
}

fn measures(evaluation: &Evaluation) -> TrialMeasures {
    let (brep, mass) = (&evaluation.brep, evaluation.mass());
    let bounds = (!brep.topology.faces.is_empty()).then(|| evaluation.tight_bounds());
    TrialMeasures {
        volume: mass.volume,
        area: mass.area,
        bounds: bounds.map(|b| [b.min, b.max]),
        solids: brep.topology.solids.len(),
    }
}

/// The fault if the boundary differs when no decision is made in f64.
fn filtered_wrongly(tree: &Tree, known: &Evaluation, terms: &TrialConfig) -> Option<Fault> {
    let unfiltered = EvaluationOptions {
        digits: Arithmetic::Extended,
        ..options(terms)
    };
    let fault = |text| Fault {
        kind: FailureKind::Filter,
        text,
    };
    let again = match evaluate(tree, &unfiltered) {
        Ok(again) => again,
        Err(error) => return Some(fault(error.to_string())),
    };
    let differ = Signature::new(&known.brep) != Signature::new(&again.brep);
    let counts = || [known, &again].map(|part| part.brep.topology.census());
    differ.then(|| fault(format!("f64 and extended precision differ: {:?}", counts())))
}

/// The number of primitives above which a tree's sums of volumes are not checked.
const FEW: usize = 12;

/// The allowed error of sums of volumes, relative to the cube of the size, in addition to the
/// effect of the resolution over the surface. Volumes are accurate to about ten digits.
const OFF: f64 = 1.0 / (1u64 << 31) as f64;

/// The fault if the volumes of the root's first child A, of its other children B, and of their
/// union, intersection and difference do not add up.
fn sums(model: &PartModel, evaluation: &Evaluation, terms: &TrialConfig) -> Option<Fault> {
    if model.leaves().count() > FEW {
        return None;
    }
    let ModelNodeKind::Operation(op, _) = model.nodes().last()?.kind else {
        return None;
    };
    let [a, b] = sides(model, op)?;
    let join = |op| PartModel::join(op, &[&a, &b], Vec::new());
    let known = evaluation.mass().volume;
    let volume = |of: ModelOperation| match of == op {
        true => Some(known),
        false => volume(&join(of), terms),
    };
    let [both, either, rest] = [
        volume(ModelOperation::Intersection)?,
        volume(ModelOperation::Union)?,
        volume(ModelOperation::Difference)?,
    ];
    let [of_a, of_b] = [self::volume(&a, terms)?, self::volume(&b, terms)?];
    let off = [either + both - of_a - of_b, rest + both - of_a];
    let size = diagonal(&[&a, &b]).max(evaluation.bounds.diagonal());
    let allowed = size.powi(3) * OFF + 6.0 * size.powi(2) * evaluation.resolution;
    off.iter().any(|v| v.abs() > allowed).then(|| Fault {
        kind: FailureKind::Sums,
        text: format!(
            "A {of_a}, B {of_b}, A or B {either}, A and B {both}, A less B {rest}: off by {off:?}"
        ),
    })
}

/// The root's first child, and the combination of its other children: their union or intersection.
fn sides(model: &PartModel, op: ModelOperation) -> Option<[PartModel; 2]> {
    let mut children = model.children();
    if children.len() < 2 {
        return None;
    }
    let others: Vec<PartModel> = children.split_off(1);
    let others: Vec<&PartModel> = others.iter().collect();
    let b = match (op, others.as_slice()) {
        (_, [only]) => (*only).clone(),
        (ModelOperation::Intersection, _) => PartModel::join(op, &others, Vec::new()),
        _ => PartModel::join(ModelOperation::Union, &others, Vec::new()),
    };
    Some([children.pop()?, b])
}

/// The volume of a tree; `None` if it is refused, which is the subject of its own trial.
fn volume(model: &PartModel, terms: &TrialConfig) -> Option<f64> {
    let tree = description(model).ok()?.tree;
    let part = evaluate(&tree, &options(terms)).ok()?;
    Some(part.mass().volume)
}

/// The diagonal of a box that contains the primitives of these models.
pub(crate) fn diagonal(models: &[&PartModel]) -> f64 {
    let boxes = models.iter().filter_map(|model| {
        let tree = description(model).ok()?.tree;
        let material = premio_csg::ray_casting::RayOracle::new(&tree);
        Some(*material.bounds())
    });
    let all = boxes.reduce(|a, b| a.hull(&b)).map(|b| b.diagonal());
    all.filter(|d| d.is_finite()).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generator::model::{ModelPrimitive, ModelStep};

    const TERMS: TrialConfig = TrialConfig {
        resolution: None,
        strict: false,
        views: false,
        sheets: false,
        step: false,
        unfiltered: false,
        rays: 2000,
    };

    fn two(op: ModelOperation, apart: f64) -> PartModel {
        let block = PartModel::new(ModelPrimitive::Block([1.0; 3]), Vec::new());
        let other = PartModel::new(
            ModelPrimitive::Block([1.0; 3]),
            vec![ModelStep::Shift([apart, 0.0, 0.0])],
        );
        PartModel::join(op, &[&block, &other], Vec::new())
    }

    #[test]
    fn a_right_answer_has_its_measures() {
        let outcome = examine(&two(ModelOperation::Union, 0.5), &TERMS);
        let Verdict::Right(measures) = outcome.verdict else {
            panic!("{outcome:?}")
        };
        assert!((measures.volume - 1.5).abs() < 1e-12 && (measures.area - 8.0).abs() < 1e-12);
        assert_eq!(measures.bounds, Some([[0.0; 3], [1.5, 1.0, 1.0]]));
        assert_eq!(measures.solids, 1);
        let empty = examine(&two(ModelOperation::Intersection, 2.0), &TERMS);
        let Verdict::Right(measures) = empty.verdict else {
            panic!("{empty:?}")
        };
        assert_eq!((measures.bounds, measures.solids), (None, 0));
    }

    #[test]
    fn close_calls_are_counted_and_refused_if_strict() {
        let model = two(ModelOperation::Union, 1.0 + 1e-10);
        let outcome = examine(&model, &TERMS);
        assert!(matches!(outcome.verdict, Verdict::Right(_)) && outcome.close_calls > 0);
        let strict = TrialConfig {
            strict: true,
            ..TERMS
        };
        assert!(matches!(
            examine(&model, &strict).verdict,
            Verdict::Refused(_)
        ));
    }

    #[test]
    fn what_is_beyond_a_limit_is_refused() {
        let coarse = TrialConfig {
            resolution: Some(1.0),
            ..TERMS
        };
        let refused = examine(&two(ModelOperation::Union, 0.5), &coarse);
        assert!(
            matches!(refused.verdict, Verdict::Refused(_)),
            "{refused:?}"
        );
    }

    #[test]
    fn views_are_counted_again() {
        let views = TrialConfig {
            views: true,
            ..TERMS
        };
        let outcome = examine(&two(ModelOperation::Difference, 0.5), &views);
        assert!(matches!(outcome.verdict, Verdict::Right(_)), "{outcome:?}");
    }

    #[test]
    fn a_reason_has_no_numbers() {
        let text = "the intersection near (1.250000, -0.5, 2) is known to 1.2e-9 only: surfaces";
        assert_eq!(
            reason(text),
            "the intersection near a point is known to # only: surfaces"
        );
        assert_eq!(reason("3."), "#.");
        assert_eq!(reason("no number"), "no number");
        assert_eq!(reason("angles (0.1, -2e-3)"), "angles (#, #)");
    }
}
