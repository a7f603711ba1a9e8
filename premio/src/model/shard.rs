//! Shards: the observations of a range of setups, a line each, whole or absent.

mod error;
mod lines;
mod writer;

use crate::{Solid, files};
pub use error::ShardError;
use error::failed;
use lines::Lines;
use premio_csg::reader::Format;
use premio_predict::model::Observation;
use premio_predict::model::consistency::{
    Inconsistency, SourceLimits, check_description, check_observation,
};
use premio_predict::model::file::hexadecimal;
use premio_predict::model::record::DescriptionRecord;
use premio_predict::setup::setups::Setups;
use premio_text::escape::quote;
use premio_text::{Content, Document, TextError};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::ops::Range;
use std::path::{Path, PathBuf};
use writer::End;
pub(crate) use writer::ShardWriter;

/// The name of the format.
const SCHEMA: &str = "premio.observations/2";

/// The first line of a shard.
///
/// # Examples
///
/// ```
/// use premio::shards::{ShardHead, ShardRun};
///
/// let solid = premio::block(6, 4, 2).evaluate()?;
/// let text = "[viewing]\ncount = 10\nradius = 25\n[[light]]\nposition = [4, -16, 30]\n";
/// let run = ShardRun::new(&solid, text)?;
/// let head = ShardHead::new(&run, [2, 5]);
/// assert_eq!((head.count, head.range()), (10, 2..4));
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShardHead {
    schema: String,
    /// The part's file.
    pub part: String,
    /// The part's description.
    pub description: DescriptionRecord,
    /// The digest of part and setups.
    pub digest: String,
    /// The setups, as they were written.
    pub setups: String,
    /// The index of the shard, from 1, and the number of shards.
    pub shard: [usize; 2],
    /// The setups of all shards.
    pub count: usize,
}

impl ShardHead {
    /// The head of a shard, from its index, from 1, and the number of shards.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::shards::{ShardHead, ShardRun};
    ///
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// let text = "[viewing]\ncount = 10\nradius = 25\n[[light]]\nposition = [4, -16, 30]\n";
    /// let run = ShardRun::new(&solid, text)?;
    /// assert_eq!(ShardHead::new(&run, [1, 3]).setups, text);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn new(run: &ShardRun, shard: [usize; 2]) -> Self {
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

    /// Whether it belongs to the same run as another shard.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::shards::{ShardHead, ShardRun};
    ///
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// let text = "[viewing]\ncount = 10\nradius = 25\n[[light]]\nposition = [4, -16, 30]\n";
    /// let run = ShardRun::new(&solid, text)?;
    /// let head = |k| ShardHead::new(&run, [k, 3]);
    /// assert!(head(1).is_of_run(&head(2)));
    /// assert!(!head(1).is_of_run(&ShardHead::new(&run, [1, 4])));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn is_of_run(&self, other: &Self) -> bool {
        let run = |head: &Self| Self {
            shard: [1, head.shard[1]],
            ..head.clone()
        };
        run(self) == run(other)
    }

    /// The setups of the shard.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::shards::{ShardHead, ShardRun};
    ///
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// let text = "[viewing]\ncount = 10\nradius = 25\n[[light]]\nposition = [4, -16, 30]\n";
    /// let run = ShardRun::new(&solid, text)?;
    /// assert_eq!(ShardHead::new(&run, [3, 3]).range(), 6..10);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn range(&self) -> Range<usize> {
        let [index, of] = self.shard;
        let at = |k: usize| (self.count as u128 * k as u128 / of as u128) as usize;
        at(index - 1)..at(index)
    }
}

/// The common data of all shards of a run.
///
/// # Examples
///
/// ```
/// use premio::shards::ShardRun;
///
/// let solid = premio::block(6, 4, 2).evaluate()?;
/// let text = "[viewing]\ncount = 10\nradius = 25\n[[light]]\nposition = [4, -16, 30]\n";
/// let run = ShardRun::new(&solid, text)?;
/// assert_eq!(run.setups.len(), 10);
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Debug)]
pub struct ShardRun {
    /// The part's file.
    pub part: String,
    /// The part's description.
    pub description: DescriptionRecord,
    /// The digest of part and setups.
    pub digest: String,
    /// The setups, as they were written.
    pub text: String,
    /// The setups.
    pub setups: Setups,
}

impl ShardRun {
    /// A run of a solid in the setups of a TOML text.
    ///
    /// # Errors
    /// The text is not valid setups, or no description can express the solid's numbers exactly.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::shards::ShardRun;
    ///
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// let text = "[viewing]\ncount = 10\nradius = 25\n[[light]]\nposition = [4, -16, 30]\n";
    /// let run = ShardRun::new(&solid, text)?;
    /// assert_eq!(run.description.language, "padl");
    /// assert!(ShardRun::new(&solid, "").is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn new(solid: &Solid, setups: &str) -> crate::Result<Self> {
        let description = solid.record().ok_or(crate::Error::NoDescription)?;
        let resolution = solid.resolution().to_bits().to_le_bytes();
        Ok(Self {
            part: solid.expression().name(),
            digest: digest([description.text.as_bytes(), &resolution, setups.as_bytes()]),
            description,
            text: setups.to_owned(),
            setups: Setups::from_toml(setups)?,
        })
    }
}

/// The hash of some bytes by Fowler, Noll and Vo, which distinguishes files.
///
/// # Examples
///
/// ```
/// use premio::shards::digest;
///
/// let one = digest([b"ab".as_slice(), b"c"]);
/// assert_ne!(one, digest([b"a".as_slice(), b"bc"]));
/// assert_eq!(one.len(), 16);
/// ```
pub fn digest<'b>(all: impl IntoIterator<Item = &'b [u8]>) -> String {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    for bytes in all {
        for &byte in bytes.iter().chain(&(bytes.len() as u64).to_le_bytes()) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }
    format!("{hash:016x}")
}

/// A verified shard in a file.
///
/// # Examples
///
/// ```
/// use premio::shards::Shard;
///
/// assert!(Shard::open("no such.shard".as_ref(), u64::MAX).is_err());
/// ```
#[derive(Debug)]
pub struct Shard {
    /// Its first line.
    pub head: ShardHead,
    path: PathBuf,
    max_bytes: u64,
}

impl Shard {
    /// Opens a shard.
    ///
    /// # Errors
    /// It is no shard, has another schema, was changed after it was written, or has more bytes than
    /// `max_bytes`.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::Progress;
    /// use premio::shards::{Finishes, PreparedPart, SetupObserver, Shard, ShardRun};
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # let path = folder.path().join("1-of-5.shard");
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// let text = "[viewing]\ncount = 10\nradius = 25\n[[light]]\nposition = [4, -16, 30]\n";
    /// let run = ShardRun::new(&solid, text)?;
    /// let part = PreparedPart::new(solid.brep(), solid.resolution()).unwrap();
    /// let finishes = Finishes::new(&part, &run.setups.conditions)?;
    /// let observer = SetupObserver { part: &part, finishes: &finishes, setups: &run.setups };
    /// observer.write_shard(&path, &run, [1, 5], &Progress::new())?;
    /// let shard = Shard::open(&path, u64::MAX)?;
    /// assert_eq!(shard.head.count, 10);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn open(path: &Path, max_bytes: u64) -> Result<Self, ShardError> {
        if files::is_no_file(path) {
            let said = "a shard is read twice: found a folder, a pipe or a device, expected a file";
            return Err(failed(path, &said));
        }
        let mut lines = Lines::open(path, max_bytes)?;
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
            max_bytes,
        };
        if !is_whole || !last.ends_with('\n') {
            // A line may contain the error.
            shard.each(&SourceLimits::NONE, |_| ())?;
            end?;
            let said =
                "the lines before are not those that this digest is of: make the shard again";
            return Err(lines.wrong(0..0, &last, said));
        }
        Ok(shard)
    }

    /// The file.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::Progress;
    /// use premio::shards::{Finishes, PreparedPart, SetupObserver, Shard, ShardRun};
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # let path = folder.path().join("1-of-5.shard");
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// let text = "[viewing]\ncount = 10\nradius = 25\n[[light]]\nposition = [4, -16, 30]\n";
    /// let run = ShardRun::new(&solid, text)?;
    /// let part = PreparedPart::new(solid.brep(), solid.resolution()).unwrap();
    /// let finishes = Finishes::new(&part, &run.setups.conditions)?;
    /// let observer = SetupObserver { part: &part, finishes: &finishes, setups: &run.setups };
    /// observer.write_shard(&path, &run, [1, 5], &Progress::new())?;
    /// let shard = Shard::open(&path, u64::MAX)?;
    /// assert_eq!(shard.path(), path);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Passes on every observation of it, in order.
    ///
    /// # Errors
    /// An observation is missing, invalid or inconsistent; or there are too many.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::Progress;
    /// use premio::shards::{Finishes, PreparedPart, SetupObserver, Shard, ShardRun, SourceLimits};
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # let path = folder.path().join("1-of-5.shard");
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// let text = "[viewing]\ncount = 10\nradius = 25\n[[light]]\nposition = [4, -16, 30]\n";
    /// let run = ShardRun::new(&solid, text)?;
    /// let part = PreparedPart::new(solid.brep(), solid.resolution()).unwrap();
    /// let finishes = Finishes::new(&part, &run.setups.conditions)?;
    /// let observer = SetupObserver { part: &part, finishes: &finishes, setups: &run.setups };
    /// observer.write_shard(&path, &run, [1, 5], &Progress::new())?;
    /// let shard = Shard::open(&path, u64::MAX)?;
    /// let mut setups = Vec::new();
    /// shard.each(&SourceLimits::of_part(solid.brep()).with_setups(&run.setups), |seen| setups.push(seen.setup))?;
    /// assert_eq!(setups, [0, 1]);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn each(
        &self,
        limits: &SourceLimits,
        mut report: impl FnMut(&Observation),
    ) -> Result<(), ShardError> {
        let mut lines = Lines::open(&self.path, self.max_bytes)?;
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

/// The language of a description in a model.
///
/// # Errors
/// There is no language of this name.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
/// use premio::shards::{DescriptionRecord, language};
///
/// let record = DescriptionRecord { language: "csg".to_owned(), ..DescriptionRecord::default() };
/// assert_eq!(language(&record), Ok(Format::Csg));
/// assert!(language(&DescriptionRecord::default()).is_err());
/// ```
pub fn language(written: &DescriptionRecord) -> Result<Format, String> {
    let language = &written.language;
    let format = Format::ALL.into_iter().find(|f| f.ending() == language);
    format.ok_or_else(|| {
        let all: Vec<&str> = Format::ALL.iter().map(|f| f.ending()).collect();
        format!("is {}, expected one of {}", quote(language), all.join(", "))
    })
}

/// The observation of a line.
fn observation(
    lines: &Lines,
    line: &str,
    setup: usize,
    limits: &SourceLimits,
) -> Result<Observation, ShardError> {
    // Positions are only needed for errors.
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

/// The error of an inconsistent value of a line.
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
        if let Err(words) = language(&head.description) {
            let key = "description.language";
            return refused(key, format!("`{key}` {words}"));
        }
        check_description(&head.description).map_err(|error| inconsistent(line, &error))?;
        Ok(head)
    }
}

#[cfg(test)]
mod tests;
