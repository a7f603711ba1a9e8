//! Values that know their places.

use crate::deserializer::ValueDeserializer;
use crate::{json, toml_text};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::ops::Range;

/// What is wrong with a text, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{message}", shown(key))]
pub struct TextError {
    /// What is wrong: what was found, and what was expected.
    pub message: String,
    /// The keys that lead to the place, as `light[1].position`; empty for the whole text.
    pub key: String,
    /// The bytes of the text at which it is.
    pub span: Option<Range<usize>>,
}

fn shown(key: &str) -> String {
    match key {
        "" => String::new(),
        key => format!("`{key}`: "),
    }
}

impl TextError {
    /// An error at a place of the text.
    pub fn at(span: Range<usize>, message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            key: String::new(),
            span: Some(span),
        }
    }
}

/// A value, and the bytes of the text at which it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// What it is.
    pub content: Content,
    /// Where it is.
    pub span: Range<usize>,
}

/// The kinds of values.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// Nothing; JSON only.
    Null,
    /// A truth value.
    Bool(bool),
    /// A whole number that is below zero.
    Negative(i64),
    /// A whole number.
    Whole(u64),
    /// Any other number, which may be too large to be finite.
    Float(f64),
    /// A text.
    Text(String),
    /// A date or a time; TOML only.
    Time(String),
    /// Values in order.
    Array(Vec<Value>),
    /// Values with keys, in order, each key once.
    Object(Vec<Member>),
}

/// A value with its key.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// The key.
    pub key: String,
    /// Where the key stands.
    pub key_span: Range<usize>,
    /// The value.
    pub value: Value,
}

/// The values of a text.
#[derive(Clone, Debug, PartialEq)]
pub struct Document {
    /// The outermost value.
    pub root: Value,
}

impl Document {
    /// The values of a JSON text.
    ///
    /// # Errors
    /// The text is not JSON, an object has a key twice, or it is nested too deeply.
    pub fn from_json(text: &str) -> Result<Self, TextError> {
        json::parse(text).map(|root| Self { root })
    }

    /// The values of a TOML text.
    ///
    /// # Errors
    /// The text is not TOML.
    pub fn from_toml(text: &str) -> Result<Self, TextError> {
        toml_text::parse(text).map(|root| Self { root })
    }

    /// Reads a typed value.
    ///
    /// # Errors
    /// Another value is expected at a place: of another kind, longer or shorter, finite, with other
    /// keys.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T, TextError> {
        T::deserialize(ValueDeserializer::new(&self.root))
    }

    /// Where keys like `light[1].position` stand with their value, or else the nearest that is there
    /// and holds it; none if that is the whole text.
    pub fn span(&self, key: &str) -> Option<Range<usize>> {
        let mut at = &self.root;
        let mut found = None;
        for step in key.split(['.', '[']).filter(|step| !step.is_empty()) {
            match (&at.content, step.strip_suffix(']')) {
                (Content::Array(items), Some(index)) => {
                    let item = index.parse().ok().and_then(|i: usize| items.get(i));
                    let Some(item) = item else { break };
                    at = item;
                    found = Some(item.span.clone());
                }
                _ => {
                    let Some(member) = at.member(step) else { break };
                    at = &member.value;
                    found = Some(member.span());
                }
            }
        }
        found
    }

    /// Where the first value is that a test is true of.
    pub fn find(&self, test: impl Fn(&Member) -> bool) -> Option<Range<usize>> {
        let mut left = vec![&self.root];
        let mut found: Option<Range<usize>> = None;
        while let Some(value) = left.pop() {
            match &value.content {
                Content::Array(items) => left.extend(items),
                Content::Object(members) => {
                    left.extend(members.iter().map(|member| &member.value));
                    for member in members.iter().filter(|member| test(member)) {
                        let span = member.span();
                        let is_first = found.as_ref().is_none_or(|f| span.start < f.start);
                        found = if is_first { Some(span) } else { found };
                    }
                }
                _ => (),
            }
        }
        found
    }
}

impl Member {
    /// The key and its value, or the key alone where the value stands elsewhere, as a table does.
    pub fn span(&self) -> Range<usize> {
        let end = match self.value.span.start >= self.key_span.end {
            true => self.value.span.end,
            false => self.key_span.end,
        };
        self.key_span.start..end
    }
}

impl Value {
    /// The value of a key of an object.
    pub fn get(&self, key: &str) -> Option<&Self> {
        self.member(key).map(|member| &member.value)
    }

    /// A key of an object, with its value.
    pub fn member(&self, key: &str) -> Option<&Member> {
        match &self.content {
            Content::Object(members) => members.iter().find(|member| member.key == key),
            _ => None,
        }
    }

    /// Reads a typed value.
    ///
    /// # Errors
    /// As [`Document::read`].
    pub fn read<'v, T: Deserialize<'v>>(&'v self) -> Result<T, TextError> {
        T::deserialize(ValueDeserializer::new(self))
    }

    /// What it is, for a message.
    pub(crate) fn describe(&self) -> String {
        match &self.content {
            Content::Null => "null".to_owned(),
            Content::Bool(value) => format!("{value}"),
            Content::Negative(value) => format!("{value}"),
            Content::Whole(value) => format!("{value}"),
            // With its point or exponent, which tell it from a whole number.
            Content::Float(value) => format!("{value:?}"),
            Content::Text(text) => format!("the text {}", crate::escape::quote(text)),
            Content::Time(text) => format!("the time {text}"),
            Content::Array(items) => format!("an array of {}", items.len()),
            Content::Object(_) => "a table".to_owned(),
        }
    }
}
