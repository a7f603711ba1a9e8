//! Why a file is no drawing.

use crate::figure::MAX_EDGES;
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
    /// There are too many edges.
    #[error("the drawing has more than {MAX_EDGES} edges")]
    TooManyEdges,
    /// A number is too large for a coordinate, or has too many digits.
    #[error("the drawing has a coordinate that is too large or too long")]
    Coordinate,
}
