//! Arbitrary bytes as setups, of one image and of a model. None may panic or hang; errors have a
//! position in the text; a setup that is written and read again is the same.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nalgebra::Point3;
use premio_predict::setup::light::{IncidentLight, LightSource};
use premio_predict::setup::setups::Setups;
use premio_predict::setup::{Setup, SetupError};

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    match Setup::from_toml(text) {
        Err(error) => check_span(&error, text),
        Ok(setup) => {
            let again = toml::to_string(&setup).expect("a setup is written");
            assert_eq!(Setup::from_toml(&again), Ok(setup.clone()), "{again}");
            used(&setup);
        }
    }
    match Setups::from_toml(text) {
        Err(error) => check_span(&error, text),
        Ok(setups) => {
            let again = toml::to_string(&setups).expect("setups are written");
            assert_eq!(Setups::from_toml(&again), Ok(setups.clone()), "{again}");
            for index in [0, setups.len() - 1] {
                let [view, light] = setups.directions(index);
                assert!(view.is_some_and(|v| (v.norm() - 1.0).abs() < 1e-9));
                assert_eq!(light.is_some(), setups.illumination.is_some());
            }
        }
    }
});

/// Checks that the position of an error is in the text.
fn check_span(error: &SetupError, text: &str) {
    assert!(!error.to_string().is_empty());
    if let Some(span) = error.span(text) {
        assert!(text.get(span.clone()).is_some(), "{span:?} {error}\n{text}");
    }
}

/// Evaluates a valid setup as a prediction would.
fn used(setup: &Setup) {
    let sensor = &setup.conditions.sensor;
    let centre = Point3::new(1.0, 2.0, 3.0);
    if let Ok(matrices) = setup.camera.matrices(sensor, &centre) {
        assert!(matrices.camera().is_ok());
    }
    for light in &setup.lights {
        let IncidentLight {
            direction,
            strength,
        } = LightSource::new(light, &Point3::origin()).from(&centre);
        // A light may be at the point itself.
        let length = direction.norm();
        assert!(length.is_nan() || (length - 1.0).abs() < 1e-9, "{light:?}");
        assert!(strength.is_nan() || strength >= 0.0, "{light:?}");
    }
}
