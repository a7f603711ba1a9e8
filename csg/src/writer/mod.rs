//! Writers of the description languages, from part to text.
//!
//! A part is written by the steps and operations with which it was read. The text therefore
//! describes the same tree if the language can represent its numbers. Mirrors and scales are
//! applied to the primitives. Nothing here recurses.

mod json;
mod number;
mod padl;
mod scad;
mod turns;

use premio_kernel::number::rational::Rational;

use crate::builder::{Builder, BuilderNode, MAX_LEAVES, Placing, SolidId, TreeError};
use crate::primitive::{MirrorImage, Primitive};
use crate::reader::Format;
use crate::transform::{Transform, TransformStep};
use crate::tree::Operation;

/// The longest text, in bytes.
pub(crate) const MAX_TEXT: usize = 1 << 30;

/// Why a part was not written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WriteError {
    /// `.padl` cannot represent the empty solid.
    #[error("`.padl` has no word for the empty solid")]
    Empty,
    /// The language is supported for reading only.
    #[error("this language is read, and not written: expected padl, csg or json")]
    ReadOnly,
    /// Parts used several times are copied if a language has no names, and there are too many
    /// copies.
    #[error("{leaves} primitives, with every use of a part counted; the limit is {MAX_LEAVES}")]
    TooManyLeaves {
        /// The number of primitives.
        leaves: u64,
    },
    /// The part belongs to another builder.
    #[error("a solid of another builder was used")]
    ForeignSolid,
    /// `.csg` has circles, and no arcs.
    #[error("`.csg` cannot represent a figure with arcs")]
    Arcs,
    /// The faces of polyhedra in `.csg` have no holes.
    #[error("`.csg` cannot represent a polyhedron with a hole in a face")]
    Holes,
    /// The part has no bound.
    #[error(transparent)]
    Unbounded(TreeError),
    /// The text would be too long.
    #[error("a text of more than {MAX_TEXT} bytes")]
    TooLong,
}

/// The description of a part.
///
/// Numbers are written with all their digits. What a language cannot represent is written to f64
/// precision: in `.padl` rotations about other than coordinate axes, in `.csg` rotations by other
/// than quarters of a degree about coordinate axes, in `.csg` and `.json` numbers without a finite
/// decimal. A bounded solid is written in place of an unbounded one.
///
/// # Errors
/// The solid belongs to another builder, has too many primitives or no bound, the language is read only or
/// has no word for the empty solid, or the text is too long.
pub fn write(builder: &Builder, part: SolidId, format: Format) -> Result<String, WriteError> {
    if builder.is_foreign(part) {
        return Err(WriteError::ForeignSolid);
    }
    let leaves = builder.leaves(part);
    if leaves > MAX_LEAVES {
        return Err(WriteError::TooManyLeaves { leaves });
    }
    if builder.has_unbounded(part) {
        let (bounded, part) = builder.bounded(part).map_err(WriteError::Unbounded)?;
        return write(&bounded, part, format);
    }
    let top = builder.draft_of(part).map(Use::new);
    match format {
        Format::Csg if has_primitive(builder, part, has_arcs) => return Err(WriteError::Arcs),
        Format::Csg if has_primitive(builder, part, has_holes) => return Err(WriteError::Holes),
        _ => {}
    }
    match format {
        Format::Padl => padl::write(builder, top.ok_or(WriteError::Empty)?),
        Format::Csg => scad::write(builder, top),
        Format::Json => json::write(builder, top),
        Format::Asc | Format::Pov => Err(WriteError::ReadOnly),
    }
}

/// Whether a primitive has a figure with arcs.
fn has_arcs(primitive: &Primitive) -> bool {
    match primitive {
        Primitive::Prism { figure, .. } | Primitive::Revolution { figure, .. } => {
            !figure.is_polygon()
        }
        _ => false,
    }
}

/// Whether a primitive has a plane face with a hole that no figure describes.
fn has_holes(primitive: &Primitive) -> bool {
    match primitive {
        Primitive::Polyhedron { polyhedron } => {
            polyhedron.faces().iter().any(|face| face.loops.len() > 1)
        }
        _ => false,
    }
}

/// Whether a part uses a primitive of some kind.
fn has_primitive(builder: &Builder, part: SolidId, is_it: impl Fn(&Primitive) -> bool) -> bool {
    let mut seen = std::collections::BTreeSet::new();
    let mut ahead: Vec<usize> = builder.draft_of(part).into_iter().collect();
    while let Some(draft) = ahead.pop() {
        if !seen.insert(draft) {
            continue;
        }
        match builder.draft(draft) {
            BuilderNode::Leaf(primitive) if is_it(primitive) => return true,
            BuilderNode::Leaf(_) | BuilderNode::Unbounded(_) => {}
            BuilderNode::Operation { children, .. } => ahead.extend(children),
            BuilderNode::Moved { child, .. } => ahead.push(*child),
        }
    }
    false
}

/// A use of a part: possibly mirrored by `y -> -y`, and possibly scaled.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Use {
    draft: usize,
    mirrored: bool,
    /// The scale factor; `None` for one.
    factor: Option<Rational>,
}

impl Use {
    fn new(draft: usize) -> Self {
        Self {
            draft,
            mirrored: false,
            factor: None,
        }
    }

    /// The same use of another draft.
    fn with(&self, draft: usize) -> Self {
        let factor = self.factor.clone();
        Self {
            draft,
            factor,
            ..*self
        }
    }

    fn step(&self, step: &TransformStep) -> TransformStep {
        let step = match &self.factor {
            Some(factor) => step.scaled(factor),
            None => step.clone(),
        };
        if self.mirrored {
            step.mirrored_y()
        } else {
            step
        }
    }

    /// The part without its motion.
    fn resolved(mut self, builder: &Builder) -> ResolvedUse {
        let mut steps = Vec::new();
        if let BuilderNode::Moved { child, entry, .. } = builder.draft(self.draft) {
            // From the last placing to the first: the outer ones act on the inner steps.
            let mut next = Some(*entry);
            while let Some(entry) = next.map(|index| builder.entry(index)) {
                match &entry.placing {
                    Placing::Steps(inner) => {
                        steps.extend(inner.iter().rev().map(|step| self.step(step)));
                    }
                    Placing::MirrorY => self.mirrored = !self.mirrored,
                    Placing::Scale(factor) => {
                        self.factor = Some(match &self.factor {
                            Some(outer) => outer * factor,
                            None => factor.clone(),
                        });
                    }
                }
                next = entry.before;
            }
            steps.reverse();
            self.draft = *child;
        }
        ResolvedUse {
            part: self,
            steps: Transform::tidied(steps),
        }
    }

    /// A primitive as it is used.
    fn primitive(&self, primitive: &Primitive) -> UsedPrimitive {
        let primitive = match &self.factor {
            Some(factor) => primitive.scaled(factor),
            None => primitive.clone(),
        };
        if !self.mirrored {
            let step = None;
            return UsedPrimitive { primitive, step };
        }
        let MirrorImage { primitive, motion } = primitive.mirrored_y();
        let step = match &primitive {
            Primitive::Revolution {
                angle: Some(angle), ..
            } => Some(TransformStep::Turn {
                axis: [Rational::ZERO, Rational::ZERO, Rational::ONE],
                degrees: -angle.degrees(),
            }),
            _ if motion.is_identity() => None,
            _ => Some(TransformStep::Shift(motion.offset().clone())),
        };
        UsedPrimitive { primitive, step }
    }
}

/// A part that is moved.
struct ResolvedUse {
    /// The part as it is used inside the motion.
    part: Use,
    /// The steps of the motion.
    steps: Vec<TransformStep>,
}

/// A primitive as it is used.
struct UsedPrimitive {
    primitive: Primitive,
    /// The motion that a mirror causes.
    step: Option<TransformStep>,
}

/// The syntax of a language.
trait Language {
    /// A primitive, moved.
    fn leaf(&mut self, primitive: &Primitive, steps: &[TransformStep]);
    /// A part with a name, moved.
    fn name(&mut self, name: usize, steps: &[TransformStep]);
    /// The beginning of an operation.
    fn open(&mut self, op: Operation, steps: &[TransformStep]);
    /// The separator of two operands.
    fn between(&mut self, op: Operation);
    /// The end of an operation, moved.
    fn close(&mut self, steps: &[TransformStep]);
    /// The length of the text.
    fn length(&self) -> usize;
}

/// A pending task.
enum Task {
    Enter(Use),
    Between(Operation),
    Close(Vec<TransformStep>),
}

/// Writes a part. Parts to which `name` assigns a name are written by name.
fn walk(
    builder: &Builder,
    top: Use,
    name: impl Fn(&Use) -> Option<usize>,
    language: &mut impl Language,
) -> Result<(), WriteError> {
    let mut tasks = vec![Task::Enter(top)];
    while let Some(task) = tasks.pop() {
        match task {
            Task::Enter(part) => enter(builder, part, &name, language, &mut tasks),
            Task::Between(op) => language.between(op),
            Task::Close(steps) => language.close(&steps),
        }
        if language.length() > MAX_TEXT {
            return Err(WriteError::TooLong);
        }
    }
    Ok(())
}

fn enter(
    builder: &Builder,
    part: Use,
    name: &impl Fn(&Use) -> Option<usize>,
    language: &mut impl Language,
    tasks: &mut Vec<Task>,
) {
    let ResolvedUse { part, mut steps } = part.resolved(builder);
    if let Some(name) = name(&part) {
        language.name(name, &steps);
        return;
    }
    match builder.draft(part.draft) {
        BuilderNode::Leaf(primitive) => {
            let UsedPrimitive { primitive, step } = part.primitive(primitive);
            steps.splice(0..0, step);
            let steps = Transform::tidied(steps);
            language.leaf(&primitive, &steps);
        }
        BuilderNode::Operation { op, children } => {
            language.open(*op, &steps);
            tasks.push(Task::Close(steps));
            let operands = operands(builder, &part, *op, children, name);
            for (index, operand) in operands.into_iter().enumerate().rev() {
                tasks.push(Task::Enter(operand));
                if index > 0 {
                    tasks.push(Task::Between(*op));
                }
            }
        }
        // Consecutive placements are merged, and unbounded solids were replaced.
        BuilderNode::Moved { .. } | BuilderNode::Unbounded(_) => {}
    }
}

/// The operands of an operation. An operand that is the same operation is replaced by its own
/// operands, where that changes nothing.
fn operands(
    builder: &Builder,
    part: &Use,
    op: Operation,
    children: &[usize],
    name: &impl Fn(&Use) -> Option<usize>,
) -> Vec<Use> {
    let below = |part: &Use, children: &[usize]| {
        let uses = children.iter().rev().map(|&child| part.with(child));
        uses.collect::<Vec<Use>>()
    };
    let mut ahead = below(part, children);
    let mut operands = Vec::new();
    while let Some(operand) = ahead.pop() {
        // (A - B) - C is A - B - C, while A - (B - C) stays.
        if op != Operation::Difference || operands.is_empty() {
            let ResolvedUse { part: inner, steps } = operand.clone().resolved(builder);
            if let BuilderNode::Operation { op: same, children } = builder.draft(inner.draft)
                && *same == op
                && steps.is_empty()
                && name(&inner).is_none()
            {
                ahead.extend(below(&inner, children));
                continue;
            }
        }
        operands.push(operand);
    }
    operands
}

/// The indentation at a depth.
fn indent(depth: usize) -> &'static str {
    const BLANKS: &str = "                                ";
    &BLANKS[..(2 * depth).min(BLANKS.len())]
}

/// Adds to a text.
fn push(text: &mut String, written: std::fmt::Arguments<'_>) {
    // A string takes everything.
    let _ = std::fmt::Write::write_fmt(text, written);
}
