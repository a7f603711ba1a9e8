//! Zip archives whose parts are read up to a limit.

use std::io::{Cursor, Read};

use zip::ZipArchive;
use zip::read::ZipFile;
use zip::result::ZipError;

use super::MeshFileError;

/// The longest part: a few hundred bytes deflate to one, so that the archive's own length bounds
/// nothing.
const MAX_PART_LENGTH: u64 = 1 << 28;

/// A zip archive.
pub(super) struct ZipPackage<'b>(ZipArchive<Cursor<&'b [u8]>>);

impl<'b> ZipPackage<'b> {
    /// Whether a file begins as an archive does.
    pub fn is_package(bytes: &[u8]) -> bool {
        bytes.starts_with(b"PK\x03\x04")
    }

    pub fn open(bytes: &'b [u8]) -> Result<Self, MeshFileError> {
        let archive = ZipArchive::new(Cursor::new(bytes));
        Ok(Self(archive.map_err(|_| MeshFileError::Archive)?))
    }

    /// The only part whose name is accepted, or the only part.
    pub fn only_part(
        &mut self,
        accepts: impl Fn(&str) -> bool,
    ) -> Result<Option<Vec<u8>>, MeshFileError> {
        let names = self.0.file_names().filter(|name| accepts(name));
        let names: Vec<String> = names.map(str::to_owned).collect();
        match (&names[..], self.0.len()) {
            ([name], _) => self.part(name),
            (_, 1) => unpacked(self.0.by_index(0)),
            _ => Ok(None),
        }
    }

    /// The bytes of a part; `None` if there is none of this name.
    pub fn part(&mut self, name: &str) -> Result<Option<Vec<u8>>, MeshFileError> {
        unpacked(self.0.by_name(name))
    }
}

fn unpacked<R: Read>(
    part: Result<ZipFile<'_, R>, ZipError>,
) -> Result<Option<Vec<u8>>, MeshFileError> {
    let part = match part {
        Err(ZipError::FileNotFound) => return Ok(None),
        part => part.map_err(|_| MeshFileError::Archive)?,
    };
    let mut bytes = Vec::new();
    let read = part.take(MAX_PART_LENGTH + 1).read_to_end(&mut bytes);
    match read.map_err(|_| MeshFileError::Archive)? as u64 > MAX_PART_LENGTH {
        true => Err(MeshFileError::LongPart {
            limit: MAX_PART_LENGTH,
        }),
        false => Ok(Some(bytes)),
    }
}
