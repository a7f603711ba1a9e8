//! Arbitrary bytes as a model. None may panic or hang, and errors have a position in the text. The
//! digest is corrected, so that the rest is tested, too; a model that is read is used for matching.
#![no_main]

use libfuzzer_sys::fuzz_target;
use premio_fuzz::BORED_BLOCK;
use premio_matching::part::detectability_prior::DetectabilityPrior;
use premio_predict::model::file::{ModelFile, parse, sealed};

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    tried(text);
    if let Some(text) = sealed(text)
        && let Some(model) = tried(&text)
    {
        let learned = DetectabilityPrior::new(&model.records, &BORED_BLOCK.brep);
        for record in &model.records {
            if let premio_predict::model::record::Record::Feature(feature) = record {
                let states = learned.states(&feature.source);
                let sums = states.map(|s| s.iter().sum::<f64>());
                assert!(
                    sums.iter().all(|s| (s - 1.0).abs() < 1e-9),
                    "{states:?}\n{text}"
                );
            }
        }
    }
});

fn tried(text: &str) -> Option<ModelFile> {
    match parse(text) {
        Ok(model) => Some(model),
        Err(error) => {
            assert!(!error.words.is_empty());
            let span = error.span.clone();
            assert!(text.get(span).is_some(), "{error:?}\n{text}");
            None
        }
    }
}
