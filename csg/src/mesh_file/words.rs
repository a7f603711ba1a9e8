//! The words of text formats.

use std::str::SplitWhitespace;

use super::{MeshCoordinate, MeshFileError};

pub(super) fn text(bytes: &[u8]) -> Result<&str, MeshFileError> {
    std::str::from_utf8(bytes).map_err(|error| MeshFileError::Text {
        byte: error.valid_up_to(),
    })
}

/// The error at a line that is counted from 0.
pub(super) fn wrong(line: usize, expected: &'static str) -> MeshFileError {
    MeshFileError::Line {
        line: line + 1,
        expected,
    }
}

/// The numbers of the next words of a line.
pub(super) fn numbers<C: MeshCoordinate>(
    words: &mut SplitWhitespace<'_>,
    line: usize,
) -> Result<[C; 3], MeshFileError> {
    let mut next = || {
        let number = words.next().and_then(C::from_decimal);
        number.ok_or_else(|| wrong(line, "a finite number"))
    };
    Ok([next()?, next()?, next()?])
}

/// A face has three corners or more.
pub(super) fn check_face(corners: &[usize], line: usize) -> Result<(), MeshFileError> {
    match corners {
        [_, _, _, ..] => Ok(()),
        _ => Err(wrong(line, "three corners or more")),
    }
}
