//! What a part hides of itself, by the direction it is seen from: asked when it is needed, and kept.

use super::Part;
use super::marks::{Mark, View};
use nalgebra::{Point3, Vector3};
use premio_predict::sphere::{Lattice, Sampling, points};
use premio_visibility::camera::Camera;
use premio_visibility::contour::{Contour, Kind, Piece};
use premio_visibility::view::contours;
use std::sync::OnceLock;

/// How many directions there are.
const DIRECTIONS: usize = 320;
/// How far the eyes are from the middle of the part, in its radius.
const DISTANCE: f64 = 6.0;
/// How many marks a piece of a limb has.
const MARKS: usize = 24;

/// The views of a part.
#[derive(Debug)]
pub struct Views {
    directions: Vec<Vector3<f64>>,
    views: Vec<OnceLock<View>>,
}

impl Views {
    pub fn new() -> Self {
        let all = points(Lattice::Fibonacci, Sampling::Count(DIRECTIONS), &[]);
        let directions = all.unwrap_or_else(|_| vec![Vector3::z()]);
        Self {
            views: directions.iter().map(|_| OnceLock::new()).collect(),
            directions,
        }
    }

    /// The view from the direction nearest to that of an eye.
    pub fn from(&self, part: &Part<'_>, eye: &Point3<f64>) -> &View {
        let towards = eye - part.centre;
        let mut best = (0, f64::NEG_INFINITY);
        for (i, d) in self.directions.iter().enumerate() {
            let cosine = d.dot(&towards);
            if cosine > best.1 {
                best = (i, cosine);
            }
        }
        self.views[best.0].get_or_init(|| view(part, &self.directions[best.0]))
    }
}

/// The view from a direction; where there is none, nothing is hidden.
fn view(part: &Part<'_>, direction: &Vector3<f64>) -> View {
    let eye = part.centre + direction * (DISTANCE * part.radius);
    let nothing = || View {
        hidden: vec![false; part.marks.len()],
        limbs: Vec::new(),
    };
    let Ok(camera) = Camera::perspective(eye, part.centre, Vector3::z(), 1.0) else {
        return nothing();
    };
    match contours(part.brep, &camera, part.band) {
        Ok(contours) => of(part, &contours.contours, &eye),
        Err(_) => nothing(),
    }
}

/// What contours that an eye sees tell of the marks of a part.
pub fn of(part: &Part<'_>, contours: &[Contour], eye: &Point3<f64>) -> View {
    let mut view = View {
        hidden: vec![false; part.marks.len()],
        limbs: Vec::new(),
    };
    let mut by_edge = vec![None; part.brep.topology.edges.len()];
    for contour in contours {
        match (contour.kind, contour.edge) {
            (Kind::Boundary, Some(edge)) => by_edge[edge.0 as usize] = Some(contour),
            (Kind::Limb, _) => limb(part, contour, &mut view.limbs),
            _ => {}
        }
    }
    for stroke in &part.strokes {
        let Some(contour) = by_edge[stroke.edge.0 as usize] else {
            continue;
        };
        for i in stroke.marks.clone() {
            let mark = &part.marks[i];
            // What the own faces hide is asked where the eye really is.
            view.hidden[i] = mark.faces(eye) && !is_visible(contour, mark.parameter);
        }
    }
    view
}

fn is_visible(contour: &Contour, t: f64) -> bool {
    contour.pieces.iter().any(|piece| {
        let [from, to] = piece.t;
        let t = contour.curve3.in_cycle(t, from);
        piece.visible && t >= from && t <= to
    })
}

/// The marks of the visible pieces of a limb.
fn limb(part: &Part<'_>, contour: &Contour, marks: &mut Vec<Mark>) {
    let stroke = part.strokes.len() + contour.id as usize;
    for Piece { t: [from, to], .. } in contour.pieces.iter().filter(|p| p.visible) {
        for k in 0..MARKS {
            let parameter = from + (to - from) * (k as f64 + 0.5) / MARKS as f64;
            let point = contour.curve3.point(parameter);
            marks.push(Mark {
                point,
                tangent: contour.curve3.tangent(parameter),
                normals: None,
                parameter,
                stroke,
                step: contour.curve3.speed(parameter) * (to - from) / MARKS as f64,
            });
        }
    }
}
