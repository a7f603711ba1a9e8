//! `import` and `surface`: drawings, meshes and height fields of other programs.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::Path;
use std::sync::Arc;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::includes::{IncludePath, Includes};
use super::super::notes::Notes;
use super::super::region::{Region, bad_figure};
use super::arguments::{Argument, Arguments};
use super::facets::{FacetRule, fragments};
use crate::drawing_file::{self, Drawing, DrawingFileError, DrawingOptions};
use crate::figure::FigureError;
use crate::height_field::HeightField;
use crate::mesh_file::{MeshFile, MeshFormat, MeshReadOptions, ObjectPlacement};
use crate::polyhedron::{MAX_CORNERS, Polyhedron, PolyhedronError};

/// The files that a text imports.
pub(super) struct ImportedFiles<'a> {
    /// The name of the text.
    name: &'a str,
    includes: &'a Includes,
    /// Their bytes, by their identity.
    loaded: BTreeMap<String, Arc<[u8]>>,
    /// Them, in the order in which they were read.
    pub paths: Vec<IncludePath>,
}

impl<'a> ImportedFiles<'a> {
    pub fn new(name: &'a str, includes: &'a Includes) -> Self {
        Self {
            name,
            includes,
            loaded: BTreeMap::new(),
            paths: Vec::new(),
        }
    }

    /// The bytes of the file that an argument names, relative to the folder of the text.
    pub fn bytes(&mut self, file: &str, place: &Argument) -> Result<Arc<[u8]>, SpannedError> {
        let wrong = |found: String| {
            SpannedError::input(place.span.clone(), found, "a file that can be imported")
        };
        let Some(loader) = self.includes.loader() else {
            return Err(wrong("a file, where files cannot be read".to_owned()));
        };
        let failed = |error| wrong(format!("{}: {error}", premio_text::escape::quote(file)));
        let path = loader.find(Some(self.name), file).map_err(failed)?;
        if let Some(known) = self.loaded.get(&path.identity) {
            return Ok(Arc::clone(known));
        }
        let bytes: Arc<[u8]> = loader.load(&path).map_err(failed)?.into();
        self.loaded
            .insert(path.identity.clone(), Arc::clone(&bytes));
        self.paths.push(path);
        Ok(bytes)
    }
}

/// A format of drawings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum DrawingFormat {
    Dxf,
    Svg,
}

/// A format that `import` reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ImportFormat {
    Drawing(DrawingFormat),
    Mesh(MeshFormat),
}

impl ImportFormat {
    /// The format of a file, by its ending.
    pub fn from_path(file: &str) -> Option<Self> {
        let ending = Path::new(file).extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "dxf" => Some(Self::Drawing(DrawingFormat::Dxf)),
            "svg" => Some(Self::Drawing(DrawingFormat::Svg)),
            _ => {
                let mesh = MeshFormat::ALL
                    .into_iter()
                    .find(|mesh| mesh.ending() == ending);
                mesh.map(Self::Mesh)
            }
        }
    }
}

/// The error of a file that is not what its node needs.
fn bad_file(arguments: &Arguments, why: &dyn Display, expected: &str) -> SpannedError {
    let file = arguments.words("file").unwrap_or_default();
    let found = format!("the file {}", premio_text::escape::quote(file));
    SpannedError::input(arguments.span.clone(), found, expected).help(why.to_string())
}

/// The polyhedra of a mesh, of which the union is meant.
pub(super) fn mesh(
    format: MeshFormat,
    bytes: &[u8],
    arguments: &Arguments,
) -> Result<Vec<Polyhedron>, SpannedError> {
    let wrong = |why: &dyn Display| bad_file(arguments, why, "a mesh that bounds a solid");
    let options = MeshReadOptions {
        max_corners: MAX_CORNERS,
        placement: ObjectPlacement::AsWritten,
    };
    let file = MeshFile::<Rational>::read(bytes, format, &options);
    match file.map_err(|error| wrong(&error))?.polyhedra() {
        Ok(polyhedra) => Ok(polyhedra),
        Err(PolyhedronError::Empty) => Ok(Vec::new()),
        Err(error) => Err(wrong(&error)),
    }
}

/// The polyhedron of a height field.
pub(super) fn surface(
    file: &str,
    bytes: &[u8],
    arguments: &Arguments,
) -> Result<Polyhedron, SpannedError> {
    let is_picture = Path::new(file)
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
    let wrong = |why: &dyn Display| bad_file(arguments, why, "a height field");
    let field = match is_picture {
        true => HeightField::from_png(bytes, arguments.flag("invert")?),
        false => HeightField::from_dat(bytes),
    };
    let field = field.map_err(|error| wrong(&error))?;
    let made = field.polyhedron(arguments.flag("center")?);
    made.map_err(|error| wrong(&error))
}

/// The region of a drawing; `None` if it is empty.
pub(super) fn drawing(
    format: DrawingFormat,
    bytes: &[u8],
    arguments: &Arguments,
    rule: &mut FacetRule,
    notes: &mut Notes,
) -> Result<Option<Region>, SpannedError> {
    let span = arguments.span.clone();
    let drawing = contents(format, bytes, arguments, rule)?;
    let drawing = drawing.map_err(|error| bad_file(arguments, &error, "a drawing"))?;
    remark(&drawing, arguments, notes);
    match drawing_file::figure(&drawing) {
        Ok(figure) => Ok(Some(Region::new(figure, span))),
        Err(FigureError::Empty) => Ok(None),
        Err(error) => Err(bad_figure(&error, &span)),
    }
}

/// The contents of a file, as the arguments want them.
fn contents(
    format: DrawingFormat,
    bytes: &[u8],
    arguments: &Arguments,
    rule: &mut FacetRule,
) -> Result<Result<Drawing, DrawingFileError>, SpannedError> {
    let number = |name: &str, default: Rational| match arguments.find(name) {
        Some(argument) => Ok(argument.number()?.clone()),
        None => Ok(default),
    };
    // `$fn`, `$fa` and `$fs` are numbers, as this shows for all radii.
    rule.sides(arguments, &Rational::ONE)?;
    let mut sides = |radius: &Rational| rule.sides(arguments, radius).ok().flatten();
    let count = |radius: f64| fragments(arguments, radius).map_or(0, |count| count as u32);
    let name = |name: &str| {
        let text = arguments.words(name)?;
        Ok::<_, SpannedError>((!text.is_empty()).then_some(text))
    };
    let mut options = DrawingOptions {
        layer: name("layer")?,
        id: name("id")?,
        origin: origin(arguments)?,
        scale: number("scale", Rational::ONE)?,
        dpi: number("dpi", Rational::from(72))?,
        is_centred: arguments.flag("center")?,
        sides: &mut sides,
        fragments: &count,
    };
    Ok(match format {
        DrawingFormat::Dxf => drawing_file::read_dxf(bytes, &mut options),
        DrawingFormat::Svg => drawing_file::read_svg(bytes, &mut options),
    })
}

fn origin(arguments: &Arguments) -> Result<[Rational; 2], SpannedError> {
    let Some(argument) = arguments.find("origin") else {
        return Ok([Rational::ZERO, Rational::ZERO]);
    };
    let [x, y] = argument.list("a point: a list of two numbers")?;
    Ok([x.number()?.clone(), y.number()?.clone()])
}

/// Says what was not taken as it is.
fn remark(drawing: &Drawing, arguments: &Arguments, notes: &mut Notes) {
    let kinds = [
        (
            drawing.approximated,
            "curves are no circular arcs, and were cut into segments",
        ),
        (drawing.completed, "open paths were closed by a segment"),
        (drawing.passed_over, "entities have no effect"),
    ];
    for (count, what) in kinds.into_iter().filter(|(count, _)| *count > 0) {
        notes.add(format!("{count} {what}"), arguments.span.clone());
    }
}
