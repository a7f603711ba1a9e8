//! Finding a solid in pictures.

mod picture_match;
mod tracker;

pub use picture_match::PictureMatch;
pub use tracker::PartTracker;

use crate::model::Model;
use crate::progress::{Cancelled, Progress};
use crate::{Error, Result, Solid};
use premio_detect::{Detector, Grey};
use premio_kernel::brep::Brep;
use premio_matching::camera::{CameraFile, Pinhole};
use premio_matching::image::{DownsampledImage, ImageFeatures, detector, downsampled};
use premio_matching::matcher::Matcher;
use premio_matching::output::report::{MatchReport, MatchSeconds, ReportNames};
use premio_matching::part::SoughtPart;
use premio_matching::part::detectability_prior::DetectabilityPrior;
use premio_matching::search::monitor::SearchStopped;
use premio_matching::verification::part_match::{SearchOptions, SearchResult};
use std::fmt;
use std::time::Instant;

/// Finds a solid in pictures.
///
/// A finder prepares the solid once: edges, symmetries, chains. It then takes any number of
/// pictures.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
/// let setup = premio::read_setup("../examples/plate-setup.toml")?;
/// let picture = solid.render(&setup, &Progress::new())?;
/// let camera = CameraFile::from_json(r#"{"K": [[290.9, 0, 79.5], [0, 290.9, 59.5], [0, 0, 1]]}"#)?;
/// let found = PartFinder::new(&solid)?.find(&picture, &camera)?;
/// assert_eq!(found.report().image, "");
/// assert!(found.pose().is_some());
/// # Ok::<(), premio::Error>(())
/// ```
pub struct PartFinder<'s> {
    part: SoughtPart<'s>,
    prior: DetectabilityPrior,
    detector: Detector,
    options: SearchOptions,
    progress: Progress<'s>,
    name: String,
}

/// Shows the detector and the search options.
impl fmt::Debug for PartFinder<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PartFinder")
            .field("name", &self.name)
            .field("detector", &self.detector)
            .field("options", &self.options)
            .field("progress", &self.progress)
            .finish_non_exhaustive()
    }
}

impl<'s> PartFinder<'s> {
    /// A finder of a solid without a model.
    ///
    /// # Errors
    /// The solid is empty, or f64 cannot separate its surfaces.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// assert!(PartFinder::new(&block(6, 4, 2).evaluate()?).is_ok());
    /// assert!(PartFinder::new(&Expression::empty().evaluate()?).is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn new(solid: &'s Solid) -> Result<Self> {
        Self::with_prior(solid, DetectabilityPrior::nothing(), detector())
    }

    /// A finder of a solid with its model. Features are detected with the detector of the model's
    /// setups.
    ///
    /// # Errors
    /// As [`PartFinder::new`].
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setups = premio::read_setups("../examples/plate-setups.toml")?;
    /// let model = Model::train(&solid, &setups, &Progress::new())?;
    /// let finder = PartFinder::with_model(&solid, &model)?;
    /// assert!(format!("{finder:?}").starts_with("PartFinder"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn with_model(solid: &'s Solid, model: &Model) -> Result<Self> {
        let prior = DetectabilityPrior::new(model.records(), solid.brep());
        let detector = model.head().setups.conditions.detector.clone();
        Self::with_prior(solid, prior, detector)
    }

    fn with_prior(solid: &'s Solid, prior: DetectabilityPrior, detector: Detector) -> Result<Self> {
        let resolution = solid.view_resolution()?;
        let finder = Self::from_brep(solid.brep(), resolution, prior, detector)?;
        Ok(finder.with_name(solid.expression().name()))
    }

    /// A finder of a boundary with its resolution, from the detectability of its features.
    ///
    /// # Errors
    /// There are no faces.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    /// use premio::{DetectabilityPrior, default_detector};
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let uniform = DetectabilityPrior::uniform();
    /// let finder = PartFinder::from_brep(solid.brep(), 1e-10, uniform, default_detector())?;
    /// assert!(format!("{finder:?}").contains("detector"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn from_brep(
        brep: &'s Brep,
        resolution: f64,
        prior: DetectabilityPrior,
        detector: Detector,
    ) -> Result<Self> {
        if brep.topology.faces.is_empty() {
            return Err(Error::Empty);
        }
        Ok(Self {
            part: SoughtPart::new(brep, resolution, &prior),
            prior,
            detector,
            options: SearchOptions::default(),
            progress: Progress::new(),
            name: String::new(),
        })
    }

    /// Sets the name of the solid in reports.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let finder = PartFinder::new(&solid)?.with_name("brick");
    /// assert!(format!("{finder:?}").contains("brick"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn with_name(mut self, name: impl Into<String>) -> Self {
        self.name = name.into();
        self
    }

    /// Sets the detector of features.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let detector = Detector { shortest: 20.0, ..Detector::default() };
    /// let finder = PartFinder::new(&solid)?.with_detector(detector);
    /// assert!(format!("{finder:?}").contains("shortest: 20"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn with_detector(mut self, detector: Detector) -> Self {
        self.detector = detector;
        self
    }

    /// Sets the options of the search for correspondences.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let options = SearchOptions { strategy: Strategy::Stepped, ..SearchOptions::default() };
    /// let finder = PartFinder::new(&solid)?.with_options(options);
    /// assert!(format!("{finder:?}").contains("Stepped"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn with_options(mut self, options: SearchOptions) -> Self {
        self.options = options;
        self
    }

    /// Sets the receiver of the progress of each search, whose token cancels it.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// let token = CancelToken::new();
    /// let progress = Progress::new()
    ///     .with_callback(|step| println!("{} of {}", step.done, step.total))
    ///     .with_token(&token);
    /// let finder = PartFinder::new(&solid)?.with_progress(progress);
    /// assert!(finder.find(&nothing, &camera).is_ok());
    /// token.cancel();
    /// assert!(matches!(finder.find(&nothing, &camera), Err(premio::Error::Cancelled(_))));
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn with_progress(mut self, progress: Progress<'s>) -> Self {
        self.progress = progress;
        self
    }

    /// Searches the whole picture for the solid.
    ///
    /// # Errors
    /// The camera did not take a picture of this size; or the search was cancelled.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// assert!(!PartFinder::new(&solid)?.find(&nothing, &camera)?.is_found());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn find(&self, picture: &Grey, camera: &CameraFile) -> Result<PictureMatch> {
        let camera = camera.for_picture([picture.width, picture.height])?;
        self.find_with(picture.clone(), camera, "", |matcher| matcher.find())
    }

    /// Searches a picture with a function, which returns the search result.
    ///
    /// # Errors
    /// The search was cancelled.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// let camera = camera.for_picture([64, 48])?;
    /// let finder = PartFinder::new(&solid)?;
    /// let found = finder.find_with(nothing, camera, "a.png", |matcher| matcher.find())?;
    /// assert_eq!(found.report().image, "a.png");
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn find_with(
        &self,
        picture: Grey,
        camera: Pinhole,
        name: &str,
        look: impl FnOnce(&Matcher<'_>) -> Result<SearchResult, SearchStopped>,
    ) -> Result<PictureMatch> {
        let started = Instant::now();
        let DownsampledImage {
            grey,
            camera,
            scale,
        } = downsampled(picture, camera);
        let features = ImageFeatures::new(&grey, &self.detector);
        let detecting = started.elapsed().as_secs_f64();
        let matcher = Matcher {
            part: &self.part,
            learned: &self.prior,
            picture: &features,
            camera: &camera,
            options: &self.options,
            monitor: &self.progress,
        };
        let result = look(&matcher).map_err(|SearchStopped| Cancelled)?;
        let seconds = MatchSeconds {
            features: detecting,
            matching: started.elapsed().as_secs_f64() - detecting,
        };
        let names = ReportNames {
            image: name,
            part: &self.name,
        };
        let report = MatchReport::new(&self.part, names, &features, &result, scale, seconds);
        Ok(PictureMatch {
            grey,
            features,
            result,
            report,
        })
    }

    /// Follows the solid through the pictures of a sequence.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let finder = PartFinder::new(&solid)?;
    /// assert!(finder.track().last_pose().is_none());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn track(&self) -> PartTracker<'_> {
        let (finder, last) = (self, None);
        PartTracker { finder, last }
    }
}

impl Solid {
    /// Finds the solid in a picture, without a model.
    ///
    /// For several pictures, make one [`PartFinder`].
    ///
    /// # Errors
    /// As [`PartFinder::new`] and [`PartFinder::find`].
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let picture = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// assert!(!block(6, 4, 2).evaluate()?.find(&picture, &camera)?.is_found());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn find(&self, picture: &Grey, camera: &CameraFile) -> Result<PictureMatch> {
        PartFinder::new(self)?.find(picture, camera)
    }
}
