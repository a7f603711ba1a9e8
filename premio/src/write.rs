//! Files of a solid.

use crate::{Error, Fineness, Result, Solid};
use premio_drawing::sheet::Sheet;
use premio_drawing::{dxf, svg};
use premio_exchange::FaceColours;
use premio_exchange::mesh::{glb, obj, stl, threemf};
use premio_exchange::step::{self, Protocol};
use premio_kernel::unit::Unit;
use premio_text::escape;
use serde::Serialize;
use std::path::Path;

pub(crate) fn whole_file(path: &Path, bytes: impl AsRef<[u8]>) -> Result<()> {
    crate::files::write_whole(bytes, path).map_err(|source| Error::file(path, source))
}

/// A value as JSON, in one line, without characters that a terminal obeys.
pub(crate) fn json_text(value: &impl Serialize) -> Result<String> {
    Ok(escape::json(serde_json::to_string(value)?))
}

/// A format of a solid's file.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// assert_eq!(SolidFormat::from_path("a/plate.STP"), Some(SolidFormat::Step));
/// assert_eq!(SolidFormat::from_path("plate.dwg"), None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SolidFormat {
    /// `.step` and `.stp`: the exact boundary (ISO 10303).
    Step,
    /// `.stl`: triangles.
    Stl,
    /// `.obj`: triangles with the faces' names.
    Obj,
    /// `.glb`: triangles, binary glTF.
    Glb,
    /// `.3mf`: triangles.
    ThreeMf,
    /// `.json`: the topological object model (`premio.object/1`).
    Json,
}

impl SolidFormat {
    /// The format that a file's ending names.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// assert_eq!(SolidFormat::from_path("plate.3mf"), Some(SolidFormat::ThreeMf));
    /// ```
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        let ending = path.as_ref().extension()?.to_str()?;
        match ending.to_ascii_lowercase().as_str() {
            "step" | "stp" => Some(Self::Step),
            "stl" => Some(Self::Stl),
            "obj" => Some(Self::Obj),
            "glb" => Some(Self::Glb),
            "3mf" => Some(Self::ThreeMf),
            "json" => Some(Self::Json),
            _ => None,
        }
    }
}

/// The settings of a solid's file.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let options = ExportSettings { unit: Unit::Inch, ..ExportSettings::new("plate") };
/// let step = block(1, 2, 3).evaluate()?.to_step(&options)?;
/// assert!(step.contains("'plate'") && step.contains("INCH"));
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExportSettings {
    /// The name of the solid.
    pub name: String,
    /// The unit of the solid; by default millimetres.
    pub unit: Unit,
    /// The fineness of triangles.
    pub fineness: Fineness,
    /// The greatest distance of splines in STEP from their curves, in the solid's unit; by default
    /// a millionth of its size.
    pub accuracy: Option<f64>,
    /// The application protocol of STEP.
    pub protocol: Protocol,
}

impl ExportSettings {
    /// The default settings with a name.
    ///
    /// # Examples
    ///
    /// ```
    /// assert_eq!(premio::ExportSettings::new("plate").unit.symbol(), "mm");
    /// ```
    pub fn new(name: impl Into<String>) -> Self {
        let name = name.into();
        Self {
            name,
            ..Self::default()
        }
    }

    fn for_path(path: &Path) -> Self {
        let stem = path.file_stem().unwrap_or_default();
        Self::new(stem.to_string_lossy())
    }
}

impl Solid {
    /// The text of a STEP file: the exact boundary.
    ///
    /// # Errors
    /// The solid is empty, or a part of it is thinner than the point tolerance of other kernels.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let text = torus(5, 1).evaluate()?.to_step(&ExportSettings::default())?;
    /// assert!(text.contains("TOROIDAL_SURFACE"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn to_step(&self, settings: &ExportSettings) -> Result<String> {
        let options = step::StepOptions {
            name: settings.name.clone(),
            protocol: settings.protocol,
            unit: settings.unit,
            accuracy: settings
                .accuracy
                .unwrap_or(step::ACCURACY * self.extent().size),
            resolution: self.evaluation().f64_resolution(),
            colours: FaceColours(self.face_colours()),
        };
        Ok(step::write(self.brep(), &options)?)
    }

    /// The bytes of a file.
    ///
    /// # Errors
    /// The solid is empty, or it cannot be written in the format.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let bytes = block(1, 2, 3).evaluate()?.to_bytes(SolidFormat::Stl, &ExportSettings::default())?;
    /// // A header of 80 bytes, the count, and 50 bytes for each triangle.
    /// assert_eq!(bytes.len(), 84 + 12 * 50);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn to_bytes(&self, format: SolidFormat, settings: &ExportSettings) -> Result<Vec<u8>> {
        let facets = || self.facets(&settings.fineness);
        let (name, unit) = (&settings.name, settings.unit);
        let colours = || FaceColours(self.face_colours());
        Ok(match format {
            SolidFormat::Step => self.to_step(settings)?.into_bytes(),
            SolidFormat::Json => (self.to_json()? + "\n").into_bytes(),
            SolidFormat::Stl => stl::write(&facets()?)?,
            SolidFormat::Obj => obj::write(&facets()?, name).into_bytes(),
            SolidFormat::Glb => glb::write(&facets()?, &colours(), name, unit)?,
            SolidFormat::ThreeMf => threemf::write(&facets()?, &colours(), name, unit)?,
        })
    }

    /// The topological object model as JSON (`premio.object/1`).
    ///
    /// # Errors
    /// A number is not finite.
    ///
    /// # Examples
    ///
    /// ```
    /// let json = premio::sphere(1).evaluate()?.to_json()?;
    /// assert!(json.starts_with(r#"{"schema":"premio.object/1""#));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn to_json(&self) -> Result<String> {
        json_text(&self.object_model())
    }

    /// Writes a STEP file, in millimetres, named after the file. It appears whole or not at all.
    ///
    /// # Errors
    /// As [`Solid::to_step`]; or the file cannot be written.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # std::env::set_current_dir(&folder).unwrap();
    /// block(1, 2, 3).evaluate()?.write_step("brick.step")?;
    /// assert!(std::fs::read_to_string("brick.step").unwrap().contains("'brick'"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn write_step(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        whole_file(path, self.to_step(&ExportSettings::for_path(path))?)
    }

    /// Writes a file in the format that its ending names: `.step`, `.stl`, `.obj`, `.glb`, `.3mf`
    /// or `.json`. It appears whole or not at all.
    ///
    /// # Errors
    /// As [`Solid::to_bytes`]; the ending names no format, or the file cannot be written.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # std::env::set_current_dir(&folder).unwrap();
    /// let solid = cylinder(1, 2).evaluate()?;
    /// for name in ["a.step", "a.stl", "a.obj", "a.glb", "a.3mf", "a.json"] {
    ///     solid.write(name)?;
    ///     assert!(std::fs::metadata(name).unwrap().len() > 0);
    /// }
    /// assert!(solid.write("a.txt").is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        self.write_with(path.as_ref(), &ExportSettings::for_path(path.as_ref()))
    }

    /// Writes a file with settings, in the format that its ending names.
    ///
    /// # Errors
    /// As [`Solid::write`].
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # std::env::set_current_dir(&folder).unwrap();
    /// block(1, 2, 3).evaluate()?.write_with("a.obj", &ExportSettings::new("brick"))?;
    /// assert!(std::fs::read_to_string("a.obj").unwrap().contains("o brick"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn write_with(&self, path: impl AsRef<Path>, settings: &ExportSettings) -> Result<()> {
        let path = path.as_ref();
        let format = SolidFormat::from_path(path).ok_or_else(|| Error::UnknownFormat {
            path: path.to_owned(),
            expected: ".step, .stl, .obj, .glb, .3mf or .json",
        })?;
        whole_file(path, self.to_bytes(format, settings)?)
    }
}

/// A sheet of views as SVG.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = block(60, 40, 20).evaluate()?;
/// let sheet = solid.sheet(&[StandardView::Front], &DrawingOptions::default(), SheetOptions::new("brick"))?;
/// assert!(premio::sheet_to_svg(&sheet).contains("brick"));
/// # Ok::<(), premio::Error>(())
/// ```
pub fn sheet_to_svg(sheet: &Sheet) -> String {
    svg::write_sheet(sheet)
}

/// A sheet of views as DXF.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = block(60, 40, 20).evaluate()?;
/// let sheet = solid.sheet(&[StandardView::Front], &DrawingOptions::default(), SheetOptions::new("brick"))?;
/// assert!(premio::sheet_to_dxf(&sheet).contains("LINE"));
/// # Ok::<(), premio::Error>(())
/// ```
pub fn sheet_to_dxf(sheet: &Sheet) -> String {
    dxf::write_sheet(sheet)
}
