//! `premio contours`: what a camera sees.

use crate::arguments::{ContoursFormat, ContoursOptions, ViewName};
use crate::diagnostics::{Failure, Voice};
use crate::input::Part;
use crate::{input, output};
use nalgebra::Point3;
use premio_kernel::unit::Unit;
use premio_visibility::drawing::sheet::{self, Angle, Paper, Sheet, View};
use premio_visibility::drawing::{self, Drawing, dxf, svg};
use premio_visibility::{Camera, Contours, contours};

/// Runs the command.
pub fn run(options: &ContoursOptions, voice: Voice) -> Result<(), Failure> {
    let to = options.output.path();
    if options.sheet.is_asked() {
        return output::write(on_sheet(options, voice)?, to);
    }
    let camera = input::camera(&options.camera)?;
    let part = input::part(&options.description, voice)?;
    let working = voice.working("finding the contours");
    let mut seen = seen(&part, &camera)?;
    drop(working);
    match options.format {
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

fn seen(part: &Part, camera: &Camera) -> Result<Contours, Failure> {
    let resolution = input::resolution_of_views(part)?;
    contours(&part.evaluation.brep, camera, resolution)
        .map_err(|e| Failure::limit(format!("{}: {e}", part.name)))
}

fn drawing(seen: &Contours, options: &ContoursOptions) -> Drawing {
    let how = drawing::Options {
        hidden: options.hidden,
        smooth: options.smooth_edges,
        ..drawing::Options::default()
    };
    Drawing::new(seen, &how)
}

/// The views, or that of the camera, on a sheet.
fn on_sheet(options: &ContoursOptions, voice: Voice) -> Result<String, Failure> {
    let write = match options.format {
        ContoursFormat::Json => {
            return Err(Failure::input(
                "a sheet goes with --format svg and dxf only",
            ));
        }
        ContoursFormat::Svg => svg::write_sheet,
        ContoursFormat::Dxf => dxf::write_sheet,
    };
    let asked = &options.sheet;
    let alone = match asked.views.is_empty() {
        true => Some(input::camera(&options.camera)?),
        false => None,
    };
    let part = input::part(&options.description, voice)?;
    let cameras = match alone {
        Some(camera) => vec![(None, camera)],
        None => cameras(&part, &asked.views)?,
    };
    let bar = voice.progress(cameras.len() as u64);
    let mut views = Vec::new();
    for (view, camera) in cameras {
        views.push((view, drawing(&seen(&part, &camera)?, options)));
        bar.inc(1);
    }
    bar.finish_and_clear();
    let title = asked.title.clone();
    let how = sheet::Options {
        title: title.unwrap_or_else(|| options.description.stem()),
        unit: asked.unit.map(Unit::from).unwrap_or_default(),
        paper: asked.paper.map(Paper::from).unwrap_or_default(),
        scale: asked.scale,
        angle: asked.projection.map(Angle::from).unwrap_or_default(),
    };
    let sheet = Sheet::of(views, how).map_err(|e| Failure::input(e.to_string()))?;
    Ok(write(&sheet))
}

/// The cameras of views of a part about its middle, each once.
fn cameras(part: &Part, names: &[ViewName]) -> Result<Vec<(Option<View>, Camera)>, Failure> {
    let evaluation = &part.evaluation;
    let (middle, size) = match evaluation.brep.topology.faces.is_empty() {
        true => (Point3::origin(), 1.0),
        false => {
            let bounds = evaluation.tight_bounds();
            (bounds.centre(), bounds.diagonal())
        }
    };
    let mut cameras: Vec<(Option<View>, Camera)> = Vec::new();
    for &name in names {
        let view = View::from(name);
        if !cameras.iter().any(|(known, _)| *known == Some(view)) {
            let camera = view.camera(middle, size);
            let camera = camera.map_err(|e| Failure::limit(e.to_string()))?;
            cameras.push((Some(view), camera));
        }
    }
    Ok(cameras)
}
