//! Height fields: OpenSCAD's `surface` of a table of numbers or of a picture.
//!
//! The first row of a table lies along x at y = 0, the next ones at y = 1, 2 and so on. The last row
//! of a picture lies at y = 0, so that the picture is upright as seen from above. Each cell is four
//! triangles about its centre, whose height is the mean of its corners. Walls and a base close the
//! solid. Facts are those of OpenSCAD 2021.01.

mod picture;
mod table;

use premio_kernel::number::rational::Rational;

use crate::polyhedron::{MAX_CORNERS, Polyhedron, PolyhedronError, PolyhedronFace, SpacePoint};

/// The corners of the faces of a cell: those of four triangles, and of its part of the base.
const CELL_CORNERS: usize = 16;

/// The largest number of heights.
const MAX_HEIGHTS: usize = MAX_CORNERS / CELL_CORNERS;

/// Why a file is no height field.
#[derive(Clone, Debug, Eq, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub(crate) enum HeightFieldError {
    /// A table is no text.
    #[error("byte {byte}: expected a text in UTF-8")]
    Text {
        /// The offset of the first other byte.
        byte: usize,
    },
    /// A word of a table is no number.
    #[error("line {line}: expected numbers")]
    Number {
        /// The line, from 1.
        line: usize,
    },
    /// There are too many heights.
    #[error("{columns} x {rows} heights; the limit is {MAX_HEIGHTS}")]
    TooManyHeights {
        /// The number of columns.
        columns: usize,
        /// The number of rows.
        rows: usize,
    },
    /// A picture is damaged, or has a kind of pixels that is not read.
    #[error("expected a PNG picture that is not damaged")]
    Picture,
}

/// Heights over a grid of unit squares.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) struct HeightField {
    columns: usize,
    rows: usize,
    /// The heights, row after row from y = 0 on.
    heights: Vec<Rational>,
    /// The height of the base.
    base: Rational,
}

/// The height of the base over heights: one below the least one, and not above zero.
fn base_below<'a>(heights: impl Iterator<Item = &'a Rational>) -> Rational {
    let below = heights.min().map(|least| least - Rational::ONE);
    below.unwrap_or_default().min(Rational::ZERO)
}

fn check_size(columns: usize, rows: usize) -> Result<(), HeightFieldError> {
    let count = columns.checked_mul(rows);
    match count.is_some_and(|count| (0..=MAX_HEIGHTS).contains(&count)) {
        true => Ok(()),
        false => Err(HeightFieldError::TooManyHeights { columns, rows }),
    }
}

impl HeightField {
    /// Reads a table: numbers in rows, and lines that begin with `#`.
    ///
    /// Missing numbers at the end of a row are zeros; they do not lower the base.
    ///
    /// # Errors
    /// The file is no text of numbers, or has too many of them.
    pub(crate) fn from_dat(bytes: &[u8]) -> Result<Self, HeightFieldError> {
        table::read(bytes)
    }

    /// Reads a picture. Black is 0, white is 100 high, and what is transparent is read as it is
    /// below. An inverted picture has black at 100 / 255 and white at 100 / 255 - 100, as in
    /// OpenSCAD, which subtracts the levels 0 to 255 from 1.
    ///
    /// # Errors
    /// The picture is damaged or too large.
    pub(crate) fn from_png(bytes: &[u8], invert: bool) -> Result<Self, HeightFieldError> {
        picture::read(bytes, invert)
    }

    /// The solid between the surface and its base, with the middle of the grid at the origin if it
    /// is centred.
    ///
    /// # Errors
    /// There are fewer than two rows or columns, or the surface lies on its base.
    pub(crate) fn polyhedron(&self, is_centred: bool) -> Result<Polyhedron, PolyhedronError> {
        let mut solid = FieldSolid::new(self, is_centred);
        for row in 1..self.rows {
            for column in 1..self.columns {
                solid.add_cell(column - 1, row - 1);
            }
        }
        solid.add_walls();
        let FieldSolid { points, faces, .. } = solid;
        Ok(Polyhedron::from_faces(&points, &faces)?.polyhedron)
    }

    fn height(&self, column: usize, row: usize) -> &Rational {
        &self.heights[row * self.columns + column]
    }
}

/// The faces of a field's solid.
struct FieldSolid<'f> {
    field: &'f HeightField,
    /// The points of the surface, those of the base below them, and the centres of cells.
    points: Vec<SpacePoint>,
    faces: Vec<PolyhedronFace>,
    /// The place of the first height.
    origin: [Rational; 2],
}

impl<'f> FieldSolid<'f> {
    fn new(field: &'f HeightField, is_centred: bool) -> Self {
        let half = |count: usize| Rational::from(count.saturating_sub(1)) / Rational::from(2);
        let origin = match is_centred {
            true => [-half(field.columns), -half(field.rows)],
            false => [Rational::ZERO, Rational::ZERO],
        };
        let mut solid = Self {
            field,
            points: Vec::new(),
            faces: Vec::new(),
            origin,
        };
        for is_base in [false, true] {
            for (k, height) in field.heights.iter().enumerate() {
                let [column, row] = [k % field.columns, k / field.columns];
                let z = if is_base { &field.base } else { height };
                let point = solid.place(Rational::from(column), Rational::from(row), z.clone());
                solid.points.push(point);
            }
        }
        solid
    }

    fn place(&self, column: Rational, row: Rational, z: Rational) -> SpacePoint {
        [&self.origin[0] + column, &self.origin[1] + row, z]
    }

    fn top(&self, [column, row]: [usize; 2]) -> usize {
        row * self.field.columns + column
    }

    fn bottom(&self, corner: [usize; 2]) -> usize {
        self.field.heights.len() + self.top(corner)
    }

    fn is_on_base(&self, [column, row]: [usize; 2]) -> bool {
        *self.field.height(column, row) == self.field.base
    }

    /// Adds the surface of a cell and its part of the base. A cell that lies on the base has no
    /// volume; then its faces would cancel each other.
    fn add_cell(&mut self, column: usize, row: usize) {
        let corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[i, j]| [column + i, row + j]);
        if corners.iter().all(|corner| self.is_on_base(*corner)) {
            return;
        }
        let sum = corners.iter().fold(Rational::ZERO, |sum, [column, row]| {
            sum + self.field.height(*column, *row)
        });
        let middle = |k: usize| Rational::from(2 * k + 1) / Rational::from(2);
        let centre = self.place(middle(column), middle(row), sum / Rational::from(4));
        let centre_index = self.points.len();
        self.points.push(centre);
        let ends = corners.iter().cycle().skip(1);
        for (from, to) in corners.iter().zip(ends) {
            let triangle = vec![self.top(*from), self.top(*to), centre_index];
            self.faces.push(PolyhedronFace::simple(triangle));
        }
        let base = corners.iter().rev().map(|corner| self.bottom(*corner));
        let base = PolyhedronFace::simple(base.collect());
        self.faces.push(base);
    }

    /// Adds the walls along the outline of the grid, counterclockwise as seen from above.
    fn add_walls(&mut self) {
        let (columns, rows) = (self.field.columns, self.field.rows);
        let [Some(right), Some(back)] = [columns.checked_sub(1), rows.checked_sub(1)] else {
            return;
        };
        let front = (0..right).map(|i| [i, 0]);
        let right_side = (0..back).map(|i| [right, i]);
        let back_side = (1..=right).rev().map(|i| [i, back]);
        let left_side = (1..=back).rev().map(|i| [0, i]);
        let outline: Vec<[usize; 2]> = front
            .chain(right_side)
            .chain(back_side)
            .chain(left_side)
            .collect();
        let ends = outline.iter().cycle().skip(1);
        for (from, to) in outline.iter().zip(ends) {
            let [a, b] = [from, to].map(|corner| self.bottom(*corner));
            let [c, d] = [to, from].map(|corner| self.top(*corner));
            self.faces.push(PolyhedronFace::simple(vec![a, b, c, d]));
        }
    }
}

#[cfg(test)]
mod tests;
