//! JSON as values with places.

use crate::escape::quote;
use crate::value::{Content, Member, TextError, Value};
use std::collections::HashSet;

/// Arrays and objects may lie so deep within one another.
const DEPTH: usize = 128;

pub(crate) fn parse(text: &str) -> Result<Value, TextError> {
    let mut parser = Parser { text, at: 0 };
    let value = parser.value(0)?;
    parser.skip_space();
    match parser.at == text.len() {
        true => Ok(value),
        false => Err(parser.unexpected("the end of the text")),
    }
}

struct Parser<'t> {
    text: &'t str,
    at: usize,
}

impl Parser<'_> {
    fn rest(&self) -> &[u8] {
        &self.text.as_bytes()[self.at..]
    }

    fn peek(&self) -> Option<u8> {
        self.rest().first().copied()
    }

    fn skip_space(&mut self) {
        let space = |b: &&u8| matches!(b, b' ' | b'\t' | b'\n' | b'\r');
        self.at += self.rest().iter().take_while(space).count();
    }

    /// Whether a symbol comes next, which is then behind.
    fn takes(&mut self, symbol: u8) -> bool {
        self.skip_space();
        let is_next = self.peek() == Some(symbol);
        self.at += usize::from(is_next);
        is_next
    }

    fn unexpected(&self, expected: &str) -> TextError {
        let rest = &self.text[self.at..];
        let Some(first) = rest.chars().next() else {
            let message = format!("found the end of the text, expected {expected}");
            return TextError::at(self.at..self.at, message);
        };
        let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '+' | '.');
        let word = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
        let end = self.at + word.max(first.len_utf8());
        let found = quote(&self.text[self.at..end]);
        TextError::at(self.at..end, format!("found {found}, expected {expected}"))
    }

    fn value(&mut self, depth: usize) -> Result<Value, TextError> {
        self.skip_space();
        let start = self.at;
        let content = match self.peek() {
            Some(b'[' | b'{') if depth == DEPTH => {
                let expected = format!("at most {DEPTH} arrays and objects within one another");
                return Err(self.unexpected(&expected));
            }
            Some(b'[') => self.array(depth)?,
            Some(b'{') => self.object(depth)?,
            Some(b'"') => Content::Text(self.string()?),
            Some(b'-' | b'0'..=b'9') => self.number()?,
            _ => self.word()?,
        };
        Ok(Value {
            content,
            span: start..self.at,
        })
    }

    fn word(&mut self) -> Result<Content, TextError> {
        let words = [
            ("null", Content::Null),
            ("true", Content::Bool(true)),
            ("false", Content::Bool(false)),
        ];
        for (word, content) in words {
            if self.rest().starts_with(word.as_bytes()) {
                self.at += word.len();
                return Ok(content);
            }
        }
        Err(self.unexpected("a JSON value"))
    }

    fn array(&mut self, depth: usize) -> Result<Content, TextError> {
        self.at += 1;
        let mut items = Vec::new();
        if self.takes(b']') {
            return Ok(Content::Array(items));
        }
        loop {
            items.push(self.value(depth + 1)?);
            if self.takes(b']') {
                return Ok(Content::Array(items));
            }
            if !self.takes(b',') {
                return Err(self.unexpected("`,` or `]`"));
            }
        }
    }

    fn object(&mut self, depth: usize) -> Result<Content, TextError> {
        self.at += 1;
        let mut members = Vec::new();
        let mut known = HashSet::new();
        if self.takes(b'}') {
            return Ok(Content::Object(members));
        }
        loop {
            self.skip_space();
            let start = self.at;
            if self.peek() != Some(b'"') {
                return Err(self.unexpected("a key in quotes"));
            }
            let key = self.string()?;
            let key_span = start..self.at;
            if !known.insert(key.clone()) {
                let message = format!("found the key {} twice, expected it once", quote(&key));
                return Err(TextError::at(key_span, message));
            }
            if !self.takes(b':') {
                return Err(self.unexpected("`:`"));
            }
            let value = self.value(depth + 1)?;
            members.push(Member {
                key,
                key_span,
                value,
            });
            if self.takes(b'}') {
                return Ok(Content::Object(members));
            }
            if !self.takes(b',') {
                return Err(self.unexpected("`,` or `}`"));
            }
        }
    }

    fn string(&mut self) -> Result<String, TextError> {
        let start = self.at;
        let mut end = start + 1;
        let bytes = self.text.as_bytes();
        loop {
            match bytes.get(end) {
                Some(b'"') => break,
                Some(b'\\') => end += 2,
                Some(_) => end += 1,
                None => {
                    let message = "found a text without its end, expected `\"`";
                    return Err(TextError::at(start..start + 1, message));
                }
            }
        }
        end += 1;
        self.at = end;
        // A quote is one byte, and stands within no character.
        let text = &self.text[start..end];
        serde_json::from_str(text).map_err(|_| {
            let message = format!("found {}, expected a text as JSON writes it", quote(text));
            TextError::at(start..end, message)
        })
    }

    fn number(&mut self) -> Result<Content, TextError> {
        let is_part = |b: &&u8| matches!(b, b'0'..=b'9' | b'+' | b'-' | b'.' | b'e' | b'E');
        let length = self.rest().iter().take_while(is_part).count();
        let span = self.at..self.at + length;
        let text = &self.text[span.clone()];
        if !is_number(text) {
            let message = format!("found {}, expected a number as JSON writes it", quote(text));
            return Err(TextError::at(span, message));
        }
        self.at = span.end;
        if let Ok(whole) = text.parse() {
            return Ok(Content::Whole(whole));
        }
        match (text.parse::<i64>(), text.parse()) {
            // There is a zero below zero among f64 values only.
            (Ok(negative), _) if negative < 0 => Ok(Content::Negative(negative)),
            (_, Ok(number)) => Ok(Content::Float(number)),
            (_, Err(_)) => Err(TextError::at(span, "expected a number")),
        }
    }
}

/// Whether a text is a number as JSON writes it.
fn is_number(text: &str) -> bool {
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let text = text.strip_prefix('-').unwrap_or(text);
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => {
            let exponent = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
            (mantissa, Some(exponent))
        }
        None => (text, None),
    };
    let (whole, fraction) = match mantissa.split_once('.') {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (mantissa, None),
    };
    digits(whole)
        && (whole.len() == 1 || !whole.starts_with('0'))
        && fraction.is_none_or(digits)
        && exponent.is_none_or(digits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Document;
    use proptest::prelude::*;
    use serde::Deserialize;

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Eye {
        place: [f64; 3],
        #[serde(default)]
        size: Option<u32>,
    }

    fn refused(text: &str) -> (String, String) {
        let read = Document::from_json(text).and_then(|d| d.read::<Eye>());
        let error = read.unwrap_err();
        let span = error.span.clone().unwrap();
        (text[span].to_owned(), error.to_string())
    }

    #[test]
    fn errors_are_at_their_places() {
        for (text, place, words) in [
            (
                r#"{"place": [1, 2, 3, 4]}"#,
                "[1, 2, 3, 4]",
                "array of length 3",
            ),
            (r#"{"place": [1, 2]}"#, "[1, 2]", "array of length 3"),
            (r#"{"place": [1, 2, 1e999]}"#, "1e999", "`place[2]`"),
            (
                r#"{"place": [1, 2, 3], "sise": 4}"#,
                "\"sise\"",
                "did you mean `size`?",
            ),
            (r#"{"place": [1, 2, 3], "size": 4.5}"#, "4.5", "`size`"),
            (r#"{"place": [1, 2, 3], "place": 4}"#, "\"place\"", "twice"),
            (r#"{"size": 4}"#, r#"{"size": 4}"#, "`place` is missing"),
            (r#"{"place": [1, 2, 03]}"#, "03", "number"),
            (r#"{"place": [1, 2, "x"#, "\"", "without its end"),
            (r#"{"place": [1, 2, NaN]}"#, "NaN", "JSON value"),
        ] {
            let (at, message) = refused(text);
            assert_eq!(at, place, "{text}: {message}");
            assert!(message.contains(words), "{message}");
        }
        assert_eq!(refused("{\"place\": [1, 2,").0, "");
    }

    #[test]
    fn depth_is_bounded() {
        let deep = "[".repeat(1_000_000);
        let error = Document::from_json(&deep).unwrap_err();
        assert_eq!(error.span, Some(DEPTH..DEPTH + 1));
    }

    #[test]
    fn keys_lead_to_their_values() {
        let text = r#"{"a": [{"b": 1}, {"b": 22}], "c": null}"#;
        let document = Document::from_json(text).unwrap();
        let at = |key: &str| document.span(key).map(|span| &text[span]);
        assert_eq!(at("a[1].b"), Some("\"b\": 22"));
        assert_eq!(at("a[1].x"), Some("{\"b\": 22}"));
        assert_eq!(at("c"), Some("\"c\": null"));
        assert_eq!(at("x"), None);
    }

    proptest! {
        #[test]
        fn what_is_json_is_known_as_serde_knows_it(text in r#"[-\[\]{}",:0-9.eE+tnul \\a]{0,24}"#) {
            let known: Result<serde_json::Value, _> = serde_json::from_str(&text);
            let read = Document::from_json(&text);
            // Numbers too large are refused where they are read, keys that come twice here.
            if known.is_ok() {
                let twice = read.as_ref().is_err_and(|e| e.message.contains("twice"));
                prop_assert!(read.is_ok() || twice, "{read:?}");
            } else if let Ok(document) = read {
                let value = document.read::<serde_json::Value>();
                prop_assert!(value.is_err(), "{text}");
            }
        }
    }
}
