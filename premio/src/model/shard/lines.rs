//! The lines of a shard's file, read up to a limit.

use super::error::{ShardError, failed, not_read};
use premio_text::{LineColumn, TextError};
use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A file that is read up to a limit.
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

/// The lines of a file.
pub(super) struct Lines {
    reader: BufReader<LimitedFile>,
    pub(super) path: PathBuf,
    /// The number of lines read.
    pub(super) count: usize,
}

impl Lines {
    pub(super) fn open(path: &Path, max_bytes: u64) -> Result<Self, ShardError> {
        let file = File::open(path).map_err(|e| not_read(path, &e))?;
        let left = max_bytes;
        let reader = BufReader::new(LimitedFile { file, left });
        Ok(Self {
            reader,
            path: path.to_owned(),
            count: 0,
        })
    }

    pub(super) fn next_line(&mut self) -> Result<Option<String>, ShardError> {
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

    pub(super) fn parsed<T>(
        &self,
        line: &str,
        parse: impl Fn(&str) -> Result<T, TextError>,
    ) -> Result<T, ShardError> {
        parse(line).map_err(|e| self.wrong(e.span.clone().unwrap_or(0..0), line, &e.to_string()))
    }

    /// An error of the line that was read last.
    pub(super) fn wrong(&self, span: Range<usize>, line: &str, words: &str) -> ShardError {
        let LineColumn { column, .. } = LineColumn::new(line.as_bytes(), span.start);
        ShardError {
            place: Some([self.count.max(1), column]),
            ..failed(&self.path, &words)
        }
    }
}
