//! Arbitrary bytes as cameras, of `contours` and of pictures. None may panic or hang; errors have a
//! position in the text; a camera that is read has a view of a part.
#![no_main]

use libfuzzer_sys::fuzz_target;
use nalgebra::Point3;
use premio_fuzz::BORED_BLOCK;
use premio_matching::camera::CameraFile;
use premio_visibility::camera::projection::Projection;
use premio_visibility::{ViewCamera, contours};
use std::ops::Range;

fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return;
    };
    match ViewCamera::from_json(text) {
        Err(error) => check_span(&error.to_string(), error.span(text), text),
        Ok(camera) => {
            let again = serde_json::to_string(&camera).expect("a camera is written");
            assert_eq!(ViewCamera::from_json(&again), Ok(camera.clone()), "{again}");
            let size = BORED_BLOCK.bounds.diagonal();
            let projection = Projection::new(&camera, size);
            let depth = projection.depth(&Point3::new(3.0, 2.0, 1.0));
            assert!(!depth.is_nan(), "{text}");
            // A camera without a view returns an error.
            let _ = contours(&BORED_BLOCK.brep, &camera, BORED_BLOCK.resolution);
        }
    }
    match CameraFile::from_json(text) {
        Err(error) => check_span(&error.to_string(), error.span(text), text),
        Ok(file) => {
            for size in [[640, 480], [1, 1], [100_000, 3]] {
                if let Ok(pinhole) = file.for_picture(size) {
                    let ray = pinhole.ray(&nalgebra::Point2::new(3.0, 4.0));
                    assert!((ray.norm() - 1.0).abs() < 1e-9, "{text}");
                }
            }
        }
    }
});

/// Checks that the position of an error is in the text.
fn check_span(words: &str, span: Option<Range<usize>>, text: &str) {
    assert!(!words.is_empty());
    let span = span.unwrap_or_else(|| panic!("{words} has no place\n{text}"));
    assert!(text.get(span.clone()).is_some(), "{span:?} {words}\n{text}");
}
