//! The corners: points where curves are cut, equal ones made one.

use super::concern::{Between, Unlisted};
use nalgebra::{Point3, Vector3};
use premio_kernel::number::sign::{Judge, Side};
use std::collections::HashMap;

/// A point where a curve is cut.
#[derive(Clone, Debug)]
pub(super) struct Corner {
    /// The place.
    pub point: Point3<f64>,
    /// The carriers through it, in order.
    pub carriers: Vec<usize>,
    /// The pairs of carriers that have it by themselves: where they touch, where their curve
    /// crosses itself, an apex.
    pub nodes: Vec<[usize; 2]>,
}

impl Corner {
    /// Whether a carrier passes through it.
    pub fn is_on(&self, carrier: usize) -> bool {
        self.carriers.binary_search(&carrier).is_ok()
    }
}

/// Corners by place, so that equal ones are one.
pub(super) struct Corners {
    /// In the order in which they were found.
    pub all: Vec<Corner>,
    /// The close calls met.
    pub calls: Vec<Unlisted>,
    grid: HashMap<[i64; 3], Vec<usize>>,
    cell: f64,
}

impl Corners {
    pub fn new(band: f64) -> Self {
        Self {
            all: Vec::new(),
            calls: Vec::new(),
            grid: HashMap::new(),
            cell: 256.0 * band,
        }
    }

    fn key(&self, p: &Point3<f64>) -> [i64; 3] {
        [0, 1, 2].map(|i| (p[i] / self.cell).floor() as i64)
    }

    /// The corner at `p`, which the given carriers define, or are known to pass through.
    pub fn at(&mut self, p: &Point3<f64>, carriers: &[usize], judge: &Judge) -> usize {
        let v = self.found(p, carriers, judge);
        let corner = &mut self.all[v];
        for &c in carriers {
            if let Err(at) = corner.carriers.binary_search(&c) {
                corner.carriers.insert(at, c);
            }
        }
        if let [a, b] = *carriers {
            corner.nodes.push([a, b]);
        }
        v
    }

    /// The corner that coincides with `p`, or a new one.
    fn found(&mut self, p: &Point3<f64>, carriers: &[usize], judge: &Judge) -> usize {
        let new = self.all.len();
        if let Some((d, v)) = self.nearest(p, judge.reach()) {
            let (side, call) = judge.decide("point on point", d, [p.x, p.y, p.z]);
            let one = side == Side::On;
            let between = match one {
                true => Between::CornerAndPoint(v, carriers.to_vec()),
                false => Between::Corners([v, new]),
            };
            self.calls.extend(call.map(|call| (call, between)));
            if one {
                return v;
            }
        }
        self.all.push(Corner {
            point: *p,
            carriers: Vec::new(),
            nodes: Vec::new(),
        });
        self.grid.entry(self.key(p)).or_default().push(new);
        new
    }

    /// The corner nearest to `p` that is nearer than `reach`, with its distance.
    fn nearest(&self, p: &Point3<f64>, reach: f64) -> Option<(f64, usize)> {
        let lo = self.key(&(p - Vector3::repeat(reach)));
        let hi = self.key(&(p + Vector3::repeat(reach)));
        let mut best: Option<(f64, usize)> = None;
        for x in lo[0]..=hi[0] {
            for y in lo[1]..=hi[1] {
                for z in lo[2]..=hi[2] {
                    for &v in self.grid.get(&[x, y, z]).into_iter().flatten() {
                        let d = (self.all[v].point - p).norm();
                        if best.is_none_or(|b| d < b.0) {
                            best = Some((d, v));
                        }
                    }
                }
            }
        }
        best.filter(|b| b.0 < reach)
    }
}
