//! Triangles of files of other programs: STL, binary or text, OFF and OBJ.

use std::collections::HashMap;
use std::fmt;
use std::str::SplitWhitespace;

/// A format of meshes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum MeshFormat {
    /// STL, binary or text.
    Stl,
    /// The object file format of Geomview.
    Off,
    /// Wavefront OBJ.
    Obj,
}

impl MeshFormat {
    /// Every format.
    pub const ALL: [Self; 3] = [Self::Stl, Self::Off, Self::Obj];

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Stl => "stl",
            Self::Off => "off",
            Self::Obj => "obj",
        }
    }
}

/// Why a mesh has no measures.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshReadError {
    /// The file is no text.
    #[error("byte {byte}: expected a text in UTF-8")]
    Text {
        /// The offset of the first other byte.
        byte: usize,
    },
    /// A line has another form.
    #[error("line {line}: expected {expected}")]
    Line {
        /// The line, from 1.
        line: usize,
        /// What was expected.
        expected: &'static str,
    },
    /// A triangle of a binary file has a coordinate that is not finite.
    #[error("triangle {number}: expected finite numbers")]
    Triangle {
        /// The triangle, from 1.
        number: usize,
    },
    /// There are too many triangles.
    #[error("found {count} triangles, expected at most {MAX_TRIANGLES}")]
    TooMany {
        /// Their number.
        count: usize,
    },
    /// A side has not as many triangles in one sense as in the other.
    #[error("the mesh is not closed, or not oriented, at ({:.6}, {:.6}, {:.6})", .place[0], .place[1], .place[2])]
    Open {
        /// An end of such a side.
        place: [f64; 3],
    },
}

/// The largest number of triangles: their sides have to fit into memory.
pub(super) const MAX_TRIANGLES: usize = 1 << 23;

/// The triangles of a file.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct ReadMesh {
    pub points: Vec<[f64; 3]>,
    pub triangles: Vec<[usize; 3]>,
    /// Whether the coordinates were rounded to single precision.
    pub is_single_precision: bool,
}

impl fmt::Display for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.ending())
    }
}

/// Reads a file.
pub(super) fn read(bytes: &[u8], format: MeshFormat) -> Result<ReadMesh, MeshReadError> {
    match format {
        MeshFormat::Stl if is_binary_stl(bytes) => binary_stl(bytes),
        MeshFormat::Stl => text_stl(text(bytes)?),
        MeshFormat::Off => off(text(bytes)?),
        MeshFormat::Obj => obj(text(bytes)?),
    }
}

fn text(bytes: &[u8]) -> Result<&str, MeshReadError> {
    std::str::from_utf8(bytes).map_err(|error| MeshReadError::Text {
        byte: error.valid_up_to(),
    })
}

fn wrong(line: usize, expected: &'static str) -> MeshReadError {
    MeshReadError::Line {
        line: line + 1,
        expected,
    }
}

/// Points with equal coordinates are one point.
#[derive(Default)]
struct PointTable {
    mesh: ReadMesh,
    known: HashMap<[u64; 3], usize>,
}

impl PointTable {
    fn corner(&mut self, point: [f64; 3]) -> usize {
        // A negative zero is the same coordinate.
        let point = point.map(|x| x + 0.0);
        let points = &mut self.mesh.points;
        *self
            .known
            .entry(point.map(f64::to_bits))
            .or_insert_with(|| {
                points.push(point);
                points.len() - 1
            })
    }

    /// A triangle with two corners at one point has no area, and is left out.
    fn triangle(&mut self, corners: [[f64; 3]; 3]) {
        let [a, b, c] = corners.map(|point| self.corner(point));
        if a != b && b != c && c != a {
            self.mesh.triangles.push([a, b, c]);
        }
    }
}

/// The lengths in bytes of a binary STL's header, count, triangle and number.
const HEADER: usize = 80;
const COUNT: usize = 4;
const TRIANGLE: usize = 50;
const NUMBER: usize = 4;

fn count_of_stl(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER..HEADER + COUNT)?.try_into().ok()?;
    usize::try_from(u32::from_le_bytes(count)).ok()
}

/// The length decides: some programs begin a binary file with `solid`.
fn is_binary_stl(bytes: &[u8]) -> bool {
    let length = count_of_stl(bytes).and_then(|n| n.checked_mul(TRIANGLE));
    length.is_some_and(|length| bytes.len().checked_sub(HEADER + COUNT) == Some(length))
}

fn binary_stl(bytes: &[u8]) -> Result<ReadMesh, MeshReadError> {
    let mut table = PointTable::default();
    let (triangles, _) = bytes[HEADER + COUNT..].as_chunks::<TRIANGLE>();
    for (k, triangle) in triangles.iter().enumerate() {
        let (numbers, _) = triangle.as_chunks::<NUMBER>();
        let mut corners = [[0.0; 3]; 3];
        // The normal comes first.
        for (x, bytes) in corners.iter_mut().flatten().zip(&numbers[3..]) {
            *x = f64::from(f32::from_le_bytes(*bytes));
        }
        if !corners.iter().flatten().all(|x| x.is_finite()) {
            return Err(MeshReadError::Triangle { number: k + 1 });
        }
        table.triangle(corners);
    }
    table.mesh.is_single_precision = true;
    Ok(table.mesh)
}

/// The numbers of the next words of a line; these are finite.
fn numbers<const N: usize>(
    words: &mut SplitWhitespace<'_>,
    line: usize,
) -> Result<[f64; N], MeshReadError> {
    let mut numbers = [0.0; N];
    for x in &mut numbers {
        let word = words.next().and_then(|word| word.parse::<f64>().ok());
        let finite = word.filter(|x| x.is_finite());
        *x = finite.ok_or_else(|| wrong(line, "a finite number"))?;
    }
    Ok(numbers)
}

fn text_stl(text: &str) -> Result<ReadMesh, MeshReadError> {
    if !text.trim_start().starts_with("solid") {
        return Err(wrong(0, "`solid`, or a binary file of the stated length"));
    }
    let mut table = PointTable::default();
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut is_complete = false;
    for (line, words) in text.lines().enumerate() {
        let mut words = words.split_whitespace();
        match words.next() {
            Some("vertex") => corners.push(numbers(&mut words, line)?),
            Some("endloop") => {
                let triangle = corners.as_slice().try_into();
                table.triangle(triangle.map_err(|_| wrong(line, "three corners before it"))?);
                corners.clear();
            }
            Some(word) => is_complete = word == "endsolid",
            None => {}
        }
    }
    match is_complete && corners.is_empty() {
        true => Ok(table.mesh),
        false => Err(wrong(text.lines().count(), "`endsolid`")),
    }
}

/// The triangles of a polygon, all from its first corner.
fn fan(mesh: &mut ReadMesh, corners: &[usize], line: usize) -> Result<(), MeshReadError> {
    let [first, rest @ ..] = corners else {
        return Err(wrong(line, "three corners or more"));
    };
    if rest.len() < 2 {
        return Err(wrong(line, "three corners or more"));
    }
    for pair in rest.windows(2) {
        let triangle = [*first, pair[0], pair[1]];
        if triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0] {
            mesh.triangles.push(triangle);
        }
    }
    Ok(())
}

fn off(text: &str) -> Result<ReadMesh, MeshReadError> {
    let without_comment =
        |line: &'_ str| -> String { line.split('#').next().unwrap_or_default().to_owned() };
    let lines = text.lines().map(without_comment).enumerate();
    let mut lines = lines.filter(|(_, line)| !line.trim().is_empty());
    let (at, header) = lines.next().ok_or_else(|| wrong(0, "`OFF`"))?;
    let counts = header.trim().strip_prefix("OFF");
    let counts = counts.ok_or_else(|| wrong(at, "`OFF`"))?.to_owned();
    // The counts are on the line of the header or on the next one.
    let (at, counts) = match counts.trim().is_empty() {
        true => lines.next().ok_or_else(|| wrong(at, "the counts"))?,
        false => (at, counts),
    };
    let [points, faces] = numbers::<2>(&mut counts.split_whitespace(), at)?;
    let mut mesh = ReadMesh::default();
    let mut left = points;
    while left >= 1.0 {
        let (at, line) = lines.next().ok_or_else(|| wrong(at, "as many points"))?;
        mesh.points.push(numbers(&mut line.split_whitespace(), at)?);
        left -= 1.0;
    }
    let mut left = faces;
    while left >= 1.0 {
        let (at, line) = lines.next().ok_or_else(|| wrong(at, "as many faces"))?;
        let mut words = line.split_whitespace();
        let expected = "a number of corners and their points";
        let count: usize = words
            .next()
            .and_then(|word| word.parse().ok())
            .ok_or_else(|| wrong(at, expected))?;
        let corners: Result<Vec<usize>, _> = words.take(count).map(str::parse).collect();
        let corners = corners.map_err(|_| wrong(at, expected))?;
        let is_known = |corner: &usize| *corner < mesh.points.len();
        if corners.len() != count || !corners.iter().all(is_known) {
            return Err(wrong(at, expected));
        }
        fan(&mut mesh, &corners, at)?;
        left -= 1.0;
    }
    Ok(mesh)
}

fn obj(text: &str) -> Result<ReadMesh, MeshReadError> {
    let mut mesh = ReadMesh::default();
    for (line, words) in text.lines().enumerate() {
        let mut words = words.split_whitespace();
        match words.next() {
            Some("v") => mesh.points.push(numbers(&mut words, line)?),
            Some("f") => {
                let known = mesh.points.len();
                let corners: Option<Vec<usize>> = words.map(|w| index(w, known)).collect();
                let expected = "the numbers of points before it";
                fan(
                    &mut mesh,
                    &corners.ok_or_else(|| wrong(line, expected))?,
                    line,
                )?;
            }
            _ => {}
        }
    }
    Ok(mesh)
}

/// The index of a corner of an OBJ file: numbers are from 1, or negative from the last.
fn index(word: &str, known: usize) -> Option<usize> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let index = match number > 0 {
        true => usize::try_from(number).ok()?.checked_sub(1),
        false => known.checked_sub(usize::try_from(number.checked_neg()?).ok()?),
    };
    index.filter(|index| *index < known)
}
