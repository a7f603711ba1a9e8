//! Values that know their places.

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

impl Member {
    /// The key and its value, or the key alone where the value stands elsewhere, as a table does.
    pub(crate) fn span(&self) -> Range<usize> {
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
