//! The clear text of ISO 10303-21, as far as the project writes it: instances with their parameters.

use std::collections::HashMap;

/// A parameter of an instance.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number, whole or not.
    Number(f64),
    /// Another instance.
    Instance(u32),
    /// A string, as it is written between its quotes.
    Text(String),
    /// A name between points.
    Enumeration(String),
    /// Values in brackets.
    List(Vec<Value>),
    /// `$` or `*`.
    Absent,
}

/// An instance: its entity and the parameters; of a complex instance every part with its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// The entities with their parameters.
    pub parts: Vec<(String, Vec<Value>)>,
}

/// What is wrong with a file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReadError {
    /// The text breaks the grammar.
    #[error("line {line}: found {found:?}, expected {expected}")]
    Grammar {
        /// The line, from 1.
        line: usize,
        /// What stands there.
        found: String,
        /// What should.
        expected: &'static str,
    },
    /// An instance has not what its entity has.
    #[error("#{id}: expected {expected}")]
    Instance {
        /// The number of the instance.
        id: u32,
        /// What it should be or have.
        expected: &'static str,
    },
}

/// The instances of a file by their numbers.
pub type Instances = HashMap<u32, Instance>;

/// Reads the data section of a file.
pub fn read(text: &str) -> Result<Instances, ReadError> {
    let mut instances = Instances::new();
    let data = text.lines().enumerate();
    for (number, line) in data.filter(|(_, line)| line.starts_with('#')) {
        let mut cursor = Cursor {
            line,
            at: 0,
            number,
        };
        let Value::Instance(id) = cursor.value()? else {
            return Err(cursor.error("the number of an instance"));
        };
        cursor.take('=', "`=`")?;
        let instance = cursor.instance()?;
        cursor.take(';', "`;`")?;
        if instances.insert(id, instance).is_some() {
            let expected = "no second instance of this number";
            return Err(ReadError::Instance { id, expected });
        }
    }
    Ok(instances)
}

/// A place in a line.
struct Cursor<'t> {
    line: &'t str,
    at: usize,
    number: usize,
}

impl Cursor<'_> {
    fn rest(&self) -> &str {
        &self.line[self.at..]
    }

    fn error(&self, expected: &'static str) -> ReadError {
        ReadError::Grammar {
            line: self.number + 1,
            found: self.rest().chars().take(12).collect(),
            expected,
        }
    }

    fn take(&mut self, c: char, expected: &'static str) -> Result<(), ReadError> {
        match self.rest().starts_with(c) {
            true => {
                self.at += c.len_utf8();
                Ok(())
            }
            false => Err(self.error(expected)),
        }
    }

    /// What comes while characters are of a kind.
    fn while_is(&mut self, is: impl Fn(char) -> bool) -> String {
        let rest = self.rest();
        let end = rest.find(|c| !is(c)).unwrap_or(rest.len());
        let taken = rest[..end].to_owned();
        self.at += end;
        taken
    }

    fn instance(&mut self) -> Result<Instance, ReadError> {
        let mut parts = Vec::new();
        if !self.rest().starts_with('(') {
            parts.push(self.part()?);
            return Ok(Instance { parts });
        }
        self.take('(', "`(`")?;
        while !self.rest().starts_with(')') {
            parts.push(self.part()?);
        }
        self.take(')', "`)`")?;
        Ok(Instance { parts })
    }

    fn part(&mut self) -> Result<(String, Vec<Value>), ReadError> {
        let name = self.while_is(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_');
        if name.is_empty() {
            return Err(self.error("the name of an entity"));
        }
        match self.value()? {
            Value::List(values) => Ok((name, values)),
            _ => Err(self.error("parameters in brackets")),
        }
    }

    fn value(&mut self) -> Result<Value, ReadError> {
        let Some(first) = self.rest().chars().next() else {
            return Err(self.error("a value"));
        };
        match first {
            '(' => self.list(),
            '#' => {
                self.at += 1;
                let digits = self.while_is(|c| c.is_ascii_digit());
                let id = digits.parse().map_err(|_| self.error("a number"))?;
                Ok(Value::Instance(id))
            }
            '\'' => self.text(),
            '.' => {
                self.at += 1;
                let name = self.while_is(|c| c.is_ascii_alphanumeric() || c == '_');
                self.take('.', "`.`")?;
                Ok(Value::Enumeration(name))
            }
            '$' | '*' => {
                self.at += 1;
                Ok(Value::Absent)
            }
            'A'..='Z' => {
                // A typed value stands for the value.
                let (_, mut values) = self.part()?;
                values.pop().ok_or_else(|| self.error("a value"))
            }
            _ => {
                let is_part = |c: char| c.is_ascii_digit() || "+-.E".contains(c);
                let digits = self.while_is(is_part);
                let number = digits.parse().map_err(|_| self.error("a number"))?;
                Ok(Value::Number(number))
            }
        }
    }

    fn list(&mut self) -> Result<Value, ReadError> {
        self.take('(', "`(`")?;
        let mut values = Vec::new();
        while !self.rest().starts_with(')') {
            if !values.is_empty() {
                self.take(',', "`,` or `)`")?;
            }
            values.push(self.value()?);
        }
        self.take(')', "`)`")?;
        Ok(Value::List(values))
    }

    fn text(&mut self) -> Result<Value, ReadError> {
        let mut text = String::new();
        loop {
            self.take('\'', "a string")?;
            text += &self.while_is(|c| c != '\'');
            self.take('\'', "the end of a string")?;
            // Two quotes are one in the string.
            if !self.rest().starts_with('\'') {
                return Ok(Value::Text(text));
            }
            text.push('\'');
        }
    }
}
