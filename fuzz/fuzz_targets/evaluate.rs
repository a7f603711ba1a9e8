//! Small parts: no panic, the boundary keeps its rules, its measures are those of a solid, and a
//! second evaluation gives the same result.
#![no_main]

use libfuzzer_sys::fuzz_target;
use premio_fuzz::{Part, Recipe};

fuzz_target!(|bytes: &[u8]| {
    let model = Recipe::new(bytes).model();
    let Some(part) = Part::new(&model) else {
        return;
    };
    let violations = part.evaluation.violations();
    assert!(violations.is_empty(), "{violations:?}\n{}", part.text);
    let mass = part.evaluation.mass();
    let size = part.evaluation.bounds.diagonal();
    let within = mass.volume <= size.powi(3) && mass.area.is_finite();
    assert!(mass.volume >= 0.0 && within, "{mass:?}\n{}", part.text);
    let again = Part::new(&model).map(|again| again.evaluation.mass());
    assert_eq!(again, Some(mass), "{}", part.text);
});
