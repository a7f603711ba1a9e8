//! The solids that extrusions make of plane figures.
//!
//! Extruding commutes with set operations, so each figure becomes a solid by itself. A straight
//! extrusion commutes with motions in the plane, too; other extrusions take the figure in its final
//! place.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::bad_length;
use super::extrusion::Raise;
use super::figures::{bad_figure, mapped};
use super::measures::{MovedPrimitive, Shape};
use crate::figure::{Figure, PlaneMap};
use crate::primitive::{Primitive, PrimitiveError, RevolutionAngle};
use crate::transform::Transform;

/// What an extrusion does with the figures inside it.
#[derive(Debug, Clone)]
pub(super) enum Sweep {
    /// `linear_extrude`.
    Raised(Raise),
    /// `rotate_extrude`, with the first axis of the plane as the radius.
    Revolved(Option<RevolutionAngle>),
}

/// An extrusion, and the map of the plane between it and a node inside it.
#[derive(Debug, Clone)]
pub(super) struct Extrusion {
    pub sweep: Sweep,
    pub map: PlaneMap,
    /// Whether a difference or an intersection is between them.
    pub is_combined: bool,
}

impl Extrusion {
    pub(super) fn new(sweep: Sweep) -> Self {
        Self {
            sweep,
            map: PlaneMap::identity(),
            is_combined: false,
        }
    }

    /// Whether the extrusion commutes with motions of the plane.
    pub(super) fn is_straight(&self) -> bool {
        match &self.sweep {
            Sweep::Raised(raise) => raise.top.is_one() && self.map.is_identity(),
            Sweep::Revolved(_) => false,
        }
    }

    /// The solid of a figure.
    pub(super) fn solid(
        &self,
        figure: &Figure,
        span: &Range<usize>,
    ) -> Result<Shape, SpannedError> {
        let figure = mapped(figure, &self.map, span)?;
        let Some(figure) = figure else {
            return Ok(None);
        };
        let wrong = |error: PrimitiveError| bad_length(error, None, span.clone());
        match &self.sweep {
            Sweep::Raised(raise) if raise.height.is_zero() => Ok(None),
            Sweep::Raised(raise) => {
                let (height, top) = (raise.height.clone(), raise.top.clone());
                let prism = Primitive::scaled_prism(figure, height, top).map_err(wrong)?;
                let moves = raise.at(Rational::ZERO, Rational::ZERO);
                Ok(Some(MovedPrimitive::new(prism, moves)))
            }
            Sweep::Revolved(angle) => {
                if figure.crosses_axis() && !self.is_combined {
                    return Err(wrong(PrimitiveError::AcrossAxis));
                }
                // OpenSCAD revolves a figure on the other side of the axis, too. Of an operand only
                // the part on this side matters.
                let is_beyond = figure.is_left_of_axis() && !self.is_combined;
                let (figure, moves) = match is_beyond {
                    true => (figure.mirrored_x(), half_turn()),
                    false => (figure, Transform::new()),
                };
                let Some(figure) = figure.right_of_axis().map_err(|e| bad_figure(&e, span))? else {
                    return Ok(None);
                };
                let part = Primitive::revolution(figure, angle.clone()).map_err(wrong)?;
                Ok(Some(MovedPrimitive::new(part, moves)))
            }
        }
    }
}

/// Half a turn about z.
fn half_turn() -> Transform {
    let turn = [[-1, 0, 0], [0, -1, 0], [0, 0, 1]].map(|row| row.map(Rational::from));
    Transform::quarter_turns(&turn).unwrap_or_default()
}
