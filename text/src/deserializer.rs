//! Typed values from values with places.

use crate::escape::quote;
use crate::nearest;
use crate::value::{Content, Member, TextError, Value};
use serde::de::{
    self, DeserializeSeed, Deserializer, EnumAccess, Expected, IntoDeserializer, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};
use std::fmt::Display;
use std::ops::Range;

impl de::Error for TextError {
    fn custom<T: Display>(message: T) -> Self {
        Self {
            message: message.to_string(),
            key: String::new(),
            span: None,
        }
    }

    fn invalid_type(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        let as_written = match (&found, words(expected).starts_with(WHOLE)) {
            (Unexpected::Float(value), true) if value.fract() == 0.0 => {
                ", written without a point and an exponent"
            }
            _ => "",
        };
        let (found, expected) = (in_words(found), words(expected));
        Self::custom(format_args!(
            "found {found}, expected {expected}{as_written}"
        ))
    }

    fn invalid_value(found: Unexpected<'_>, expected: &dyn Expected) -> Self {
        let (found, expected) = (in_words(found), words(expected));
        Self::custom(format_args!("found {found}, expected {expected}"))
    }

    fn invalid_length(found: usize, expected: &dyn Expected) -> Self {
        Self::custom(format_args!("found {found} values, expected {expected}"))
    }

    fn unknown_variant(found: &str, expected: &'static [&'static str]) -> Self {
        Self::custom(format_args!(
            "found {}, expected {}",
            quote(found),
            known("one of", found, expected)
        ))
    }

    fn unknown_field(found: &str, expected: &'static [&'static str]) -> Self {
        Self::custom(format_args!(
            "found the unknown key {}, expected {}",
            quote(found),
            known("one of", found, expected)
        ))
    }

    fn missing_field(field: &'static str) -> Self {
        Self::custom(format_args!("the key `{field}` is missing"))
    }

    fn duplicate_field(field: &'static str) -> Self {
        Self::custom(format_args!(
            "found the key `{field}` twice, expected it once"
        ))
    }
}

/// What was found, in the words of a text's author.
fn in_words(found: Unexpected<'_>) -> String {
    match found {
        Unexpected::Bool(value) => format!("{value}"),
        Unexpected::Unsigned(value) => format!("{value}"),
        Unexpected::Signed(value) => format!("{value}"),
        // With its point or exponent, which tell it from a whole number.
        Unexpected::Float(value) => format!("{value:?}"),
        Unexpected::Str(text) => format!("the text {}", quote(text)),
        Unexpected::Unit | Unexpected::Option => "null".to_owned(),
        Unexpected::Seq => "an array".to_owned(),
        Unexpected::Map => "a table".to_owned(),
        other => other.to_string(),
    }
}

/// How what is expected of a whole number begins.
const WHOLE: &str = "a whole number";

fn whole(least: impl Display, most: impl Display) -> String {
    format!("{WHOLE} from {least} to {most}")
}

/// What was expected, in the words of a text's author.
fn words(expected: &dyn Expected) -> String {
    let expected = expected.to_string();
    let known = match expected.as_str() {
        "f64" | "f32" => "a number",
        "u64" | "usize" => return whole(0, u64::MAX),
        "u32" => return whole(0, u32::MAX),
        "u16" => return whole(0, u16::MAX),
        "u8" => return whole(0, u8::MAX),
        "i64" | "isize" => return whole(i64::MIN, i64::MAX),
        "i32" => return whole(i32::MIN, i32::MAX),
        "i16" => return whole(i16::MIN, i16::MAX),
        "i8" => return whole(i8::MIN, i8::MAX),
        "a sequence" => "an array",
        "a map" => "a table",
        "a string" | "a borrowed string" => "a text",
        "a boolean" => "true or false",
        other => other.strip_prefix("struct ").map_or(other, |_| "a table"),
    };
    known.to_owned()
}

/// The names that are known, and the one that is meant, perhaps.
fn known(one_of: &str, found: &str, names: &[&str]) -> String {
    let all: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    let all = match names {
        [] => "none".to_owned(),
        [_] => all.concat(),
        _ => format!("{one_of} {}", all.join(", ")),
    };
    match nearest(found, names.iter().copied()) {
        Some(name) => format!("{all} (did you mean `{name}`?)"),
        None => all,
    }
}

impl TextError {
    /// The error at this place, if it knows no place that is further inside.
    fn within(mut self, span: &Range<usize>) -> Self {
        self.span.get_or_insert_with(|| span.clone());
        self
    }

    /// The error below a key.
    fn below(mut self, step: &str) -> Self {
        let dot = if self.key.is_empty() || self.key.starts_with('[') {
            ""
        } else {
            "."
        };
        self.key = format!("{step}{dot}{}", self.key);
        self
    }
}

/// Reads one value.
#[derive(Clone, Copy)]
pub(crate) struct ValueDeserializer<'v> {
    value: &'v Value,
}

impl<'v> ValueDeserializer<'v> {
    pub(crate) fn new(value: &'v Value) -> Self {
        Self { value }
    }

    fn refused(&self, expected: &str) -> TextError {
        let found = self.value.describe();
        TextError::at(
            self.value.span.clone(),
            format!("found {found}, expected {expected}"),
        )
    }

    fn visit<V: Visitor<'v>>(self, visitor: V) -> Result<V::Value, TextError> {
        match &self.value.content {
            Content::Null => visitor.visit_unit(),
            Content::Bool(value) => visitor.visit_bool(*value),
            Content::Negative(value) => visitor.visit_i64(*value),
            Content::Whole(value) => visitor.visit_u64(*value),
            Content::Float(value) if value.is_finite() => visitor.visit_f64(*value),
            Content::Float(_) => Err(self.refused("a finite number")),
            Content::Text(text) => visitor.visit_borrowed_str(text),
            Content::Time(_) => Err(self.refused("a number, a text, an array or a table")),
            Content::Array(items) => sequence(items, self.value, visitor),
            Content::Object(members) => visitor.visit_map(Members {
                left: members.iter(),
                current: None,
            }),
        }
    }
}

/// Visits an array, all of it.
fn sequence<'v, V: Visitor<'v>>(
    items: &'v [Value],
    whole: &Value,
    visitor: V,
) -> Result<V::Value, TextError> {
    // What is expected is known to the visitor, which is spent on the visit.
    let expected = expectation(&visitor);
    let mut access = Items {
        left: items.iter(),
        index: 0,
    };
    let read = visitor.visit_seq(&mut access)?;
    match access.left.next() {
        None => Ok(read),
        Some(_) => Err(TextError::at(
            whole.span.clone(),
            format!("found an array of {}, expected {expected}", items.len()),
        )),
    }
}

fn expectation<'v>(visitor: &impl Visitor<'v>) -> String {
    let expected: &dyn Expected = visitor;
    expected.to_string()
}

macro_rules! visits {
    ($($method:ident)*) => {
        $(fn $method<V: Visitor<'v>>(self, visitor: V) -> Result<V::Value, TextError> {
            self.deserialize_any(visitor)
        })*
    };
}

impl<'v> Deserializer<'v> for ValueDeserializer<'v> {
    type Error = TextError;

    fn deserialize_any<V: Visitor<'v>>(self, visitor: V) -> Result<V::Value, TextError> {
        self.visit(visitor).map_err(|e| e.within(&self.value.span))
    }

    visits! {
        deserialize_bool deserialize_i8 deserialize_i16 deserialize_i32 deserialize_i64
        deserialize_u8 deserialize_u16 deserialize_u32 deserialize_u64 deserialize_f32
        deserialize_f64 deserialize_char deserialize_str deserialize_string deserialize_bytes
        deserialize_byte_buf deserialize_unit deserialize_seq deserialize_map
        deserialize_identifier
    }

    fn deserialize_option<V: Visitor<'v>>(self, visitor: V) -> Result<V::Value, TextError> {
        match self.value.content {
            Content::Null => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
        .map_err(|e| e.within(&self.value.span))
    }

    fn deserialize_unit_struct<V: Visitor<'v>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, TextError> {
        self.deserialize_any(visitor)
    }

    fn deserialize_newtype_struct<V: Visitor<'v>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, TextError> {
        let read = visitor.visit_newtype_struct(self);
        read.map_err(|e| e.within(&self.value.span))
    }

    fn deserialize_tuple<V: Visitor<'v>>(
        self,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, TextError> {
        self.deserialize_any(visitor)
    }

    fn deserialize_tuple_struct<V: Visitor<'v>>(
        self,
        _: &'static str,
        _: usize,
        visitor: V,
    ) -> Result<V::Value, TextError> {
        self.deserialize_any(visitor)
    }

    fn deserialize_struct<V: Visitor<'v>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TextError> {
        match &self.value.content {
            // An array of the right length stands for no record.
            Content::Array(_) => Err(self.refused("a table")),
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_enum<V: Visitor<'v>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TextError> {
        let read = match &self.value.content {
            Content::Text(text) => visitor.visit_enum(text.as_str().into_deserializer()),
            Content::Object(members) if members.len() == 1 => visitor.visit_enum(Variant {
                member: &members[0],
            }),
            _ => Err(self.refused(&known("one of", "", variants))),
        };
        read.map_err(|e| e.within(&self.value.span))
    }

    fn deserialize_ignored_any<V: Visitor<'v>>(self, visitor: V) -> Result<V::Value, TextError> {
        visitor.visit_unit()
    }
}

/// The values of an array.
struct Items<'v> {
    left: std::slice::Iter<'v, Value>,
    index: usize,
}

impl<'v> SeqAccess<'v> for &mut Items<'v> {
    type Error = TextError;

    fn next_element_seed<S: DeserializeSeed<'v>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, TextError> {
        let Some(value) = self.left.next() else {
            return Ok(None);
        };
        let step = format!("[{}]", self.index);
        self.index += 1;
        let read = seed.deserialize(ValueDeserializer { value });
        read.map(Some)
            .map_err(|e| e.within(&value.span).below(&step))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.left.len())
    }
}

/// The members of an object.
struct Members<'v> {
    left: std::slice::Iter<'v, Member>,
    current: Option<&'v Member>,
}

impl<'v> MapAccess<'v> for Members<'v> {
    type Error = TextError;

    fn next_key_seed<S: DeserializeSeed<'v>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, TextError> {
        let Some(member) = self.left.next() else {
            return Ok(None);
        };
        self.current = Some(member);
        let key = de::value::BorrowedStrDeserializer::new(&member.key);
        let read = seed.deserialize(key);
        read.map(Some)
            .map_err(|e: TextError| e.within(&member.key_span))
    }

    fn next_value_seed<S: DeserializeSeed<'v>>(&mut self, seed: S) -> Result<S::Value, TextError> {
        let Some(member) = self.current.take() else {
            return Err(de::Error::custom("a value without its key"));
        };
        let read = seed.deserialize(ValueDeserializer {
            value: &member.value,
        });
        read.map_err(|e| e.within(&member.value.span).below(&member.key))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.left.len())
    }
}

/// A variant with its content: an object of one key.
struct Variant<'v> {
    member: &'v Member,
}

impl<'v> EnumAccess<'v> for Variant<'v> {
    type Error = TextError;
    type Variant = ValueDeserializer<'v>;

    fn variant_seed<S: DeserializeSeed<'v>>(
        self,
        seed: S,
    ) -> Result<(S::Value, Self::Variant), TextError> {
        let key = de::value::BorrowedStrDeserializer::new(&self.member.key);
        let read = seed.deserialize(key);
        let variant = read.map_err(|e: TextError| e.within(&self.member.key_span))?;
        Ok((variant, ValueDeserializer::new(&self.member.value)))
    }
}

impl<'v> VariantAccess<'v> for ValueDeserializer<'v> {
    type Error = TextError;

    fn unit_variant(self) -> Result<(), TextError> {
        Err(self.refused("a name without a value"))
    }

    fn newtype_variant_seed<S: DeserializeSeed<'v>>(self, seed: S) -> Result<S::Value, TextError> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'v>>(self, _: usize, visitor: V) -> Result<V::Value, TextError> {
        self.deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'v>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TextError> {
        self.deserialize_any(visitor)
    }
}
