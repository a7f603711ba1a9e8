//! The options for a camera.

use super::{ViewName, positive, vector};
use clap::Args;
use std::path::{Path, PathBuf};

/// The camera: a file, an eye that looks at a target, or a view by its name.
#[derive(Debug, Args)]
pub struct CameraOptions {
    /// A view by its name [default: iso]
    #[arg(long, value_enum, value_name = "VIEW",
          conflicts_with_all = ["camera", "eye", "target", "up", "focal", "ortho"])]
    pub view: Option<ViewName>,
    /// A file with the camera as JSON
    #[arg(long, value_name = "CAM.json", conflicts_with_all = ["eye", "target", "up", "focal", "ortho"])]
    pub camera: Option<PathBuf>,
    /// The eye
    #[arg(long, value_name = "x,y,z", value_parser = vector, allow_hyphen_values = true)]
    pub eye: Option<[f64; 3]>,
    /// A point that the eye looks at [default: the middle of the part]
    #[arg(long, value_name = "x,y,z", value_parser = vector, allow_hyphen_values = true)]
    pub target: Option<[f64; 3]>,
    /// The direction that is up in the image [default: 0,0,1]
    #[arg(long, value_name = "x,y,z", value_parser = vector, allow_hyphen_values = true)]
    pub up: Option<[f64; 3]>,
    /// The focal length, which is the unit of the image [default: 1]
    #[arg(long, value_name = "f", value_parser = positive, conflicts_with = "ortho")]
    pub focal: Option<f64>,
    /// Parallel instead of central projection
    #[arg(long)]
    pub ortho: bool,
}

/// The camera of the command line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraChoice<'a> {
    /// The camera of a file.
    File(&'a Path),
    /// A view of the part about its middle.
    Named(ViewName),
    /// An eye that looks at a point, or otherwise at the middle of the part.
    Eye {
        /// The eye.
        eye: [f64; 3],
        /// The target.
        target: Option<[f64; 3]>,
        /// The direction that is up in the image.
        up: [f64; 3],
        /// The focal length; none for parallel projection.
        focal: Option<f64>,
    },
}

/// The ways to give a camera.
const CAMERAS: &str = "a camera is `--camera CAM.json`, `--eye x,y,z` (with `--target x,y,z`, \
    `--up x,y,z`, and `--focal f` or `--ortho`), `--view NAME` (front, back, left, right, top, bottom \
    or iso), or, on a sheet, `--views NAMES`; without any it is `--view iso`";

impl CameraOptions {
    /// The chosen camera.
    ///
    /// # Errors
    /// Options of an eye are given, and no eye.
    pub fn choice(&self) -> Result<CameraChoice<'_>, String> {
        if let Some(path) = &self.camera {
            return Ok(CameraChoice::File(path));
        }
        let lonely = [
            ("target", self.target.is_some()),
            ("up", self.up.is_some()),
            ("focal", self.focal.is_some()),
            ("ortho", self.ortho),
        ];
        match (self.eye, lonely.iter().find(|(_, given)| *given)) {
            (Some(eye), _) => Ok(CameraChoice::Eye {
                eye,
                target: self.target,
                up: self.up.unwrap_or([0.0, 0.0, 1.0]),
                focal: (!self.ortho).then(|| self.focal.unwrap_or(1.0)),
            }),
            (None, Some((option, _))) => Err(format!("`--{option}` needs `--eye`: {CAMERAS}")),
            (None, None) => Ok(CameraChoice::Named(self.view.unwrap_or(ViewName::Iso))),
        }
    }
}
