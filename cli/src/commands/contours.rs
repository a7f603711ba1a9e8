//! `premio contours`: what a camera sees.

use crate::arguments::{CameraChoice, ContoursFormat, ContoursOptions, ViewName};
use crate::diagnostics::CliError;
use crate::input::EvaluatedPart;
use crate::session::Session;
use crate::{input, output};
use nalgebra::Point3;
use premio_drawing::sheet::{self, Angle, Paper, Sheet, StandardView};
use premio_drawing::{Drawing, dxf, svg};
use premio_kernel::unit::Unit;
use premio_visibility::camera::CameraError;
use premio_visibility::contours::ViewError;
use premio_visibility::{Camera, Contours, contours};
use std::path::Path;

/// Runs the command.
pub fn run(options: &ContoursOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    let to = options.output.path();
    let format = options
        .output
        .format(options.format)
        .map_err(CliError::input)?;
    let chosen = options.camera.choice().map_err(CliError::input)?;
    if options.sheet.is_requested() {
        return output::write(on_sheet(options, format, session)?, to);
    }
    let given = Given::read(chosen, session)?;
    let part = input::part(&options.description, session)?;
    let camera = given.camera(&part)?;
    let working = voice.working("finding the contours");
    let mut seen = seen(&part, &camera, Some(&given))?;
    drop(working);
    match format {
        ContoursFormat::Json => {
            if let Some(n) = options.samples {
                seen.sample(n as usize);
            }
            output::json(&seen, to)
        }
        ContoursFormat::Svg => output::write(svg::write(&drawing(&seen, options)), to),
        ContoursFormat::Dxf => output::write(dxf::write(&drawing(&seen, options)), to),
    }
}

/// What a camera sees; `given` is how it was given, where that was not by the name of a view.
fn seen(
    part: &EvaluatedPart,
    camera: &Camera,
    given: Option<&Given<'_>>,
) -> Result<Contours, CliError> {
    let resolution = input::view_resolution(part)?;
    let failed = |error: ViewError| {
        let beyond = || CliError::limit(format!("{}: {error}", part.name));
        let refused = given.and_then(|given| given.refused(&error));
        refused.unwrap_or_else(beyond)
    };
    contours(&part.evaluation.brep, camera, resolution).map_err(failed)
}

fn drawing(seen: &Contours, options: &ContoursOptions) -> Drawing {
    let how = premio_drawing::DrawingOptions {
        hidden: options.hidden,
        smooth: options.smooth_edges,
        ..premio_drawing::DrawingOptions::default()
    };
    Drawing::new(seen, &how)
}

/// The views, or that of the camera, on a sheet.
fn on_sheet(
    options: &ContoursOptions,
    format: ContoursFormat,
    session: Session,
) -> Result<String, CliError> {
    let write = match format {
        ContoursFormat::Json => {
            return Err(CliError::input(
                "a sheet goes with --format svg and dxf only",
            ));
        }
        ContoursFormat::Svg => svg::write_sheet,
        ContoursFormat::Dxf => dxf::write_sheet,
    };
    let requested = &options.sheet;
    let given = match requested.views.is_empty() {
        true => {
            let chosen = options.camera.choice().map_err(CliError::input)?;
            Some(Given::read(chosen, session)?)
        }
        false => None,
    };
    let part = input::part(&options.description, session)?;
    let cameras = match &given {
        Some(Given::Choice(CameraChoice::Named(name))) => cameras(&part, &[*name])?,
        Some(given) => vec![(None, given.camera(&part)?)],
        None => cameras(&part, &requested.views)?,
    };
    let bar = session.voice.progress(cameras.len() as u64);
    let mut views = Vec::new();
    for (view, camera) in cameras {
        views.push((
            view,
            drawing(&seen(&part, &camera, given.as_ref())?, options),
        ));
        bar.inc(1);
    }
    bar.finish_and_clear();
    let title = requested.title.clone();
    let how = sheet::SheetOptions {
        title: title.unwrap_or_else(|| options.description.stem()),
        unit: requested.unit.map(Unit::from).unwrap_or_default(),
        paper: requested.paper.map(Paper::from).unwrap_or_default(),
        scale: requested.scale,
        angle: requested.projection.map(Angle::from).unwrap_or_default(),
    };
    let sheet = Sheet::new(views, how).map_err(|e| CliError::input(e.to_string()))?;
    Ok(write(&sheet))
}

/// A camera, before there is a part.
enum Given<'a> {
    /// That of a file.
    File {
        /// The file.
        path: &'a Path,
        /// Its text.
        text: String,
        /// Its camera.
        camera: Camera,
    },
    /// One that depends on the part.
    Choice(CameraChoice<'a>),
}

impl<'a> Given<'a> {
    fn read(choice: CameraChoice<'a>, session: Session) -> Result<Self, CliError> {
        match choice {
            CameraChoice::File(path) => {
                let (camera, text) = input::camera_of_file(path, session)?;
                Ok(Self::File { path, text, camera })
            }
            choice => Ok(Self::Choice(choice)),
        }
    }

    fn camera(&self, part: &EvaluatedPart) -> Result<Camera, CliError> {
        let failed = |e: CameraError| CliError::input(e.to_string());
        match self {
            Self::File { camera, .. } => Ok(camera.clone()),
            Self::Choice(CameraChoice::File(path)) => {
                Err(CliError::input(format!("{}: is not read", path.display())))
            }
            Self::Choice(CameraChoice::Named(name)) => {
                let Extent { middle, size } = Extent::new(part);
                StandardView::from(*name)
                    .camera(middle, size)
                    .map_err(failed)
            }
            Self::Choice(CameraChoice::Eye {
                eye,
                target,
                up,
                focal,
            }) => {
                let middle = Extent::new(part).middle;
                let (eye, up) = (Point3::from(*eye), (*up).into());
                let target = target.map_or(middle, Point3::from);
                match focal {
                    Some(focal) => Camera::perspective(eye, target, up, *focal).map_err(failed),
                    None => Camera::orthographic(eye, target, up).map_err(failed),
                }
            }
        }
    }

    /// That the camera is refused where the eye is; none where that is not what is wrong.
    fn refused(&self, error: &ViewError) -> Option<CliError> {
        let words = match error {
            ViewError::EyeInside(_) => "lies inside the material of the part",
            ViewError::EyeFar { .. } => "is too far from the part for its resolution",
            ViewError::Limb(_) => return None,
        };
        match self {
            Self::File { path, text, .. } => {
                let error = CameraError::Value("eye", words);
                Some(input::refused_camera(path, text, &error))
            }
            Self::Choice(CameraChoice::Eye { .. }) => {
                Some(CliError::input(format!("`--eye` is wrong: {error}")))
            }
            Self::Choice(_) => None,
        }
    }
}

/// The cameras of views of a part about its middle, each once.
fn cameras(
    part: &EvaluatedPart,
    names: &[ViewName],
) -> Result<Vec<(Option<StandardView>, Camera)>, CliError> {
    let Extent { middle, size } = Extent::new(part);
    let mut cameras: Vec<(Option<StandardView>, Camera)> = Vec::new();
    for &name in names {
        let view = StandardView::from(name);
        if !cameras.iter().any(|(known, _)| *known == Some(view)) {
            let camera = view.camera(middle, size);
            let camera = camera.map_err(|e| CliError::limit(e.to_string()))?;
            cameras.push((Some(view), camera));
        }
    }
    Ok(cameras)
}

/// Where a part is, and how large; a point at the origin is taken to be of size one.
struct Extent {
    middle: Point3<f64>,
    size: f64,
}

impl Extent {
    fn new(part: &EvaluatedPart) -> Self {
        let evaluation = &part.evaluation;
        if evaluation.brep.topology.faces.is_empty() {
            let middle = Point3::origin();
            return Self { middle, size: 1.0 };
        }
        let bounds = evaluation.tight_bounds();
        Self {
            middle: bounds.centre(),
            size: bounds.diagonal(),
        }
    }
}
