//! Boundaries with seams, for parts of every kind.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use nalgebra::Vector3;
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_exchange::FaceColours;
use premio_exchange::step;
use premio_exchange::two_manifold::{HalfEdge, SeamError, TwoManifold};
use premio_kernel::brep::topology::Sense;
use premio_kernel::unit::Unit;
use std::collections::HashMap;

/// Parts, with their numbers of faces, edges and vertices in the result.
const PARTS: &[(&str, &str, [usize; 3])] = &[
    // A meridian from pole to pole.
    ("ball", "A = SPH(R=2)", [1, 1, 2]),
    // Two circles that cross in a vertex.
    ("ring", "A = TOR(RMAJ=3, RMIN=1)", [1, 2, 1]),
    // Two circles and a ruling between them.
    ("cylinder", "A = CYL(R=1, H=3)", [3, 3, 2]),
    // A circle and a ruling to the apex.
    ("cone", "A = CON(R=1, H=2)", [2, 2, 2]),
    // One half of the meridian, from one pole to the circle.
    (
        "cap",
        "A = SPH(R=2) INT BLO(X=8, Y=8, Z=4) AT (MOVX=-4, MOVY=-4, MOVZ=1)",
        [2, 2, 2],
    ),
    // A quarter of a ring: one circle, along the tube.
    (
        "elbow",
        "A = TOR(RMAJ=3, RMIN=1) INT BLO(X=8, Y=8, Z=4) AT (MOVZ=-2)",
        [3, 3, 2],
    ),
    // The block's edges, the circles of the hole, and a ruling of it.
    (
        "plate",
        "A = BLO(X=4, Y=4, Z=1) DIF CYL(R=1, H=3) AT (MOVX=2, MOVY=2, MOVZ=-1)",
        [7, 15, 10],
    ),
    // Two blocks that share an edge: each gets its own copy.
    (
        "two",
        "A = BLO(X=1, Y=1, Z=1) UN BLO(X=1, Y=1, Z=1) AT (MOVX=1, MOVY=1)",
        [12, 24, 16],
    ),
    // A ball on a table: the point of contact adds nothing.
    (
        "touch",
        "A = SPH(R=1) AT (MOVZ=1) UN BLO(X=4, Y=4, Z=1) AT (MOVX=-2, MOVY=-2, MOVZ=-1)",
        [7, 13, 10],
    ),
    // A void.
    (
        "hollow",
        "A = BLO(X=4, Y=4, Z=4) DIF SPH(R=1) AT (MOVX=2, MOVY=2, MOVZ=2)",
        [7, 13, 10],
    ),
    // The ring touches itself along the circle of the ball, and is not cut there again: two copies
    // of that circle, a seam along the ring, and a meridian of either half of the ball.
    (
        "inscribed",
        "A = TOR(RMAJ=3, RMIN=1) DIF SPH(R=1) AT (MOVX=3)",
        [3, 7, 6],
    ),
];

fn part(text: &str) -> Evaluation {
    let part = read(
        "part",
        text.as_bytes(),
        Format::Padl,
        &ReadOptions::default(),
    )
    .unwrap();
    evaluate(&part.tree, &EvaluationOptions::default()).unwrap()
}

/// The number of distinct vertices at edge ends.
fn vertices(seamed: &TwoManifold<'_>) -> usize {
    let mut used: Vec<usize> = seamed.edges.iter().flat_map(|e| e.ends).collect();
    used.sort_unstable();
    used.dedup();
    used.len()
}

/// Every edge has two sides in opposite senses; loops close, and edges end in their vertices.
fn is_sound(name: &str, seamed: &TwoManifold<'_>) {
    let mut sides: HashMap<usize, Vec<Sense>> = HashMap::new();
    for face in &seamed.faces {
        assert!(!face.loops.is_empty(), "{name}");
        for ring in &face.loops {
            let ends = |HalfEdge { edge, sense }: HalfEdge| {
                let [a, b] = seamed.edges[edge].ends;
                match sense {
                    Sense::Along => [a, b],
                    Sense::Against => [b, a],
                }
            };
            let after = ring.iter().cycle().skip(1);
            for (one, next) in ring.iter().zip(after) {
                assert_eq!(ends(*one)[1], ends(*next)[0], "{name}");
                sides.entry(one.edge).or_default().push(one.sense);
            }
        }
    }
    assert_eq!(sides.len(), seamed.edges.len(), "{name}");
    for (edge, senses) in &sides {
        let both = senses.len() == 2 && senses[0] != senses[1];
        assert!(both, "{name}: edge {edge} is run {senses:?}");
    }
    for (k, edge) in seamed.edges.iter().enumerate() {
        let [from, to] = edge.range.map(|t| edge.curve.point(t));
        let middle = edge.curve.point(0.5 * (edge.range[0] + edge.range[1]));
        let length = (middle - from).norm() + (to - middle).norm();
        assert!(length > 1e-9, "{name}: edge {k} is {length:e} long");
        // A seam may run once around between two coincident vertices.
        if edge.ends[0] != edge.ends[1] && edge.source.is_some() {
            assert!((to - from).norm() > 1e-9, "{name}: edge {k} closes");
        }
        for (end, t) in edge.ends.iter().zip(edge.range) {
            let off = (seamed.points[*end] - edge.curve.point(t)).norm();
            assert!(off < 1e-9, "{name}: edge {k} ends {off:e} off");
        }
    }
}

#[test]
fn seams_are_as_few_as_can_be() {
    for (name, text, expected) in PARTS {
        let known = part(text);
        let seamed = TwoManifold::new(&known.brep, known.resolution).unwrap();
        is_sound(name, &seamed);
        let found = [seamed.faces.len(), seamed.edges.len(), vertices(&seamed)];
        assert_eq!(found, *expected, "{name}");
    }
}

/// Seams of two faces may meet the edge between them at the same point, which may be the start and
/// end of its range. Rounding moves them to both sides of it, and must not create an edge of length
/// zero.
#[test]
fn seams_that_meet_where_a_closed_edge_starts_leave_no_short_edge() {
    let solids = [
        "(CYL(R=10, H=30) UN CON(R=10, R2=8, H=2) AT (MOVZ=30))",
        "(CYL(R=12, H=10) UN CYL(R=8, H=20) AT (MOVZ=10) UN CYL(R=5, H=9) AT (MOVZ=30))",
        "(CYL(R=9, H=20) DIF CYL(R=6, H=30) AT (MOVZ=-5) DIF CON(R=8, R2=6, H=2))",
        "(CYL(R=6, H=40) UN SPH(R=6) AT (MOVZ=40))",
        "(CYL(R=9, H=20) DIF TOR(RMAJ=9, RMIN=2) AT (MOVZ=10))",
    ];
    for solid in solids {
        for degrees in 1..40 {
            for turn in ["ROTX", "ROTY"] {
                let name = format!("A = {solid} AT ({turn}={degrees})");
                let known = part(&name);
                let seamed = TwoManifold::new(&known.brep, known.resolution).unwrap();
                is_sound(&name, &seamed);
            }
        }
    }
}

/// If it is a manifold, the Euler characteristic of the whole is unchanged.
#[test]
fn seams_keep_the_characteristic() {
    for (name, text, _) in PARTS {
        let known = part(text);
        let topology = &known.brep.topology;
        let seamed = TwoManifold::new(&known.brep, known.resolution).unwrap();
        let holes: usize = seamed.faces.iter().map(|f| f.loops.len() - 1).sum();
        let cells = (vertices(&seamed) + seamed.faces.len()) as i64;
        let euler = cells - (seamed.edges.len() + holes) as i64;
        let shells = topology.shells.iter();
        let expected: i64 = shells.map(|s| 2 - 2 * i64::from(s.genus)).sum();
        assert_eq!(euler, expected, "{name}");
    }
}

/// The edge of a pocket lies in the plane of the roof, with a wall of zero thickness in between.
#[test]
fn a_wall_without_thickness_is_refused() {
    let known = part("A = WED(X=4, Y=4, Z=4) DIF BLO(X=1, Y=2, Z=1) AT (MOVX=1, MOVY=1, MOVZ=1)");
    assert_eq!(known.brep.topology.edges_of_many_faces(), 1);
    let error = TwoManifold::new(&known.brep, known.resolution).unwrap_err();
    assert_eq!(
        error,
        SeamError::Crack {
            place: [2.0, 2.0, 2.0]
        }
    );
}

/// The meridian of a rotated ball is an exact circle. No parameter curve is needed for it, although
/// the longitude of its ends is arbitrary.
#[test]
fn a_seam_has_no_splines() {
    let known = part("A = SPH(R=2) AT (MOVX=0.3, ROTX=17, ROTZ=31)");
    let options = step::StepOptions {
        name: "ball".to_owned(),
        protocol: step::Protocol::Ap214,
        unit: Unit::Inch,
        accuracy: 1e-6,
        resolution: known.resolution,
        colours: FaceColours::default(),
    };
    let file = step::write(&known.brep, &options).unwrap();
    assert!(
        !file.contains("B_SPLINE") && !file.contains("PCURVE"),
        "{file}"
    );
}

/// Readers compute the parameter of a circle at a vertex. For an arc that starts at zero the result
/// may be a whole turn.
#[test]
fn arcs_start_far_from_where_their_parameter_does() {
    let known = part(
        "A = (BLO(X=44, Y=53, Z=10) AT (MOVY=6) UN BLO(X=32, Y=65, Z=10) AT (MOVX=6)
            UN CYL(R=6, H=10) AT (MOVX=6, MOVY=6) UN CYL(R=6, H=10) AT (MOVX=38, MOVY=6)
            UN CYL(R=6, H=10) AT (MOVX=6, MOVY=59) UN CYL(R=6, H=10) AT (MOVX=38, MOVY=59)
        ) AT (ROTZ=268.2, ROTX=278.9, ROTY=180)",
    );
    let options = step::StepOptions {
        name: "plate".to_owned(),
        protocol: step::Protocol::Ap214,
        unit: Unit::Millimetre,
        accuracy: 1e-6,
        resolution: known.resolution,
        colours: FaceColours::default(),
    };
    let file = step::write(&known.brep, &options).unwrap();
    let instance = |id: &str| {
        let line = file.lines().find(|l| l.starts_with(&format!("{id}=")));
        line.unwrap().to_owned()
    };
    let ids = |line: &str| -> Vec<String> {
        let parts = line.split(['(', ',', ')', ';']);
        parts
            .filter(|p| p.starts_with('#') && !p.contains('='))
            .map(str::to_owned)
            .collect()
    };
    let numbers = |line: &str| -> Vector3<f64> {
        let numbers = line
            .split(['(', ',', ')'])
            .filter_map(|x| x.parse::<f64>().ok());
        Vector3::from_iterator(numbers)
    };
    let mut arcs = 0;
    for line in file.lines().filter(|l| l.contains("=EDGE_CURVE(")) {
        let of = ids(line);
        let mut curve = instance(&of[2]);
        if curve.contains("=SURFACE_CURVE(") {
            curve = instance(&ids(&curve)[0]);
        }
        if !curve.contains("=CIRCLE(") {
            continue;
        }
        let start = numbers(&instance(&ids(&instance(&of[0]))[0]));
        let place = ids(&instance(&ids(&curve)[0]));
        let [centre, x] = [0, 2].map(|k| numbers(&instance(&place[k])));
        assert!((start - centre).normalize().dot(&x) < 0.5, "{line}");
        arcs += 1;
    }
    assert_eq!(arcs, 8);
}

#[test]
fn every_instance_of_a_file_is_written_before_it_is_named() {
    for (name, text, _) in PARTS {
        let known = part(text);
        let options = step::StepOptions {
            name: (*name).to_owned(),
            protocol: step::Protocol::Ap242,
            unit: Unit::Millimetre,
            accuracy: 1e-6,
            resolution: known.resolution,
            colours: FaceColours::default(),
        };
        let file = step::write(&known.brep, &options).unwrap();
        let data = file.split("DATA;\n").nth(1).unwrap();
        let mut last = 0;
        for line in data.lines().take_while(|l| l.starts_with('#')) {
            let (number, entity) = line[1..].split_once('=').unwrap();
            let number: u32 = number.parse().unwrap();
            assert_eq!(number, last + 1, "{name}");
            for named in entity.split('#').skip(1) {
                let end = named.find(|c: char| !c.is_ascii_digit()).unwrap();
                assert!(
                    named[..end].parse::<u32>().unwrap() < number,
                    "{name}: {line}"
                );
            }
            last = number;
        }
        assert!(last > 30, "{name}");
        let solids = known.brep.topology.solids.len();
        let written = ["=MANIFOLD_SOLID_BREP(", "=BREP_WITH_VOIDS("];
        let count: usize = written.iter().map(|s| data.matches(s).count()).sum();
        assert_eq!(count, solids, "{name}");
    }
}

/// Two rings 1e-9 from tangent in a block: on one of them no seam reaches both of its ends. The loops
/// along it do not close, and the part is refused with the place.
#[test]
fn a_seam_that_does_not_close_is_refused() {
    let known = part(
        "A = (BLO(X=3, Y=1.5, Z=0.5) AT (MOVX=-1.5, MOVY=0.5, MOVZ=0.5)
         UN TOR(RMAJ=1, RMIN=0.5) AT (ROTY=90, MOVY=2.000000999999999999999954748111825886258685613938723690807819366455078125, MOVZ=-1.5)
         UN TOR(RMAJ=1.5, RMIN=1) AT (ROTY=0.0000000010000000000000000622815914577798564188970686927859787829220294952392578125,
             ROTX=-0.0000000010000000000000000622815914577798564188970686927859787829220294952392578125))
         PART = A AT (MOVY=2, MOVZ=-1)",
    );
    let seamed = TwoManifold::new(&known.brep, known.resolution);
    assert!(matches!(seamed, Err(SeamError::Blocked { .. })));
}
