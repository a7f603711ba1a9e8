//! Triangles approximate the boundary of every named case, and rays on them agree on what is
//! hidden.

use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_kernel::tessellation::{Accuracy, tessellate};
use premio_tests::cast::Cast;
use premio_tests::random::tree;
use premio_verify::checks::views;
use premio_visibility::contours;
use std::collections::HashSet;
use std::fs;
use std::path::Path;

fn part(text: &str, format: Format) -> Option<Evaluation> {
    let description = read("part", text.as_bytes(), format, &ReadOptions::default()).ok()?;
    evaluate(&description.tree, &EvaluationOptions::default()).ok()
}

/// The fault of the mesh of a part at an accuracy, given relative to the part's size.
fn fault(part: &Evaluation, deviation: f64) -> Option<String> {
    let size = part.bounds.diagonal();
    let deviation = deviation * size;
    let accuracy = Accuracy {
        deviation,
        angle: 0.5,
    };
    let mesh = match tessellate(&part.brep, &accuracy, part.resolution) {
        Ok(mesh) => mesh,
        Err(error) => return Some(error.to_string()),
    };
    let exact = part.mass();
    let off = (mesh.volume() - exact.volume).abs();
    // The volume error of triangles that deviate everywhere by the allowed amount.
    if off.is_nan() || off > exact.area * deviation {
        return Some(format!("volume {off:e} off"));
    }
    let far = mesh.triangles.iter().flat_map(|t| {
        let [a, b, c] = t.corners.map(|c| mesh.points[c as usize]);
        let middle = a + ((b - a) + (c - a)) / 3.0;
        let surface = part.brep.surface(t.face);
        [a, b, c, middle].map(|p| surface.distance(&p).abs())
    });
    let far = far.fold(0.0, f64::max);
    if far.is_nan() || far > 2.0 * deviation {
        return Some(format!("a triangle {far:e} off its surface"));
    }
    if !mesh.is_watertight() {
        return Some("not watertight".to_owned());
    }
    // If no edge has four faces, no side has four triangles.
    let mut sides = HashSet::new();
    let mut ends = mesh.triangles.iter().flat_map(|t| {
        let [a, b, c] = t.corners;
        [[a, b], [b, c], [c, a]]
    });
    let once = ends.all(|side| sides.insert(side));
    let crowded = part.brep.topology.edges_of_many_faces() > 0;
    (!once && !crowded).then(|| "a side of four triangles".to_owned())
}

/// Parts whose faces are narrow, or whose edges run through the middle of a chart.
#[rustfmt::skip]
const NARROW: &[(&str, &str)] = &[
    ("a cone barely out of a torus", r#"{"op":"union","children":[{"prim":"torus","R":2,"r":1.5},{"prim":"cone","r":1,"h":0.5,"transform":[{"rotate":[[1,0,0],90]},{"translate":[1,0.5,1]},{"rotate":[[0,0,1],90]},{"translate":[2,0,-0.5]}]}]}"#),
    ("a sliver between a rim and a torus", r#"{"op":"difference","children":[{"prim":"cone","r":1,"h":1.5,"transform":[{"rotate":[[0,1,0],-90]},{"translate":[-1.5,2,0.5]}]},{"prim":"torus","R":2,"r":1,"transform":[{"translate":[0.5,1.5,0.5]}]}]}"#),
    ("an edge that ends at an apex", r#"{"op":"union","children":[{"prim":"cone","r":2,"h":2,"transform":[{"rotate":[[0,1,0],-90]},{"translate":[0,-0.5,1.5]}]},{"prim":"frustum","r1":0.5,"r2":2,"h":2.5,"transform":[{"translate":[-2,-1,1.5]}]}]}"#),
    ("a great circle", r#"{"op":"union","children":[{"prim":"frustum","r1":1,"r2":0,"h":3},{"prim":"sphere","r":1},{"prim":"cylinder","r":1,"h":2,"transform":[{"rotate":[[1,0,0],-90]},{"translate":[-1,-2,-0.5]}]},{"prim":"cylinder","r":1.5,"h":0.5,"transform":[{"rotate":[[1,0,0],-90]},{"translate":[-1,-2,-0.5]}]}]}"#),
    ("a ball with a slit all but around", r#"{"op":"union","children":[{"prim":"sphere","r":0.25,"transform":[{"translate":[3,0,0]}]},{"op":"difference","children":[{"prim":"torus","R":3,"r":0.75},{"prim":"torus","R":3,"r":0.25},{"prim":"block","size":[10,10,0.125],"transform":[{"translate":[-5,-5,0]}]}]}]}"#),
];

/// Cases without triangles: a face has edges that are 1e-9 apart or on one line in `f64`, or an edge 4e-17
/// long.
const REFUSED: [&str; 3] = [
    "cone-around-a-ball-with-a-lip-of-1e-9",
    "coplanar-faces-tilted-by-1e-7",
    "horn-ring-less-a-block-1e-8-above-its-pole",
];

#[test]
fn triangles_follow_every_named_case() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut complaints = Vec::new();
    let mut followed = 0;
    for folder in fs::read_dir(root).unwrap() {
        let folder = folder.unwrap().path();
        let text = fs::read_to_string(folder.join("model.padl")).unwrap();
        let Some(part) = part(&text, Format::Padl) else {
            continue;
        };
        followed += 1;
        let is_refused = REFUSED.iter().any(|name| folder.ends_with(name));
        for deviation in [0.02, 0.001] {
            let fault = fault(&part, deviation);
            if is_refused {
                let text = fault.unwrap_or_default();
                assert!(text.contains("too close to one another"), "{text}");
            } else if let Some(fault) = fault {
                complaints.push(format!("{}: {deviation}: {fault}", folder.display()));
            }
        }
    }
    assert!(followed > 70, "{followed}");
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn a_whole_sphere_and_a_whole_torus_are_closed() {
    for text in ["P = SPH(R=2)", "P = TOR(RMAJ=3, RMIN=1)"] {
        let part = part(text, Format::Padl).unwrap();
        for deviation in [0.02, 0.001, 0.0001] {
            assert_eq!(fault(&part, deviation), None, "{text} {deviation}");
        }
    }
}

#[test]
fn rays_on_triangles_find_pieces_that_are_wrong() {
    let (mut raised, mut found) = (0, 0);
    for seed in 0..12 {
        let part = part(&tree(seed).to_string(), Format::Json).unwrap();
        let cast = Cast::new(&part).unwrap();
        assert_eq!(cast.faults(&part), None);
        for view in views::around(&part.bounds).iter().take(3) {
            let mut seen = contours(&part.brep, &view.camera, part.resolution).unwrap();
            let before = cast.count(&seen);
            assert!(before.wrong.is_empty(), "{seed} {}: {before:?}", view.name);
            // Nearly all samples are far enough from everything else.
            assert!(before.agreed >= 2 * before.unclear, "{seed}: {before:?}");
            for contour in &mut seen.contours {
                for piece in &mut contour.pieces {
                    piece.quantitative_invisibility += 1;
                    raised += 2;
                }
            }
            found += cast.count(&seen).wrong.len();
        }
    }
    assert!(4 * found > raised, "{found} of {raised}");
}

#[test]
fn narrow_faces_are_followed() {
    for (name, text) in NARROW {
        let part = part(text, Format::Json).unwrap();
        for deviation in [1e-2, 2e-3, 5e-4] {
            assert_eq!(fault(&part, deviation), None, "{name} at {deviation}");
        }
    }
}

/// 22,214 points on a circle: inserted in order, each would flip the triangles of all before it.
#[test]
fn a_circle_of_many_points_is_followed() {
    let part = part("P = CYL(R=1, H=1)", Format::Padl).unwrap();
    assert_eq!(fault(&part, 1e-8 / part.bounds.diagonal()), None);
}

/// The permitted length of a triangle's side is proportional to the square root of the radius of
/// curvature, and the ring's is that of the tube times up to 100,000.
#[test]
fn a_thin_ring_takes_no_more_triangles_than_a_thick_one() {
    let count = |minor: &str, cut: &str| {
        let text = format!("P = TOR(RMAJ=50, RMIN={minor}){cut}");
        let part = part(&text, Format::Padl).unwrap();
        assert_eq!(fault(&part, 1e-4), None, "{text}");
        let accuracy = Accuracy {
            deviation: 0.01,
            angle: 0.5,
        };
        let mesh = tessellate(&part.brep, &accuracy, part.resolution).unwrap();
        mesh.triangles.len()
    };
    for cut in ["", " DIF BLO(X=100, Y=100, Z=10) AT (MOVZ=-5)"] {
        let thick = count("5", cut);
        for minor in ["0.1", "0.01", "0.0005"] {
            let thin = count(minor, cut);
            assert!(2 * thin < 3 * thick, "{minor}{cut}: {thin} for {thick}");
        }
    }
}
