//! Triangles follow the boundary of every named case, and rays on them see what is hidden.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use premio::checks::views;
use premio_csg::boundary::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, Options, read};
use premio_kernel::brep::mass::mass;
use premio_kernel::tessellation::{Accuracy, tessellate};
use premio_tests::cast::Cast;
use premio_tests::random::tree;
use premio_visibility::contours;
use std::fs;
use std::path::Path;

fn part(text: &str, format: Format) -> Option<Evaluation> {
    let description = read("part", text.as_bytes(), format, &Options::default()).ok()?;
    evaluate(&description.tree, &EvaluationOptions::default()).ok()
}

/// What is wrong with the mesh of a part at an accuracy, given as a part of its size.
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
    let exact = mass(&part.brep);
    let off = (mesh.volume() - exact.volume).abs();
    // Triangles that are off everywhere, by as much as they may be.
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
    (!mesh.is_watertight()).then(|| "not watertight".to_owned())
}

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
        for deviation in [0.02, 0.001] {
            if let Some(fault) = fault(&part, deviation) {
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
        let cast = Cast::of(&part).unwrap();
        assert_eq!(cast.faults(&part), None);
        for view in views::around(&part.bounds).iter().take(3) {
            let mut seen = contours(&part.brep, &view.camera, part.resolution).unwrap();
            let before = cast.count(&seen);
            assert!(before.wrong.is_empty(), "{seed} {}: {before:?}", view.name);
            // Nearly all samples are far enough from all else.
            assert!(before.agreed >= 2 * before.unclear, "{seed}: {before:?}");
            for contour in &mut seen.contours {
                for piece in &mut contour.pieces {
                    piece.qi += 1;
                    raised += 2;
                }
            }
            found += cast.count(&seen).wrong.len();
        }
    }
    assert!(4 * found > raised, "{found} of {raised}");
}
