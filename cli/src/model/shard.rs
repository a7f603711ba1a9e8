//! Shards: the observations of a range of setups, a line each, whole or absent.

use crate::diagnostics::Failure;
use crate::output;
use premio_predict::model::record::Description;
use premio_predict::model::{Observation, Setups};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{BufRead, BufReader, BufWriter, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// The name of the format.
const SCHEMA: &str = "premio.observations/1";

/// The first line of a shard.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Head {
    schema: String,
    /// The part's file.
    pub part: String,
    /// The part's description.
    pub description: Description,
    /// What part and setups are told from others by.
    pub digest: String,
    /// The setups, as they were written.
    pub setups: String,
    /// Which shard, from 1, and of how many.
    pub shard: [usize; 2],
    /// The setups of all shards.
    pub count: usize,
}

impl Head {
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
    pub description: Description,
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

/// A shard that is being written, beside its place.
pub struct Writer {
    out: BufWriter<NamedTempFile>,
    path: PathBuf,
}

impl Writer {
    /// A shard to be.
    pub fn new(path: &Path, head: &Head) -> Result<Self, Failure> {
        let path = output::target(path).map_err(|e| failed(path, &e))?;
        if output::is_no_file(&path) {
            return Err(failed(&path, &"a shard is a file, and this is none"));
        }
        let file = output::temporary(&path).map_err(|e| failed(&path, &e))?;
        let out = BufWriter::new(file);
        let mut writer = Self { out, path };
        writer.line(head)?;
        Ok(writer)
    }

    /// Adds a line.
    pub fn line(&mut self, value: &impl Serialize) -> Result<(), Failure> {
        let text = serde_json::to_string(value).map_err(|e| failed(&self.path, &e))?;
        writeln!(self.out, "{text}").map_err(|e| failed(&self.path, &e))
    }

    /// Puts the shard in its place.
    pub fn finish(self) -> Result<(), Failure> {
        let path = self.path;
        let file = self.out.into_inner().map_err(|e| failed(&path, &e))?;
        file.as_file().sync_all().map_err(|e| failed(&path, &e))?;
        file.persist(&path).map_err(|e| failed(&path, &e))?;
        Ok(())
    }
}

fn failed(path: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::input(format!("{}: {error}", path.display()))
}

/// A shard in a file.
#[derive(Debug)]
pub struct Shard {
    /// Its first line.
    pub head: Head,
    path: PathBuf,
}

impl Shard {
    /// Opens a shard.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let mut text = String::new();
        let mut lines = reader(path)?;
        lines.read_line(&mut text).map_err(|e| failed(path, &e))?;
        let head: Head = serde_json::from_str(&text)
            .map_err(|e| failed(path, &format!("not the first line of a shard: {e}")))?;
        let [index, of] = head.shard;
        if head.schema != SCHEMA || index == 0 || index > of {
            return Err(failed(
                path,
                &format!("not the first line of a shard of {SCHEMA}"),
            ));
        }
        let path = path.to_owned();
        Ok(Self { head, path })
    }

    /// Tells every observation of it, in order.
    pub fn each(&self, mut report: impl FnMut(&Observation)) -> Result<(), Failure> {
        let mut expected = self.head.range();
        let lines = reader(&self.path)?.lines();
        for (number, line) in lines.enumerate().skip(1) {
            let place = |e: &dyn std::fmt::Display| {
                Failure::input(format!("{}:{}: {e}", self.path.display(), number + 1))
            };
            let line = line.map_err(|e| place(&e))?;
            let observation: Observation = serde_json::from_str(&line).map_err(|e| place(&e))?;
            if expected.next() != Some(observation.setup) {
                return Err(place(&format!(
                    "found setup {}, out of turn",
                    observation.setup
                )));
            }
            report(&observation);
        }
        match expected.next() {
            None => Ok(()),
            Some(setup) => Err(failed(&self.path, &format!("setup {setup} is missing"))),
        }
    }
}

fn reader(path: &Path) -> Result<BufReader<File>, Failure> {
    File::open(path)
        .map(BufReader::new)
        .map_err(|e| failed(path, &e))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_the_setups_without_rest() {
        for (count, of) in [(10, 3), (3, 10), (1000, 7), (0, 2)] {
            let head = |index| Head {
                shard: [index, of],
                count,
                ..head()
            };
            let all: Vec<usize> = (1..=of).flat_map(|i| head(i).range()).collect();
            assert_eq!(all, (0..count).collect::<Vec<_>>());
        }
    }

    fn head() -> Head {
        Head {
            schema: SCHEMA.to_owned(),
            description: Description::default(),
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
