//! Reading descriptions.

use crate::files::{IncludedFiles, SystemFonts};
use crate::{Error, Expression, Result};
use premio_csg::lettering::Fonts;
use premio_csg::reader::{self, Format, Includes, ReadOptions, StandaloneText};
use premio_csg::writer::write;
use premio_predict::model::record::DescriptionRecord;
use std::fs;
use std::path::Path;

/// Reads a description. The file's ending names its language: `.padl`, `.csg`, `.json`, `.asc` or
/// `.pov`.
///
/// # Errors
/// The file cannot be read, its ending names no language, or the text is not a description. The error has
/// the place in the text.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// # let folder = tempfile::tempdir().unwrap();
/// # std::env::set_current_dir(&folder).unwrap();
/// std::fs::write("ball.csg", "sphere($fn = 200, r = 2);").unwrap();
/// let ball = premio::read("ball.csg")?.evaluate()?;
/// assert_eq!(ball.faces().count(), 1);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn read(path: impl AsRef<Path>) -> Result<Expression> {
    read_with(path, &ReadOptions::default())
}

/// Reads a description with options: which part of the text, which round shapes of OpenSCAD
/// are polygons, other values for numbers, and the loader of included files.
///
/// Without a loader, a `.padl` file includes files by [`IncludedFiles`].
///
/// # Errors
/// As [`read`].
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// # let folder = tempfile::tempdir().unwrap();
/// # std::env::set_current_dir(&folder).unwrap();
/// std::fs::write("two.padl", "A = BLO(X=1, Y=1, Z=1)\nB = SPH(R=1)\n").unwrap();
/// let options = ReadOptions { part: Some("A".to_owned()), ..ReadOptions::default() };
/// assert_eq!(premio::read_with("two.padl", &options)?.evaluate()?.faces().count(), 6);
/// assert_eq!(premio::read("two.padl")?.evaluate()?.faces().count(), 1);
///
/// std::fs::write("cube.padl", "L = 2\nCUBE = BLO(X=L, Y=L, Z=L)\n").unwrap();
/// let other = ValueOverride { name: "L".to_owned(), value: "3".to_owned() };
/// let options = ReadOptions { overrides: vec![other], ..ReadOptions::default() };
/// let cube = premio::read_with("cube.padl", &options)?.evaluate()?;
/// assert!((cube.volume() - 27.0).abs() < 1e-12);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn read_with(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Expression> {
    let path = path.as_ref();
    let format = Format::from_path(path).ok_or_else(|| Error::UnknownFormat {
        path: path.to_owned(),
        expected: ".padl, .csg, .json, .asc or .pov",
    })?;
    let bytes = fs::read(path).map_err(|source| Error::file(path, source))?;
    let name = path.display().to_string();
    let mut options = options.clone();
    if !options.includes.is_available() {
        options.includes = Includes::new(IncludedFiles::default());
    }
    if !options.fonts.has_source() {
        options.fonts = Fonts::new(SystemFonts::default());
    }
    read_bytes(&name, &bytes, format, &options)
}

/// Reads a description from a text.
///
/// # Errors
/// The text is not a description. The error has the place in the text.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let text = r#"{"prim": "torus", "R": 5, "r": 1}"#;
/// assert_eq!(premio::read_text(text, Format::Json)?.evaluate()?.genus(), [1]);
/// assert!(premio::read_text("{", Format::Json).is_err());
/// # Ok::<(), premio::Error>(())
/// ```
pub fn read_text(text: &str, format: Format) -> Result<Expression> {
    read_bytes("part", text.as_bytes(), format, &ReadOptions::default())
}

/// Reads a description from bytes. `name` is its name in errors and models.
///
/// # Errors
/// The bytes are no description. The error has the place in the text.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let error = premio::read_bytes("a.padl", b"A = BLO(X=1)", Format::Padl, &ReadOptions::default());
/// assert!(error.unwrap_err().to_string().starts_with("a.padl:1:"));
/// ```
pub fn read_bytes(
    name: &str,
    bytes: &[u8],
    format: Format,
    options: &ReadOptions,
) -> Result<Expression> {
    let program = reader::parse(name, bytes, format, options)?;
    let text = String::from_utf8_lossy(bytes).into_owned();
    let as_read = DescriptionRecord {
        language: format.ending().to_owned(),
        part: options.part.clone(),
        facets: options.facets.recorded(),
        ..DescriptionRecord::default()
    };
    // A model has no other files.
    let (record, read) = match &program.standalone {
        StandaloneText::AsRead => (DescriptionRecord { text, ..as_read }, None),
        StandaloneText::Rewritten(standalone) => {
            let record = DescriptionRecord {
                text: standalone.clone(),
                ..as_read
            };
            (record, Some(text))
        }
        StandaloneText::Unavailable => {
            let record = DescriptionRecord {
                language: Format::Json.ending().to_owned(),
                text: write(&program.builder, program.part, Format::Json)?,
                noise: program.digits,
                ..DescriptionRecord::default()
            };
            (record, Some(text))
        }
    };
    Ok(Expression::of_text(program, record, name.to_owned(), read))
}
