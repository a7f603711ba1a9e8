//! What is asked of every tree: it is evaluated without a refusal, a panic or a close call, the
//! boundary keeps its rules, the volume is the rays', no piece of a view is wrong, and no contour is
//! missing.

use crate::cast::Cast;
use premio::checks::{Checker, views};
use premio_csg::boundary::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, Options, read};
use premio_kernel::brep::locate::{FaceLocator, Place};
use premio_visibility::contour::{Contour, Piece};
use premio_visibility::invisibility::Method;
use premio_visibility::view::contours_by;
use premio_visibility::{Camera, Contours, contours};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc;
use std::time::Duration;

/// A perspective, a general orthographic and the axis views: along the axes limbs lie on edges and
/// on one another.
pub const VIEWS: [&str; 5] = [
    "perspective 3",
    "orthographic 1",
    "along x",
    "along y",
    "along z",
];

/// The place in a piece that is asked first for what lies before it, as a part of its range.
const COUNTED_AT: f64 = 0.47;

/// How far a point of a face may be off, in multiples of the resolution.
const ON: f64 = 4.0;

/// What to look at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depth {
    /// How many rays measure the volume.
    pub rays: usize,
    /// The names of the views that are examined.
    pub views: &'static [&'static str],
}

/// The outcome of some work; none where it takes longer than `limit`, and then goes on unheeded.
pub fn within<T: Send + 'static>(
    limit: Duration,
    work: impl FnOnce() -> T + Send + 'static,
) -> Option<T> {
    let (sender, receiver) = mpsc::channel();
    // Nobody listens any more where the time has run out.
    std::thread::spawn(move || sender.send(work()).is_ok());
    receiver.recv_timeout(limit).ok()
}

/// The same as [`examine`], given up after some time.
pub fn examine_within(json: &str, depth: Depth, limit: Duration) -> Vec<String> {
    let text = json.to_owned();
    within(limit, move || examine(&text, depth))
        .unwrap_or_else(|| vec![format!("time: more than {limit:?}")])
}

/// What is wrong with a tree, one kind each; nothing where all is well.
pub fn examine(json: &str, depth: Depth) -> Vec<String> {
    let work = AssertUnwindSafe(|| examine_unguarded(json, depth));
    catch_unwind(work).unwrap_or_else(|panic| vec![format!("panic: {}", message(&*panic))])
}

fn message(panic: &(dyn std::any::Any + Send)) -> &str {
    match (panic.downcast_ref::<&str>(), panic.downcast_ref::<String>()) {
        (Some(text), _) => text,
        (None, Some(text)) => text,
        (None, None) => "of an unknown kind",
    }
}

fn examine_unguarded(json: &str, depth: Depth) -> Vec<String> {
    let description = match read("tree", json.as_bytes(), Format::Json, &Options::default()) {
        Ok(description) => description,
        Err(error) => return vec![format!("refusal: {error}")],
    };
    let evaluation = match evaluate(&description.tree, &EvaluationOptions::default()) {
        Ok(evaluation) => evaluation,
        Err(error) => return vec![format!("refusal: {error}")],
    };
    let mut wrong = Vec::new();
    if let Some(call) = evaluation.decisions.close_calls.first() {
        let [x, y, z] = call.place;
        wrong.push(format!(
            "close call: {} {:e} apart at ({x}, {y}, {z})",
            call.question, call.distance
        ));
    }
    let checker = Checker::new(&description.tree, &evaluation);
    let mut report = checker.solid(depth.rays);
    if !depth.views.is_empty() && report.holds() {
        let all = views::around(&evaluation.bounds);
        let cast = Cast::of(&evaluation);
        match &cast {
            Ok(cast) => wrong.extend(cast.faults(&evaluation)),
            Err(error) => wrong.push(format!("mesh: {error}")),
        }
        for &name in depth.views {
            for v in all.iter().filter(|v| v.name == name) {
                report.checks.extend(checker.view(&v.name, &v.camera));
                wrong.extend(differences(&evaluation, &v.name, &v.camera));
                if let Ok(cast) = &cast {
                    wrong.extend(before(cast, &evaluation, &v.name, &v.camera));
                }
            }
        }
    }
    wrong.extend(
        report
            .failures()
            .map(|c| format!("{}: {}", c.subject, c.detail)),
    );
    wrong
}

/// Where rays on triangles of the boundary see something else before a piece than it says.
fn before(cast: &Cast, evaluation: &Evaluation, name: &str, camera: &Camera) -> Option<String> {
    let seen = contours(&evaluation.brep, camera, evaluation.resolution).ok()?;
    let counted = cast.count(&seen);
    let first = counted.wrong.first()?;
    Some(format!(
        "triangles in {name}: {} of {} samples; {first}",
        counted.wrong.len(),
        counted.agreed + counted.unclear + counted.wrong.len()
    ))
}

/// Where the invisibility that is carried along contours is not what is counted piece by piece.
pub fn differences(evaluation: &Evaluation, name: &str, camera: &Camera) -> Option<String> {
    let of = |method| contours_by(&evaluation.brep, camera, evaluation.resolution, method).ok();
    let (carried, counted) = (of(Method::Carried)?, of(Method::Counted)?);
    let pieces = |seen: &Contours| -> Vec<usize> {
        let each = seen.contours.iter();
        each.map(|c| c.pieces.len()).collect()
    };
    if pieces(&carried) != pieces(&counted) {
        return Some(format!("methods in {name}: not the same pieces"));
    }
    let both = carried.contours.iter().zip(&counted.contours);
    let differ = |contour: &Contour, a: &Piece, b: &Piece| {
        let apart = a.qi.abs_diff(b.qi) as usize;
        a.t != b.t || apart > 0 && apart > lies_on(evaluation, contour, a)
    };
    both.flat_map(|(a, b)| a.pieces.iter().zip(&b.pieces).map(move |pair| (a, pair)))
        .find(|(contour, (a, b))| differ(contour, a, b))
        .map(|(contour, (a, b))| {
            let (id, [from, to]) = (contour.id, a.t);
            format!(
                "methods in {name}: contour {id} from {from} to {to}: carried {}, counted {} from {} to {}",
                a.qi, b.qi, b.t[0], b.t[1]
            )
        })
}

/// On how many faces that are not its own a piece lies within the resolution, next to its middle,
/// where it is counted: whether these lie before it is not to be told.
fn lies_on(evaluation: &Evaluation, contour: &Contour, piece: &Piece) -> usize {
    let (brep, band) = (&evaluation.brep, evaluation.resolution);
    let [lo, hi] = piece.t;
    let p = contour.curve3.point(lo + (hi - lo) * COUNTED_AT);
    let others = brep.topology.face_ids();
    let others = others.filter(|f| !contour.faces.contains(f));
    let on = others.filter(|&f| {
        let near = brep.surface(f).distance(&p).abs() <= ON * band;
        near && FaceLocator::of(brep, f, band).place(&p) != Place::Outside
    });
    on.count()
}
