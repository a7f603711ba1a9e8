//! The attribute `transform`.

use super::super::error::DrawingFileError;
use super::attributes::{decimal, malformed};
use crate::figure::{PlaneMap, direction};
use premio_kernel::number::rational::{Rational, from_f64};
use roxmltree::Node;
use svgtypes::{TransformListParser, TransformListToken};

/// The map of an element's contents into those of its parent.
pub(super) fn read(node: &Node<'_, '_>) -> Result<PlaneMap, DrawingFileError> {
    let text = node.attribute("transform").unwrap_or_default();
    let mut map = PlaneMap::identity();
    for token in TransformListParser::from(text) {
        let token = token.map_err(|error| malformed(node, "transform", &error))?;
        map = plane_map(token)?.then(&map);
        super::check_map(&map)?;
    }
    Ok(map)
}

fn plane_map(token: TransformListToken) -> Result<PlaneMap, DrawingFileError> {
    let (zero, one) = (|| Rational::ZERO, || Rational::ONE);
    let linear = |matrix| PlaneMap {
        matrix,
        offset: [zero(), zero()],
    };
    Ok(match token {
        TransformListToken::Matrix { a, b, c, d, e, f } => PlaneMap {
            matrix: [[decimal(a)?, decimal(c)?], [decimal(b)?, decimal(d)?]],
            offset: [decimal(e)?, decimal(f)?],
        },
        TransformListToken::Translate { tx, ty } => PlaneMap {
            offset: [decimal(tx)?, decimal(ty)?],
            ..PlaneMap::identity()
        },
        TransformListToken::Scale { sx, sy } => {
            linear([[decimal(sx)?, zero()], [zero(), decimal(sy)?]])
        }
        TransformListToken::Rotate { angle } => {
            let [cos, sin] = direction(&decimal(angle)?);
            linear([[cos.clone(), -&sin], [sin, cos]])
        }
        TransformListToken::SkewX { angle } => linear([[one(), tangent(angle)?], [zero(), one()]]),
        TransformListToken::SkewY { angle } => linear([[one(), zero()], [tangent(angle)?, one()]]),
    })
}

/// The tangent of an angle in degrees: exact for half a right angle, else rounded to f64.
fn tangent(degrees: f64) -> Result<Rational, DrawingFileError> {
    let angle = decimal(degrees)?;
    match angle == Rational::from(45) || angle == Rational::from(-45) {
        true => Ok(angle / Rational::from(45)),
        false => from_f64(degrees.to_radians().tan()).ok_or(DrawingFileError::Coordinate),
    }
}
