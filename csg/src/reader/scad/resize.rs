//! `resize`: new sizes as factors.

use premio_kernel::number::rational::{Rational, from_decimal, to_f64};

use super::super::error::SpannedError;
use super::arguments::{Arguments, Value};

/// The new sizes along the axes: up to three, filled up with zeros.
pub(super) fn sizes(arguments: &Arguments) -> Result<[Rational; 3], SpannedError> {
    let items = arguments
        .require("newsize")?
        .items("a list of up to three numbers")?;
    let mut all: [Rational; 3] = Default::default();
    for (x, item) in all.iter_mut().zip(items) {
        *x = item.number()?.clone();
    }
    Ok(all)
}

/// Which sizes of zero follow the others, by `auto`: one flag for all axes, or one each.
pub(super) fn automatic(arguments: &Arguments) -> Result<[bool; 3], SpannedError> {
    let Some(argument) = arguments.find("auto") else {
        return Ok([false; 3]);
    };
    let mut all = [false; 3];
    match &argument.value {
        Value::List(items) => {
            for (flag, item) in all.iter_mut().zip(items) {
                *flag = match &item.value {
                    Value::Number(number) => !number.is_zero(),
                    _ => item.bool()?,
                };
            }
        }
        _ => all = [argument.bool()?; 3],
    }
    Ok(all)
}

/// The factors that give a box new sizes. A size of zero keeps the axis, or with `auto` scales it
/// as the axis that grows most.
pub(super) fn factors(sizes: &[Rational; 3], auto: &[bool; 3], extent: &[f64]) -> [Rational; 3] {
    let own = |i: usize| {
        // The size is rounded to its digits, so that equal ones are equal.
        let size = extent.get(i).copied().filter(|x| *x > 0.0);
        let size = size.and_then(|x| from_decimal(&format!("{x:.11e}")).ok());
        let size = size.filter(|_| !sizes[i].is_zero());
        size.map(|size| &sizes[i] / size)
    };
    let most = (0..3)
        .filter_map(own)
        .max_by(|a, b| to_f64(a).total_cmp(&to_f64(b)));
    std::array::from_fn(|i| {
        let automatic = most.clone().filter(|_| auto[i] && sizes[i].is_zero());
        own(i).or(automatic).unwrap_or(Rational::ONE)
    })
}
