//! Figures in `.json`, and the solids that they sweep.

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::bad_length;
use super::super::refusal::construction_error;
use super::super::region::Region;
use super::super::sweep::{Extrusion, Revolution};
use super::contours::contours;
use super::region::region;
use super::value::Content;
use super::{Fields, number};
use crate::builder::{Builder, SolidId};
use crate::construction::scaled_prism;
use crate::figure::Figure;
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
            Primitive::check_prism(&height.value, &top).map_err(wrong)?;
            let made = scaled_prism(builder, &figure, &height.value, &top);
            made.map_err(|error| construction_error(&error, &fields.span))
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
