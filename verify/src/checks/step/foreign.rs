//! The measures of the solids of a STEP file that another program wrote.
//!
//! Read are solids of planes, cylinders, cones, spheres and tori whose edges are lines, conics and
//! simple B-splines, in millimetres and radians, without assemblies. Anything else is an error that
//! names it.

use super::part21::{self, Instances, StepReadError, StepValue};
use super::shape::{StepOrigin, StepShape};
use super::surface::FaceQuantity;
use super::walk::FaceIntegral;
use nalgebra::Point3;
use std::collections::HashMap;

/// The measures of the solids of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StepMeasures {
    /// The volume, in cubic millimetres.
    pub volume: f64,
    /// The area, in square millimetres.
    pub area: f64,
    /// The number of solids.
    pub solids: usize,
}

/// Why a file has no measures.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepMeasureError {
    /// It cannot be read.
    #[error("{0}")]
    Read(String),
    /// It has an entity that is not read.
    #[error("{0} is not read")]
    Entity(String),
    /// Its brackets are nested deeper than any entity asks for.
    #[error("brackets are nested too deep")]
    Depth,
    /// An edge has not as many uses in one sense as in the other, or a loop is open.
    #[error("a shell is not closed")]
    Open,
    /// An edge passes through a pole, or a measure is no number.
    #[error("the measures are undetermined")]
    Undetermined,
}

/// Entities by which lengths, angles or places are others.
const UNREAD: [&str; 3] = ["CONVERSION_BASED_UNIT", "MAPPED_ITEM", "FACETED_BREP"];

/// The entity that places a part of an assembly.
const PLACED: &str = "ITEM_DEFINED_TRANSFORMATION";

/// The measures of a file.
pub(crate) fn measures(text: &str) -> Result<StepMeasures, StepMeasureError> {
    let instances = part21::read(&statements(text)?);
    let instances = instances.map_err(|error| StepMeasureError::Read(error.to_string()))?;
    check_entities(&instances)?;
    let shape = StepShape::new(&instances, StepOrigin::Others);
    let shape = shape.map_err(|error| named(&instances, &error))?;
    let volume = integral(&shape, FaceQuantity::Volume)?;
    let area = integral(&shape, FaceQuantity::Area)?;
    match volume.is_finite() && area.is_finite() {
        true => Ok(StepMeasures {
            volume,
            area,
            solids: shape.solids.len(),
        }),
        false => Err(StepMeasureError::Undetermined),
    }
}

/// An error with the names of the entities of its instance.
fn named(instances: &Instances, error: &StepReadError) -> StepMeasureError {
    let StepReadError::Instance { id, expected } = error else {
        return StepMeasureError::Read(error.to_string());
    };
    let parts = instances.get(id).map(|instance| &instance.parts);
    let names = parts.into_iter().flatten().map(|part| part.name.as_str());
    let names: Vec<&str> = names.collect();
    match names.is_empty() {
        true => StepMeasureError::Read(format!("#{id} is absent")),
        false => StepMeasureError::Entity(format!("{} (expected {expected})", names.join(", "))),
    }
}

fn check_entities(instances: &Instances) -> Result<(), StepMeasureError> {
    let mut wrong: Option<String> = None;
    for part in instances.values().flat_map(|instance| &instance.parts) {
        let is_other_length = || {
            // The metre with another prefix than milli.
            part.name == "SI_UNIT"
                && part.values.last() == Some(&enumeration("METRE"))
                && part.values.first() != Some(&enumeration("MILLI"))
        };
        let is_moved = || part.name == PLACED && !is_in_place(instances, &part.values);
        let name = match UNREAD.contains(&part.name.as_str()) || is_moved() {
            true => part.name.clone(),
            false if is_other_length() => "a length in other units than millimetres".to_owned(),
            false => continue,
        };
        // The same for any order of the instances.
        if wrong.as_ref().is_none_or(|known| name < *known) {
            wrong = Some(name);
        }
    }
    wrong.map_or(Ok(()), |name| Err(StepMeasureError::Entity(name)))
}

/// The number of references from a transformation to the numbers of its placements.
const REFERENCES: usize = 3;

/// Whether the two placements of a transformation are equal, so that nothing moves.
fn is_in_place(instances: &Instances, values: &[StepValue]) -> bool {
    match values {
        [.., from, to] => are_equal(instances, from, to, REFERENCES),
        _ => false,
    }
}

fn are_equal(instances: &Instances, a: &StepValue, b: &StepValue, left: usize) -> bool {
    let (StepValue::Instance(i), StepValue::Instance(j)) = (a, b) else {
        return a == b;
    };
    if i == j {
        return true;
    }
    let (Some(a), Some(b)) = (instances.get(i), instances.get(j)) else {
        return false;
    };
    let parts = a.parts.iter().zip(&b.parts);
    left > 0
        && a.parts.len() == b.parts.len()
        && parts.into_iter().all(|(a, b)| {
            let values = a.values.iter().zip(&b.values);
            a.name == b.name
                && a.values.len() == b.values.len()
                && values
                    .into_iter()
                    .all(|(a, b)| are_equal(instances, a, b, left - 1))
        })
}

fn enumeration(name: &str) -> StepValue {
    StepValue::Enumeration(name.to_owned())
}

/// The deepest nesting of brackets.
const DEPTH: usize = 16;

/// The statements of a file, one a line, without spaces and comments.
fn statements(text: &str) -> Result<String, StepMeasureError> {
    let mut lines = String::with_capacity(text.len());
    let (mut in_string, mut depth) = (false, 0usize);
    let mut letters = text.chars().peekable();
    while let Some(letter) = letters.next() {
        if letter == '\'' {
            in_string = !in_string;
        }
        match letter {
            _ if in_string && letter.is_control() => continue,
            _ if in_string => {}
            '/' if letters.peek() == Some(&'*') => {
                let mut before = ' ';
                letters.next();
                for inner in letters.by_ref() {
                    if before == '*' && inner == '/' {
                        break;
                    }
                    before = inner;
                }
                continue;
            }
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ if letter.is_whitespace() => continue,
            _ => {}
        }
        if depth > DEPTH {
            return Err(StepMeasureError::Depth);
        }
        lines.push(letter);
        if letter == ';' && !in_string {
            lines.push('\n');
            depth = 0;
        }
    }
    Ok(lines)
}

/// The integral over all faces of all solids.
fn integral(shape: &StepShape, quantity: FaceQuantity) -> Result<f64, StepMeasureError> {
    let scale = Scale::new(shape);
    let integral = FaceIntegral {
        quantity,
        about: scale.middle,
        size: scale.size,
    };
    let mut sum = 0.0;
    for shell in shape.solids.iter().flatten() {
        let mut senses: HashMap<u32, [usize; 2]> = HashMap::new();
        for face in shell {
            let mut of_face = 0.0;
            for ring in &face.loops {
                for used in ring {
                    senses.entry(used.edge).or_default()[usize::from(used.along)] += 1;
                }
                let found = integral.along(shape, face, ring);
                if found.open.is_some() {
                    return Err(StepMeasureError::Open);
                }
                of_face += found.sum.ok_or(StepMeasureError::Undetermined)?;
            }
            sum += match quantity {
                FaceQuantity::Volume => of_face,
                FaceQuantity::Area => of_face.abs(),
            };
        }
        // Where a solid touches itself an edge may have more than two faces.
        if senses.values().any(|uses| uses[0] != uses[1]) {
            return Err(StepMeasureError::Open);
        }
    }
    Ok(sum)
}

/// The middle and the size of what the edges span.
struct Scale {
    middle: Point3<f64>,
    size: f64,
}

impl Scale {
    fn new(shape: &StepShape) -> Self {
        let edges = shape.edges.values();
        let mut points = edges.flat_map(|edge| {
            let stops = edge.curve.stops(edge.range);
            stops.into_iter().map(|t| edge.curve.at(t).point)
        });
        let first = points.next().unwrap_or(Point3::origin());
        let (low, high) = points.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)));
        Self {
            middle: nalgebra::center(&low, &high),
            size: (high - low).norm(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generator::write::{Format, read};
    use premio_csg::evaluate::{EvaluationOptions, evaluate};
    use premio_exchange::FaceColours;
    use premio_exchange::step::{self, Protocol, StepOptions};
    use premio_kernel::unit::Unit;

    /// The STEP file of a part, and its volume and area.
    fn written(text: &str) -> (String, [f64; 2]) {
        let tree = read(text, Format::Padl).unwrap().tree;
        let evaluation = evaluate(&tree, &EvaluationOptions::default()).unwrap();
        let options = StepOptions {
            name: "part".to_owned(),
            protocol: Protocol::default(),
            unit: Unit::default(),
            accuracy: 1e-6,
            resolution: evaluation.resolution,
            colours: FaceColours::default(),
        };
        let mass = evaluation.mass();
        let text = step::write(&evaluation.brep, &options).unwrap();
        (text, [mass.volume, mass.area])
    }

    const PARTS: [&str; 5] = [
        "A = BLO(X=3, Y=4, Z=5)",
        "A = SPH(R=2) AT (ROTX=17, MOVX=9)",
        "A = TOR(RMAJ=3, RMIN=1) AT (ROTX=17, MOVZ=-4)",
        "A = (CON(R=3, H=4) INT BLO(X=5, Y=5, Z=5)) AT (ROTX=40)",
        "A = (CYL(R=2, H=9) UN CYL(R=1, H=9) AT (ROTX=80, MOVZ=4) DIF SPH(R=1)) AT (ROTX=40)",
    ];

    fn check(file: &str, [volume, area]: [f64; 2]) {
        let found = measures(file).unwrap();
        let off = [found.volume / volume - 1.0, found.area / area - 1.0];
        assert!(off.iter().all(|off| off.abs() < 1e-6), "{off:?}");
        assert_eq!(found.solids, 1);
    }

    #[test]
    fn a_file_has_its_measures() {
        for text in PARTS {
            let (file, known) = written(text);
            check(&file, known);
            // As others write: spaces, lines that go on, comments.
            let spaced = file.replace(',', " ,\n  /* ,* ; */").replace("=", " = ");
            check(&spaced, known);
        }
    }

    /// Another program may turn the bounds.
    #[test]
    fn turned_bounds_are_read() {
        let (file, known) = written(PARTS[0]);
        // A line of an edge loop, whose edges are turned and reversed with its bound.
        let mut turned = String::new();
        for line in file.lines() {
            let is_bound = line.contains("=FACE_OUTER_BOUND(") || line.contains("=FACE_BOUND(");
            let line = match is_bound {
                true => line.replace(",.T.);", ",.F.);"),
                false => reversed(line),
            };
            turned += &line;
            turned.push('\n');
        }
        assert_ne!(turned, file);
        check(&turned, known);
    }

    /// The lines of an edge loop and of its edges, turned.
    fn reversed(line: &str) -> String {
        if line.contains("=ORIENTED_EDGE(") {
            let [a, b] = [",.T.);", ",.F.);"];
            return match line.contains(a) {
                true => line.replace(a, b),
                false => line.replace(b, a),
            };
        }
        let Some((start, list)) = line.split_once("=EDGE_LOOP('',(") else {
            return line.to_owned();
        };
        let list = list.trim_end_matches("));");
        let mut edges: Vec<&str> = list.split(',').collect();
        edges.reverse();
        format!("{start}=EDGE_LOOP('',({}));", edges.join(","))
    }

    #[test]
    fn what_is_not_read_is_named() {
        let (file, _) = written(PARTS[1]);
        let error = |text: &str| measures(text).unwrap_err();
        let other = file.replace("=SPHERICAL_SURFACE(", "=OFFSET_SURFACE(");
        let words = error(&other).to_string();
        assert!(words.starts_with("OFFSET_SURFACE"), "{words}");
        let metres = file.replace(".MILLI.", "$");
        assert!(matches!(error(&metres), StepMeasureError::Entity(_)));
        let nested = format!("DATA;\n#1=A({});", "(".repeat(100_000));
        assert_eq!(error(&nested), StepMeasureError::Depth);
        let (file, _) = written(PARTS[0]);
        let face = file.lines().find(|l| l.contains("=CLOSED_SHELL(")).unwrap();
        let (start, _) = face.rsplit_once(',').unwrap();
        let open = file.replace(face, &format!("{start}));"));
        assert_eq!(error(&open), StepMeasureError::Open);
    }
}
