//! `premio fuzz`: self-checks on thousands of random trees.

use crate::arguments::{FuzzOptions, ModelFormat, ProfileChoice};
use crate::diagnostics::{CliError, Reporter};
use crate::fuzz::FuzzError;
use crate::fuzz::against::command::{AgainstCommand, CommandError};
use crate::fuzz::against::launch::{ProgramLimits, become_program};
use crate::fuzz::against::tally::AgainstCounts;
use crate::fuzz::archive::Archive;
use crate::fuzz::comparison::{AgainstConfig, AgainstExaminer, ModelForm, file_model};
use crate::fuzz::examine::Examine;
use crate::fuzz::item::FileModel;
use crate::fuzz::run::{RunConfig, run as run_all};
use crate::fuzz::state::{AgainstPlan, Plan, RunState, Writing};
use crate::fuzz::summary::RunSummary;
use crate::fuzz::worker::{Worker, serve};
use crate::interrupt::stop;
use crate::output;
use crate::session::Session;
use premio_kernel::concurrency::threads;
use premio_verify::against::import::{ImportError, model};
use premio_verify::against::template::{ModelTemplate, TemplateLanguage};
use premio_verify::generator::profile::Profile;
use premio_verify::generator::write::Format;
use premio_verify::trial::TrialConfig;
use std::ffi::OsString;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Duration;

impl From<FuzzError> for CliError {
    fn from(error: FuzzError) -> Self {
        Self::input(error.to_string())
    }
}

/// Runs the command.
pub fn run(options: &FuzzOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    let limit = Duration::from_secs_f64(options.limit);
    if let Some(terms) = &options.worker {
        return worker(terms, limit);
    }
    if let Some(memory) = options.launch {
        let words: Vec<OsString> = options.files.iter().map(OsString::from).collect();
        let limits = ProgramLimits {
            time: limit,
            memory,
        };
        return Err(FuzzError::Program(become_program(&words, &limits)).into());
    }
    check_use(options)?;
    let against = against(options, &session)?;
    let files = options.files.iter().map(|path| read_file(path, &session));
    let files = files.collect::<Result<Vec<FileModel>, CliError>>()?;
    let plan = plan(options)?;
    let archive = match &options.write {
        Some(folder) => Some(Archive::new(folder, &formats(options))?),
        None => None,
    };
    let state = match &options.state {
        Some(path) => RunState::load(path, plan, &session.limits)?,
        None => RunState::new(plan),
    };
    let stop = stop()?;
    let how = RunConfig {
        threads: threads(),
        stop: &stop,
        state: options.state.as_deref(),
        archive: archive.as_ref(),
        files: &files,
    };
    let terms = state.plan.terms;
    let worker = || Worker::new(terms, limit, &stop);
    let state = match &against {
        Some(config) => {
            let make = || AgainstExaminer::new(worker(), config, &files, &stop);
            run_shown(state, &how, make, voice)?
        }
        None => run_shown(state, &how, worker, voice)?,
    };
    if let Some(archive) = &archive {
        archive.finish(&state)?;
    }
    let stopped = stop.load(Ordering::Relaxed);
    tell(options, voice, &RunSummary::new(&state), stopped)
}

/// Runs the plan, and shows its progress.
fn run_shown<E: Examine>(
    state: RunState,
    how: &RunConfig<'_>,
    make: impl Fn() -> E + Sync,
    voice: Reporter,
) -> Result<RunState, FuzzError> {
    let bar = voice.progress(state.plan.trees());
    let state = run_all(state, how, make, |state| {
        bar.set_position(state.done());
        let of = |count: fn(&_) -> u64| state.tallies.values().map(count).sum::<u64>();
        let (wrong, refused) = (of(|t| t.wrong), of(|t| t.refused));
        let against = state.tallies.values().filter_map(|t| t.against.as_ref());
        let against = against.map(|a| a.counts).reduce(AgainstCounts::plus);
        let theirs = match against {
            Some(counts) => format!("; the program: {} failures", counts.failures()),
            None => String::new(),
        };
        bar.set_message(format!(", {wrong} wrong, {refused} refused{theirs}"));
    })?;
    bar.finish_and_clear();
    Ok(state)
}

/// Checks the options that depend on each other.
fn check_use(options: &FuzzOptions) -> Result<(), CliError> {
    let has_formats = !options.write_format.is_empty();
    let text = match (&options.against, &options.write) {
        (None, _) if !options.files.is_empty() => "FILES: expected `--against` with them",
        (None, None) if has_formats => "--write-format: expected `--write` or `--against` with it",
        (Some(_), _) if formats(options).len() != 1 => {
            "--write-format: expected one format with `--against`"
        }
        _ => return Ok(()),
    };
    Err(CliError::input(text))
}

/// The configuration of the other program.
fn against(options: &FuzzOptions, session: &Session) -> Result<Option<AgainstConfig>, CliError> {
    let Some(text) = &options.against else {
        return Ok(None);
    };
    let named = |error: CommandError| CliError::input(format!("--against: {error}"));
    let command = AgainstCommand::new(text).map_err(named)?;
    command.check().map_err(named)?;
    let form = match &options.template {
        Some(path) => ModelForm::Program(template(path, session)?),
        None => ModelForm::Description(formats(options)[0]),
    };
    Ok(Some(AgainstConfig {
        command,
        form,
        limits: ProgramLimits {
            time: Duration::from_secs_f64(options.limit),
            memory: options.memory,
        },
        tolerance: options.tolerance,
    }))
}

fn template(path: &Path, session: &Session) -> Result<ModelTemplate, CliError> {
    let name = path.display();
    let ending = path.extension().and_then(|ending| ending.to_str());
    let language = ending.and_then(TemplateLanguage::from_ending);
    let language = language.ok_or_else(|| {
        CliError::input(format!(
            "{name}: expected a template that ends with .py or .cpp"
        ))
    })?;
    let text = session.limits.read_text(path)?;
    ModelTemplate::new(&text, language).map_err(|e| CliError::input(format!("{name}: {e}")))
}

fn read_file(path: &Path, session: &Session) -> Result<FileModel, CliError> {
    let name = path.display().to_string();
    let format = Format::from_path(path)
        .ok_or_else(|| CliError::input(format!("{name}: expected the ending of a description")))?;
    let bytes = session.limits.read(path)?;
    let read = model(&name, &bytes, format);
    // An error of reading has the name already.
    let read = read.map_err(|error| match error {
        ImportError::Read(error) => CliError::read(&error, &bytes),
        error => CliError::input(format!("{name}: {error}")),
    })?;
    Ok(file_model(read))
}

fn tell(
    options: &FuzzOptions,
    voice: Reporter,
    summary: &RunSummary,
    stopped: bool,
) -> Result<(), CliError> {
    let to = options.output.as_deref();
    match voice.is_json() {
        true => output::json(summary, to)?,
        false => output::write(summary.to_string(), to)?,
    }
    let theirs = summary.against.map_or(0, |counts| counts.failures());
    match (stopped, summary.wrong + theirs) {
        (true, _) => Err(CliError::Interrupted),
        (false, 0) => Ok(()),
        (false, _) => Err(CliError::Check),
    }
}

fn worker(terms: &str, limit: Duration) -> Result<(), CliError> {
    let terms: TrialConfig = serde_json::from_str(terms)
        .map_err(|e| CliError::input(format!("the configuration of a worker: {e}")))?;
    serve(&terms, limit).map_err(|e| FuzzError::Worker(e).into())
}

fn plan(options: &FuzzOptions) -> Result<Plan, CliError> {
    if options.from.checked_add(options.count).is_none() {
        let text = "--from and --count: expected seeds of at most 64 bits";
        return Err(CliError::input(text));
    }
    let mut profiles: Vec<Profile> = Vec::new();
    for choice in &options.profile {
        match choice {
            ProfileChoice::All => profiles.extend(Profile::ALL),
            ProfileChoice::One(profile) => profiles.push(*profile),
        }
    }
    profiles.sort();
    profiles.dedup();
    Ok(Plan {
        profiles,
        from: options.from,
        count: options.count,
        terms: TrialConfig {
            resolution: options.resolution,
            strict: options.strict,
            views: options.views,
            sheets: options.sheets,
            step: options.step,
            unfiltered: options.unfiltered,
            rays: options.rays,
        },
        limit: options.limit,
        shrink: options.shrink,
        write: options.write.as_ref().map(|folder| Writing {
            folder: folder.clone(),
            formats: formats(options)
                .iter()
                .map(|f| f.ending().to_owned())
                .collect(),
        }),
        files: options.files.clone(),
        against: options.against.as_ref().map(|command| AgainstPlan {
            command: command.clone(),
            form: match &options.template {
                Some(template) => ending(template),
                None => formats(options)[0].ending().to_owned(),
            },
            template: options.template.clone(),
            memory: options.memory,
            tolerance: options.tolerance,
        }),
    })
}

fn ending(path: &Path) -> String {
    let ending = path.extension().unwrap_or_default();
    ending.to_string_lossy().into_owned()
}

fn formats(options: &FuzzOptions) -> Vec<Format> {
    let mut wanted = options.write_format.clone();
    if wanted.is_empty() {
        wanted.push(ModelFormat::Padl);
    }
    wanted.sort();
    wanted.dedup();
    let format = |format: &ModelFormat| match format {
        ModelFormat::Padl => Format::Padl,
        ModelFormat::Csg => Format::Csg,
        ModelFormat::Json => Format::Json,
    };
    wanted.iter().map(format).collect()
}
