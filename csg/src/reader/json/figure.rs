//! Figures in `.json`, and the solids that they sweep.

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::bad_length;
use super::value::{Document, ValueId};
use super::{Fields, items, number};
use crate::figure::{ContourCorner, Figure, FigureArc};
use crate::primitive::{Primitive, RevolutionAngle};

/// A prism: `figure`, `h`, and `top` if it is scaled.
pub(super) fn prism(fields: &Fields<'_>) -> Result<Primitive, SpannedError> {
    let figure = figure(fields)?;
    let height = number(fields.document, fields.require("h")?.value)?;
    let top = match fields.find("top") {
        Some(member) => number(fields.document, member.value)?.value,
        None => Rational::ONE,
    };
    let made = Primitive::scaled_prism(figure, height.value.clone(), top);
    made.map_err(|error| bad_length(error, Some(&height.value), height.span))
}

/// A revolution: `figure`, and `angle` if it is no whole turn.
pub(super) fn revolution(fields: &Fields<'_>) -> Result<Primitive, SpannedError> {
    let of = figure(fields)?;
    let angle = match fields.find("angle") {
        Some(member) => {
            let degrees = number(fields.document, member.value)?;
            let angle = RevolutionAngle::new(degrees.value);
            Some(angle.ok_or_else(|| {
                let found = "an angle out of range";
                SpannedError::input(degrees.span, found, "an angle between 0 and 360")
            })?)
        }
        None => None,
    };
    let span = fields
        .document
        .value(fields.require("figure")?.value)
        .span
        .clone();
    Primitive::revolution(of, angle).map_err(|error| bad_length(error, None, span))
}

/// The contours of a figure.
fn figure(fields: &Fields<'_>) -> Result<Figure, SpannedError> {
    let member = fields.require("figure")?;
    let contours = fields.array(member, "an array of contours")?.iter();
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
