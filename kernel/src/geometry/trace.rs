//! The branches of F(θ, φ) = 0 on the parameter torus, all of them, with their singular points.
//!
//! The square of both angles is divided until in every cell F has no zero, or one of its partial
//! derivatives dominates the other, so that the curve in the cell is a graph of bounded slope
//! (Snyder 1992; Plantinga and Vegter 2004). The bounds are Taylor's with a global bound of the
//! third derivatives. Cells are joined through the roots on their sides. Singular points, where F
//! and its gradient vanish within the band, are found first and stand in cells of their own.

use super::bitrig::{BiTrig, Local, Partials};
use super::singular::{Contact as Kind, SingularPoint, singular_points};
use super::surface::Torus;
use super::toric::{Axis, Segment, Toric, wrap};
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::roots::{Contact, Zeros, isolate};
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::TAU;

/// A point where the curve crosses or touches itself, by its angles.
#[derive(Clone, Debug, PartialEq)]
pub struct Singular {
    /// (θ, φ).
    pub angles: [f64; 2],
    /// Where the branches pass: (index of the branch, parameter). Empty for an isolated point.
    pub on: Vec<(usize, f64)>,
}

/// The zero set of F.
#[derive(Clone, Debug, Default)]
pub struct Traced {
    /// The branches, all closed.
    pub branches: Vec<Toric>,
    /// The singular points.
    pub singular: Vec<Singular>,
}

/// The curve has a singular point worse than a crossing, or one that cannot be told from it.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("a curve on a torus could not be resolved near the angles ({:.6}, {:.6})", angles[0], angles[1])]
pub struct Unresolved {
    /// (θ, φ).
    pub angles: [f64; 2],
}

/// A rectangle of angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    lo: [f64; 2],
    hi: [f64; 2],
}

impl Cell {
    pub(super) fn centre(&self) -> [f64; 2] {
        [
            0.5 * (self.lo[0] + self.hi[0]),
            0.5 * (self.lo[1] + self.hi[1]),
        ]
    }
    pub(super) fn half(&self) -> [f64; 2] {
        [
            0.5 * (self.hi[0] - self.lo[0]),
            0.5 * (self.hi[1] - self.lo[1]),
        ]
    }
    /// Both halves across one angle.
    pub(super) fn halves(&self, across: usize) -> [Cell; 2] {
        let c = self.centre()[across];
        let (mut low, mut high) = (*self, *self);
        low.hi[across] = c;
        high.lo[across] = c;
        [low, high]
    }
}

/// Taylor's bounds over a cell: the least |F|, and the ranges of |F_x| and |F_y|.
pub(super) struct Bounds {
    /// F has no zero in the cell.
    pub clear: bool,
    /// The least and the greatest |F_x|.
    pub x: [f64; 2],
    /// The least and the greatest |F_y|.
    pub y: [f64; 2],
    /// At the centre.
    pub at: Partials<f64>,
    /// The angle along which the form varies more over the cell.
    pub wide: usize,
}

#[derive(Default)]
struct Remainders {
    third: f64,
    x: f64,
    y: f64,
    across: [f64; 2],
}

pub(super) struct Tracer<'a> {
    pub form: &'a BiTrig,
    /// A bound of the third derivatives.
    pub third: f64,
    /// A bound of the rounding error of the form.
    pub slop: f64,
    pub band: f64,
}

/// The depth at which a cell that is still undecided is given up: sides of 1e-7 radians.
pub(super) const DEPTH: u32 = 48;
/// The cells of the first grid along each angle.
const GRID: usize = 10;
/// Where the first grid starts, so that symmetric curves do not meet its lines in special points.
const START: f64 = 0.061_803_4;
/// A graph's slope is at most this in an accepted cell.
const STEEP: f64 = 2.0;

impl Tracer<'_> {
    pub(super) fn bounds(&self, cell: &Cell) -> Bounds {
        let [cx, cy] = cell.centre();
        let [hx, hy] = cell.half();
        let p = self.form.partials(cx, cy);
        let r = self.remainders(hx, hy);
        let spread = p.x.abs() * hx
            + p.y.abs() * hy
            + 0.5 * (p.xx.abs() * hx * hx + 2.0 * p.xy.abs() * hx * hy + p.yy.abs() * hy * hy)
            + r.third / 6.0
            + self.slop;
        let rx = p.xx.abs() * hx + p.xy.abs() * hy + 0.5 * r.x + self.slop;
        let ry = p.xy.abs() * hx + p.yy.abs() * hy + 0.5 * r.y + self.slop;
        Bounds {
            clear: p.f.abs() > spread,
            x: [p.x.abs() - rx, p.x.abs() + rx],
            y: [p.y.abs() - ry, p.y.abs() + ry],
            at: p,
            wide: usize::from(r.across[1] > r.across[0]),
        }
    }

    /// Bounds of the third derivatives in the direction (hx, hy), of those of both first partial
    /// derivatives, and how much the form varies along each angle.
    fn remainders(&self, hx: f64, hy: f64) -> Remainders {
        let degree = [0.0, 1.0, 1.0, 2.0, 2.0];
        let mut r = Remainders::default();
        for (row, dx) in self.form.0.iter().zip(degree) {
            for (c, dy) in row.iter().zip(degree) {
                let d: f64 = dx * hx + dy * hy;
                let c = c.abs() * d * d;
                r.third += c * d;
                r.x += c * dx;
                r.y += c * dy;
                r.across[0] += c * dx * hx;
                r.across[1] += c * dy * hy;
            }
        }
        r
    }

    /// The cells that hold a piece of the curve, each with the angle its graph runs over.
    fn leaves(&self, cells: Vec<Cell>) -> Result<Vec<(Cell, Axis)>, Unresolved> {
        let mut leaves = Vec::new();
        let mut stack: Vec<(Cell, u32)> = cells.into_iter().map(|c| (c, 0)).collect();
        while let Some((cell, depth)) = stack.pop() {
            let b = self.bounds(&cell);
            if b.clear {
                continue;
            }
            if b.y[0] > 0.0 && b.x[1] <= STEEP * b.y[0] {
                leaves.push((cell, Axis::Around));
            } else if b.x[0] > 0.0 && b.y[1] <= STEEP * b.x[0] {
                leaves.push((cell, Axis::Tube));
            } else if depth >= DEPTH {
                return Err(Unresolved {
                    angles: cell.centre(),
                });
            } else {
                stack.extend(cell.halves(b.wide).map(|c| (c, depth + 1)));
            }
        }
        Ok(leaves)
    }

    /// The roots of F on a side of a cell: the angle that is `fixed` on it, and its ends.
    fn roots_on(&self, fixed: usize, at: f64, lo: f64, hi: f64) -> Option<Vec<f64>> {
        let f = |t: Interval| {
            let c = Interval::point(at);
            if fixed == 0 {
                let p = self.form.partials(c, t);
                Jet {
                    v: p.f,
                    d: p.y,
                    dd: p.yy,
                }
            } else {
                let p = self.form.partials(t, c);
                Jet {
                    v: p.f,
                    d: p.x,
                    dd: p.xx,
                }
            }
        };
        match isolate(&f, &[lo, hi], self.slop) {
            Zeros::At { roots, .. } if roots.iter().all(|r| r.contact == Contact::Simple) => {
                Some(roots.into_iter().map(|r| r.t).collect())
            }
            _ => None,
        }
    }
}

pub(super) fn near(a: &[f64; 2], b: &[f64; 2], reach: f64) -> bool {
    wrap(a[0] - b[0]).abs() <= reach && wrap(a[1] - b[1]).abs() <= reach
}

/// The cells of the first grid, without singular points.
pub(super) fn plain_grid() -> Vec<Cell> {
    let all = lines(&[], [1.0; 2]);
    grid(&all, &all)
}

/// The lines of the first grid along one angle: even ones, but none through a zone, and the sides
/// of the zones, given as (centre, size). `skew` makes the sides unequal, so that a curve of a
/// simple slope misses the corners.
fn lines(zones: &[(f64, f64)], skew: [f64; 2]) -> Vec<f64> {
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

fn grid(xs: &[f64], ys: &[f64]) -> Vec<Cell> {
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

/// A root on a side, by the angles there.
type RootId = usize;

/// The roots on all sides, shared by the cells on both sides of them.
#[derive(Default)]
struct Sides {
    roots: Vec<[f64; 2]>,
    known: HashMap<(usize, u64, u64, u64), Vec<RootId>>,
}

/// A line's name: lines a period apart are the same.
fn key(x: f64, first: f64) -> u64 {
    let y = if x >= first + TAU { first } else { x };
    y.to_bits()
}

/// A piece of the curve in one cell: the roots or the singular point it joins.
struct Piece {
    ends: [End; 2],
    segment: Segment,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum End {
    Root(RootId),
    /// A pass through a singular point: (point, which of its two branches).
    Pass(usize, usize),
}

/// All branches of `form` = 0 on the torus, where `form` is a distance to first order and `band`
/// the resolution.
pub fn trace(torus: &Torus, form: &BiTrig, band: f64) -> Result<Traced, Unresolved> {
    let slop = form.bound() * f64::EPSILON * 64.0;
    let tracer = Tracer {
        form,
        third: form.third(),
        slop,
        band: band.max(slop),
    };
    let points = singular_points(&tracer)?;
    let mut shrink = 1.0;
    let mut failed = None;
    for attempt in 0..ATTEMPTS {
        match tracer.assemble(torus, &points, shrink, SKEWS[attempt % SKEWS.len()]) {
            Ok(traced) => return Ok(traced),
            Err(e) => failed = failed.or(Some(e)),
        }
        shrink *= 0.5;
    }
    let angles = points.first().map_or([0.0; 2], |p| p.angles);
    Err(failed.unwrap_or(Unresolved { angles }))
}

/// How often smaller zones are tried.
const ATTEMPTS: usize = 9;
/// How far the sides of a zone lie from its point, as parts of its size: low and high, along both
/// angles.
const SKEWS: [[[f64; 2]; 2]; 3] = [
    [[0.913_7, 1.0], [0.871_3, 0.761_9]],
    [[0.731_1, 0.653_7], [1.0, 0.941_7]],
    [[1.0, 0.831_9], [0.537_1, 0.611_3]],
];

impl Tracer<'_> {
    fn assemble(
        &self,
        torus: &Torus,
        points: &[SingularPoint],
        shrink: f64,
        skew: [[f64; 2]; 2],
    ) -> Result<Traced, Unresolved> {
        let zones = |k: usize| -> Vec<(f64, f64)> {
            let zone = |p: &SingularPoint| (p.angles[k], p.zone * shrink);
            points.iter().map(zone).collect()
        };
        let (xs, ys) = (lines(&zones(0), skew[0]), lines(&zones(1), skew[1]));
        let cells = grid(&xs, &ys);
        let home = |c: &Cell| {
            points
                .iter()
                .position(|p| near(&c.centre(), &p.angles, 0.9 * p.zone * shrink))
        };
        let (own, free): (Vec<Cell>, Vec<Cell>) =
            cells.into_iter().partition(|c| home(c).is_some());
        if own.len() != points.len() {
            return Err(Unresolved {
                angles: points.first().map_or([0.0; 2], |p| p.angles),
            });
        }
        let leaves = self.leaves(free)?;
        let mut sides = Sides::default();
        let corners = corners(leaves.iter().map(|l| &l.0).chain(&own), xs[0], ys[0]);
        let mut pieces = Vec::new();
        let origin = [xs[0], ys[0]];
        for (cell, axis) in &leaves {
            let roots = self.around(cell, &corners, origin, &mut sides)?;
            self.join(cell, *axis, roots, &mut pieces)?;
        }
        let mut isolated = Vec::new();
        for cell in &own {
            let Some(i) = home(cell) else { continue };
            let roots = self.around(cell, &corners, origin, &mut sides)?;
            let angles = points[i].angles;
            match (roots.len(), &points[i].contact) {
                (0, Kind::Isolated) => isolated.push(i),
                (4, Kind::Crossing(directions)) => {
                    self.cross(i, &angles, directions, &roots, &mut pieces)?;
                }
                (4, Kind::Tacnode(direction)) => {
                    self.kiss(i, &angles, direction, &roots, &mut pieces)?;
                }
                _ => return Err(Unresolved { angles }),
            }
        }
        chain(torus, self.form, points, pieces)
    }

    /// The roots around a cell: (id, angles next to the cell).
    fn around(
        &self,
        cell: &Cell,
        corners: &Corners,
        origin: [f64; 2],
        sides: &mut Sides,
    ) -> Result<Vec<(RootId, [f64; 2])>, Unresolved> {
        let mut all = Vec::new();
        for fixed in [0, 1] {
            let other = 1 - fixed;
            for at in [cell.lo[fixed], cell.hi[fixed]] {
                let name = key(at, origin[fixed]);
                let marks = corners.between(fixed, name, cell.lo[other], cell.hi[other]);
                for pair in marks.windows(2) {
                    let id = (fixed, name, pair[0].to_bits(), pair[1].to_bits());
                    if !sides.known.contains_key(&id) {
                        let roots =
                            self.roots_on(fixed, at, pair[0], pair[1])
                                .ok_or(Unresolved {
                                    angles: cell.centre(),
                                })?;
                        let ids = roots.into_iter().map(|t| {
                            sides.roots.push(if fixed == 0 { [at, t] } else { [t, at] });
                            sides.roots.len() - 1
                        });
                        let ids = ids.collect();
                        sides.known.insert(id, ids);
                    }
                    for &root in &sides.known[&id] {
                        let mut p = sides.roots[root];
                        p[fixed] = at;
                        all.push((root, p));
                    }
                }
            }
        }
        Ok(all)
    }

    /// Joins the roots around a cell in which the curve is a graph.
    fn join(
        &self,
        cell: &Cell,
        axis: Axis,
        mut roots: Vec<(RootId, [f64; 2])>,
        pieces: &mut Vec<Piece>,
    ) -> Result<(), Unresolved> {
        let k = if axis == Axis::Around { 0 } else { 1 };
        roots.sort_by(|a, b| a.1[k].total_cmp(&b.1[k]));
        if roots.len() % 2 == 1 {
            return Err(Unresolved {
                angles: cell.centre(),
            });
        }
        for pair in roots.chunks(2) {
            let (p, q) = (pair[0].1, pair[1].1);
            let slope = |p: [f64; 2]| {
                let g = self.form.partials(p[0], p[1]);
                if k == 0 { -g.x / g.y } else { -g.y / g.x }
            };
            let segment = Segment {
                axis,
                from: p[k],
                to: q[k],
                ends: [p[1 - k], q[1 - k]],
                slopes: [slope(p), slope(q)],
                steep: STEEP,
                bracket: [cell.lo[1 - k], cell.hi[1 - k]],
                node: None,
            };
            pieces.push(Piece {
                ends: [End::Root(pair[0].0), End::Root(pair[1].0)],
                segment,
            });
        }
        Ok(())
    }

    /// Joins the four roots around a crossing to its two branches.
    fn cross(
        &self,
        index: usize,
        point: &[f64; 2],
        directions: &[[f64; 2]; 2],
        roots: &[(RootId, [f64; 2])],
        pieces: &mut Vec<Piece>,
    ) -> Result<(), Unresolved> {
        let mut used = [[false; 2]; 2];
        for (root, p) in roots {
            let away = [wrap(p[0] - point[0]), wrap(p[1] - point[1])];
            let length = away[0].hypot(away[1]);
            let along = |d: &[f64; 2]| (away[0] * d[0] + away[1] * d[1]) / length;
            let b = usize::from(along(&directions[1]).abs() > along(&directions[0]).abs());
            let d = directions[b];
            let forward = usize::from(along(&d) > 0.0);
            if used[b][forward] {
                return Err(Unresolved { angles: *point });
            }
            used[b][forward] = true;
            let segment = self.node_segment(index, point, &d, p);
            pieces.push(Piece {
                ends: [End::Pass(index, b), End::Root(*root)],
                segment,
            });
        }
        Ok(())
    }

    /// Joins the four roots around a tacnode to its two branches: they keep their order across the
    /// common `direction`.
    fn kiss(
        &self,
        index: usize,
        point: &[f64; 2],
        direction: &[f64; 2],
        roots: &[(RootId, [f64; 2])],
        pieces: &mut Vec<Piece>,
    ) -> Result<(), Unresolved> {
        let d = direction;
        let mut sides: [Vec<(f64, usize)>; 2] = Default::default();
        for (i, (_, p)) in roots.iter().enumerate() {
            let away = [wrap(p[0] - point[0]), wrap(p[1] - point[1])];
            let along = away[0] * d[0] + away[1] * d[1];
            let across = away[1] * d[0] - away[0] * d[1];
            sides[usize::from(along > 0.0)].push((across, i));
        }
        for side in &mut sides {
            if side.len() != 2 {
                return Err(Unresolved { angles: *point });
            }
            side.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (b, &(_, i)) in side.iter().enumerate() {
                let (root, p) = &roots[i];
                pieces.push(Piece {
                    ends: [End::Pass(index, b), End::Root(*root)],
                    segment: self.node_segment(index, point, d, p),
                });
            }
        }
        Ok(())
    }

    /// The graph from a node, left in the direction `d`, to a root around it.
    fn node_segment(&self, index: usize, point: &[f64; 2], d: &[f64; 2], p: &[f64; 2]) -> Segment {
        let away = [wrap(p[0] - point[0]), wrap(p[1] - point[1])];
        let k = usize::from(d[1].abs() > d[0].abs());
        let g = self.form.partials(p[0], p[1]);
        let slope = if k == 0 { -g.x / g.y } else { -g.y / g.x };
        Segment {
            axis: if k == 0 { Axis::Around } else { Axis::Tube },
            from: point[k],
            to: point[k] + away[k],
            ends: [point[1 - k], point[1 - k] + away[1 - k]],
            slopes: [d[1 - k] / d[k], slope],
            steep: 2.0 * STEEP,
            bracket: [f64::NEG_INFINITY, f64::INFINITY],
            node: Some(index),
        }
    }
}

/// The corners of cells on every line of the grid.
struct Corners {
    on: [HashMap<u64, Vec<f64>>; 2],
}

fn corners<'a>(cells: impl Iterator<Item = &'a Cell>, x0: f64, y0: f64) -> Corners {
    let mut on: [HashMap<u64, Vec<f64>>; 2] = Default::default();
    for c in cells {
        for fixed in [0, 1] {
            let first = if fixed == 0 { x0 } else { y0 };
            for at in [c.lo[fixed], c.hi[fixed]] {
                let list = on[fixed].entry(key(at, first)).or_default();
                list.push(c.lo[1 - fixed]);
                list.push(c.hi[1 - fixed]);
            }
        }
    }
    for list in on.iter_mut().flat_map(|m| m.values_mut()) {
        list.sort_by(f64::total_cmp);
        list.dedup();
    }
    Corners { on }
}

impl Corners {
    fn between(&self, fixed: usize, name: u64, lo: f64, hi: f64) -> Vec<f64> {
        let list = self.on[fixed].get(&name).map_or(&[][..], Vec::as_slice);
        list.iter()
            .copied()
            .filter(|v| *v >= lo && *v <= hi)
            .collect()
    }
}

/// Pieces joined to closed branches.
fn chain(
    torus: &Torus,
    form: &BiTrig,
    points: &[SingularPoint],
    pieces: Vec<Piece>,
) -> Result<Traced, Unresolved> {
    let mut at: BTreeMap<(usize, usize, usize), Vec<usize>> = BTreeMap::new();
    let name = |e: &End| match *e {
        End::Root(r) => (0, r, 0),
        End::Pass(p, b) => (1, p, b),
    };
    for (i, p) in pieces.iter().enumerate() {
        for e in &p.ends {
            at.entry(name(e)).or_default().push(i);
        }
    }
    if let Some((_, list)) = at.iter().find(|(_, l)| l.len() != 2) {
        let s = &pieces[list[0]].segment;
        return Err(Unresolved {
            angles: [s.from, s.ends[0]],
        });
    }
    let mut singular: Vec<Singular> = points
        .iter()
        .map(|p| Singular {
            angles: p.angles,
            on: Vec::new(),
        })
        .collect();
    let locals: Vec<Local> = points
        .iter()
        .map(|p| Local::about(form, p.angles))
        .collect();
    let mut used = vec![false; pieces.len()];
    let mut branches = Vec::new();
    for start in 0..pieces.len() {
        if used[start] {
            continue;
        }
        let mut segments = Vec::new();
        let (mut here, mut entry) = (start, pieces[start].ends[0]);
        while !used[here] {
            used[here] = true;
            let p = &pieces[here];
            let forward = p.ends[0] == entry;
            if let End::Pass(s, _) = entry {
                singular[s].on.push((branches.len(), segments.len() as f64));
            }
            segments.push(if forward {
                p.segment
            } else {
                p.segment.reversed()
            });
            entry = if forward { p.ends[1] } else { p.ends[0] };
            let pair = &at[&name(&entry)];
            here = if pair[0] == here { pair[1] } else { pair[0] };
        }
        branches.push(Toric {
            torus: *torus,
            form: form.clone(),
            nodes: locals.clone(),
            segments,
            closed: true,
        });
    }
    Ok(Traced { branches, singular })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::frame::Frame;
    use crate::geometry::surface::{Cylinder, Plane, Surface};
    use nalgebra::{Point3, Vector3};

    fn traced(surface: &Surface, major: f64, minor: f64) -> Traced {
        let torus = Torus {
            frame: Frame::world(),
            major,
            minor,
        };
        let form = BiTrig::interpolate(|x, y| {
            let p = Surface::Torus(torus).point(x, y);
            surface.level([p.x, p.y, p.z])
        });
        let traced = trace(&torus, &form, 1e-11).unwrap();
        for b in &traced.branches {
            for i in 0..(10 * b.segments.len()) {
                let p = b.point(i as f64 / 10.0);
                assert!(
                    surface.distance(&p).abs() < 1e-12,
                    "{}",
                    surface.distance(&p)
                );
            }
            for i in 0..b.segments.len() {
                let t = i as f64;
                let gap = (b.point(t + 1e-12) - b.point(t - 1e-12)).norm();
                assert!(gap < 1e-9, "gap {gap} at {t}");
            }
        }
        traced
    }

    fn plane(n: Vector3<f64>, d: f64) -> Surface {
        let n = n.normalize();
        Surface::Plane(Plane {
            frame: Frame::about(Point3::from(n * d), n),
        })
    }

    #[test]
    fn a_spiric_section_has_one_or_two_ovals_or_a_node() {
        // x = d across a torus (3, 1): two ovals for d < 2, a lemniscate at 2, one oval above.
        for (d, branches, singular) in [(0.7, 2, 0), (2.0, 1, 1), (2.5, 1, 0), (3.999, 1, 0)] {
            let t = traced(&plane(Vector3::x(), d), 3.0, 1.0);
            assert_eq!(
                (t.branches.len(), t.singular.len()),
                (branches, singular),
                "d = {d}"
            );
        }
        assert_eq!(
            traced(&plane(Vector3::x(), 4.0), 3.0, 1.0).singular.len(),
            1
        );
        assert!(
            traced(&plane(Vector3::x(), 4.001), 3.0, 1.0)
                .branches
                .is_empty()
        );
    }

    #[test]
    fn a_near_node_splits_on_either_side() {
        assert_eq!(
            traced(&plane(Vector3::x(), 2.0 - 1e-9), 3.0, 1.0)
                .branches
                .len(),
            2
        );
        assert_eq!(
            traced(&plane(Vector3::x(), 2.0 + 1e-9), 3.0, 1.0)
                .branches
                .len(),
            1
        );
    }

    #[test]
    fn a_cylinder_through_the_ring() {
        // Along x through the whole ring: into and out of the tube twice.
        let frame = Frame::about(Point3::origin(), Vector3::x());
        let c = Surface::Cylinder(Cylinder { frame, radius: 0.5 });
        assert_eq!(traced(&c, 3.0, 1.0).branches.len(), 4);
        // Parallel to the axis, as wide as the tube and centred on the spine: nodes on both equators.
        let frame = Frame::about(Point3::new(5.0, 0.0, 0.0), Vector3::z());
        let c = Surface::Cylinder(Cylinder { frame, radius: 1.5 });
        assert_eq!(traced(&c, 5.0, 1.5).singular.len(), 2);
    }
}
