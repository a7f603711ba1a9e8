//! The object file format of Geomview, as text. Colours and normals of points and faces are not
//! read.

use super::words::{check_face, numbers, wrong};
use super::{MeshBuilder, MeshCoordinate, MeshFileError};

pub(super) fn read<C: MeshCoordinate>(
    text: &str,
    mesh: &mut MeshBuilder<C>,
) -> Result<(), MeshFileError> {
    let without_comment = |line| -> &str { str::split(line, '#').next().unwrap_or_default() };
    let lines = text.lines().map(without_comment).enumerate();
    let mut lines = lines.filter(|(_, line)| !line.trim().is_empty());
    let (at, header) = lines.next().ok_or_else(|| wrong(0, "`OFF`"))?;
    let counts = header.trim().strip_prefix("OFF");
    let counts = counts.ok_or_else(|| wrong(at, "`OFF`"))?;
    // The counts are on the line of the header or on the next one.
    let (at, counts) = match counts.trim().is_empty() {
        true => lines.next().ok_or_else(|| wrong(at, "the counts"))?,
        false => (at, counts),
    };
    let mut counts = counts.split_whitespace().map(str::parse::<usize>);
    let (Some(Ok(points)), Some(Ok(faces))) = (counts.next(), counts.next()) else {
        return Err(wrong(at, "the numbers of points and faces"));
    };
    for _ in 0..points {
        let (at, line) = lines.next().ok_or_else(|| wrong(at, "as many points"))?;
        mesh.point(numbers(&mut line.split_whitespace(), at)?)?;
    }
    let mut corners = Vec::new();
    for _ in 0..faces {
        let (at, line) = lines.next().ok_or_else(|| wrong(at, "as many faces"))?;
        read_face(line, points, &mut corners)
            .ok_or_else(|| wrong(at, "a number of corners and their points"))?;
        check_face(&corners, at)?;
        mesh.face(&corners)?;
    }
    Ok(())
}

/// Reads the points of a face: their number comes first.
fn read_face(line: &str, known: usize, corners: &mut Vec<usize>) -> Option<()> {
    let mut words = line.split_whitespace();
    let count: usize = words.next()?.parse().ok()?;
    corners.clear();
    for word in words.take(count) {
        let corner = word.parse().ok()?;
        corners.push((0..known).contains(&corner).then_some(corner)?);
    }
    (corners.len() == count).then_some(())
}
