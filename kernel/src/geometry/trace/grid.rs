//! Cells of the parameter torus, and the first grid of them.

use crate::geometry::toric::wrap;
use std::f64::consts::TAU;

/// A rectangle of angles.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// The least angles.
    pub lo: [f64; 2],
    /// The greatest angles.
    pub hi: [f64; 2],
}

impl Cell {
    /// The angles in the middle.
    pub fn centre(&self) -> [f64; 2] {
        [
            0.5 * (self.lo[0] + self.hi[0]),
            0.5 * (self.lo[1] + self.hi[1]),
        ]
    }

    /// Half the sides.
    pub fn half(&self) -> [f64; 2] {
        [
            0.5 * (self.hi[0] - self.lo[0]),
            0.5 * (self.hi[1] - self.lo[1]),
        ]
    }

    /// Both halves across one angle.
    pub fn halves(&self, across: usize) -> [Cell; 2] {
        let c = self.centre()[across];
        let (mut low, mut high) = (*self, *self);
        low.hi[across] = c;
        high.lo[across] = c;
        [low, high]
    }
}

/// The cells of the first grid along each angle.
const GRID: usize = 10;

/// Where the first grid starts, so that symmetric curves do not meet its lines in special points.
const START: f64 = 0.061_803_4;

/// The cells of the first grid, without singular points.
pub fn plain_grid() -> Vec<Cell> {
    let all = lines(&[], [1.0; 2]);
    grid(&all, &all)
}

/// The lines of the first grid along one angle: even ones, but none through a zone, and the sides
/// of the zones, given as (centre, size). `skew` makes the sides unequal, so that a curve of a
/// simple slope misses the corners.
pub fn lines(zones: &[(f64, f64)], skew: [f64; 2]) -> Vec<f64> {
    let mut all: Vec<f64> = (0..GRID)
        .map(|i| START + TAU * i as f64 / GRID as f64)
        .collect();
    all.retain(|x| zones.iter().all(|(c, size)| wrap(x - c).abs() > *size));
    for &(c, size) in zones {
        for side in [c - size * skew[0], c + size * skew[1]] {
            let side = START + (side - START).rem_euclid(TAU);
            let same = all.iter().any(|x| wrap(x - side).abs() < size * SAME);
            let within = |(c, size): &(f64, f64)| {
                let d = wrap(side - c);
                d > -size * skew[0] * WITHIN && d < size * skew[1] * WITHIN
            };
            if !same && !zones.iter().any(within) {
                all.push(side);
            }
        }
    }
    all.sort_by(f64::total_cmp);
    let first = all[0];
    all.push(first + TAU);
    all
}

/// Lines nearer than this part of a zone are one.
const SAME: f64 = 1.0 / (1 << 20) as f64;

/// What lies within this part of a zone is inside.
const WITHIN: f64 = 0.999;

/// The cells between lines of both angles.
pub fn grid(xs: &[f64], ys: &[f64]) -> Vec<Cell> {
    let mut cells = Vec::new();
    for x in xs.windows(2) {
        for y in ys.windows(2) {
            cells.push(Cell {
                lo: [x[0], y[0]],
                hi: [x[1], y[1]],
            });
        }
    }
    cells
}
