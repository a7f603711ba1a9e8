//! The words of Tcl as far as a text database uses them: bare, in braces, in quotes.
//!
//! A list in braces consists of words again, so trees and vectors are read by the same rules.

use std::ops::Range;

use winnow::combinator::alt;
use winnow::error::ContextError;
use winnow::prelude::*;
use winnow::token::{take_till, take_while};

use super::super::error::SpannedError;
use premio_text::escape::quote;

/// A word without its braces or quotes, and its span.
#[derive(Debug, Clone)]
pub(super) struct Word<'a> {
    pub(super) text: &'a str,
    pub(super) span: Range<usize>,
}

impl<'a> Word<'a> {
    /// The error that something else is expected here.
    pub(super) fn unexpected(&self, expected: impl Into<String>) -> SpannedError {
        SpannedError::input(self.span.clone(), quote(self.text), expected)
    }

    /// A part of it, with its span in the text.
    pub(super) fn part(&self, span: Range<usize>) -> Self {
        let start = self.span.start;
        let text = self.text.get(span.start - start..span.end - start);
        Self {
            text: text.unwrap_or_default(),
            span,
        }
    }

    /// The words of the list that this word is.
    pub(super) fn list(&self) -> Result<Vec<Self>, SpannedError> {
        let mut words = Words::new(self.text, self.span.start);
        let mut list = Vec::new();
        loop {
            match words.next()? {
                Next::Word(word) => list.push(word),
                // Inside a list the ends of commands are blanks.
                Next::EndOfCommand => {}
                Next::EndOfText => return Ok(list),
            }
        }
    }
}

/// The commands of a text, each with one word or more.
pub(super) fn commands(source: &str) -> Result<Vec<Vec<Word<'_>>>, SpannedError> {
    let text = source.strip_prefix('\u{feff}').unwrap_or(source);
    let mut words = Words::new(text, source.len() - text.len());
    let mut commands = Vec::new();
    let mut command = Vec::new();
    loop {
        if command.is_empty() {
            words.skip_comments();
        }
        match words.next()? {
            Next::Word(word) => command.push(word),
            end @ (Next::EndOfCommand | Next::EndOfText) => {
                if !command.is_empty() {
                    commands.push(std::mem::take(&mut command));
                }
                if matches!(end, Next::EndOfText) {
                    return Ok(commands);
                }
            }
        }
    }
}

enum Next<'a> {
    Word(Word<'a>),
    EndOfCommand,
    EndOfText,
}

/// A mark in a nested list.
pub(super) enum Mark<'a> {
    /// A brace; the list begins after it.
    Open(usize),
    /// A brace; the list ends before it.
    Close(usize),
    Word(Word<'a>),
    End,
}

/// Iterates over the marks of a list of lists, of any depth.
pub(super) struct Marks<'a> {
    words: Words<'a>,
}

impl<'a> Marks<'a> {
    /// The braces of a word are paired.
    pub(super) fn new(word: &Word<'a>) -> Self {
        let words = Words::new(word.text, word.span.start);
        Self { words }
    }

    pub(super) fn next(&mut self) -> Result<Mark<'a>, SpannedError> {
        let words = &mut self.words;
        loop {
            // Skipping cannot fail: it may skip nothing.
            let _ = blanks(&mut words.rest);
            match words.rest.strip_prefix(['\n', ';']) {
                Some(rest) => words.rest = rest,
                None => break,
            }
        }
        let at = words.at();
        let brace = match words.rest.chars().next() {
            None => return Ok(Mark::End),
            Some('{') => Mark::Open(at + 1),
            Some('}') => Mark::Close(at),
            Some(_) => return words.bare().map(Mark::Word),
        };
        words.rest = &words.rest[1..];
        Ok(brace)
    }
}

/// A position in a text of words.
struct Words<'a> {
    rest: &'a str,
    /// The position of the end of the text.
    end: usize,
}

type Plain<T> = Result<T, ContextError>;

fn blanks<'a>(input: &mut &'a str) -> Plain<&'a str> {
    let blank = take_while(1.., |c: char| c.is_whitespace() && c != '\n').void();
    let continued = alt(("\\\n", "\\\r\n")).void();
    winnow::combinator::repeat::<_, _, (), _, _>(0.., alt((blank, continued)))
        .take()
        .parse_next(input)
}

fn bare<'a>(input: &mut &'a str) -> Plain<&'a str> {
    take_till(1.., |c: char| {
        c.is_whitespace() || matches!(c, ';' | '{' | '}')
    })
    .parse_next(input)
}

impl<'a> Words<'a> {
    fn new(text: &'a str, start: usize) -> Self {
        let end = start + text.len();
        Self { rest: text, end }
    }

    fn at(&self) -> usize {
        self.end - self.rest.len()
    }

    /// Skips comments, which may stand where a command could begin.
    fn skip_comments(&mut self) {
        loop {
            self.rest = self
                .rest
                .trim_start_matches(|c: char| c.is_whitespace() || c == ';');
            if !self.rest.starts_with('#') {
                return;
            }
            let line = self.rest.find('\n').unwrap_or(self.rest.len());
            self.rest = &self.rest[line..];
        }
    }

    fn next(&mut self) -> Result<Next<'a>, SpannedError> {
        // Skipping cannot fail: it may skip nothing.
        let _ = blanks(&mut self.rest);
        match self.rest.chars().next() {
            None => Ok(Next::EndOfText),
            Some('\n' | ';') => {
                self.rest = &self.rest[1..];
                Ok(Next::EndOfCommand)
            }
            Some('{') => self.braced().map(Next::Word),
            Some('}') => {
                let at = self.at();
                let expected = "an opening `{` before it";
                Err(SpannedError::input(at..at + 1, "a closing `}`", expected))
            }
            Some('"') => self.quoted().map(Next::Word),
            Some(_) => self.bare().map(Next::Word),
        }
    }

    /// Takes a number of bytes as a word, and skips the delimiters before and after it.
    fn take(&mut self, before: usize, length: usize, after: usize) -> Word<'a> {
        let start = self.at() + before;
        let text = &self.rest[before..before + length];
        self.rest = &self.rest[before + length + after..];
        Word {
            text,
            span: start..start + length,
        }
    }

    fn braced(&mut self) -> Result<Word<'a>, SpannedError> {
        let mut depth = 0usize;
        let mut escaped = false;
        for (at, byte) in self.rest.bytes().enumerate() {
            match byte {
                _ if escaped => escaped = false,
                b'\\' => escaped = true,
                b'{' => depth += 1,
                b'}' => {
                    depth -= 1;
                    if depth == 0 {
                        let word = self.take(1, at - 1, 1);
                        return self.separated(word);
                    }
                }
                _ => {}
            }
        }
        let at = self.at();
        Err(SpannedError::input(
            at..at + 1,
            "a brace without an end",
            "a closing `}`",
        ))
    }

    fn quoted(&mut self) -> Result<Word<'a>, SpannedError> {
        let Some(length) = self.rest[1..].find('"') else {
            let at = self.at();
            return Err(SpannedError::input(
                at..at + 1,
                "a text without an end",
                "a closing `\"`",
            ));
        };
        let word = self.take(1, length, 1);
        let word = self.separated(word)?;
        literal(word)
    }

    fn bare(&mut self) -> Result<Word<'a>, SpannedError> {
        let mut ahead = self.rest;
        // There is a character, so it takes at least one.
        let _ = bare(&mut ahead);
        let length = self.rest.len() - ahead.len();
        let word = self.take(0, length, 0);
        literal(word)
    }

    /// A word in braces or quotes must end there.
    fn separated(&self, word: Word<'a>) -> Result<Word<'a>, SpannedError> {
        match self.rest.chars().next() {
            Some(c) if !c.is_whitespace() && c != ';' && !self.rest.starts_with("\\\n") => {
                let at = self.at();
                let text = &self.rest[..c.len_utf8()];
                let span = at..at + c.len_utf8();
                Err(SpannedError::input(
                    span,
                    quote(text),
                    "a blank between two words",
                ))
            }
            _ => Ok(word),
        }
    }
}

/// Refuses Tcl's substitutions: words in a text database are literal.
fn literal(word: Word<'_>) -> Result<Word<'_>, SpannedError> {
    match word.text.find(['$', '[', '\\']) {
        None => Ok(word),
        Some(at) => {
            let start = word.span.start + at;
            let found = format!("{} outside braces", quote(&word.text[at..=at]));
            let expected = "words as they are, without substitutions";
            Err(SpannedError::input(start..start + 1, found, expected))
        }
    }
}
