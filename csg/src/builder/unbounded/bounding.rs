//! A box around a region, or the direction in which there is none.
//!
//! Beyond a cube about the origin a point is u/w with u on the surface of the unit cube and w from 0 to
//! the inverse of the cube's half edge. So finitely many cells show that nothing is out there.

use super::linear_form::Cell;
use super::region::{Region, RegionInCell};
use crate::builder::UnboundedSide;
use premio_kernel::geometry::bounds::Aabb;

/// The number of cubes that are tried, each of four times the size.
const CUBES: i32 = 11;
/// The number of times that a cell at infinity is divided.
const DEPTH: u32 = 64;
/// The number of cells at infinity after which a cube is given up, and of nodes in all of them.
const MAX_CELLS: usize = 1 << 14;
/// See [`MAX_CELLS`].
const MAX_NODES: usize = 1 << 26;
/// The size, in reaches of the region, from which a box is not shrunk further.
const SMALL: f64 = 1.0 / (1u64 << 40) as f64;
/// The number of times that a box is divided to shrink it.
const HALVINGS: u32 = 3;

/// A box that contains a region; `None` if that is empty.
///
/// # Errors
/// There is none.
pub(super) fn bounds(region: &Region) -> Result<Option<Aabb>, UnboundedSide> {
    let mut beyond = UnboundedSide::Everywhere;
    for power in 0..CUBES {
        let half = 2.0 * region.reach() * 4.0_f64.powi(power);
        match found_beyond(region, half) {
            None => {
                let cube = Aabb {
                    min: [-half; 3],
                    max: [half; 3],
                };
                return Ok(shrunk(region, cube));
            }
            Some(side) => beyond = side,
        }
    }
    Err(beyond)
}

/// The two halves of a range.
fn halves([lo, hi]: [f64; 2]) -> [[f64; 2]; 2] {
    let middle = 0.5 * (lo + hi);
    [[lo, middle], [middle, hi]]
}

/// Where the region may reach out of a cube.
fn found_beyond(region: &Region, half: f64) -> Option<UnboundedSide> {
    let (w, reach) = ([0.0, 1.0 / half], region.reach());
    if let Some(axis) = axis_beyond(region, half) {
        return Some(axis);
    }
    let faces = (0..3).flat_map(|i| [-1.0, 1.0].map(|side| (i, side)));
    let mut open: Vec<(Cell, u32, Region)> = Vec::new();
    let (mut cells, mut nodes) = (0, 0);
    for (i, side) in faces {
        let mut u = [[-1.0, 1.0]; 3];
        u[i] = [side; 2];
        open.push((Cell { u, w }, 0, region.clone()));
        while let Some((cell, depth, region)) = open.pop() {
            (cells, nodes) = (cells + 1, nodes + region.node_count());
            let is_early = depth < DEPTH && cells < MAX_CELLS && nodes < MAX_NODES;
            match region.within(&cell) {
                RegionInCell::Outside => {}
                RegionInCell::Unknown(rest) if is_early => {
                    let parts = divided(&cell, i, reach).into_iter();
                    open.extend(parts.map(|part| (part, depth + 1, rest.clone())));
                }
                RegionInCell::Unknown(_) | RegionInCell::Inside => return Some(toward(&cell)),
            }
        }
    }
    None
}

/// A coordinate axis along which the region reaches out of a cube.
fn axis_beyond(region: &Region, half: f64) -> Option<UnboundedSide> {
    let axes = (0..3).flat_map(|i| [1, -1].map(|side| (i, side)));
    let mut found = axes.filter(|&(i, side)| {
        let u = std::array::from_fn(|j| {
            if i == j {
                [f64::from(side); 2]
            } else {
                [0.0; 2]
            }
        });
        let cell = Cell {
            u,
            w: [0.5 / half, 1.0 / half],
        };
        matches!(region.within(&cell), RegionInCell::Inside)
    });
    let (i, side) = found.next()?;
    Some(UnboundedSide::Toward(std::array::from_fn(|j| {
        if i == j { 100 * side } else { 0 }
    })))
}

/// The parts of a cell on the face of the unit cube across an axis: by direction, or by distance where
/// that moves the solids more.
fn divided(cell: &Cell, face: usize, reach: f64) -> Vec<Cell> {
    let [i, j] = [(face + 1) % 3, (face + 2) % 3];
    let width = cell.u[i][1] - cell.u[i][0];
    if (cell.w[1] - cell.w[0]) * reach > width {
        return halves(cell.w).map(|w| Cell { u: cell.u, w }).into();
    }
    let [u, v] = [i, j].map(|i| halves(cell.u[i]));
    let pairs = u.into_iter().flat_map(|u| v.map(|v| [u, v]));
    let part = |[u, v]: [[f64; 2]; 2]| {
        let mut part = *cell;
        (part.u[i], part.u[j]) = (u, v);
        part
    };
    pairs.map(part).collect()
}

/// The direction of the middle of a cell.
fn toward(cell: &Cell) -> UnboundedSide {
    let middle = cell.u.map(|[lo, hi]| 0.5 * (lo + hi));
    let size = middle.iter().map(|x| x * x).sum::<f64>().sqrt();
    // Hundredths of a unit vector are small.
    UnboundedSide::Toward(middle.map(|x| (100.0 * x / size).round() as i16))
}

/// The box around the parts of a box that may contain points. It is shrunk until it hardly gets smaller.
fn shrunk(region: &Region, start: Aabb) -> Option<Aabb> {
    let mut known = start;
    loop {
        let smaller = occupied(region, &known)?;
        let is_small = smaller.diagonal() <= SMALL * region.reach();
        if is_small || smaller.diagonal() > 0.5 * known.diagonal() {
            return Some(smaller);
        }
        known = smaller;
    }
}

/// The box around the cells of a box that may contain points; `None` if there are none.
fn occupied(region: &Region, whole: &Aabb) -> Option<Aabb> {
    let mut found: Option<Aabb> = None;
    let mut open = vec![(*whole, 0, region.clone())];
    while let Some((cell, depth, region)) = open.pop() {
        let u = [0, 1, 2].map(|i| [cell.min[i], cell.max[i]]);
        let rest = match region.within(&Cell { u, w: [1.0; 2] }) {
            RegionInCell::Outside => continue,
            RegionInCell::Unknown(rest) if depth < HALVINGS => rest,
            RegionInCell::Unknown(_) | RegionInCell::Inside => {
                found = Some(found.map_or(cell, |found| found.hull(&cell)));
                continue;
            }
        };
        let halves = u.map(halves);
        open.extend((0..8_usize).map(|octant| {
            let range = |i: usize| halves[i][octant >> i & 1];
            let part = Aabb {
                min: [0, 1, 2].map(|i| range(i)[0]),
                max: [0, 1, 2].map(|i| range(i)[1]),
            };
            (part, depth + 1, rest.clone())
        }));
    }
    found
}
