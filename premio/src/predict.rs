//! Prediction of the features that a sensor and a detector find.

use crate::progress::Progress;
use crate::{Error, Result, Solid};
use premio_detect::{Grey, PixelMask};
use premio_predict::image_arcs::ArcSource;
use premio_predict::prediction::{Memory, PredictedImage, Prediction, prediction, with_draft};
use premio_predict::prediction_score::{MatchedArc, PredictionScore, matches};
use premio_predict::prepared_part::PreparedPart;
use premio_predict::render;
use premio_predict::setup::Setup;
use premio_predict::setup::setups::Setups;
use rayon::prelude::*;
use std::fs;
use std::path::Path;

/// The setup of a TOML file: camera, lights, sensor, material and detector.
///
/// # Errors
/// The file cannot be read, or is not a setup.
///
/// # Examples
///
/// ```
/// let setup = premio::read_setup("../examples/plate-setup.toml")?;
/// assert_eq!(setup.lights.len(), 1);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn read_setup(path: impl AsRef<Path>) -> Result<Setup> {
    Ok(Setup::from_toml(&text_of(path.as_ref())?)?)
}

/// The setups of a TOML file: cameras and lights on spheres, for a model.
///
/// # Errors
/// The file cannot be read, or is not setups.
///
/// # Examples
///
/// ```
/// assert_eq!(premio::read_setups("../examples/plate-setups.toml")?.len(), 8);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn read_setups(path: impl AsRef<Path>) -> Result<Setups> {
    Ok(Setups::from_toml(&text_of(path.as_ref())?)?)
}

pub(crate) fn text_of(path: &Path) -> Result<String> {
    fs::read_to_string(path).map_err(|source| Error::file(path, source))
}

/// The agreement of a prediction with a picture.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
/// let setup = premio::read_setup("../examples/plate-setup.toml")?;
/// let picture = solid.render(&setup, &Progress::new())?;
/// let agreement = solid.compare(&setup, &picture)?;
/// assert!(agreement.outlines.same > 0.8);
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PredictionAgreement {
    /// Edges and limbs.
    pub outlines: PredictionScore,
    /// Boundaries of shadows, and outlines of highlights.
    pub lighting: PredictionScore,
    /// Each predicted arc with its detection.
    pub features: Vec<MatchedArc>,
    /// The prediction.
    pub prediction: Prediction,
}

impl PredictionAgreement {
    /// Compares the prediction of an image with a picture of the sensor's size.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    /// use premio::PredictionAgreement;
    ///
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setup = premio::read_setup("../examples/plate-setup.toml")?;
    /// let grey = Grey { width: 160, height: 120, levels: vec![99.0; 160 * 120] };
    /// let agreement = solid.with_prediction(&setup, |image| {
    ///     PredictionAgreement::new(image, &setup, &grey)
    /// })?;
    /// assert!(agreement.outlines.same < 0.5);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn new(draft: &PredictedImage<'_>, setup: &Setup, picture: &Grey) -> Self {
        let prediction = prediction(draft, setup);
        let all = PixelMask::full(picture.width, picture.height);
        let found = draft.evidence_in(picture, &all).arcs;
        let shortest = setup.conditions.detector.shortest;
        let features = matches(&prediction.arcs, &found, shortest);
        let outline =
            |m: &&MatchedArc| matches!(m.source, ArcSource::Edge { .. } | ArcSource::Limb { .. });
        Self {
            outlines: PredictionScore::new(features.iter().filter(outline)),
            lighting: PredictionScore::new(features.iter().filter(|m| !outline(m))),
            features,
            prediction,
        }
    }
}

/// The number of rows that are rendered at once.
const STRIP: usize = 16;

/// The picture of a predicted image's setup, by a line of sight through every pixel. A step of the
/// progress is a row.
///
/// # Errors
/// The work was cancelled.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
/// let mut setup = premio::read_setup("../examples/plate-setup.toml")?;
/// setup.conditions.sensor.read_noise = 2.0;
/// let other = solid.with_prediction(&setup, |image| premio::rendered(image, 7, &Progress::new()))??;
/// // Another seed gives other noise.
/// assert!(other != solid.render(&setup, &Progress::new())?);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn rendered(draft: &PredictedImage<'_>, seed: u64, progress: &Progress<'_>) -> Result<Grey> {
    let sensor = &draft.conditions.sensor;
    let [width, height] = sensor.resolution;
    let shading = &draft.shading;
    let counter = progress.counter(height as u64);
    let strips: Vec<usize> = (0..height).step_by(STRIP).collect();
    let levels: Result<Vec<Vec<f32>>> = strips
        .into_par_iter()
        .map(|y| {
            progress.check()?;
            let rows = y..(y + STRIP).min(height);
            let count = rows.len() as u64;
            let levels = render::rows(shading, width, rows);
            counter.add(count);
            Ok(levels)
        })
        .collect();
    Ok(render::finished(levels?.concat(), sensor, seed))
}

impl Solid {
    pub(crate) fn prepared(&self) -> Result<PreparedPart<'_>> {
        let resolution = self.view_resolution()?;
        PreparedPart::new(self.brep(), resolution).map_err(|_| Error::Empty)
    }

    /// Calls a function with the predicted image of the solid in a setup.
    ///
    /// # Errors
    /// The solid is empty, or not visible in the setup.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setup = premio::read_setup("../examples/plate-setup.toml")?;
    /// let arcs = solid.with_prediction(&setup, |image| image.arcs.len())?;
    /// assert!(arcs > 9);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn with_prediction<T>(
        &self,
        setup: &Setup,
        ask: impl FnOnce(&PredictedImage<'_>) -> T,
    ) -> Result<T> {
        let part = self.prepared()?;
        Ok(with_draft(&part, None, setup, &mut Memory::default(), ask)?)
    }

    /// Predicts the features of the solid that a sensor and a detector find in a setup, with their
    /// probabilities.
    ///
    /// # Errors
    /// The solid is empty, or not visible in the setup.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setup = premio::read_setup("../examples/plate-setup.toml")?;
    /// let prediction = solid.predict(&setup)?;
    /// assert!(!prediction.segments.is_empty());
    /// assert!(prediction.arcs.len() >= prediction.boundaries.len());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn predict(&self, setup: &Setup) -> Result<Prediction> {
        self.with_prediction(setup, |draft| prediction(draft, setup))
    }

    /// The picture of the solid in a setup, by a line of sight through every pixel. A step of the
    /// progress is a row.
    ///
    /// # Errors
    /// As [`Solid::predict`]; or the work was cancelled.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setup = premio::read_setup("../examples/plate-setup.toml")?;
    /// let picture = solid.render(&setup, &Progress::new())?;
    /// assert_eq!(picture.levels.len(), 160 * 120);
    /// let token = CancelToken::new();
    /// token.cancel();
    /// let cancelled = solid.render(&setup, &Progress::new().with_token(&token));
    /// assert!(matches!(cancelled, Err(premio::Error::Cancelled(_))));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn render(&self, setup: &Setup, progress: &Progress<'_>) -> Result<Grey> {
        let seed = setup.conditions.seed;
        self.with_prediction(setup, |draft| rendered(draft, seed, progress))?
    }

    /// Compares the prediction with a picture of the solid in the setup, of the sensor's size.
    ///
    /// # Errors
    /// As [`Solid::predict`]; or the picture has another size than the sensor.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setup = premio::read_setup("../examples/plate-setup.toml")?;
    /// let picture = Grey { width: 3, height: 3, levels: vec![0.0; 9] };
    /// assert!(solid.compare(&setup, &picture).is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn compare(&self, setup: &Setup, picture: &Grey) -> Result<PredictionAgreement> {
        let sensor = setup.conditions.sensor.resolution;
        let found = [picture.width, picture.height];
        if found != sensor {
            return Err(Error::PictureSize { found, sensor });
        }
        self.with_prediction(setup, |draft| {
            PredictionAgreement::new(draft, setup, picture)
        })
    }
}
