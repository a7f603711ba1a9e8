//! STL, binary or text. The normals of triangles are not read: they follow from the corners.

use super::words::{numbers, text, wrong};
use super::{MeshBuilder, MeshCoordinate, MeshFileError};

/// The lengths in bytes of a binary STL's header, count, triangle and number.
const HEADER: usize = 80;
const COUNT: usize = 4;
const TRIANGLE: usize = 50;
const NUMBER: usize = 4;

pub(super) fn read<C: MeshCoordinate>(
    bytes: &[u8],
    mesh: &mut MeshBuilder<C>,
) -> Result<(), MeshFileError> {
    match is_binary(bytes) {
        true => binary(bytes, mesh),
        false => read_text(text(bytes)?, mesh),
    }
}

fn count_of_triangles(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER..HEADER + COUNT)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(count)).ok()
}

/// The length decides: some programs begin a binary file with `solid`.
fn is_binary(bytes: &[u8]) -> bool {
    let length = count_of_triangles(bytes).and_then(|n| n.checked_mul(TRIANGLE));
    length.is_some_and(|length| bytes.len().checked_sub(HEADER + COUNT) == Some(length))
}

fn binary<C: MeshCoordinate>(bytes: &[u8], mesh: &mut MeshBuilder<C>) -> Result<(), MeshFileError> {
    mesh.mesh.is_single_precision = true;
    let (triangles, _) = bytes[HEADER + COUNT..].as_chunks::<TRIANGLE>();
    for (k, triangle) in triangles.iter().enumerate() {
        let (values, _) = triangle.as_chunks::<NUMBER>();
        // The normal comes first.
        let mut values = values[3..].iter().map(|bytes| f32::from_le_bytes(*bytes));
        let mut next = || {
            let value = values.next().and_then(C::from_single);
            value.ok_or(MeshFileError::Triangle { number: k + 1 })
        };
        let mut corners = [0; 3];
        for corner in &mut corners {
            *corner = mesh.distinct_point([next()?, next()?, next()?])?;
        }
        mesh.face(&corners)?;
    }
    Ok(())
}

fn read_text<C: MeshCoordinate>(
    text: &str,
    mesh: &mut MeshBuilder<C>,
) -> Result<(), MeshFileError> {
    if !text.trim_start().starts_with("solid") {
        return Err(wrong(0, "`solid`, or a binary file of the stated length"));
    }
    let mut corners: Vec<usize> = Vec::new();
    let mut is_complete = false;
    for (line, words) in text.lines().enumerate() {
        let mut words = words.split_whitespace();
        match words.next() {
            Some("vertex") => corners.push(mesh.distinct_point(numbers(&mut words, line)?)?),
            Some("endloop") => {
                if corners.len() != 3 {
                    return Err(wrong(line, "three corners before it"));
                }
                mesh.face(&corners)?;
                corners.clear();
            }
            Some(word) => is_complete = word == "endsolid",
            None => {}
        }
    }
    match is_complete && corners.is_empty() {
        true => Ok(()),
        false => Err(wrong(text.lines().count(), "`endsolid`")),
    }
}
