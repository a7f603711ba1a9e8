//! Models of a solid: the summary of predictions over many setups.

mod run;
mod shard;

/// Shards of a model: the observations of a range of setups in a file, for runs on several
/// machines.
///
/// [`Model::train`](crate::Model::train) needs none of this.
pub mod shards {
    pub use super::run::{SetupObserver, summed};
    pub use super::shard::{Shard, ShardError, ShardHead, ShardRun, digest, language};
    pub use premio_predict::image::shading::Finishes;
    pub use premio_predict::model::Observation;
    pub use premio_predict::model::consistency::SourceLimits;
    pub use premio_predict::model::record::{DescriptionRecord, Record};
    pub use premio_predict::prepared_part::PreparedPart;

    /// The description of a solid that a model carries.
    ///
    /// # Errors
    /// No description language can express the solid's numbers exactly.
    ///
    /// # Examples
    ///
    /// ```
    /// let record = premio::shards::description(&premio::block(1, 2, 3).evaluate()?)?;
    /// assert_eq!(record.language, "padl");
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn description(solid: &crate::Solid) -> crate::Result<DescriptionRecord> {
        solid.record().ok_or(crate::Error::NoDescription)
    }
}

use crate::predict::text_of;
use crate::progress::Progress;
use crate::write::{json_text, whole_file};
use crate::{Result, Solid};
use premio_csg::evaluate::EvaluationOptions;
use premio_csg::reader::{self, FacetLimit, ReadOptions};
use premio_kernel::number::predicates::CoincidencePolicy;
use premio_predict::image::shading::Finishes;
use premio_predict::model::Observation;
use premio_predict::model::consistency::SourceLimits;
use premio_predict::model::file::{self, ModelError, ModelFile};
use premio_predict::model::record::{ModelHead, Record, records};
use premio_predict::model::summary::Summary;
use premio_predict::setup::setups::Setups;
pub use run::SetupObserver;
pub use shard::ShardError;
use std::path::Path;

/// The model of a solid over the setups of a viewing and an illumination sphere: the detectability,
/// reliability and accuracy of each feature, and the co-detection of features.
///
/// A model carries the description of its solid.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
/// let setups = premio::read_setups("../examples/plate-setups.toml")?;
/// let model = Model::train(&solid, &setups, &Progress::new())?;
/// assert_eq!(model.head().count, 8);
/// assert_eq!(model.solid()?.volume(), solid.volume());
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Model {
    file: ModelFile,
    text: String,
}

impl Model {
    /// Predicts all setups and summarises them. A step of the progress is a setup.
    ///
    /// # Errors
    /// The solid is empty, a material is not known, no description can express the solid's numbers,
    /// or the work was cancelled.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    /// use std::sync::atomic::{AtomicU64, Ordering};
    ///
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setups = premio::read_setups("../examples/plate-setups.toml")?;
    /// let steps = AtomicU64::new(0);
    /// let count = |_| { steps.fetch_add(1, Ordering::Relaxed); };
    /// Model::train(&solid, &setups, &Progress::new().with_callback(count))?;
    /// assert_eq!(steps.into_inner(), 8);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn train(solid: &Solid, setups: &Setups, progress: &Progress<'_>) -> Result<Self> {
        let description = shards::description(solid)?;
        let part = solid.prepared()?;
        let finishes = Finishes::new(&part, &setups.conditions)?;
        let observer = SetupObserver {
            part: &part,
            finishes: &finishes,
            setups,
        };
        let mut observed: Vec<Observation> = Vec::new();
        observer.observe(0..setups.len(), progress, |batch| {
            observed.extend_from_slice(batch);
            Ok(())
        })?;
        let mut summary = Summary::default();
        observed.iter().for_each(|o| summary.add(o));
        summary.begin_second();
        observed.iter().for_each(|o| summary.add_again(o));
        let name = solid.expression().name();
        let digest = shard::digest([
            description.text.as_bytes(),
            &solid.resolution().to_bits().to_le_bytes(),
            serde_json::to_string(setups)?.as_bytes(),
        ]);
        let all = records(&summary, &name, &description, &digest, setups);
        Self::from_text(text(&all)?)
    }

    fn from_text(text: String) -> Result<Self> {
        let file = file::parse(&text)?;
        Ok(Self { file, text })
    }

    /// The model of a text (`premio.model/1`).
    ///
    /// # Errors
    /// The text is not a model, is inconsistent, or was changed after it was written.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// assert!(matches!(Model::parse("{}"), Err(premio::Error::Model(_))));
    /// ```
    pub fn parse(text: &str) -> Result<Self> {
        Self::from_text(text.to_owned())
    }

    /// Reads the model of a file.
    ///
    /// # Errors
    /// As [`Model::parse`]; or the file cannot be read.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// assert!(matches!(Model::read("no such.model"), Err(premio::Error::File { .. })));
    /// ```
    pub fn read(path: impl AsRef<Path>) -> Result<Self> {
        Self::from_text(text_of(path.as_ref())?)
    }

    /// Writes the model. The file appears whole or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setups = premio::read_setups("../examples/plate-setups.toml")?;
    /// let model = Model::train(&solid, &setups, &Progress::new())?;
    /// let path = folder.path().join("plate.model");
    /// model.write(&path)?;
    /// assert_eq!(Model::read(&path)?.text(), model.text());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        whole_file(path.as_ref(), &self.text)
    }

    /// The text of the model: a record of JSON a line.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setups = premio::read_setups("../examples/plate-setups.toml")?;
    /// let model = Model::train(&solid, &setups, &Progress::new())?;
    /// assert_eq!(model.text().lines().count(), model.records().len());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The head of the model.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setups = premio::read_setups("../examples/plate-setups.toml")?;
    /// let model = Model::train(&solid, &setups, &Progress::new())?;
    /// assert!(model.head().features > 9);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn head(&self) -> &ModelHead {
        &self.file.head
    }

    /// All records: the head, features, aspects, relations and dependences.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    /// use premio::shards::Record;
    ///
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setups = premio::read_setups("../examples/plate-setups.toml")?;
    /// let model = Model::train(&solid, &setups, &Progress::new())?;
    /// let features = model.records().iter().filter(|r| matches!(r, Record::Feature(_)));
    /// assert_eq!(features.count(), model.head().features);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn records(&self) -> &[Record] {
        &self.file.records
    }

    /// Evaluates the solid that the model carries.
    ///
    /// # Errors
    /// The description is invalid, or the model is of another solid.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let ball = sphere(2).evaluate()?;
    /// let setups = premio::read_setups("../examples/plate-setups.toml")?;
    /// let model = Model::train(&ball, &setups, &Progress::new())?;
    /// assert_eq!(model.solid()?.faces().count(), 1);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn solid(&self) -> Result<Solid> {
        let record = &self.file.head.description;
        let in_head = |words: String| -> ModelError {
            self.file
                .in_head(&self.text, "description.language", &words)
        };
        let format = shard::language(record).map_err(in_head)?;
        let how = ReadOptions {
            facets: FacetLimit::from_record(record.smooth, record.facets.as_deref())?,
            part: record.part.clone(),
            ..ReadOptions::default()
        };
        let name = &self.file.head.part;
        let program = reader::parse(name, record.text.as_bytes(), format, &how)?;
        let options = EvaluationOptions {
            resolution: record.resolution,
            zeros: match record.exact {
                true => CoincidencePolicy::Exact,
                false => CoincidencePolicy::ByResolution,
            },
            noise: record.noise,
            ..EvaluationOptions::default()
        };
        let expression = crate::Expression::described(program, record.clone(), name.clone());
        let solid = expression.evaluate_with(&options)?;
        let limits = SourceLimits::of_part(solid.brep());
        self.file.check_sources(&self.text, &limits)?;
        Ok(solid)
    }
}

/// The text of records, with its digest in the first line.
fn text(records: &[Record]) -> Result<String> {
    let mut text = String::new();
    for record in records {
        text += &json_text(record)?;
        text.push('\n');
    }
    Ok(file::sealed(&text).unwrap_or(text))
}
