//! The result of a search.

use crate::picture::{PictureError, PictureFormat, draw_match};
use premio_detect::Grey;
use premio_matching::image::ImageFeatures;
use premio_matching::output::explain::explained;
use premio_matching::output::report::{MatchReport, Pose};
use premio_matching::verification::part_match::{PartMatch, SearchResult};
use premio_matching::verification::scoring::ScoreMeasures;

/// The result of a search for a solid in a picture.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = block(6, 4, 2).evaluate()?;
/// let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
/// let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
/// let found = PartFinder::new(&solid)?.find(&nothing, &camera)?;
/// assert_eq!(found.probability(), 0.0);
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PictureMatch {
    pub(super) grey: Grey,
    pub(super) features: ImageFeatures,
    pub(super) result: SearchResult,
    pub(super) report: MatchReport,
}

impl PictureMatch {
    /// Whether the solid is there.
    ///
    /// # Examples
    ///
    /// ```
    /// # use premio::prelude::*;
    /// # let solid = block(6, 4, 2).evaluate()?;
    /// # let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// # let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// let found = PartFinder::new(&solid)?.find(&nothing, &camera)?;
    /// assert!(!found.is_found());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn is_found(&self) -> bool {
        self.report.found
    }

    /// The probability that the solid is there.
    ///
    /// # Examples
    ///
    /// ```
    /// # use premio::prelude::*;
    /// # let solid = block(6, 4, 2).evaluate()?;
    /// # let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// # let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// let found = PartFinder::new(&solid)?.find(&nothing, &camera)?;
    /// assert!((0.0..=1.0).contains(&found.probability()));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn probability(&self) -> f64 {
        self.report.probability
    }

    /// The pose: x_camera = R x + t; the likeliest one if the solid is not found.
    ///
    /// # Examples
    ///
    /// ```
    /// # use premio::prelude::*;
    /// # let solid = block(6, 4, 2).evaluate()?;
    /// # let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// # let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// let found = PartFinder::new(&solid)?.find(&nothing, &camera)?;
    /// assert!(found.pose().is_none());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn pose(&self) -> Option<Pose> {
        self.report.pose
    }

    /// The report (`premio.match/1`).
    ///
    /// # Examples
    ///
    /// ```
    /// # use premio::prelude::*;
    /// # let solid = block(6, 4, 2).evaluate()?;
    /// # let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// # let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// let found = PartFinder::new(&solid)?.find(&nothing, &camera)?;
    /// assert!(found.report().instances.is_empty());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn report(&self) -> &MatchReport {
        &self.report
    }

    /// The likeliest match, with its correspondences.
    ///
    /// # Examples
    ///
    /// ```
    /// # use premio::prelude::*;
    /// # let solid = block(6, 4, 2).evaluate()?;
    /// # let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// # let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// let found = PartFinder::new(&solid)?.find(&nothing, &camera)?;
    /// assert!(found.best().is_none());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn best(&self) -> Option<&PartMatch> {
        self.result.best()
    }

    /// The evidence for and against the likeliest match, in words.
    ///
    /// # Examples
    ///
    /// ```
    /// # use premio::prelude::*;
    /// # let solid = block(6, 4, 2).evaluate()?;
    /// # let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// # let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// let found = PartFinder::new(&solid)?.find(&nothing, &camera)?;
    /// assert!(!found.explained().is_empty());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn explained(&self) -> String {
        explained(self.best(), &self.report)
    }

    /// The match with what its score is made of in its report (`measures`).
    ///
    /// # Examples
    ///
    /// ```
    /// # use premio::prelude::*;
    /// # let solid = block(6, 4, 2).evaluate()?;
    /// # let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// # let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// let found = PartFinder::new(&solid)?.find(&nothing, &camera)?.with_measures();
    /// // There are none without a match.
    /// assert!(found.report().measures.is_none());
    /// # Ok::<(), premio::Error>(())
    /// ```
    #[must_use]
    pub fn with_measures(mut self) -> Self {
        let best = self.result.best();
        let straightness = self.report.straightness;
        self.report.measures = best.map(|found| ScoreMeasures::new(found, straightness));
        self
    }

    /// The bytes of the picture with the likeliest match drawn on it: found contours green, missed
    /// ones red and dashed, their segments blue. None without a match.
    ///
    /// # Errors
    /// The picture cannot be encoded.
    ///
    /// # Examples
    ///
    /// ```
    /// # use premio::prelude::*;
    /// # let solid = block(6, 4, 2).evaluate()?;
    /// # let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
    /// # let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
    /// let found = PartFinder::new(&solid)?.find(&nothing, &camera)?;
    /// assert!(found.overlay(premio::PictureFormat::Png)?.is_none());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn overlay(&self, format: PictureFormat) -> Result<Option<Vec<u8>>, PictureError> {
        let draw = |best| draw_match(&self.grey, &self.features, best, format);
        self.best().map(draw).transpose()
    }
}
