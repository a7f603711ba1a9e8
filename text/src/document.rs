//! Texts read as values, and typed values from these.

use crate::deserializer::ValueDeserializer;
use crate::value::{Content, Member, TextError, Value};
use crate::{json, toml_text};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::ops::Range;

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

impl Value {
    /// Reads a typed value.
    ///
    /// # Errors
    /// As [`Document::read`].
    pub fn read<'v, T: Deserialize<'v>>(&'v self) -> Result<T, TextError> {
        T::deserialize(ValueDeserializer::new(self))
    }
}
