//! `premio fuzz`: random trees by the thousand.

use crate::arguments::{FuzzOptions, ModelFormat, ProfileChoice};
use crate::diagnostics::{Failure, Voice};
use crate::fuzz::Error;
use crate::fuzz::archive::Archive;
use crate::fuzz::run::{How, run as run_all};
use crate::fuzz::state::{Plan, State, Writing};
use crate::fuzz::summary::Summary;
use crate::fuzz::worker::{Worker, serve};
use crate::interrupt::{stop, threads};
use crate::output;
use crate::session::Session;
use premio_verify::generator::profile::Profile;
use premio_verify::generator::write::Format;
use premio_verify::trial::Terms;
use std::sync::atomic::Ordering;
use std::time::Duration;

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::input(error.to_string())
    }
}

/// Runs the command.
pub fn run(options: &FuzzOptions, session: Session) -> Result<(), Failure> {
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
        Some(path) => State::load(path, plan, &session.limits)?,
        None => State::new(plan),
    };
    let stop = stop()?;
    let how = How {
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
    tell(options, voice, &Summary::new(&state), stopped)
}

fn tell(
    options: &FuzzOptions,
    voice: Voice,
    summary: &Summary,
    stopped: bool,
) -> Result<(), Failure> {
    let to = options.output.as_deref();
    match voice.is_json() {
        true => output::json(summary, to)?,
        false => output::write(summary.to_string(), to)?,
    }
    match (stopped, summary.wrong) {
        (true, _) => Err(Failure::Interrupted),
        (false, 0) => Ok(()),
        (false, _) => Err(Failure::Check),
    }
}

fn worker(terms: &str, limit: Duration) -> Result<(), Failure> {
    let terms: Terms = serde_json::from_str(terms)
        .map_err(|e| Failure::input(format!("the terms of a worker: {e}")))?;
    serve(&terms, limit).map_err(|e| Error::Worker(e).into())
}

fn plan(options: &FuzzOptions) -> Result<Plan, Failure> {
    if options.from.checked_add(options.count).is_none() {
        let text = "--from and --count: expected seeds of at most 64 bits";
        return Err(Failure::input(text));
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
        terms: Terms {
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
