//! The rules for the solids of a STEP file.

use super::curve::{StepCurve, StepCurvePoint};
use super::shape::{StepEdge, StepEdgeUse, StepFace, StepShape};
use super::surface::{Pole, StepSurface};
use nalgebra::Point3;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
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
    pub area: f64,
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
    // Curves may deviate over the entire surface, and quadrature has a limited precision.
    let allowed = known.area * known.accuracy + known.size.powi(3) * QUADRATURE;
    if let Some(volume) = volume
        && (volume - known.volume).abs() > allowed
    {
        let rule = StepRule::Volume(volume);
        let place = known.middle;
        measured.broken.push(Broken { rule, place });
    }
    measured
}

/// The allowed relative error of quadrature.
const QUADRATURE: f64 = 1.0 / (1u64 << 33) as f64;

/// The allowed relative error for a piece of an edge.
const FINE: f64 = 1.0 / (1u64 << 42) as f64;

/// The distance from a period within which a start may be taken for its end.
const PERIOD: f64 = 1.0 / (1u64 << 26) as f64;

fn broken_edge(edge: &StepEdge, known: &Known) -> Vec<Broken> {
    let mut broken = Vec::new();
    for k in 0..2 {
        let p = edge.curve.at(edge.range[k]).point;
        let off = (p - edge.points[k]).norm();
        if off.is_nan() || off > known.accuracy {
            let rule = StepRule::VertexOnCurve(off);
            let place = edge.points[k];
            broken.push(Broken { rule, place });
        }
    }
    let [from, to] = edge.points;
    let stops = edge.curve.stops(edge.range);
    let steps = stops.windows(2).flat_map(|pair| {
        let step = (pair[1] - pair[0]) / f64::from(PLACES);
        (0..=PLACES).map(move |k| pair[0] + step * f64::from(k))
    });
    let points: Vec<Point3<f64>> = steps.map(|t| edge.curve.at(t).point).collect();
    let length: f64 = points.windows(2).map(|w| (w[1] - w[0]).norm()).sum();
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

/// The end of an edge at a pole.
#[derive(Clone, Copy)]
struct PoleArrival {
    pole: Pole,
    /// The parameter u with which the edge arrives.
    u: f64,
    used: StepEdgeUse,
}

/// A pole at which two edges meet.
#[derive(Clone, Copy)]
struct PoleCusp {
    pole: Pole,
    /// The parameter u with which the first edge arrives.
    u: f64,
}

/// The integral of P du along a piece of a curve.
#[derive(Clone, Copy)]
struct PieceIntegral {
    sum: f64,
    /// The parameters at the end of the piece.
    end: [f64; 2],
}

/// A vertex at which an edge of a loop starts or ends.
#[derive(Clone, Copy)]
struct LoopVertex {
    /// The number of the vertex.
    id: u32,
    point: Point3<f64>,
}

/// A position in the parameters of a surface that moves along a loop.
struct Walk<'s> {
    surface: &'s StepSurface,
    about: Point3<f64>,
    /// u and v, continued without jumps; `None` at a pole before the first edge.
    at: Option<[f64; 2]>,
    first: Option<[f64; 2]>,
    /// Minus the integral of P du.
    flow: f64,
    /// The pole at which the last edge ended.
    pole: Option<PoleArrival>,
    /// The first edge, if it starts at a pole.
    first_from_pole: Option<StepEdgeUse>,
    /// A pole at which two edges meet. If they have the same direction, or turn away from it at
    /// once, one more or one less turn may lie between them.
    cusp: Option<PoleCusp>,
    /// Whether loops are counterclockwise as seen along the surface's normal.
    along: bool,
    /// The distance from a pole within which a point is at the pole.
    tolerance: f64,
    /// The allowed error of a piece's integral.
    fine: f64,
    is_clear: bool,
}

impl Measured {
    /// Checks the loops of a face. Returns the flow out of it, if it is determined.
    fn add_face(&mut self, shape: &StepShape, face: &StepFace, known: &Known) -> Option<f64> {
        let surface = &shape.surfaces[&face.surface];
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
            let mut walk = Walk {
                surface,
                about: known.middle,
                at: None,
                first: None,
                flow: 0.0,
                pole: None,
                first_from_pole: None,
                cusp: None,
                along: face.along,
                tolerance: known.size * POLE,
                fine: known.size.powi(3) * FINE,
                is_clear: true,
            };
            for used in ring {
                walk.add(&shape.edges[&used.edge], *used);
            }
            let open = walk.close();
            is_clear &= walk.is_clear;
            flow += walk.flow;
            let is_open = [
                open[0].abs() > GAP * if surface.has_angle() { 1.0 } else { known.size },
                open[1].abs() > GAP * known.size.max(1.0),
            ];
            if walk.is_clear && (is_open[0] || is_open[1]) {
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

/// The distance from a pole, relative to the size, within which a point is at the pole.
const POLE: f64 = 1.0 / (1u64 << 30) as f64;

/// The relative gap allowed in loops: vertices and curves are f64, and splines approximate.
const GAP: f64 = 1.0 / 1024.0;

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

/// Gauss's five-point rule: nodes and weights without the middle one.
const GAUSS: [[f64; 2]; 2] = [
    [0.538_469_310_105_683_1, 0.478_628_670_499_366_47],
    [0.906_179_845_938_664, 0.236_926_885_056_189_08],
];
/// The weight of the middle node.
const CENTRE: f64 = 128.0 / 225.0;

/// The number of times that a piece is halved.
const HALVED: u32 = 12;

impl Walk<'_> {
    /// Moves along an edge.
    fn add(&mut self, edge: &StepEdge, used: StepEdgeUse) {
        let along = used.along;
        let mut stops = edge.curve.stops(edge.range);
        if !along {
            stops.reverse();
        }
        let (start, end) = match along {
            true => (edge.points[0], edge.points[1]),
            false => (edge.points[1], edge.points[0]),
        };
        let poles = [start, end].map(|p| self.surface.pole(&p, self.tolerance));
        for (k, pair) in stops.windows(2).enumerate() {
            // Between the ends, so that no angle is evaluated at a pole.
            let (is_first, is_last) = (k == 0, k + 2 == stops.len());
            let inner = (pair[1] - pair[0]) * INNER;
            let from = if is_first && poles[0].is_some() {
                pair[0] + inner
            } else {
                pair[0]
            };
            let to = if is_last && poles[1].is_some() {
                pair[1] - inner
            } else {
                pair[1]
            };
            if is_first {
                self.enter(&edge.curve, from, poles[0].map(|_| used));
            }
            self.piece(&edge.curve, [from, to], HALVED);
        }
        let ended = poles[1].zip(self.at);
        self.pole = ended.map(|(pole, [u, _])| PoleArrival { pole, u, used });
    }

    /// Moves to the start of an edge; `from_pole` is the edge if it starts at a pole.
    fn enter(&mut self, curve: &StepCurve, t: f64, from_pole: Option<StepEdgeUse>) {
        let p = curve.at(t).point;
        let there = self.surface.parameters(&p);
        let Some(at) = self.at else {
            self.at = Some(there);
            self.first = self.at;
            self.first_from_pole = from_pole;
            return;
        };
        let mut next = self.nearest_equivalent(there, at);
        if let (Some(last), Some(used)) = (self.pole, from_pole) {
            let is_seam = is_seam(last.used, used);
            next[0] = self.around_pole(last.pole, [last.u, there[0]], is_seam);
            next[1] = there[1];
        }
        self.at = Some(next);
    }

    /// The angle at which a loop leaves a pole: before the angle at which it arrived, as seen with
    /// the pole above. For a returning seam it is a whole turn.
    fn around_pole(&mut self, pole: Pole, [from, to]: [f64; 2], is_seam: bool) -> f64 {
        let down = self.down(pole);
        let mut turned = (down * (to - from)).rem_euclid(TAU);
        if is_seam {
            turned = TAU;
        } else {
            self.cusp = Some(PoleCusp { pole, u: from });
        }
        self.pass_pole(pole, from, down * turned)
    }

    /// The direction of u in which a loop turns at a pole.
    fn down(&self, pole: Pole) -> f64 {
        match (pole == Pole::North) == self.along {
            true => -1.0,
            false => 1.0,
        }
    }

    fn pass_pole(&mut self, pole: Pole, from: f64, turned: f64) -> f64 {
        let to = from + turned;
        self.flow -= self.surface.flow_at_pole(pole, [from, to], &self.about);
        to
    }

    /// The equivalent parameters closest to others.
    fn nearest_equivalent(&self, mut there: [f64; 2], at: [f64; 2]) -> [f64; 2] {
        use super::surface::SurfaceForm;
        let periodic = [
            self.surface.has_angle(),
            matches!(self.surface.form, SurfaceForm::Torus { .. }),
        ];
        for i in 0..2 {
            if periodic[i] {
                there[i] += TAU * ((at[i] - there[i]) / TAU).round();
            }
        }
        there
    }

    /// Moves along a piece of a curve. It is halved until it turns little and the quadrature of
    /// both halves agrees with that of the whole.
    fn piece(&mut self, curve: &StepCurve, range: [f64; 2], halvings: u32) {
        let Some(at) = self.at else { return };
        let [from, to] = range;
        let middle = 0.5 * (from + to);
        let whole = self.integral(curve, range, at);
        let first = self.integral(curve, [from, middle], at);
        let second = self.integral(curve, [middle, to], first.end);
        let turn = (whole.end[0] - at[0])
            .abs()
            .max((first.end[0] - at[0]).abs());
        let is_fine = (first.sum + second.sum - whole.sum).abs() <= self.fine
            && (whole.end[0] - second.end[0]).abs() < 1.0
            && (!self.surface.has_angle() || turn < 1.0);
        if is_fine || halvings == 0 {
            if self.surface.has_angle() && turn > 0.5 * PI {
                self.is_clear = false;
            }
            self.flow -= first.sum + second.sum;
            self.at = Some(second.end);
            return;
        }
        self.piece(curve, [from, middle], halvings - 1);
        self.piece(curve, [middle, to], halvings - 1);
    }

    /// The integral along a piece that starts at given parameters.
    fn integral(&self, curve: &StepCurve, [a, b]: [f64; 2], mut at: [f64; 2]) -> PieceIntegral {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let [[inner, inner_weight], [outer, outer_weight]] = GAUSS;
        let places = [
            (-outer, outer_weight),
            (-inner, inner_weight),
            (0.0, CENTRE),
            (inner, inner_weight),
            (outer, outer_weight),
        ];
        let mut sum = 0.0;
        for (x, weight) in places {
            let StepCurvePoint { point, derivative } = curve.at(middle + half * x);
            at = self.nearest_equivalent(self.surface.parameters(&point), at);
            let flow = self.surface.flow(at, &self.about);
            sum += weight * flow * self.surface.u_speed(&point, &derivative);
        }
        let there = self.surface.parameters(&curve.at(b).point);
        PieceIntegral {
            sum: half * sum,
            end: self.nearest_equivalent(there, at),
        }
    }

    /// Returns to the start, and gives the gap in both parameters.
    fn close(&mut self) -> [f64; 2] {
        let (Some(first), Some(mut at)) = (self.first, self.at) else {
            return [0.0; 2];
        };
        if let (Some(last), Some(used)) = (self.pole, self.first_from_pole) {
            let is_seam = is_seam(last.used, used);
            let angle = self.around_pole(last.pole, [last.u, first[0]], is_seam);
            at = [angle, first[1]];
        }
        let mut open = [at[0] - first[0], at[1] - first[1]];
        if let Some(PoleCusp { pole, u }) = self.cusp {
            let turned = -open[0].signum() * TAU;
            if (open[0] + turned).abs() < GAP {
                self.pass_pole(pole, u, turned);
                open[0] += turned;
            }
        }
        open
    }
}

/// Whether a loop arrives at a pole along an edge and leaves it along the same edge, which is a
/// seam. A single edge from the pole back to it has one sense only.
fn is_seam(last: StepEdgeUse, next: StepEdgeUse) -> bool {
    last.edge == next.edge && last.along != next.along
}

/// The distance from a pole at which an edge is first evaluated, relative to its first piece.
const INNER: f64 = 1.0 / (1 << 20) as f64;
