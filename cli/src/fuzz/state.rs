//! The plan and the state of a run, kept in a file, so that it continues where it ended.

use super::FuzzError;
use super::against::tally::AgainstTally;
use super::examine::Examined;
use super::finding::{Find, Finds};
use super::item::{Item, TreeSource};
use crate::diagnostics::CliError;
use crate::session::InputLimits;
use premio_text::Document;
use premio_text::escape::quote;
use premio_verify::generator::profile::Profile;
use premio_verify::trial::{FailureKind, TrialConfig, TrialOutcome, Verdict, reason};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// What to try.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Plan {
    /// The profiles.
    pub profiles: Vec<Profile>,
    /// The first seed.
    pub from: u64,
    /// The number of seeds of each profile.
    pub count: u64,
    /// The configuration of the trial of each tree.
    pub terms: TrialConfig,
    /// The time limit of a tree, in seconds.
    pub limit: f64,
    /// Whether failures are shrunk.
    pub shrink: bool,
    /// The folder and the formats of models.
    pub write: Option<Writing>,
    /// The files, in place of profiles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<PathBuf>,
    /// The other program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub against: Option<AgainstPlan>,
}

/// What determines the results of another program.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct AgainstPlan {
    /// The command.
    pub command: String,
    /// The ending of the models' files.
    pub form: String,
    /// The template of the models.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub template: Option<PathBuf>,
    /// The limit of memory, in MiB.
    pub memory: u64,
    /// The relative tolerance.
    pub tolerance: f64,
}

/// The folder and the formats of models.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Writing {
    /// The folder.
    pub folder: PathBuf,
    /// The endings of the files.
    pub formats: Vec<String>,
}

/// The results of the trees of a profile.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Tally {
    /// The number of right trees.
    pub right: u64,
    /// The number of refused ones.
    pub refused: u64,
    /// The number of wrong ones.
    pub wrong: u64,
    /// The refused ones, by reason.
    pub refusals: BTreeMap<String, Finds>,
    /// The wrong ones, by kind; one tree may be of several.
    pub faults: BTreeMap<FailureKind, Finds>,
    /// Those with an undetermined check.
    #[serde(default)]
    pub undetermined: Finds,
    /// The number of trees with close calls.
    pub close_trees: u64,
    /// The number of close calls.
    pub close_calls: u64,
    /// The lines of the manifest, by seed, where models are written.
    pub lines: BTreeMap<u64, String>,
    /// The duration of all trials, in seconds.
    pub seconds: f64,
    /// The seed of the longest trial, and its seconds.
    pub longest: Option<(u64, f64)>,
    /// Those that took longer than [`SLOW`], by seed, in seconds.
    pub slow: BTreeMap<u64, f64>,
    /// The results of the other program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub against: Option<AgainstTally>,
}

/// The duration, in seconds, above which a trial is listed.
pub const SLOW: f64 = 2.0;

/// The schema of the file.
const SCHEMA: &str = "premio.fuzz.state/1";

/// The state of a run.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct RunState {
    schema: String,
    /// What to try.
    pub plan: Plan,
    /// The finished items, as half-open ranges.
    done: BTreeMap<u64, u64>,
    /// The results by profile, or those of the files.
    pub tallies: BTreeMap<TreeSource, Tally>,
    /// The duration so far, in seconds.
    pub seconds: f64,
}

impl Plan {
    /// The number of trees.
    pub fn trees(&self) -> u64 {
        match self.files.is_empty() {
            true => self.count.saturating_mul(self.profiles.len() as u64),
            false => self.files.len() as u64,
        }
    }

    /// The sources of its trees.
    pub fn sources(&self) -> Vec<TreeSource> {
        match self.files.is_empty() {
            true => self
                .profiles
                .iter()
                .map(|p| TreeSource::Profile(*p))
                .collect(),
            false => vec![TreeSource::Files],
        }
    }

    /// The tree of an index from 0: seed by seed, every profile of each; or file by file.
    pub fn item(&self, number: u64) -> Option<Item> {
        if number < self.files.len() as u64 {
            let source = TreeSource::Files;
            return Some(Item {
                source,
                seed: number,
            });
        }
        let profiles = self.profiles.len() as u64;
        let profile = *self.profiles.get(number.checked_rem(profiles)? as usize)?;
        let seed = self.from.wrapping_add(number / profiles);
        let source = TreeSource::Profile(profile);
        (number < self.trees()).then_some(Item { source, seed })
    }
}

impl Tally {
    /// The number of tried trees.
    pub fn trees(&self) -> u64 {
        self.right + self.refused + self.wrong
    }

    fn record(&mut self, seed: u64, outcome: TrialOutcome, seconds: f64, file: Option<&str>) {
        let find = |text| Find::new(text, file);
        match outcome.verdict {
            Verdict::Right(_) => self.right += 1,
            Verdict::Refused(text) => {
                self.refused += 1;
                let finds = self.refusals.entry(reason(&text)).or_default();
                finds.insert(seed, find(text));
            }
            Verdict::Wrong(faults) => {
                self.wrong += 1;
                for fault in faults {
                    let finds = self.faults.entry(fault.kind).or_default();
                    finds.entry(seed).or_insert_with(|| find(fault.text));
                }
            }
        }
        if !outcome.undetermined.is_empty() {
            self.undetermined
                .insert(seed, find(outcome.undetermined.join("; ")));
        }
        self.close_trees += u64::from(outcome.close_calls > 0);
        self.close_calls += outcome.close_calls as u64;
        self.seconds += seconds;
        if self.longest.is_none_or(|(_, longest)| seconds > longest) {
            self.longest = Some((seed, seconds));
        }
        if seconds > SLOW {
            self.slow.insert(seed, seconds);
        }
    }
}

impl RunState {
    /// A run that has not begun.
    pub fn new(plan: Plan) -> Self {
        let tallies = plan.sources();
        let tallies = tallies.into_iter().map(|s| (s, Tally::default()));
        Self {
            schema: SCHEMA.to_owned(),
            tallies: tallies.collect(),
            plan,
            done: BTreeMap::new(),
            seconds: 0.0,
        }
    }

    /// Loads the run of a file, or starts a new one where there is no file.
    ///
    /// # Errors
    /// The file cannot be read, is longer than the limit, or contains no state of this plan.
    pub fn load(path: &Path, plan: Plan, limits: &InputLimits) -> Result<Self, CliError> {
        if fs::metadata(path).is_err_and(|e| e.kind() == io::ErrorKind::NotFound) {
            return Ok(Self::new(plan));
        }
        let text = limits.read_text(path)?;
        let name = path.display().to_string();
        let refused = |span: Range<usize>, words: String| {
            let words = format!("{words}: expected the state of a run of `premio fuzz`");
            CliError::in_bytes(&name, text.as_bytes(), span, &words)
        };
        // The document's own reader gives duplicate keys and non-finite numbers a place.
        let document = Document::from_json(&text)
            .map_err(|e| refused(e.span.clone().unwrap_or(0..0), e.to_string()))?;
        let state: Self = serde_json::from_str(&text).map_err(|e| {
            let at = byte_of(&text, e.line(), e.column());
            refused(at..at, without_place(&e))
        })?;
        if state.schema != SCHEMA {
            let span = document.span("schema").unwrap_or(0..0);
            let words = format!("found the schema {}, not `{SCHEMA}`", quote(&state.schema));
            return Err(refused(span, words));
        }
        if state.plan != plan {
            return Err(FuzzError::OtherPlan { path: name }.into());
        }
        match state.is_consistent() {
            true => Ok(state),
            false => {
                let span = document.span("done").unwrap_or(0..0);
                let words = "`done` and `tallies` count different numbers of trees".to_owned();
                Err(refused(span, words))
            }
        }
    }

    /// Whether the finished items belong to the plan, and as many trees are counted.
    fn is_consistent(&self) -> bool {
        let mut end = 0;
        for (&from, &to) in &self.done {
            if from < end || to <= from {
                return false;
            }
            end = to;
        }
        let is_counted = |tally: &Tally| match &tally.against {
            Some(against) => against.counts.trees() == Some(tally.trees()),
            None => self.plan.against.is_none() || tally.trees() == 0,
        };
        let counts = self.tallies.values();
        let mut counts = counts.flat_map(|tally| [tally.right, tally.refused, tally.wrong]);
        let counted = counts.try_fold(0u64, u64::checked_add);
        // The first comparison excludes an overflow in the last one.
        end <= self.plan.trees()
            && counted == Some(self.done())
            && self.tallies.values().all(is_counted)
    }

    /// Saves the run: the whole file or none.
    pub fn save(&self, path: &Path) -> Result<(), FuzzError> {
        let text = serde_json::to_string(self).map_err(|e| FuzzError::file(path, e.into()))?;
        premio::files::write_whole(&text, path).map_err(|source| FuzzError::file(path, source))
    }

    /// The number of finished trees.
    pub fn done(&self) -> u64 {
        self.done.iter().map(|(from, to)| to - from).sum()
    }

    /// Whether a tree is finished.
    pub fn is_done(&self, number: u64) -> bool {
        let before = self.done.range(..=number).next_back();
        before.is_some_and(|(_, &to)| number < to)
    }

    /// Records the outcomes of a tree, their duration, and its line of the manifest.
    pub fn record(&mut self, number: u64, examined: Examined, seconds: f64, line: Option<String>) {
        let Some(Item { source, seed }) = self.plan.item(number) else {
            return;
        };
        if self.is_done(number) {
            return;
        }
        let files = &self.plan.files;
        let file = match source {
            TreeSource::Profile(_) => None,
            TreeSource::Files => usize::try_from(seed).ok().and_then(|k| files.get(k)),
        };
        let file = file.map(|path| path.display().to_string());
        let tally = self.tallies.entry(source).or_default();
        tally.record(seed, examined.outcome, seconds, file.as_deref());
        if let Some(outcome) = examined.against {
            let against = tally.against.get_or_insert_default();
            against.record(seed, outcome, file.as_deref());
        }
        tally.lines.extend(line.map(|line| (seed, line)));
        self.mark(number);
    }

    /// Adjacent ranges are merged.
    fn mark(&mut self, number: u64) {
        let to = self.done.remove(&(number + 1)).unwrap_or(number + 1);
        match self.done.range_mut(..number).next_back() {
            Some((_, end)) if *end == number => *end = to,
            _ => {
                self.done.insert(number, to);
            }
        }
    }
}

/// The byte offset of a line and a column, both from 1; columns count bytes.
fn byte_of(text: &str, line: usize, column: usize) -> usize {
    let before = text.split_inclusive('\n').take(line.saturating_sub(1));
    before.map(str::len).sum::<usize>() + column.saturating_sub(1)
}

/// The error without its position, which is reported before it.
fn without_place(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    text.strip_suffix(&place).unwrap_or(&text).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan() -> Plan {
        Plan {
            profiles: vec![Profile::Near, Profile::Grid],
            from: 5,
            count: 10,
            terms: TrialConfig::default(),
            limit: 20.0,
            shrink: false,
            write: None,
            files: Vec::new(),
            against: None,
        }
    }

    fn outcome(number: u64) -> TrialOutcome {
        match number % 3 {
            0 => TrialOutcome::wrong(FailureKind::Volume, "off by 0.1"),
            1 => TrialOutcome {
                verdict: Verdict::Refused(format!("near ({number}, 1, 2)")),
                close_calls: 2,
                undetermined: Vec::new(),
                seconds: 0.0,
            },
            _ => TrialOutcome::wrong(FailureKind::Time, "none"),
        }
    }

    #[test]
    fn items_are_all_profiles_of_each_seed() {
        let item = |n| plan().item(n).map(|i| (i.source, i.seed));
        assert_eq!(item(0), Some((TreeSource::Profile(Profile::Near), 5)));
        assert_eq!(item(1), Some((TreeSource::Profile(Profile::Grid), 5)));
        assert_eq!(item(19), Some((TreeSource::Profile(Profile::Grid), 14)));
        assert_eq!(item(20), None);
    }

    #[test]
    fn any_order_is_the_same_state() {
        let (mut a, mut b) = (RunState::new(plan()), RunState::new(plan()));
        for n in 0..20 {
            a.record(n, outcome(n).into(), 1.0, None);
            b.record(
                (n * 7 + 3) % 20,
                outcome((n * 7 + 3) % 20).into(),
                1.0,
                None,
            );
            assert_eq!((a.done(), b.done()), (n + 1, n + 1));
        }
        // A second record is not another tree.
        b.record(3, outcome(3).into(), 1.0, None);
        for state in [&mut a, &mut b] {
            assert_eq!(state.done, BTreeMap::from([(0, 20)]));
            for tally in state.tallies.values_mut() {
                tally.longest = None;
            }
        }
        assert_eq!(a, b);
        assert!(a.is_done(19) && !a.is_done(20));
    }

    #[test]
    fn a_file_is_read_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.json");
        let mut state = RunState::load(&path, plan(), &InputLimits::default()).unwrap();
        assert_eq!(state, RunState::new(plan()));
        for n in [4, 9, 5, 12] {
            state.record(n, outcome(n).into(), 0.1 + n as f64, Some("{}".to_owned()));
        }
        state.save(&path).unwrap();
        assert_eq!(
            RunState::load(&path, plan(), &InputLimits::default()).unwrap(),
            state
        );
        let other = Plan { from: 6, ..plan() };
        let error = RunState::load(&path, other, &InputLimits::default()).unwrap_err();
        assert!(format!("{error:?}").contains("other arguments"));
        fs::write(&path, "{").unwrap();
        let error = RunState::load(&path, plan(), &InputLimits::default()).unwrap_err();
        assert!(format!("{error:?}").contains("state.json:1:2"));
    }
}
