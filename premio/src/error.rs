//! The error type.

use crate::expression::ExpressionError;
use crate::number::NumberError;
use crate::picture::PictureError;
use premio_csg::builder::TreeError;
use premio_csg::evaluate::{EvaluationError, ViewLimit};
use premio_csg::reader::{FacetLimitError, ReadError};
use premio_csg::writer::WriteError;
use premio_drawing::sheet::SheetError;
use premio_exchange::mesh::MeshError;
use premio_exchange::step::StepError;
use premio_matching::camera::PinholeError;
use premio_predict::image_arcs::lit_scene::StageError;
use premio_predict::model::file::ModelError;
use premio_predict::setup::SetupError;
use premio_visibility::ViewError;
use premio_visibility::camera::CameraError;
use std::io;
use std::path::PathBuf;

/// The result of a call that can fail.
///
/// # Examples
///
/// ```
/// fn volume_of_a_ball(radius: f64) -> premio::Result<f64> {
///     Ok(premio::sphere(radius).evaluate()?.volume())
/// }
/// assert!(volume_of_a_ball(3.0)? > 113.0);
/// assert!(volume_of_a_ball(-3.0).is_err());
/// # Ok::<(), premio::Error>(())
/// ```
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// The error of a call.
///
/// Each variant carries the error of the step that failed.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let error = cylinder(0.0, 5.0).evaluate().unwrap_err();
/// assert!(matches!(error, premio::Error::Expression(_)));
/// assert_eq!(error.to_string(), "the radius must be greater than zero");
/// ```
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number is not finite, or a text is not a number.
    #[error(transparent)]
    Number(#[from] NumberError),
    /// A primitive or a motion of an expression is invalid.
    #[error(transparent)]
    Expression(#[from] ExpressionError),
    /// An expression is beyond a limit.
    #[error(transparent)]
    Tree(#[from] TreeError),
    /// A description cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A model records a wrong limit of facets.
    #[error(transparent)]
    Facets(#[from] FacetLimitError),
    /// An expression cannot be written as a description.
    #[error(transparent)]
    Description(#[from] WriteError),
    /// The boundary cannot be determined.
    #[error(transparent)]
    Evaluation(#[from] EvaluationError),
    /// The precision of predictions and searches is too low for the solid.
    #[error(
        "surfaces are so nearly coincident that f64 cannot separate them: the boundary is known, \
         but predictions need more precision"
    )]
    NoView,
    /// The precision of views is too low for the solid, and rays contradict one.
    #[error(
        "surfaces are so nearly coincident that f64 cannot separate them: the boundary is known, \
         but rays contradict the view: {detail}"
    )]
    UncertainView {
        /// What they contradict.
        detail: String,
    },
    /// The boundary rounded to f64 has no view.
    #[error(transparent)]
    ViewLimit(ViewLimit),
    /// A camera is invalid.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// A camera has no view from its position.
    #[error(transparent)]
    View(#[from] ViewError),
    /// Views do not fit on a sheet.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// A STEP file cannot be written.
    #[error(transparent)]
    Step(#[from] StepError),
    /// The boundary cannot be followed by triangles.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// A mesh would have more triangles than are made.
    #[error("a {what} of {asked:e} is beyond the limit, expected at least {least:.1e}")]
    Fineness {
        /// The deviation, or the angle.
        what: &'static str,
        /// The value that was given.
        asked: f64,
        /// The least valid value.
        least: f64,
    },
    /// A setup is invalid.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// Nothing can be predicted of the solid in a setup.
    #[error(transparent)]
    Stage(#[from] StageError),
    /// A text is not a valid model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A text is not a valid camera of a picture.
    #[error(transparent)]
    Pinhole(#[from] PinholeError),
    /// A picture cannot be read or written.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A picture has another size than the sensor of the setup.
    #[error(
        "found {} x {} pixels, expected the setup's {} x {}",
        found[0], found[1], sensor[0], sensor[1]
    )]
    PictureSize {
        /// The width and height of the picture in pixels.
        found: [usize; 2],
        /// Those of the sensor.
        sensor: [usize; 2],
    },
    /// A shard of a model cannot be read or written.
    #[error(transparent)]
    Shard(#[from] crate::model::ShardError),
    /// No description is read as the solid, so a model cannot carry one.
    #[error("no description holds the numbers of the solid exactly")]
    NoDescription,
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The ending of a file names no known format.
    #[error("{}: found a file of an unknown kind, expected one that ends in {expected}", path.display())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// The known endings.
        expected: &'static str,
    },
    /// A value cannot be written as JSON.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// A solid has no faces, so there is nothing to see or to find.
    #[error("the solid is empty")]
    Empty,
    /// The caller cancelled the work.
    #[error(transparent)]
    Cancelled(#[from] crate::progress::Cancelled),
}

impl Error {
    pub(crate) fn file(path: impl Into<PathBuf>, source: io::Error) -> Self {
        let path = path.into();
        Self::File { path, source }
    }
}
