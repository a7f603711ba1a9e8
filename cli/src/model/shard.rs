//! Shards: the observations of a range of setups, a line each, whole or absent.

use crate::diagnostics::CliError;
use crate::session::{Limited, Session};
use crate::{input, output};
use premio_predict::model::consistency::{
    Inconsistency, SourceLimits, check_description, check_observation,
};
use premio_predict::model::file::hexadecimal;
use premio_predict::model::record::DescriptionRecord;
use premio_predict::model::{Observation, Setups};
use premio_text::escape::quote;
use premio_text::{Content, Document, LineColumn, TextError};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::io::{BufRead, BufReader, BufWriter, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// The name of the format.
const SCHEMA: &str = "premio.observations/2";

/// The first line of a shard.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShardHead {
    schema: String,
    /// The part's file.
    pub part: String,
    /// The part's description.
    pub description: DescriptionRecord,
    /// What part and setups are told from others by.
    pub digest: String,
    /// The setups, as they were written.
    pub setups: String,
    /// Which shard, from 1, and of how many.
    pub shard: [usize; 2],
    /// The setups of all shards.
    pub count: usize,
}

impl ShardHead {
    /// The head of a shard.
    pub fn new(run: &Run, shard: [usize; 2]) -> Self {
        Self {
            schema: SCHEMA.to_owned(),
            part: run.part.clone(),
            description: run.description.clone(),
            digest: run.digest.clone(),
            setups: run.text.clone(),
            shard,
            count: run.setups.len(),
        }
    }

    /// Whether it is of the same run as another shard.
    pub fn is_of_run(&self, other: &Self) -> bool {
        let run = |head: &Self| Self {
            shard: [1, head.shard[1]],
            ..head.clone()
        };
        run(self) == run(other)
    }

    /// The setups of the shard.
    pub fn range(&self) -> Range<usize> {
        let [index, of] = self.shard;
        let at = |k: usize| (self.count as u128 * k as u128 / of as u128) as usize;
        at(index - 1)..at(index)
    }
}

/// What all shards of a run share.
#[derive(Debug)]
pub struct Run {
    /// The part's file.
    pub part: String,
    /// The part's description.
    pub description: DescriptionRecord,
    /// What part and setups are told from others by.
    pub digest: String,
    /// The setups, as they were written.
    pub text: String,
    /// The setups.
    pub setups: Setups,
}

/// Fowler, Noll and Vo's hash of some bytes: what files are told from one another by.
pub fn digest<'b>(all: impl IntoIterator<Item = &'b [u8]>) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    for bytes in all {
        for &byte in bytes.iter().chain(&(bytes.len() as u64).to_le_bytes()) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    format!("{hash:016x}")
}

/// The last line of a shard.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct End {
    /// How many lines are before it.
    lines: u64,
    /// SHA-256 of all bytes before it.
    sha256: String,
}

/// A shard that is being written, beside its place.
pub struct Writer {
    out: BufWriter<NamedTempFile>,
    path: PathBuf,
    hash: Sha256,
    lines: u64,
}

impl Writer {
    /// A shard to be.
    pub fn new(path: &Path, head: &ShardHead) -> Result<Self, CliError> {
        let path = output::target(path).map_err(|e| failed(path, &e))?;
        if output::is_no_file(&path) {
            return Err(failed(&path, &"a shard is a file, and this is none"));
        }
        let file = output::temporary(&path).map_err(|e| failed(&path, &e))?;
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
    pub fn line(&mut self, value: &impl Serialize) -> Result<(), CliError> {
        let text = output::json_text(value)? + "\n";
        self.hash.update(&text);
        self.lines += 1;
        let written = self.out.write_all(text.as_bytes());
        written.map_err(|e| failed(&self.path, &e))
    }

    /// Puts the shard in its place.
    pub fn finish(mut self) -> Result<(), CliError> {
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

fn failed(path: &Path, error: &dyn std::fmt::Display) -> CliError {
    CliError::input(format!("{}: {error}", path.display()))
}

/// A shard in a file, which is as it was written.
#[derive(Debug)]
pub struct Shard {
    /// Its first line.
    pub head: ShardHead,
    path: PathBuf,
    session: Session,
}

impl Shard {
    /// Opens a shard.
    ///
    /// # Errors
    /// It is none, it is of another schema, or it is not as it was written.
    pub fn open(path: &Path, session: Session) -> Result<Self, CliError> {
        if output::is_no_file(path) {
            let said = "a shard is read twice: found a folder, a pipe or a device, expected a file";
            return Err(failed(path, &said));
        }
        let mut lines = Lines::open(path, session)?;
        let first = lines.next_line()?.unwrap_or_default();
        let head = lines.parsed(&first, ShardHead::from_json)?;
        let mut hash = Sha256::new();
        hash.update(&first);
        let (mut before, mut last) = (1, String::new());
        while let Some(line) = lines.next_line()? {
            if !last.is_empty() {
                hash.update(&last);
                before += 1;
            }
            last = line;
        }
        let end = lines.parsed(&last, End::from_json);
        let digest = hexadecimal(&hash.finalize());
        let is_whole = end
            .as_ref()
            .is_ok_and(|end| end.lines == before && end.sha256 == digest);
        let shard = Self {
            head,
            path: path.to_owned(),
            session,
        };
        if !is_whole || !last.ends_with('\n') {
            // Perhaps a line says what is wrong.
            shard.each(&SourceLimits::NONE, |_| ())?;
            end?;
            let said =
                "the lines before are not those that this digest is of: make the shard again";
            return Err(lines.wrong(0..0, &last, said));
        }
        Ok(shard)
    }

    /// Its file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Hands on every observation of it, in order.
    ///
    /// # Errors
    /// One is missing, is not one, or is of what there is not; or there are more.
    pub fn each(
        &self,
        limits: &SourceLimits,
        mut report: impl FnMut(&Observation),
    ) -> Result<(), CliError> {
        let mut lines = Lines::open(&self.path, self.session)?;
        lines.next_line()?;
        for setup in self.head.range() {
            let line = lines.next_line()?;
            let Some(line) = line.filter(|line| End::from_json(line).is_err()) else {
                let said = format!("found the end of the shard, expected setup {setup}");
                return Err(lines.wrong(0..0, "", &said));
            };
            report(&observation(&lines, &line, setup, limits)?);
        }
        let line = lines.next_line()?.unwrap_or_default();
        lines.parsed(&line, End::from_json)?;
        match lines.next_line()? {
            None => Ok(()),
            Some(line) => Err(lines.wrong(0..0, &line, "found a line after the end of the shard")),
        }
    }
}

/// The observation of a line.
fn observation(
    lines: &Lines,
    line: &str,
    setup: usize,
    limits: &SourceLimits,
) -> Result<Observation, CliError> {
    // What is right needs no places.
    let observation = match serde_json::from_str::<Observation>(line) {
        Ok(observation) => observation,
        Err(_) => lines.parsed(line, |line| Document::from_json(line)?.read())?,
    };
    if observation.setup != setup {
        let found = observation.setup;
        let said = format!("found setup {found}, expected setup {setup}");
        return Err(lines.wrong(0..0, line, &said));
    }
    match check_observation(&observation, limits) {
        Ok(()) => Ok(observation),
        Err(error) => lines.parsed(line, |line| Err(inconsistent(line, &error))),
    }
}

/// A value of a line that does not fit to the rest.
fn inconsistent(line: &str, error: &Inconsistency) -> TextError {
    let document = Document::from_json(line);
    let span = document.ok().and_then(|document| document.span(&error.key));
    TextError::at(span.unwrap_or(0..0), error.to_string())
}

impl ShardHead {
    fn from_json(line: &str) -> Result<Self, TextError> {
        let document = Document::from_json(line)?;
        let refused = |key: &str, words: String| {
            let span = document.span(key).unwrap_or(0..0);
            Err(TextError::at(span, words))
        };
        match document.root.get("schema").map(|value| &value.content) {
            Some(Content::Text(schema)) if schema == SCHEMA => (),
            Some(Content::Text(schema)) => {
                let words = format!("found the schema {}, expected `{SCHEMA}`", quote(schema));
                return refused("schema", words);
            }
            _ => {
                let words = format!("found no schema, expected a shard's first line, `{SCHEMA}`");
                return refused("schema", words);
            }
        }
        let head: Self = document.read()?;
        let [index, of] = head.shard;
        if index == 0 || index > of {
            let words = format!("found shard {index}/{of}, expected one of them");
            return refused("shard", words);
        }
        if let Err(words) = input::language(&head.description) {
            let key = "description.language";
            return refused(key, format!("`{key}` {words}"));
        }
        check_description(&head.description).map_err(|error| inconsistent(line, &error))?;
        Ok(head)
    }
}

impl End {
    fn from_json(line: &str) -> Result<Self, TextError> {
        Document::from_json(line)?.read()
    }
}

/// The lines of a file.
struct Lines {
    reader: BufReader<Limited>,
    path: PathBuf,
    /// How many have been read.
    count: usize,
}

impl Lines {
    fn open(path: &Path, session: Session) -> Result<Self, CliError> {
        let reader = BufReader::new(session.limits.open(path)?);
        Ok(Self {
            reader,
            path: path.to_owned(),
            count: 0,
        })
    }

    fn next_line(&mut self) -> Result<Option<String>, CliError> {
        let mut bytes = Vec::new();
        let read = self.reader.read_until(b'\n', &mut bytes);
        let read = read.map_err(|e| failed(&self.path, &e))?;
        self.count += usize::from(read > 0);
        let text = String::from_utf8(bytes).map_err(|e| {
            let at = e.utf8_error().valid_up_to();
            let byte = e.as_bytes().get(at).copied().unwrap_or_default();
            let said = format!("found the byte {byte:#04x}, expected a text in UTF-8");
            self.wrong(at..at + 1, &String::from_utf8_lossy(e.as_bytes()), &said)
        })?;
        Ok((read > 0).then_some(text))
    }

    fn parsed<T>(
        &self,
        line: &str,
        parse: impl Fn(&str) -> Result<T, TextError>,
    ) -> Result<T, CliError> {
        parse(line).map_err(|e| self.wrong(e.span.clone().unwrap_or(0..0), line, &e.to_string()))
    }

    /// What is wrong with the line that was read last.
    fn wrong(&self, span: Range<usize>, line: &str, words: &str) -> CliError {
        let LineColumn { column, .. } = LineColumn::new(line.as_bytes(), span.start);
        let (path, number) = (self.path.display(), self.count.max(1));
        CliError::input(format!("{path}:{number}:{column}: {words}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_the_setups_without_rest() {
        for (count, of) in [(10, 3), (3, 10), (1000, 7), (0, 2)] {
            let head = |index| ShardHead {
                shard: [index, of],
                count,
                ..head()
            };
            let all: Vec<usize> = (1..=of).flat_map(|i| head(i).range()).collect();
            assert_eq!(all, (0..count).collect::<Vec<_>>());
        }
    }

    fn head() -> ShardHead {
        ShardHead {
            schema: SCHEMA.to_owned(),
            description: DescriptionRecord::default(),
            part: String::new(),
            digest: String::new(),
            setups: String::new(),
            shard: [1, 1],
            count: 0,
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_shard_is_as_readable_as_any_other_file() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let [shard, other] = ["a.shard", "other"].map(|name| folder.path().join(name));
        Writer::new(&shard, &head()).unwrap().finish().unwrap();
        std::fs::write(&other, "").unwrap();
        let [a, b] = [&shard, &other].map(|path| std::fs::metadata(path).unwrap().permissions());
        assert_eq!(a.mode(), b.mode());
    }

    #[test]
    fn a_folder_is_no_place_for_a_shard() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Writer::new(folder.path(), &head()).is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn digests_tell_where_texts_end() {
        let [a, b] = [["ab", "c"], ["a", "bc"]].map(|texts| digest(texts.map(str::as_bytes)));
        assert_ne!(a, b);
    }
}
