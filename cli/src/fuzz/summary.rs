//! The summary of a run, as JSON (premio.fuzz/1) and as text.
//!
//! Everything except the times is the same for any number of threads: findings are in the order of
//! profiles, kinds and seeds, and the times are separate, at the end.

use super::against::tally::{AgainstCounts, AgainstTally, AgainstTimes};
use super::finding::{Find, Finds};
use super::item::TreeSource;
use super::state::{Plan, RunState, Tally};
use premio_text::escape::terminal;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// The summary.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RunSummary {
    schema: &'static str,
    plan: Plan,
    /// Whether every tree of the plan was tried.
    pub complete: bool,
    /// The number of tried trees.
    pub trees: u64,
    right: u64,
    refused: u64,
    /// The number of wrong ones.
    pub wrong: u64,
    /// The numbers of trees by the verdict on the other program.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against: Option<AgainstCounts>,
    profiles: BTreeMap<TreeSource, Part>,
    seconds: Seconds,
}

/// The results of a profile.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Part {
    trees: u64,
    right: u64,
    refused: u64,
    wrong: u64,
    refusals: Vec<Kind>,
    faults: Vec<Kind>,
    /// The trees with an undetermined check.
    undetermined: Vec<Kind>,
    close_calls: CloseCalls,
    #[serde(skip_serializing_if = "Option::is_none")]
    against: Option<AgainstPart>,
}

/// The results of another program on a profile.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct AgainstPart {
    #[serde(flatten)]
    counts: AgainstCounts,
    refusals: Vec<Kind>,
    faults: Vec<Kind>,
}

/// The findings of one kind.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Kind {
    kind: String,
    count: usize,
    finds: Vec<Seed>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct Seed {
    seed: u64,
    #[serde(flatten)]
    find: Find,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct CloseCalls {
    trees: u64,
    decisions: u64,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct Seconds {
    /// From the beginning to the end.
    total: f64,
    profiles: BTreeMap<TreeSource, Times>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct Times {
    /// The sum of all trials.
    trials: f64,
    longest: Option<Timed>,
    slow: Vec<Timed>,
    /// Of the other program and of ours, on the compared trees.
    #[serde(skip_serializing_if = "Option::is_none")]
    against: Option<AgainstTimes>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct Timed {
    seed: u64,
    seconds: f64,
}

impl RunSummary {
    /// The summary of a run.
    pub fn new(state: &RunState) -> Self {
        let sum = |of: fn(&Tally) -> u64| state.tallies.values().map(of).sum();
        let tallies = || state.tallies.iter();
        let against = tallies().filter_map(|(_, t)| t.against.as_ref());
        let against = against.map(|a| a.counts).reduce(AgainstCounts::plus);
        Self {
            schema: "premio.fuzz/1",
            plan: state.plan.clone(),
            complete: state.done() == state.plan.trees(),
            trees: sum(Tally::trees),
            right: sum(|t| t.right),
            refused: sum(|t| t.refused),
            wrong: sum(|t| t.wrong),
            against,
            profiles: tallies().map(|(p, t)| (*p, Part::new(t))).collect(),
            seconds: Seconds {
                total: state.seconds,
                profiles: tallies().map(|(p, t)| (*p, Times::new(t))).collect(),
            },
        }
    }
}

impl Part {
    fn new(tally: &Tally) -> Self {
        let refusals = tally.refusals.iter().map(|(k, f)| Kind::new(k, f));
        let faults = tally.faults.iter().map(|(k, f)| Kind::new(k.name(), f));
        let undetermined = Some(&tally.undetermined).filter(|finds| !finds.is_empty());
        let undetermined = undetermined
            .into_iter()
            .map(|f| Kind::new("too few samples", f));
        Self {
            trees: tally.trees(),
            right: tally.right,
            refused: tally.refused,
            wrong: tally.wrong,
            refusals: refusals.collect(),
            faults: faults.collect(),
            undetermined: undetermined.collect(),
            close_calls: CloseCalls {
                trees: tally.close_trees,
                decisions: tally.close_calls,
            },
            against: tally.against.as_ref().map(AgainstPart::new),
        }
    }
}

impl AgainstPart {
    fn new(tally: &AgainstTally) -> Self {
        let refusals = tally.refusals.iter().map(|(k, f)| Kind::new(k, f));
        let faults = tally.faults.iter().map(|(k, f)| Kind::new(k.name(), f));
        Self {
            counts: tally.counts,
            refusals: refusals.collect(),
            faults: faults.collect(),
        }
    }
}

impl Kind {
    fn new(kind: &str, finds: &Finds) -> Self {
        let each = finds.iter().map(|(&seed, find)| Seed {
            seed,
            find: find.clone(),
        });
        Self {
            kind: kind.to_owned(),
            count: finds.len(),
            finds: each.collect(),
        }
    }
}

impl Times {
    fn new(tally: &Tally) -> Self {
        let timed = |(seed, seconds)| Timed { seed, seconds };
        Self {
            trials: tally.seconds,
            longest: tally.longest.map(timed),
            slow: tally.slow.iter().map(|(&s, &t)| timed((s, t))).collect(),
            against: tally.against.as_ref().map(|against| against.times),
        }
    }
}

/// The number of findings of a kind that are listed in the text; JSON has all.
const LISTED: usize = 10;

impl fmt::Display for RunSummary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<8} {:>9} {:>9} {:>8} {:>6} {:>12} {:>9}",
            "profile", "trees", "right", "refused", "wrong", "close calls", "seconds"
        )?;
        for (profile, part) in &self.profiles {
            writeln!(
                f,
                "{:<8} {:>9} {:>9} {:>8} {:>6} {:>12} {:>9.1}",
                profile.name(),
                part.trees,
                part.right,
                part.refused,
                part.wrong,
                part.close_calls.decisions,
                self.seconds.profiles.get(profile).map_or(0.0, |t| t.trials),
            )?;
        }
        self.write_against(f)?;
        for (profile, part) in &self.profiles {
            list(f, *profile, "wrong", &part.faults)?;
            list(f, *profile, "refused", &part.refusals)?;
            list(f, *profile, "undetermined", &part.undetermined)?;
            if let Some(against) = &part.against {
                list(f, *profile, "the program", &against.faults)?;
                list(f, *profile, "refused by the program", &against.refusals)?;
            }
        }
        for (profile, times) in &self.seconds.profiles {
            for Timed { seed, seconds } in times.slow.iter().take(LISTED) {
                writeln!(f, "{profile} {seed}: {seconds:.1} s")?;
            }
        }
        let left = match self.complete {
            true => "",
            false => ", not all of the plan",
        };
        let Self {
            trees,
            refused,
            wrong,
            ..
        } = self;
        let total = self.seconds.total;
        writeln!(
            f,
            "{trees} trees in {total:.1} s: {wrong} wrong, {refused} refused{left}"
        )?;
        match self.against {
            Some(AgainstCounts {
                right,
                wrong,
                refused,
                crashed,
                slow,
                memory,
                unread,
                unknown,
            }) => writeln!(
                f,
                "the program: {right} right, {wrong} wrong, {refused} refused, {crashed} crashed, \
                 {slow} slow, {memory} without memory, {unread} unread, {unknown} unknown"
            ),
            None => Ok(()),
        }
    }
}

impl RunSummary {
    /// The table of the other program.
    fn write_against(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rows = self.profiles.iter();
        let rows = rows.filter_map(|(source, part)| Some((source, part.against.as_ref()?)));
        for (k, (source, part)) in rows.enumerate() {
            if k == 0 {
                writeln!(
                    f,
                    "\n{:<8} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9} {:>9}",
                    "program",
                    "right",
                    "wrong",
                    "refused",
                    "crashed",
                    "slow",
                    "memory",
                    "unread",
                    "unknown",
                    "seconds",
                    "ours"
                )?;
            }
            let counts = &part.counts;
            let times = self.seconds.profiles.get(source);
            let times = times.and_then(|times| times.against).unwrap_or_default();
            writeln!(
                f,
                "{:<8} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>7} {:>9.1} {:>9.1}",
                source.name(),
                counts.right,
                counts.wrong,
                counts.refused,
                counts.crashed,
                counts.slow,
                counts.memory,
                counts.unread,
                counts.unknown,
                times.stated,
                times.ours,
            )?;
        }
        Ok(())
    }
}

fn list(
    f: &mut fmt::Formatter<'_>,
    profile: TreeSource,
    what: &str,
    kinds: &[Kind],
) -> fmt::Result {
    for Kind { kind, count, finds } in kinds {
        writeln!(f, "\n{profile}, {what}: {}: {count}", terminal(kind))?;
        for Seed { seed, find } in finds.iter().take(LISTED) {
            match &find.file {
                Some(file) => writeln!(f, "  {}: {}", terminal(file), terminal(&find.text))?,
                None => writeln!(f, "  {profile} {seed}: {}", terminal(&find.text))?,
            }
            for line in find.shrunk.iter().flat_map(|text| text.lines()) {
                writeln!(f, "    {line}")?;
            }
        }
        if *count > LISTED {
            writeln!(f, "  and {} more", count - LISTED)?;
        }
    }
    Ok(())
}
