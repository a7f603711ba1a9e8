//! `linear_extrude` and `rotate_extrude`.

use std::sync::Arc;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::region::Region;
use super::super::sweep::{Extrusion, Revolution};
use super::arguments::{Arguments, Value};
use super::facets::FacetRule;
use super::measures::{half, length};
use super::twist::{Twist, revolved_polygon, twisted};
use crate::builder::{Builder, SolidId};
use crate::primitive::{Primitive, RevolutionAngle};
use crate::transform::Transform;

/// A straight or twisted extrusion.
pub(super) struct Raise {
    height: Rational,
    bottom: Rational,
    /// The factors along both axes at the top.
    top: [Rational; 2],
    twist: Option<Twist>,
}

impl Raise {
    /// Reads the arguments of `linear_extrude`. A height of zero makes every figure empty.
    pub fn new(arguments: &mut Arguments) -> Result<Self, SpannedError> {
        arguments.bind(&[
            "height", "center", "scale", "twist", "v", "h", "slices", "segments",
        ])?;
        let height = match arguments.find("h") {
            Some(height) => length(height)?,
            None => length(arguments.require("height")?)?,
        };
        let top = scale(arguments)?;
        check_upright(arguments)?;
        let bottom = if arguments.flag("center")? {
            -half(&height)
        } else {
            Rational::ZERO
        };
        let twist = Twist::new(arguments, &top)?;
        Ok(Self {
            height,
            bottom,
            top,
            twist,
        })
    }

    /// The solid of a region.
    pub fn solid(
        &self,
        builder: &mut Builder,
        region: &Region,
        arguments: &Arguments,
        rule: &FacetRule,
    ) -> Result<SolidId, SpannedError> {
        if self.height.is_zero() {
            return Ok(SolidId::EMPTY);
        }
        let part = match &self.twist {
            Some(twist) => {
                let Some(figure) = region.evaluated(&arguments.span)? else {
                    return Ok(SolidId::EMPTY);
                };
                let made = twisted(
                    &figure,
                    &self.height,
                    &self.top,
                    twist,
                    rule.is_literal(),
                    arguments,
                )?;
                let polyhedron = Arc::new(made);
                builder.primitive(Primitive::Polyhedron { polyhedron })
            }
            None => {
                let [top, _] = &self.top;
                let height = &self.height;
                Extrusion { height, top }.solid(builder, region, &arguments.span)?
            }
        };
        let lift = Transform::shift([Rational::ZERO, Rational::ZERO, self.bottom.clone()]);
        Ok(builder.moved(part, lift))
    }
}

/// The factors along both axes at the top.
fn scale(arguments: &Arguments) -> Result<[Rational; 2], SpannedError> {
    let Some(scale) = arguments.find("scale") else {
        return Ok([Rational::ONE, Rational::ONE]);
    };
    let factors = match &scale.value {
        Value::List(_) => {
            let [x, y] = scale.list("a number or a list of two")?;
            [x.number()?.clone(), y.number()?.clone()]
        }
        _ => [scale.number()?.clone(), scale.number()?.clone()],
    };
    match factors.iter().any(|factor| *factor < Rational::ZERO) {
        true => Err(scale.wrong("a `scale` of zero or more")),
        false => Ok(factors),
    }
}

/// Refuses a direction that would make the sides oblique.
fn check_upright(arguments: &Arguments) -> Result<(), SpannedError> {
    let Some(direction) = arguments.find("v") else {
        return Ok(());
    };
    let [x, y, z] = direction.list("a list of three")?;
    match x.number()?.is_zero() && y.number()?.is_zero() && *z.number()? > Rational::ZERO {
        true => Ok(()),
        false => Err(direction.wrong("a direction along z: only upright extrusions are read")),
    }
}

/// A revolution about z.
pub(super) struct Spin {
    /// The angle; `None` for a whole turn.
    angle: Option<RevolutionAngle>,
    /// The turn to the start of the revolution.
    start: Transform,
    /// Whether the start is written.
    is_started: bool,
}

impl Spin {
    /// Reads the arguments of `rotate_extrude`.
    pub fn new(arguments: &mut Arguments) -> Result<Self, SpannedError> {
        arguments.bind(&["angle", "start"])?;
        let turn = Rational::from(360);
        let degrees = match arguments.find("angle") {
            Some(angle) => angle.number()?.clone(),
            None => turn.clone(),
        };
        let is_whole = degrees >= turn || degrees <= -&turn;
        let mut start = match arguments.find("start") {
            Some(start) => start.number()?.clone(),
            None => Rational::ZERO,
        };
        if degrees < Rational::ZERO && !is_whole {
            start += &degrees;
        }
        let size = if degrees < Rational::ZERO {
            -&degrees
        } else {
            degrees
        };
        let angle = match is_whole {
            true => None,
            false => {
                let made = RevolutionAngle::new(size);
                let argument = arguments.require("angle")?;
                Some(made.ok_or_else(|| argument.wrong("an angle other than 0"))?)
            }
        };
        let mut moves = Transform::new();
        if !start.is_zero() {
            let step = crate::transform::TransformStep::about(2, start);
            let argument = arguments.find("start").or(arguments.find("angle"));
            moves.push(step).map_err(|_| match argument {
                Some(argument) => argument.wrong("an angle in range"),
                None => SpannedError::input(arguments.span.clone(), "a wrong angle", "an angle"),
            })?;
        }
        Ok(Self {
            angle,
            start: moves,
            is_started: arguments.find("start").is_some(),
        })
    }

    /// The solid of a region.
    pub fn solid(
        &self,
        builder: &mut Builder,
        region: &Region,
        arguments: &Arguments,
        rule: &mut FacetRule,
    ) -> Result<SolidId, SpannedError> {
        let span = &arguments.span;
        // OpenSCAD counts segments by the reach of the figure from the axis.
        let reach = match rule.is_literal() {
            true => region
                .evaluated(span)?
                .map_or(Rational::ONE, |figure| figure.reach()),
            false => Rational::ONE,
        };
        let part = match rule.sides(arguments, &reach)? {
            Some(sides) => {
                let Some(figure) = region.evaluated(span)? else {
                    return Ok(SolidId::EMPTY);
                };
                let degrees = self.angle.as_ref().map(RevolutionAngle::degrees);
                let made = revolved_polygon(&figure, sides, degrees, self.is_started, span)?;
                let polyhedron = Arc::new(made);
                builder.primitive(Primitive::Polyhedron { polyhedron })
            }
            None => {
                let angle = self.angle.as_ref();
                Revolution { angle }.solid(builder, region, span)?
            }
        };
        Ok(builder.moved(part, self.start.clone()))
    }
}
