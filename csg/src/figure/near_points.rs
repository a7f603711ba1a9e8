//! Points within the resolution of each other are one point.

use super::FigurePoint;
use premio_kernel::number::predicates::RELATIVE_RESOLUTION;
use premio_kernel::number::rational::to_f64;
use std::collections::HashMap;

/// The first points at their places.
pub(super) struct NearPoints {
    resolution: f64,
    /// The points by the cells of a grid, of which each is as wide as the resolution.
    cells: HashMap<[i64; 2], Vec<(FigurePoint, [f64; 2])>>,
}

impl NearPoints {
    /// No points yet, of a figure of this size.
    pub fn new(size: f64) -> Self {
        Self {
            resolution: RELATIVE_RESOLUTION * size,
            cells: HashMap::new(),
        }
    }

    /// The first point within the resolution of a point.
    pub fn first_at(&mut self, point: &FigurePoint) -> FigurePoint {
        let at = point.each_ref().map(to_f64);
        let cell = at.map(|x| (x / self.resolution).floor() as i64);
        for [i, j] in around(cell) {
            for (known, place) in self.cells.get(&[i, j]).into_iter().flatten() {
                if (place[0] - at[0]).hypot(place[1] - at[1]) <= self.resolution {
                    return known.clone();
                }
            }
        }
        self.cells
            .entry(cell)
            .or_default()
            .push((point.clone(), at));
        point.clone()
    }
}

/// A cell and the eight around it.
fn around([i, j]: [i64; 2]) -> impl Iterator<Item = [i64; 2]> {
    let steps = [-1, 0, 1];
    let all = steps
        .into_iter()
        .flat_map(move |di| steps.map(|dj| [di, dj]));
    all.map(move |[di, dj]| [i.saturating_add(di), j.saturating_add(dj)])
}
