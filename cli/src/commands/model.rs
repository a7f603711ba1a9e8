//! `premio model`: the summary of many predictions.

use crate::arguments::{MergeOptions, ModelCommand, ModelOptions, ModelRunOptions, RecordsFormat};
use crate::diagnostics::{CliError, counted};
use crate::input::EvaluatedPart;
use crate::interrupt::{pool, stop};
use crate::model::format;
use crate::session::Session;
use crate::setup::{SetupFile, setups};
use crate::{input, output};
use indicatif::ProgressBar;
use premio::files::is_no_file;
use premio::shards::{SetupObserver, Shard, ShardHead, ShardRun, digest, summed};
use premio::{CancelToken, Progress};
use premio_kernel::brep::Brep;
use premio_predict::model::consistency::SourceLimits;
use premio_predict::model::record::Record;
use premio_predict::setup::setups::Setups;
use rayon::ThreadPool;
use std::fs;
use std::path::{Path, PathBuf};

/// The number of setups of a shard where the run is not divided by `--shard`.
const SHARD: usize = 256;

/// Runs the command.
pub fn run(options: &ModelOptions, session: Session) -> Result<(), CliError> {
    match (&options.command, &options.run.0) {
        (Some(ModelCommand::Merge(merge)), _) => merged(merge, session),
        (None, Some(run)) => predicted(run, session),
        (None, None) => Err(CliError::input(
            "expected a description and --setups, or `merge`",
        )),
    }
}

fn predicted(options: &ModelRunOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    let format = format::requested(&options.output)?;
    if options.shard.is_some() && format != RecordsFormat::Jsonl {
        let said = "a shard is lines of JSON: what is a table is the model, by `model merge`";
        return Err(CliError::input(said));
    }
    let file = setups(&options.setups, session)?;
    let part = input::part(&options.description, session)?;
    let run = ShardRun {
        digest: run_digest(&part, options, &file.text),
        part: part.name.clone(),
        description: part.written.clone(),
        text: file.text.clone(),
        setups: file.value.clone(),
    };
    let (subject, finishes) = file.subject(&part, &run.setups.conditions)?;
    file.check_places(&subject, session)?;
    let pool = pool()?;
    let stop = stop()?;
    let bar = voice.progress(run.setups.len() as u64);
    let token = CancelToken::from(stop);
    let workers = Workers {
        observer: SetupObserver {
            part: &subject,
            finishes: &finishes,
            setups: &run.setups,
        },
        run: &run,
        threads: &pool,
        progress: Progress::new()
            .with_callback(|_| bar.inc(1))
            .with_token(&token),
    };
    let to = options.output.output.as_deref();
    if let Some(shard) = options.shard {
        let Some(path) = to else {
            return Err(CliError::input("a shard is a file: expected -o OUT"));
        };
        let shard = [shard.index, shard.of];
        bar.set_length((run.setups.len() / shard[1]) as u64);
        workers.shard(path, shard)?;
        bar.finish_and_clear();
        return Ok(());
    }
    let folder = Parts::new(to, options.resume)?;
    let made = whole(&workers, &folder, &bar, session, |records| {
        if let Some(Record::Model(head)) = records.first() {
            file.check_seen(head, session)?;
        }
        let count = records.len();
        output::write(format::bytes(records, format)?, to)?;
        bar.finish_and_clear();
        let setups = counted(run.setups.len(), "setup");
        voice.summary(&format!(
            "a model of {setups}: {}",
            counted(count, "record")
        ));
        Ok(())
    });
    bar.finish_and_clear();
    match &made {
        // An interrupted run continues from the existing shards.
        Err(CliError::Interrupted) => (),
        Err(_) if folder.was_there => (),
        _ => folder.remove(),
    }
    made
}

/// The workers that predict the shards of a run.
struct Workers<'s> {
    observer: SetupObserver<'s>,
    run: &'s ShardRun,
    threads: &'s ThreadPool,
    progress: Progress<'s>,
}

impl Workers<'_> {
    /// Predicts the setups of a shard into its file; no file remains if it is interrupted.
    fn shard(&self, path: &Path, shard: [usize; 2]) -> Result<(), CliError> {
        let Self {
            observer,
            run,
            progress,
            ..
        } = self;
        let written = || observer.write_shard(path, run, shard, progress);
        self.threads.install(written).map_err(CliError::library)
    }
}

/// Predicts all shards of a run and writes the model.
fn whole(
    workers: &Workers<'_>,
    folder: &Parts,
    bar: &ProgressBar,
    session: Session,
    write: impl Fn(Vec<Record>) -> Result<(), CliError>,
) -> Result<(), CliError> {
    let run = workers.run;
    let of = run.setups.len().div_ceil(SHARD).max(1);
    for index in 1..=of {
        let path = folder.shard(index);
        if folder.is_whole(&path, run, [index, of], session)? {
            bar.inc(SHARD as u64);
            continue;
        }
        workers.shard(&path, [index, of])?;
    }
    bar.finish_and_clear();
    let paths: Vec<PathBuf> = (1..=of).map(|i| folder.shard(i)).collect();
    let shards = opened(&paths, session)?;
    write(summed_up(
        run,
        &shards,
        workers.observer.part.brep,
        session,
    )?)
}

/// The digest of part and setups: of everything that observations depend on.
fn run_digest(part: &EvaluatedPart, options: &ModelRunOptions, setups: &str) -> String {
    let description = part.written.text.as_bytes();
    let taken = options.description.reading.part.clone().unwrap_or_default();
    let resolution = part.solid.evaluation().resolution.to_bits().to_le_bytes();
    let version = env!("CARGO_PKG_VERSION").as_bytes();
    digest([
        description,
        taken.as_bytes(),
        &resolution,
        setups.as_bytes(),
        version,
    ])
}

/// The folder of a run's shards, next to its output.
struct Parts {
    path: PathBuf,
    /// Whether it remains from an interrupted run.
    was_there: bool,
    /// Removed at the end, if the output is not a file.
    _temporary: Option<tempfile::TempDir>,
}

impl Parts {
    fn new(output: Option<&Path>, resume: bool) -> Result<Self, CliError> {
        let Some(output) = output.filter(|path| !is_no_file(path)) else {
            let folder = tempfile::tempdir().map_err(|e| CliError::input(e.to_string()))?;
            let path = folder.path().to_owned();
            return Ok(Self {
                path,
                was_there: false,
                _temporary: Some(folder),
            });
        };
        let mut name = output.as_os_str().to_owned();
        name.push(".parts");
        let path = PathBuf::from(name);
        let failed = |e: std::io::Error| CliError::input(format!("{}: {e}", path.display()));
        let was_there = path.exists();
        if was_there && !resume {
            let said = "remains from an interrupted run: continue it with --resume, or remove it";
            return Err(CliError::input(format!("{}: {said}", path.display())));
        }
        if !was_there {
            fs::create_dir(&path).map_err(failed)?;
        }
        Ok(Self {
            path,
            was_there,
            _temporary: None,
        })
    }

    /// Whether a complete shard of the run exists.
    fn is_whole(
        &self,
        path: &Path,
        run: &ShardRun,
        shard: [usize; 2],
        session: Session,
    ) -> Result<bool, CliError> {
        if !path.exists() {
            return Ok(false);
        }
        let found = open(path, session)?.head;
        match found == ShardHead::new(run, shard) {
            true => Ok(true),
            false => Err(CliError::input(format!(
                "{}: found a shard of another run, of {}: remove {}",
                path.display(),
                found.part,
                self.path.display()
            ))),
        }
    }

    /// The file of a shard.
    fn shard(&self, index: usize) -> PathBuf {
        self.path.join(format!("{index:08}.shard"))
    }

    /// Removes the shards, and the folder if nothing else is in it.
    fn remove(&self) {
        if self._temporary.is_some() {
            return;
        }
        // Files that cannot be removed are harmless.
        let mut index = 1;
        while fs::remove_file(self.shard(index)).is_ok() {
            index += 1;
        }
        let _ = fs::remove_dir(&self.path);
    }
}

fn open(path: &Path, session: Session) -> Result<Shard, CliError> {
    Shard::open(path, session.limits.input).map_err(|error| CliError::shard(&error))
}

fn opened(paths: &[PathBuf], session: Session) -> Result<Vec<Shard>, CliError> {
    let open = |path: &PathBuf| open(path, session);
    paths.iter().map(open).collect()
}

fn summed_up(
    run: &ShardRun,
    shards: &[Shard],
    brep: &Brep,
    session: Session,
) -> Result<Vec<Record>, CliError> {
    let bar = session.voice.progress(2 * run.setups.len() as u64);
    let limits = SourceLimits::of_part(brep).with_setups(&run.setups);
    let progress = Progress::new().with_callback(|_| bar.inc(1));
    let all = summed(run, shards, &limits, &progress);
    bar.finish_and_clear();
    all.map_err(CliError::library)
}

/// Checks that the shards are all those of one run, in order.
fn check_run(shards: &[Shard]) -> Result<(), CliError> {
    let first = &shards[0].head;
    let said = |shard: &Shard, words: String| {
        Err(CliError::input(format!(
            "{}:1:1: {words}",
            shard.path().display()
        )))
    };
    for (i, shard) in shards.iter().enumerate() {
        if !shard.head.is_of_run(first) {
            let words = format!(
                "found a shard of another run, of {}, expected one of {}, as {} is",
                shard.head.part,
                first.part,
                shards[0].path().display()
            );
            return said(shard, words);
        }
        if shard.head.shard[0] != i + 1 {
            let (found, of) = (shard.head.shard[0], first.shard[1]);
            let words = format!("found shard {found}/{of}, expected {}/{of}", i + 1);
            return said(shard, words);
        }
    }
    match (shards.len(), first.shard[1]) {
        (found, of) if found == of => Ok(()),
        (found, of) => Err(CliError::input(format!(
            "expected {of} shards, found {found}"
        ))),
    }
}

fn merged(options: &MergeOptions, session: Session) -> Result<(), CliError> {
    let format = format::requested(&options.output)?;
    let mut shards = opened(&options.shards, session)?;
    shards.sort_by_key(|shard| shard.head.shard[0]);
    check_run(&shards)?;
    let first = shards[0].head.clone();
    let setups = Setups::from_toml(&first.setups)
        .map_err(|error| CliError::setup("the setups of the shards", &error, &first.setups))?;
    if setups.len() != first.count {
        let (name, found) = (shards[0].path().display(), first.count);
        let expected = setups.len();
        let said = format!("{name}:1:1: found `count` {found}, expected {expected} setups");
        return Err(CliError::input(said));
    }
    let run = ShardRun {
        part: first.part,
        description: first.description,
        digest: first.digest,
        text: first.setups,
        setups,
    };
    let name = shards[0].path().display().to_string();
    let part = input::part_of_model(&name, run.description.clone(), session.voice)?;
    let records = summed_up(&run, &shards, part.solid.brep(), session)?;
    let file = SetupFile {
        name: "the setups of the shards".to_owned(),
        text: run.text.clone(),
        value: (),
    };
    if let Some(Record::Model(head)) = records.first() {
        file.check_seen(head, session)?;
    }
    let to = options.output.output.as_deref();
    output::write(format::bytes(records, format)?, to)
}
