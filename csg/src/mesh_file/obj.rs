//! Wavefront OBJ: points and faces. Groups, normals, textures, curves and other files are not read.

use super::words::{check_face, numbers, wrong};
use super::{MeshBuilder, MeshCoordinate, MeshFileError};

pub(super) fn read<C: MeshCoordinate>(
    text: &str,
    mesh: &mut MeshBuilder<C>,
) -> Result<(), MeshFileError> {
    let mut corners = Vec::new();
    let mut known = 0;
    for (line, words) in text.lines().enumerate() {
        let mut words = words.split_whitespace();
        match words.next() {
            Some("v") => known = mesh.point(numbers(&mut words, line)?)? + 1,
            Some("f") => {
                corners.clear();
                for word in words {
                    let corner = index(word, known);
                    let expected = "the numbers of points before it";
                    corners.push(corner.ok_or_else(|| wrong(line, expected))?);
                }
                check_face(&corners, line)?;
                mesh.face(&corners)?;
            }
            _ => {}
        }
    }
    Ok(())
}

/// The index of a corner: numbers are from 1, or negative from the last.
fn index(word: &str, known: usize) -> Option<usize> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let index = match number.is_positive() {
        true => usize::try_from(number).ok()?.checked_sub(1),
        false => known.checked_sub(usize::try_from(number.checked_neg()?).ok()?),
    };
    index.filter(|index| (0..known).contains(index))
}
