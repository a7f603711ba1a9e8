//! Drawings of other programs as contours of segments and circular arcs: DXF and SVG, with the
//! meaning that OpenSCAD's `import` gives them.
//!
//! | module | what it gives |
//! | --- | --- |
//! | `error` | why a file is no drawing |
//! | `curves` | circles, arcs, ellipses and Bezier curves as edges, and maps of edges |
//! | `dxf` | the entities of a DXF file |
//! | `joining` | edges that share ends as closed contours |
//! | `region` | the region of a drawing |
//! | `svg` | the elements of an SVG file |

mod curves;
mod dxf;
mod error;
mod joining;
mod region;
mod svg;

use crate::figure::{ContourCorner, FigurePoint};
use premio_kernel::number::rational::Rational;

pub(crate) use dxf::read_dxf;
pub use error::DrawingFileError;
pub(crate) use region::figure;
pub(crate) use svg::read_svg;

/// What an `import` says besides the name of the file.
pub(crate) struct DrawingOptions<'a> {
    /// The only layer to read; all of them if it is absent or empty.
    pub layer: Option<&'a str>,
    /// The only element of an SVG file to read.
    pub id: Option<&'a str>,
    /// The point of a DXF file that becomes the origin.
    pub origin: FigurePoint,
    /// The factor of all lengths of a DXF file.
    pub scale: Rational,
    /// The number of user units of an SVG file in an inch: 72 if it is not greater than zero.
    pub dpi: Rational,
    /// Whether the middle of an SVG drawing becomes the origin.
    pub is_centred: bool,
    /// The number of sides of the polygon that stands for a circle of a radius; `None` for a true
    /// circle.
    pub sides: &'a mut dyn FnMut(&Rational) -> Option<u32>,
    /// The number of segments of a full turn of a curve that is no circular arc, by its radius.
    pub fragments: &'a dyn Fn(f64) -> u32,
}

/// Contours of which an odd number enclose each point of the shape.
pub(crate) type DrawingShape = Vec<Vec<ContourCorner>>;

/// The contents of a drawing file.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Drawing {
    /// The shapes. Their union is the region of the drawing.
    pub shapes: Vec<DrawingShape>,
    /// The number of curves that are no circular arcs, and were cut into segments.
    pub approximated: usize,
    /// The number of entities without effect, as in OpenSCAD.
    pub passed_over: usize,
    /// The number of open paths that a segment closes, as in OpenSCAD.
    pub completed: usize,
}

#[cfg(test)]
mod tests;
