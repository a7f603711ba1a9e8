//! The self-occlusion of a part by viewing direction, computed on demand and cached.

use super::SoughtPart;
use super::edge_samples::{EdgeSample, PartView};
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::topology::FaceId;
use premio_predict::sphere::{Lattice, SphereSampling, points};
use premio_visibility::camera::ViewCamera;
use premio_visibility::camera::projection::Projection;
use premio_visibility::contour_generator::junctions::Junctions;
use premio_visibility::contour_generator::limb_arcs::{LimbArc, limb_arcs};
use premio_visibility::contours::part_size;
use premio_visibility::ray_casting::OriginIncidence;
use premio_visibility::scene::Scene;
use std::sync::OnceLock;

/// The number of directions.
const DIRECTIONS: usize = 320;
/// The distance of the eyes from the part's centre, in its radius.
const DISTANCE: f64 = 6.0;
/// The number of samples of a limb.
const MARKS: usize = 24;

/// The views of a part.
#[derive(Debug)]
pub struct VisibilityCache {
    directions: Vec<Vector3<f64>>,
    /// Views of a subset of the samples, and of all.
    glimpses: Vec<OnceLock<PartView>>,
    views: Vec<OnceLock<PartView>>,
}

impl VisibilityCache {
    pub fn new() -> Self {
        let all = points(Lattice::Fibonacci, SphereSampling::Count(DIRECTIONS), &[]);
        let directions = all.unwrap_or_else(|_| vec![Vector3::z()]);
        Self {
            glimpses: directions.iter().map(|_| OnceLock::new()).collect(),
            views: directions.iter().map(|_| OnceLock::new()).collect(),
            directions,
        }
    }

    /// The view from the direction nearest to that of an eye.
    pub fn from(&self, part: &SoughtPart<'_>, eye: &Point3<f64>) -> &PartView {
        let nearest = self.nearest(part, eye);
        self.views[nearest].get_or_init(|| view(part, &self.directions[nearest], 1))
    }

    /// The same with only every [`SoughtPart::stride`]-th sample: all others count as hidden.
    pub fn glimpse(&self, part: &SoughtPart<'_>, eye: &Point3<f64>) -> &PartView {
        let nearest = self.nearest(part, eye);
        self.glimpses[nearest].get_or_init(|| view(part, &self.directions[nearest], part.stride()))
    }

    fn nearest(&self, part: &SoughtPart<'_>, eye: &Point3<f64>) -> usize {
        let towards = eye - part.centre;
        let mut best = (0, f64::NEG_INFINITY);
        for (i, d) in self.directions.iter().enumerate() {
            let cosine = d.dot(&towards);
            if cosine > best.1 {
                best = (i, cosine);
            }
        }
        best.0
    }
}

/// The view of every `stride`-th sample from a direction; where there is no view, nothing is
/// hidden.
///
/// Visibility is evaluated at samples only. It needs no junctions of contours, which take most of
/// the time of a whole view.
fn view(part: &SoughtPart<'_>, direction: &Vector3<f64>, stride: usize) -> PartView {
    let eye = part.centre + direction * (DISTANCE * part.radius);
    let others = (0..part.marks.len()).map(|i| i % stride != 0);
    let mut view = PartView {
        hidden: others.collect(),
        limbs: Vec::new(),
    };
    let Ok(camera) = ViewCamera::perspective(eye, part.centre, Vector3::z(), 1.0) else {
        return view;
    };
    let projection = Projection::new(&camera, part_size(part.brep));
    let scene = Scene::new(part.brep, &projection, part.resolution);
    if scene.eye_inside() {
        return view;
    }
    let subset = view.hidden.iter_mut().zip(&part.marks).step_by(stride);
    for (hidden, mark) in subset {
        // Occlusion by its own faces is evaluated later, at the actual eye.
        *hidden =
            mark.faces(&eye) && is_hidden(&scene, mark, part.faces(mark), OriginIncidence::Through);
    }
    let mut junctions = Junctions::new(&projection, part.brep.topology.vertices as usize);
    if let Ok(limbs) = limb_arcs(&scene, &mut junctions) {
        for (number, arc) in limbs.arcs.iter().enumerate() {
            let stroke = part.strokes.len() + number;
            let visible = |mark: &EdgeSample| {
                !is_hidden(&scene, mark, [arc.face; 2], OriginIncidence::Tangent)
            };
            let marks = limb(arc, stroke).skip(stride / 2).step_by(stride);
            view.limbs.extend(marks.filter(visible));
        }
    }
    view
}

/// Whether a face occludes a sample on given faces; `leaves` is the incidence of the line of sight
/// on these.
fn is_hidden(
    scene: &Scene<'_>,
    mark: &EdgeSample,
    faces: [FaceId; 2],
    leaves: OriginIncidence,
) -> bool {
    let own = |face| {
        if faces.contains(&face) {
            leaves
        } else {
            OriginIncidence::No
        }
    };
    scene.is_hidden(&mark.point, &own)
}

/// The samples of a limb.
fn limb(arc: &LimbArc, stroke: usize) -> impl Iterator<Item = EdgeSample> {
    let [from, to] = arc.range;
    (0..MARKS).map(move |k| {
        let parameter = from + (to - from) * (k as f64 + 0.5) / MARKS as f64;
        EdgeSample {
            point: arc.curve.point(parameter),
            tangent: arc.curve.tangent(parameter),
            normals: None,
            parameter,
            stroke,
            step: arc.curve.speed(parameter) * (to - from) / MARKS as f64,
        }
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by it")]

    use super::*;
    use crate::part::detectability_prior::DetectabilityPrior;
    use premio_csg::evaluate::{EvaluationOptions, evaluate};
    use premio_csg::reader::{Format, ReadOptions, read};
    use premio_visibility::contours::contours;
    use premio_visibility::contours::{Contour, ContourKind, ContourPiece};

    /// A plate with a hole, a boss and a ball: edges and limbs that hide one another.
    const PART: &str = r#"{"op": "union", "children": [
        {"op": "difference", "children": [
            {"prim": "block", "size": [6, 4, 1]},
            {"prim": "cylinder", "r": 0.7, "h": 4, "transform": [{"translate": [4.5, 2.5, -1]}]}
        ]},
        {"prim": "cylinder", "r": 0.9, "h": 2.5, "transform": [{"translate": [1.5, 1.5, 0.5]}]},
        {"prim": "sphere", "r": 0.8, "transform": [{"translate": [3, 1.2, 1.3]}]}
    ]}"#;

    fn is_visible(contour: &Contour, t: f64) -> bool {
        let within = |piece: &&ContourPiece| {
            let [from, to] = piece.range;
            let t = contour.space_curve.in_cycle(t, from);
            t >= from && t <= to
        };
        contour
            .pieces
            .iter()
            .find(within)
            .is_some_and(|p| p.visible)
    }

    #[test]
    fn marks_are_hidden_where_contours_are() {
        let tree = read(
            "part",
            PART.as_bytes(),
            Format::Json,
            &ReadOptions::default(),
        )
        .unwrap();
        let evaluation = evaluate(&tree.tree, &EvaluationOptions::default()).unwrap();
        let part = SoughtPart::new(
            &evaluation.brep,
            evaluation.resolution,
            &DetectabilityPrior::nothing(),
        );
        let (mut hidden, mut limbs) = (0, 0);
        for direction in part.views.directions.iter().step_by(7) {
            let view = view(&part, direction, 1);
            let eye = part.centre + direction * (DISTANCE * part.radius);
            let camera = ViewCamera::perspective(eye, part.centre, Vector3::z(), 1.0).unwrap();
            let all = contours(part.brep, &camera, part.resolution)
                .unwrap()
                .contours;
            for (mark, &known) in part.marks.iter().zip(&view.hidden) {
                let edge = Some(part.strokes[mark.stroke].edge);
                let contour = all.iter().find(|c| c.edge == edge).unwrap();
                let visible = is_visible(contour, mark.parameter);
                assert_eq!(
                    visible,
                    mark.faces(&eye) && !known,
                    "{direction:?} {mark:?}"
                );
                hidden += usize::from(known);
            }
            // The visible share of every limb's length agrees, within a sample at each end of a
            // piece.
            for contour in all.iter().filter(|c| c.kind == ContourKind::Limb) {
                let length = |p: &ContourPiece| p.range[1] - p.range[0];
                let shown = contour.pieces.iter().filter(|p| p.visible).map(length);
                let share = shown.sum::<f64>() / contour.pieces.iter().map(length).sum::<f64>();
                let own = |m: &&EdgeSample| {
                    let curve = &contour.space_curve;
                    let t = curve.in_cycle(curve.parameter(&m.point), contour.pieces[0].range[0]);
                    let within = contour
                        .pieces
                        .iter()
                        .any(|p| t >= p.range[0] && t <= p.range[1]);
                    within && (curve.point(t) - m.point).norm() < part.resolution.sqrt()
                };
                let marks = view.limbs.iter().filter(own).count() as f64 / MARKS as f64;
                let allowed = 2.0 * contour.pieces.len() as f64 / MARKS as f64;
                assert!(
                    (marks - share).abs() <= allowed,
                    "{direction:?} {marks} {share}"
                );
                limbs += 1;
            }
        }
        assert!(hidden > 100 && limbs > 100, "{hidden} {limbs}");
    }
}
