//! The bytes of a model, in the requested format.

use crate::arguments::{ModelOutput, RecordsFormat};
use crate::diagnostics::CliError;
use crate::output;
use premio_predict::model::file::hexadecimal;
use premio_predict::model::record::Record;
use sha2::{Digest, Sha256};
use std::path::Path;

/// The requested format, by its name or by the file's ending; refused before anything is predicted,
/// where the program cannot write it.
pub fn requested(output: &ModelOutput) -> Result<RecordsFormat, CliError> {
    let ending = output.output.as_deref().and_then(Path::extension);
    let by_ending = match ending.is_some_and(|e| e.eq_ignore_ascii_case("parquet")) {
        true => RecordsFormat::Parquet,
        false => RecordsFormat::Jsonl,
    };
    let format = output.format.unwrap_or(by_ending);
    match format == RecordsFormat::Parquet && !cfg!(feature = "parquet") {
        true => Err(without()),
        false => Ok(format),
    }
}

fn without() -> CliError {
    CliError::input(
        "this program is built without Parquet: build it with \
         `cargo build --release -p premio-cli --features parquet`, or ask for `--format jsonl`",
    )
}

/// The bytes of a model, which contain its digest.
pub fn bytes(records: Vec<Record>, format: RecordsFormat) -> Result<Vec<u8>, CliError> {
    let records = sealed(records)?;
    match format {
        RecordsFormat::Jsonl => lines(&records),
        #[cfg(feature = "parquet")]
        RecordsFormat::Parquet => {
            super::parquet::bytes(&records).map_err(|e| CliError::input(e.to_string()))
        }
        #[cfg(not(feature = "parquet"))]
        RecordsFormat::Parquet => Err(without()),
    }
}

/// The records with the digest of their lines in the head.
fn sealed(mut records: Vec<Record>) -> Result<Vec<Record>, CliError> {
    let digest = hexadecimal(&Sha256::digest(lines(&records)?));
    for record in &mut records {
        if let Record::Model(head) = record {
            head.sha256.clone_from(&digest);
        }
    }
    Ok(records)
}

fn lines(records: &[Record]) -> Result<Vec<u8>, CliError> {
    let mut text = Vec::new();
    for record in records {
        text.extend(output::json_text(record)?.into_bytes());
        text.push(b'\n');
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(format: Option<RecordsFormat>, path: &str) -> Option<RecordsFormat> {
        let output = Some(path.into());
        requested(&ModelOutput { output, format }).ok()
    }

    #[test]
    fn the_ending_tells_the_format_where_nothing_else_does() {
        use RecordsFormat::{Jsonl, Parquet};
        let table = cfg!(feature = "parquet").then_some(Parquet);
        assert_eq!(of(None, "part.model"), Some(Jsonl));
        assert_eq!(of(None, "part.parquet"), table);
        assert_eq!(of(Some(Parquet), "part.model"), table);
        assert_eq!(of(Some(Jsonl), "part.parquet"), Some(Jsonl));
    }

    #[cfg(not(feature = "parquet"))]
    #[test]
    fn what_is_not_built_in_says_how_to_build_it() {
        let format = Some(RecordsFormat::Parquet);
        let output = None;
        let refused = requested(&ModelOutput { output, format }).unwrap_err();
        assert!(format!("{refused:?}").contains("--features parquet"));
    }
}
