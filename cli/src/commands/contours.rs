//! `premio contours`: what a camera sees.

use crate::arguments::{ContoursFormat, ContoursOptions};
use crate::diagnostics::Failure;
use crate::{input, output};
use premio_visibility::drawing::{self, Drawing, dxf, svg};
use premio_visibility::{Contours, contours};

/// Why there is no view of some parts.
const UNSEEN: &str = "surfaces lie so nearly along one another that doubles do not tell them apart: \
    the boundary is known, but no view of it is reckoned with more digits";

/// Runs the command.
pub fn run(options: &ContoursOptions) -> Result<(), Failure> {
    let camera = input::camera(&options.camera)?;
    let part = input::part(&options.description)?;
    let evaluation = &part.evaluation;
    let Some(resolution) = evaluation.resolution_of_views() else {
        return Err(Failure::limit(format!("{}: {UNSEEN}", part.name)));
    };
    let mut seen = contours(&evaluation.brep, &camera, resolution)
        .map_err(|e| Failure::limit(format!("{}: {e}", part.name)))?;
    let to = options.output.as_deref();
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

fn drawing(seen: &Contours, options: &ContoursOptions) -> Drawing {
    let how = drawing::Options {
        hidden: options.hidden,
        smooth: options.smooth_edges,
        ..drawing::Options::default()
    };
    Drawing::new(seen, &how)
}
