//! `premio model`: what many predictions come to.

use crate::arguments::{MergeOptions, ModelCommand, ModelOptions, ModelRunOptions, RecordsFormat};
use crate::diagnostics::{Failure, Voice};
use crate::input::Part;
use crate::interrupt::{pool, stop};
use crate::model::format;
use crate::model::run::{Workers, summed};
use crate::model::shard::{Run, Shard, digest};
use crate::setup::{setups, subject};
use crate::{input, output};
use premio_predict::model::Setups;
use premio_predict::model::record::Record;
use std::fs;
use std::path::{Path, PathBuf};

/// How many setups a shard has where the run is not divided by hand.
const SHARD: usize = 256;

/// Runs the command.
pub fn run(options: &ModelOptions, voice: Voice) -> Result<(), Failure> {
    match (&options.command, &options.run.0) {
        (Some(ModelCommand::Merge(merge)), _) => merged(merge, voice),
        (None, Some(run)) => predicted(run, voice),
        (None, None) => Err(Failure::input(
            "expected a description and --setups, or `merge`",
        )),
    }
}

fn predicted(options: &ModelRunOptions, voice: Voice) -> Result<(), Failure> {
    let format = format::asked(&options.output)?;
    if options.shard.is_some() && format != RecordsFormat::Jsonl {
        let said = "a shard is lines of JSON: what is a table is the model, by `model merge`";
        return Err(Failure::input(said));
    }
    let (setups, text) = setups(&options.setups)?;
    let part = input::part(&options.description, voice)?;
    let run = Run {
        digest: told_apart(&part, options, &text)?,
        part: part.name.clone(),
        description: part.written.clone(),
        text,
        setups,
    };
    let (subject, finishes) = subject(&part, &options.setups, &run.setups.conditions)?;
    let pool = pool(options.threads)?;
    let stop = stop()?;
    let bar = voice.progress(run.setups.len() as u64);
    let workers = Workers {
        subject: &subject,
        finishes: &finishes,
        run: &run,
        threads: &pool,
        bar: &bar,
        stop: &stop,
    };
    let to = options.output.output.as_deref();
    if let Some(shard) = options.shard {
        let Some(path) = to else {
            return Err(Failure::input("a shard is a file: expected -o OUT"));
        };
        let shard = [shard.index, shard.of];
        bar.set_length((run.setups.len() / shard[1]) as u64);
        workers.shard(path, shard)?;
        bar.finish_and_clear();
        return Ok(());
    }
    let folder = Parts::new(to, options.resume)?;
    let of = run.setups.len().div_ceil(SHARD).max(1);
    for index in 1..=of {
        let path = folder.path.join(format!("{index:08}.shard"));
        if folder.is_whole(&path, &run, [index, of])? {
            bar.inc(SHARD as u64);
            continue;
        }
        workers
            .shard(&path, [index, of])
            .inspect_err(|_| bar.finish_and_clear())?;
    }
    bar.finish_and_clear();
    let paths: Vec<PathBuf> = (1..=of)
        .map(|i| folder.path.join(format!("{i:08}.shard")))
        .collect();
    let shards = opened(&paths)?;
    let records = summed_up(&run, &shards, voice)?;
    output::write(format::bytes(&records, format)?, to)?;
    folder.remove();
    Ok(())
}

/// What this part in these setups is told from others by: all that observations depend on.
fn told_apart(part: &Part, options: &ModelRunOptions, setups: &str) -> Result<String, Failure> {
    let description = input::bytes(&options.description.file)?;
    let taken = options.description.reading.part.clone().unwrap_or_default();
    let resolution = part.evaluation.resolution.to_bits().to_le_bytes();
    let version = env!("CARGO_PKG_VERSION").as_bytes();
    Ok(digest([
        &description,
        taken.as_bytes(),
        &resolution,
        setups.as_bytes(),
        version,
    ]))
}

/// The folder of a run's shards, beside its output.
struct Parts {
    path: PathBuf,
    /// Removed at the end, if the output is no file.
    _temporary: Option<tempfile::TempDir>,
}

impl Parts {
    fn new(output: Option<&Path>, resume: bool) -> Result<Self, Failure> {
        let Some(output) = output else {
            let folder = tempfile::tempdir().map_err(|e| Failure::input(e.to_string()))?;
            let path = folder.path().to_owned();
            return Ok(Self {
                path,
                _temporary: Some(folder),
            });
        };
        let mut name = output.as_os_str().to_owned();
        name.push(".parts");
        let path = PathBuf::from(name);
        let failed = |e: std::io::Error| Failure::input(format!("{}: {e}", path.display()));
        if path.exists() && !resume {
            let said =
                "is left of a run that was interrupted: --resume goes on with it; or remove it";
            return Err(Failure::input(format!("{}: {said}", path.display())));
        }
        fs::create_dir_all(&path).map_err(failed)?;
        Ok(Self {
            path,
            _temporary: None,
        })
    }

    /// Whether a shard of the run is there.
    fn is_whole(&self, path: &Path, run: &Run, shard: [usize; 2]) -> Result<bool, Failure> {
        if !path.exists() {
            return Ok(false);
        }
        let found = Shard::open(path)?.head;
        match found.digest == run.digest && found.shard == shard {
            true => Ok(true),
            false => Err(Failure::input(format!(
                "{}: found a shard of another run, of {}: remove {}",
                path.display(),
                found.part,
                self.path.display()
            ))),
        }
    }

    fn remove(&self) {
        if self._temporary.is_none() {
            // The model is written; what is left is of no harm.
            let _ = fs::remove_dir_all(&self.path);
        }
    }
}

fn opened(paths: &[PathBuf]) -> Result<Vec<Shard>, Failure> {
    paths.iter().map(|path| Shard::open(path)).collect()
}

fn summed_up(run: &Run, shards: &[Shard], voice: Voice) -> Result<Vec<Record>, Failure> {
    let bar = voice.progress(2 * run.setups.len() as u64);
    let all = summed(run, shards, &bar);
    bar.finish_and_clear();
    all
}

fn merged(options: &MergeOptions, voice: Voice) -> Result<(), Failure> {
    let format = format::asked(&options.output)?;
    let mut shards = opened(&options.shards)?;
    shards.sort_by_key(|shard| shard.head.shard[0]);
    let first = shards[0].head.clone();
    for (i, shard) in shards.iter().enumerate() {
        let head = &shard.head;
        if head.digest != first.digest || head.shard[1] != first.shard[1] {
            let said = format!(
                "shards of different runs: of {} and of {}",
                first.part, head.part
            );
            return Err(Failure::input(said));
        }
        if head.shard[0] != i + 1 {
            let of = first.shard[1];
            return Err(Failure::input(format!(
                "expected shard {}/{of}, found {}/{of}",
                i + 1,
                head.shard[0]
            )));
        }
    }
    if shards.len() != first.shard[1] {
        let (found, of) = (shards.len(), first.shard[1]);
        return Err(Failure::input(format!(
            "expected {of} shards, found {found}"
        )));
    }
    let setups = Setups::from_toml(&first.setups)
        .map_err(|error| Failure::setup("the setups of the shards", &error, &first.setups))?;
    let run = Run {
        part: first.part,
        description: first.description,
        digest: first.digest,
        text: first.setups,
        setups,
    };
    let records = summed_up(&run, &shards, voice)?;
    let to = options.output.output.as_deref();
    output::write(format::bytes(&records, format)?, to)
}
