//! `premio fuzz`: self-checks on thousands of random trees.

use crate::arguments::{FuzzOptions, ModelFormat, ProfileChoice};
use crate::diagnostics::{CliError, Reporter};
use crate::fuzz::FuzzError;
use crate::fuzz::archive::Archive;
use crate::fuzz::run::{RunConfig, run as run_all};
use crate::fuzz::state::{Plan, RunState, Writing};
use crate::fuzz::summary::RunSummary;
use crate::fuzz::worker::{Worker, serve};
use crate::interrupt::{stop, threads};
use crate::output;
use crate::session::Session;
use premio_verify::generator::profile::Profile;
use premio_verify::generator::write::Format;
use premio_verify::trial::TrialConfig;
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
        threads: threads(options.threads),
        stop: &stop,
        state: options.state.as_deref(),
        archive: archive.as_ref(),
    };
    let terms = state.plan.terms;
    let bar = voice.progress(state.plan.trees());
    let state = run_all(
        state,
        &how,
        || Worker::new(terms, limit, &stop),
        |state| {
            bar.set_position(state.done());
            let of = |count: fn(&_) -> u64| state.tallies.values().map(count).sum::<u64>();
            let (wrong, refused) = (of(|t| t.wrong), of(|t| t.refused));
            bar.set_message(format!(", {wrong} wrong, {refused} refused"));
        },
    )?;
    bar.finish_and_clear();
    if let Some(archive) = &archive {
        archive.finish(&state)?;
    }
    let stopped = stop.load(Ordering::Relaxed);
    tell(options, voice, &RunSummary::new(&state), stopped)
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
    match (stopped, summary.wrong) {
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
    })
}

fn formats(options: &FuzzOptions) -> Vec<Format> {
    let mut wanted = options.write_format.clone();
    wanted.sort();
    wanted.dedup();
    let format = |format: &ModelFormat| match format {
        ModelFormat::Padl => Format::Padl,
        ModelFormat::Csg => Format::Csg,
        ModelFormat::Json => Format::Json,
    };
    wanted.iter().map(format).collect()
}
