//! Expressions as steps of a stack machine, so that they can be evaluated more than once.

use std::ops::Range;
use std::rc::Rc;

use premio_kernel::number::rational::Rational;

use super::expression::Operator;
use super::keywords::{Function, Shape};
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
    /// Joins a solid to the one before the loop.
    Join(Operation),
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

/// The start of a loop.
#[derive(Debug)]
pub(super) struct LoopStart {
    pub(super) variable: Rc<str>,
    pub(super) slot: usize,
    pub(super) has_step: bool,
    pub(super) operation: Operation,
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
