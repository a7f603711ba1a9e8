//! A JSON text as values with their spans and exact decimals.
//!
//! It is read without recursion into an arena; depth is limited by memory only.

use std::ops::Range;

use super::super::error::SpannedError;
use super::super::lexer::{Cursor, Dialect, Lexeme, Token};
use super::super::spanned::Spanned;
use premio_text::escape::quote;

/// The index of a value in its document.
pub(super) type ValueId = usize;

#[derive(Debug)]
pub(super) enum Content {
    Null,
    Bool,
    /// With its sign.
    Number(String),
    Text(String),
    Array(Vec<ValueId>),
    Object(Vec<Member>),
}

impl Content {
    pub(super) fn describe(&self) -> String {
        match self {
            Self::Null => "`null`".to_owned(),
            Self::Bool => "a truth value".to_owned(),
            Self::Number(text) => format!("the number {}", quote(text)),
            Self::Text(text) => format!("the text {}", quote(text)),
            Self::Array(_) => "an array".to_owned(),
            Self::Object(_) => "an object".to_owned(),
        }
    }
}

#[derive(Debug)]
pub(super) struct Member {
    pub(super) key: String,
    pub(super) key_span: Range<usize>,
    pub(super) value: ValueId,
}

#[derive(Debug)]
pub(super) struct Value {
    pub(super) content: Content,
    pub(super) span: Range<usize>,
}

/// All values of a text.
#[derive(Debug)]
pub(super) struct Document {
    values: Vec<Value>,
    pub(super) root: ValueId,
}

impl Document {
    pub(super) fn value(&self, id: ValueId) -> &Value {
        &self.values[id]
    }
}

/// An array or an object that is not closed yet.
enum Open {
    Array {
        start: usize,
        items: Vec<ValueId>,
    },
    Object {
        start: usize,
        members: Vec<Member>,
        key: Option<Spanned<String>>,
    },
}

pub(super) fn parse(source: &str) -> Result<Document, SpannedError> {
    let cursor = Cursor::new(source, Dialect::Json)?;
    let mut parser = Parser {
        cursor,
        values: Vec::new(),
        open: Vec::new(),
    };
    let root = parser.document()?;
    Ok(Document {
        values: parser.values,
        root,
    })
}

struct Parser<'a> {
    cursor: Cursor<'a>,
    values: Vec<Value>,
    open: Vec<Open>,
}

impl Parser<'_> {
    fn document(&mut self) -> Result<ValueId, SpannedError> {
        loop {
            let Some(mut done) = self.begin_value()? else {
                continue;
            };
            // The value may be the last of its container, and that the last of its own.
            loop {
                match self.after_value(done)? {
                    After::Next => break,
                    After::Closed(outer) => done = outer,
                    After::End => return Ok(done),
                }
            }
        }
    }

    fn add(&mut self, content: Content, span: Range<usize>) -> ValueId {
        self.values.push(Value { content, span });
        self.values.len() - 1
    }

    /// Reads a whole value, or the beginning of a non-empty array or object.
    fn begin_value(&mut self) -> Result<Option<ValueId>, SpannedError> {
        let lexeme = self.cursor.next();
        let span = lexeme.span();
        let content = match lexeme.token {
            Token::Symbol('[') => {
                if !self.cursor.peek().is(']') {
                    self.open.push(Open::Array {
                        start: span.start,
                        items: Vec::new(),
                    });
                    return Ok(None);
                }
                Content::Array(Vec::new())
            }
            Token::Symbol('{') => {
                if !self.cursor.peek().is('}') {
                    let key = Some(self.key()?);
                    let (start, members) = (span.start, Vec::new());
                    self.open.push(Open::Object {
                        start,
                        members,
                        key,
                    });
                    return Ok(None);
                }
                Content::Object(Vec::new())
            }
            _ => return self.scalar(lexeme).map(Some),
        };
        let close = self.cursor.next();
        Ok(Some(self.add(content, span.start..close.span().end)))
    }

    fn scalar(&mut self, lexeme: Lexeme) -> Result<ValueId, SpannedError> {
        let text = self.cursor.text(lexeme);
        let read = match (lexeme.token, text) {
            (Token::Text, _) => Spanned::new(Content::Text(self.decode(lexeme)?), lexeme.span()),
            (Token::Name, "null") => Spanned::new(Content::Null, lexeme.span()),
            (Token::Name, "true" | "false") => Spanned::new(Content::Bool, lexeme.span()),
            (Token::Number, _) => self.number(lexeme, lexeme)?,
            (Token::Symbol('-'), _) => {
                let digits = self.cursor.next();
                self.number(lexeme, digits)?
            }
            _ => return Err(self.cursor.unexpected(lexeme, "a JSON value")),
        };
        Ok(self.add(read.value, read.span))
    }

    fn number(&self, first: Lexeme, digits: Lexeme) -> Result<Spanned<Content>, SpannedError> {
        let span = first.span().start..digits.span().end;
        let text = self.cursor.source().get(span.clone()).unwrap_or_default();
        if digits.token != Token::Number || !is_json_number(text) {
            let expected = "a number as JSON writes it, such as `-0.5` or `1e-3`";
            return Err(SpannedError::input(span, quote(text), expected));
        }
        Ok(Spanned::new(Content::Number(text.to_owned()), span))
    }

    fn decode(&self, lexeme: Lexeme) -> Result<String, SpannedError> {
        serde_json::from_str(self.cursor.text(lexeme))
            .map_err(|_| self.cursor.unexpected(lexeme, "a text as JSON writes it"))
    }

    fn key(&mut self) -> Result<Spanned<String>, SpannedError> {
        let lexeme = self.cursor.next();
        if lexeme.token != Token::Text {
            return Err(self.cursor.unexpected(lexeme, "a key in quotes"));
        }
        let key = self.decode(lexeme)?;
        self.cursor.expect(':', "after the key")?;
        Ok(Spanned::new(key, lexeme.span()))
    }

    fn after_value(&mut self, value: ValueId) -> Result<After, SpannedError> {
        let lexeme = self.cursor.next();
        match self.open.pop() {
            None if lexeme.token == Token::End => Ok(After::End),
            None => Err(self.cursor.unexpected(lexeme, "the end of the file")),
            Some(Open::Array { start, mut items }) => {
                items.push(value);
                if lexeme.is(',') {
                    self.open.push(Open::Array { start, items });
                    return Ok(After::Next);
                }
                self.close(lexeme, ']', start, Content::Array(items))
            }
            Some(Open::Object {
                start,
                mut members,
                key,
            }) => {
                if let Some(key) = key {
                    members.push(Member {
                        key: key.value,
                        key_span: key.span,
                        value,
                    });
                }
                if lexeme.is(',') {
                    let key = Some(self.key()?);
                    self.open.push(Open::Object {
                        start,
                        members,
                        key,
                    });
                    return Ok(After::Next);
                }
                self.close(lexeme, '}', start, Content::Object(members))
            }
        }
    }

    fn close(
        &mut self,
        lexeme: Lexeme,
        symbol: char,
        start: usize,
        content: Content,
    ) -> Result<After, SpannedError> {
        if !lexeme.is(symbol) {
            return Err(self.cursor.unexpected(lexeme, format!("`,` or `{symbol}`")));
        }
        Ok(After::Closed(self.add(content, start..lexeme.span().end)))
    }
}

/// What follows a value.
enum After {
    /// Another value.
    Next,
    /// The end of the array or object around it, which is now itself a value.
    Closed(ValueId),
    /// The end of the text.
    End,
}

/// Whether a number accepted by other languages is also valid in JSON.
fn is_json_number(text: &str) -> bool {
    let text = text.strip_prefix('-').unwrap_or(text);
    let digit_at = |at: usize| text.as_bytes().get(at).is_some_and(u8::is_ascii_digit);
    let leading_zero = text.starts_with('0') && digit_at(1);
    let bare_point = text.find('.').is_some_and(|at| !digit_at(at + 1));
    digit_at(0) && !leading_zero && !bare_point
}
