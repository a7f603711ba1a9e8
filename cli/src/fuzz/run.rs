//! Trials of many trees on many threads.

use super::FuzzError;
use super::against::verdict::{AgainstFailure, AgainstFindingKind};
use super::archive::Archive;
use super::examine::{Examine, Examined, ModelOrigin};
use super::finding::Finds;
use super::item::{FileModel, Item};
use super::state::RunState;
use premio_verify::generator::model::PartModel;
use premio_verify::generator::shrink::shrink;
use premio_verify::generator::write::{Format, write};
use premio_verify::trial::{FailureKind, Verdict, reason};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// The configuration of a run, in addition to its plan.
#[derive(Clone, Copy, Debug)]
pub struct RunConfig<'a> {
    /// The number of threads.
    pub threads: usize,
    /// Set when the run shall stop.
    pub stop: &'a AtomicBool,
    /// The file of the state.
    pub state: Option<&'a Path>,
    /// The folder for models.
    pub archive: Option<&'a Archive>,
    /// The models of files.
    pub files: &'a [FileModel],
}

/// The interval between progress reports.
const TELL: Duration = Duration::from_millis(100);

/// The least interval between saves of the state, and its least ratio to the duration of a save.
const SAVE: Duration = Duration::from_secs(5);
const SAVING: u32 = 20;

/// The number of findings of each kind and profile that are shrunk, the first by seed; one for
/// refusals.
const SHRUNK: usize = 5;

/// The most smaller trees that are tried for a finding; each that hangs takes the time limit.
const TRIES: usize = 1000;
const TRIES_IN_TIME: usize = 30;

/// The number of findings of each kind and profile of another program that are shrunk, and the most
/// smaller trees that are tried for each; a program has to start for every one of them.
const SHRUNK_AGAINST: usize = 2;
const TRIES_AGAINST: usize = 400;

/// The data that all threads share.
#[derive(Clone, Copy)]
struct Shared<'a> {
    how: &'a RunConfig<'a>,
    state: &'a Mutex<RunState>,
}

impl<'a> Shared<'a> {
    /// No thread leaves the state inconsistent.
    fn state(&self) -> MutexGuard<'a, RunState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_stopped(&self) -> bool {
        self.how.stop.load(Ordering::Relaxed)
    }
}

/// Runs the remaining trials of a plan, then shrinks the failures, and returns the findings; fewer
/// if it is stopped. `make` makes the examiner of each thread; `tell` receives the progress.
pub fn run<E: Examine>(
    state: RunState,
    how: &RunConfig<'_>,
    make: impl Fn() -> E + Sync,
    mut tell: impl FnMut(&RunState),
) -> Result<RunState, FuzzError> {
    let shrink = state.plan.shrink;
    let state = Mutex::new(state);
    let shared = Shared { how, state: &state };
    try_all(shared, &make, &mut tell)?;
    if shrink && !shared.is_stopped() {
        shrink_all(shared, &make, &mut tell)?;
    }
    Ok(state.into_inner().unwrap_or_else(PoisonError::into_inner))
}

fn try_all<E: Examine>(
    shared: Shared<'_>,
    make: &(impl Fn() -> E + Sync),
    tell: &mut impl FnMut(&RunState),
) -> Result<(), FuzzError> {
    let next = AtomicU64::new(0);
    let left = {
        let state = shared.state();
        state.plan.trees().saturating_sub(state.done())
    };
    let work = |examiner: &mut E| -> Result<bool, FuzzError> {
        let Some(NumberedItem { number, item }) = take(shared, &next) else {
            return Ok(false);
        };
        let model = item.model(shared.how.files);
        let started = Instant::now();
        let is_whole = true;
        let examined = examiner.examine(&model, &ModelOrigin { item, is_whole });
        let Some(examined) = examined.map_err(FuzzError::Worker)? else {
            return Ok(false);
        };
        // The times of another program are counted apart.
        let program = examined.against.as_ref().map(|a| a.times.program);
        let seconds = started.elapsed().as_secs_f64() - program.unwrap_or(0.0);
        let line = match shared.how.archive {
            Some(archive) => Some(archive.put(item, &model, &examined.outcome)?),
            None => None,
        };
        shared.state().record(number, examined, seconds, line);
        Ok(true)
    };
    // Few trees need only few processes.
    let threads = left.min(shared.how.threads as u64) as usize;
    dispatch(shared, threads, make, &work, tell)
}

/// A tree of a run, and its number.
struct NumberedItem {
    number: u64,
    item: Item,
}

/// The next tree that is not finished.
fn take(shared: Shared<'_>, next: &AtomicU64) -> Option<NumberedItem> {
    loop {
        let number = next.fetch_add(1, Ordering::Relaxed);
        let state = shared.state();
        let item = state.plan.item(number)?;
        if !state.is_done(number) {
            return Some(NumberedItem { number, item });
        }
    }
}

/// Shrinks the first findings of each kind.
fn shrink_all<E: Examine>(
    shared: Shared<'_>,
    make: &(impl Fn() -> E + Sync),
    tell: &mut impl FnMut(&RunState),
) -> Result<(), FuzzError> {
    let jobs = jobs(&shared.state());
    let next = AtomicUsize::new(0);
    let work = |examiner: &mut E| -> Result<bool, FuzzError> {
        let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) else {
            return Ok(false);
        };
        let small = job.small(examiner, shared.how.files)?;
        // A finding whose shrinking was stopped is not minimal.
        if shared.is_stopped() {
            return Ok(false);
        }
        job.put(&mut shared.state(), write(&small, Format::Padl));
        Ok(true)
    };
    dispatch(
        shared,
        jobs.len().min(shared.how.threads),
        make,
        &work,
        tell,
    )
}

/// Runs threads until there is no more work, and meanwhile reports and saves.
fn dispatch<E: Examine>(
    shared: Shared<'_>,
    threads: usize,
    make: &(impl Fn() -> E + Sync),
    work: &(impl Fn(&mut E) -> Result<bool, FuzzError> + Sync),
    tell: &mut impl FnMut(&RunState),
) -> Result<(), FuzzError> {
    let before = shared.state().seconds;
    let started = Instant::now();
    let error: Mutex<Option<FuzzError>> = Mutex::new(None);
    let failed = AtomicBool::new(false);
    let busy = AtomicUsize::new(threads);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                let ended = until_done(make(), work, || {
                    failed.load(Ordering::Relaxed) || shared.is_stopped()
                });
                if let (Err(e), Ok(mut error)) = (ended, error.lock()) {
                    error.get_or_insert(e);
                    failed.store(true, Ordering::Relaxed);
                }
                busy.fetch_sub(1, Ordering::Release);
            });
        }
        let mut saver = Saver::default();
        while busy.load(Ordering::Acquire) > 0 {
            std::thread::sleep(TELL);
            shared.state().seconds = before + started.elapsed().as_secs_f64();
            tell(&shared.state());
            if let Some(path) = shared.how.state.filter(|_| saver.is_due()) {
                let copy = shared.state().clone();
                if let (Err(e), Ok(mut error)) = (saver.save(&copy, path), error.lock()) {
                    error.get_or_insert(e);
                    failed.store(true, Ordering::Relaxed);
                }
            }
        }
    });
    let mut state = shared.state();
    state.seconds = before + started.elapsed().as_secs_f64();
    if let Some(path) = shared.how.state {
        state.save(path)?;
    }
    match error.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(error),
        None => Ok(()),
    }
}

fn until_done<E>(
    mut examiner: E,
    work: &impl Fn(&mut E) -> Result<bool, FuzzError>,
    is_over: impl Fn() -> bool,
) -> Result<(), FuzzError> {
    while !is_over() && work(&mut examiner)? {}
    Ok(())
}

/// Saves the state at intervals, which are longer the longer a save takes.
#[derive(Default)]
struct Saver {
    last: Option<Save>,
}

/// A save of the state.
#[derive(Clone, Copy)]
struct Save {
    ended: Instant,
    /// How long it took.
    took: Duration,
}

impl Saver {
    fn is_due(&mut self) -> bool {
        let last = self.last.get_or_insert_with(|| Save {
            ended: Instant::now(),
            took: Duration::ZERO,
        });
        last.ended.elapsed() > SAVE.max(SAVING * last.took)
    }

    fn save(&mut self, state: &RunState, path: &Path) -> Result<(), FuzzError> {
        let started = Instant::now();
        let saved = state.save(path);
        self.last = Some(Save {
            ended: Instant::now(),
            took: started.elapsed(),
        });
        saved
    }
}

/// The kind of a tree's failure.
#[derive(Clone, Debug)]
enum Way {
    Wrong(FailureKind),
    Refused(String),
    /// By another program.
    Against(AgainstFindingKind),
    RefusedAgainst(String),
}

/// A finding to shrink.
#[derive(Clone, Debug)]
struct Job {
    item: Item,
    way: Way,
}

/// The first findings of each kind and profile that are not shrunk yet.
fn jobs(state: &RunState) -> Vec<Job> {
    let mut jobs = Vec::new();
    for (&source, tally) in &state.tallies {
        let mut add = |finds: &Finds, most: usize, way: Way| {
            let first = finds.iter().take(most);
            for (&seed, _) in first.filter(|(_, find)| find.shrunk.is_none()) {
                let (item, way) = (Item { source, seed }, way.clone());
                jobs.push(Job { item, way });
            }
        };
        for (&kind, finds) in &tally.faults {
            add(finds, SHRUNK, Way::Wrong(kind));
        }
        for (reason, finds) in &tally.refusals {
            add(finds, 1, Way::Refused(reason.clone()));
        }
        if let Some(against) = &tally.against {
            for (&kind, finds) in &against.faults {
                add(finds, SHRUNK_AGAINST, Way::Against(kind));
            }
            for (reason, finds) in &against.refusals {
                add(finds, 1, Way::RefusedAgainst(reason.clone()));
            }
        }
    }
    jobs
}

impl Way {
    fn is_that_of(&self, examined: &Examined) -> bool {
        let against = examined.against.as_ref().map(|against| &against.verdict);
        match (self, &examined.outcome.verdict, against) {
            (Self::Wrong(kind), Verdict::Wrong(faults), _) => {
                faults.iter().any(|f| f.kind == *kind)
            }
            (Self::Refused(kind), Verdict::Refused(text), _) => reason(text) == *kind,
            (Self::Against(kind), _, Some(against)) => against.has(*kind),
            (Self::RefusedAgainst(kind), _, Some(against)) => against.is_refusal(kind),
            _ => false,
        }
    }

    /// The most smaller trees that are tried.
    fn tries(&self) -> usize {
        match self {
            Self::Wrong(FailureKind::Time)
            | Self::Against(AgainstFindingKind::Failure(AgainstFailure::Slow)) => TRIES_IN_TIME,
            Self::Wrong(_) | Self::Refused(_) => TRIES,
            Self::Against(_) | Self::RefusedAgainst(_) => TRIES_AGAINST,
        }
    }
}

impl Job {
    /// The smallest tree that fails in the same way.
    fn small(
        &self,
        examiner: &mut impl Examine,
        files: &[FileModel],
    ) -> Result<PartModel, FuzzError> {
        let mut error = None;
        let model = self.item.model(files);
        let origin = ModelOrigin {
            item: self.item,
            is_whole: false,
        };
        let mut fails = |smaller: &PartModel| match examiner.examine(smaller, &origin) {
            Ok(Some(examined)) => self.way.is_that_of(&examined),
            Ok(None) => false,
            Err(e) => {
                error.get_or_insert(e);
                false
            }
        };
        let small = shrink(&model, self.way.tries(), &mut fails);
        error.map_or(Ok(small), |e| Err(FuzzError::Worker(e)))
    }

    fn put(&self, state: &mut RunState, text: String) {
        let Some(tally) = state.tallies.get_mut(&self.item.source) else {
            return;
        };
        let against = tally.against.as_mut();
        let finds = match &self.way {
            Way::Wrong(kind) => tally.faults.get_mut(kind),
            Way::Refused(reason) => tally.refusals.get_mut(reason),
            Way::Against(kind) => against.and_then(|a| a.faults.get_mut(kind)),
            Way::RefusedAgainst(reason) => against.and_then(|a| a.refusals.get_mut(reason)),
        };
        if let Some(find) = finds.and_then(|finds| finds.get_mut(&self.item.seed)) {
            find.shrunk = Some(text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::state::Plan;
    use crate::fuzz::summary::RunSummary;
    use premio_verify::generator::model::{ModelNodeKind, ModelPrimitive};
    use premio_verify::generator::profile::Profile;
    use premio_verify::trial::{TrialConfig, TrialMeasures, TrialOutcome};
    use std::io;

    /// An examiner by which tori are wrong and spheres refused; it stops after some trees.
    struct Planted<'a> {
        left: &'a AtomicUsize,
        stop: &'a AtomicBool,
    }

    impl Examine for Planted<'_> {
        fn examine(&mut self, model: &PartModel, _: &ModelOrigin) -> io::Result<Option<Examined>> {
            let left = self.left.load(Ordering::Relaxed);
            self.left.store(left.saturating_sub(1), Ordering::Relaxed);
            if left == 0 {
                self.stop.store(true, Ordering::Relaxed);
                return Ok(None);
            }
            let has = |is: fn(&ModelPrimitive) -> bool| {
                let leaf = |kind: &ModelNodeKind| matches!(kind, ModelNodeKind::Leaf(p) if is(p));
                model.nodes().iter().any(|node| leaf(&node.kind))
            };
            if has(|p| matches!(p, ModelPrimitive::Torus { .. })) {
                let wrong = TrialOutcome::wrong(FailureKind::Volume, "a torus");
                return Ok(Some(wrong.into()));
            }
            let measures = TrialMeasures {
                volume: 1.0,
                area: 1.0,
                bounds: None,
                solids: 1,
            };
            let verdict = match has(|p| matches!(p, ModelPrimitive::Sphere(_))) {
                true => Verdict::Refused(format!("{} nodes", model.nodes().len())),
                false => Verdict::Right(measures),
            };
            let outcome = TrialOutcome {
                verdict,
                close_calls: 1,
                undetermined: Vec::new(),
                seconds: 0.0,
            };
            Ok(Some(outcome.into()))
        }
    }

    fn plan() -> Plan {
        Plan {
            profiles: vec![Profile::Grid, Profile::Tangent],
            from: 100,
            count: 50,
            terms: TrialConfig::default(),
            limit: 1.0,
            shrink: true,
            write: None,
            files: Vec::new(),
            against: None,
        }
    }

    /// A run that is stopped after a number of trials.
    fn ran(state: RunState, threads: usize, questions: usize, path: Option<&Path>) -> RunState {
        let (stop, left) = (AtomicBool::new(false), AtomicUsize::new(questions));
        let how = RunConfig {
            threads,
            stop: &stop,
            state: path,
            archive: None,
            files: &[],
        };
        let make = || Planted {
            left: &left,
            stop: &stop,
        };
        run(state, &how, make, |_| {}).unwrap()
    }

    /// The part of a state that does not depend on time.
    fn timeless(state: &RunState) -> serde_json::Value {
        let mut timeless = serde_json::to_value(RunSummary::new(state)).unwrap();
        timeless.as_object_mut().unwrap().remove("seconds");
        timeless
    }

    #[test]
    fn the_summary_is_the_same_for_any_number_of_threads() {
        let one = ran(RunState::new(plan()), 1, usize::MAX, None);
        let many = ran(RunState::new(plan()), 7, usize::MAX, None);
        assert_eq!(timeless(&one), timeless(&many));
        let summary = RunSummary::new(&one);
        assert!(summary.complete && summary.wrong > 0 && summary.trees == 100);
    }

    #[test]
    fn failures_are_made_small() {
        let state = ran(RunState::new(plan()), 2, usize::MAX, None);
        for tally in state.tallies.values() {
            let [(_, wrong)] = tally.faults.iter().collect::<Vec<_>>()[..] else {
                panic!("{tally:?}")
            };
            let small = wrong.values().filter_map(|find| find.shrunk.as_deref());
            let small: Vec<&str> = small.collect();
            assert_eq!(small.len(), SHRUNK.min(wrong.len()));
            assert!(small.iter().all(|text| text.starts_with("PART = TOR(")));
            let refused = tally.refusals.values().next().unwrap();
            let text = refused.values().next().unwrap().shrunk.as_deref();
            assert_eq!(text, Some("PART = SPH(R=1)\n"));
        }
    }

    #[test]
    fn a_run_that_is_stopped_goes_on() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.json");
        let whole = ran(RunState::new(plan()), 2, usize::MAX, None);
        let half = ran(RunState::new(plan()), 2, 50, Some(&path));
        assert!(half.done() > 0 && half.done() < 100);
        // Stopped again, while failures are shrunk.
        let read = RunState::load(&path, plan(), &Default::default()).unwrap();
        assert_eq!(timeless(&read), timeless(&half));
        let most = ran(read, 2, 100, Some(&path));
        assert_eq!(most.done(), 100);
        assert_ne!(timeless(&most), timeless(&whole));
        let read = RunState::load(&path, plan(), &Default::default()).unwrap();
        let rest = ran(read, 3, usize::MAX, Some(&path));
        assert_eq!(timeless(&rest), timeless(&whole));
    }
}
