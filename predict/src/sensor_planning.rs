//! Sensor planning: the best directions of camera and light. The setups of spheres are scored, and
//! the best of them are moved as long as their score improves.

use crate::feature::detected_arc::DetectionState;
use crate::image::shading::Finishes;
use crate::image_arcs::ArcSource;
use crate::image_arcs::lit_scene::StageError;
use crate::model::information::{deviation, information};
use crate::prediction::{Memory, PredictedImage, with_draft};
use crate::prepared_part::PreparedPart;
use crate::setup::setups::Setups;
use nalgebra::{Matrix6, Vector3};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The name of the format.
pub const SCHEMA: &str = "premio.advice/1";

/// The goal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Goal {
    /// The greatest expected number of found features.
    #[default]
    Features,
    /// The least standard deviation of the pose.
    Pose,
}

/// Directions of a camera and a light from the part's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    /// Of the camera.
    pub view: Vector3<f64>,
    /// Of the moving light, if there is one.
    pub light: Option<Vector3<f64>>,
}

/// The score of a setup.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// The expected number of features that are found, whole or in part.
    pub expected: f64,
    /// The number of visible features.
    pub visible: usize,
    /// The standard deviations of the pose: rotation in radians, translation in the part's unit.
    pub pose: Option<[f64; 2]>,
    /// By feature: the probability that it is found.
    #[serde(skip)]
    pub chances: BTreeMap<ArcSource, f64>,
}

impl Score {
    /// Its value for a goal: greater is better.
    pub(crate) fn value(&self, goal: Goal, radius: f64) -> f64 {
        match goal {
            Goal::Features => self.expected,
            // The standard deviation of a point at the part's radius.
            Goal::Pose => self
                .pose
                .map_or(f64::NEG_INFINITY, |[turn, by]| -turn.mul_add(radius, by)),
        }
    }
}

/// A setup with its score.
#[derive(Clone, Debug)]
pub struct ScoredPlacing {
    /// The setup.
    pub placing: Placing,
    /// Its score.
    pub score: Score,
}

/// The scorer of a part's setups.
#[derive(Clone, Copy, Debug)]
pub struct SetupScorer<'s> {
    /// The part.
    pub subject: &'s PreparedPart<'s>,
    /// The materials of its faces.
    pub finishes: &'s Finishes,
    /// The setups.
    pub setups: &'s Setups,
    /// The goal.
    pub goal: Goal,
}

impl SetupScorer<'_> {
    /// The score of a setup.
    ///
    /// # Errors
    /// The setup cannot be used, the camera or a light has no view of the part, or the image does
    /// not show it.
    pub fn score(&self, placing: &Placing, memory: &mut Memory) -> Result<Score, StageError> {
        // One seed for all: no setup is better than another by its noise.
        let setup = self
            .setups
            .looking(placing.view, placing.light, 0, self.subject);
        with_draft(self.subject, Some(self.finishes), &setup, memory, scored)
    }

    /// The value of a score for the goal.
    pub fn value(&self, score: &Score) -> f64 {
        score.value(self.goal, self.subject.radius)
    }

    /// Moves the setup as long as its score improves, by steps from an angle (radians) down to a
    /// sixteenth of it.
    pub fn refined(&self, from: ScoredPlacing, angle: f64, memory: &mut Memory) -> ScoredPlacing {
        let mut best = from;
        let mut step = angle;
        while step > angle / 16.0 {
            let better = neighbours(&best.placing, step)
                .into_iter()
                .find_map(|placing| {
                    let score = self.score(&placing, memory).ok()?;
                    let is_better = self.value(&score) > self.value(&best.score);
                    is_better.then_some(ScoredPlacing { placing, score })
                });
            match better {
                Some(found) => best = found,
                None => step *= 0.5,
            }
        }
        best
    }
}

fn scored(draft: &PredictedImage<'_>) -> Score {
    let outcome = draft.outcome();
    let mut chances: BTreeMap<ArcSource, f64> = BTreeMap::new();
    for (i, arc) in draft.arcs.iter().enumerate() {
        let [start, end] = draft.ink.spans[i];
        if arc.smooth || end - start < draft.conditions.detector.shortest {
            continue;
        }
        let counts = outcome.counts[i];
        let total: u32 = counts.iter().sum();
        let found =
            1.0 - f64::from(counts[DetectionState::Missed.index()]) / f64::from(total.max(1));
        let known = chances.entry(arc.source).or_default();
        *known = known.max(found);
    }
    let all: Matrix6<f64> = information(draft, &outcome.evidence).iter().sum();
    Score {
        expected: chances.values().sum(),
        visible: chances.len(),
        pose: deviation(&all),
        chances,
    }
}

/// The neighbours of a setup: the camera, or the light, moved by a step in four directions.
fn neighbours(placing: &Placing, step: f64) -> Vec<Placing> {
    let moved = |d: &Vector3<f64>| {
        let across = d.cross(&Vector3::ith(d.abs().imin(), 1.0)).normalize();
        let other = d.cross(&across);
        [across, -across, other, -other].map(|a| (d + a * step.tan()).normalize())
    };
    let views = moved(&placing.view).map(|view| Placing { view, ..*placing });
    let lights = placing.light.iter().flat_map(moved);
    let lights = lights.map(|light| Placing {
        light: Some(light),
        ..*placing
    });
    views.into_iter().chain(lights).collect()
}
