//! Models in files.

use crate::diagnostics::Failure;
use crate::session::Session;
use premio_predict::model::file::{ModelFile, parse};
use std::path::Path;

/// Reads a model.
///
/// # Errors
/// The file is none, is of another schema, says what does not add up, or is not as it was written.
pub fn read(path: &Path, session: Session) -> Result<ModelFile, Failure> {
    let text = session.limits.read_text(path)?;
    let name = path.display().to_string();
    parse(&text).map_err(|error| Failure::at(&name, &text, Some(error.span.clone()), &error))
}
