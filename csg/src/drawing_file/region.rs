//! The region of a drawing.

use super::{Drawing, DrawingShape};
use crate::figure::{Figure, FigureError, FigureExpression, FigureOperation};

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
    match &figures[..] {
        [] => Err(FigureError::Empty),
        [_] => Ok(figures.swap_remove(0)),
        _ => {
            let figures: Vec<&Figure> = figures.iter().collect();
            Figure::combined(FigureOperation::Union, &figures)
        }
    }
}

/// The points inside an odd number of contours.
fn shape_figure(shape: &DrawingShape) -> Result<Figure, FigureError> {
    match Figure::from_contours(shape) {
        Err(FigureError::ArcCrosses { .. }) if shape.len() > 1 => {}
        result => return result,
    }
    let mut figures = Vec::new();
    for contour in shape {
        figures.extend(non_empty(Figure::from_contours(std::slice::from_ref(
            contour,
        )))?);
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
