//! The trees of a run: those of a profile by their seeds, and those of files.

use premio_verify::generator::model::PartModel;
use premio_verify::generator::profile::Profile;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Where trees are from.
#[derive(Clone, Copy, Debug, Deserialize, Eq, Ord, PartialEq, PartialOrd, Serialize)]
#[serde(into = "String", try_from = "String")]
pub enum TreeSource {
    /// A profile.
    Profile(Profile),
    /// The files of the command line.
    Files,
}

/// The name of the files in summaries and states.
const FILES: &str = "files";

impl TreeSource {
    /// The name, as it is written in the summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Profile(profile) => profile.name(),
            Self::Files => FILES,
        }
    }
}

impl fmt::Display for TreeSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl From<TreeSource> for String {
    fn from(source: TreeSource) -> Self {
        source.name().to_owned()
    }
}

impl TryFrom<String> for TreeSource {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        match name.as_str() {
            FILES => Ok(Self::Files),
            name => name.parse().map(Self::Profile),
        }
    }
}

/// A tree of a plan.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub struct Item {
    /// Where it is from.
    pub source: TreeSource,
    /// Its seed; the place of a file on the command line, from 0.
    pub seed: u64,
}

/// The model of a file.
#[derive(Clone, Debug)]
pub struct FileModel {
    /// The model.
    pub model: PartModel,
    /// The distance by which its rounded coordinates move a primitive.
    pub displacement: f64,
}

impl Item {
    /// The tree; that of a file is found among those of the run.
    pub fn model(self, files: &[FileModel]) -> PartModel {
        match self.source {
            TreeSource::Profile(profile) => profile.model(self.seed),
            TreeSource::Files => {
                let file = self.file(files);
                file.map(|file| file.model.clone()).unwrap_or_default()
            }
        }
    }

    /// The file that it is from.
    pub fn file(self, files: &[FileModel]) -> Option<&FileModel> {
        match self.source {
            TreeSource::Profile(_) => None,
            TreeSource::Files => files.get(usize::try_from(self.seed).ok()?),
        }
    }
}
