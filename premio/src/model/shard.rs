//! Shards: the observations of a range of setups, a line each, whole or absent.

use crate::{Solid, files};
use premio_csg::reader::Format;
use premio_predict::model::consistency::{
    Inconsistency, SourceLimits, check_description, check_observation,
};
use premio_predict::model::file::hexadecimal;
use premio_predict::model::record::DescriptionRecord;
use premio_predict::model::{Observation, Setups};
use premio_text::escape::{self, quote};
use premio_text::{Content, Document, LineColumn, TextError};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader, BufWriter, ErrorKind, Read, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

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
    /// What part and setups are distinguished from others by.
    pub digest: String,
    /// The setups, as they were written.
    pub setups: String,
    /// Which shard, from 1, and of how many.
    pub shard: [usize; 2],
    /// The setups of all shards.
    pub count: usize,
}

impl ShardHead {
    /// The head of a shard: which, from 1, and of how many.
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

    /// Whether it is of the same run as another shard.
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

/// What all shards of a run share.
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
    /// What part and setups are distinguished from others by.
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
    /// The text is none of setups, or no description holds the solid's numbers exactly.
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

/// Fowler, Noll and Vo's hash of some bytes: it tells files apart.
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

/// The last line of a shard.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct End {
    /// How many lines are before it.
    lines: u64,
    /// SHA-256 of all bytes before it.
    sha256: String,
}

/// A shard that is being written, next to its place.
#[derive(Debug)]
pub(crate) struct ShardWriter {
    out: BufWriter<NamedTempFile>,
    path: PathBuf,
    hash: Sha256,
    lines: u64,
}

impl ShardWriter {
    /// A shard to be.
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

    /// Puts the shard in its place.
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

fn failed(path: &Path, error: &dyn fmt::Display) -> ShardError {
    ShardError {
        path: path.to_owned(),
        place: None,
        words: error.to_string(),
        is_too_long: false,
    }
}

fn not_read(path: &Path, error: &io::Error) -> ShardError {
    ShardError {
        is_too_long: error.kind() == ErrorKind::FileTooLarge,
        ..failed(path, error)
    }
}

/// A value as JSON, in one line, without characters that a terminal obeys.
fn json_text(value: &impl Serialize) -> Result<String, serde_json::Error> {
    serde_json::to_string(value).map(escape::json)
}

/// What is wrong with a shard, and where.
///
/// # Examples
///
/// ```
/// use premio::shards::Shard;
///
/// # let folder = tempfile::tempdir().unwrap();
/// # std::env::set_current_dir(&folder).unwrap();
/// std::fs::write("a.shard", "{}\n").unwrap();
/// let error = Shard::open("a.shard".as_ref(), u64::MAX).unwrap_err();
/// assert!(error.to_string().starts_with("a.shard:1:1: "));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShardError {
    path: PathBuf,
    /// The line and the column.
    place: Option<[usize; 2]>,
    words: String,
    is_too_long: bool,
}

impl ShardError {
    /// Whether the file has more bytes than the limit.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::shards::Shard;
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # std::env::set_current_dir(&folder).unwrap();
    /// std::fs::write("a.shard", "{}\n").unwrap();
    /// assert!(Shard::open("a.shard".as_ref(), 1).unwrap_err().is_too_long());
    /// ```
    pub fn is_too_long(&self) -> bool {
        self.is_too_long
    }
}

impl fmt::Display for ShardError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (path, words) = (self.path.display(), &self.words);
        match self.place {
            Some([line, column]) => write!(f, "{path}:{line}:{column}: {words}"),
            None => write!(f, "{path}: {words}"),
        }
    }
}

impl std::error::Error for ShardError {}

/// A file of which no more is read than a limit.
#[derive(Debug)]
struct LimitedFile {
    file: File,
    left: u64,
}

impl Read for LimitedFile {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let read = self.file.read(into)?;
        match self.left.checked_sub(read as u64) {
            Some(left) => self.left = left,
            None => {
                let said = "found more than the limit of bytes";
                return Err(io::Error::new(ErrorKind::FileTooLarge, said));
            }
        }
        Ok(read)
    }
}

/// A shard in a file, which is as it was written.
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
    /// It is none, it is of another schema, it is not as it was written, or it has more bytes than
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
            // Perhaps a line says what is wrong.
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

    /// Hands on every observation of it, in order.
    ///
    /// # Errors
    /// One is missing, is not one, or is of what there is not; or there are more.
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
/// There is none of this name.
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
        if let Err(words) = language(&head.description) {
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
    reader: BufReader<LimitedFile>,
    path: PathBuf,
    /// How many have been read.
    count: usize,
}

impl Lines {
    fn open(path: &Path, max_bytes: u64) -> Result<Self, ShardError> {
        let file = File::open(path).map_err(|e| not_read(path, &e))?;
        let left = max_bytes;
        let reader = BufReader::new(LimitedFile { file, left });
        Ok(Self {
            reader,
            path: path.to_owned(),
            count: 0,
        })
    }

    fn next_line(&mut self) -> Result<Option<String>, ShardError> {
        let mut bytes = Vec::new();
        let read = self.reader.read_until(b'\n', &mut bytes);
        let read = read.map_err(|e| not_read(&self.path, &e))?;
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
    ) -> Result<T, ShardError> {
        parse(line).map_err(|e| self.wrong(e.span.clone().unwrap_or(0..0), line, &e.to_string()))
    }

    /// What is wrong with the line that was read last.
    fn wrong(&self, span: Range<usize>, line: &str, words: &str) -> ShardError {
        let LineColumn { column, .. } = LineColumn::new(line.as_bytes(), span.start);
        ShardError {
            place: Some([self.count.max(1), column]),
            ..failed(&self.path, &words)
        }
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
        ShardWriter::new(&shard, &head()).unwrap().finish().unwrap();
        std::fs::write(&other, "").unwrap();
        let [a, b] = [&shard, &other].map(|path| std::fs::metadata(path).unwrap().permissions());
        assert_eq!(a.mode(), b.mode());
    }

    #[test]
    fn a_folder_is_no_place_for_a_shard() {
        let folder = tempfile::tempdir().unwrap();
        assert!(ShardWriter::new(folder.path(), &head()).is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn digests_tell_where_texts_end() {
        let [a, b] = [["ab", "c"], ["a", "bc"]].map(|texts| digest(texts.map(str::as_bytes)));
        assert_ne!(a, b);
    }
}
