//! The region of a drawing.

use super::{Drawing, DrawingShape};
use crate::figure::{ContourCorner, Figure, FigureEdge, FigureError, FigureExpression, MAX_EDGES};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

/// The region of a drawing: the union of its shapes.
///
/// # Errors
/// There are too many edges, an arc crosses another edge of its own contour, edges run so close to
/// each other that it is unclear which of them are one, or the region is empty.
pub(crate) fn figure(drawing: &Drawing) -> Result<Figure, FigureError> {
    let mut figures = Vec::new();
    for shape in &drawing.shapes {
        figures.extend(non_empty(shape_figure(shape))?);
    }
    let mut all = Figure {
        edges: Vec::new(),
        contours: Vec::new(),
    };
    for group in overlapping(figures) {
        let united = Figure::united(group)?;
        let first = all.edges.len();
        all.contours
            .extend(united.contours.iter().map(|i| first + i));
        all.edges.extend(united.edges);
    }
    match all.edges.len() {
        0 => Err(FigureError::Empty),
        count if count > MAX_EDGES => Err(FigureError::TooManyEdges { count }),
        _ => Ok(all),
    }
}

/// The points inside an odd number of contours.
fn shape_figure(shape: &[Vec<ContourCorner>]) -> Result<Figure, FigureError> {
    let is_round = |contour: &&Vec<ContourCorner>| contour.iter().any(|c| c.arc.is_some());
    let (round, straight): (Vec<_>, Vec<_>) = shape.iter().partition(is_round);
    if round.is_empty() || !may_touch(shape) {
        return Figure::from_contours(shape);
    }
    // Contours with arcs that touch or cross others are operands of a set operation.
    let owned = |contours: Vec<&Vec<ContourCorner>>| -> DrawingShape {
        contours.into_iter().cloned().collect()
    };
    let (round, straight) = (owned(round), owned(straight));
    let mut operands = vec![straight];
    match may_touch(&round) {
        true => operands.extend(round.into_iter().map(|contour| vec![contour])),
        false => operands.push(round),
    }
    let mut figures = Vec::new();
    for operand in &operands {
        figures.extend(non_empty(Figure::from_contours(operand))?);
    }
    let leaves = (0..figures.len()).map(FigureExpression::Leaf).collect();
    let figures: Vec<&Figure> = figures.iter().collect();
    Figure::evaluated(&figures, &FigureExpression::Parity(leaves))
}

fn non_empty(result: Result<Figure, FigureError>) -> Result<Option<Figure>, FigureError> {
    match result {
        Ok(figure) => Ok(Some(figure)),
        Err(FigureError::Empty) => Ok(None),
        Err(error) => Err(error),
    }
}

/// A bounding box with the number of its owner.
type OwnedBox = GeomWithData<Rectangle<[f64; 2]>, usize>;

fn owned_box([lo, hi]: [[f64; 2]; 2], owner: usize) -> OwnedBox {
    GeomWithData::new(Rectangle::from_corners(lo, hi), owner)
}

/// Whether the bounding boxes of edges of different contours overlap.
fn may_touch(shape: &[Vec<ContourCorner>]) -> bool {
    let mut boxes = Vec::new();
    for (owner, contour) in shape.iter().enumerate() {
        let next = contour.iter().cycle().skip(1);
        for (corner, next) in contour.iter().zip(next) {
            let edge = FigureEdge {
                start: corner.point.clone(),
                end: next.point.clone(),
                arc: corner.arc.clone(),
            };
            boxes.push(owned_box(edge.bounds(), owner));
        }
    }
    let index = RTree::bulk_load(boxes.clone());
    boxes.iter().any(|own| {
        let area = AABB::from_corners(own.geom().lower(), own.geom().upper());
        let mut others = index.locate_in_envelope_intersecting(area);
        others.any(|other| other.data != own.data)
    })
}

/// Figures in groups such that the bounding boxes of different groups do not overlap.
fn overlapping(figures: Vec<Figure>) -> Vec<Vec<Figure>> {
    let bounds = figures.iter().map(Figure::bounds).enumerate();
    let boxes: Vec<OwnedBox> = bounds.map(|(i, b)| owned_box(b, i)).collect();
    let mut index = RTree::bulk_load(boxes.clone());
    let mut figures: Vec<Option<Figure>> = figures.into_iter().map(Some).collect();
    let mut groups = Vec::new();
    for first in boxes {
        let mut group = Vec::new();
        let mut waiting = vec![first];
        while let Some(own) = waiting.pop() {
            group.extend(figures[own.data].take());
            let area = AABB::from_corners(own.geom().lower(), own.geom().upper());
            waiting.extend(index.drain_in_envelope_intersecting(area));
        }
        if !group.is_empty() {
            groups.push(group);
        }
    }
    groups
}
