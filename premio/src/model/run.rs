//! Prediction of the setups of shards, and their summary.

use super::shard::{Shard, ShardHead, ShardRun, ShardWriter};
use crate::progress::{Progress, StepCounter};
use crate::{Error, Result};
use premio_kernel::concurrency::on_one_thread;
use premio_predict::image::shading::Finishes;
use premio_predict::image_arcs::lit_scene::StageError;
use premio_predict::model::consistency::SourceLimits;
use premio_predict::model::record::{Record, records};
use premio_predict::model::summary::Summary;
use premio_predict::model::{Observation, observe};
use premio_predict::prediction::{Memory, with_draft};
use premio_predict::prepared_part::PreparedPart;
use premio_predict::setup::setups::Setups;
use rayon::prelude::*;
use std::ops::Range;
use std::path::Path;

/// The number of setups in a batch.
const BATCH: usize = 64;

/// Predicts setups of a part, on the threads of the pool that it is called in.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
/// use premio::shards::{Finishes, PreparedPart, SetupObserver};
///
/// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
/// let setups = premio::read_setups("../examples/plate-setups.toml")?;
/// let part = PreparedPart::new(solid.brep(), solid.resolution()).unwrap();
/// let finishes = Finishes::new(&part, &setups.conditions)?;
/// let observer = SetupObserver { part: &part, finishes: &finishes, setups: &setups };
/// let mut seen = Vec::new();
/// observer.observe(2..4, &Progress::new(), |batch| {
///     seen.extend(batch.iter().map(|observation| observation.setup));
///     Ok(())
/// })?;
/// assert_eq!(seen, [2, 3]);
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SetupObserver<'s> {
    /// The part.
    pub part: &'s PreparedPart<'s>,
    /// The materials of its faces.
    pub finishes: &'s Finishes,
    /// The setups.
    pub setups: &'s Setups,
}

impl SetupObserver<'_> {
    /// Predicts a range of setups and passes them on in order, in batches. A step of the progress
    /// is a setup.
    ///
    /// # Errors
    /// The work was cancelled, or the receiver of the observations fails.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    /// use premio::shards::{Finishes, PreparedPart, SetupObserver};
    ///
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setups = premio::read_setups("../examples/plate-setups.toml")?;
    /// let part = PreparedPart::new(solid.brep(), solid.resolution()).unwrap();
    /// let finishes = Finishes::new(&part, &setups.conditions)?;
    /// let observer = SetupObserver { part: &part, finishes: &finishes, setups: &setups };
    /// let token = CancelToken::new();
    /// token.cancel();
    /// let progress = Progress::new().with_token(&token);
    /// assert!(observer.observe(0..8, &progress, |_| Ok(())).is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn observe(
        &self,
        range: Range<usize>,
        progress: &Progress<'_>,
        mut report: impl FnMut(&[Observation]) -> Result<()>,
    ) -> Result<()> {
        let counter = progress.counter(range.len() as u64);
        let mut from = range.start;
        while from < range.end {
            let batch = from..(from + BATCH).min(range.end);
            from = batch.end;
            let each = batch.into_par_iter();
            let observed: Vec<Observation> = each
                .map_init(Memory::default, |memory, i| {
                    on_one_thread(|| self.one(i, memory, progress, &counter))
                })
                .collect();
            progress.check()?;
            report(&observed)?;
        }
        Ok(())
    }

    /// Predicts the setups of a shard into its file; no file remains if the work is cancelled.
    ///
    /// # Errors
    /// The work was cancelled, or the file cannot be written.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    /// use premio::shards::{Finishes, PreparedPart, SetupObserver, Shard, ShardRun};
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// let solid = premio::read("../examples/bored-block.padl")?.evaluate()?;
    /// let setups = std::fs::read_to_string("../examples/plate-setups.toml").unwrap();
    /// let run = ShardRun::new(&solid, &setups)?;
    /// let part = PreparedPart::new(solid.brep(), solid.resolution()).unwrap();
    /// let finishes = Finishes::new(&part, &run.setups.conditions)?;
    /// let observer = SetupObserver { part: &part, finishes: &finishes, setups: &run.setups };
    /// let path = folder.path().join("2-of-4.shard");
    /// observer.write_shard(&path, &run, [2, 4], &Progress::new())?;
    /// assert_eq!(Shard::open(&path, u64::MAX)?.head.range(), 2..4);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn write_shard(
        &self,
        path: &Path,
        run: &ShardRun,
        shard: [usize; 2],
        progress: &Progress<'_>,
    ) -> Result<()> {
        let head = ShardHead::new(run, shard);
        let mut writer = ShardWriter::new(path, &head)?;
        self.observe(head.range(), progress, |observed| {
            for observation in observed {
                writer.line(observation)?;
            }
            Ok(())
        })?;
        Ok(writer.finish()?)
    }

    fn one(
        &self,
        index: usize,
        memory: &mut Memory,
        progress: &Progress<'_>,
        counter: &StepCounter<'_, '_>,
    ) -> Observation {
        if progress.check().is_err() {
            // It is not passed on.
            return Observation::unseen(self.setups, index, String::new());
        }
        let seen = self.predict(index, memory);
        counter.add(1);
        let unseen = |e: StageError| Observation::unseen(self.setups, index, e.to_string());
        seen.unwrap_or_else(unseen)
    }

    fn predict(&self, index: usize, memory: &mut Memory) -> Result<Observation, StageError> {
        let setup = self.setups.setup(index, self.part);
        let finishes = Some(self.finishes);
        with_draft(self.part, finishes, &setup, memory, |draft| {
            observe(draft, self.setups, index)
        })
    }
}

/// The records of a model, from all shards of a run, in order. A step of the progress is an
/// observation; each is read twice.
///
/// # Errors
/// A shard cannot be read, or was changed after it was written, or the work was cancelled.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
/// use premio::shards::{ShardRun, SourceLimits, summed};
///
/// let solid = premio::block(6, 4, 2).evaluate()?;
/// let setups = std::fs::read_to_string("../examples/plate-setups.toml").unwrap();
/// let run = ShardRun::new(&solid, &setups)?;
/// // Without observations there is the head and nothing else but the dependences.
/// let records = summed(&run, &[], &SourceLimits::NONE, &Progress::new())?;
/// assert!(!records.is_empty());
/// # Ok::<(), premio::Error>(())
/// ```
pub fn summed(
    run: &ShardRun,
    shards: &[Shard],
    limits: &SourceLimits,
    progress: &Progress<'_>,
) -> Result<Vec<Record>> {
    let counter = progress.counter(2 * run.setups.len() as u64);
    let mut summary = Summary::default();
    let each = |add: &mut dyn FnMut(&Observation)| {
        for shard in shards {
            progress.check()?;
            shard.each(limits, |observation| {
                add(observation);
                counter.add(1);
            })?;
        }
        Ok::<(), Error>(())
    };
    each(&mut |observation| summary.add(observation))?;
    summary.begin_second();
    each(&mut |observation| summary.add_again(observation))?;
    Ok(records(
        &summary,
        &run.part,
        &run.description,
        &run.digest,
        &run.setups,
    ))
}
