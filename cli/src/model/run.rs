//! Predicting the setups of shards, and summing them up.

use super::shard::{Run, Shard, ShardHead, Writer};
use crate::diagnostics::CliError;
use indicatif::ProgressBar;
use premio_predict::image::shading::Finishes;
use premio_predict::image_arcs::lit_scene::StageError;
use premio_predict::model::consistency::SourceLimits;
use premio_predict::model::record::{Record, records};
use premio_predict::model::summary::Summary;
use premio_predict::model::{Observation, observe};
use premio_predict::prediction::{Memory, with_draft};
use premio_predict::prepared_part::PreparedPart;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// How many setups are predicted before they are written.
const BATCH: usize = 64;

/// What predicts.
pub struct Workers<'s> {
    /// The part.
    pub subject: &'s PreparedPart<'s>,
    /// The materials of its faces.
    pub finishes: &'s Finishes,
    /// The run.
    pub run: &'s Run,
    /// The threads.
    pub threads: &'s ThreadPool,
    /// How far the work is.
    pub bar: &'s ProgressBar,
    /// Set by an interrupt.
    pub stop: &'s AtomicBool,
}

impl Workers<'_> {
    /// Predicts the setups of a shard into its file; nothing is left of it if it is interrupted.
    pub fn shard(&self, path: &Path, shard: [usize; 2]) -> Result<(), CliError> {
        let head = ShardHead::new(self.run, shard);
        let mut writer = Writer::new(path, &head)?;
        let range = head.range();
        let mut from = range.start;
        while from < range.end {
            let batch = from..(from + BATCH).min(range.end);
            from = batch.end;
            let observed: Vec<Observation> = self.threads.install(|| {
                let each = batch.into_par_iter();
                each.map_init(Memory::default, |memory, i| self.observe(i, memory))
                    .collect()
            });
            if self.stop.load(Ordering::Relaxed) {
                return Err(CliError::Interrupted);
            }
            for observation in &observed {
                writer.line(observation)?;
            }
        }
        writer.finish()
    }

    fn observe(&self, index: usize, memory: &mut Memory) -> Observation {
        if self.stop.load(Ordering::Relaxed) {
            // It will not be written.
            return Observation::unseen(&self.run.setups, index, String::new());
        }
        let seen = self.predict(index, memory);
        self.bar.inc(1);
        let unseen = |e: StageError| Observation::unseen(&self.run.setups, index, e.to_string());
        seen.unwrap_or_else(unseen)
    }

    fn predict(&self, index: usize, memory: &mut Memory) -> Result<Observation, StageError> {
        let setups = &self.run.setups;
        let setup = setups.setup(index, self.subject);
        let finishes = Some(self.finishes);
        with_draft(self.subject, finishes, &setup, memory, |draft| {
            observe(draft, setups, index)
        })
    }
}

/// The records of a model, from all shards of a run, in order.
pub fn summed(
    run: &Run,
    shards: &[Shard],
    limits: &SourceLimits,
    bar: &ProgressBar,
) -> Result<Vec<Record>, CliError> {
    let mut summary = Summary::default();
    for shard in shards {
        shard.each(limits, |observation| {
            summary.add(observation);
            bar.inc(1);
        })?;
    }
    summary.begin_second();
    for shard in shards {
        shard.each(limits, |observation| {
            summary.add_again(observation);
            bar.inc(1);
        })?;
    }
    let part = (run.part.as_str(), &run.description);
    Ok(records(&summary, part, &run.digest, &run.setups))
}
