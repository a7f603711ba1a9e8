//! The functions of numbers in `.padl`: exact where the value is rational, otherwise the nearest
//! f64.

use std::cmp::Ordering;
use std::ops::Range;

use premio_kernel::number::extended::F237;
use premio_kernel::number::float::Float;
use premio_kernel::number::rational::{Rational, exact_sqrt};

use super::super::error::SpannedError;
use super::super::number::show;
use super::keywords::Function;

/// A value of a function.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum FunctionValue {
    Exact(Rational),
    /// The nearest f64 to an irrational value.
    Nearest(f64),
}

/// Why a function has no value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum UndefinedValue {
    NegativeRadicand,
    Pole,
}

/// The value of a function of one argument.
pub(super) fn value(
    function: Function,
    argument: &Rational,
    span: &Range<usize>,
) -> Result<FunctionValue, SpannedError> {
    let value = match function {
        Function::Sine => Ok(sine(argument)),
        Function::Cosine => Ok(sine(&(argument + Rational::from(90)))),
        Function::Tangent => tangent(argument),
        Function::SquareRoot => square_root(argument),
        Function::Minimum | Function::Maximum => Ok(FunctionValue::Exact(argument.clone())),
    };
    let word = function.word();
    value.map_err(|undefined| {
        let expected = match undefined {
            UndefinedValue::NegativeRadicand => "a number of zero or more",
            UndefinedValue::Pole => "an angle other than 90 degrees and its odd multiples",
        };
        let found = format!("{} in `{word}`", show(argument));
        SpannedError::input(span.clone(), found, expected)
    })
}

/// The number pi.
pub(super) fn pi() -> FunctionValue {
    nearest(F237::PI)
}

fn nearest(value: F237) -> FunctionValue {
    FunctionValue::Nearest(value.rounded())
}

/// An angle from 0 to 360 degrees.
fn reduced(degrees: &Rational) -> Rational {
    let turn = Rational::from(360);
    let turns = Rational::from((degrees / &turn).floor());
    degrees - turns * turn
}

/// The sine of an angle from 0 to 90 degrees.
fn acute_sine(degrees: &Rational) -> F237 {
    let radians = |degrees: &Rational| F237::nearest(degrees) * F237::PI / F237::from_f64(180.0);
    match *degrees <= Rational::from(45) {
        true => radians(degrees).sin(),
        false => radians(&(Rational::from(90) - degrees)).cos(),
    }
}

/// An angle from 0 to 90 degrees with the same sine but for the sign.
struct AcuteAngle {
    degrees: Rational,
    is_negative: bool,
}

impl AcuteAngle {
    fn of_sine(degrees: &Rational) -> Self {
        let mut degrees = reduced(degrees);
        let half = Rational::from(180);
        let is_negative = degrees > half;
        if is_negative {
            degrees -= &half;
        }
        if degrees > Rational::from(90) {
            degrees = half - degrees;
        }
        Self {
            degrees,
            is_negative,
        }
    }

    fn signed<T: std::ops::Neg<Output = T>>(&self, value: T) -> T {
        match self.is_negative {
            true => -value,
            false => value,
        }
    }

    /// The sine, if it is rational: by Niven's theorem at 0, 30 and 90 degrees only.
    fn exact_sine(&self) -> Option<Rational> {
        let degrees = [0, 30, 90].map(Rational::from);
        let at = degrees.iter().position(|known| *known == self.degrees)?;
        Some(self.signed(Rational::from_parts((at as i64).into(), 2u8.into())))
    }

    fn sine(&self) -> F237 {
        self.signed(acute_sine(&self.degrees))
    }
}

fn sine(degrees: &Rational) -> FunctionValue {
    let angle = AcuteAngle::of_sine(degrees);
    match angle.exact_sine() {
        Some(value) => FunctionValue::Exact(value),
        None => nearest(angle.sine()),
    }
}

fn tangent(degrees: &Rational) -> Result<FunctionValue, UndefinedValue> {
    let opposite = AcuteAngle::of_sine(degrees);
    let adjacent = AcuteAngle::of_sine(&(degrees + Rational::from(90)));
    let is_negative = opposite.is_negative != adjacent.is_negative;
    let signed = |n: i64| FunctionValue::Exact(Rational::from(if is_negative { -n } else { n }));
    if adjacent.degrees.is_zero() {
        return Err(UndefinedValue::Pole);
    }
    if opposite.degrees.is_zero() {
        return Ok(signed(0));
    }
    match opposite.degrees.cmp(&Rational::from(45)) {
        Ordering::Equal => Ok(signed(1)),
        _ => Ok(nearest(opposite.sine() / adjacent.sine())),
    }
}

fn square_root(radicand: &Rational) -> Result<FunctionValue, UndefinedValue> {
    if *radicand < Rational::ZERO {
        return Err(UndefinedValue::NegativeRadicand);
    }
    Ok(match exact_sqrt(radicand) {
        Some(root) => FunctionValue::Exact(root),
        None => nearest(F237::nearest(radicand).sqrt()),
    })
}
