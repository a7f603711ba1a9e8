//! The tokens of the languages, each with its span in the text.

use std::ops::Range;

use winnow::ascii::{digit0, digit1};
use winnow::combinator::{alt, not, opt, peek, preceded, repeat};
use winnow::error::ContextError;
use winnow::prelude::*;
use winnow::token::{any, none_of, one_of, take_till, take_until, take_while};

use super::error::SpannedError;
use premio_text::escape::quote;

/// The lexical differences between the languages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dialect {
    /// `#` comments; line ends are significant; ranges such as `0..7`.
    Padl,
    /// `//` and `/* */` comments.
    Scad,
    /// No comments.
    Json,
    /// `//` comments and nested `/* */` comments; more symbols.
    Pov,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Token {
    Name,
    /// Without a sign.
    Number,
    /// With its quotes.
    Text,
    Symbol(char),
    /// `..`
    Range,
    Newline,
    End,
}

/// A token and its span.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Lexeme {
    pub(super) token: Token,
    start: usize,
    end: usize,
}

impl Lexeme {
    pub(super) fn span(self) -> Range<usize> {
        self.start..self.end
    }

    pub(super) fn is(self, symbol: char) -> bool {
        self.token == Token::Symbol(symbol)
    }
}

type Plain<T> = Result<T, ContextError>;

fn exponent<'a>(input: &mut &'a str) -> Plain<&'a str> {
    (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1)
        .take()
        .parse_next(input)
}

fn number<'a>(dialect: Dialect) -> impl FnMut(&mut &'a str) -> Plain<&'a str> {
    // The two points of a range belong to no number.
    let range = move |input: &mut &'a str| match dialect {
        Dialect::Padl => peek('.').void().parse_next(input),
        _ => winnow::combinator::fail.parse_next(input),
    };
    move |input| {
        let whole = (digit1, opt(('.', not(range), digit0))).void();
        let fraction = ('.', digit1).void();
        (alt((whole, fraction)), opt(exponent))
            .take()
            .parse_next(input)
    }
}

fn name<'a>(input: &mut &'a str) -> Plain<&'a str> {
    let first = |c: char| c.is_alphabetic() || c == '_' || c == '$';
    let later = |c: char| c.is_alphanumeric() || c == '_';
    (one_of(first), take_while(0.., later))
        .take()
        .parse_next(input)
}

fn quoted<'a>(input: &mut &'a str) -> Plain<&'a str> {
    let unescaped = none_of(['"', '\\', '\n']).void();
    let escaped = ('\\', any).void();
    let inside = repeat::<_, _, (), _, _>(0.., alt((unescaped, escaped)));
    ('"', inside, '"').take().parse_next(input)
}

fn comment<'a>(dialect: Dialect) -> impl FnMut(&mut &'a str) -> Plain<()> {
    move |input| match dialect {
        Dialect::Padl => preceded('#', take_till(0.., ['\n']))
            .void()
            .parse_next(input),
        Dialect::Scad => alt((
            preceded("//", take_till(0.., ['\n'])).void(),
            ("/*", take_until(0.., "*/"), "*/").void(),
        ))
        .parse_next(input),
        Dialect::Json => winnow::combinator::fail.parse_next(input),
        Dialect::Pov => alt((
            preceded("//", take_till(0.., ['\n'])).void(),
            nested_comment,
        ))
        .parse_next(input),
    }
}

/// A comment that may contain comments.
fn nested_comment(input: &mut &str) -> Plain<()> {
    let rest = "/*".parse_next(input).map(|_| *input)?;
    let mut depth = 1usize;
    let marks = rest.match_indices(['*', '/']).map(|(at, _)| at);
    let mut after = 0;
    for at in marks.filter(|&at| at + 1 < rest.len()) {
        match &rest.as_bytes()[at..at + 2] {
            _ if at < after => continue,
            b"/*" => depth += 1,
            b"*/" => depth -= 1,
            _ => continue,
        }
        after = at + 2;
        if depth == 0 {
            *input = &rest[after..];
            return Ok(());
        }
    }
    winnow::combinator::fail.parse_next(input)
}

fn skipped<'a>(dialect: Dialect) -> impl FnMut(&mut &'a str) -> Plain<()> {
    let white = move |c: char| c.is_whitespace() && !(dialect == Dialect::Padl && c == '\n');
    move |input| {
        repeat::<_, _, (), _, _>(0.., alt((take_while(1.., white).void(), comment(dialect))))
            .parse_next(input)
    }
}

fn word(dialect: Dialect, input: &mut &str) -> Plain<Token> {
    let more = |c: char| dialect == Dialect::Pov && matches!(c, '<' | '>' | '.' | '?' | '&' | '|');
    let range = move |input: &mut &str| match dialect {
        Dialect::Padl => "..".value(Token::Range).parse_next(input),
        _ => winnow::combinator::fail.parse_next(input),
    };
    alt((
        number(dialect).value(Token::Number),
        name.value(Token::Name),
        quoted.value(Token::Text),
        '\n'.value(Token::Newline),
        one_of([
            '(', ')', '[', ']', '{', '}', '=', ',', ';', ':', '+', '-', '*', '/', '%', '#', '!',
        ])
        .map(Token::Symbol),
        range,
        one_of(more).map(Token::Symbol),
    ))
    .parse_next(input)
}

/// All tokens of a text, the last of which is [`Token::End`].
fn lex(source: &str, dialect: Dialect) -> Result<Vec<Lexeme>, SpannedError> {
    let mut rest = source.strip_prefix('\u{feff}').unwrap_or(source);
    let mut lexemes = Vec::new();
    loop {
        // Skipping cannot fail: it may skip nothing.
        let _ = skipped(dialect).parse_next(&mut rest);
        let start = source.len() - rest.len();
        if rest.is_empty() {
            lexemes.push(Lexeme {
                token: Token::End,
                start,
                end: start,
            });
            return Ok(lexemes);
        }
        // The rest of a comment that has no end; its first two characters are symbols, too.
        let comments = matches!(dialect, Dialect::Scad | Dialect::Pov);
        if comments && rest.starts_with("/*") {
            return Err(unreadable(source, start));
        }
        match word(dialect, &mut rest) {
            Ok(token) => {
                let end = source.len() - rest.len();
                lexemes.push(Lexeme { token, start, end });
            }
            Err(_) => return Err(unreadable(source, start)),
        }
    }
}

fn unreadable(source: &str, start: usize) -> SpannedError {
    let rest = &source[start..];
    if rest.starts_with('"') {
        return SpannedError::input(start..start + 1, "a text without an end", "a closing `\"`");
    }
    if rest.starts_with("/*") {
        return SpannedError::input(
            start..start + 2,
            "a comment without an end",
            "a closing `*/`",
        );
    }
    let first: String = rest.chars().take(1).collect();
    let span = start..start + first.len();
    SpannedError::input(
        span,
        quote(&first),
        "a name, a number or a symbol of the language",
    )
}

/// A position among the tokens of a text.
pub(super) struct Cursor<'a> {
    source: &'a str,
    /// Added to all positions.
    base: usize,
    /// The end of the text in words.
    end_words: &'static str,
    lexemes: Vec<Lexeme>,
    at: usize,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(source: &'a str, dialect: Dialect) -> Result<Self, SpannedError> {
        Self::with_base(source, dialect, 0)
    }

    /// The tokens of a text whose positions are counted from `base`.
    pub(super) fn with_base(
        source: &'a str,
        dialect: Dialect,
        base: usize,
    ) -> Result<Self, SpannedError> {
        let mut lexemes = lex(source, dialect).map_err(|error| {
            let Range { start, end } = error.span();
            error.moved(base + start..base + end, None)
        })?;
        for lexeme in &mut lexemes {
            lexeme.start += base;
            lexeme.end += base;
        }
        Ok(Self {
            source,
            base,
            end_words: "the end of the file",
            lexemes,
            at: 0,
        })
    }

    pub(super) fn peek(&self) -> Lexeme {
        self.peek_at(0)
    }

    /// Says what ends with the text, where it is not a file.
    pub(super) fn name_end(&mut self, words: &'static str) {
        self.end_words = words;
    }

    /// The token after `ahead` others.
    pub(super) fn peek_at(&self, ahead: usize) -> Lexeme {
        let end = self.end();
        let last = Lexeme {
            token: Token::End,
            start: end,
            end,
        };
        self.lexemes.get(self.at + ahead).copied().unwrap_or(last)
    }

    /// The position of the end of the text.
    pub(super) fn end(&self) -> usize {
        self.base + self.source.len()
    }

    pub(super) fn next(&mut self) -> Lexeme {
        let lexeme = self.peek();
        self.at += 1;
        lexeme
    }

    /// Goes back to the last token.
    pub(super) fn back(&mut self) {
        self.at = self.at.saturating_sub(1);
    }

    /// The position after the last token that was taken.
    pub(super) fn previous_end(&self) -> usize {
        let last = self.at.checked_sub(1).and_then(|at| self.lexemes.get(at));
        last.map_or(self.base, |lexeme| lexeme.end)
    }

    pub(super) fn skip_newlines(&mut self) {
        while self.peek().token == Token::Newline {
            self.at += 1;
        }
    }

    pub(super) fn contains(&self, symbol: char) -> bool {
        self.lexemes.iter().any(|lexeme| lexeme.is(symbol))
    }

    pub(super) fn source(&self) -> &'a str {
        self.source
    }

    pub(super) fn text(&self, lexeme: Lexeme) -> &'a str {
        let Range { start, end } = lexeme.span();
        let span = start.saturating_sub(self.base)..end.saturating_sub(self.base);
        self.source.get(span).unwrap_or_default()
    }

    /// The error that something else is expected in place of a token.
    pub(super) fn unexpected(&self, lexeme: Lexeme, expected: impl Into<String>) -> SpannedError {
        let found = match lexeme.token {
            Token::End => self.end_words.to_owned(),
            Token::Newline => "the end of the line".to_owned(),
            _ => quote(self.text(lexeme)),
        };
        SpannedError::input(lexeme.span(), found, expected)
    }

    /// Takes a symbol, or reports what it was expected for.
    pub(super) fn expect(&mut self, symbol: char, what_for: &str) -> Result<Lexeme, SpannedError> {
        let lexeme = self.next();
        if lexeme.is(symbol) {
            Ok(lexeme)
        } else {
            Err(self.unexpected(lexeme, format!("`{symbol}` {what_for}")))
        }
    }
}
