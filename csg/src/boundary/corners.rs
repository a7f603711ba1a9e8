//! The corners: points where curves are cut, equal ones made one.

use nalgebra::{Point3, Vector3};
use premio_kernel::number::sign::Judge;
use std::collections::HashMap;

/// A point where a curve is cut.
#[derive(Clone, Debug)]
pub(super) struct Corner {
    /// The place.
    pub point: Point3<f64>,
    /// The carriers through it, in order.
    pub carriers: Vec<usize>,
}

/// Corners by place, so that equal ones are one.
pub(super) struct Corners {
    /// In the order in which they were found.
    pub all: Vec<Corner>,
    grid: HashMap<[i64; 3], Vec<usize>>,
    cell: f64,
}

impl Corners {
    pub fn new(band: f64) -> Self {
        Self {
            all: Vec::new(),
            grid: HashMap::new(),
            cell: 256.0 * band,
        }
    }

    fn key(&self, p: &Point3<f64>) -> [i64; 3] {
        [0, 1, 2].map(|i| (p[i] / self.cell).floor() as i64)
    }

    /// The corner at `p`, which the given carriers pass through.
    pub fn at(&mut self, p: &Point3<f64>, carriers: &[usize], judge: &Judge) -> usize {
        let reach = judge.reach();
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
        if let Some((d, v)) = best
            && d < reach
            && judge.coincide("point on point", d, [p.x, p.y, p.z])
        {
            for &c in carriers {
                if let Err(at) = self.all[v].carriers.binary_search(&c) {
                    self.all[v].carriers.insert(at, c);
                }
            }
            return v;
        }
        let v = self.all.len();
        let mut carriers = carriers.to_vec();
        carriers.sort_unstable();
        self.all.push(Corner {
            point: *p,
            carriers,
        });
        self.grid.entry(self.key(p)).or_default().push(v);
        v
    }
}
