//! Readers of the description languages: text in, tree out.
//!
//! Nothing here touches files. Every error has its place in the text, and no text, however deep
//! its brackets, makes a reader overflow the stack.

mod error;
mod json;
mod lexer;
mod number;
mod padl;
mod scad;
#[cfg(test)]
mod tests;

use std::ops::Range;
use std::path::Path;

use error::Fault;
pub use error::{ErrorKind, ReadError};

use crate::builder::{Builder, Part};
use crate::tree::Tree;

/// A description language.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// `.padl`, after PADL-2.
    Padl,
    /// `.csg`, OpenSCAD's flattened output.
    Csg,
    /// `.json`, the tree.
    Json,
}

impl Format {
    /// The language that a file's ending says; `None` for another ending.
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        let ending = path.as_ref().extension()?.to_str()?;
        match ending.to_ascii_lowercase().as_str() {
            "padl" => Some(Self::Padl),
            "csg" => Some(Self::Csg),
            "json" => Some(Self::Json),
            _ => None,
        }
    }
}

/// How to read.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Options {
    /// Reads a `.csg` primitive with a small `$fn` as the smooth one.
    pub smooth: bool,
    /// The part to read from a `.padl` text; the last solid assigned if absent.
    pub part: Option<String>,
}

/// Something the author may want to know, and its place in the text in bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// What there is to know.
    pub text: String,
    /// The place.
    pub span: Range<usize>,
}

/// What was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// The solid.
    pub tree: Tree,
    /// The noise of the coordinates relative to their size, where the text holds rounded
    /// numbers that had to be replaced; `None` for exact numbers.
    pub digits: Option<f64>,
    /// What the author may want to know.
    pub notes: Vec<Note>,
}

/// Reads a description. `name` is what messages call it.
pub fn read(
    name: &str,
    bytes: &[u8],
    format: Format,
    options: &Options,
) -> Result<Description, ReadError> {
    read_bytes(bytes, format, options).map_err(|fault| fault.locate(name, bytes))
}

fn read_bytes(bytes: &[u8], format: Format, options: &Options) -> Result<Description, Fault> {
    let source = std::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        let byte = bytes.get(at).copied().unwrap_or_default();
        Fault::input(
            at..at + 1,
            format!("the byte {byte:#04x}"),
            "a text in UTF-8",
        )
    })?;
    if options.part.is_some() && format != Format::Padl {
        let found = "a part asked for by name";
        return Err(Fault::input(
            0..0,
            found,
            "a `.padl` file, in which parts have names",
        ));
    }
    match format {
        Format::Padl => padl::read(source, options),
        Format::Csg => scad::read(source, options),
        Format::Json => json::read(source),
    }
}

/// The tree of a part; a tree beyond its limits is pointed at as a whole.
fn finish(builder: &Builder, part: Part, span: Range<usize>) -> Result<Tree, Fault> {
    builder
        .finish(part)
        .map_err(|error| Fault::limit(span, error.to_string(), "a description within the limits"))
}
