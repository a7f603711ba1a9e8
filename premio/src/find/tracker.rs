//! A solid in a sequence of pictures.

use super::{PartFinder, PictureMatch};
use crate::Result;
use nalgebra::Isometry3;
use premio_detect::Grey;
use premio_matching::camera::{CameraFile, Pinhole};
use premio_matching::output::report::Pose;
use premio_matching::tracker::TrackResult;
use premio_matching::verification::part_match::PartMatch;

/// Follows a solid through the pictures of a sequence: from its last pose, or by a search of the
/// whole picture where it is lost.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = block(6, 4, 2).evaluate()?;
/// let nothing = Grey { width: 64, height: 48, levels: vec![99.0; 64 * 48] };
/// let camera = CameraFile::from_json(r#"{"K": [[80, 0, 32], [0, 80, 24], [0, 0, 1]]}"#)?;
/// let finder = PartFinder::new(&solid)?;
/// let mut tracker = finder.track();
/// let found = tracker.next(&nothing, &camera)?;
/// assert_eq!(found.report().anew, Some(true));
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct PartTracker<'f> {
    pub(super) finder: &'f PartFinder<'f>,
    pub(super) last: Option<Isometry3<f64>>,
}

impl PartTracker<'_> {
    /// The solid in the next picture.
    ///
    /// # Errors
    /// As [`PartFinder::find`]. The last pose stays.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let small = Grey { width: 4, height: 3, levels: vec![99.0; 12] };
    /// let camera = CameraFile::from_json(r#"{"K": [[800, 0, 32], [0, 800, 24], [0, 0, 1]]}"#)?;
    /// let finder = PartFinder::new(&solid)?;
    /// assert!(finder.track().next(&small, &camera).is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn next(&mut self, picture: &Grey, camera: &CameraFile) -> Result<PictureMatch> {
        let camera = camera.for_picture([picture.width, picture.height])?;
        self.next_with(picture.clone(), camera, "")
    }

    /// The solid in the next picture, with the picture's name and the camera for its size.
    ///
    /// # Errors
    /// The search was cancelled. The last pose stays.
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
    /// assert_eq!(finder.track().next_with(nothing, camera, "1.png")?.report().image, "1.png");
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn next_with(
        &mut self,
        picture: Grey,
        camera: Pinhole,
        name: &str,
    ) -> Result<PictureMatch> {
        let last = self.last;
        let mut searched_anew = None;
        let mut found = self.finder.find_with(picture, camera, name, |matcher| {
            let TrackResult { result, anew } = matcher.next(last.as_ref())?;
            searched_anew = Some(anew);
            Ok(result)
        })?;
        found.report.anew = searched_anew;
        let accepted = found.best().filter(|m| m.is_accepted());
        self.last = accepted.map(|m: &PartMatch| m.pose);
        Ok(found)
    }

    /// The pose in the last picture; none where the solid was not found.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// assert!(PartFinder::new(&solid)?.track().last_pose().is_none());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn last_pose(&self) -> Option<Pose> {
        self.last.as_ref().map(Pose::from)
    }
}
