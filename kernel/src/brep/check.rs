//! The checker of boundary representations: one named violation for each rule.

use super::Brep;
use super::cycle_space;
use super::disjoint_union::Renumbering;
use super::end_gaps::{EndGap, gaps_at_ends};
use super::face_integrals::{FaceArea, FaceDifference, FaceIntegrals};
use super::topology::{CoedgeId, EdgeId, FaceId, LoopId, Sense, ShellId, TouchId, VertexId};
use crate::geometry::surface::Surface;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::Point3;
use std::collections::BTreeMap;

/// A rule that a boundary breaks.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Violation {
    /// The end of a coedge is not the start of the next.
    #[error("loop {} is open after its coedge {}", ring.0, after.0)]
    LoopOpen {
        /// The loop.
        ring: LoopId,
        /// The coedge whose end is not connected.
        after: CoedgeId,
    },
    /// A loop is not a sum of the cycles of its face's boundary.
    #[error("loop {} is not a sum of cycles", ring.0)]
    LoopNoCycle {
        /// The loop.
        ring: LoopId,
    },
    /// An edge is not used in pairs of opposite direction.
    #[error("edge {} is not used in opposite pairs", edge.0)]
    EdgeUse {
        /// The edge.
        edge: EdgeId,
    },
    /// An edge does not end at its vertex.
    #[error("edge {} ends {distance:e} away from vertex {}", edge.0, vertex.0)]
    EdgeEnd {
        /// The edge.
        edge: EdgeId,
        /// The vertex.
        vertex: VertexId,
        /// The distance, in the part's unit.
        distance: f64,
    },
    /// An edge leaves the surface of one of its faces.
    #[error("edge {} lies {distance:e} off face {}", edge.0, face.0)]
    EdgeOffFace {
        /// The edge.
        edge: EdgeId,
        /// The face.
        face: FaceId,
        /// The distance, in the part's unit.
        distance: f64,
    },
    /// A point at which the boundary touches itself does not lie on the entities that meet there.
    #[error("touch {} lies {distance:e} away from the entities that meet there", touch.0)]
    TouchOff {
        /// The touch.
        touch: TouchId,
        /// The distance, in the part's unit.
        distance: f64,
    },
    /// The entities of a shell violate the Euler-Poincaré formula.
    #[error("shell {} has the Euler characteristic {euler}", shell.0)]
    Euler {
        /// The shell.
        shell: ShellId,
        /// Vertices minus edges plus the faces' characteristics. It must be even and at most two.
        euler: i32,
    },
    /// The area of a face is invalid.
    #[error("face {} has the area {area:e}", face.0)]
    Area {
        /// The face.
        face: FaceId,
        /// The area, in square units.
        area: f64,
    },
    /// The faces of one side of a closed surface are larger together than the surface. They overlap:
    /// loops of one face were taken for the loops of several.
    #[error("face {} overlaps another one: the faces of its surface have the area {area:e} of {whole:e}", face.0)]
    Overlap {
        /// The last one of the faces.
        face: FaceId,
        /// The sum of their areas, in square units.
        area: f64,
        /// The area of the surface.
        whole: f64,
    },
    /// The boundary of a face does not close in the parameters of its surface.
    #[error("the boundary of face {} is open by {defect:e} in the parameters of its surface", face.0)]
    Closure {
        /// The face.
        face: FaceId,
        /// The defect: an angle in radians, or a length relative to the part's size.
        defect: f64,
    },
    /// The integrals over a face depend on how its edges are divided.
    #[error("face {} has the area {} or {}, depending on the division of its edges", face.0, areas[0], areas[1])]
    Integral {
        /// The face.
        face: FaceId,
        /// Its area by either division, in square units.
        areas: [f64; 2],
    },
    /// A shell is turned inside out.
    #[error("shell {} encloses the volume {volume:e}", shell.0)]
    Orientation {
        /// The shell.
        shell: ShellId,
        /// The signed volume, in cubic units.
        volume: f64,
    },
}

impl Violation {
    /// The same violation in a boundary to which the entities were appended.
    pub fn renumbered(self, ids: &Renumbering) -> Self {
        match self {
            Self::LoopOpen { ring, after } => Self::LoopOpen {
                ring: ids.ring(ring),
                after: ids.coedge(after),
            },
            Self::LoopNoCycle { ring } => Self::LoopNoCycle {
                ring: ids.ring(ring),
            },
            Self::EdgeUse { edge } => Self::EdgeUse {
                edge: ids.edge(edge),
            },
            Self::EdgeEnd {
                edge,
                vertex,
                distance,
            } => Self::EdgeEnd {
                edge: ids.edge(edge),
                vertex: ids.vertex(vertex),
                distance,
            },
            Self::EdgeOffFace {
                edge,
                face,
                distance,
            } => Self::EdgeOffFace {
                edge: ids.edge(edge),
                face: ids.face(face),
                distance,
            },
            Self::TouchOff { touch, distance } => Self::TouchOff {
                touch: ids.touch(touch),
                distance,
            },
            Self::Euler { shell, euler } => Self::Euler {
                shell: ids.shell(shell),
                euler,
            },
            Self::Area { face, area } => Self::Area {
                face: ids.face(face),
                area,
            },
            Self::Closure { face, defect } => Self::Closure {
                face: ids.face(face),
                defect,
            },
            Self::Overlap { face, area, whole } => Self::Overlap {
                face: ids.face(face),
                area,
                whole,
            },
            Self::Integral { face, areas } => Self::Integral {
                face: ids.face(face),
                areas,
            },
            Self::Orientation { shell, volume } => Self::Orientation {
                shell: ids.shell(shell),
                volume,
            },
        }
    }
}

/// The multiple of the resolution by which an edge may miss its faces and its vertices. The edge
/// was constructed from two of them, and the others were merged with these within the resolution.
const PLAY: f64 = 8.0;

/// The distance of an edge from a vertex or a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeGap<N: Float = f64> {
    /// The point on the edge.
    pub place: Point3<N>,
    /// The distance.
    pub distance: N,
}

/// The largest distance of an edge from a vertex at its end or from a face, if it exceeds what
/// merging within the resolution accounts for.
pub fn worst_gap<N: Float>(brep: &Brep<N>, resolution: N) -> Option<EdgeGap<N>> {
    let t = &brep.topology;
    let gaps = t.edge_ids().flat_map(|id| {
        let ends = gaps_at_ends(brep, id).map(|gap| EdgeGap {
            place: gap.place,
            distance: gap.distance,
        });
        let faces = t.faces_of(id);
        ends.chain(faces.map(move |face| gap_from_face(brep, id, face)))
    });
    let worst = gaps.max_by(|a, b| a.distance.total_cmp(&b.distance));
    worst.filter(|gap| !is_accounted(gap.distance, resolution))
}

/// Whether merging of coincident entities accounts for a distance.
fn is_accounted<N: Float>(distance: N, resolution: N) -> bool {
    distance.is_within(N::from_f64(PLAY) * resolution)
}

/// The distance of an edge from a face's surface, at the farthest point.
fn gap_from_face<N: Float>(brep: &Brep<N>, id: EdgeId, face: FaceId) -> EdgeGap<N> {
    let ([lo, hi], curve) = (brep.range(id), brep.curve(id));
    let gaps = (0..=PLACES).map(|k| {
        let place = curve.point(lo + (hi - lo) * N::whole(k) / N::whole(PLACES));
        let distance = brep.surface(face).distance(&place).abs();
        EdgeGap { place, distance }
    });
    let worst = gaps.max_by(|a, b| a.distance.total_cmp(&b.distance));
    worst.unwrap_or(EdgeGap {
        place: Point3::origin(),
        distance: N::ZERO,
    })
}

/// The number of sample points, less one, at which an edge is compared with a face.
const PLACES: u32 = 8;

/// The rules that a boundary breaks; empty if it is valid.
pub fn check<N: Float>(
    brep: &Brep<N>,
    measures: &FaceIntegrals<N>,
    resolution: N,
) -> Vec<Violation> {
    let mut found = Vec::new();
    check_loops(brep, &mut found);
    check_edges(brep, resolution, &mut found);
    check_touches(brep, resolution, &mut found);
    check_genera(brep, &mut found);
    check_shells(brep, measures, &mut found);
    let areas = measures.areas(brep);
    check_areas(&areas, &mut found);
    check_closures(measures, &mut found);
    check_overlaps(brep, &areas, &mut found);
    found
}

/// The faces whose integrals depend on how edges are divided: the quadrature has no node in a part of an
/// edge. The check takes several times as long as the integrals, so that [`check`] leaves it out.
pub fn check_integrals<N: Float>(brep: &Brep<N>, measures: &FaceIntegrals<N>) -> Vec<Violation> {
    let graded = FaceIntegrals::with_graded_edges(brep);
    let different = measures.different_faces(brep, &graded);
    different
        .map(|FaceDifference { face, areas }| Violation::Integral { face, areas })
        .collect()
}

/// A face with a negative area has a loop that was misclassified.
fn check_areas<N: Float>(areas: &[FaceArea<N>], found: &mut Vec<Violation>) {
    for (i, &FaceArea { area, noise }) in areas.iter().enumerate() {
        // The area of a sliver may be rounding.
        if area.is_nan() || area.is_at_most(-noise) {
            found.push(Violation::Area {
                face: FaceId(i as u32),
                area: area.rounded(),
            });
        }
    }
}

/// The largest defect of closure, in radians or relative to the part's size, that inaccurate tangents of
/// edges cause. With a larger one, a piece of a loop is missing, such as an edge around a pole.
const OPEN: f64 = 1.0 / (1 << 10) as f64;

/// Around each loop, the angle about the surface's axis changes by whole turns.
fn check_closures<N: Float>(measures: &FaceIntegrals<N>, found: &mut Vec<Violation>) {
    for (i, &defect) in measures.defects().iter().enumerate() {
        if defect.is_beyond(N::from_f64(OPEN)) {
            found.push(Violation::Closure {
                face: FaceId(i as u32),
                defect: defect.rounded(),
            });
        }
    }
}

/// The part of a closed surface by which its faces may exceed it: the error of their areas.
const EXCESS: f64 = 1.0 / (1 << 10) as f64;

/// Compares the faces of each closed surface with the whole surface.
fn check_overlaps<N: Float>(brep: &Brep<N>, areas: &[FaceArea<N>], found: &mut Vec<Violation>) {
    let whole = |surface: &Surface<N>| match surface {
        Surface::Sphere(s) => Some(N::TWO * N::TAU * s.radius * s.radius),
        Surface::Torus(t) => {
            // The integral of the distance from the axis, from pole to pole.
            let pole = t.pole_angle();
            let distances = t.major * pole + t.minor * pole.sin();
            Some(N::TWO * N::TAU * t.minor * distances)
        }
        _ => None,
    };
    let mut sums: BTreeMap<(usize, bool), N> = BTreeMap::new();
    for (face, &FaceArea { area, .. }) in brep.topology.face_ids().zip(areas) {
        let Some(whole) = whole(brep.surface(face)) else {
            continue;
        };
        let side = (brep.carrier(face), brep.sense(face) == Sense::Along);
        let sum = sums.entry(side).or_insert(N::ZERO);
        *sum += area;
        if (*sum - whole).is_beyond(N::from_f64(EXCESS) * whole) {
            let (area, whole) = (sum.rounded(), whole.rounded());
            found.push(Violation::Overlap { face, area, whole });
        }
    }
}

fn check_loops<N: Float>(brep: &Brep<N>, found: &mut Vec<Violation>) {
    let t = &brep.topology;
    for (i, ring) in t.loops.iter().enumerate() {
        let id = LoopId(i as u32);
        for (k, &c) in ring.coedges.iter().enumerate() {
            let next = ring.coedges[(k + 1) % ring.coedges.len()];
            let joined = match (t.run(c), t.run(next)) {
                (Some([_, end]), Some([start, _])) => end == start,
                (None, None) => ring.coedges.len() == 1,
                _ => false,
            };
            if !joined {
                found.push(Violation::LoopOpen { ring: id, after: c });
            }
        }
    }
    for face in &t.faces {
        check_cycles(brep, &face.loops, found);
    }
}

/// Checks the loops of a face against the cycles of its boundary.
fn check_cycles<N: Float>(brep: &Brep<N>, loops: &[LoopId], found: &mut Vec<Violation>) {
    let t = &brep.topology;
    for &l in loops {
        let coedges = t.ring(l).coedges.iter();
        let ends = coedges.filter_map(|&c| t.edge(t.coedge(c).edge).ends);
        let edges: Vec<_> = ends.map(|ends| ends.map(|v| v.index())).collect();
        if !cycle_space::is_sum_of_cycles(&edges) {
            found.push(Violation::LoopNoCycle { ring: l });
        }
    }
}

fn check_edges<N: Float>(brep: &Brep<N>, resolution: N, found: &mut Vec<Violation>) {
    let t = &brep.topology;
    for id in t.edge_ids() {
        let edge = t.edge(id);
        let paired = edge.coedges.len() >= 2
            && edge.coedges.len().is_multiple_of(2)
            && edge
                .coedges
                .chunks(2)
                .all(|p| t.coedge(p[0]).sense != t.coedge(p[1]).sense);
        if !paired {
            found.push(Violation::EdgeUse { edge: id });
        }
        for EndGap {
            vertex, distance, ..
        } in gaps_at_ends(brep, id)
        {
            if !is_accounted(distance, resolution) {
                found.push(Violation::EdgeEnd {
                    edge: id,
                    vertex,
                    distance: distance.rounded(),
                });
            }
        }
        for face in t.faces_of(id) {
            let distance = gap_from_face(brep, id, face).distance;
            if !is_accounted(distance, resolution) {
                found.push(Violation::EdgeOffFace {
                    edge: id,
                    face,
                    distance: distance.rounded(),
                });
            }
        }
    }
}

fn check_touches<N: Float>(brep: &Brep<N>, resolution: N, found: &mut Vec<Violation>) {
    let touches = brep.topology.touches.iter().zip(&brep.geometry.touches);
    for (i, (touch, place)) in touches.enumerate() {
        let vertices = touch.vertex.iter().map(|&v| brep.point(v));
        let edges = touch.edges.iter().map(|&e| {
            let curve = brep.curve(e);
            curve.point(curve.parameter(place))
        });
        let points = vertices.chain(edges).map(|p| (p - place).length());
        let faces = touch.faces.iter();
        let faces = faces.map(|&f| brep.surface(f).distance(place).abs());
        let distance = points.chain(faces).fold(N::ZERO, N::max);
        let meeting = touch.fans + touch.edges.len() + touch.faces.len();
        if meeting < 2 || !is_accounted(distance, resolution) {
            let touch = TouchId(i as u32);
            found.push(Violation::TouchOff {
                touch,
                distance: distance.rounded(),
            });
        }
    }
}

fn check_genera<N: Float>(brep: &Brep<N>, found: &mut Vec<Violation>) {
    for (i, shell) in brep.topology.shells.iter().enumerate() {
        if shell.genus < 0 || shell.odd {
            let euler = 2 - 2 * shell.genus - i32::from(shell.odd);
            let shell = ShellId(i as u32);
            found.push(Violation::Euler { shell, euler });
        }
    }
}

fn check_shells<N: Float>(brep: &Brep<N>, measures: &FaceIntegrals<N>, found: &mut Vec<Violation>) {
    for (i, shell) in brep.topology.shells.iter().enumerate() {
        let id = ShellId(i as u32);
        let enclosed = measures.enclosed(brep, id);
        let volume = enclosed.volume;
        // The volume of a sliver may be below rounding, and then its sign is meaningless.
        let is_turned = enclosed.is_clear() && volume.is_below_zero() != shell.void;
        if volume.is_nan() || is_turned {
            found.push(Violation::Orientation {
                shell: id,
                volume: volume.rounded(),
            });
        }
    }
}
