//! Readers of the description languages, from text to tree.
//!
//! Nothing here accesses files: included ones come from a loader of the caller. Every error has its position in the text. No text, however deeply
//! nested, can overflow a reader's stack.

mod brlcad;
mod error;
mod frame;
mod includes;
mod json;
mod lexer;
mod notes;
mod number;
mod padl;
mod pov;
mod refusal;
mod region;
mod rigid_fit;
mod scad;
mod spanned;
mod sweep;

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

pub use error::{ErrorKind, ReadError};
use error::{OtherText, SpannedError};
pub use includes::{IncludeError, IncludeLoader, IncludePath, Includes, ValueOverride};

use crate::builder::{Builder, SolidId, TreeError};
use crate::lettering::Fonts;
use crate::tree::Tree;
use premio_text::escape::quote;

/// A description language.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// `.padl`, after PADL-2.
    Padl,
    /// `.csg`, OpenSCAD's flattened output.
    Csg,
    /// `.json`, the tree.
    Json,
    /// `.asc`, BRL-CAD's database as text; it is read only.
    Asc,
    /// `.pov` and `.inc`, POV-Ray's scene description language; it is read only.
    Pov,
}

impl Format {
    /// All languages.
    pub const ALL: [Self; 5] = [Self::Padl, Self::Csg, Self::Json, Self::Asc, Self::Pov];

    /// The language with a file name's extension; `None` for another extension.
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        let ending = path.as_ref().extension()?.to_str()?;
        match ending.to_ascii_lowercase().as_str() {
            "padl" => Some(Self::Padl),
            "csg" => Some(Self::Csg),
            "json" => Some(Self::Json),
            "asc" => Some(Self::Asc),
            "pov" | "inc" => Some(Self::Pov),
            _ => None,
        }
    }

    /// The extension of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Padl => "padl",
            Self::Csg => "csg",
            Self::Json => "json",
            Self::Asc => "asc",
            Self::Pov => "pov",
        }
    }
}

/// Which round shapes of OpenSCAD are read as polygons and polyhedra.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FacetLimit {
    /// Those with a `$fn` from 3 to this number, which are meant so; others are true circles.
    UpTo(u32),
    /// None.
    None,
    /// All, as OpenSCAD shows them.
    All,
}

impl FacetLimit {
    /// The limit as a model records it; `None` for the default.
    pub fn recorded(self) -> Option<String> {
        (self != Self::default()).then(|| self.to_string())
    }

    /// The limit that a model records. Older ones record whether all circles are smooth.
    ///
    /// # Errors
    /// The text is no limit.
    pub fn from_record(is_smooth: bool, text: Option<&str>) -> Result<Self, FacetLimitError> {
        match text {
            _ if is_smooth => Ok(Self::None),
            Some(text) => text.parse(),
            None => Ok(Self::default()),
        }
    }
}

impl std::fmt::Display for FacetLimit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::UpTo(limit) => write!(f, "{limit}"),
            Self::None => f.write_str("none"),
            Self::All => f.write_str("all"),
        }
    }
}

/// A text is no limit of facets.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0:?} is not a number of sides from 3 to 10000, `none` or `all`")]
pub struct FacetLimitError(String);

impl std::str::FromStr for FacetLimit {
    type Err = FacetLimitError;

    fn from_str(text: &str) -> Result<Self, FacetLimitError> {
        match text {
            "none" => Ok(Self::None),
            "all" => Ok(Self::All),
            _ => match text.parse() {
                Ok(limit @ 3..=10_000) => Ok(Self::UpTo(limit)),
                _ => Err(FacetLimitError(text.to_owned())),
            },
        }
    }
}

impl Default for FacetLimit {
    fn default() -> Self {
        Self::UpTo(12)
    }
}

/// How a description is read.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ReadOptions {
    /// Which circles of `.csg` are read as polygons.
    pub facets: FacetLimit,
    /// The name of the part to read, for languages in which parts have names. By default it is the
    /// last solid assigned in `.padl`, the only object that no other contains in `.asc`, and the
    /// whole scene in `.pov`.
    pub part: Option<String>,
    /// Other values for names that a `.padl` text sets.
    pub overrides: Vec<ValueOverride>,
    /// The loader of the files that a `.padl` text includes, and a `.csg` text imports.
    pub includes: Includes,
    /// The fonts of texts.
    pub fonts: Fonts,
}

/// A remark for the author, and its span in the text in bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Note {
    /// The remark.
    pub text: String,
    /// The span.
    pub span: Range<usize>,
}

/// The result of reading.
#[derive(Debug, Clone, PartialEq)]
pub struct Description {
    /// The solid.
    pub tree: Tree,
    /// The noise of the coordinates relative to their size, if rounded numbers of the text had to
    /// be replaced; `None` if all numbers are exact.
    pub digits: Option<f64>,
    /// The remarks for the author.
    pub notes: Vec<Note>,
}

/// A part as it was written, by its operations and motions, without copies.
#[derive(Debug)]
pub struct Program {
    /// The parts of the text.
    pub builder: Builder,
    /// The requested part.
    pub part: SolidId,
    /// The noise of the coordinates; see [`Description::digits`].
    pub digits: Option<f64>,
    /// The remarks for the author.
    pub notes: Vec<Note>,
    /// A text that describes the same parts without other files and overrides.
    pub standalone: StandaloneText,
    /// The files that the text includes, in the order in which they were read.
    pub included: Vec<IncludePath>,
    /// The position of the part.
    place: PartPlace,
}

/// A text that describes the same parts as another one, without other files and overrides.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StandaloneText {
    /// The text that was read.
    AsRead,
    /// Another text in the same language.
    Rewritten(String),
    /// There is none in the same language: the text imports files, or has fonts of the machine.
    Unavailable,
}

impl StandaloneText {
    /// The other text in the same language, if there is one.
    pub fn rewritten(&self) -> Option<&str> {
        match self {
            Self::Rewritten(text) => Some(text),
            Self::AsRead | Self::Unavailable => None,
        }
    }
}

/// The position of a part: its span, and the text if it is not the one that was read.
#[derive(Debug, Default)]
struct PartPlace {
    span: Range<usize>,
    text: Option<Arc<OtherText>>,
}

impl PartPlace {
    fn new(span: Range<usize>) -> Self {
        Self { span, text: None }
    }
}

impl Program {
    /// The tree of the part. `name` and `bytes` must be those that were read.
    ///
    /// # Errors
    /// The tree exceeds a limit; the error has the position of the part in the text.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio_csg::reader::{Format, ReadOptions, parse};
    ///
    /// let text = b"A = SPH(R=1)";
    /// let program = parse("a.padl", text, Format::Padl, &ReadOptions::default())?;
    /// assert_eq!(program.tree("a.padl", text)?.leaves().count(), 1);
    /// # Ok::<(), premio_csg::reader::ReadError>(())
    /// ```
    pub fn tree(&self, name: &str, bytes: &[u8]) -> Result<Tree, ReadError> {
        self.finished().map_err(|fault| fault.locate(name, bytes))
    }

    fn finished(&self) -> Result<Tree, SpannedError> {
        self.builder.finish(self.part).map_err(|error| {
            let PartPlace { span, text } = &self.place;
            let found = error.to_string();
            let error = match error {
                TreeError::Unbounded(_) => {
                    let expected = "solids that bound it on every side";
                    SpannedError::input(span.clone(), found, expected)
                }
                _ => {
                    let expected = "a description within the limits";
                    SpannedError::limit(span.clone(), found, expected)
                }
            };
            error.moved(span.clone(), text.clone())
        })
    }

    /// The tree of the part. If it exceeds a limit, the error points at the whole part.
    fn description(self) -> Result<Description, SpannedError> {
        Ok(Description {
            tree: self.finished()?,
            digits: self.digits,
            notes: self.notes,
        })
    }
}

/// Reads a description. `name` is used in messages.
///
/// # Errors
/// The text does not describe a solid in this format, or it is beyond a stated limit.
pub fn read(
    name: &str,
    bytes: &[u8],
    format: Format,
    options: &ReadOptions,
) -> Result<Description, ReadError> {
    parse_bytes(name, bytes, format, options)
        .and_then(Program::description)
        .map_err(|fault| fault.locate(name, bytes))
}

/// Reads a description in a form that can be written again. `name` is used in messages.
///
/// # Errors
/// The text does not describe a solid in this format, or it is beyond a stated limit.
pub fn parse(
    name: &str,
    bytes: &[u8],
    format: Format,
    options: &ReadOptions,
) -> Result<Program, ReadError> {
    parse_bytes(name, bytes, format, options).map_err(|fault| fault.locate(name, bytes))
}

fn parse_bytes(
    name: &str,
    bytes: &[u8],
    format: Format,
    options: &ReadOptions,
) -> Result<Program, SpannedError> {
    let source = utf8(bytes, 0)?;
    if options.part.is_some() && matches!(format, Format::Csg | Format::Json) {
        let found = "a part requested by name";
        let expected = "a `.padl`, `.asc` or `.pov` file, in which parts have names";
        return Err(SpannedError::input(0..0, found, expected));
    }
    if let (Some(first), false) = (options.overrides.first(), format == Format::Padl) {
        let found = format!("another value for {}", quote(&first.name));
        let expected = "a `.padl` file, in which numbers have names";
        return Err(SpannedError::input(0..0, found, expected));
    }
    match format {
        Format::Padl => padl::read(name, source, options),
        Format::Csg => scad::read(name, source, options),
        Format::Json => json::read(source),
        Format::Asc => brlcad::read(source, options),
        Format::Pov => pov::read(source, options),
    }
}

/// The text of bytes whose positions are counted from `base`.
fn utf8(bytes: &[u8], base: usize) -> Result<&str, SpannedError> {
    std::str::from_utf8(bytes).map_err(|error| {
        let at = error.valid_up_to();
        let byte = bytes.get(at).copied().unwrap_or_default();
        let span = base + at..base + at + 1;
        SpannedError::input(span, format!("the byte {byte:#04x}"), "a text in UTF-8")
    })
}
