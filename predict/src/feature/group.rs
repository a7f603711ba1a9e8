//! Groups of arcs: boundaries of regions, chains, triplets.

use super::junction::{JunctionForm, Nodes, PredictedJunction};
use crate::image_arcs::arc::ArcSide;
use crate::image_arcs::{PredictedArc, Regions};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// A boundary of a region.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct BoundaryGroup {
    /// Its arcs, in order; the region is to their left.
    pub arcs: Vec<u32>,
    /// Whether it is closed.
    pub closed: bool,
    /// Whether the region is outside of it.
    pub hole: bool,
}

/// A section of an arc on its way around a region.
#[derive(Clone, Copy, Debug)]
struct Step {
    section: u32,
    arc: u32,
    /// Whether it has the direction of the arc.
    along: bool,
    from: u32,
    to: u32,
    /// The directions in which it leaves and arrives.
    angles: [f64; 2],
}

/// By region: its boundaries.
pub(crate) fn boundaries(
    arcs: &[PredictedArc],
    nodes: &Nodes,
    regions: &Regions,
) -> Vec<Vec<BoundaryGroup>> {
    let mut steps: Vec<Vec<Step>> = vec![Vec::new(); regions.all.len()];
    for (i, arc) in arcs.iter().enumerate() {
        for (slot, section) in regions.sections.of_arc(i).enumerate() {
            let ends = [nodes.of_arcs[i][slot], nodes.of_arcs[i][slot + 1]];
            for (on, along) in [(ArcSide::Left, true), (ArcSide::Right, false)] {
                let region = regions.adjacent(section, on) as usize;
                steps[region].push(step(arc, i, section, ends, along, regions));
            }
        }
    }
    steps
        .into_iter()
        .map(|steps| walks(arcs, &steps, regions))
        .collect()
}

fn step(
    arc: &PredictedArc,
    number: usize,
    section: u32,
    ends: [u32; 2],
    along: bool,
    regions: &Regions,
) -> Step {
    let [from, to] = regions.sections.all[section as usize].ends;
    let points = &arc.line.points;
    let angle = |a: usize, b: usize| {
        let [p, q] = [points[a], points[b]];
        (q[1] - p[1]).atan2(q[0] - p[0])
    };
    let (from, to, ends) = match along {
        true => (from, to, ends),
        false => (to, from, [ends[1], ends[0]]),
    };
    let next = |k: usize, towards: usize| if towards > k { k + 1 } else { k - 1 };
    Step {
        section,
        arc: number as u32,
        along,
        from: ends[0],
        to: ends[1],
        angles: [angle(from, next(from, to)), angle(next(to, from), to)],
    }
}

/// The closed and open walks formed by steps with the region on their left.
fn walks(arcs: &[PredictedArc], steps: &[Step], regions: &Regions) -> Vec<BoundaryGroup> {
    let mut at_node: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (i, step) in steps.iter().enumerate() {
        at_node.entry(step.from).or_default().push(i);
    }
    let mut used = vec![false; steps.len()];
    let mut found = Vec::new();
    for start in 0..steps.len() {
        if used[start] {
            continue;
        }
        let mut walk = vec![start];
        used[start] = true;
        loop {
            let step = &steps[walk[walk.len() - 1]];
            let open = at_node.get(&step.to).into_iter().flatten().copied();
            let next = open
                .filter(|&i| !used[i])
                .min_by(|&a, &b| turn(step, &steps[a]).total_cmp(&turn(step, &steps[b])));
            let back = steps[start].from == step.to;
            match next {
                // The walk closes where the turn back to its start is less than to any other step.
                Some(i) if !back || turn(step, &steps[i]) < turn(step, &steps[start]) => {
                    used[i] = true;
                    walk.push(i);
                }
                _ => break,
            }
        }
        found.push(boundary(arcs, steps, &walk, regions));
    }
    found
}

/// The angle by which a step turns from the reverse of the previous one, counterclockwise on the
/// page. The region on the left lies between the two, so the next step is the first one found
/// turning clockwise.
fn turn(before: &Step, after: &Step) -> f64 {
    let back = before.angles[1] + std::f64::consts::PI;
    // Angles grow clockwise, because y points down.
    let turned = (after.angles[0] - back).rem_euclid(std::f64::consts::TAU);
    match before.section == after.section && before.along != after.along {
        true => std::f64::consts::TAU,
        false => turned,
    }
}

fn boundary(
    arcs: &[PredictedArc],
    steps: &[Step],
    walk: &[usize],
    regions: &Regions,
) -> BoundaryGroup {
    let mut own: Vec<u32> = Vec::new();
    let mut twice_area = 0.0;
    for &i in walk {
        let step = &steps[i];
        if own.last() != Some(&step.arc) {
            own.push(step.arc);
        }
        let [from, to] = regions.sections.all[step.section as usize].ends;
        let sum: f64 = arcs[step.arc as usize].line.points[from..=to]
            .windows(2)
            .map(|w| w[0][0] * w[1][1] - w[0][1] * w[1][0])
            .sum();
        twice_area += if step.along { sum } else { -sum };
    }
    let (first, last) = (&steps[walk[0]], &steps[walk[walk.len() - 1]]);
    if own.len() > 1 && own.first() == own.last() {
        own.pop();
    }
    BoundaryGroup {
        arcs: own,
        closed: first.from == last.to,
        // Counterclockwise on a page whose y points down is a negative area.
        hole: twice_area > 0.0,
    }
}

/// A chain of consecutive arcs.
#[derive(
    Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, JsonSchema, Serialize, Deserialize,
)]
pub struct ArcChain {
    /// The arcs, in order.
    pub arcs: Vec<u32>,
    /// Whether the last is followed by the first.
    pub closed: bool,
}

/// By arc: the ends (start and end) with the junction there.
fn ends_of(count: usize, junctions: &[PredictedJunction]) -> Vec<[Option<u32>; 2]> {
    let mut ends = vec![[None; 2]; count];
    for (j, junction) in junctions.iter().enumerate() {
        let branches = &junction.branches;
        for b in branches {
            // An arc that passes through has two branches there, and no end.
            let ways = branches
                .iter()
                .filter(|o| o.arc == b.arc && o.along == b.along)
                .count();
            if ways == 1 {
                ends[b.arc as usize][usize::from(!b.leaves)] = Some(j as u32);
            }
        }
    }
    ends
}

/// The arcs other than `arc` that end in a junction.
fn others(junction: &PredictedJunction, arc: u32) -> BTreeSet<u32> {
    junction
        .branches
        .iter()
        .map(|b| b.arc)
        .filter(|a| *a != arc)
        .collect()
}

/// The longest chains of arcs through junctions of two.
pub(crate) fn chains(count: usize, junctions: &[PredictedJunction]) -> Vec<ArcChain> {
    let ends = ends_of(count, junctions);
    let next = |arc: u32, junction: Option<u32>| -> Option<u32> {
        let junction = &junctions[junction? as usize];
        match junction.form {
            JunctionForm::L | JunctionForm::Continuation => {
                others(junction, arc).into_iter().next()
            }
            _ => None,
        }
    };
    let mut used = vec![false; count];
    let mut found = Vec::new();
    for start in 0..count as u32 {
        if used[start as usize] {
            continue;
        }
        used[start as usize] = true;
        let mut line = std::collections::VecDeque::from([start]);
        let mut closed = false;
        for (side, first) in [(1, ends[start as usize][1]), (0, ends[start as usize][0])] {
            let (mut arc, mut junction) = (start, first);
            while let Some(other) = next(arc, junction) {
                if used[other as usize] {
                    closed |= line.len() > 2 && (other == line[0] || Some(&other) == line.back());
                    break;
                }
                used[other as usize] = true;
                match side {
                    1 => line.push_back(other),
                    _ => line.push_front(other),
                }
                let [a, b] = ends[other as usize];
                junction = if a == junction { b } else { a };
                arc = other;
            }
        }
        if line.len() > 1 {
            let arcs = line.into_iter().collect();
            found.push(ArcChain { arcs, closed });
        }
    }
    found
}

/// Three arcs, the middle one of which has a junction with the others at its ends (Henikoff and
/// Shapiro 1990).
pub(crate) fn triplets(count: usize, junctions: &[PredictedJunction]) -> Vec<[u32; 3]> {
    let mut found = BTreeSet::new();
    for (arc, ends) in ends_of(count, junctions).iter().enumerate() {
        let arc = arc as u32;
        let [Some(start), Some(end)] = *ends else {
            continue;
        };
        for a in others(&junctions[start as usize], arc) {
            for b in others(&junctions[end as usize], arc) {
                if a != b {
                    found.insert([a.min(b), arc, a.max(b)]);
                }
            }
        }
    }
    found.into_iter().collect()
}
