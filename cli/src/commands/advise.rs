//! `premio advise`: the best directions of camera and light.

use crate::arguments::{AdviseOptions, GoalName};
use crate::diagnostics::{CliError, Reporter};
use crate::interrupt::pool;
use crate::session::Session;
use crate::setup::setups;
use crate::{input, output};
use nalgebra::Vector3;
use premio_kernel::concurrency::on_one_thread;
use premio_predict::image_arcs::ArcSource;
use premio_predict::prediction::Memory;
use premio_predict::sensor_planning::{Goal, Placing, SCHEMA, Score, ScoredPlacing, SetupScorer};
use premio_predict::setup::Setup;
use rayon::prelude::*;
use serde::Serialize;
use std::fmt::Write;

/// An advised setup.
#[derive(Debug, Serialize)]
struct Advised {
    eye: [f64; 3],
    light: Option<[f64; 3]>,
    #[serde(flatten)]
    score: Score,
    /// Its cost relative to the best: how many features fewer, and the factors by which the pose's
    /// standard deviations are greater.
    cost: Cost,
    /// The features that the best setup probably finds, and this one does not.
    lost: Vec<ArcSource>,
}

#[derive(Debug, Serialize)]
struct Cost {
    features: f64,
    pose: Option<[f64; 2]>,
}

/// The advice, as it is written.
#[derive(Debug, Serialize)]
struct Advice {
    schema: &'static str,
    goal: Goal,
    /// The number of setups tried.
    tried: usize,
    /// The number of them in which the part is not visible.
    unseen: usize,
    /// The best one, refined; then the best of the given setups.
    best: Vec<Advised>,
}

/// A refinement starts with steps of this angle, in radians.
const STEP: f64 = 0.1;

/// Runs the command.
pub fn run(options: &AdviseOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    let file = setups(&options.setups, session)?;
    let setups = &file.value;
    let part = input::part(&options.description, session)?;
    let (subject, finishes) = file.subject(&part, &setups.conditions)?;
    file.check_places(&subject, session)?;
    let predicates = SetupScorer {
        subject: &subject,
        finishes: &finishes,
        setups,
        goal: match options.goal {
            GoalName::Features => Goal::Features,
            GoalName::Pose => Goal::Pose,
        },
    };
    let pool = pool()?;
    let keep = usize::from(options.top).max(1);
    let TriedSetups { best: scored, seen } = pool.install(|| scores(&predicates, keep, voice));
    let tried = setups.len();
    let Some(first) = scored.first().cloned() else {
        let name = options.setups.display();
        return Err(CliError::input(format!(
            "{name}: the part is not visible in any of {tried} setups"
        )));
    };
    let working = voice.working("moving the best setup");
    let best = predicates.refined(first, STEP, &mut Memory::default());
    drop(working);
    let mut all = vec![best];
    all.extend(scored.into_iter().take(usize::from(options.top)));
    let advice = Advice {
        schema: SCHEMA,
        goal: predicates.goal,
        tried,
        unseen: tried - seen,
        best: all
            .iter()
            .map(|one| advised(&predicates, one, &all[0].score))
            .collect(),
    };
    let to = options.output.path();
    match voice.is_json() {
        true => output::json(&advice, to),
        false => output::write(words(&advice), to),
    }
}

/// The number of setups that are scored before all but the best are dropped.
const BATCH: usize = 256;

/// The result of a search of all setups.
struct TriedSetups {
    /// The best of them, the best first.
    best: Vec<ScoredPlacing>,
    /// The number of setups in which the part is visible.
    seen: usize,
}

/// Scores all setups.
fn scores(predicates: &SetupScorer<'_>, keep: usize, voice: Reporter) -> TriedSetups {
    let count = predicates.setups.len();
    let bar = voice.progress(count as u64);
    let (mut best, mut seen) = (Vec::new(), 0);
    for from in (0..count).step_by(BATCH) {
        let each = (from..(from + BATCH).min(count)).into_par_iter();
        let scored: Vec<Option<ScoredPlacing>> = each
            .map_init(Memory::default, |memory, i| {
                let [view, light] = predicates.setups.directions(i);
                let view = view.unwrap_or_else(Vector3::x);
                let placing = Placing { view, light };
                let score = on_one_thread(|| predicates.score(&placing, memory));
                bar.inc(1);
                score.ok().map(|score| ScoredPlacing { placing, score })
            })
            .collect();
        let before = best.len();
        best.extend(scored.into_iter().flatten());
        seen += best.len() - before;
        // The sort is stable: of equals the first setup is the better one.
        best.sort_by(|a, b| {
            let value = |one: &ScoredPlacing| predicates.value(&one.score);
            value(b).total_cmp(&value(a))
        });
        best.truncate(keep);
    }
    bar.finish_and_clear();
    TriedSetups { best, seen }
}

fn advised(
    predicates: &SetupScorer<'_>,
    ScoredPlacing { placing, score }: &ScoredPlacing,
    best: &Score,
) -> Advised {
    let Setup { camera, lights, .. } =
        predicates
            .setups
            .looking(placing.view, placing.light, 0, predicates.subject);
    let likely = |chance: &f64| *chance >= 0.5;
    let lost = best.chances.iter().filter(|(source, chance)| {
        likely(chance) && !score.chances.get(source).is_some_and(likely)
    });
    Advised {
        eye: camera.eye.unwrap_or_default(),
        light: placing.light.and_then(|_| lights.last()?.position),
        cost: Cost {
            features: best.expected - score.expected,
            pose: score
                .pose
                .zip(best.pose)
                .map(|(p, q)| [p[0] / q[0], p[1] / q[1]]),
        },
        lost: lost.map(|(source, _)| *source).collect(),
        score: score.clone(),
    }
}

fn words(advice: &Advice) -> String {
    let mut text = format!(
        "{} setups tried, {} without the part\n\
         rank  camera                    light                     expected  of  pose: turn, move     costs\n",
        advice.tried, advice.unseen
    );
    let point = |p: &Option<[f64; 3]>| match p {
        Some([x, y, z]) => format!("({x:.4}, {y:.4}, {z:.4})"),
        None => "as given".to_owned(),
    };
    for (rank, one) in advice.best.iter().enumerate() {
        let pose = one
            .score
            .pose
            .map_or("undetermined".to_owned(), |[turn, by]| {
                format!("{:.4}°, {by:.3e}", turn.to_degrees())
            });
        let times = one
            .cost
            .pose
            .map_or("pose undetermined".to_owned(), |[turn, by]| {
                format!("pose x {turn:.2}, {by:.2}")
            });
        let cost = match rank {
            0 => "nothing: the best, refined".to_owned(),
            _ => format!("{:.1} features, {times}", one.cost.features),
        };
        let _ = writeln!(
            text,
            "{rank:4}  {:24}  {:24}  {:8.2}  {:2}  {pose:20} {cost}",
            point(&Some(one.eye)),
            point(&one.light),
            one.score.expected,
            one.score.visible
        );
    }
    text
}
