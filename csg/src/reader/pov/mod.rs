//! `.pov`: POV-Ray's scene description language, limited to declared numbers, vectors and objects,
//! and to solids that are represented exactly.
//!
//! Coordinates are kept as written. An unsupported object is an error if the part uses it, but not
//! if it is only declared.

mod expression;
mod keywords;
mod object;
mod solid;

use std::collections::HashMap;
use std::ops::Range;

use premio_kernel::number::rational::Rational;

use self::keywords::{PASSED_OVER, SOLIDS};
use self::solid::Object;
use super::error::SpannedError;
use super::lexer::{Cursor, Dialect, Lexeme, Token};
use super::notes::{Notes, Remarks};
use super::spanned::Spanned;
use super::{PartPlace, Program, ReadOptions, StandaloneText};
use crate::builder::{Builder, SolidId};
use crate::tree::Operation;
use premio_text::LineColumn;
use premio_text::escape::quote;

/// A remark on every scene.
const LEFT_HANDED: &str = "POV-Ray's axes are left-handed: coordinates are kept as they are \
    written, so that the solid is the mirror image of what POV-Ray shows";

pub(super) fn read(source: &str, options: &ReadOptions) -> Result<Program, SpannedError> {
    let mut reader = Reader {
        cursor: Cursor::new(source, Dialect::Pov)?,
        builder: Builder::new(),
        names: HashMap::new(),
        scene: Vec::new(),
        notes: Notes::of_digits(0.0),
        included: Vec::new(),
        inside: 0,
    };
    reader.scene()?;
    let Spanned { value: part, span } = match &options.part {
        Some(name) => reader.declared(name)?,
        None => Spanned::new(reader.whole()?, 0..source.len()),
    };
    reader.notes.add(LEFT_HANDED, span.start..span.start);
    let Remarks { digits, notes } = reader.notes.finish();
    Ok(Program {
        builder: reader.builder,
        part,
        digits,
        notes,
        standalone: StandaloneText::AsRead,
        included: Vec::new(),
        place: PartPlace::new(span),
    })
}

/// The help text where a macro is used.
const NO_MACROS: &str = "macros are not read";

/// The value of a name.
#[derive(Debug, Clone)]
enum Value {
    Number(Rational),
    Vector(Vec<Rational>),
    Object(Object, Range<usize>),
    /// Something unsupported, reported where it is used.
    Refused(Box<SpannedError>),
    /// A texture, a colour, a camera.
    Other,
}

impl Value {
    fn describe(&self) -> &'static str {
        match self {
            Self::Number(_) => "a number",
            Self::Vector(_) => "a vector",
            Self::Object(..) => "an object",
            Self::Refused(_) | Self::Other => "neither a number nor an object",
        }
    }
}

struct Reader<'a> {
    cursor: Cursor<'a>,
    builder: Builder,
    names: HashMap<&'a str, Value>,
    scene: Vec<Spanned<Object>>,
    notes: Notes,
    /// The included files, which are not read.
    included: Vec<&'a str>,
    /// The nesting depth of declared objects being read.
    inside: usize,
}

impl<'a> Reader<'a> {
    /// Reads all statements.
    fn scene(&mut self) -> Result<(), SpannedError> {
        loop {
            let lexeme = self.cursor.next();
            let text = self.cursor.text(lexeme);
            match lexeme.token {
                Token::End => return Ok(()),
                Token::Symbol(';') => {}
                Token::Symbol('#') => self.directive()?,
                Token::Name if keywords::is_object(text) => {
                    let object = self.object(lexeme)?;
                    self.scene.push(Spanned::new(object, lexeme.span()));
                }
                Token::Name if PASSED_OVER.contains(&text) => self.pass_over_block(lexeme)?,
                _ => return Err(self.statement_expected(lexeme)),
            }
        }
    }

    fn statement_expected(&self, lexeme: Lexeme) -> SpannedError {
        let text = self.cursor.text(lexeme);
        let expected = format!("an object, one of `{}`, or `#declare`", SOLIDS.join("`, `"));
        let fault = self.cursor.unexpected(lexeme, expected);
        match self.cursor.peek().is('(') {
            true => fault.help(NO_MACROS),
            false => fault.suggest(text, SOLIDS),
        }
    }

    /// A statement that begins with `#`.
    fn directive(&mut self) -> Result<(), SpannedError> {
        let word = self.cursor.next();
        match self.cursor.text(word) {
            "declare" | "local" => self.declare(),
            "undef" => {
                let name = self.cursor.next();
                self.names.remove(self.cursor.text(name));
                Ok(())
            }
            "include" => {
                let file = self.cursor.next();
                if file.token != Token::Text {
                    return Err(self.cursor.unexpected(file, "the name of a file in quotes"));
                }
                let name = self.cursor.text(file);
                self.included.push(name);
                self.notes.add(format!("{name} is not read"), file.span());
                Ok(())
            }
            "version" => {
                self.pass_over_value();
                Ok(())
            }
            "default" => self.pass_over_block(word),
            "debug" | "warning" | "render" | "statistics" => self.pass_over_message(),
            _ => {
                let expected = "`#declare`, `#local`, `#include` or `#version`";
                let help = "loops, conditions and macros are not read";
                Err(self.cursor.unexpected(word, expected).help(help))
            }
        }
    }

    /// Skips the text of `#debug` and similar directives.
    fn pass_over_message(&mut self) -> Result<(), SpannedError> {
        let text = self.cursor.next();
        match text.token {
            Token::Text => Ok(()),
            Token::Name if self.cursor.peek().is('(') => {
                let open = self.cursor.next();
                self.pass_over_to_end_of(open)
            }
            _ => Err(self.cursor.unexpected(text, "a text")),
        }
    }

    /// Declares a name; its previous value is dropped.
    fn declare(&mut self) -> Result<(), SpannedError> {
        let name = self.cursor.next();
        if name.token != Token::Name {
            return Err(self.cursor.unexpected(name, "a name to declare"));
        }
        let known = self.cursor.text(name);
        if keywords::is_object(known) || ["x", "y", "z"].contains(&known) {
            return Err(self.cursor.unexpected(name, "a name that is not a keyword"));
        }
        self.cursor.expect('=', "after the name that is declared")?;
        let value = self.declared_value()?;
        self.names.insert(known, value);
        if self.cursor.peek().is(';') {
            self.cursor.next();
        }
        Ok(())
    }

    fn declared_value(&mut self) -> Result<Value, SpannedError> {
        let first = self.cursor.peek();
        let text = self.cursor.text(first);
        if first.token == Token::Name && keywords::is_object(text) {
            self.cursor.next();
            let object = self.object(first)?;
            return Ok(Value::Object(object, first.span()));
        }
        if first.token == Token::Name && PASSED_OVER.contains(&text) {
            self.cursor.next();
            self.pass_over_block(first)?;
            return Ok(Value::Other);
        }
        let number = matches!(
            first.token,
            Token::Number | Token::Symbol('<' | '(' | '-' | '+')
        );
        let known = ["x", "y", "z"].contains(&text)
            || keywords::truth(text).is_some()
            || self.names.contains_key(text);
        if !number && !known {
            // A colour, a function, a text, or a name from a file that is not read.
            let fault = self.unknown(first);
            self.pass_over_value();
            return Ok(Value::Refused(Box::new(fault)));
        }
        if let Some(value @ (Value::Object(..) | Value::Other)) = self.names.get(text) {
            let value = value.clone();
            self.pass_over_value();
            return Ok(value);
        }
        match self.expression() {
            Ok(operand) => Ok(operand.value()),
            Err(fault) => {
                self.pass_over_value();
                Ok(Value::Refused(Box::new(fault)))
            }
        }
    }

    /// The error at an unknown name.
    fn unknown(&self, lexeme: Lexeme) -> SpannedError {
        let text = self.cursor.text(lexeme);
        let found = match lexeme.token {
            Token::Name => format!("the unknown name {}", quote(text)),
            _ => quote(text),
        };
        let expected = "an exact number, or a name that is declared above";
        let mut known: Vec<&str> = self.names.keys().copied().collect();
        known.sort_unstable();
        let fault = SpannedError::input(lexeme.span(), found, expected);
        match self.included.as_slice() {
            [] => fault.suggest(text, known),
            files => {
                let files = files.join(", ");
                let help = format!("what is declared in {files} is not read");
                fault.help(help).suggest(text, known)
            }
        }
    }

    /// Skips a value to its `;`, or to a token that cannot be part of it.
    fn pass_over_value(&mut self) {
        let mut depth = 0usize;
        loop {
            let next = self.cursor.peek();
            let text = self.cursor.text(next);
            match next.token {
                Token::End => return,
                Token::Symbol('#' | ';') if depth == 0 => return,
                Token::Name if depth == 0 && begins_statement(text) => return,
                Token::Symbol('{' | '(' | '[') => depth += 1,
                Token::Symbol('}' | ')' | ']') if depth == 0 => return,
                Token::Symbol('}' | ')' | ']') => depth -= 1,
                _ => {}
            }
            self.cursor.next();
        }
    }

    /// Skips a block in braces.
    fn pass_over_block(&mut self, word: Lexeme) -> Result<(), SpannedError> {
        let what_for = format!("after `{}`", self.cursor.text(word));
        let open = self.cursor.expect('{', &what_for)?;
        self.pass_over_to_end_of(open)
    }

    /// Skips to the bracket that closes `open`.
    fn pass_over_to_end_of(&mut self, open: Lexeme) -> Result<(), SpannedError> {
        let mut depth = 1usize;
        while depth > 0 {
            let next = self.cursor.next();
            match next.token {
                Token::End => return Err(self.unclosed(next, open)),
                Token::Symbol('{' | '(' | '[') => depth += 1,
                Token::Symbol('}' | ')' | ']') => depth -= 1,
                _ => {}
            }
        }
        Ok(())
    }

    fn unclosed(&self, end: Lexeme, open: Lexeme) -> SpannedError {
        let source = self.cursor.source().as_bytes();
        let line = LineColumn::new(source, open.span().start).line;
        let fault = self.cursor.unexpected(end, "a closing bracket");
        fault.help(format!("the bracket opened on line {line} is not closed"))
    }

    /// An optional comma.
    fn comma(&mut self) {
        if self.cursor.peek().is(',') {
            self.cursor.next();
        }
    }

    /// The object declared with a name.
    fn declared(&mut self, name: &str) -> Result<Spanned<SolidId>, SpannedError> {
        let end = self.cursor.source().len();
        match self.names.get(name).cloned() {
            Some(Value::Object(object, span)) => {
                let part = object.solid(&mut self.builder)?;
                Ok(Spanned::new(part, span))
            }
            Some(other) => {
                let found = format!("{}, which is {}", quote(name), other.describe());
                Err(SpannedError::input(
                    end..end,
                    found,
                    "the name of an object",
                ))
            }
            None => {
                let found = format!("no object called {}", quote(name));
                let fault =
                    SpannedError::input(end..end, found, "the name of an object in the file");
                Err(fault.suggest(name, self.objects()))
            }
        }
    }

    /// The names of objects, sorted.
    fn objects(&self) -> Vec<&'a str> {
        let objects = self.names.iter();
        let objects = objects.filter(|(_, value)| matches!(value, Value::Object(..)));
        let mut names: Vec<&str> = objects.map(|(name, _)| *name).collect();
        names.sort_unstable();
        names
    }

    /// All objects of the scene.
    fn whole(&mut self) -> Result<SolidId, SpannedError> {
        if self.scene.is_empty() {
            let end = self.cursor.source().len();
            let fault = SpannedError::input(end..end, "no object in the scene", "one at least");
            let names = self.objects();
            return Err(match names.is_empty() {
                true => fault,
                false => fault.help(format!("`--part` reads one of {}", names.join(", "))),
            });
        }
        let mut parts = Vec::new();
        for object in std::mem::take(&mut self.scene) {
            parts.push(object.value.solid(&mut self.builder)?);
        }
        Ok(self.builder.operation(Operation::Union, &parts))
    }
}

/// Whether a keyword cannot be part of a value.
fn begins_statement(word: &str) -> bool {
    keywords::is_object(word) || PASSED_OVER.contains(&word)
}
