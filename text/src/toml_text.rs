//! TOML as values with places.

use crate::value::{Content, Member, TextError, Value};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

pub(crate) fn parse(text: &str) -> Result<Value, TextError> {
    let table = DeTable::parse(text).map_err(|error| TextError {
        message: error.message().to_owned(),
        key: String::new(),
        span: error.span().or_else(|| deepest(text)),
    })?;
    let span = table.span();
    Ok(Value {
        content: members(table.get_ref())?,
        span,
    })
}

/// The first line with more dots and brackets than the parser follows, which it tells no place of.
fn deepest(text: &str) -> Option<Range<usize>> {
    const DEEP: usize = 64;
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let is_deep = line.matches(['.', '[', '{']).count() > DEEP;
        if is_deep {
            return Some(start..start + 1);
        }
        start += line.len();
    }
    None
}

/// What the TOML parser allows in depth bounds the recursion.
fn value(value: &Spanned<DeValue<'_>>) -> Result<Value, TextError> {
    let span = value.span();
    let content = match value.get_ref() {
        DeValue::String(text) => Content::Text(text.as_ref().to_owned()),
        DeValue::Integer(number) => whole(number.as_str(), number.radix(), &span)?,
        DeValue::Float(number) => {
            let digits = number.as_str().replace('_', "");
            let number = digits.parse().map_err(|_| malformed(&span))?;
            Content::Float(number)
        }
        DeValue::Boolean(value) => Content::Bool(*value),
        DeValue::Datetime(time) => Content::Time(time.to_string()),
        DeValue::Array(items) => {
            let items: Result<_, _> = items.iter().map(self::value).collect();
            Content::Array(items?)
        }
        DeValue::Table(table) => members(table)?,
    };
    Ok(Value { content, span })
}

fn malformed(span: &Range<usize>) -> TextError {
    TextError::at(span.clone(), "expected a number")
}

fn whole(digits: &str, radix: u32, span: &Range<usize>) -> Result<Content, TextError> {
    let digits = digits.replace('_', "");
    let number = i128::from_str_radix(&digits, radix);
    let known = number.ok().and_then(|number| {
        let negative = || i64::try_from(number).map(Content::Negative);
        u64::try_from(number)
            .map(Content::Whole)
            .or_else(|_| negative())
            .ok()
    });
    known.ok_or_else(|| TextError::at(span.clone(), "expected a whole number of at most 64 bits"))
}

fn members(table: &DeTable<'_>) -> Result<Content, TextError> {
    let mut members: Vec<Member> = table
        .iter()
        .map(|(key, value)| member(key, value))
        .collect::<Result<_, _>>()?;
    members.sort_by_key(|member| member.key_span.start);
    Ok(Content::Object(members))
}

fn member(key: &Spanned<DeString<'_>>, of: &Spanned<DeValue<'_>>) -> Result<Member, TextError> {
    Ok(Member {
        key: key.get_ref().as_ref().to_owned(),
        key_span: key.span(),
        value: value(of)?,
    })
}
