//! The clear text of ISO 10303-21, as far as this project writes it: instances with their
//! parameters.

use std::collections::HashMap;

/// A parameter of an instance.
#[derive(Clone, Debug, PartialEq)]
pub enum StepValue {
    /// A number, integral or not.
    Number(f64),
    /// Another instance.
    Instance(u32),
    /// A string, as written between its quotes.
    Text(String),
    /// A name between full stops.
    Enumeration(String),
    /// Values in parentheses.
    List(Vec<StepValue>),
    /// `$` or `*`.
    Absent,
}

/// An instance: its entity and parameters. A complex instance has several entities.
#[derive(Clone, Debug, PartialEq)]
pub struct StepInstance {
    /// The entities with their parameters.
    pub parts: Vec<StepEntity>,
}

/// An entity of an instance.
#[derive(Clone, Debug, PartialEq)]
pub struct StepEntity {
    pub name: String,
    /// The parameters.
    pub values: Vec<StepValue>,
}

/// Why a file cannot be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepReadError {
    /// The text breaks the grammar.
    #[error("line {line}: found {found:?}, expected {expected}")]
    Grammar {
        /// The line, from 1.
        line: usize,
        /// What was found.
        found: String,
        /// What was expected.
        expected: &'static str,
    },
    /// An instance does not have the form of its entity.
    #[error("#{id}: expected {expected}")]
    Instance {
        /// The number of the instance.
        id: u32,
        /// What was expected.
        expected: &'static str,
    },
}

/// The instances of a file by their numbers.
pub type Instances = HashMap<u32, StepInstance>;

/// Reads the data section of a file.
pub fn read(text: &str) -> Result<Instances, StepReadError> {
    let mut instances = Instances::new();
    let data = text.lines().enumerate();
    for (number, line) in data.filter(|(_, line)| line.starts_with('#')) {
        let mut cursor = Cursor {
            line,
            at: 0,
            number,
        };
        let StepValue::Instance(id) = cursor.value()? else {
            return Err(cursor.error("the number of an instance"));
        };
        cursor.take('=', "`=`")?;
        let instance = cursor.instance()?;
        cursor.take(';', "`;`")?;
        if instances.insert(id, instance).is_some() {
            let expected = "no second instance of this number";
            return Err(StepReadError::Instance { id, expected });
        }
    }
    Ok(instances)
}

/// A position in a line.
struct Cursor<'t> {
    line: &'t str,
    at: usize,
    number: usize,
}

impl Cursor<'_> {
    fn rest(&self) -> &str {
        &self.line[self.at..]
    }

    fn error(&self, expected: &'static str) -> StepReadError {
        StepReadError::Grammar {
            line: self.number + 1,
            found: self.rest().chars().take(12).collect(),
            expected,
        }
    }

    fn take(&mut self, c: char, expected: &'static str) -> Result<(), StepReadError> {
        match self.rest().starts_with(c) {
            true => {
                self.at += c.len_utf8();
                Ok(())
            }
            false => Err(self.error(expected)),
        }
    }

    /// The characters up to the first that is not of a kind.
    fn while_is(&mut self, is: impl Fn(char) -> bool) -> String {
        let rest = self.rest();
        let end = rest.find(|c| !is(c)).unwrap_or(rest.len());
        let taken = rest[..end].to_owned();
        self.at += end;
        taken
    }

    fn instance(&mut self) -> Result<StepInstance, StepReadError> {
        let mut parts = Vec::new();
        if !self.rest().starts_with('(') {
            parts.push(self.part()?);
            return Ok(StepInstance { parts });
        }
        self.take('(', "`(`")?;
        while !self.rest().starts_with(')') {
            parts.push(self.part()?);
        }
        self.take(')', "`)`")?;
        Ok(StepInstance { parts })
    }

    fn part(&mut self) -> Result<StepEntity, StepReadError> {
        let name = self.while_is(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
        if name.is_empty() {
            return Err(self.error("the name of an entity"));
        }
        match self.value()? {
            StepValue::List(values) => Ok(StepEntity { name, values }),
            _ => Err(self.error("parameters in brackets")),
        }
    }

    fn value(&mut self) -> Result<StepValue, StepReadError> {
        let Some(first) = self.rest().chars().next() else {
            return Err(self.error("a value"));
        };
        match first {
            '(' => self.list(),
            '#' => {
                self.at += 1;
                let digits = self.while_is(|c| c.is_ascii_digit());
                let id = digits.parse().map_err(|_| self.error("a number"))?;
                Ok(StepValue::Instance(id))
            }
            '\'' => self.text(),
            '.' => {
                self.at += 1;
                let name = self.while_is(|c| c.is_ascii_alphanumeric() || c == '_');
                self.take('.', "`.`")?;
                Ok(StepValue::Enumeration(name))
            }
            '$' | '*' => {
                self.at += 1;
                Ok(StepValue::Absent)
            }
            'A'..='Z' => {
                // A typed value is replaced by its value.
                let mut values = self.part()?.values;
                values.pop().ok_or_else(|| self.error("a value"))
            }
            _ => {
                let is_part = |c: char| c.is_ascii_digit() || "+-.E".contains(c);
                let digits = self.while_is(is_part);
                let number = digits.parse().map_err(|_| self.error("a number"))?;
                Ok(StepValue::Number(number))
            }
        }
    }

    fn list(&mut self) -> Result<StepValue, StepReadError> {
        self.take('(', "`(`")?;
        let mut values = Vec::new();
        while !self.rest().starts_with(')') {
            if !values.is_empty() {
                self.take(',', "`,` or `)`")?;
            }
            values.push(self.value()?);
        }
        self.take(')', "`)`")?;
        Ok(StepValue::List(values))
    }

    fn text(&mut self) -> Result<StepValue, StepReadError> {
        let mut text = String::new();
        loop {
            self.take('\'', "a string")?;
            text += &self.while_is(|c| c != '\'');
            self.take('\'', "the end of a string")?;
            // Two quotes represent one in the string.
            if !self.rest().starts_with('\'') {
                return Ok(StepValue::Text(text));
            }
            text.push('\'');
        }
    }
}
