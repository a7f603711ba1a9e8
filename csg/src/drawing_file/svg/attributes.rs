//! Numbers and styles in the attributes of elements.

use super::super::error::DrawingFileError;
use super::line;
use crate::figure::{OffsetJoin, Stroke, StrokeCap};
use premio_kernel::number::rational::{Rational, from_decimal};
use roxmltree::Node;

/// The number in an attribute. Like in OpenSCAD it is zero if the attribute is absent or has a unit.
pub(super) fn number(node: &Node<'_, '_>, name: &str) -> Rational {
    let text = node.attribute(name).unwrap_or_default();
    from_decimal(text).unwrap_or(Rational::ZERO)
}

/// The shortest decimal number that rounds to an f64: it is the number in the file.
pub(super) fn decimal(value: f64) -> Result<Rational, DrawingFileError> {
    from_decimal(&value.to_string()).map_err(|_| DrawingFileError::Coordinate)
}

/// The error that an attribute is malformed.
pub(super) fn malformed(
    node: &Node<'_, '_>,
    attribute: &'static str,
    error: &svgtypes::Error,
) -> DrawingFileError {
    DrawingFileError::Attribute {
        line: line(node),
        attribute,
        message: error.to_string(),
    }
}

/// A property of the style: that of the attribute, or that in the attribute `style`. Like in
/// OpenSCAD it is not inherited, and spaces around it matter.
fn property<'d>(node: &Node<'d, '_>, name: &str) -> &'d str {
    if let Some(value) = node.attribute(name).filter(|value| !value.is_empty()) {
        return value;
    }
    let style = node.attribute("style").unwrap_or_default();
    let pairs = style.split(';').filter_map(|item| item.split_once(':'));
    let mut values = pairs.filter(|(property, _)| *property == name);
    values.next().map_or("", |(_, value)| value)
}

/// How an open path is stroked.
pub(super) fn stroke(node: &Node<'_, '_>) -> Stroke {
    let hundredth = Rational::ONE / Rational::from(100);
    let width = from_decimal(property(node, "stroke-width")).unwrap_or(Rational::ZERO);
    // OpenSCAD draws thinner lines with the width 1.
    let width = match width < hundredth {
        true => Rational::ONE,
        false => width,
    };
    Stroke {
        half_width: width / Rational::from(2),
        cap: match property(node, "stroke-linecap") {
            "butt" => StrokeCap::Butt,
            "round" => StrokeCap::Round,
            _ => StrokeCap::Square,
        },
        join: match property(node, "stroke-linejoin") {
            "bevel" => OffsetJoin::Chamfer,
            "round" => OffsetJoin::Round,
            _ => OffsetJoin::Miter,
        },
    }
}
