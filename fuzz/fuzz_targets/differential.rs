//! Two independent ways to every answer, on small parts: point membership by the boundary and by
//! the tree; the quantitative invisibility of every piece of a view, and the completeness of
//! contours, against rays in the tree.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nalgebra::Vector3;
use premio_csg::ray_casting::RayOracle;
use premio_fuzz::{Part, Recipe};
use premio_kernel::brep::point_in_solid::contains;
use premio_verify::checks::{Checker, Finding};

/// The number of points that are classified.
const POINTS: u32 = 32;

fuzz_target!(|bytes: &[u8]| {
    let mut recipe = Recipe::new(bytes);
    let sight = recipe.sight();
    let Some(part) = Part::new(&recipe.model()) else {
        return;
    };
    let known = &part.evaluation;
    let material = RayOracle::new(&part.tree);
    // Points near the boundary within the resolution are skipped.
    let resolution = known.f64_resolution();
    let near = 1000.0 * resolution;
    let steps = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| axis * near);
    for p in (0..POINTS).map(|k| part.place(k)) {
        let held = material.contains(&p);
        let around = steps.iter().flat_map(|step| [p + step, p - step]);
        if around.clone().all(|q| material.contains(&q) == held)
            && let Some(told) = contains(&known.brep, &p, resolution)
        {
            assert_eq!(told, held, "at {p}\n{}", part.text);
        }
    }
    if let Some(camera) = part.camera(&sight) {
        for check in Checker::new(&part.tree, known).view("of the fuzzer", &camera) {
            assert!(
                check.finding != Finding::Fails,
                "{}: {}\n{}",
                check.subject,
                check.detail,
                part.text
            );
        }
    }
});
