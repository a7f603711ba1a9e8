//! Figures in `.json`, and the solids that they sweep.

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::bad_length;
use super::super::region::Region;
use super::super::sweep::{Extrusion, Revolution};
use super::region::region;
use super::value::{Content, Document, Member, ValueId};
use super::{Fields, items, number};
use crate::builder::{Builder, SolidId};
use crate::figure::{ContourCorner, Figure, FigureArc};
use crate::primitive::{Primitive, RevolutionAngle};

/// A figure of a solid: its contours, or an expression.
enum SweptFigure {
    Contours(Figure),
    /// Empty if none.
    Expression(Option<Region>),
}

/// A prism: `figure`, `h`, and `top` if it is scaled.
pub(super) fn prism(builder: &mut Builder, fields: &Fields<'_>) -> Result<SolidId, SpannedError> {
    let figure = swept(fields)?;
    let height = number(fields.document, fields.require("h")?.value)?;
    let top = match fields.find("top") {
        Some(member) => number(fields.document, member.value)?.value,
        None => Rational::ONE,
    };
    let wrong = |error| bad_length(error, Some(&height.value), height.span.clone());
    match figure {
        SweptFigure::Contours(figure) => {
            let made = Primitive::scaled_prism(figure, height.value.clone(), top);
            Ok(builder.primitive(made.map_err(wrong)?))
        }
        SweptFigure::Expression(region) => {
            Primitive::check_prism(&height.value, &top).map_err(wrong)?;
            let extrusion = Extrusion {
                height: &height.value,
                top: &top,
            };
            let solid = region.map(|region| extrusion.solid(builder, &region, &fields.span));
            solid.unwrap_or(Ok(SolidId::EMPTY))
        }
    }
}

/// A revolution: `figure`, and `angle` if it is no whole turn.
pub(super) fn revolution(
    builder: &mut Builder,
    fields: &Fields<'_>,
) -> Result<SolidId, SpannedError> {
    let figure = swept(fields)?;
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
    match figure {
        SweptFigure::Contours(figure) => {
            let made = Primitive::revolution(figure, angle);
            Ok(builder.primitive(made.map_err(|error| bad_length(error, None, span))?))
        }
        SweptFigure::Expression(region) => {
            let angle = angle.as_ref();
            let solid = region.map(|region| Revolution { angle }.solid(builder, &region, &span));
            solid.unwrap_or(Ok(SolidId::EMPTY))
        }
    }
}

/// The figure of a prism or a revolution.
fn swept(fields: &Fields<'_>) -> Result<SweptFigure, SpannedError> {
    let member = fields.require("figure")?;
    match fields.document.value(member.value).content {
        Content::Object(_) => {
            let region = region(fields.document, member.value)?;
            Ok(SweptFigure::Expression(region))
        }
        _ => contours(fields, member).map(SweptFigure::Contours),
    }
}

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
