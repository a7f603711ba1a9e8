//! The pieces of the curve in the cells, joined to closed branches through the roots on the sides
//! of the cells and through the singular points.

use super::grid::{Cell, grid, lines};
use super::{STEEP, Singular, Traced, Tracer, Unresolved, near};
use crate::geometry::bitrig::{BiTrig, Local};
use crate::geometry::singular::{Contact as Kind, SingularPoint};
use crate::geometry::surface::Torus;
use crate::geometry::toric::{Axis, Segment, Toric, wrap};
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::TAU;

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

impl Tracer<'_> {
    pub(super) fn assemble(
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
