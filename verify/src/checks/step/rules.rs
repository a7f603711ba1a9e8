//! The rules for the solids of a STEP file.

use super::curve::StepCurve;
use super::shape::{StepEdge, StepEdgeUse, StepFace, StepShape};
use super::surface::{FaceQuantity, StepSurface};
use super::walk::FaceIntegral;
use nalgebra::Point3;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fmt;

/// What is known of the part.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// The part's resolution.
    pub resolution: f64,
    /// The allowed distance of curves from surfaces.
    pub accuracy: f64,
    /// The diagonal of its bounding box.
    pub size: f64,
    /// The centre of its bounding box.
    pub middle: Point3<f64>,
    pub volume: f64,
}

/// A broken rule, with a location.
#[derive(Clone, Debug, PartialEq)]
pub struct Broken {
    pub rule: StepRule,
    pub place: Point3<f64>,
}

/// A rule, with the value that breaks it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepRule {
    /// Vertices lie on their curves; the distance of an edge's point from its curve.
    VertexOnCurve(f64),
    /// An edge is longer than the resolution; its length.
    EdgeLength(f64),
    /// At the start of an edge with two ends, rounding cannot turn the parameter into a whole
    /// period.
    StartParameter(f64),
    /// Edges lie on their surfaces; the distance of an edge.
    EdgeOnSurface(f64),
    /// An edge's curve in the parameters of a surface equals the curve in space; their distance.
    ParametricCurve(f64),
    /// Consecutive edges of a loop are connected.
    Chain,
    /// A loop closes in the parameters of the surface; the gap in units of length or turns.
    ClosedLoop([f64; 2]),
    /// In a shell every edge is used twice, with opposite senses; the number of uses and the sum of
    /// their senses.
    TwoUses { uses: usize, sum: i32 },
    /// Outer shells enclose material, voids do not; the volume that a shell encloses.
    Orientation(f64),
    /// The volume by the file's curves and surfaces is the boundary's; that volume.
    Volume(f64),
}

impl fmt::Display for Broken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.rule {
            StepRule::VertexOnCurve(off) => write!(f, "a vertex is {off:.1e} off its curve")?,
            StepRule::EdgeLength(length) => write!(f, "an edge is {length:.1e} long")?,
            StepRule::StartParameter(t) => write!(f, "an edge starts at the parameter {t:e}")?,
            StepRule::EdgeOnSurface(off) => write!(f, "an edge is {off:.1e} off its surface")?,
            StepRule::ParametricCurve(off) => {
                write!(f, "a curve in parameters is {off:.1e} off the one in space")?;
            }
            StepRule::Chain => f.write_str("the edges of a loop do not follow one another")?,
            StepRule::ClosedLoop([u, v]) => {
                write!(f, "a loop is open by ({u:.3}, {v:.3}) in its parameters")?;
            }
            StepRule::TwoUses { uses, sum } => {
                write!(f, "an edge has {uses} uses in a shell, of senses {sum:+}")?;
            }
            StepRule::Orientation(volume) => write!(f, "a shell encloses {volume}")?,
            StepRule::Volume(volume) => write!(f, "the file's volume is {volume}")?,
        }
        let p = self.place;
        write!(f, " at ({:.6}, {:.6}, {:.6})", p.x, p.y, p.z)
    }
}

/// The measured values.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    pub broken: Vec<Broken>,
    /// The volume; `None` if an edge passes through a pole, so that angles are inconclusive.
    pub volume: Option<f64>,
    /// The largest distance of curves from surfaces, and from the curves in parameters.
    pub off: f64,
    pub edges: usize,
    pub faces: usize,
}

/// Checks a shape by all rules.
pub fn measure(shape: &StepShape, known: &Known) -> Measured {
    let mut measured = Measured {
        edges: shape.edges.len(),
        ..Measured::default()
    };
    let mut edges: Vec<(&u32, &StepEdge)> = shape.edges.iter().collect();
    edges.sort_by_key(|(id, _)| **id);
    for (_, edge) in edges {
        measured.broken.extend(broken_edge(edge, known));
    }
    let mut volume = Some(0.0);
    for solid in &shape.solids {
        for (k, shell) in solid.iter().enumerate() {
            measured.faces += shell.len();
            measured.broken.extend(misused(shape, shell));
            let mut enclosed = Some(0.0);
            for face in shell {
                let flow = measured.add_face(shape, face, known);
                enclosed = enclosed.zip(flow).map(|(a, b)| a + b);
            }
            // A shell that encloses almost nothing is not judged.
            let least = known.size.powi(3) * QUADRATURE;
            if let Some(enclosed) = enclosed
                && enclosed.abs() > least
                && (enclosed > 0.0) != (k == 0)
            {
                let rule = StepRule::Orientation(enclosed);
                let place = known.middle;
                measured.broken.push(Broken { rule, place });
            }
            volume = volume.zip(enclosed).map(|(a, b)| a + b);
        }
    }
    measured.volume = volume;
    let allowed = volume_error(shape, known) + known.size.powi(3) * QUADRATURE;
    if let Some(volume) = volume
        && (volume - known.volume).abs() > allowed
    {
        let rule = StepRule::Volume(volume);
        let place = known.middle;
        measured.broken.push(Broken { rule, place });
    }
    measured
}

/// The largest error of the volume that displaced edges cause: by the resolution of the boundary, and
/// by the accuracy of splines. By the divergence theorem the volume is a third of the sum of ∫ P·N dA
/// over faces, with P about the part's middle; a displaced edge adds to two faces a strip of its length.
/// Where an edge ends next to its vertex, because a shorter edge was merged, a strip as wide as the gap is
/// missing, which is no longer than the part.
fn volume_error(shape: &StepShape, known: &Known) -> f64 {
    let distance = 0.5 * known.size;
    let strip = |edge: &StepEdge| {
        let displaced = match edge.curve {
            StepCurve::Spline(_) => known.accuracy,
            _ => known.resolution,
        };
        let gaps: f64 = [0, 1].map(|k| off_vertex(edge, k)).iter().sum();
        length(edge) * displaced + gaps * known.size
    };
    let strips: f64 = shape.edges.values().map(strip).sum();
    2.0 * strips * distance / 3.0
}

/// The length of an edge.
fn length(edge: &StepEdge) -> f64 {
    let points = samples(edge);
    points.windows(2).map(|w| (w[1] - w[0]).norm()).sum()
}

/// Points of an edge, in order.
fn samples(edge: &StepEdge) -> Vec<Point3<f64>> {
    let stops = edge.curve.stops(edge.range);
    let steps = stops.windows(2).flat_map(|pair| {
        let step = (pair[1] - pair[0]) / f64::from(PLACES);
        (0..=PLACES).map(move |k| pair[0] + step * f64::from(k))
    });
    steps.map(|t| edge.curve.at(t).point).collect()
}

/// The allowed relative error of quadrature.
const QUADRATURE: f64 = 1.0 / (1u64 << 33) as f64;

/// The distance from a period within which a start may be taken for its end.
const PERIOD: f64 = 1.0 / (1u64 << 26) as f64;

/// The distance of an end of an edge's curve from the vertex there.
fn off_vertex(edge: &StepEdge, end: usize) -> f64 {
    (edge.curve.at(edge.range[end]).point - edge.points[end]).norm()
}

fn broken_edge(edge: &StepEdge, known: &Known) -> Vec<Broken> {
    let mut broken = Vec::new();
    for k in 0..2 {
        let off = off_vertex(edge, k);
        if off.is_nan() || off > known.accuracy {
            let rule = StepRule::VertexOnCurve(off);
            let place = edge.points[k];
            broken.push(Broken { rule, place });
        }
    }
    let [from, to] = edge.points;
    let length = length(edge);
    let is_open = edge.ends[0] != edge.ends[1];
    // Between two vertices close to each other no reader can distinguish a full turn from an edge
    // of length zero. Between two coincident vertices it is a full turn.
    let chord = (to - from).norm();
    let shortest = match is_open && edge.curve.is_periodic() && chord > 0.0 {
        true => length.min(chord),
        false => length,
    };
    if shortest.is_nan() || shortest <= known.resolution {
        let (rule, place) = (StepRule::EdgeLength(shortest), from);
        broken.push(Broken { rule, place });
    }
    let start = edge.range[0];
    if is_open && edge.curve.is_periodic() && start.min(TAU - start) < PERIOD {
        let (rule, place) = (StepRule::StartParameter(start), from);
        broken.push(Broken { rule, place });
    }
    broken
}

/// Edges of a shell that are not used twice with opposite senses.
fn misused(shape: &StepShape, shell: &[StepFace]) -> Vec<Broken> {
    let mut senses: HashMap<u32, Vec<i32>> = HashMap::new();
    for used in shell.iter().flat_map(|face| &face.loops).flatten() {
        let sense = if used.along { 1 } else { -1 };
        senses.entry(used.edge).or_default().push(sense);
    }
    let counted = senses.into_iter().map(|(edge, senses)| {
        let (uses, sum) = (senses.len(), senses.iter().sum());
        (edge, StepRule::TwoUses { uses, sum })
    });
    let right = StepRule::TwoUses { uses: 2, sum: 0 };
    let wrong = counted.filter(|(_, rule)| *rule != right);
    wrong
        .map(|(edge, rule)| Broken {
            rule,
            place: shape.edges[&edge].points[0],
        })
        .collect()
}

/// A vertex at which an edge of a loop starts or ends.
#[derive(Clone, Copy)]
struct LoopVertex {
    /// The number of the vertex.
    id: u32,
    point: Point3<f64>,
}

impl Measured {
    /// Checks the loops of a face. Returns the flow out of it, if it is determined.
    fn add_face(&mut self, shape: &StepShape, face: &StepFace, known: &Known) -> Option<f64> {
        let surface = &shape.surfaces[&face.surface];
        let integral = FaceIntegral {
            quantity: FaceQuantity::Volume,
            about: known.middle,
            size: known.size,
        };
        let mut flow = 0.0;
        let mut is_clear = true;
        for ring in &face.loops {
            let Some(start) = ring.first().map(|u| tail(shape, u)) else {
                continue;
            };
            let place = start.point;
            for (used, next) in ring.iter().zip(ring.iter().cycle().skip(1)) {
                let edge = &shape.edges[&used.edge];
                self.hold(edge, face.surface, surface, known);
                if head(shape, used).id != tail(shape, next).id {
                    let rule = StepRule::Chain;
                    self.broken.push(Broken { rule, place });
                }
            }
            let found = integral.along(shape, face, ring);
            is_clear &= found.sum.is_some();
            flow += found.sum.unwrap_or(0.0);
            if let Some(open) = found.open {
                let rule = StepRule::ClosedLoop(open);
                self.broken.push(Broken { rule, place });
            }
        }
        is_clear.then_some(flow)
    }

    /// Compares an edge with a surface on which it lies.
    fn hold(&mut self, edge: &StepEdge, id: u32, surface: &StepSurface, known: &Known) {
        let mut off: f64 = 0.0;
        let mut off_parametric: f64 = 0.0;
        let mut places = [edge.points[0]; 2];
        let on = edge.on.iter().find(|on| on.surface == id);
        for pair in edge.curve.stops(edge.range).windows(2) {
            for k in 0..=PLACES {
                let t = pair[0] + (pair[1] - pair[0]) * f64::from(k) / f64::from(PLACES);
                let p = edge.curve.at(t).point;
                let away = surface.distance(&p).abs();
                if away.is_nan() || away > off {
                    (off, places[0]) = (away, p);
                }
                if let Some(on) = on {
                    let away = (surface.point(on.spline.at(t)[0]) - p).norm();
                    if away.is_nan() || away > off_parametric {
                        (off_parametric, places[1]) = (away, p);
                    }
                }
            }
        }
        let [place, parametric_place] = places;
        if off.is_nan() || off > known.accuracy {
            let rule = StepRule::EdgeOnSurface(off);
            self.broken.push(Broken { rule, place });
        }
        if off_parametric.is_nan() || off_parametric > known.accuracy {
            let rule = StepRule::ParametricCurve(off_parametric);
            let place = parametric_place;
            self.broken.push(Broken { rule, place });
        }
        self.off = self.off.max(off).max(off_parametric);
    }
}

/// The number of samples at which a piece of a curve is compared with surfaces.
const PLACES: u32 = 11;

/// The vertex at which an edge starts.
fn tail(shape: &StepShape, used: &StepEdgeUse) -> LoopVertex {
    shape.edges[&used.edge].vertex(usize::from(!used.along))
}

/// The vertex at which an edge ends.
fn head(shape: &StepShape, used: &StepEdgeUse) -> LoopVertex {
    shape.edges[&used.edge].vertex(usize::from(used.along))
}

impl StepEdge {
    /// The vertex at an end.
    fn vertex(&self, k: usize) -> LoopVertex {
        LoopVertex {
            id: self.ends[k],
            point: self.points[k],
        }
    }
}
