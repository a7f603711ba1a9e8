//! Models in files.

use crate::diagnostics::CliError;
use crate::input::{self, EvaluatedPart};
use crate::session::Session;
use premio::shards::language;
use premio_predict::model::consistency::SourceLimits;
use premio_predict::model::file::{ModelError, ModelFile, parse};
use std::path::Path;

/// A model with its text, for errors at its lines.
#[derive(Debug)]
pub struct ReadModel {
    /// Its content.
    pub file: ModelFile,
    name: String,
    text: String,
}

impl ReadModel {
    /// Reads a model.
    ///
    /// # Errors
    /// The file is not a model, has another schema, is inconsistent, or was changed after it was written.
    pub fn read(path: &Path, session: Session) -> Result<Self, CliError> {
        let text = session.limits.read_text(path)?;
        let name = path.display().to_string();
        match parse(&text) {
            Ok(file) => Ok(Self { file, name, text }),
            Err(error) => Err(refused(&name, &text, &error)),
        }
    }

    /// The part of its description.
    ///
    /// # Errors
    /// The description is invalid, or the model is of another part.
    pub fn part(&self, session: Session) -> Result<EvaluatedPart, CliError> {
        let written = &self.file.head.description;
        let failed = |error: ModelError| refused(&self.name, &self.text, &error);
        if let Err(words) = language(written) {
            let key = "description.language";
            return Err(failed(self.file.in_head(&self.text, key, &words)));
        }
        let part = input::part_of_model(&self.name, written.clone(), session.voice)?;
        let limits = SourceLimits::of_part(part.solid.brep());
        self.file
            .check_sources(&self.text, &limits)
            .map_err(failed)?;
        Ok(part)
    }
}

fn refused(name: &str, text: &str, error: &ModelError) -> CliError {
    CliError::at(name, text, Some(error.span.clone()), error)
}
