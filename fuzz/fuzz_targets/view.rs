//! Views of small parts: no panic, consecutive pieces, and a drawing.
#![no_main]

use libfuzzer_sys::fuzz_target;
use premio_fuzz::{Part, Recipe};
use premio_visibility::contours;

fuzz_target!(|bytes: &[u8]| {
    let mut recipe = Recipe::new(bytes);
    let sight = recipe.sight();
    let Some(part) = Part::new(&recipe.model()) else {
        return;
    };
    let Some(camera) = part.camera(&sight) else {
        return;
    };
    let Some(resolution) = part.evaluation.view_resolution() else {
        return;
    };
    let Ok(seen) = contours(&part.evaluation.brep, &camera, resolution) else {
        return;
    };
    for contour in &seen.contours {
        let ranges = contour.pieces.iter().map(|piece| piece.range);
        let ordered = ranges.clone().all(|[lo, hi]| lo < hi)
            && ranges
                .clone()
                .zip(ranges.skip(1))
                .all(|(a, b)| a[1] <= b[0]);
        assert!(ordered, "{:?}\n{}", contour.pieces, part.text);
    }
});
