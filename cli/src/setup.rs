//! Reading setups, and predicting parts in them.

use crate::diagnostics::CliError;
use crate::input::{self, EvaluatedPart};
use crate::session::Session;
use nalgebra::Point3;
use premio_detect::Detector;
use premio_kernel::brep::bounding_box::bounds;
use premio_kernel::geometry::bounds::Aabb;
use premio_predict::image::shading::Finishes;
use premio_predict::image_arcs::lit_scene::StageError;
use premio_predict::model::record::ModelHead;
use premio_predict::prediction::{self, Memory, PredictedImage};
use premio_predict::prepared_part::PreparedPart;
use premio_predict::setup::light::Light;
use premio_predict::setup::setups::Setups;
use premio_predict::setup::{Conditions, Setup, SetupError, detector_from_toml};
use std::path::Path;

/// A file of setups with its content.
#[derive(Debug)]
pub struct SetupFile<T> {
    /// Its name in messages.
    pub name: String,
    /// Its text.
    pub text: String,
    /// Its content.
    pub value: T,
}

/// The setup of a file.
pub fn setup(path: &Path, session: Session) -> Result<SetupFile<Setup>, CliError> {
    let file = read(path, session, Setup::from_toml)?;
    file.check_pixels(&file.value.conditions, session)?;
    if is_dark(&file.value.lights) {
        file.note_darkness(&file.value.conditions, session);
    }
    Ok(file)
}

/// The setups of a file.
pub fn setups(path: &Path, session: Session) -> Result<SetupFile<Setups>, CliError> {
    let file = read(path, session, Setups::from_toml)?;
    file.check_pixels(&file.value.conditions, session)?;
    if is_dark(&file.value.lights) && file.value.illumination.is_none() {
        file.note_darkness(&file.value.conditions, session);
    }
    Ok(file)
}

/// Whether there is no light, or none that shines.
fn is_dark(lights: &[Light]) -> bool {
    lights.iter().all(|light| light.intensity() <= 0.0)
}

/// The detector of a file.
pub fn detector(path: &Path, session: Session) -> Result<Detector, CliError> {
    read(path, session, detector_from_toml).map(|file| file.value)
}

fn read<T>(
    path: &Path,
    session: Session,
    parse: impl Fn(&str) -> Result<T, SetupError>,
) -> Result<SetupFile<T>, CliError> {
    let name = path.display().to_string();
    let text = session.limits.read_text(path)?;
    let value = parse(&text).map_err(|error| CliError::setup(&name, &error, &text))?;
    Ok(SetupFile { name, text, value })
}

impl<T> SetupFile<T> {
    /// The error of a part in it.
    fn failure(&self, part: &EvaluatedPart, error: &StageError) -> CliError {
        CliError::stage(&part.name, [&self.name, &self.text], error)
    }

    fn check_pixels(&self, conditions: &Conditions, session: Session) -> Result<(), CliError> {
        let [width, height] = conditions.sensor.resolution;
        let (pixels, most) = (width as u64 * height as u64, session.limits.pixels);
        if pixels <= most {
            return Ok(());
        }
        let reason = format!(
            "is {width} x {height}, {pixels} pixels, expected at most {most}: --max-pixels sets \
             another limit"
        );
        let error = SetupError::value("sensor.resolution", reason);
        Err(CliError::setup(&self.name, &error, &self.text))
    }

    fn note_darkness(&self, conditions: &Conditions, session: Session) {
        let said = format!(
            "there is no `[[light]]` that shines: only the surroundings shine, evenly (ambient {}), and nothing \
             casts a shadow",
            conditions.ambient
        );
        session.voice.note(&self.name, &said);
    }

    /// A part prepared for the setups, with the materials of its faces.
    pub fn subject<'p>(
        &self,
        part: &'p EvaluatedPart,
        conditions: &Conditions,
    ) -> Result<(PreparedPart<'p>, Finishes), CliError> {
        let subject = self.bare(part)?;
        let finishes = Finishes::new(&subject, conditions);
        Ok((subject, finishes.map_err(|e| self.failure(part, &e))?))
    }

    /// Notes in how many setups the part is not visible.
    ///
    /// # Errors
    /// It is visible in none.
    pub fn check_seen(&self, head: &ModelHead, session: Session) -> Result<(), CliError> {
        let unseen: u64 = head.unseen.values().sum();
        let Some((why, _)) = head.unseen.iter().max_by_key(|(_, count)| **count) else {
            return Ok(());
        };
        let count = head.count;
        if unseen < count {
            let said = format!("the part is not visible in {unseen} of {count} setups: {why}");
            session.voice.note(&self.name, &said);
            return Ok(());
        }
        let reason = format!("does not show the part in any of {count} setups: {why}");
        let error = SetupError::value("viewing.radius", reason);
        Err(CliError::setup(&self.name, &error, &self.text))
    }

    fn bare<'p>(&self, part: &'p EvaluatedPart) -> Result<PreparedPart<'p>, CliError> {
        let resolution = input::view_resolution(part)?;
        let subject = PreparedPart::new(part.solid.brep(), resolution);
        subject.map_err(|error| self.failure(part, &error.into()))
    }
}

impl SetupFile<Setups> {
    /// Notes how many cameras and lights of the spheres are inside the part, where nothing is
    /// visible.
    ///
    /// # Errors
    /// All of one sphere are, or a fixed light is.
    pub fn check_places(
        &self,
        subject: &PreparedPart<'_>,
        session: Session,
    ) -> Result<(), CliError> {
        let setups = &self.value;
        let refused = |key: String, reason: &str| {
            let error = SetupError::value(key, reason);
            Err(CliError::setup(&self.name, &error, &self.text))
        };
        for (i, light) in setups.lights.iter().enumerate() {
            let place = light.position.map(Point3::from);
            if place.is_some_and(|p| subject.contains(&p)) {
                let reason = "is inside the part: expected a point outside";
                return refused(format!("light[{i}].position"), reason);
            }
        }
        let bounds = bounds(subject.brep);
        for (key, what, places) in [
            ("viewing", "viewpoints", setups.eyes(subject)),
            ("illumination", "lights", setups.moving_lights(subject)),
        ] {
            let inside = places.iter().filter(|p| subject.contains(p)).count();
            let all = places.len();
            if inside > 0 && inside == all {
                let reason =
                    format!("puts all {all} {what} inside the part: expected a larger sphere");
                return refused(format!("{key}.radius"), &reason);
            }
            let boxed = places.iter().filter(|p| contains(&bounds, p)).count();
            let said = match (inside, boxed) {
                (0, 0) => continue,
                (0, _) => format!("{boxed} of {all} {what} are inside the part's box"),
                _ => format!(
                    "{inside} of {all} {what} are inside the part: nothing is visible in these setups"
                ),
            };
            session.voice.note(&self.name, &said);
        }
        Ok(())
    }
}

/// Whether a box contains a point.
fn contains(bounds: &Aabb, p: &Point3<f64>) -> bool {
    (0..3).all(|i| (bounds.min[i]..=bounds.max[i]).contains(&p[i]))
}

impl SetupFile<Setup> {
    /// Evaluates a function on the predicted image of a part.
    pub fn with_draft<T>(
        &self,
        part: &EvaluatedPart,
        ask: impl FnOnce(&PredictedImage<'_>) -> T,
    ) -> Result<T, CliError> {
        let subject = self.bare(part)?;
        prediction::with_draft(&subject, None, &self.value, &mut Memory::default(), ask)
            .map_err(|error| self.failure(part, &error))
    }
}
