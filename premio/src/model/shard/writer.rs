//! Writing a shard: whole, or not at all.

use super::ShardHead;
use super::error::{ShardError, failed};
use crate::files;
use premio_predict::model::file::hexadecimal;
use premio_text::escape;
use premio_text::{Document, TextError};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// The last line of a shard.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct End {
    /// The number of lines before it.
    pub(super) lines: u64,
    /// SHA-256 of all bytes before it.
    pub(super) sha256: String,
}

/// A shard being written to a temporary file next to the target.
#[derive(Debug)]
pub(crate) struct ShardWriter {
    out: BufWriter<NamedTempFile>,
    path: PathBuf,
    hash: Sha256,
    lines: u64,
}

impl ShardWriter {
    /// Starts a shard.
    pub(crate) fn new(path: &Path, head: &ShardHead) -> Result<Self, ShardError> {
        let path = files::target(path).map_err(|e| failed(path, &e))?;
        if files::is_no_file(&path) {
            return Err(failed(&path, &"a shard is a file, and this is none"));
        }
        let file = files::temporary(&path).map_err(|e| failed(&path, &e))?;
        let out = BufWriter::new(file);
        let mut writer = Self {
            out,
            path,
            hash: Sha256::new(),
            lines: 0,
        };
        writer.line(head)?;
        Ok(writer)
    }

    /// Adds a line.
    pub(crate) fn line(&mut self, value: &impl Serialize) -> Result<(), ShardError> {
        let text = json_text(value).map_err(|e| failed(&self.path, &e))? + "\n";
        self.hash.update(&text);
        self.lines += 1;
        let written = self.out.write_all(text.as_bytes());
        written.map_err(|e| failed(&self.path, &e))
    }

    /// Renames the shard to its target.
    pub(crate) fn finish(mut self) -> Result<(), ShardError> {
        let end = End {
            lines: self.lines,
            sha256: hexadecimal(&self.hash.clone().finalize()),
        };
        self.line(&end)?;
        let path = self.path;
        let file = self.out.into_inner().map_err(|e| failed(&path, &e))?;
        file.as_file().sync_all().map_err(|e| failed(&path, &e))?;
        file.persist(&path).map_err(|e| failed(&path, &e))?;
        Ok(())
    }
}

impl End {
    pub(super) fn from_json(line: &str) -> Result<Self, TextError> {
        Document::from_json(line)?.read()
    }
}

/// A value as JSON, in one line, without characters that a terminal obeys.
fn json_text(value: &impl Serialize) -> Result<String, serde_json::Error> {
    serde_json::to_string(value).map(escape::json)
}
