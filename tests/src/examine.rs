//! The examination of every tree. It is evaluated without a refusal, a panic or a close call; the
//! boundary keeps its rules; the volume agrees with ray casting; no piece of a view is wrong; and
//! no contour is missing.

use crate::cast::Cast;
use nalgebra::Point3;
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_kernel::brep::locate::{FaceLocator, PointLocation};
use premio_verify::checks::{Checker, views};
use premio_verify::trial::message;
use premio_visibility::camera::projection::Projection;
use premio_visibility::contours::contours_with;
use premio_visibility::contours::{Contour, ContourPiece};
use premio_visibility::invisibility::Method;
use premio_visibility::{Contours, ViewCamera, contours};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc;
use std::time::Duration;

pub use premio_verify::trial::VIEWS;

/// The fraction of a piece's range at which the faces in front of it are counted first.
const COUNTED_AT: f64 = 0.47;

/// The distance from a contour at which its sides are examined, in multiples of the resolution.
const LATERAL: f64 = 64.0;

/// The number of points of a piece that are tested for passing close to a line of sight, and the
/// number of bisections between them.
const POINTS: u32 = 256;
const HALVINGS: usize = 80;

/// The error of a point on a face, in multiples of the resolution.
const ON: f64 = 4.0;

/// The extent of an examination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Depth {
    /// How many rays measure the volume.
    pub rays: usize,
    /// The names of the views that are examined.
    pub views: &'static [&'static str],
}

/// The result of some work; `None` if it takes longer than `limit`. The work then continues
/// unobserved.
pub fn within<T: Send + 'static>(
    limit: Duration,
    work: impl FnOnce() -> T + Send + 'static,
) -> Option<T> {
    let (sender, receiver) = mpsc::channel();
    // The receiver is gone if the time has run out.
    std::thread::spawn(move || sender.send(work()).is_ok());
    receiver.recv_timeout(limit).ok()
}

/// [`examine`], with a time limit.
pub fn examine_within(json: &str, depth: Depth, limit: Duration) -> Vec<String> {
    let text = json.to_owned();
    within(limit, move || examine(&text, depth))
        .unwrap_or_else(|| vec![format!("time: more than {limit:?}")])
}

/// The faults of a tree, one of each kind; empty if there are none.
pub fn examine(json: &str, depth: Depth) -> Vec<String> {
    let work = AssertUnwindSafe(|| examine_unguarded(json, depth));
    catch_unwind(work).unwrap_or_else(|panic| vec![format!("panic: {}", message(&*panic))])
}

fn examine_unguarded(json: &str, depth: Depth) -> Vec<String> {
    let description = match read(
        "tree",
        json.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    ) {
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
    let drawn = evaluation.view_resolution().is_some();
    if drawn && !depth.views.is_empty() && report.passes() {
        let all = views::around(&evaluation.bounds);
        let cast = Cast::new(&evaluation);
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

/// The pieces in front of which rays on triangles of the boundary count other faces than given.
fn before(cast: &Cast, evaluation: &Evaluation, name: &str, camera: &ViewCamera) -> Option<String> {
    let seen = contours(&evaluation.brep, camera, evaluation.resolution).ok()?;
    let counted = cast.count(&seen);
    let first = counted.wrong.first()?;
    Some(format!(
        "triangles in {name}: {} of {} samples; {first}",
        counted.wrong.len(),
        counted.agreed + counted.unclear + counted.wrong.len()
    ))
}

/// The pieces whose propagated invisibility differs from the recounted one.
pub fn differences(evaluation: &Evaluation, name: &str, camera: &ViewCamera) -> Option<String> {
    let of = |method| contours_with(&evaluation.brep, camera, evaluation.resolution, method).ok();
    let (carried, counted) = (of(Method::Propagated)?, of(Method::Recounted)?);
    let pieces = |seen: &Contours| -> Vec<usize> {
        let each = seen.contours.iter();
        each.map(|c| c.pieces.len()).collect()
    };
    if pieces(&carried) != pieces(&counted) {
        return Some(format!("methods in {name}: not the same pieces"));
    }
    let both = carried.contours.iter().zip(&counted.contours);
    let differ = |contour: &Contour, a: &ContourPiece, b: &ContourPiece| {
        let apart = a
            .quantitative_invisibility
            .abs_diff(b.quantitative_invisibility) as usize;
        let is_decided = || apart > lies_on(evaluation, contour, a);
        a.range != b.range
            || is_decided() && apart > passing(evaluation, &carried, contour, a, camera)
    };
    both.flat_map(|(a, b)| a.pieces.iter().zip(&b.pieces).map(move |pair| (a, pair)))
        .find(|(contour, (a, b))| differ(contour, a, b))
        .map(|(contour, (a, b))| {
            let (id, [from, to]) = (contour.id, a.range);
            format!(
                "methods in {name}: contour {id} from {from} to {to}: carried {}, counted {} from {} to {}",
                a.quantitative_invisibility, b.quantitative_invisibility, b.range[0], b.range[1]
            )
        })
}

/// The number of contours that pass the line of sight of the point at which a piece is counted,
/// within the distance examined around it. The side on which they pass is not resolved.
fn passing(
    evaluation: &Evaluation,
    seen: &Contours,
    contour: &Contour,
    piece: &ContourPiece,
    camera: &ViewCamera,
) -> usize {
    let [lo, hi] = piece.range;
    let p = contour.space_curve.point(lo + (hi - lo) * COUNTED_AT);
    let size = evaluation.bounds.diagonal();
    let v = Projection::new(camera, size).towards_eye(&p).direction;
    let away = |q: Point3<f64>| (q - p).cross(&v).norm();
    // Another part of the contour itself counts if it is clearly closer to the eye.
    let before = |other: &Contour, q: Point3<f64>| {
        let own = other.id == contour.id;
        (q - p).dot(&v) > if own { size / f64::from(POINTS) } else { 0.0 }
    };
    let passes = |other: &Contour, near: &ContourPiece| {
        let [lo, hi] = near.range;
        let at = |k: f64| {
            other
                .space_curve
                .point(lo + (hi - lo) * (k / f64::from(POINTS)))
        };
        let samples = (0..=POINTS)
            .map(f64::from)
            .filter(|&k| before(other, at(k)));
        let Some(k) = samples.min_by(|&k, &l| away(at(k)).total_cmp(&away(at(l)))) else {
            return false;
        };
        let (mut from, mut to) = (k - 1.0, k + 1.0);
        for _ in 0..HALVINGS {
            let [m, n] = [from + (to - from) / 3.0, to - (to - from) / 3.0];
            match away(at(m)) < away(at(n)) {
                true => to = n,
                false => from = m,
            }
        }
        away(at(0.5 * (from + to))) <= LATERAL * evaluation.resolution
    };
    let of = |other: &&Contour| other.pieces.iter().any(|near| passes(other, near));
    seen.contours.iter().filter(of).count()
}

/// The number of other faces on which a piece lies within the resolution, at the point at which it
/// is counted. Whether these are in front of the piece is ambiguous.
fn lies_on(evaluation: &Evaluation, contour: &Contour, piece: &ContourPiece) -> usize {
    let (brep, resolution) = (&evaluation.brep, evaluation.resolution);
    let [lo, hi] = piece.range;
    let p = contour.space_curve.point(lo + (hi - lo) * COUNTED_AT);
    let others = brep.topology.face_ids();
    let others = others.filter(|f| !contour.faces.contains(f));
    let on = others.filter(|&f| {
        let near = brep.surface(f).distance(&p).abs() <= ON * resolution;
        near && FaceLocator::from_face(brep, f, resolution).place(&p) != PointLocation::Outside
    });
    on.count()
}
