//! Why a file is no drawing.

use crate::figure::{FigureError, MAX_EDGES};
use premio_text::escape::quote;

/// Why a file is no drawing.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DrawingFileError {
    /// A line of a DXF file is no group code.
    #[error("line {line}: {shown} is no group code", shown = quote(found))]
    GroupCode {
        /// The line, from 1.
        line: usize,
        /// The text in its place.
        found: String,
    },
    /// A text is no number.
    #[error("line {line}: {shown} is no number", shown = quote(found))]
    Number {
        /// The line, from 1.
        line: usize,
        /// The text in its place.
        found: String,
    },
    /// An entity of a DXF file lacks coordinates.
    #[error("line {line}: {shown} has too few coordinates", shown = quote(entity))]
    Incomplete {
        /// The line at which the entity starts, from 1.
        line: usize,
        /// The name of the entity.
        entity: String,
    },
    /// The bytes of an SVG file are no UTF-8.
    #[error("the file is no text in UTF-8")]
    Encoding,
    /// An SVG file is no XML.
    #[error("no XML: {message}")]
    Xml {
        /// What the parser says, with the line.
        message: String,
    },
    /// An attribute of an SVG file is malformed.
    #[error("line {line}: the attribute `{attribute}` is malformed: {message}")]
    Attribute {
        /// The line at which the element starts, from 1.
        line: u32,
        /// The name of the attribute.
        attribute: &'static str,
        /// What the parser says.
        message: String,
    },
    /// Elements of an SVG file use each other in a circle, or too deeply.
    #[error("line {line}: the element uses itself, or elements within elements too deeply")]
    Nesting {
        /// The line at which the element starts, from 1.
        line: u32,
    },
    /// The stroke of an open path has no outline.
    #[error("line {line}: the stroke of an open path: {error}")]
    Stroke {
        /// The line at which the element starts, from 1.
        line: u32,
        /// Why.
        error: FigureError,
    },
    /// There are too many edges.
    #[error("the drawing has more than {MAX_EDGES} edges")]
    TooManyEdges,
    /// A number is too large for a coordinate, or has too many digits.
    #[error("the drawing has a coordinate that is too large or too long")]
    Coordinate,
}
