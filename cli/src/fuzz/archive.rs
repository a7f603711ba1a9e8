//! The models written to a folder, with a manifest of their true measures.

use super::FuzzError;
use super::item::Item;
use super::state::RunState;
use premio_verify::generator::model::PartModel;
use premio_verify::generator::write::{Format, description, format, read, write};
use premio_verify::trial::{TrialMeasures, TrialOutcome, Verdict};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// A folder for models.
#[derive(Clone, Debug)]
pub struct Archive {
    folder: PathBuf,
    formats: Vec<Format>,
}

/// The name of the manifest in the folder: one line of JSON per model.
pub const MANIFEST: &str = "manifest.jsonl";

/// A line of the manifest.
#[derive(Debug, Serialize)]
struct Line<'a> {
    profile: &'static str,
    seed: u64,
    /// `right`, with measures; `refused` or `wrong`.
    verdict: &'static str,
    measures: Option<&'a TrialMeasures>,
    files: Vec<Written>,
}

/// A file.
#[derive(Debug, Serialize)]
struct Written {
    file: String,
    /// Whether it is read as exactly the model's tree; a csg has its rotations in matrices.
    same_tree: bool,
}

impl Archive {
    /// Makes the folder, if it does not exist.
    pub fn new(folder: &Path, formats: &[Format]) -> Result<Self, FuzzError> {
        std::fs::create_dir_all(folder).map_err(|e| FuzzError::file(folder, e))?;
        Ok(Self {
            folder: folder.to_owned(),
            formats: formats.to_vec(),
        })
    }

    /// Writes a model in every format; returns its line of the manifest.
    pub fn put(
        &self,
        item: Item,
        model: &PartModel,
        outcome: &TrialOutcome,
    ) -> Result<String, FuzzError> {
        let exact = description(model).map(|d| d.tree).ok();
        let mut files = Vec::new();
        let mut formats: Vec<Format> = self.formats.iter().map(|&f| format(model, f)).collect();
        formats.dedup();
        for format in formats {
            let file = format!("{}-{}.{}", item.source, item.seed, format.ending());
            let path = self.folder.join(&file);
            let text = write(model, format);
            premio::files::write_whole(&text, &path).map_err(|e| FuzzError::file(&path, e))?;
            let same_tree = read(&text, format).map(|d| d.tree).ok() == exact;
            files.push(Written { file, same_tree });
        }
        let (verdict, measures) = match &outcome.verdict {
            Verdict::Right(measures) => ("right", Some(measures)),
            Verdict::Refused(_) => ("refused", None),
            Verdict::Wrong(_) => ("wrong", None),
        };
        let line = Line {
            profile: item.source.name(),
            seed: item.seed,
            verdict,
            measures,
            files,
        };
        serde_json::to_string(&line).map_err(|e| FuzzError::file(&self.folder, e.into()))
    }

    /// Writes the manifest of all finished models.
    pub fn finish(&self, state: &RunState) -> Result<(), FuzzError> {
        let path = self.folder.join(MANIFEST);
        let mut text = String::new();
        for line in state.tallies.values().flat_map(|t| t.lines.values()) {
            text += line;
            text.push('\n');
        }
        premio::files::write_whole(&text, &path).map_err(|e| FuzzError::file(&path, e))
    }
}
