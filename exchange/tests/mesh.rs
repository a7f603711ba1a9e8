//! Triangle files, read back.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use approx::assert_relative_eq;
use gltf::{Glb, Gltf};
use nalgebra::{Point3, Vector3};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_exchange::FaceColours;
use premio_exchange::mesh::{Facets, MeshError, glb, obj, stl};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::tessellation::Accuracy;
use premio_kernel::unit::Unit;
use std::collections::HashSet;
use std::io::Cursor;

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

fn facets(part: &Evaluation, deviation: f64) -> Result<Facets, MeshError> {
    let accuracy = Accuracy {
        deviation,
        angle: 0.3,
    };
    Facets::new(&part.brep, &accuracy, part.resolution)
}

/// Every side is a side of one triangle in each direction.
fn is_closed(facets: &Facets) -> bool {
    let mut sides = HashSet::new();
    let all = facets.facets.iter().flat_map(|f| {
        let [a, b, c] = f.corners;
        [[a, b], [b, c], [c, a]]
    });
    all.clone().all(|side| sides.insert(side)) && all.clone().all(|[a, b]| sides.contains(&[b, a]))
}

fn volume(corners: impl Iterator<Item = [Point3<f64>; 3]>) -> f64 {
    let six = corners.map(|[a, b, c]| a.coords.dot(&b.coords.cross(&c.coords)));
    six.sum::<f64>() / 6.0
}

/// Parts with their numbers of points and triangles. All faces are planes, so Euler's formula gives
/// the numbers.
const PLANE: &[(&str, &str, usize, usize)] = &[
    ("block", "A = BLO(X=1, Y=2, Z=3)", 8, 12),
    // Each block has its own copy of the common edge, with a point in the middle.
    (
        "two blocks along an edge",
        "A = BLO(X=1, Y=1, Z=1) UN BLO(X=1, Y=1, Z=1) AT (MOVX=1, MOVY=1)",
        18,
        28,
    ),
    // Each block has its own copy of the common corner.
    (
        "two blocks at a corner",
        "A = BLO(X=1, Y=1, Z=1) UN BLO(X=1, Y=1, Z=1) AT (MOVX=1, MOVY=1, MOVZ=1)",
        16,
        24,
    ),
];

#[test]
fn what_touches_has_points_of_its_own() {
    for (name, text, points, triangles) in PLANE {
        let part = part(text);
        let facets = facets(&part, 0.1).unwrap();
        assert!(is_closed(&facets), "{name}");
        let found = (facets.points.len(), facets.facets.len());
        assert_eq!(found, (*points, *triangles), "{name}");
        let exact = part.mass().volume;
        let found = volume(facets.facets.iter().map(|f| facets.corners(f)));
        assert_relative_eq!(found, exact, max_relative = 1e-12);
    }
}

/// Two faces that meet in a tip each have a triangle with the same corners there.
#[test]
fn sides_are_of_two_triangles_where_faces_come_together() {
    let parts = [
        // The halves of a ring's section with a Villarceau plane meet in the points where its
        // circles cross.
        "A = TOR(RMAJ=3, RMIN=1) DIF BLO(X=10, Y=10, Z=5) AT (MOVX=-5, MOVY=-5, ROTX=19.47122063449069)",
        "A = TOR(RMAJ=3, RMIN=1) DIF SPH(R=1) AT (MOVX=3)",
        "A = CYL(R=1, H=4) UN BLO(X=2, Y=2, Z=4) AT (MOVX=1, MOVY=-1)",
    ];
    for text in parts {
        let facets = facets(&part(text), 0.05).unwrap();
        assert!(is_closed(&facets), "{text}");
    }
}

/// A ring so coarse that one side leads from a point of its seam to a point across the tube, and
/// another from there to the same point of the seam in the other direction.
#[test]
fn a_coarse_ring_is_closed() {
    let ring = "A = TOR(RMAJ=2, RMIN=1)";
    let cut = "DIF BLO(X=4, Y=4, Z=4) AT (MOVX=-2, MOVY=0.5, MOVZ=-3)";
    for text in [ring.to_owned(), format!("{ring} {cut}")] {
        let part = part(&text);
        for deviation in [0.1, 0.5, 1.0, 2.0] {
            let accuracy = Accuracy {
                deviation,
                angle: 2.0,
            };
            let facets = Facets::new(&part.brep, &accuracy, part.resolution).unwrap();
            assert!(is_closed(&facets), "{text}: {deviation}");
        }
    }
}

/// Normals point away from the axis of a cone, at its apex, too.
#[test]
fn normals_are_the_surfaces() {
    let part = part("A = CON(R=3, H=4)");
    let facets = facets(&part, 0.01).unwrap();
    let mut at_apex = 0;
    for facet in &facets.facets {
        let is_cone = matches!(part.brep.surface(facet.face), Surface::Cone(_));
        for (p, n) in facets.corners(facet).iter().zip(&facet.normals) {
            if !is_cone {
                assert_relative_eq!(*n, -Vector3::z(), epsilon = 1e-12);
                continue;
            }
            // 4 of 5 away from the axis, 3 of 5 up.
            assert_relative_eq!(n.z, 0.6, epsilon = 1e-12);
            if p.z < 3.9 {
                let away = Vector3::new(p.x, p.y, 0.0).normalize();
                assert_relative_eq!(n.dot(&away), 0.8, epsilon = 1e-9);
            } else {
                at_apex += 1;
                let middle = facets
                    .corners(facet)
                    .iter()
                    .fold(Vector3::zeros(), |s, p| s + p.coords);
                assert!(n.dot(&middle) > 0.0);
            }
        }
    }
    assert!(at_apex > 10);
}

#[test]
fn stl_is_read_back() {
    let part = part("A = CYL(R=2, H=3) DIF SPH(R=1)");
    let facets = facets(&part, 0.01).unwrap();
    let bytes = stl::write(&facets).unwrap();
    let read = stl_io::read_stl(&mut Cursor::new(bytes)).unwrap();
    assert!(read.validate().is_ok());
    assert_eq!(read.faces.len(), facets.facets.len());
    let corners = read.faces.iter().map(|f| {
        f.vertices
            .map(|v| Point3::from(read.vertices[v].0.map(f64::from)))
    });
    assert_relative_eq!(volume(corners), part.mass().volume, max_relative = 0.01);
}

/// In metres, y up, at the original position; the edges are lines.
#[test]
fn gltf_is_read_back() {
    let part = part("A = BLO(X=10, Y=20, Z=40) AT (MOVX=1000, MOVY=2000, MOVZ=4000)");
    let facets = facets(&part, 0.1).unwrap();
    let bytes = glb::write(&facets, &FaceColours::default(), "block", Unit::Centimetre).unwrap();
    let file = Glb::from_slice(&bytes).unwrap();
    let bin = file.bin.as_deref().unwrap();
    let gltf = Gltf::from_slice(&bytes).unwrap();
    let node = gltf.nodes().next().unwrap();
    assert_eq!(node.name(), Some("block"));
    let [x, y, z, at] = node.transform().matrix();
    let place = [at[0], at[1], at[2]];
    for (found, expected) in place.iter().zip([10.05, 40.2, -20.1]) {
        assert_relative_eq!(*found, expected, max_relative = 1e-6);
    }
    assert_eq!([x[0], y[2], z[1]], [0.01, -0.01, 0.01]);
    let primitives: Vec<_> = node.mesh().unwrap().primitives().collect();
    let counts: Vec<_> = primitives
        .iter()
        .map(|p| p.indices().unwrap().count())
        .collect();
    // Twelve triangles, twelve lines.
    assert_eq!(counts, [36, 24]);
    let box_of = primitives[0].bounding_box();
    assert_eq!(
        (box_of.min, box_of.max),
        ([-5.0, -10.0, -20.0], [5.0, 10.0, 20.0])
    );
    // Each face has its own four corners.
    let positions = primitives[0].get(&gltf::Semantic::Positions).unwrap();
    assert_eq!(positions.count(), 24);
    let last = gltf
        .accessors()
        .map(|a| a.view().unwrap())
        .map(|v| v.offset() + v.length());
    assert_eq!(last.max(), Some(bin.len()));
}

/// Names are separated from what follows, and a coordinate is written as its shortest decimal.
#[test]
fn an_obj_has_an_object_for_each_solid() {
    let text = "A = BLO(X=0.1, Y=1, Z=1) UN BLO(X=1, Y=1, Z=1) AT (MOVX=2)";
    let written = obj::write(&facets(&part(text), 0.1).unwrap(), "two\nblocks");
    let objects: Vec<_> = written.lines().filter(|l| l.starts_with("o ")).collect();
    assert_eq!(objects, ["o two blocks 1", "o two blocks 2"]);
    assert!(written.contains("v 0.1 0 1\n"));
    assert_eq!(written.lines().filter(|l| l.starts_with("vn ")).count(), 6);
    assert_eq!(written.lines().filter(|l| l.starts_with("f ")).count(), 24);
}

/// A part that single precision cannot represent is refused; a format with an offset can represent
/// it.
#[test]
fn single_precision_is_refused_far_from_the_origin() {
    let far = part("A = CYL(R=1, H=1) AT (MOVX=100000000)");
    let facets = facets(&far, 0.01).unwrap();
    let place = match stl::write(&facets).unwrap_err() {
        MeshError::Coarse { place } => place,
        other => panic!("{other}"),
    };
    assert!((place[0] - 1e8).abs() <= 1.0);
    assert!(glb::write(&facets, &FaceColours::default(), "far", Unit::Metre).is_ok());
}

/// The lune between two balls is at most 3e-8 thick, less than the spacing of f32 at their radius,
/// so its two sides would coincide. Blocks that touch along an edge are written, each with its own
/// edge.
#[test]
fn a_sliver_below_single_precision_is_refused() {
    let lune = part("A = SPH(R=2) DIF SPH(R=2) AT (MOVX=0.00000003)");
    let lune = facets(&lune, 0.01).unwrap();
    assert!(matches!(stl::write(&lune), Err(MeshError::Coarse { .. })));
    assert!(!obj::write(&lune, "lune").is_empty());
    let blocks = part("A = BLO(X=1, Y=1, Z=1) UN BLO(X=1, Y=1, Z=1) AT (MOVX=1, MOVY=1)");
    assert!(stl::write(&facets(&blocks, 0.01).unwrap()).is_ok());
}

#[test]
fn an_empty_part_is_refused() {
    let nothing = part("A = BLO(X=1, Y=1, Z=1) DIF BLO(X=1, Y=1, Z=1)");
    assert_eq!(facets(&nothing, 0.1).unwrap_err(), MeshError::Empty);
}
