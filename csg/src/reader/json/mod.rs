//! `.json`: the tree itself.

mod contours;
mod ellipsoid;
mod figure;
mod oblique;
mod polyhedron;
mod region;
mod unbounded;
mod value;

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use self::value::{Content, Document, Member, Value, ValueId, parse};
use super::error::SpannedError;
use super::number::{bad_length, literal};
use super::refusal::construction_error;
use super::spanned::Spanned;
use super::{PartPlace, Program, StandaloneText};
use crate::builder::{Builder, MAX_MOTION_BITS, SolidId};
use crate::construction::convex_hull;
use crate::polyhedron::SpacePoint;
use crate::primitive::{Dimension, Primitive, PrimitiveError};
use crate::transform::{self, Transform};
use crate::tree::Operation;
use premio_text::escape::quote;

pub(super) fn read(source: &str) -> Result<Program, SpannedError> {
    let document = parse(source)?;
    let mut builder = Builder::new();
    let part = Reader {
        document: &document,
        builder: &mut builder,
    }
    .solid(document.root)?;
    let span = document.value(document.root).span.clone();
    Ok(Program {
        builder,
        part,
        digits: None,
        notes: Vec::new(),
        standalone: StandaloneText::AsRead,
        included: Vec::new(),
        place: PartPlace::new(span),
    })
}

/// An operation on solids.
#[derive(Debug, Clone, Copy)]
enum SolidOperation {
    Set(Operation),
    Hull,
    /// The outside of a union.
    Complement,
}

const OPERATIONS: [(&str, SolidOperation); 5] = [
    ("union", SolidOperation::Set(Operation::Union)),
    ("intersection", SolidOperation::Set(Operation::Intersection)),
    ("difference", SolidOperation::Set(Operation::Difference)),
    ("hull", SolidOperation::Hull),
    ("complement", SolidOperation::Complement),
];

/// The primitives, and the keys of each besides `prim` and `transform`.
const PRIMITIVES: [(&str, &[&str]); 15] = [
    ("block", &["size"]),
    ("wedge", &["size"]),
    ("cylinder", &["r", "h"]),
    ("cone", &["r", "h"]),
    ("frustum", &["r1", "r2", "h"]),
    ("sphere", &["r"]),
    ("torus", &["R", "r"]),
    ("prism", &["figure", "h", "top"]),
    ("revolution", &["figure", "angle"]),
    ("polyhedron", &["points", "faces"]),
    ("oblique_frustum", &["x", "y", "z", "top"]),
    ("ellipsoid", &["x", "y", "z"]),
    ("half_space", &["normal", "offset"]),
    ("infinite_cylinder", &["r"]),
    ("infinite_cone", &["slope"]),
];

/// A pending step; the solids created so far are on a stack.
enum Step {
    Enter(ValueId),
    Combine {
        op: SolidOperation,
        count: usize,
        moves: Transform,
        span: Range<usize>,
    },
}

struct Reader<'a> {
    document: &'a Document,
    builder: &'a mut Builder,
}

impl<'a> Reader<'a> {
    fn solid(&mut self, root: ValueId) -> Result<SolidId, SpannedError> {
        let mut steps = vec![Step::Enter(root)];
        let mut parts: Vec<SolidId> = Vec::new();
        while let Some(step) = steps.pop() {
            match step {
                Step::Enter(id) => {
                    if let Some(part) = self.enter(id, &mut steps)? {
                        parts.push(part);
                    }
                }
                Step::Combine {
                    op,
                    count,
                    moves,
                    span,
                } => {
                    let children = parts.split_off(parts.len().saturating_sub(count));
                    let part = match op {
                        SolidOperation::Set(op) => self.builder.operation(op, &children),
                        SolidOperation::Complement => {
                            let union = self.builder.operation(Operation::Union, &children);
                            self.builder.complement(union)
                        }
                        SolidOperation::Hull => {
                            let hull = convex_hull(self.builder, &children, 0.0);
                            hull.map_err(|error| construction_error(&error, &span))?
                                .solid
                        }
                    };
                    parts.push(self.builder.moved(part, moves));
                }
            }
        }
        Ok(parts.pop().unwrap_or(SolidId::EMPTY))
    }

    /// Creates a primitive, or schedules the children of an operation.
    fn enter(
        &mut self,
        id: ValueId,
        steps: &mut Vec<Step>,
    ) -> Result<Option<SolidId>, SpannedError> {
        let value = self.document.value(id);
        let Content::Object(members) = &value.content else {
            let expected = "a solid: an object with `op` or `prim`";
            return Err(SpannedError::input(
                value.span.clone(),
                value.content.describe(),
                expected,
            ));
        };
        let fields = Fields {
            document: self.document,
            members,
            span: value.span.clone(),
        };
        fields.check_unique()?;
        match (fields.find("op"), fields.find("prim")) {
            (Some(op), None) => {
                self.operation(&fields, op, steps)?;
                Ok(None)
            }
            (None, Some(name)) => self.primitive(&fields, name).map(Some),
            (Some(_), Some(second)) => {
                let expected = "either `op` or `prim`, not both";
                Err(SpannedError::input(
                    second.key_span.clone(),
                    quote(&second.key),
                    expected,
                ))
            }
            (None, None) => Err(fields.neither()),
        }
    }

    fn operation(
        &mut self,
        fields: &Fields<'a>,
        name: &Member,
        steps: &mut Vec<Step>,
    ) -> Result<(), SpannedError> {
        fields.check_known(&["op", "children", "transform"])?;
        let op = choice(self.document.value(name.value), &OPERATIONS)?;
        let children = fields.array(fields.require("children")?, "an array of solids")?;
        let moves = fields.moves()?;
        steps.push(Step::Combine {
            op,
            count: children.len(),
            moves,
            span: fields.span.clone(),
        });
        steps.extend(children.iter().rev().map(|&child| Step::Enter(child)));
        Ok(())
    }

    fn primitive(&mut self, fields: &Fields<'a>, name: &Member) -> Result<SolidId, SpannedError> {
        let keys = choice(self.document.value(name.value), &PRIMITIVES)?;
        let known: Vec<&str> = ["prim", "transform"].iter().chain(keys).copied().collect();
        fields.check_known(&known)?;
        let Content::Text(name) = &self.document.value(name.value).content else {
            return Err(fields.neither());
        };
        let moves = fields.moves()?;
        let swept = match name.as_str() {
            "prism" => Some(figure::prism(self.builder, fields)?),
            "revolution" => Some(figure::revolution(self.builder, fields)?),
            "polyhedron" => {
                let polyhedron = polyhedron::polyhedron(fields)?;
                Some(self.builder.primitive(polyhedron))
            }
            "oblique_frustum" => {
                let frustum = oblique::oblique_frustum(fields)?;
                Some(self.builder.primitive(frustum))
            }
            "ellipsoid" => {
                let ellipsoid = ellipsoid::ellipsoid(fields)?;
                Some(self.builder.primitive(ellipsoid))
            }
            "half_space" | "infinite_cylinder" | "infinite_cone" => {
                let unbounded = unbounded::unbounded(name, fields)?;
                Some(self.builder.unbounded(unbounded))
            }
            _ => None,
        };
        if let Some(part) = swept {
            return Ok(self.builder.moved(part, moves));
        }
        let lengths = fields.lengths(keys)?;
        let primitive = make(name, &lengths).map_err(|error| {
            let length = &lengths[length_index(error.dimension(), lengths.len())];
            bad_length(error, Some(&length.value), length.span.clone())
        })?;
        let part = self.builder.primitive(primitive);
        Ok(self.builder.moved(part, moves))
    }
}

/// A number and its span.
type Length = Spanned<Rational>;

/// A step of a transform.
struct AxisStep {
    step: transform::TransformStep,
    /// The value of its axis.
    axis: ValueId,
}

/// The primitive with this name, from its numbers in the order of its keys.
fn make(name: &str, lengths: &[Length]) -> Result<Primitive, PrimitiveError> {
    let n = |index: usize| {
        lengths
            .get(index)
            .map_or(Rational::ZERO, |length| length.value.clone())
    };
    match name {
        "block" => Primitive::block([n(0), n(1), n(2)]),
        "wedge" => Primitive::wedge([n(0), n(1), n(2)]),
        "cylinder" => Primitive::cylinder(n(0), n(1)),
        "cone" => Primitive::cone(n(0), n(1)),
        "frustum" => Primitive::frustum(n(0), n(1), n(2)),
        "sphere" => Primitive::sphere(n(0)),
        _ => Primitive::torus(n(0), n(1)),
    }
}

/// Three numbers; `expected` describes them.
fn coordinates(
    document: &Document,
    id: ValueId,
    expected: &str,
) -> Result<SpacePoint, SpannedError> {
    let values = items(document, id, expected)?.iter();
    let values: Vec<Rational> = values
        .map(|&id| Ok(number(document, id)?.value))
        .collect::<Result<_, SpannedError>>()?;
    SpacePoint::try_from(values).map_err(|values| {
        let found = format!("an array of {}", values.len());
        SpannedError::input(document.value(id).span.clone(), found, expected)
    })
}

/// The index of the number of a primitive to which an error refers.
fn length_index(dimension: Dimension, count: usize) -> usize {
    let last = count.saturating_sub(1);
    match dimension {
        Dimension::X
        | Dimension::Radius
        | Dimension::Base
        | Dimension::Major
        | Dimension::Slope => 0,
        Dimension::Y | Dimension::Top | Dimension::Minor => last.min(1),
        Dimension::Z | Dimension::Height => last,
    }
}

/// The value of a text that is one of several choices.
fn choice<T: Copy>(value: &Value, known: &[(&'static str, T)]) -> Result<T, SpannedError> {
    let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
    let expected = format!("one of \"{}\"", names.join("\", \""));
    let fault = SpannedError::input(value.span.clone(), value.content.describe(), expected);
    let Content::Text(text) = &value.content else {
        return Err(fault);
    };
    match known.iter().find(|(name, _)| name == text) {
        Some((_, meaning)) => Ok(*meaning),
        None => Err(fault.suggest(text, names)),
    }
}

/// The members of an object.
struct Fields<'a> {
    document: &'a Document,
    members: &'a [Member],
    span: Range<usize>,
}

impl<'a> Fields<'a> {
    fn find(&self, key: &str) -> Option<&'a Member> {
        self.members.iter().find(|member| member.key == key)
    }

    fn require(&self, key: &str) -> Result<&'a Member, SpannedError> {
        self.find(key).ok_or_else(|| {
            let end = self.span.end;
            let found = format!("an object without `{key}`");
            SpannedError::input(
                end.saturating_sub(1)..end,
                found,
                format!("the key `{key}`"),
            )
        })
    }

    fn neither(&self) -> SpannedError {
        let found = "an object without `op` or `prim`";
        SpannedError::input(self.span.clone(), found, "`op` or `prim`")
    }

    fn check_unique(&self) -> Result<(), SpannedError> {
        let mut seen = std::collections::HashSet::new();
        for member in self.members {
            if !seen.insert(member.key.as_str()) {
                let found = format!("the key {} a second time", quote(&member.key));
                return Err(SpannedError::input(
                    member.key_span.clone(),
                    found,
                    "each key once",
                ));
            }
        }
        Ok(())
    }

    fn check_known(&self, known: &[&str]) -> Result<(), SpannedError> {
        for member in self.members {
            if !known.contains(&member.key.as_str()) {
                let found = format!("the unknown key {}", quote(&member.key));
                let expected = format!("one of `{}`", known.join("`, `"));
                let fault = SpannedError::input(member.key_span.clone(), found, expected);
                return Err(fault.suggest(&member.key, known.iter().copied()));
            }
        }
        Ok(())
    }

    fn array(&self, member: &Member, expected: &str) -> Result<&'a [ValueId], SpannedError> {
        items(self.document, member.value, expected)
    }

    /// The numbers of a primitive, in the order of its keys.
    fn lengths(&self, keys: &[&str]) -> Result<Vec<Length>, SpannedError> {
        if keys == ["size"] {
            let member = self.require("size")?;
            return Ok(lengths::<3>(self.document, member.value, TRIPLE)?.into());
        }
        keys.iter()
            .map(|key| number(self.document, self.require(key)?.value))
            .collect()
    }

    /// The steps of the optional transform.
    fn moves(&self) -> Result<Transform, SpannedError> {
        let mut moves = Transform::new();
        let Some(member) = self.find("transform") else {
            return Ok(moves);
        };
        for &id in self.array(member, "an array of steps")? {
            let AxisStep { step, axis } = self.step(id)?;
            moves.push(step).map_err(|error| {
                let span = self.document.value(axis).span.clone();
                SpannedError::input(span, error.to_string(), "an axis with a direction")
            })?;
            check_bits(&moves, &self.document.value(id).span)?;
        }
        Ok(moves)
    }

    fn step(&self, id: ValueId) -> Result<AxisStep, SpannedError> {
        let value = self.document.value(id);
        let expected = "a step: {\"translate\":[x,y,z]}, {\"rotate\":[[x,y,z],degrees]} or \
                        {\"quaternion\":[w,x,y,z]}";
        let wrong = || SpannedError::input(value.span.clone(), value.content.describe(), expected);
        let Content::Object(members) = &value.content else {
            return Err(wrong());
        };
        let step = Fields {
            document: self.document,
            members,
            span: value.span.clone(),
        };
        step.check_known(&["translate", "rotate", "quaternion"])?;
        let [member] = members.as_slice() else {
            return Err(wrong());
        };
        match member.key.as_str() {
            "translate" => {
                let offset = numbers(self.document, member.value, TRIPLE)?;
                Ok(AxisStep {
                    step: transform::TransformStep::Shift(offset),
                    axis: member.value,
                })
            }
            "quaternion" => {
                let quaternion = numbers(self.document, member.value, "an array of four numbers")?;
                Ok(AxisStep {
                    step: transform::TransformStep::Quaternion(quaternion),
                    axis: member.value,
                })
            }
            _ => self.rotation(member.value),
        }
    }

    fn rotation(&self, id: ValueId) -> Result<AxisStep, SpannedError> {
        let expected = "an axis and an angle: [[x,y,z],degrees]";
        let &[axis_id, degrees] = items(self.document, id, expected)? else {
            let span = self.document.value(id).span.clone();
            return Err(SpannedError::input(
                span,
                "an array of another length",
                expected,
            ));
        };
        let axis = numbers(self.document, axis_id, TRIPLE)?;
        let degrees = number(self.document, degrees)?.value;
        Ok(AxisStep {
            step: transform::TransformStep::Turn { axis, degrees },
            axis: axis_id,
        })
    }
}

/// Limits the exact numbers of a transform.
fn check_bits(moves: &Transform, span: &Range<usize>) -> Result<(), SpannedError> {
    let bits = moves.motion().bits();
    if bits <= MAX_MOTION_BITS {
        return Ok(());
    }
    let found = format!("a transform whose exact numbers take {bits} bits");
    let expected = format!("at most {MAX_MOTION_BITS} bits");
    Err(SpannedError::limit(span.clone(), found, expected))
}

fn items<'a>(
    document: &'a Document,
    id: ValueId,
    expected: &str,
) -> Result<&'a [ValueId], SpannedError> {
    let value = document.value(id);
    match &value.content {
        Content::Array(items) => Ok(items),
        other => Err(SpannedError::input(
            value.span.clone(),
            other.describe(),
            expected,
        )),
    }
}

fn number(document: &Document, id: ValueId) -> Result<Length, SpannedError> {
    let Value { content, span } = document.value(id);
    match content {
        Content::Number(text) => {
            let value = literal(text, span.clone())?;
            Ok(Length {
                value,
                span: span.clone(),
            })
        }
        other => Err(SpannedError::input(
            span.clone(),
            other.describe(),
            "a number",
        )),
    }
}

/// What is expected for three coordinates.
const TRIPLE: &str = "an array of three numbers";

fn lengths<const N: usize>(
    document: &Document,
    id: ValueId,
    expected: &str,
) -> Result<[Length; N], SpannedError> {
    let all = items(document, id, expected)?;
    let all: Result<Vec<Length>, SpannedError> = match all.len() == N {
        true => all.iter().map(|&item| number(document, item)).collect(),
        false => Ok(Vec::new()),
    };
    all?.try_into().map_err(|_| {
        let span = document.value(id).span.clone();
        SpannedError::input(span, "an array of another length", expected)
    })
}

fn numbers<const N: usize>(
    document: &Document,
    id: ValueId,
    expected: &str,
) -> Result<[Rational; N], SpannedError> {
    Ok(lengths(document, id, expected)?.map(|length| length.value))
}
