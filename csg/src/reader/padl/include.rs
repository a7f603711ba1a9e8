//! `INCLUDE`: the statements of another file, in place of the statement.

use std::sync::Arc;

use super::super::error::SpannedError;
use super::super::includes::{IncludeLoader, IncludePath};
use super::super::lexer::{Lexeme, Token};
use super::super::utf8;
use super::keywords::INCLUDE;
use super::parser::Parser;
use super::read_text;
use super::session::{OpenFile, TextPiece};
use premio_text::escape::quote;

/// The largest number of files that include each other, one inside the other.
const MAX_NESTING: usize = 32;

/// The largest number of included files.
const MAX_FILES: usize = 1000;

impl Parser<'_, '_, '_> {
    /// Reads the statement after its word.
    pub(super) fn include(&mut self, word: Lexeme) -> Result<(), SpannedError> {
        let lexeme = self.cursor.next();
        if lexeme.token != Token::Text {
            let expected =
                format!("the name of a file in quotes, as in `{INCLUDE} \"holes.padl\"`");
            return Err(self.cursor.unexpected(lexeme, expected));
        }
        let after = self.cursor.peek();
        if !matches!(after.token, Token::Newline | Token::End) {
            return Err(self.cursor.unexpected(after, "the end of the line"));
        }
        let path = self.cursor.text(lexeme).trim_matches('"').to_owned();
        check_path(&path, lexeme)?;
        self.cut(word.span().start..lexeme.span().end, String::new());
        let options = self.session.options;
        let Some(loader) = options.includes.loader() else {
            let found = format!("`{INCLUDE}`, and no way to read other files");
            return Err(SpannedError::input(
                word.span(),
                found,
                "a text in one file",
            ));
        };
        let file = self.find(loader, &path, lexeme)?;
        let known = &self.session.included;
        if known.iter().any(|known| known.identity == file.identity) {
            return Ok(());
        }
        self.check_limits(&file, lexeme)?;
        let bytes = loader
            .load(&file)
            .map_err(|error| unreadable(&path, &error, lexeme))?;
        self.read_included(file, bytes.into(), lexeme)
    }

    /// Finds a file, which must not be one that is being read.
    fn find(
        &mut self,
        loader: &dyn IncludeLoader,
        path: &str,
        lexeme: Lexeme,
    ) -> Result<IncludePath, SpannedError> {
        if let [
            OpenFile {
                name,
                identity: identity @ None,
            },
        ] = self.session.open.as_mut_slice()
        {
            *identity = loader.find(None, name).ok().map(|main| main.identity);
        }
        let including = self.session.open.last().map(|file| file.name.as_str());
        let file = loader
            .find(including, path)
            .map_err(|error| unreadable(path, &error, lexeme))?;
        let is_it = |open: &OpenFile| open.identity.as_deref() == Some(&file.identity);
        let Some(first) = self.session.open.iter().position(is_it) else {
            return Ok(file);
        };
        let cycle = self.session.open[first..]
            .iter()
            .map(|open| open.name.as_str());
        let cycle: Vec<&str> = cycle.chain([file.name.as_str()]).collect();
        let found = format!("{}, which is being read", quote(path));
        let expected = "a file that does not include this one";
        let fault = SpannedError::input(lexeme.span(), found, expected);
        Err(fault.help(format!(
            "{} includes itself: {}",
            file.name,
            cycle.join(", ")
        )))
    }

    fn check_limits(&self, file: &IncludePath, lexeme: Lexeme) -> Result<(), SpannedError> {
        let nesting = self.session.open.len();
        let limit = |found: String, expected: String| {
            Err(SpannedError::limit(lexeme.span(), found, expected))
        };
        let name = quote(&file.name);
        if nesting > MAX_NESTING {
            let found = format!("{name}, inside {nesting} other files");
            return limit(found, format!("at most {MAX_NESTING}"));
        }
        if self.session.included.len() >= MAX_FILES {
            let found = format!("{name}, after {MAX_FILES} other files");
            return limit(found, format!("at most {MAX_FILES} included files"));
        }
        Ok(())
    }

    /// Reads the statements of an included file.
    fn read_included(
        &mut self,
        file: IncludePath,
        bytes: Arc<[u8]>,
        lexeme: Lexeme,
    ) -> Result<(), SpannedError> {
        let at = lexeme.span().start;
        let session = &mut *self.session;
        let base = session.sources.add(&file.name, Arc::clone(&bytes), at);
        session.included.push(file.clone());
        session.open.push(OpenFile {
            name: file.name,
            identity: Some(file.identity),
        });
        let result = utf8(&bytes, base).and_then(|text| {
            let uncut = read_text(session, text, base)?;
            session
                .pieces
                .push(TextPiece::Span(uncut..base + text.len()));
            session.pieces.push(TextPiece::Text("\n".to_owned()));
            Ok(())
        });
        session.open.pop();
        result.map_err(|error| match error.is_in_other_text() {
            true => error,
            false => {
                let line = session.sources.line(at);
                session
                    .sources
                    .locate(error)
                    .context(&format!("included on {line}"))
            }
        })
    }
}

/// Checks that a path is that of a `.padl` file near the including one.
fn check_path(path: &str, lexeme: Lexeme) -> Result<(), SpannedError> {
    let expected = if path.contains('\\') {
        "a path with `/` between its folders"
    } else if path.starts_with('/') || path.contains(':') {
        "a path relative to the folder of this file"
    } else if !path.to_ascii_lowercase().ends_with(".padl") {
        "a file that ends in `.padl`"
    } else {
        return Ok(());
    };
    Err(SpannedError::input(lexeme.span(), quote(path), expected))
}

fn unreadable(path: &str, error: &super::super::IncludeError, lexeme: Lexeme) -> SpannedError {
    let found = format!("{}, which is not read: {error}", quote(path));
    SpannedError::input(lexeme.span(), found, "a file that can be read")
}
