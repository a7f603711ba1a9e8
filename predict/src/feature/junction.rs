//! Junctions of arcs in the image.

use super::arc_raster::ArcRaster;
use super::detected_arc::DetectedArc;
use crate::image_arcs::PredictedArc;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// The distance, in pixels, within which ends of arcs are one point.
const ONE: f64 = 1.0 / 16.0;
/// The length along a branch at which its direction is evaluated, in pixels.
const TURN: f64 = 3.0;
/// The greatest angle between two branches that count as collinear.
const STRAIGHT: f64 = PI / 15.0;
/// The greatest distance, in pixels, of the end of a found branch from its junction, in addition to
/// the detector's margin.
pub(crate) const NEAR: f64 = 3.0;

/// The form of a junction.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, JsonSchema, Serialize, Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum JunctionForm {
    /// One arc ends.
    End,
    /// Two arcs continue each other.
    Continuation,
    /// Two arcs at an angle.
    L,
    /// Three, two of them collinear.
    T,
    /// Three that lie within half a turn.
    Arrow,
    /// Three that do not.
    Y,
    /// More.
    Multi,
}

/// A branch of a junction.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct JunctionBranch {
    /// The arc.
    pub arc: u32,
    /// The length along the arc at which it leaves the junction, in pixels.
    pub along: f64,
    /// Whether the arc's direction is away from the junction.
    pub leaves: bool,
    /// Its direction in the image, in radians, y down.
    pub angle: f64,
    /// Whether the detector found the arc up to the junction.
    pub found: bool,
}

/// A junction of arcs.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct PredictedJunction {
    /// Its position in pixels.
    pub at: [f64; 2],
    /// Its form.
    pub form: JunctionForm,
    /// Its branches, by angle.
    pub branches: Vec<JunctionBranch>,
}

impl PredictedJunction {
    /// Whether the detector found all branches up to the junction.
    pub(crate) fn is_found(&self) -> bool {
        self.branches.iter().all(|b| b.found)
    }
}

/// The nodes: the points at which sections of arcs end.
#[derive(Clone, Debug)]
pub(crate) struct Nodes {
    /// Their positions.
    pub places: Vec<[f64; 2]>,
    /// By arc: its nodes, at the start, its stops and the end.
    pub of_arcs: Vec<Vec<u32>>,
}

/// A start, a stop or an end of an arc.
struct ArcStop {
    point: [f64; 2],
    /// The index of the arc.
    arc: usize,
    /// The place among the arc's nodes.
    slot: usize,
}

impl Nodes {
    /// The nodes of arcs.
    pub fn new(arcs: &[PredictedArc]) -> Self {
        let mut ends: Vec<ArcStop> = Vec::new();
        for (i, arc) in arcs.iter().enumerate() {
            let last = arc.line.points.len() - 1;
            for (slot, &k) in [0].iter().chain(&arc.stops).chain([&last]).enumerate() {
                ends.push(ArcStop {
                    point: arc.line.points[k],
                    arc: i,
                    slot,
                });
            }
        }
        ends.sort_by(|a, b| {
            let [p, q] = [a.point, b.point];
            p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1]))
        });
        let mut nodes = Self {
            places: Vec::new(),
            of_arcs: arcs
                .iter()
                .map(|arc| vec![0; arc.stops.len() + 2])
                .collect(),
        };
        let mut first = 0;
        for ArcStop {
            point: p,
            arc,
            slot,
        } in ends
        {
            while nodes.places.get(first).is_some_and(|q| q[0] < p[0] - ONE) {
                first += 1;
            }
            let near = |q: &[f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]) <= ONE;
            let known = nodes.places[first..]
                .iter()
                .position(near)
                .map(|k| first + k);
            let node = known.unwrap_or_else(|| {
                nodes.places.push(p);
                nodes.places.len() - 1
            });
            nodes.of_arcs[arc][slot] = node as u32;
        }
        nodes
    }
}

/// The junctions of the arcs that may be found.
pub(crate) fn junctions(
    arcs: &[PredictedArc],
    nodes: &Nodes,
    evidence: &[DetectedArc],
    ink: &ArcRaster,
    margin: f64,
) -> Vec<PredictedJunction> {
    let mut branches: Vec<Vec<JunctionBranch>> = vec![Vec::new(); nodes.places.len()];
    for (i, arc) in arcs.iter().enumerate().filter(|(_, arc)| !arc.smooth) {
        let last = arc.line.points.len() - 1;
        let places: Vec<usize> = [0]
            .into_iter()
            .chain(arc.stops.iter().copied())
            .chain([last])
            .collect();
        let closed = nodes.of_arcs[i][0] == nodes.of_arcs[i][places.len() - 1];
        for (slot, &k) in places.iter().enumerate() {
            if closed && places.len() == 2 {
                continue;
            }
            let node = nodes.of_arcs[i][slot] as usize;
            let ways = [(k < last, 1i64), (k > 0, -1)];
            for (_, way) in ways.into_iter().filter(|w| w.0) {
                branches[node].push(branch(arc, i, k, way, &evidence[i], margin));
            }
        }
    }
    let [width, height] = ink.size();
    let inside = |p: &[f64; 2]| {
        p[0] > -0.5 && p[1] > -0.5 && p[0] < width as f64 - 0.5 && p[1] < height as f64 - 0.5
    };
    let all = nodes.places.iter().zip(branches);
    all.filter(|(p, branches)| inside(p) && !branches.is_empty())
        .map(|(&at, mut branches)| {
            branches.sort_by(|a, b| a.angle.total_cmp(&b.angle).then(a.arc.cmp(&b.arc)));
            let form = form(&branches);
            PredictedJunction { at, form, branches }
        })
        .collect()
}

fn branch(
    arc: &PredictedArc,
    number: usize,
    k: usize,
    way: i64,
    found: &DetectedArc,
    margin: f64,
) -> JunctionBranch {
    let points = &arc.line.points;
    let p = points[k];
    let mut towards = p;
    let mut i = k as i64;
    while (towards[0] - p[0]).hypot(towards[1] - p[1]) < TURN {
        i += way;
        match points.get(i as usize) {
            Some(&q) if i >= 0 => towards = q,
            _ => break,
        }
    }
    let step = |w: &[[f64; 2]]| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1]);
    let along: f64 = points[..=k].windows(2).map(step).sum();
    let reaches = |f: &super::Fragment| {
        let end = if way > 0 { f.along[0] } else { f.along[1] };
        (end - along).abs() <= margin + NEAR
    };
    JunctionBranch {
        arc: number as u32,
        along,
        leaves: way > 0,
        angle: (towards[1] - p[1]).atan2(towards[0] - p[0]),
        // A branch that leaves in the middle of a fragment is found, too.
        found: found
            .fragments
            .iter()
            .any(|f| reaches(f) || f.along[0] <= along && along <= f.along[1]),
    }
}

/// The form of a junction with branches in the order of their angles.
fn form(branches: &[JunctionBranch]) -> JunctionForm {
    let angle = |i: usize| branches[i].angle;
    let between = |i: usize, j: usize| {
        let d = (angle(j) - angle(i)).rem_euclid(TAU);
        d.min(TAU - d)
    };
    let straight = |i: usize, j: usize| PI - between(i, j) <= STRAIGHT;
    match branches.len() {
        0 | 1 => JunctionForm::End,
        2 if straight(0, 1) => JunctionForm::Continuation,
        2 => JunctionForm::L,
        3 if straight(0, 1) || straight(1, 2) || straight(0, 2) => JunctionForm::T,
        3 => {
            let gaps = [0, 1, 2].map(|i| (angle((i + 1) % 3) - angle(i)).rem_euclid(TAU));
            match gaps.iter().any(|gap| *gap > PI) {
                true => JunctionForm::Arrow,
                false => JunctionForm::Y,
            }
        }
        _ => JunctionForm::Multi,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(degrees: &[f64]) -> JunctionForm {
        let branch = |d: &f64| JunctionBranch {
            arc: 0,
            along: 0.0,
            leaves: true,
            angle: d.to_radians(),
            found: false,
        };
        form(&degrees.iter().map(branch).collect::<Vec<_>>())
    }

    #[test]
    fn angles_determine_forms() {
        assert_eq!(of(&[10.0]), JunctionForm::End);
        assert_eq!(of(&[-175.0, 0.0]), JunctionForm::Continuation);
        assert_eq!(of(&[-90.0, 0.0]), JunctionForm::L);
        assert_eq!(of(&[-90.0, 0.0, 91.0]), JunctionForm::T);
        assert_eq!(of(&[-90.0, 30.0, 150.0]), JunctionForm::Y);
        assert_eq!(of(&[-40.0, 0.0, 40.0]), JunctionForm::Arrow);
        assert_eq!(of(&[-179.0, -140.0, 140.0]), JunctionForm::Arrow);
        assert_eq!(of(&[-90.0, 0.0, 90.0, 180.0]), JunctionForm::Multi);
    }
}
