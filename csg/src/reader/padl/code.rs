//! Expressions as steps of a stack machine, so that they can be evaluated more than once.

use std::ops::Range;
use std::rc::Rc;

use premio_kernel::number::rational::Rational;

use super::expression::Operator;
use super::keywords::{Construction, Function, Outline, Shape};
use crate::tree::Operation;

/// A step of an evaluation. Operands are taken from the stack, and the result is pushed.
#[derive(Debug)]
pub(super) enum Step {
    Number(Rational),
    /// The value of a name, by its index.
    Global(usize),
    /// The value of a parameter or a loop variable, by its slot.
    Local(usize),
    Pi,
    Empty,
    Negate,
    Apply(Operator),
    /// A function of a number of arguments.
    Function(Function, usize),
    /// A primitive, with the indices of its arguments in the order written.
    Primitive(Shape, Box<[usize]>),
    /// Moves a solid, by the motions in the order written.
    Place(Box<[usize]>),
    /// The result is the whole span, which has brackets around it.
    Group,
    Call(Box<Call>),
    Begin(Box<LoopStart>),
    /// Joins what a loop gives to what is before the loop.
    Join(Joining),
    /// A figure or a solid of a figure, with the indices of its arguments in the order written.
    Construct(Construction, Box<[usize]>),
    /// The convex hull of a number of operands.
    Hull(usize),
    /// A list without tuples.
    List,
    /// A tuple of numbers, by their counts between semicolons.
    Tuple(Box<[usize]>),
    /// Begins the second or a later part of a list.
    Separate,
    /// What a list describes.
    Outline(Outline),
    /// Continues at a step with the next number of the innermost loop, if there is one.
    Next(usize),
    /// Continues at a step if an argument was given for a parameter.
    SkipIfGiven(usize, usize),
    /// Sets a parameter to its default.
    Store(usize),
}

/// A step and its place in the text.
#[derive(Debug)]
pub(super) struct Instruction {
    pub(super) step: Step,
    pub(super) span: Range<usize>,
}

/// The steps of an expression.
pub(super) type Code = Rc<[Instruction]>;

/// The use of a part with parameters.
#[derive(Debug)]
pub(super) struct Call {
    pub(super) part: Rc<ParametricPart>,
    /// The slots of the arguments, in the order written.
    pub(super) arguments: Vec<usize>,
}

/// How a loop joins what it gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Joining {
    Set(Operation),
    /// Tuples are appended to a list.
    Append,
}

/// The start of a loop.
#[derive(Debug)]
pub(super) struct LoopStart {
    pub(super) variable: Rc<str>,
    pub(super) slot: usize,
    pub(super) has_step: bool,
    pub(super) joining: Joining,
    /// The index of the step after the loop.
    pub(super) exit: usize,
}

/// A part with parameters.
#[derive(Debug)]
pub(super) struct ParametricPart {
    pub(super) name: Rc<str>,
    pub(super) parameters: Vec<Parameter>,
    /// The index of its body.
    pub(super) body: usize,
}

/// The value of a part with parameters. The parts in it are known by their index, so that a long
/// chain of parts is dropped without recursion.
#[derive(Debug)]
pub(super) struct PartBody {
    /// The number of parameters and loop variables.
    pub(super) slots: usize,
    pub(super) code: Code,
}

/// A parameter.
#[derive(Debug)]
pub(super) struct Parameter {
    pub(super) name: Rc<str>,
    pub(super) has_default: bool,
}
