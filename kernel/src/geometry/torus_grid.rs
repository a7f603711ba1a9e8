//! Cells of the parameter torus, and the initial grid.

use crate::geometry::torus_curve::wrap;
use crate::number::float::Float;

/// A rectangle of angles.
#[derive(Clone, Copy, Debug)]
pub struct Cell<N: Float = f64> {
    /// The minimum of each angle.
    pub lo: [N; 2],
    /// The maximum of each angle.
    pub hi: [N; 2],
}

impl<N: Float> Cell<N> {
    /// The angles of the centre.
    pub fn centre(&self) -> [N; 2] {
        [
            N::HALF * (self.lo[0] + self.hi[0]),
            N::HALF * (self.lo[1] + self.hi[1]),
        ]
    }

    /// Half the sides.
    pub fn half(&self) -> [N; 2] {
        [
            N::HALF * (self.hi[0] - self.lo[0]),
            N::HALF * (self.hi[1] - self.lo[1]),
        ]
    }

    /// Whether f64 describes the form on it as well as extended precision does: its terms vary over
    /// the cell by far more than their rounding.
    pub fn is_coarse(&self) -> bool {
        self.half().into_iter().all(|h| h.rounded() > COARSE)
    }

    /// The cell rounded to f64.
    pub fn to_f64(self) -> Cell {
        let [lo, hi] = [self.lo, self.hi].map(|angles| angles.map(N::rounded));
        Cell { lo, hi }
    }

    /// The two halves, split across one angle.
    pub fn halves(&self, across: usize) -> [Cell<N>; 2] {
        let c = self.centre()[across];
        let (mut low, mut high) = (*self, *self);
        low.hi[across] = c;
        high.lo[across] = c;
        [low, high]
    }
}

/// Half the side of the smallest coarse cell. Its square is far larger than the rounding of f64.
const COARSE: f64 = 1.0 / (1 << 16) as f64;

/// The number of cells of the initial grid along each angle.
const GRID: usize = 10;

/// The start of the initial grid along each angle. It is irregular, so that symmetric curves
/// neither cross its lines at special points nor pass through its corners.
const START: [f64; 2] = [0.061_803_4, 0.041_421_4];

/// The position of the grid lines. It is arbitrary, except that no curve may pass through a corner.
#[derive(Clone, Copy, Debug)]
pub struct Layout<N: Float = f64> {
    /// The size of a zone, relative to the largest.
    pub shrink: N,
    /// The distance of a zone's sides from its point, relative to its size: low and high, along
    /// both angles.
    pub skew: [[N; 2]; 2],
    /// The first line along each angle.
    pub start: [N; 2],
}

/// The sides of zones. They are unequal, so that a curve with a simple slope misses the corners.
const SKEWS: [[[f64; 2]; 2]; 3] = [
    [[0.913_7, 1.0], [0.871_3, 0.761_9]],
    [[0.731_1, 0.653_7], [1.0, 0.941_7]],
    [[1.0, 0.831_9], [0.537_1, 0.611_3]],
];

impl<N: Float> Layout<N> {
    /// The layout of an attempt: first every skew, then the same with smaller zones.
    pub fn new(attempt: usize) -> Self {
        let n = attempt as i32;
        let skews = SKEWS.len() as i32;
        Self {
            shrink: N::HALF.powi(n / skews),
            skew: SKEWS[attempt % SKEWS.len()].map(|side| side.map(N::from_f64)),
            start: START.map(|s| N::from_f64(s) * N::whole(n + 1)),
        }
    }
}

/// The cells of the initial grid, without singular points.
pub fn regular_grid<N: Float>() -> Vec<Cell<N>> {
    let layout = Layout::new(0);
    let [xs, ys] = [0, 1].map(|angle| lines(angle, &[], &layout));
    grid(&xs, &ys)
}

/// The neighbourhood of a singular point along one angle.
#[derive(Clone, Copy, Debug)]
pub struct Zone<N: Float = f64> {
    pub centre: N,
    pub size: N,
}

impl<N: Float> Zone<N> {
    /// Whether a value of the angle is within a part of the zone.
    pub fn contains(&self, angle: N, part: N) -> bool {
        wrap(angle - self.centre).abs() <= part * self.size
    }
}

/// The grid lines along one `angle`, given by its index: evenly spaced lines outside the zones, and
/// the sides of the zones.
pub fn lines<N: Float>(angle: usize, zones: &[Zone<N>], layout: &Layout<N>) -> Vec<N> {
    let (start, skew) = (layout.start[angle], layout.skew[angle]);
    let mut all: Vec<N> = (0..GRID)
        .map(|i| start + N::TAU * N::from_f64(i as f64) / N::from_f64(GRID as f64))
        .collect();
    all.retain(|x| zones.iter().all(|z| wrap(*x - z.centre).abs() > z.size));
    for &Zone { centre, size } in zones {
        for side in [centre - size * skew[0], centre + size * skew[1]] {
            let side = start + (side - start).rem_euclid(N::TAU);
            let same = all
                .iter()
                .any(|x| wrap(*x - side).abs() < size * N::from_f64(SAME));
            let within = |zone: &Zone<N>| {
                let d = wrap(side - zone.centre);
                d > -zone.size * skew[0] * N::from_f64(WITHIN)
                    && d < zone.size * skew[1] * N::from_f64(WITHIN)
            };
            if !same && !zones.iter().any(within) {
                all.push(side);
            }
        }
    }
    all.sort_by(N::total_cmp);
    let first = all[0];
    all.push(first + N::TAU);
    all
}

/// Lines closer than this fraction of a zone are one.
const SAME: f64 = 1.0 / (1 << 20) as f64;

/// A line within this fraction of a zone counts as inside.
const WITHIN: f64 = 0.999;

/// The cells between lines of both angles.
pub fn grid<N: Float>(xs: &[N], ys: &[N]) -> Vec<Cell<N>> {
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
