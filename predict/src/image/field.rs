//! The light of flat regions, by the corners of cells where it runs straight between them.

use super::shading::Shading;
use crate::outline::Seen;
use premio_kernel::geometry::surface::Surface;

/// The side of a cell, in pixels.
const CELL: usize = 8;
/// How far the light in the middle of a cell may be from straight, in grey levels.
const STRAIGHT: f64 = 1.0 / 16.0;

/// What is known of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Course {
    Unknown,
    Straight,
    Bent,
}

/// The light of one flat region.
#[derive(Clone, Debug)]
pub struct Field {
    seen: Seen,
    /// Corners in a row of cells.
    columns: usize,
    rows: usize,
    corners: Vec<f64>,
    courses: Vec<Course>,
}

impl Field {
    /// The light of a region, if it is flat: a plane or the background.
    pub fn of(shading: &Shading<'_>, seen: &Seen, [width, height]: [usize; 2]) -> Option<Self> {
        let flat = |face| matches!(shading.surface(face), Surface::Plane(_));
        let [columns, rows] = [width, height].map(|n| n.div_ceil(CELL) + 2);
        seen.face.is_none_or(flat).then(|| Self {
            seen: *seen,
            columns,
            rows,
            corners: vec![f64::NAN; columns * rows],
            courses: vec![Course::Unknown; columns * rows],
        })
    }

    /// The grey level at a point of the image, before noise and steps.
    pub fn level(&mut self, shading: &Shading<'_>, at: [f64; 2]) -> f64 {
        // The first corner lies half a pixel before the image, where it begins.
        let place = at.map(|x| (x + 0.5) / CELL as f64);
        let [i, j] = place.map(|x| x.max(0.0) as usize);
        if i + 1 >= self.columns || j + 1 >= self.rows {
            return self.exact(shading, at);
        }
        let cell = j * self.columns + i;
        if self.courses[cell] == Course::Unknown {
            self.courses[cell] = self.course(shading, [i, j]);
        }
        match self.courses[cell] {
            Course::Straight => self.between([i, j], [place[0] - i as f64, place[1] - j as f64]),
            _ => self.exact(shading, at),
        }
    }

    fn exact(&self, shading: &Shading<'_>, at: [f64; 2]) -> f64 {
        let mut hint = shading.distance(&self.seen.point);
        shading.level(at, &self.seen, &mut hint)
    }

    fn course(&mut self, shading: &Shading<'_>, [i, j]: [usize; 2]) -> Course {
        let corner = |i: usize, j: usize| [i, j].map(|k| (k * CELL) as f64 - 0.5);
        for (i, j) in [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)] {
            let known = j * self.columns + i;
            if self.corners[known].is_nan() {
                self.corners[known] = self.exact(shading, corner(i, j));
            }
        }
        let [x, y] = corner(i, j);
        let half = 0.5 * CELL as f64;
        let middle = self.exact(shading, [x + half, y + half]);
        // What is no number is not straight.
        match (self.between([i, j], [0.5; 2]) - middle).abs() <= STRAIGHT {
            true => Course::Straight,
            false => Course::Bent,
        }
    }

    /// The level at a part of a cell, by its corners.
    fn between(&self, [i, j]: [usize; 2], [u, v]: [f64; 2]) -> f64 {
        let first = j * self.columns + i;
        let row = |at: usize| {
            let [a, b] = [self.corners[at], self.corners[at + 1]];
            a + (b - a) * u
        };
        let [above, below] = [row(first), row(first + self.columns)];
        above + (below - above) * v
    }
}
