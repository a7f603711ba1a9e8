//! The evaluation of expressions. Loops and uses of parts with parameters are on an explicit stack.

use std::ops::Range;
use std::rc::Rc;

use premio_kernel::number::rational::{Rational, bits, from_f64};

use super::super::error::SpannedError;
use super::super::number::{check_length, show};
use super::super::spanned::Spanned;
use super::budget::Budget;
use super::code::{Call, Code, Instruction, Joining, LoopStart, ParametricPart, PartBody, Step};
use super::expression::{ListValue, Operand, Operator, Value, apply, negate};
use super::functions::{self, FunctionValue};
use super::keywords::{Function, Shape, operation_word};
use super::primitives::{PLANE_MOTIONS, not_in_plane, primitive, push_motion};
use super::remarks::Remarks;
use crate::builder::{Builder, SolidId};
use crate::transform::Transform;
use crate::tree::Operation;

/// A loop or a use of a part that is being evaluated.
#[derive(Debug)]
pub(super) enum Activity {
    Loop {
        variable: Rc<str>,
        slot: usize,
        number: Rational,
        step: Rational,
        /// The number of rounds after this one.
        remaining: u64,
        span: Range<usize>,
    },
    Call {
        part: Rc<ParametricPart>,
        span: Range<usize>,
        /// The caller's slots, and where it continues.
        base: usize,
        resume: Option<Position>,
    },
}

impl Activity {
    fn span(&self) -> &Range<usize> {
        match self {
            Self::Loop { span, .. } | Self::Call { span, .. } => span,
        }
    }
}

/// A position in the steps of an expression.
#[derive(Debug, Clone)]
pub(super) struct Position {
    code: Code,
    next: usize,
}

/// Where the evaluation continues.
enum Flow {
    Next,
    Jump(usize),
    Enter(Code),
}

/// The state of an evaluation.
#[derive(Debug, Default)]
pub(super) struct Machine {
    pub(super) builder: Builder,
    /// The values of names, by their index.
    pub(super) globals: Vec<Value>,
    /// The values of parts with parameters, by their index.
    pub(super) bodies: Vec<PartBody>,
    pub(super) remarks: Remarks,
    stack: Vec<Operand>,
    /// Parameters and loop variables of all uses of parts, one after another.
    locals: Vec<Option<Value>>,
    /// The first slot of the current use.
    base: usize,
    activities: Vec<Activity>,
    pub(super) budget: Budget,
}

impl Machine {
    /// The loops and uses of parts that are being evaluated.
    pub(super) fn activities(&self) -> &[Activity] {
        &self.activities
    }

    /// The value of an expression that was evaluated, if there is one.
    pub(super) fn take_result(&mut self) -> Option<Operand> {
        self.locals.clear();
        self.stack.pop()
    }

    /// Evaluates a step outside of recorded code.
    pub(super) fn evaluate(&mut self, instruction: &Instruction) -> Result<(), SpannedError> {
        match self.step(instruction)? {
            Flow::Enter(code) => self.run(code),
            Flow::Next | Flow::Jump(_) => Ok(()),
        }
    }

    /// Evaluates recorded code.
    pub(super) fn run(&mut self, code: Code) -> Result<(), SpannedError> {
        let mut at = Position { code, next: 0 };
        'code: loop {
            let code = Rc::clone(&at.code);
            while let Some(instruction) = code.get(at.next) {
                at.next += 1;
                self.count(instruction)?;
                match self.step(instruction)? {
                    Flow::Next => {}
                    Flow::Jump(next) => at.next = next,
                    Flow::Enter(code) => {
                        let inner = Position { code, next: 0 };
                        let outer = std::mem::replace(&mut at, inner);
                        if let Some(Activity::Call { resume, .. }) = self.activities.last_mut() {
                            *resume = Some(outer);
                        }
                        continue 'code;
                    }
                }
            }
            match self.leave() {
                Some(resume) => at = resume,
                None => return Ok(()),
            }
        }
    }

    /// Counts a step of a loop or a part with parameters.
    fn count(&mut self, instruction: &Instruction) -> Result<(), SpannedError> {
        let place = self.activities.first().map(Activity::span);
        let place = place.unwrap_or(&instruction.span);
        match instruction.step {
            Step::Primitive(..) | Step::Place(_) | Step::Join(Joining::Set(_)) => {
                self.budget.count_solid(place)
            }
            Step::Apply(Operator::Set(_)) => self.budget.count_solid(place),
            Step::Construct(..) | Step::Hull(_) | Step::Outline(_) => {
                self.budget.count_solid(place)
            }
            _ => self.budget.count_step(place),
        }
    }

    fn step(&mut self, instruction: &Instruction) -> Result<Flow, SpannedError> {
        let span = &instruction.span;
        match &instruction.step {
            Step::Begin(start) => return self.begin(start, span),
            Step::Next(start) => return Ok(self.next_round(*start)),
            Step::SkipIfGiven(slot, after) => {
                let is_given = self.local(*slot).is_some();
                return Ok(if is_given {
                    Flow::Jump(*after)
                } else {
                    Flow::Next
                });
            }
            Step::Call(call) => return Ok(self.enter(call, span)),
            Step::Number(number) => self.push(Value::Number(number.clone()), span),
            Step::Empty => self.push(Value::Solid(SolidId::EMPTY), span),
            Step::Global(index) => {
                let value = self.globals.get(*index).cloned();
                self.push(value.unwrap_or(Value::Solid(SolidId::EMPTY)), span);
            }
            Step::Local(slot) => {
                let value = self.local(*slot).cloned();
                self.push(value.unwrap_or(Value::Solid(SolidId::EMPTY)), span);
            }
            Step::Store(slot) => {
                let value = self.pop(span).value;
                self.set_local(*slot, value);
            }
            Step::Group => {
                let value = self.pop(span).value;
                self.push(value, span);
            }
            Step::Pi | Step::Negate | Step::Function(..) => self.number_step(instruction)?,
            Step::Apply(_) | Step::Join(_) | Step::Primitive(..) | Step::Place(_) => {
                self.solid_step(instruction)?;
            }
            Step::Construct(construction, arguments) => {
                self.construct(*construction, arguments, span)?;
            }
            Step::Hull(count) => self.hull(*count, span)?,
            Step::List => self.push(Value::List(ListValue::new()), span),
            Step::Tuple(counts) => self.tuple(counts, span)?,
            Step::Separate => self.separate(),
            Step::Outline(outline) => self.outline(*outline, span)?,
        }
        Ok(Flow::Next)
    }

    fn number_step(&mut self, instruction: &Instruction) -> Result<(), SpannedError> {
        let span = &instruction.span;
        match instruction.step {
            Step::Pi => self.push_value(functions::pi(), "pi", span)?,
            Step::Negate => {
                let operand = negate(self.pop(span))?;
                self.stack.push(operand);
            }
            Step::Function(function, count) => self.function(function, count, span)?,
            _ => {}
        }
        Ok(())
    }

    fn solid_step(&mut self, instruction: &Instruction) -> Result<(), SpannedError> {
        let span = &instruction.span;
        match &instruction.step {
            Step::Apply(operator) => {
                let (right, left) = (self.pop(span), self.pop(span));
                if let Operator::Set(operation) = operator {
                    let word = operation_word(*operation);
                    let sides = ["before", "after"].map(|side| format!("{side} `{word}`"));
                    let whole = left.span.start..right.span.end;
                    let value = self.combine(*operation, [left, right], &sides, &whole)?;
                    self.push(value, &whole);
                    return Ok(());
                }
                let result = apply(*operator, left, right)?;
                if let Value::Number(number) = &result.value {
                    self.budget.count_bits(bits(number));
                }
                self.stack.push(result);
            }
            Step::Join(Joining::Append) => self.append(span)?,
            Step::Join(Joining::Set(operation)) => {
                let (right, left) = (self.pop(span), self.pop(span));
                let sides = ["before `FOR`", "after `FOR`"].map(str::to_owned);
                let value = self.combine(*operation, [left, right], &sides, span)?;
                self.push(value, span);
            }
            Step::Primitive(shape, arguments) => self.primitive(*shape, arguments, span)?,
            Step::Place(motions) => self.place(motions, span)?,
            _ => {}
        }
        Ok(())
    }

    /// A set operation on solids, or on figures.
    fn combine(
        &mut self,
        operation: Operation,
        [left, right]: [Operand; 2],
        [before, after]: &[String; 2],
        span: &Range<usize>,
    ) -> Result<Value, SpannedError> {
        if left.is_figure() || right.is_figure() {
            let right = right.figure(after)?;
            return self.combine_figures(operation, left.figure(before)?, right, span);
        }
        let right = right.solid(after)?;
        let parts = [left.solid(before)?, right];
        Ok(Value::Solid(self.builder.operation(operation, &parts)))
    }

    fn primitive(
        &mut self,
        shape: Shape,
        arguments: &[usize],
        span: &Range<usize>,
    ) -> Result<(), SpannedError> {
        let values = self.pop_many(arguments.len());
        let arguments = arguments.iter().copied().zip(values);
        let primitive = primitive(shape, arguments, span)?;
        let solid = self.builder.primitive(primitive);
        self.push(Value::Solid(solid), span);
        Ok(())
    }

    fn place(&mut self, motions: &[usize], span: &Range<usize>) -> Result<(), SpannedError> {
        let values = self.pop_many(motions.len());
        let operand = self.pop(span);
        let start = operand.span.start;
        let is_plane = operand.is_figure();
        let mut moves = Transform::new();
        for (&motion, value) in motions.iter().zip(values) {
            if is_plane && !PLANE_MOTIONS.contains(&motion) {
                return Err(not_in_plane(motion, value.span));
            }
            let bits = push_motion(&mut moves, motion, value)?;
            self.budget.count_bits(bits);
        }
        let place = start..span.end;
        let value = match is_plane {
            true => self.move_figure(operand.figure("before `AT`")?, &moves, &place)?,
            false => {
                let solid = operand.solid("before `AT`")?;
                Value::Solid(self.builder.moved(solid, moves))
            }
        };
        self.push(value, &place);
        Ok(())
    }

    fn function(
        &mut self,
        function: Function,
        count: usize,
        span: &Range<usize>,
    ) -> Result<(), SpannedError> {
        let what_for = format!("for `{}`", function.word());
        let mut numbers = Vec::with_capacity(count);
        for operand in self.pop_many(count) {
            let place = operand.span.clone();
            numbers.push((operand.number(&what_for)?, place));
        }
        let numbers = numbers.into_iter();
        let least = |a: (Rational, Range<usize>), b: (Rational, Range<usize>)| {
            if (b.0 < a.0) == (function == Function::Minimum) {
                b
            } else {
                a
            }
        };
        let Some((argument, place)) = numbers.reduce(least) else {
            return Ok(());
        };
        self.budget.count_function(bits(&argument));
        let value = functions::value(function, &argument, &place)?;
        self.push_value(value, function.word(), span)
    }

    /// Pushes a value; one that is rounded is remarked on.
    fn push_value(
        &mut self,
        value: FunctionValue,
        word: &str,
        span: &Range<usize>,
    ) -> Result<(), SpannedError> {
        let number = match value {
            FunctionValue::Exact(number) => number,
            FunctionValue::Nearest(nearest) => {
                self.remarks.add_rounded(word, nearest, span);
                from_f64(nearest).ok_or_else(|| {
                    let found = format!("a value of `{word}` beyond the range of f64");
                    SpannedError::limit(span.clone(), found, "a value of at most 1.8e308")
                })?
            }
        };
        let number = check_length(number, span.clone())?;
        self.push(Value::Number(number), span);
        Ok(())
    }

    /// Starts a loop after the numbers of its range.
    fn begin(&mut self, start: &LoopStart, span: &Range<usize>) -> Result<Flow, SpannedError> {
        let step = match start.has_step {
            true => whole(self.pop(span), "for the step")?,
            false => Spanned::new(Rational::ONE, span.clone()),
        };
        let last = whole(self.pop(span), "for the end of the range")?;
        let first = whole(self.pop(span), "for the start of the range")?;
        if step.value.is_zero() {
            let expected = "a step other than zero";
            return Err(SpannedError::input(step.span, "the number 0", expected));
        }
        if let (Joining::Set(operation), Some(before)) = (start.joining, self.stack.last())
            && let Value::Number(_) = before.value
        {
            let word = operation_word(operation);
            before.clone().solid(&format!("before `{word}`"))?;
        }
        let range = first.span.start..step.span.end.max(last.span.end);
        let rounds = ((&last.value - &first.value) / &step.value).floor();
        let rounds = Rational::from(rounds) + Rational::ONE;
        if rounds <= Rational::ZERO {
            self.remarks.add_empty(&first.value, &last.value, &range);
            return Ok(Flow::Jump(start.exit));
        }
        let rounds = u64::try_from(rounds.numerator()).ok();
        let rounds = Budget::check_rounds(rounds, &range)?;
        self.set_local(start.slot, Value::Number(first.value.clone()));
        self.activities.push(Activity::Loop {
            variable: Rc::clone(&start.variable),
            slot: start.slot,
            number: first.value,
            step: step.value,
            remaining: rounds - 1,
            span: span.clone(),
        });
        Ok(Flow::Next)
    }

    /// Continues the innermost loop at its first step, or ends it.
    fn next_round(&mut self, first: usize) -> Flow {
        let Some(Activity::Loop {
            slot,
            number,
            step,
            remaining,
            ..
        }) = self.activities.last_mut()
        else {
            return Flow::Next;
        };
        if *remaining == 0 {
            self.activities.pop();
            return Flow::Next;
        }
        *remaining -= 1;
        *number += &*step;
        let (slot, number) = (*slot, number.clone());
        self.set_local(slot, Value::Number(number));
        Flow::Jump(first)
    }

    /// Enters a part with parameters.
    fn enter(&mut self, call: &Call, span: &Range<usize>) -> Flow {
        let values = self.pop_many(call.arguments.len());
        let Some(body) = self.bodies.get(call.part.body) else {
            return Flow::Next;
        };
        let (slots, code) = (body.slots, Rc::clone(&body.code));
        let base = std::mem::replace(&mut self.base, self.locals.len());
        self.locals.resize(self.base + slots, None);
        for (&slot, operand) in call.arguments.iter().zip(values) {
            self.set_local(slot, operand.value);
        }
        self.activities.push(Activity::Call {
            part: Rc::clone(&call.part),
            span: span.clone(),
            base,
            resume: None,
        });
        Flow::Enter(code)
    }

    /// Leaves the innermost part; returns where its user continues, if that is recorded code.
    fn leave(&mut self) -> Option<Position> {
        let is_call = matches!(self.activities.last(), Some(Activity::Call { .. }));
        let Some(Activity::Call {
            span, base, resume, ..
        }) = self.activities.pop_if(|_| is_call)
        else {
            return None;
        };
        self.locals.truncate(self.base);
        self.base = base;
        let value = self.pop(&span).value;
        self.push(value, &span);
        resume
    }

    fn local(&self, slot: usize) -> Option<&Value> {
        self.locals.get(self.base + slot).and_then(Option::as_ref)
    }

    fn set_local(&mut self, slot: usize, value: Value) {
        let index = self.base + slot;
        if index >= self.locals.len() {
            self.locals.resize(index + 1, None);
        }
        if let Some(place) = self.locals.get_mut(index) {
            *place = Some(value);
        }
    }

    /// The last value, if it is a list.
    pub(super) fn list_on_top(&mut self) -> Option<&mut ListValue> {
        match self.stack.last_mut().map(|operand| &mut operand.value) {
            Some(Value::List(list)) => Some(list),
            _ => None,
        }
    }

    pub(super) fn push(&mut self, value: Value, span: &Range<usize>) {
        let span = span.clone();
        self.stack.push(Operand { value, span });
    }

    /// The last operand. The parser leaves one for every step that takes one.
    pub(super) fn pop(&mut self, span: &Range<usize>) -> Operand {
        self.stack.pop().unwrap_or_else(|| Operand {
            value: Value::Solid(SolidId::EMPTY),
            span: span.clone(),
        })
    }

    /// The last operands, in order.
    pub(super) fn pop_many(&mut self, count: usize) -> Vec<Operand> {
        self.stack.split_off(self.stack.len().saturating_sub(count))
    }
}

/// A whole number of a range.
fn whole(operand: Operand, what_for: &str) -> Result<Spanned<Rational>, SpannedError> {
    let span = operand.span.clone();
    let value = operand.number(what_for)?;
    if !value.is_int() {
        let found = show(&value).replacen("the value", "the number", 1);
        let expected = format!("a whole number {what_for}");
        return Err(SpannedError::input(span, found, expected));
    }
    Ok(Spanned::new(value, span))
}
