//! Trees and views mirrored at y = 0: the view of one is the mirror image of the view of the other.

use crate::random::tree;
use nalgebra::{Point3, Vector3};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_visibility::contours::{Contour, ContourKind, ImageCurve};
use premio_visibility::{Contours, ViewCamera, contours};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// The number of chords by which a piece is measured.
const CHORDS: usize = 256;

/// The error of measures by chords, relative to the part's size.
const OFF: f64 = 1e-3;

/// The mirrored tree. Every primitive is its own mirror image, except that blocks and wedges are
/// moved along y. The axis of a rotation is a pseudovector.
pub fn mirrored(tree: &Value) -> Value {
    let Value::Object(members) = tree else {
        return tree.clone();
    };
    let mut image = members.clone();
    if let Some(Value::Array(children)) = image.get_mut("children") {
        *children = children.iter().map(mirrored).collect();
    }
    let moved = members.get("size").map(|size| {
        let width = size[1].as_f64().unwrap_or(f64::NAN);
        json!({"translate": [0.0, -width, 0.0]})
    });
    let steps = members.get("transform").and_then(Value::as_array);
    let steps: Vec<Value> = moved
        .into_iter()
        .chain(steps.into_iter().flatten().map(mirrored_step))
        .collect();
    image.insert("transform".to_owned(), Value::Array(steps));
    Value::Object(image)
}

fn mirrored_step(step: &Value) -> Value {
    let with_signs = |v: &Value, signs: [f64; 3]| {
        let number = |k: usize| signs[k] * v[k].as_f64().unwrap_or(f64::NAN);
        json!([number(0), number(1), number(2)])
    };
    match (step.get("translate"), step.get("rotate")) {
        (Some(by), None) => json!({"translate": with_signs(by, [1.0, -1.0, 1.0])}),
        (None, Some(turn)) => {
            json!({"rotate": [with_signs(&turn[0], [-1.0, 1.0, -1.0]), turn[1]]})
        }
        _ => Value::Null,
    }
}

/// The visible length of one kind of contour with one quantitative invisibility.
#[derive(Clone, Copy, Debug, Default)]
struct Share {
    length: f64,
    /// The integral of the position over the length.
    moment: Vector3<f64>,
}

/// The shares by kind, smoothness, and quantitative invisibility.
type Shares = BTreeMap<(bool, bool, u32), Share>;

/// Pieces are not counted: where contours coincide in the image they may be split although nothing
/// changes. A contour seen end-on has no length, and lies on whatever passes there.
fn shares(seen: &Contours) -> Shares {
    let mut shares = Shares::new();
    let is_seen = |c: &&Contour| !matches!(c.image_curve, ImageCurve::Point { .. });
    for contour in seen.contours.iter().filter(is_seen) {
        let limb = contour.kind == ContourKind::Limb;
        for piece in &contour.pieces {
            let share = shares
                .entry((limb, contour.smooth, piece.quantitative_invisibility))
                .or_default();
            let [lo, hi] = piece.range;
            let at = |k: usize| {
                let part = k as f64 / CHORDS as f64;
                contour.space_curve.point(lo + (hi - lo) * part)
            };
            for k in 0..CHORDS {
                let (a, b) = (at(k), at(k + 1));
                let chord = (b - a).norm();
                share.length += chord;
                share.moment += nalgebra::center(&a, &b).coords * chord;
            }
        }
    }
    shares
}

fn evaluated(tree: &Value) -> Result<Evaluation, String> {
    let text = tree.to_string();
    let read = read(
        "tree",
        text.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    );
    let tree = read.map_err(|error| error.to_string())?.tree;
    evaluate(&tree, &EvaluationOptions::default()).map_err(|error| error.to_string())
}

/// The cameras of a part and those of its mirror image: from an odd position close by and far away,
/// and along x and z.
fn cameras(part: &Evaluation) -> Vec<[ViewCamera; 2]> {
    let [min, max] = [part.bounds.min, part.bounds.max].map(Point3::from);
    let (centre, size) = (nalgebra::center(&min, &max), part.bounds.diagonal());
    let glass = |p: Point3<f64>| Point3::new(p.x, -p.y, p.z);
    let ways = [
        (Vector3::new(1.3, -1.9, 1.1), true),
        (Vector3::new(-1.7, 0.9, 0.6), false),
        (Vector3::x() * 3.0, false),
        (Vector3::z() * 3.0, true),
    ];
    let both = ways.iter().filter_map(|&(way, central)| {
        let eye = centre + way * size;
        let up = match way.x == 0.0 && way.y == 0.0 {
            true => Vector3::x(),
            false => Vector3::z(),
        };
        let camera = |eye, target| match central {
            true => ViewCamera::perspective(eye, target, up, 1.0).ok(),
            false => ViewCamera::orthographic(eye, target, up).ok(),
        };
        Some([camera(eye, centre)?, camera(glass(eye), glass(centre))?])
    });
    both.collect()
}

/// The difference if two views are not mirror images of each other.
fn difference(a: &Shares, b: &Shares, size: f64) -> Option<String> {
    let known: BTreeSet<_> = a.keys().chain(b.keys()).collect();
    known.into_iter().find_map(|known| {
        let [x, y] = [a, b].map(|of| of.get(known).copied().unwrap_or_default());
        let glass = Vector3::new(y.moment.x, -y.moment.y, y.moment.z);
        let alike = (x.length - y.length).abs() <= OFF * size
            && (x.moment - glass).norm() <= OFF * size * size;
        (!alike).then(|| format!("{known:?}: {x:?} for {y:?}"))
    })
}

/// The views of a random tree that differ from those of its mirror image, or the reason why there
/// are none.
pub fn broken_by(seed: u64) -> Vec<String> {
    let tree = tree(seed);
    let [part, image] = match [evaluated(&tree), evaluated(&mirrored(&tree))] {
        [Ok(part), Ok(image)] => [part, image],
        [Err(error), _] | [_, Err(error)] => return vec![format!("{seed}: {error}")],
    };
    let size = part.bounds.diagonal();
    let mut broken = Vec::new();
    for (k, [camera, other]) in cameras(&part).into_iter().enumerate() {
        let seen = [(&part, camera), (&image, other)]
            .map(|(of, camera)| contours(&of.brep, &camera, of.resolution));
        let fault = match seen {
            [Ok(a), Ok(b)] => difference(&shares(&a), &shares(&b), size),
            [Err(error), _] | [_, Err(error)] => Some(error.to_string()),
        };
        broken.extend(fault.map(|fault| format!("{seed} in view {k}: {fault}")));
    }
    broken
}
