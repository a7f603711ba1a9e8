//! The examination of a tree, by ourselves and perhaps by another program.

use super::against::tally::AgainstOutcome;
use super::item::Item;
use premio_verify::generator::model::PartModel;
use premio_verify::trial::TrialOutcome;
use std::io;

/// The tree of a run that a model is, or that it was shrunk from.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct ModelOrigin {
    /// The tree of the run.
    pub item: Item,
    /// Whether the model is the whole tree.
    pub is_whole: bool,
}

/// The outcomes of a tree.
#[derive(Clone, Debug, PartialEq)]
pub struct Examined {
    /// Of our own trial.
    pub outcome: TrialOutcome,
    /// Of another program.
    pub against: Option<AgainstOutcome>,
}

impl From<TrialOutcome> for Examined {
    fn from(outcome: TrialOutcome) -> Self {
        Self {
            outcome,
            against: None,
        }
    }
}

/// An examiner of trees.
pub trait Examine {
    /// The outcomes of a tree; none where the run shall stop.
    fn examine(&mut self, model: &PartModel, origin: &ModelOrigin) -> io::Result<Option<Examined>>;
}
