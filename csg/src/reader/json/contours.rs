//! Contours of figures in `.json`.

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::value::{Document, Member, ValueId};
use super::{Fields, items, number};
use crate::figure::{ContourCorner, Figure, FigureArc};

/// A figure given by its contours.
pub(super) fn contours(fields: &Fields<'_>, member: &Member) -> Result<Figure, SpannedError> {
    let contours = fields.array(member, "an array of contours, or a figure as an object")?;
    let contours = contours.iter();
    let contour = |id: &ValueId| {
        let corners = items(fields.document, *id, "a contour: an array of corners")?;
        corners
            .iter()
            .map(|id| corner(fields.document, *id))
            .collect()
    };
    let contours: Vec<Vec<ContourCorner>> = contours.map(contour).collect::<Result<_, _>>()?;
    Figure::from_contours(&contours).map_err(|error| {
        let span = fields.document.value(member.value).span.clone();
        SpannedError::input(span, error.to_string(), "a figure of segments and arcs")
    })
}

fn corner(document: &Document, id: ValueId) -> Result<ContourCorner, SpannedError> {
    const EXPECTED: &str = "a corner: [x,y], or [x,y,cx,cy,r] before an arc";
    let values = items(document, id, EXPECTED)?.iter();
    let values: Vec<Rational> = values
        .map(|&id| Ok(number(document, id)?.value))
        .collect::<Result<_, SpannedError>>()?;
    match <[Rational; 5]>::try_from(values) {
        Ok([x, y, cx, cy, r]) => Ok(ContourCorner {
            point: [x, y],
            arc: Some(FigureArc::from_signed_radius([cx, cy], r)),
        }),
        Err(values) => match <[Rational; 2]>::try_from(values) {
            Ok(point) => Ok(ContourCorner { point, arc: None }),
            Err(values) => {
                let found = format!("an array of {}", values.len());
                let span = document.value(id).span.clone();
                Err(SpannedError::input(span, found, EXPECTED))
            }
        },
    }
}
