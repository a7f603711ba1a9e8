//! Closed forms as text, so that a hand-derived answer is a formula and not a number that might
//! have been copied from an output.
//!
//! A definition is `name = expression`, `name(a, b) = expression`, or
//! `name = integral(x, from, to, expression)`. Expressions are those of the `exmex` crate: `+ - * /
//! ^`, `sqrt`, `sin`, `asin`, `acos`, `atan` and so on, and `PI`. A definition may use all earlier
//! ones. Numbers have no exponent: 1e-7 is written 0.0000001.

use exmex::{Express, FlatEx};
use std::f64::consts::FRAC_PI_2;

/// The definitions so far.
#[derive(Clone, Debug, Default)]
pub struct Definitions {
    values: Vec<(String, f64)>,
    functions: Vec<Function>,
}

#[derive(Clone, Debug)]
struct Function {
    name: String,
    parameters: Vec<String>,
    body: String,
}

impl Definitions {
    /// Takes a definition in.
    ///
    /// # Errors
    /// The text is not a definition, or its expression cannot be evaluated.
    pub fn define(&mut self, text: &str) -> Result<(), String> {
        let (left, right) = text
            .split_once('=')
            .ok_or_else(|| format!("no definition: {text}"))?;
        let (left, right) = (left.trim(), right.trim());
        if let Some((name, rest)) = left.split_once('(') {
            let parameters = arguments(rest)?.0;
            let body = self.expand(right)?;
            self.functions.push(Function {
                name: name.trim().to_owned(),
                parameters,
                body,
            });
            return Ok(());
        }
        let value = match right.strip_prefix("integral(") {
            Some(rest) => self.integral(rest)?,
            None => self.value(right)?,
        };
        self.values.push((left.to_owned(), value));
        Ok(())
    }

    /// The value of an expression.
    ///
    /// # Errors
    /// The expression cannot be evaluated.
    pub fn value(&self, text: &str) -> Result<f64, String> {
        self.compiled(text, None)?(0.0)
    }

    fn integral(&self, text: &str) -> Result<f64, String> {
        let (parts, _) = arguments(text)?;
        let [x, from, to, integrand] = parts.as_slice() else {
            return Err(format!("an integral of {} parts: {text}", parts.len()));
        };
        let f = self.compiled(integrand, Some(x))?;
        let found = integrate(&f, self.value(from)?, self.value(to)?);
        found.ok_or_else(|| format!("does not converge: {text}"))
    }

    /// An expression as a function of one more variable.
    fn compiled(
        &self,
        text: &str,
        variable: Option<&str>,
    ) -> Result<impl Fn(f64) -> Result<f64, String>, String> {
        let expanded = self.expand(text)?;
        let parsed =
            FlatEx::<f64>::parse(&expanded).map_err(|e| format!("{expanded}: {}", e.msg()))?;
        let mut values = Vec::new();
        let mut free = Vec::new();
        for (i, name) in parsed.var_names().iter().enumerate() {
            let known = self.values.iter().rfind(|(n, _)| n == name);
            match known {
                _ if Some(name.as_str()) == variable => free.push(i),
                Some((_, value)) => {
                    values.push(*value);
                    continue;
                }
                None => return Err(format!("{name} is not defined: {text}")),
            }
            values.push(0.0);
        }
        Ok(move |x: f64| {
            let mut all = values.clone();
            for &i in &free {
                all[i] = x;
            }
            parsed.eval(&all).map_err(|e| e.msg().to_owned())
        })
    }

    /// Writes the bodies of functions in place of their calls.
    fn expand(&self, text: &str) -> Result<String, String> {
        let mut out = String::new();
        let mut rest = text;
        while !rest.is_empty() {
            let word = |c: char| c.is_alphanumeric() || c == '_';
            let length = rest.find(|c| !word(c)).unwrap_or(rest.len());
            let (name, after) = rest.split_at(length);
            let called = self.functions.iter().rfind(|f| f.name == name);
            if let (Some(function), Some(inside)) = (called, after.strip_prefix('(')) {
                let (given, remainder) = arguments(inside)?;
                let given: Result<Vec<String>, String> =
                    given.iter().map(|a| self.expand(a)).collect();
                out += &function.call(&given?)?;
                rest = remainder;
            } else if length > 0 {
                out += name;
                rest = after;
            } else {
                let mut letters = rest.chars();
                out.extend(letters.next());
                rest = letters.as_str();
            }
        }
        Ok(out)
    }
}

impl Function {
    fn call(&self, given: &[String]) -> Result<String, String> {
        if given.len() != self.parameters.len() {
            return Err(format!("{} takes {:?}", self.name, self.parameters));
        }
        let mut out = String::from("(");
        let word = |c: char| c.is_alphanumeric() || c == '_';
        let mut rest = self.body.as_str();
        while let Some(first) = rest.chars().next() {
            let length = rest.find(|c| !word(c)).unwrap_or(rest.len());
            let (name, after) = rest.split_at(length.max(first.len_utf8()));
            match self.parameters.iter().position(|p| p == name) {
                Some(i) => out += &format!("({})", given[i]),
                None => out += name,
            }
            rest = after;
        }
        Ok(out + ")")
    }
}

/// The arguments of a call, from behind its opening bracket, and what follows the closing one.
fn arguments(text: &str) -> Result<(Vec<String>, &str), String> {
    let mut found = Vec::new();
    let (mut depth, mut start) = (0, 0);
    for (i, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ',' | ')' if depth == 0 => {
                found.push(text[start..i].trim().to_owned());
                start = i + 1;
                if c == ')' {
                    return Ok((found, &text[start..]));
                }
            }
            ')' => depth -= 1,
            _ => {}
        }
    }
    Err(format!("a bracket is open: {text}"))
}

/// The integral of a function that is smooth except at its ends (Takahasi and Mori 1974). The
/// substitution x = tanh(pi/2 sinh t) makes the trapezoidal rule exact to nearly all digits.
pub fn integrate(f: &impl Fn(f64) -> Result<f64, String>, from: f64, to: f64) -> Option<f64> {
    let half = 0.5 * (to - from);
    let term = |t: f64| -> f64 {
        let s = FRAC_PI_2 * t.sinh();
        // The distance from the closer end, relative to half the interval.
        let gap = 1.0 / (s.abs().exp() * s.cosh());
        let x = if s < 0.0 {
            from + half * gap
        } else {
            to - half * gap
        };
        let weight = FRAC_PI_2 * t.cosh() / s.cosh().powi(2);
        match f(x) {
            Ok(y) if y.is_finite() => weight * y,
            // Rounding may lead past an end, where the weight is zero.
            _ if weight < 1e-9 => 0.0,
            _ => f64::NAN,
        }
    };
    let reach = 3.4;
    let mut previous = f64::NAN;
    let mut step = 0.25;
    for _ in 0..8 {
        let n = (reach / step) as i32;
        let sum: f64 = (-n..=n).map(|k| term(f64::from(k) * step)).sum();
        let value = sum * step * half;
        // The remaining difference is the integrand's rounding.
        if (value - previous).abs() <= 1e-12 * value.abs() + 1e-14 {
            return Some(value);
        }
        (previous, step) = (value, 0.5 * step);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn value(definitions: &[&str], text: &str) -> f64 {
        let mut all = Definitions::default();
        for d in definitions {
            all.define(d).expect(d);
        }
        all.value(text).expect(text)
    }

    #[test]
    fn expressions() {
        assert_eq!(value(&["r = 3"], "2 * r^2 - 1/4"), 17.75);
        assert_eq!(
            value(&["f(a, b) = a - 2*b", "g(a) = f(a, -a)"], "g(1 + 1) / 2"),
            3.0
        );
        assert_eq!(value(&[], "0.25 * 10^2"), 25.0);
        assert!((value(&[], "4/3 * PI") - 4.0 / 3.0 * PI).abs() < 1e-15);
    }

    #[test]
    fn integrals() {
        let near = |definition: &str, expected: f64| {
            let found = value(&[definition], "v");
            assert!((found - expected).abs() < 1e-13, "{found} for {expected}");
        };
        near("v = integral(x, 0, 1, x^3)", 0.25);
        near("v = integral(x, -2, 2, sqrt(4 - x^2))", 2.0 * PI);
        near("v = integral(x, 0, 1, asin(x))", PI / 2.0 - 1.0);
    }

    #[test]
    fn what_is_not_defined_is_an_error() {
        let mut all = Definitions::default();
        assert!(all.define("a = b").is_err());
        assert!(all.define("a = integral(x, 0, 1)").is_err());
        assert!(all.define("a = (1").is_err());
        assert!(all.value("sqrt(").is_err());
    }
}
