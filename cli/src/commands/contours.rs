//! `premio contours`: what a camera sees.

use crate::arguments::{CameraChoice, ContoursFormat, ContoursOptions, ViewName};
use crate::diagnostics::{CliError, counted};
use crate::input::EvaluatedPart;
use crate::session::Session;
use crate::{input, output};
use premio::{Camera, Drawing, DrawingOptions, Paper, Sheet, StandardView, Unit, View};
use premio_drawing::sheet::{self, Angle, SheetView};
use premio_drawing::{dxf, svg};
use premio_kernel::concurrency;
use premio_visibility::camera::CameraError;
use premio_visibility::contours::ViewError;
use premio_visibility::{Contours, ViewCamera};
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
    let camera = given.camera()?;
    let working = voice.working("finding the contours");
    let seen = seen(&part, &camera, Some(&given))?;
    drop(working);
    match format {
        ContoursFormat::Json => {
            let mut contours = seen.contours().clone();
            if let Some(n) = options.samples {
                contours.sample(n as usize);
            }
            output::json(&contours, to)?;
            voice.summary(&words(&contours));
            Ok(())
        }
        ContoursFormat::Svg => output::write(svg::write(&drawing(&seen, options)), to),
        ContoursFormat::Dxf => output::write(dxf::write(&drawing(&seen, options)), to),
    }
}

/// The contours in words.
fn words(contours: &Contours) -> String {
    let pieces = || contours.contours.iter().flat_map(|c| &c.pieces);
    format!(
        "{} in {}, {} visible; {}",
        counted(contours.contours.len(), "contour"),
        counted(pieces().count(), "piece"),
        pieces().filter(|piece| piece.visible).count(),
        counted(contours.junctions.len(), "junction")
    )
}

/// The view of a camera; `given` is its origin, where that is not the name of a view.
fn seen(
    part: &EvaluatedPart,
    camera: &Camera,
    given: Option<&Given<'_>>,
) -> Result<View, CliError> {
    let beyond = |error: &dyn std::fmt::Display| CliError::limit(format!("{}: {error}", part.name));
    let failed = |error: premio::Error| match &error {
        premio::Error::View(view) => {
            let refused = given.and_then(|given| given.refused(view));
            refused.unwrap_or_else(|| beyond(&error))
        }
        premio::Error::Camera(_) if given.is_some() => CliError::input(error.to_string()),
        error => beyond(error),
    };
    part.solid.view(camera).map_err(failed)
}

fn drawing(seen: &View, options: &ContoursOptions) -> Drawing {
    let how = DrawingOptions {
        hidden: options.hidden,
        smooth: options.smooth_edges,
        ..DrawingOptions::default()
    };
    seen.drawing(&how)
}

/// The views, or that of the camera, on a sheet.
fn on_sheet(
    options: &ContoursOptions,
    format: ContoursFormat,
    session: Session,
) -> Result<String, CliError> {
    let write = match format {
        ContoursFormat::Json => {
            return Err(CliError::input("a sheet needs --format svg or dxf"));
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
        Some(Given::Choice(CameraChoice::Named(name))) => cameras(&[*name]),
        Some(given) => vec![SheetCamera {
            view: None,
            camera: given.camera()?,
        }],
        None => cameras(&requested.views),
    };
    let bar = session.voice.progress(cameras.len() as u64);
    let views = concurrency::map(&cameras, 1, |SheetCamera { view, camera }| {
        let seen = seen(&part, camera, given.as_ref())?;
        bar.inc(1);
        Ok(SheetView {
            view: *view,
            drawing: drawing(&seen, options),
        })
    });
    bar.finish_and_clear();
    let views = views.into_iter().collect::<Result<Vec<_>, CliError>>()?;
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

/// A camera, before the part is evaluated.
enum Given<'a> {
    /// The camera of a file.
    File {
        /// The file.
        path: &'a Path,
        /// Its text.
        text: String,
        /// Its camera.
        camera: ViewCamera,
    },
    /// One that depends on the part.
    Choice(CameraChoice<'a>),
}

impl<'a> Given<'a> {
    fn read(choice: CameraChoice<'a>, session: Session) -> Result<Self, CliError> {
        match choice {
            CameraChoice::File(path) => {
                let input::CameraText { camera, text } = input::camera_of_file(path, session)?;
                Ok(Self::File { path, text, camera })
            }
            choice => Ok(Self::Choice(choice)),
        }
    }

    fn camera(&self) -> Result<Camera, CliError> {
        match self {
            Self::File { camera, .. } => Ok(camera.clone().into()),
            Self::Choice(CameraChoice::File(path)) => {
                Err(CliError::input(format!("{}: is not read", path.display())))
            }
            Self::Choice(CameraChoice::Named(name)) => Ok(Camera::standard((*name).into())),
            Self::Choice(CameraChoice::Eye {
                eye,
                target,
                up,
                focal,
            }) => {
                let camera = Camera::from_eye(*eye, *focal).with_up(*up);
                Ok(match target {
                    Some(target) => camera.with_target(*target),
                    None => camera,
                })
            }
        }
    }

    /// The error of a camera whose eye is refused; none for another error.
    fn refused(&self, error: &ViewError) -> Option<CliError> {
        let words = match error {
            ViewError::EyeInside(_) => "lies inside the material of the part",
            ViewError::EyeFar { .. } => "is too far from the part for its resolution",
            _ => return None,
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

/// The camera of a view on a sheet.
struct SheetCamera {
    /// The view, if it is a standard one.
    view: Option<StandardView>,
    camera: Camera,
}

/// The cameras of views, each once.
fn cameras(names: &[ViewName]) -> Vec<SheetCamera> {
    let mut cameras: Vec<SheetCamera> = Vec::new();
    for &name in names {
        let standard = StandardView::from(name);
        let view = Some(standard);
        if !cameras.iter().any(|known| known.view == view) {
            let camera = Camera::standard(standard);
            cameras.push(SheetCamera { view, camera });
        }
    }
    cameras
}
