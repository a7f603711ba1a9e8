//! Joins the pieces of the curve in the cells to closed branches, through the roots on the cells'
//! sides and through the singular points.

use super::{BranchPosition, Leaf, Singular, Traced};
use crate::geometry::bivariate_trig_poly::BivariateTrigPoly;
use crate::geometry::blow_up::Chart;
use crate::geometry::singular::{BranchTangent, SingularPoint};
use crate::geometry::surface::Torus;
use crate::geometry::torus_curve::{SegmentEquation, TorusCurve, TorusCurveSegment, wrap};
use crate::geometry::torus_grid::{Cell, Layout, Zone, grid, lines};
use crate::geometry::torus_parameter::TorusParameter;
use crate::geometry::tracer::Tracer;
use crate::geometry::unresolved::Unresolved;
use crate::hash::HashMap;
use crate::number::float::{Analytic, Float};
use crate::number::interval::Interval;
use std::collections::BTreeMap;

/// A root on a side; roots are identified by their angles.
type RootId = usize;

/// The roots on all sides. Each side is shared by two cells.
#[derive(Default)]
struct Sides<N: Float = f64> {
    roots: Vec<[N; 2]>,
    known: HashMap<SideId, Vec<RootId>>,
}

/// The identity of a side.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct SideId {
    /// The index of the angle that is fixed.
    fixed: usize,
    /// The line on which it lies.
    line: Name,
    /// The corners at both ends.
    ends: [Name; 2],
}

/// A root on a side of a cell.
#[derive(Clone, Copy)]
struct CellRoot<N: Float = f64> {
    id: RootId,
    /// Its angles, close to the cell.
    angles: [N; 2],
}

/// The zones along one angle, given by its index. Zones that overlap along the angle share their
/// lines and have the size of the smallest.
fn zones<N: Float>(points: &[SingularPoint<N>], k: usize, shrink: N) -> Vec<Zone<N>> {
    let size = |p: &SingularPoint<N>| {
        let over = |q: &&SingularPoint<N>| wrap(p.angles[k] - q.angles[k]).abs() <= p.zone + q.zone;
        let sizes = points.iter().filter(over).map(|q| q.zone);
        sizes.fold(p.zone, N::min)
    };
    points
        .iter()
        .map(|p| Zone {
            centre: p.angles[k],
            size: size(p) * shrink,
        })
        .collect()
}

/// A bit pattern that identifies a number.
type Name = [u64; 4];

/// The name of a line; lines one period from each other are the same.
fn key<N: Float>(x: N, first: N) -> Name {
    let y = if x >= first + N::TAU { first } else { x };
    y.bits()
}

/// A piece of the curve in one cell, between two roots or a root and a singular point.
struct Piece<N: Float = f64> {
    ends: [End; 2],
    segment: TorusCurveSegment<N>,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum End {
    Root(RootId),
    /// The passage through a singular point.
    Pass {
        point: usize,
        /// The index of the point's branch.
        branch: usize,
    },
}

impl<N: Float> Tracer<'_, N> {
    pub(super) fn assemble(
        &self,
        torus: &Torus<N>,
        points: &[SingularPoint<N>],
        layout: &Layout<N>,
    ) -> Result<Traced<N>, Unresolved> {
        let zones = [0, 1].map(|k| zones(points, k, layout.shrink));
        let [xs, ys] = [0, 1].map(|k| lines(k, &zones[k], layout));
        let cells = grid(&xs, &ys);
        let home = |c: &Cell<N>| {
            let centre = c.centre();
            let part = N::from_f64(0.9);
            let holds = |k: usize, i: usize| zones[k][i].contains(centre[k], part);
            (0..points.len()).find(|&i| holds(0, i) && holds(1, i))
        };
        let (own, free): (Vec<Cell<N>>, Vec<Cell<N>>) =
            cells.into_iter().partition(|c| home(c).is_some());
        if own.len() != points.len() {
            return Err(Unresolved::at(
                points.first().map_or([N::ZERO; 2], |p| p.angles),
            ));
        }
        let leaves = self.leaves(free)?;
        let mut sides = Sides::default();
        let corners = corners(leaves.iter().map(|l| &l.cell).chain(&own), xs[0], ys[0]);
        let mut pieces = Vec::new();
        let origin = [xs[0], ys[0]];
        for leaf in &leaves {
            let roots = self.around(&leaf.cell, &corners, origin, &mut sides)?;
            self.join(leaf, roots, &mut pieces)?;
        }
        for cell in &own {
            let Some(i) = home(cell) else { continue };
            let roots = self.around(cell, &corners, origin, &mut sides)?;
            self.pass(points, i, &roots, &mut pieces)?;
        }
        chain(torus, self.form, points, pieces)
    }

    /// The roots around a cell.
    fn around(
        &self,
        cell: &Cell<N>,
        corners: &Corners<N>,
        origin: [N; 2],
        sides: &mut Sides<N>,
    ) -> Result<Vec<CellRoot<N>>, Unresolved> {
        let mut all = Vec::new();
        for fixed in [0, 1] {
            let other = 1 - fixed;
            for at in [cell.lo[fixed], cell.hi[fixed]] {
                let name = key(at, origin[fixed]);
                let marks = corners.between(fixed, name, cell.lo[other], cell.hi[other]);
                for pair in marks.windows(2) {
                    let id = SideId {
                        fixed,
                        line: name,
                        ends: [pair[0].bits(), pair[1].bits()],
                    };
                    if !sides.known.contains_key(&id) {
                        let roots = self
                            .roots_on(fixed, at, pair[0], pair[1])
                            .ok_or(Unresolved::at(cell.centre()))?;
                        let ids = roots.into_iter().map(|t| {
                            sides.roots.push(if fixed == 0 { [at, t] } else { [t, at] });
                            sides.roots.len() - 1
                        });
                        let ids = ids.collect();
                        sides.known.insert(id, ids);
                    }
                    for &id in &sides.known[&id] {
                        let mut angles = sides.roots[id];
                        angles[fixed] = at;
                        all.push(CellRoot { id, angles });
                    }
                }
            }
        }
        Ok(all)
    }

    /// Joins the roots around a cell in which the curve is a graph.
    fn join(
        &self,
        &Leaf { cell, axis, steep }: &Leaf<N>,
        mut roots: Vec<CellRoot<N>>,
        pieces: &mut Vec<Piece<N>>,
    ) -> Result<(), Unresolved> {
        let k = if axis == TorusParameter::Around { 0 } else { 1 };
        roots.sort_by(|a, b| a.angles[k].total_cmp(&b.angles[k]));
        if roots.len() % 2 == 1 {
            return Err(Unresolved::at(cell.centre()));
        }
        for pair in roots.chunks(2) {
            let (p, q) = (pair[0].angles, pair[1].angles);
            let slope = |p: [N; 2]| {
                let g = self.form.partials(p[0], p[1]);
                if k == 0 { -g.x / g.y } else { -g.y / g.x }
            };
            let segment = TorusCurveSegment {
                axis,
                from: p[k],
                to: q[k],
                ends: [p[1 - k], q[1 - k]],
                slopes: [slope(p), slope(q)],
                steep: N::from_f64(steep),
                bracket: [cell.lo[1 - k], cell.hi[1 - k]],
                equation: SegmentEquation::Angles,
            };
            // Close to a nearly singular point F is all rounding, and its roots are meaningless.
            if !segment.keeps_its_slope() {
                return Err(Unresolved::at(cell.centre()));
            }
            pieces.push(Piece {
                ends: [End::Root(pair[0].id), End::Root(pair[1].id)],
                segment,
            });
        }
        Ok(())
    }

    /// Joins the roots around a singular point to its branches, two to each.
    fn pass(
        &self,
        points: &[SingularPoint<N>],
        index: usize,
        roots: &[CellRoot<N>],
        pieces: &mut Vec<Piece<N>>,
    ) -> Result<(), Unresolved> {
        let point = &points[index];
        let unresolved = Unresolved::at(point.angles);
        let first: usize = points[..index].iter().map(|p| p.passes.len()).sum();
        let mut used = vec![[false; 2]; point.passes.len()];
        for CellRoot {
            id: root,
            angles: p,
        } in roots
        {
            let away = [0, 1].map(|k| wrap(p[k] - point.angles[k]));
            let all = point.passes.iter().enumerate();
            let (b, end) = all
                .map(|(b, pass)| (b, Reached::by(pass, away)))
                .min_by(|a, b| a.1.miss.total_cmp(&b.1.miss))
                .ok_or(unresolved)?;
            let forward = usize::from(end.sigma > N::ZERO);
            if std::mem::replace(&mut used[b][forward], true) {
                return Err(unresolved);
            }
            let segment = node_segment(first + b, &point.passes[b], &end).ok_or(unresolved)?;
            pieces.push(Piece {
                ends: [
                    End::Pass {
                        point: index,
                        branch: b,
                    },
                    End::Root(*root),
                ],
                segment,
            });
        }
        match used.iter().flatten().all(|u| *u) {
            true => Ok(()),
            false => Err(unresolved),
        }
    }
}

/// A root on the side of a singular point's zone, in the coordinates of a branch.
struct Reached<N: Float = f64> {
    sigma: N,
    kappa: N,
    /// The distance from the branch's leading term.
    miss: N,
}

impl<N: Float> Reached<N> {
    fn by(pass: &BranchTangent<N>, away: [N; 2]) -> Self {
        let chart = &pass.chart;
        let [s, y] = match chart.axis {
            TorusParameter::Around => away,
            TorusParameter::Tube => [away[1], away[0]],
        };
        let (sigma, kappa) = (chart.sigma(s, y), chart.kappa(s, y));
        let rise = sigma.powi(chart.weights.rise as i32).abs();
        let miss = (kappa - pass.kappa).abs() * rise;
        Self {
            sigma,
            kappa,
            miss: if miss.is_finite() { miss } else { N::INFINITY },
        }
    }
}

/// The graph of κ from a singular point to a root around it; `None` if it is not proven to be the
/// only one.
fn node_segment<N: Float>(
    index: usize,
    pass: &BranchTangent<N>,
    end: &Reached<N>,
) -> Option<TorusCurveSegment<N>> {
    let chart = &pass.chart;
    let slope = |sigma: N, kappa: N| {
        let g = chart.partials(sigma, kappa);
        -g.x / g.y
    };
    let (from, to) = (pass.kappa, end.kappa);
    let slopes = [slope(N::ZERO, from), slope(end.sigma, to)];
    let run = Interval::new(N::ZERO, end.sigma);
    let steepest = slopes[0].abs().max(slopes[1].abs());
    // A bracket that the graph cannot leave with the slopes that are possible inside.
    let mut margin = (to - from).abs().max(steepest * end.sigma.abs());
    for _ in 0..BRACKETS {
        margin = N::TWO * margin + N::ROUNDING.sqrt();
        let bracket = Interval::new(from - margin, from + margin);
        let g = chart.partials_over(run, bracket);
        if g.y.has_zero() {
            return None;
        }
        let steep = g.x.over(g.y).magnitude();
        let reach = steep * end.sigma.abs();
        if reach <= margin {
            return Some(TorusCurveSegment {
                axis: chart.axis,
                from: N::ZERO,
                to: end.sigma,
                ends: [from, to],
                slopes,
                steep,
                bracket: [bracket.lo, bracket.hi],
                equation: SegmentEquation::Chart(index),
            });
        }
        // The bounds of the slopes may be much larger than the slopes.
        margin = margin.max(reach);
    }
    None
}

/// The number of times that a wider bracket is tried.
const BRACKETS: u32 = 6;

/// The corners of cells on every line of the grid.
struct Corners<N: Float = f64> {
    on: [HashMap<Name, Vec<N>>; 2],
}

fn corners<'a, N: Float>(cells: impl Iterator<Item = &'a Cell<N>>, x0: N, y0: N) -> Corners<N> {
    let mut on: [HashMap<Name, Vec<N>>; 2] = Default::default();
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
        list.sort_by(N::total_cmp);
        list.dedup();
    }
    Corners { on }
}

impl<N: Float> Corners<N> {
    fn between(&self, fixed: usize, name: Name, lo: N, hi: N) -> Vec<N> {
        let list = self.on[fixed].get(&name).map_or(&[][..], Vec::as_slice);
        list.iter()
            .copied()
            .filter(|v| *v >= lo && *v <= hi)
            .collect()
    }
}

/// The two pieces at every end.
fn joints<N: Float>(pieces: &[Piece<N>]) -> Result<BTreeMap<End, [usize; 2]>, Unresolved> {
    let mut at: BTreeMap<End, Vec<usize>> = BTreeMap::new();
    for (i, p) in pieces.iter().enumerate() {
        for end in p.ends {
            at.entry(end).or_default().push(i);
        }
    }
    let pair = |(end, list): (End, Vec<usize>)| match list[..] {
        [a, b] => Ok((end, [a, b])),
        _ => {
            let s = &pieces[list[0]].segment;
            Err(Unresolved::at([s.from, s.ends[0]]))
        }
    };
    at.into_iter().map(pair).collect()
}

/// A piece of a branch in the direction of the branch.
struct Link<N: Float = f64> {
    /// Where it begins.
    entry: End,
    segment: TorusCurveSegment<N>,
}

/// The closed branch that begins with a piece; its pieces are marked as used.
fn links<N: Float>(
    pieces: &[Piece<N>],
    joints: &BTreeMap<End, [usize; 2]>,
    start: usize,
    used: &mut [bool],
) -> Vec<Link<N>> {
    let mut links = Vec::new();
    let (mut here, mut entry) = (start, pieces[start].ends[0]);
    while !used[here] {
        used[here] = true;
        let p = &pieces[here];
        let forward = p.ends[0] == entry;
        let segment = match forward {
            true => p.segment,
            false => p.segment.reversed(),
        };
        links.push(Link { entry, segment });
        entry = if forward { p.ends[1] } else { p.ends[0] };
        let pair = joints[&entry];
        here = if pair[0] == here { pair[1] } else { pair[0] };
    }
    links
}

/// Pieces joined to closed branches.
fn chain<N: Float>(
    torus: &Torus<N>,
    form: &BivariateTrigPoly<N>,
    points: &[SingularPoint<N>],
    pieces: Vec<Piece<N>>,
) -> Result<Traced<N>, Unresolved> {
    let joints = joints(&pieces)?;
    let mut singular: Vec<Singular<N>> = points
        .iter()
        .map(|p| Singular {
            angles: p.angles,
            on: Vec::new(),
        })
        .collect();
    let passes = points.iter().flat_map(|p| &p.passes);
    let charts: Vec<Chart<N>> = passes.map(|p| p.chart.clone()).collect();
    let mut used = vec![false; pieces.len()];
    let mut branches = Vec::new();
    for start in 0..pieces.len() {
        if used[start] {
            continue;
        }
        let links = links(&pieces, &joints, start, &mut used);
        for (index, link) in links.iter().enumerate() {
            if let End::Pass { point, .. } = link.entry {
                singular[point].on.push(BranchPosition {
                    branch: branches.len(),
                    t: N::from_f64(index as f64),
                });
            }
        }
        branches.push(TorusCurve {
            torus: *torus,
            form: form.clone(),
            extended_form: None,
            charts: charts.clone(),
            segments: links.into_iter().map(|link| link.segment).collect(),
            closed: true,
        });
    }
    Ok(Traced {
        branches,
        singular,
        ..Traced::default()
    })
}
