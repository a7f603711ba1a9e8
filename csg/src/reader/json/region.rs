//! Figures in `.json` as expressions: primitives of the plane, set operations, hulls and offsets.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::bad_length;
use super::super::region::Region;
use super::contours::contours;
use super::value::{Content, Document, Member, ValueId};
use super::{Fields, Length, check_bits, choice, lengths, number, numbers};
use crate::figure::{Figure, FigureOperation, OffsetJoin};
use crate::primitive::Dimension;
use crate::transform::{Transform, TransformStep};

/// An operation on figures.
#[derive(Debug, Clone, Copy)]
enum PlaneOperation {
    Set(FigureOperation),
    Hull,
    Offset,
}

const OPERATIONS: [(&str, PlaneOperation); 5] = [
    ("union", PlaneOperation::Set(FigureOperation::Union)),
    (
        "intersection",
        PlaneOperation::Set(FigureOperation::Intersection),
    ),
    (
        "difference",
        PlaneOperation::Set(FigureOperation::Difference),
    ),
    ("hull", PlaneOperation::Hull),
    ("offset", PlaneOperation::Offset),
];

/// A primitive of the plane.
#[derive(Debug, Clone, Copy)]
enum PlanePrimitive {
    Square,
    Circle,
    Polygon,
}

const PRIMITIVES: [(&str, PlanePrimitive); 3] = [
    ("square", PlanePrimitive::Square),
    ("circle", PlanePrimitive::Circle),
    ("polygon", PlanePrimitive::Polygon),
];

/// The distances of an offset: the key, and the shape of its corners.
const DISTANCES: [(&str, OffsetJoin); 3] = [
    ("r", OffsetJoin::Round),
    ("delta", OffsetJoin::Miter),
    ("chamfer", OffsetJoin::Chamfer),
];

/// What is to be done with the last regions.
enum Combination {
    Set(FigureOperation),
    Hull,
    Offset {
        distance: Rational,
        join: OffsetJoin,
    },
}

/// A pending step; the regions made so far are on a stack.
enum Step {
    Enter(ValueId),
    Combine(Box<PendingOperation>),
}

/// An operation whose operands are made first.
struct PendingOperation {
    how: Combination,
    count: usize,
    moves: Transform,
    span: Range<usize>,
}

/// The region that an expression describes; `None` if it is empty.
pub(super) fn region(document: &Document, root: ValueId) -> Result<Option<Region>, SpannedError> {
    let mut steps = vec![Step::Enter(root)];
    let mut regions: Vec<Option<Region>> = Vec::new();
    while let Some(step) = steps.pop() {
        match step {
            Step::Enter(id) => regions.extend(enter(document, id, &mut steps)?),
            Step::Combine(pending) => {
                let operands = regions.split_off(regions.len().saturating_sub(pending.count));
                let made = combined(pending.how, operands, &pending.span)?;
                regions.push(made.map(|region| region.moved(&pending.moves)));
            }
        }
    }
    Ok(regions.pop().flatten())
}

fn combined(
    how: Combination,
    operands: Vec<Option<Region>>,
    span: &Range<usize>,
) -> Result<Option<Region>, SpannedError> {
    match how {
        Combination::Set(op) => Region::combined(op, operands),
        Combination::Hull => Region::hull(operands.iter().flatten(), span),
        Combination::Offset { distance, join } => {
            let mut operands = operands.into_iter().flatten();
            let offset = operands
                .next()
                .map(|region| region.offset(&distance, join, span));
            Ok(offset.transpose()?.flatten())
        }
    }
}

/// Makes a primitive, or schedules the operands of an operation.
fn enter(
    document: &Document,
    id: ValueId,
    steps: &mut Vec<Step>,
) -> Result<Option<Option<Region>>, SpannedError> {
    let value = document.value(id);
    let Content::Object(members) = &value.content else {
        let expected = "a figure: an object with `op` or `prim`";
        let found = value.content.describe();
        return Err(SpannedError::input(value.span.clone(), found, expected));
    };
    let fields = Fields {
        document,
        members,
        span: value.span.clone(),
    };
    fields.check_unique()?;
    match (fields.find("op"), fields.find("prim")) {
        (Some(op), None) => {
            operation(&fields, op, steps)?;
            Ok(None)
        }
        (None, Some(name)) => primitive(&fields, name).map(Some),
        (Some(_), Some(_)) | (None, None) => Err(fields.neither()),
    }
}

fn operation(
    fields: &Fields<'_>,
    name: &Member,
    steps: &mut Vec<Step>,
) -> Result<(), SpannedError> {
    let op = choice(fields.document.value(name.value), &OPERATIONS)?;
    let (how, operands) = match op {
        PlaneOperation::Set(_) | PlaneOperation::Hull => {
            fields.check_known(&["op", "children", "transform"])?;
            let children = fields.array(fields.require("children")?, "an array of figures")?;
            let how = match op {
                PlaneOperation::Set(op) => Combination::Set(op),
                _ => Combination::Hull,
            };
            (how, children.to_vec())
        }
        PlaneOperation::Offset => {
            fields.check_known(&["op", "figure", "r", "delta", "chamfer", "transform"])?;
            (offset(fields)?, vec![fields.require("figure")?.value])
        }
    };
    steps.push(Step::Combine(Box::new(PendingOperation {
        how,
        count: operands.len(),
        moves: moves(fields)?,
        span: fields.span.clone(),
    })));
    steps.extend(operands.into_iter().rev().map(Step::Enter));
    Ok(())
}

/// The distance of an offset, and the shape of its corners.
fn offset(fields: &Fields<'_>) -> Result<Combination, SpannedError> {
    let given = DISTANCES.iter();
    let mut given = given.filter_map(|(key, join)| Some((fields.find(key)?, *join)));
    let (Some((member, join)), None) = (given.next(), given.next()) else {
        let found = "an offset without one distance";
        let expected = "one of `r`, `delta` and `chamfer`";
        return Err(SpannedError::input(fields.span.clone(), found, expected));
    };
    let distance = number(fields.document, member.value)?.value;
    Ok(Combination::Offset { distance, join })
}

fn primitive(fields: &Fields<'_>, name: &Member) -> Result<Option<Region>, SpannedError> {
    let kind = choice(fields.document.value(name.value), &PRIMITIVES)?;
    let positive = |length: Length, dimension: Dimension| {
        let checked = dimension.check_positive(&length.value);
        match checked {
            Ok(()) => Ok(length.value),
            Err(error) => Err(bad_length(error, Some(&length.value), length.span)),
        }
    };
    let figure = match kind {
        PlanePrimitive::Square => {
            fields.check_known(&["prim", "size", "transform"])?;
            let size = fields.require("size")?.value;
            let [x, y] = lengths(fields.document, size, PAIR)?;
            Figure::rectangle(&[positive(x, Dimension::X)?, positive(y, Dimension::Y)?])
        }
        PlanePrimitive::Circle => {
            fields.check_known(&["prim", "r", "transform"])?;
            let radius = number(fields.document, fields.require("r")?.value)?;
            Figure::disc(&positive(radius, Dimension::Radius)?)
        }
        PlanePrimitive::Polygon => {
            fields.check_known(&["prim", "contours", "transform"])?;
            Ok(contours(fields, fields.require("contours")?)?)
        }
    };
    let made = Region::made(figure, &fields.span)?;
    let moves = moves(fields)?;
    Ok(made.map(|region| region.moved(&moves)))
}

/// What is expected for two coordinates.
const PAIR: &str = "an array of two numbers";

/// The steps of the optional transform in the plane.
fn moves(fields: &Fields<'_>) -> Result<Transform, SpannedError> {
    let mut moves = Transform::new();
    let Some(member) = fields.find("transform") else {
        return Ok(moves);
    };
    for &id in fields.array(member, "an array of steps")? {
        let value = fields.document.value(id);
        let step = plane_step(fields.document, id)?;
        moves.push(step).map_err(|error| {
            SpannedError::input(value.span.clone(), error.to_string(), "a motion")
        })?;
        check_bits(&moves, &value.span)?;
    }
    Ok(moves)
}

fn plane_step(document: &Document, id: ValueId) -> Result<TransformStep, SpannedError> {
    let value = document.value(id);
    let expected = "a step: {\"translate\":[x,y]} or {\"rotate\":degrees}";
    let wrong = || SpannedError::input(value.span.clone(), value.content.describe(), expected);
    let Content::Object(members) = &value.content else {
        return Err(wrong());
    };
    let step = Fields {
        document,
        members,
        span: value.span.clone(),
    };
    step.check_known(&["translate", "rotate"])?;
    let [member] = members.as_slice() else {
        return Err(wrong());
    };
    match member.key.as_str() {
        "translate" => {
            let [x, y] = numbers(document, member.value, PAIR)?;
            Ok(TransformStep::Shift([x, y, Rational::ZERO]))
        }
        _ => Ok(TransformStep::Turn {
            axis: [Rational::ZERO, Rational::ZERO, Rational::ONE],
            degrees: number(document, member.value)?.value,
        }),
    }
}
