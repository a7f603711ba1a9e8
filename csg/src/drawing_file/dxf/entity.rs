//! The groups and the entities of a DXF file.

use super::super::error::DrawingFileError;
use crate::figure::FigurePoint;
use premio_kernel::number::rational::{Rational, from_decimal};

/// A group code and its value.
pub(super) struct Group<'t> {
    pub code: i32,
    value: &'t str,
    /// The line of the value, from 1.
    line: usize,
}

/// The groups of a file, until its lines end.
pub(super) struct Groups<'t> {
    lines: std::iter::Enumerate<std::str::Lines<'t>>,
}

impl<'t> Groups<'t> {
    pub fn new(text: &'t str) -> Self {
        let lines = text.lines().enumerate();
        Self { lines }
    }
}

impl<'t> Iterator for Groups<'t> {
    type Item = Result<Group<'t>, DrawingFileError>;

    fn next(&mut self) -> Option<Self::Item> {
        let (index, code) = self.lines.next()?;
        let (_, value) = self.lines.next()?;
        let group = match code.trim().parse() {
            Ok(code) => Ok(Group {
                code,
                value: value.trim(),
                line: index + 2,
            }),
            Err(_) => Err(DrawingFileError::GroupCode {
                line: index + 1,
                found: code.trim().to_owned(),
            }),
        };
        Some(group)
    }
}

/// The number in a group.
#[derive(Clone, Copy)]
struct Value<'t> {
    text: &'t str,
    line: usize,
}

impl Value<'_> {
    fn number(self) -> Result<Rational, DrawingFileError> {
        from_decimal(self.text).map_err(|_| DrawingFileError::Number {
            line: self.line,
            found: self.text.to_owned(),
        })
    }
}

/// An entity: what stands between two groups of code 0. Its numbers are read when they are needed.
pub(super) struct Entity<'t> {
    pub kind: &'t str,
    /// The value of code 2.
    pub name: &'t str,
    pub layer: &'t str,
    line: usize,
    /// The values of codes 10 and 11, and of codes 20 and 21, in the order of the file.
    coordinates: [Vec<Value<'t>>; 2],
    /// The last value of each of [`SCALARS`].
    scalars: [Option<Value<'t>>; SCALARS.len()],
    /// The value of code 70.
    flags: Option<Value<'t>>,
}

/// The codes of single numbers: a radius or a ratio, two factors or anomalies, two angles.
const SCALARS: [i32; 5] = [40, 41, 42, 50, 51];

impl<'t> Entity<'t> {
    /// The entity that a group of code 0 begins.
    pub fn new(group: &Group<'t>) -> Self {
        Self {
            kind: group.value,
            name: "",
            layer: "",
            line: group.line,
            coordinates: [Vec::new(), Vec::new()],
            scalars: [None; SCALARS.len()],
            flags: None,
        }
    }

    pub fn add(&mut self, group: &Group<'t>) {
        let value = Value {
            text: group.value,
            line: group.line,
        };
        match group.code {
            2 => self.name = group.value,
            8 => self.layer = group.value,
            10 | 11 => self.coordinates[0].push(value),
            20 | 21 => self.coordinates[1].push(value),
            70 => self.flags = Some(value),
            code => {
                let index = SCALARS.iter().position(|scalar| *scalar == code);
                if let Some(index) = index {
                    self.scalars[index] = Some(value);
                }
            }
        }
    }

    /// The last number of a code, or a default.
    pub fn number(&self, code: i32, default: i32) -> Result<Rational, DrawingFileError> {
        let index = SCALARS.iter().position(|scalar| *scalar == code);
        let value = index.and_then(|index| self.scalars[index]);
        value.map_or_else(|| Ok(Rational::from(default)), Value::number)
    }

    pub fn point_count(&self) -> usize {
        let [x, y] = &self.coordinates;
        x.len().max(y.len())
    }

    pub fn point(&self, index: usize) -> Result<FigurePoint, DrawingFileError> {
        let [x, y] = self.coordinates.each_ref().map(|list| list.get(index));
        let (Some(x), Some(y)) = (x, y) else {
            return Err(DrawingFileError::Incomplete {
                line: self.line,
                entity: self.kind.to_owned(),
            });
        };
        Ok([x.number()?, y.number()?])
    }

    /// Whether the flags of a polyline say that it is closed.
    pub fn is_closed(&self) -> Result<bool, DrawingFileError> {
        let Some(flags) = self.flags else {
            return Ok(false);
        };
        let number: Option<i64> = flags.text.parse().ok();
        let number = number.ok_or_else(|| DrawingFileError::Number {
            line: flags.line,
            found: flags.text.to_owned(),
        })?;
        Ok(number & 1 == 1)
    }
}
