//! Messages, with their position in a text where they have one: for people, and for programs.

use super::excerpt::Excerpt;
use annotate_snippets::{Group, Level as Title, Renderer};
use premio_csg::reader::ReadError;
use premio_kernel::number::predicates::CloseCall;
use premio_text::{LineColumn, escape};
use serde::Serialize;
use std::io::{self, IsTerminal};
use std::ops::Range;

/// An error or a note.
#[derive(Debug, Default)]
pub struct Message {
    text: String,
    excerpt: Option<Excerpt>,
    place: Option<Place>,
    calls: Vec<CloseCall>,
}

/// A position in a text, with the error there.
#[derive(Debug, Serialize)]
struct Place {
    file: String,
    line: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    column: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    found: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    expected: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<String>,
}

impl Place {
    /// A line without a column.
    fn line(file: &str, line: usize) -> Self {
        Self {
            file: file.to_owned(),
            line,
            column: None,
            found: None,
            expected: None,
            help: None,
        }
    }
}

/// The severity of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Level {
    /// There is no result.
    Error,
    /// There is one.
    Note,
}

/// A message for programs: one line.
#[derive(Serialize)]
struct Line<'a> {
    schema: &'static str,
    level: Level,
    #[serde(skip_serializing_if = "Option::is_none")]
    status: Option<u8>,
    text: &'a str,
    #[serde(flatten)]
    place: Option<&'a Place>,
    #[serde(skip_serializing_if = "<[CloseCall]>::is_empty")]
    close_calls: &'a [CloseCall],
}

impl Message {
    /// A message without a position.
    pub fn without_excerpt(text: impl Into<String>) -> Self {
        Self {
            text: text.into(),
            ..Self::default()
        }
    }

    /// The error of a reader, with its position.
    pub fn of_reader(error: &ReadError, text: &[u8]) -> Self {
        Self {
            text: error.to_string(),
            excerpt: Some(Excerpt::new(error.line, &error.span, text)),
            place: Some(Place {
                file: error.name.to_string(),
                line: error.line,
                column: Some(error.column),
                found: Some(error.found.to_string()),
                expected: Some(error.expected.to_string()),
                help: error.help.as_ref().map(ToString::to_string),
            }),
            ..Self::default()
        }
    }

    /// The error of a byte range of a text.
    pub fn at(name: &str, text: &[u8], span: &Range<usize>, words: &str) -> Self {
        let LineColumn { line, column } = LineColumn::new(text, span.start);
        Self {
            text: format!("{name}:{line}:{column}: {words}"),
            excerpt: Some(Excerpt::new(line, span, text)),
            place: Some(Place {
                column: Some(column),
                ..Place::line(name, line)
            }),
            ..Self::default()
        }
    }

    /// A message about a line of a file.
    pub fn at_line(file: &str, line: usize, text: &str) -> Self {
        Self {
            text: text.to_owned(),
            place: Some(Place::line(file, line)),
            ..Self::default()
        }
    }

    /// The message with its close calls.
    pub fn with_calls(self, calls: &[CloseCall]) -> Self {
        let calls = calls.to_vec();
        Self { calls, ..self }
    }

    /// The message with its excerpt, in colours on a terminal.
    pub fn render(&self) -> String {
        let renderer = match io::stderr().is_terminal() && !is_without_colours() {
            true => Renderer::styled(),
            false => Renderer::plain(),
        };
        let text = escape::terminal(&self.text);
        let title = Title::ERROR.primary_title(text);
        let group = match &self.excerpt {
            Some(excerpt) => title.element(excerpt.snippet()),
            None => Group::with_title(title),
        };
        renderer.term_width(WIDTH).render(&[group])
    }

    /// A note as text, with its file and line where it has them.
    pub fn note(&self) -> String {
        let note = match &self.place {
            Some(Place { file, line, .. }) => format!("{file}:{line}: note: {}", self.text),
            None => format!("note: {}", self.text),
        };
        escape::terminal(&note)
    }

    /// As JSON in one line (premio.message/1).
    pub fn line(&self, level: Level, status: Option<u8>) -> String {
        let line = Line {
            schema: "premio.message/1",
            level,
            status,
            text: &self.text,
            place: self.place.as_ref(),
            close_calls: &self.calls,
        };
        escape::json(serde_json::to_string(&line).unwrap_or_else(|e| e.to_string()))
    }
}

/// The greatest width of an excerpt, in columns.
const WIDTH: usize = 200;

/// Whether the environment disables colours (no-color.org).
fn is_without_colours() -> bool {
    std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;
    use premio_csg::reader::{Format, ReadOptions, read};

    fn message(text: &[u8]) -> Message {
        let error = read("part.padl", text, Format::Padl, &ReadOptions::default()).unwrap_err();
        Message::of_reader(&error, text)
    }

    fn rendered(text: &[u8]) -> String {
        message(text).render()
    }

    #[test]
    fn a_message_for_programs_is_one_line() {
        let line = message(b"A = SPH(R=1)\nB = SPG(R=2)\n").line(Level::Error, Some(2));
        assert!(!line.contains('\n'));
        let value: serde_json::Value = serde_json::from_str(&line).unwrap();
        assert_eq!(value["schema"], "premio.message/1");
        assert_eq!(
            (&value["level"], &value["status"]),
            (&"error".into(), &2.into())
        );
        assert_eq!((&value["line"], &value["column"]), (&2.into(), &5.into()));
        assert_eq!(value["file"], "part.padl");
        assert_eq!(value["help"], "did you mean `SPH`?");
        let note = Message::at_line("a.pov", 7, "something").line(Level::Note, None);
        let value: serde_json::Value = serde_json::from_str(&note).unwrap();
        assert_eq!(
            (&value["line"], &value["text"]),
            (&7.into(), &"something".into())
        );
        assert!(value.get("status").is_none() && value.get("column").is_none());
    }

    #[test]
    fn a_message_shows_its_place() {
        let shown = rendered(b"A = SPH(R=1)\nB = SPG(R=2)\n");
        assert!(shown.contains("part.padl:2:5: found"), "{shown}");
        assert!(shown.contains("B = SPG(R=2)"), "{shown}");
        let caret = shown.lines().find(|l| l.contains('^')).unwrap();
        let line = shown.lines().find(|l| l.contains("B = SPG")).unwrap();
        assert_eq!(
            caret.find('^').unwrap(),
            line.find("SPG").unwrap(),
            "{shown}"
        );
    }

    #[test]
    fn any_text_can_be_shown() {
        let long = [b"A = SPH(R=1".as_slice(), &[b' '; 100_000], b"\xc3\x28)"].concat();
        assert!(rendered(&long).len() < 1000);
        for text in [
            &b""[..],
            b"\xff",
            b"\n\n\n",
            b"A = (\n\n",
            b"A\t=\t\xe2\x82)\r\n",
            b"\r",
        ] {
            assert!(!rendered(text).is_empty());
        }
    }
}
