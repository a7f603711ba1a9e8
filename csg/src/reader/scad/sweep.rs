//! `linear_extrude` and `rotate_extrude`.

use std::ops::Range;
use std::sync::Arc;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::bad_length;
use super::arguments::{Arguments, Value};
use super::facets::FacetRule;
use super::figures::bad_figure;
use super::measures::{half, length};
use super::region::{Region, RegionFigure};
use super::twist::{Twist, revolved_polygon, twisted};
use crate::builder::{Builder, SolidId};
use crate::figure::{Figure, FigureOperation, FigurePoint};
use crate::primitive::{Primitive, PrimitiveError, RevolutionAngle};
use crate::transform::Transform;
use crate::tree::Operation;

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
            None => as_parts_or_whole(region, &arguments.span, |r| self.straight(builder, r))?,
        };
        let lift = Transform::shift([Rational::ZERO, Rational::ZERO, self.bottom.clone()]);
        Ok(builder.moved(part, lift))
    }

    fn straight(&self, builder: &mut Builder, region: &Region) -> Result<SolidId, SpannedError> {
        match region {
            Region::Figure(figure) => self.of_figure(builder, figure),
            Region::Combined { op, operands, .. } => {
                let parts: Vec<SolidId> = operands
                    .iter()
                    .map(|operand| self.straight(builder, operand))
                    .collect::<Result<_, _>>()?;
                Ok(builder.operation(operation(*op), &parts))
            }
        }
    }

    fn of_figure(
        &self,
        builder: &mut Builder,
        figure: &RegionFigure,
    ) -> Result<SolidId, SpannedError> {
        let span = &figure.span;
        let wrong = |error: PrimitiveError| bad_length(error, None, span.clone());
        let [factor, _] = &self.top;
        if let Some(moves) = &figure.moves
            && factor.is_one()
        {
            let part = extruded(&figure.base, &self.height).map_err(wrong)?;
            let solid = builder.primitive(part.primitive);
            let solid = builder.moved(solid, part.moves);
            return Ok(builder.moved(solid, moves.clone()));
        }
        let placed = figure.figure()?;
        if factor.is_one() {
            let part = extruded(&placed, &self.height).map_err(wrong)?;
            let solid = builder.primitive(part.primitive);
            return Ok(builder.moved(solid, part.moves));
        }
        let scaled = match placed.centred_disc() {
            Some(radius) => {
                Primitive::frustum(radius.clone(), radius * factor, self.height.clone())
            }
            None => Primitive::scaled_prism(placed, self.height.clone(), factor.clone()),
        };
        Ok(builder.primitive(scaled.map_err(wrong)?))
    }
}

/// The solid of a region: from the figures that it combines, and if one of them has no exact solid,
/// from their result in the plane.
fn as_parts_or_whole(
    region: &Region,
    span: &Range<usize>,
    mut solid: impl FnMut(&Region) -> Result<SolidId, SpannedError>,
) -> Result<SolidId, SpannedError> {
    let refused = match solid(region) {
        Err(refused) if matches!(region, Region::Combined { .. }) => refused,
        made => return made,
    };
    match region.evaluated(span) {
        Ok(Some(whole)) => solid(&Region::new(whole, region.span())).map_err(|_| refused),
        Ok(None) => Ok(SolidId::EMPTY),
        Err(_) => Err(refused),
    }
}

/// A primitive and its place.
struct Extruded {
    primitive: Primitive,
    moves: Transform,
}

/// The extruded figure: a block, a wedge, a cylinder or a prism.
fn extruded(figure: &Figure, height: &Rational) -> Result<Extruded, PrimitiveError> {
    if let Some(disc) = figure.as_disc() {
        let [x, y] = disc.centre;
        return Ok(Extruded {
            primitive: Primitive::cylinder(disc.radius, height.clone())?,
            moves: Transform::shift([x, y, Rational::ZERO]),
        });
    }
    if let Some([[x, y], end]) = rectangle(figure) {
        let size = [&end[0] - &x, &end[1] - &y, height.clone()];
        return Ok(Extruded {
            primitive: Primitive::block(size)?,
            moves: Transform::shift([x, y, Rational::ZERO]),
        });
    }
    if let Some(wedge) = wedge(figure, height)? {
        return Ok(wedge);
    }
    Ok(Extruded {
        primitive: Primitive::prism(figure.clone(), height.clone())?,
        moves: Transform::new(),
    })
}

/// The least and the greatest corner of a figure that is a rectangle along the axes.
fn rectangle(figure: &Figure) -> Option<[FigurePoint; 2]> {
    if figure.edges().len() != 4 || !figure.is_polygon() {
        return None;
    }
    let corners = || figure.edges().iter().map(|edge| &edge.start);
    let least: FigurePoint =
        [0, 1].map(|i| corners().map(|p| &p[i]).min().cloned().unwrap_or_default());
    let most: FigurePoint =
        [0, 1].map(|i| corners().map(|p| &p[i]).max().cloned().unwrap_or_default());
    let is_corner = |p: &FigurePoint| (0..2).all(|i| p[i] == least[i] || p[i] == most[i]);
    let is_along = figure
        .edges()
        .iter()
        .all(|edge| edge.start[0] == edge.end[0] || edge.start[1] == edge.end[1]);
    (corners().all(is_corner) && is_along && figure.contours().count() == 1)
        .then_some([least, most])
}

/// A triangle with a right angle between legs along the axes: a wedge. The primitive's right angle
/// lies between x and z, and its length is along y. With u along one leg, v along the other and w
/// upwards, its x is placed along u, its z along v, and its y along w or -w, whichever gives a
/// right-handed rotation.
fn wedge(figure: &Figure, height: &Rational) -> Result<Option<Extruded>, PrimitiveError> {
    let corners: Vec<&FigurePoint> = figure.edges().iter().map(|edge| &edge.start).collect();
    let [a, b, c] = corners[..] else {
        return Ok(None);
    };
    if !figure.is_polygon() {
        return Ok(None);
    }
    let turns = [
        [a, b, c],
        [b, c, a],
        [c, a, b],
        [a, c, b],
        [b, a, c],
        [c, b, a],
    ];
    // The corner with the right angle, followed by the ends of the legs along x and y.
    let right = turns
        .into_iter()
        .find(|[o, p, q]| o[1] == p[1] && o[0] == q[0]);
    let Some([corner, along_x, along_y]) = right else {
        return Ok(None);
    };
    let (leg_x, leg_y) = (&along_x[0] - &corner[0], &along_y[1] - &corner[1]);
    let sign = |leg: &Rational| if *leg > Rational::ZERO { 1i32 } else { -1 };
    let (u, v) = (sign(&leg_x), sign(&leg_y));
    // Columns (u,0,0), (0,0,w), (0,v,0): the determinant is -u v w.
    let w = -u * v;
    let matrix = [[u, 0, 0], [0, 0, v], [0, w, 0]].map(|row| row.map(Rational::from));
    // Along -w the wedge lies below its plane and is lifted by its length.
    let lift = if w < 0 {
        height.clone()
    } else {
        Rational::ZERO
    };
    let offset = [corner[0].clone(), corner[1].clone(), lift];
    let size = [
        leg_x * Rational::from(u),
        height.clone(),
        leg_y * Rational::from(v),
    ];
    let turn = Transform::quarter_turns(&matrix).unwrap_or_default();
    Ok(Some(Extruded {
        primitive: Primitive::wedge(size)?,
        moves: turn.then(Transform::shift(offset)),
    }))
}

pub(super) fn operation(op: FigureOperation) -> Operation {
    match op {
        FigureOperation::Union => Operation::Union,
        FigureOperation::Intersection => Operation::Intersection,
        FigureOperation::Difference => Operation::Difference,
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
            None => as_parts_or_whole(region, span, |r| self.of_region(builder, r, false))?,
        };
        Ok(builder.moved(part, self.start.clone()))
    }

    fn of_region(
        &self,
        builder: &mut Builder,
        region: &Region,
        is_combined: bool,
    ) -> Result<SolidId, SpannedError> {
        match region {
            Region::Figure(figure) => self.of_figure(builder, figure, is_combined),
            Region::Combined { op, operands, .. } => {
                let is_combined = is_combined || *op != FigureOperation::Union;
                let parts: Vec<SolidId> = operands
                    .iter()
                    .map(|operand| self.of_region(builder, operand, is_combined))
                    .collect::<Result<_, _>>()?;
                Ok(builder.operation(operation(*op), &parts))
            }
        }
    }

    fn of_figure(
        &self,
        builder: &mut Builder,
        region: &RegionFigure,
        is_combined: bool,
    ) -> Result<SolidId, SpannedError> {
        let span = &region.span;
        let wrong = |error: PrimitiveError| bad_length(error, None, span.clone());
        let figure = region.figure()?;
        if let Some(disc) = figure.as_disc()
            && self.angle.is_none()
            && disc.centre[0] > disc.radius
        {
            let [x, z] = disc.centre;
            let torus = builder.primitive(Primitive::torus(x, disc.radius).map_err(wrong)?);
            let lift = Transform::shift([Rational::ZERO, Rational::ZERO, z]);
            return Ok(builder.moved(torus, lift));
        }
        if figure.crosses_axis() && !is_combined {
            return Err(wrong(PrimitiveError::AcrossAxis));
        }
        // OpenSCAD revolves a figure on the other side of the axis, too. Of an operand only the part
        // on this side matters.
        let is_beyond = figure.is_left_of_axis() && !is_combined;
        let figure = match is_beyond {
            true => figure.mirrored_x(),
            false => figure,
        };
        let kept = figure.right_of_axis().map_err(|e| bad_figure(&e, span))?;
        let Some(figure) = kept else {
            return Ok(SolidId::EMPTY);
        };
        let part = Primitive::revolution(figure, self.angle.clone()).map_err(wrong)?;
        let part = builder.primitive(part);
        Ok(match is_beyond {
            true => builder.moved(part, half_turn()),
            false => part,
        })
    }
}

/// Half a turn about z.
fn half_turn() -> Transform {
    let turn = [[-1, 0, 0], [0, -1, 0], [0, 0, 1]].map(|row| row.map(Rational::from));
    Transform::quarter_turns(&turn).unwrap_or_default()
}
