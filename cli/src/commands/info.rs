//! `premio info`: measures of the solid.

use crate::arguments::InfoOptions;
use crate::diagnostics::CliError;
use crate::input::{self, EvaluatedPart};
use crate::output;
use crate::session::Session;
use premio::{PrimitiveRelation, Recovery};
use premio_kernel::number::predicates::{CloseCall, DecisionStats};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

/// `premio.info/1`.
#[derive(Debug, Serialize)]
struct Info {
    schema: &'static str,
    volume: f64,
    area: f64,
    centroid: [f64; 3],
    bounds: Bounds,
    solids: usize,
    shells: usize,
    faces: usize,
    edges: usize,
    loops: usize,
    vertices: u32,
    genus: Vec<i32>,
    non_manifold: NonManifold,
    faces_by_surface: BTreeMap<&'static str, usize>,
    decisions: Counts,
    #[serde(skip_serializing_if = "Option::is_none")]
    recovered: Option<Recovered>,
    /// Every decision within a factor of a hundred of the resolution.
    close_calls: Vec<CloseCall>,
    resolution: f64,
    seconds: Seconds,
}

#[derive(Debug, Serialize)]
struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
}

/// The non-manifold edges and points of the boundary.
#[derive(Debug, Serialize)]
struct NonManifold {
    /// Edges that bound more than two face corners.
    edges: usize,
    /// Points at which the boundary touches itself, vertices or not.
    points: usize,
}

#[derive(Debug, Serialize)]
struct Counts {
    filtered: u64,
    refined: u64,
    exact: u64,
    coincident: u64,
    close_calls: usize,
}

/// The relations that the rounding of coordinates had destroyed.
#[derive(Debug, Serialize)]
struct Recovered {
    rounding: String,
    /// The number of relations by kind.
    relations: BTreeMap<&'static str, usize>,
    contradictory: usize,
    moved: usize,
    furthest: f64,
    #[serde(skip)]
    summary: String,
}

#[derive(Debug, Serialize)]
struct Seconds {
    read: f64,
    evaluate: f64,
}

/// Runs the command.
pub fn run(options: &InfoOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    let part = input::part(&options.description, session)?;
    let working = voice.working("measuring");
    let info = Info::new(&part);
    drop(working);
    if voice.is_json() {
        output::json(&info, None)
    } else {
        output::write(info.to_string(), None)
    }
}

impl Info {
    fn new(part: &EvaluatedPart) -> Self {
        let brep = part.solid.brep();
        let topology = &brep.topology;
        let mut faces_by_surface = BTreeMap::new();
        for face in topology.face_ids() {
            *faces_by_surface
                .entry(brep.surface(face).kind().name())
                .or_default() += 1;
        }
        let mass = part.solid.evaluation().mass();
        Self {
            schema: "premio.info/1",
            volume: mass.volume,
            area: mass.area,
            centroid: mass.centroid.into(),
            bounds: Bounds::new(part),
            solids: topology.solids.len(),
            shells: topology.shells.len(),
            faces: topology.faces.len(),
            edges: topology.edges.len(),
            loops: topology.loops.len(),
            vertices: topology.vertices,
            genus: topology.shells.iter().map(|s| s.genus).collect(),
            non_manifold: NonManifold {
                edges: topology.edges_of_many_faces(),
                points: topology.touches.len(),
            },
            faces_by_surface,
            decisions: Counts::new(&part.solid.evaluation().decisions),
            recovered: part.solid.recovery().map(Recovered::new),
            close_calls: part.solid.evaluation().decisions.close_calls.clone(),
            resolution: part.solid.evaluation().resolution,
            seconds: Seconds {
                read: part.read,
                evaluate: part.evaluate,
            },
        }
    }
}

impl Bounds {
    /// The box of the boundary; a point at the origin for an empty solid.
    fn new(part: &EvaluatedPart) -> Self {
        let evaluation = part.solid.evaluation();
        if evaluation.brep.topology.faces.is_empty() {
            let (min, max) = ([0.0; 3], [0.0; 3]);
            return Self { min, max };
        }
        let found = evaluation.tight_bounds();
        Self {
            min: found.min,
            max: found.max,
        }
    }
}

impl Recovered {
    fn new(recovery: &Recovery) -> Self {
        let count = |kind: PrimitiveRelation| {
            let found = recovery.relations.iter().find(|r| r.kind == kind);
            (kind.name(), found.map_or(0, |relation| relation.count))
        };
        Self {
            rounding: recovery.rounding.to_string(),
            relations: PrimitiveRelation::ALL.into_iter().map(count).collect(),
            contradictory: recovery.contradictory,
            moved: recovery.moved,
            furthest: recovery.furthest,
            summary: recovery.to_string(),
        }
    }
}

impl Counts {
    fn new(decisions: &DecisionStats) -> Self {
        Self {
            filtered: decisions.filtered,
            refined: decisions.refined,
            exact: decisions.exact,
            coincident: decisions.coincident,
            close_calls: decisions.close_calls.len(),
        }
    }
}

/// The number of shells up to which each is listed.
const NAMED: usize = 24;

impl Info {
    /// The genus of each shell, or the number of shells of each genus.
    fn genera(&self) -> String {
        if self.genus.len() <= NAMED {
            return format!("{:?}", self.genus);
        }
        let mut counts: BTreeMap<i32, usize> = BTreeMap::new();
        for g in &self.genus {
            *counts.entry(*g).or_default() += 1;
        }
        let counts: Vec<String> = counts.iter().map(|(g, n)| format!("{g} of {n}")).collect();
        counts.join(", ")
    }
}

impl fmt::Display for Info {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let three = |v: &[f64; 3]| {
            let [x, y, z] = v.map(short);
            format!("({x}, {y}, {z})")
        };
        writeln!(f, "volume      {}", short(self.volume))?;
        writeln!(f, "area        {}", short(self.area))?;
        writeln!(f, "centroid    {}", three(&self.centroid))?;
        let Bounds { min, max } = &self.bounds;
        writeln!(f, "bounds      {} to {}", three(min), three(max))?;
        writeln!(f, "solids      {}", self.solids)?;
        writeln!(f, "shells      {}, genus {}", self.shells, self.genera())?;
        let kinds: Vec<String> = self
            .faces_by_surface
            .iter()
            .map(|(kind, n)| format!("{n} {kind}"))
            .collect();
        writeln!(f, "faces       {} ({})", self.faces, kinds.join(", "))?;
        writeln!(f, "loops       {}", self.loops)?;
        writeln!(f, "edges       {}", self.edges)?;
        writeln!(f, "vertices    {}", self.vertices)?;
        let NonManifold { edges, points } = self.non_manifold;
        if edges + points > 0 {
            writeln!(f, "non-manifold along {edges} edges, in {points} points")?;
        }
        let Counts {
            filtered,
            refined,
            exact,
            coincident,
            close_calls,
        } = self.decisions;
        writeln!(
            f,
            "decisions   {filtered} filtered, {refined} refined, {exact} exact, {coincident} coincident, {close_calls} close calls"
        )?;
        if let Some(recovered) = &self.recovered {
            writeln!(f, "recovered   {}", recovered.summary)?;
        }
        writeln!(f, "resolution  {:e}", self.resolution)?;
        let Seconds { read, evaluate } = self.seconds;
        writeln!(f, "seconds     {read:.3} read, {evaluate:.3} evaluate")
    }
}

/// The shorter notation of a number with all its digits.
fn short(x: f64) -> String {
    let (plain, scientific) = (format!("{x}"), format!("{x:e}"));
    if scientific.len() < plain.len() {
        scientific
    } else {
        plain
    }
}
