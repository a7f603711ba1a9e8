//! The light of flat regions, interpolated from the corners of cells where it is linear between
//! them.

use super::shading::Shading;
use crate::image_arcs::{Region, RegionSample};
use premio_kernel::geometry::surface::Surface;
use std::ops::Range;

/// The side of a cell, in pixels.
const CELL: i64 = 8;
/// The greatest deviation of the light in the middle of a cell from linearity, in grey levels.
const STRAIGHT: f64 = 1.0 / 16.0;

/// The state of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Course {
    Unknown,
    Straight,
    Bent,
}

/// The light of one flat region.
#[derive(Clone, Debug)]
pub struct Field {
    seen: RegionSample,
    /// The position of the first corner, in cells.
    first: [i64; 2],
    /// Corners in a row of cells.
    columns: usize,
    corners: Vec<f64>,
    courses: Vec<Course>,
}

impl Field {
    /// The light of a region, if it is flat: a plane or the background.
    pub fn new(shading: &Shading<'_>, region: &Region) -> Option<Self> {
        let seen = region.seen?;
        let flat = |face| matches!(shading.surface(face), Surface::Plane(_));
        let [least, most] = region.bounds;
        if !seen.face.is_none_or(flat) || least[0] > most[0] {
            return None;
        }
        let first = least.map(|x| cell(x - 1.0));
        let count = |i: usize| (cell(most[i] + 1.0) - first[i] + 2) as usize;
        let [columns, rows] = [count(0), count(1)];
        Some(Self {
            seen,
            first,
            columns,
            corners: vec![f64::NAN; columns * rows],
            courses: vec![Course::Unknown; columns * rows],
        })
    }

    /// The grey level at a point of the image, before noise and steps.
    pub fn level(&mut self, shading: &Shading<'_>, at: [f64; 2]) -> f64 {
        match self.straight(shading, at.map(cell)) {
            Some(ends) => {
                let [u, v] = at.map(|x| (x - corner(cell(x))) / CELL as f64);
                let [left, right] = [0, 1].map(|i| ends[0][i] + (ends[1][i] - ends[0][i]) * v);
                left + (right - left) * u
            }
            None => self.exact(shading, at),
        }
    }

    /// The grey levels of a run of pixels.
    pub fn shade(&mut self, shading: &Shading<'_>, run: Range<u32>, y: f64, levels: &mut [f32]) {
        let mut x = run.start;
        let row = cell(y);
        let v = (y - corner(row)) / CELL as f64;
        while x < run.end {
            let column = cell(f64::from(x));
            let end = run.end.min(((column + 1) * CELL) as u32);
            match self.straight(shading, [column, row]) {
                Some(ends) => {
                    let [left, right] = [0, 1].map(|i| ends[0][i] + (ends[1][i] - ends[0][i]) * v);
                    let step = (right - left) / CELL as f64;
                    let from = left + (f64::from(x) - corner(column)) * step;
                    for (k, level) in levels[x as usize..end as usize].iter_mut().enumerate() {
                        *level = (from + k as f64 * step) as f32;
                    }
                }
                None => {
                    for x in x..end {
                        levels[x as usize] = self.exact(shading, [f64::from(x), y]) as f32;
                    }
                }
            }
            x = end;
        }
    }

    fn exact(&self, shading: &Shading<'_>, at: [f64; 2]) -> f64 {
        let mut hint = shading.distance(&self.seen.point);
        shading.level(at, &self.seen, &mut hint)
    }

    /// The levels at the corners of a cell, by row, if the light is linear between them.
    fn straight(&mut self, shading: &Shading<'_>, place: [i64; 2]) -> Option<[[f64; 2]; 2]> {
        let [i, j] = [0, 1].map(|k| usize::try_from(place[k] - self.first[k]).ok());
        let at = j? * self.columns + i?;
        if i? + 1 >= self.columns || at + self.columns + 1 >= self.corners.len() {
            return None;
        }
        if self.courses[at] == Course::Unknown {
            self.courses[at] = self.course(shading, place, at);
        }
        (self.courses[at] == Course::Straight).then(|| self.ends(at))
    }

    fn ends(&self, at: usize) -> [[f64; 2]; 2] {
        let row = |at: usize| [self.corners[at], self.corners[at + 1]];
        [row(at), row(at + self.columns)]
    }

    fn course(&mut self, shading: &Shading<'_>, [i, j]: [i64; 2], at: usize) -> Course {
        let below = at + self.columns;
        let around = [
            (i, j, at),
            (i + 1, j, at + 1),
            (i, j + 1, below),
            (i + 1, j + 1, below + 1),
        ];
        for (i, j, at) in around {
            if self.corners[at].is_nan() {
                self.corners[at] = self.exact(shading, [corner(i), corner(j)]);
            }
        }
        let half = 0.5 * CELL as f64;
        let middle = self.exact(shading, [corner(i) + half, corner(j) + half]);
        let mean = self.ends(at).iter().flatten().sum::<f64>() / 4.0;
        // NaN is not linear.
        match (mean - middle).abs() <= STRAIGHT {
            true => Course::Straight,
            false => Course::Bent,
        }
    }
}

/// The cell that contains a column or a row.
fn cell(x: f64) -> i64 {
    ((x + 0.5) / CELL as f64).floor() as i64
}

/// The beginning of a cell, at the border of pixels.
fn corner(cell: i64) -> f64 {
    (cell * CELL) as f64 - 0.5
}
