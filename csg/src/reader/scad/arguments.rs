//! The arguments of an OpenSCAD node.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::lexer::{Cursor, Lexeme, Token};
use super::super::number::{literal, show};
use premio_text::escape::quote;

/// The maximum depth of lists in a flattened file: a matrix is a list of lists.
const MAX_DEPTH: usize = 4;

/// The value of an argument.
#[derive(Debug, Clone)]
pub(super) enum Value {
    Number(Rational),
    List(Vec<Argument>),
    Text(String),
    Bool(bool),
    Undefined,
    NotFinite,
}

/// A value, its span, and its name if it has one.
#[derive(Debug, Clone)]
pub(super) struct Argument {
    name: Option<Name>,
    pub(super) value: Value,
    pub(super) span: Range<usize>,
}

#[derive(Debug, Clone)]
struct Name {
    text: String,
    span: Range<usize>,
}

impl Argument {
    fn describe(&self) -> String {
        match &self.value {
            Value::Number(number) => show(number),
            Value::List(_) => "a list".to_owned(),
            Value::Text(_) => "a text".to_owned(),
            Value::Bool(value) => format!("`{value}`"),
            Value::Undefined => "`undef`".to_owned(),
            Value::NotFinite => "a number that is not finite".to_owned(),
        }
    }

    /// The error that something else is expected here.
    pub(super) fn wrong(&self, expected: impl Into<String>) -> SpannedError {
        SpannedError::input(self.span.clone(), self.describe(), expected)
    }

    pub(super) fn number(&self) -> Result<&Rational, SpannedError> {
        match &self.value {
            Value::Number(number) => Ok(number),
            _ => Err(self.wrong("a number")),
        }
    }

    pub(super) fn bool(&self) -> Result<bool, SpannedError> {
        match self.value {
            Value::Bool(value) => Ok(value),
            _ => Err(self.wrong("`true` or `false`")),
        }
    }

    /// The items of a list of length `N`.
    pub(super) fn list<const N: usize>(
        &self,
        expected: &str,
    ) -> Result<&[Argument; N], SpannedError> {
        match &self.value {
            Value::List(items) => {
                let count = items.len();
                items.as_slice().try_into().map_err(|_| {
                    SpannedError::input(self.span.clone(), format!("a list of {count}"), expected)
                })
            }
            _ => Err(self.wrong(expected)),
        }
    }

    pub(super) fn items(&self, expected: &str) -> Result<&[Argument], SpannedError> {
        match &self.value {
            Value::List(items) => Ok(items),
            _ => Err(self.wrong(expected)),
        }
    }
}

/// All arguments of a node.
#[derive(Debug)]
pub(super) struct Arguments {
    arguments: Vec<Argument>,
    /// The span from the node's name to the closing bracket.
    pub(super) span: Range<usize>,
    node: String,
}

impl Arguments {
    /// Reads the arguments in brackets after a node's name.
    pub(super) fn parse(cursor: &mut Cursor<'_>, node: Lexeme) -> Result<Self, SpannedError> {
        let name = cursor.text(node).to_owned();
        cursor.expect('(', &format!("after `{name}`"))?;
        let mut arguments = Vec::new();
        loop {
            if cursor.peek().is(')') {
                break;
            }
            arguments.push(argument(cursor)?);
            if !cursor.peek().is(',') {
                break;
            }
            cursor.next();
        }
        let close = cursor.expect(')', "or `,` after an argument")?;
        let span = node.span().start..close.span().end;
        Ok(Self {
            arguments,
            span,
            node: name,
        })
    }

    /// Assigns names to positional arguments, in order. Refuses unknown and repeated names.
    /// Arguments that only control the fineness of approximation are skipped.
    pub(super) fn bind(&mut self, known: &[&str]) -> Result<(), SpannedError> {
        const PASSED_OVER: [&str; 8] = [
            "$fn",
            "$fa",
            "$fs",
            "convexity",
            "slices",
            "segments",
            "timestamp",
            "$children",
        ];
        let mut seen = std::collections::HashSet::new();
        for (index, argument) in self.arguments.iter_mut().enumerate() {
            if argument.name.is_none() {
                let Some(text) = known.get(index) else {
                    return Err(argument.wrong(format!("fewer arguments of `{}`", self.node)));
                };
                let (text, span) = ((*text).to_owned(), argument.span.clone());
                argument.name = Some(Name { text, span });
            }
            let Some(name) = &argument.name else { continue };
            let text = name.text.as_str();
            if !known.contains(&text) && !PASSED_OVER.contains(&text) {
                let found = format!("the unknown argument {} of `{}`", quote(text), self.node);
                let expected = format!("one of `{}`", known.join("`, `"));
                let fault = SpannedError::input(name.span.clone(), found, expected);
                return Err(fault.suggest(text, known.iter().copied()));
            }
            if !seen.insert(text) {
                let found = format!("{} a second time", quote(text));
                return Err(SpannedError::input(
                    name.span.clone(),
                    found,
                    "each argument once",
                ));
            }
        }
        Ok(())
    }

    /// The first argument.
    pub(super) fn first(&self) -> Option<&Argument> {
        self.arguments.first()
    }

    /// An argument by its name; `undef` counts as absent.
    pub(super) fn find(&self, name: &str) -> Option<&Argument> {
        self.arguments.iter().find(|argument| {
            let named = argument.name.as_ref().is_some_and(|n| n.text == name);
            named && !matches!(argument.value, Value::Undefined)
        })
    }

    pub(super) fn require(&self, name: &str) -> Result<&Argument, SpannedError> {
        let undefined = self.arguments.iter().find(|argument| {
            let named = argument.name.as_ref().is_some_and(|n| n.text == name);
            named && matches!(argument.value, Value::Undefined)
        });
        self.find(name).ok_or_else(|| match undefined {
            Some(argument) => argument.wrong(format!("a value for `{name}`")),
            None => {
                let found = format!("`{}` without `{name}`", self.node);
                SpannedError::input(self.span.clone(), found, format!("the argument `{name}`"))
            }
        })
    }

    /// The text of an argument; empty if it is absent.
    pub(super) fn words(&self, name: &str) -> Result<&str, SpannedError> {
        match self.find(name).map(|argument| (&argument.value, argument)) {
            None => Ok(""),
            Some((Value::Text(text), _)) => Ok(text),
            Some((_, argument)) => Err(argument.wrong("a text")),
        }
    }

    pub(super) fn flag(&self, name: &str) -> Result<bool, SpannedError> {
        self.find(name).map_or(Ok(false), Argument::bool)
    }
}

fn argument(cursor: &mut Cursor<'_>) -> Result<Argument, SpannedError> {
    let first = cursor.next();
    if first.token == Token::Name && cursor.peek().is('=') {
        cursor.next();
        let name = Name {
            text: cursor.text(first).to_owned(),
            span: first.span(),
        };
        let start = cursor.next();
        let value = value(cursor, start, 0)?;
        return Ok(Argument {
            name: Some(name),
            ..value
        });
    }
    value(cursor, first, 0)
}

/// A value. The depth of lists is bounded, and with it the depth of this recursion.
fn value(cursor: &mut Cursor<'_>, first: Lexeme, depth: usize) -> Result<Argument, SpannedError> {
    let mut span = first.span();
    let value = match (first.token, cursor.text(first)) {
        (Token::Symbol('['), _) => {
            if depth == MAX_DEPTH {
                return Err(cursor.unexpected(first, format!("lists at most {MAX_DEPTH} deep")));
            }
            let ListItems { items, end } = list(cursor, depth + 1)?;
            span.end = end;
            Value::List(items)
        }
        (Token::Symbol(sign @ ('-' | '+')), _) => {
            let next = cursor.next();
            span.end = next.span().end;
            signed(cursor, sign == '-', next)?
        }
        (Token::Text, text) => Value::Text(unquoted(text)),
        (Token::Name, "true") => Value::Bool(true),
        (Token::Name, "false") => Value::Bool(false),
        (Token::Name, "undef") => Value::Undefined,
        _ => signed(cursor, false, first)?,
    };
    Ok(Argument {
        name: None,
        value,
        span,
    })
}

/// The characters of a quoted text.
fn unquoted(text: &str) -> String {
    let inner = text.strip_prefix('"').unwrap_or(text);
    let inner = inner.strip_suffix('"').unwrap_or(inner);
    let mut all = String::with_capacity(inner.len());
    let mut characters = inner.chars();
    while let Some(c) = characters.next() {
        match c {
            '\\' => all.push(match characters.next() {
                Some('n') => '\n',
                Some('t') => '\t',
                Some('r') => '\r',
                Some(other) => other,
                None => c,
            }),
            _ => all.push(c),
        }
    }
    all
}

fn signed(cursor: &Cursor<'_>, negative: bool, lexeme: Lexeme) -> Result<Value, SpannedError> {
    match (lexeme.token, cursor.text(lexeme)) {
        (Token::Number, text) => {
            let number = literal(text, lexeme.span())?;
            Ok(Value::Number(if negative { -number } else { number }))
        }
        (Token::Name, "nan" | "inf") => Ok(Value::NotFinite),
        _ => Err(cursor.unexpected(
            lexeme,
            "a number, a list, a text, `true`, `false` or `undef`",
        )),
    }
}

/// The items of a list.
struct ListItems {
    items: Vec<Argument>,
    /// Where its text ends.
    end: usize,
}

fn list(cursor: &mut Cursor<'_>, depth: usize) -> Result<ListItems, SpannedError> {
    let mut items = Vec::new();
    while !cursor.peek().is(']') {
        let first = cursor.next();
        items.push(value(cursor, first, depth)?);
        if !cursor.peek().is(',') {
            break;
        }
        cursor.next();
    }
    let close = cursor.expect(']', "or `,` after an item of a list")?;
    let end = close.span().end;
    Ok(ListItems { items, end })
}
