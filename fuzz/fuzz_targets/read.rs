//! Any bytes, to each of the readers: none may panic, overflow the stack or hang.
#![no_main]

use libfuzzer_sys::fuzz_target;
use premio_csg::reader::{Format, Options, read};

fuzz_target!(|bytes: &[u8]| {
    for smooth in [false, true] {
        let options = Options { smooth, part: None };
        for format in [Format::Padl, Format::Csg, Format::Json] {
            if let Err(error) = read("input", bytes, format, &options) {
                assert!(error.span.start <= error.span.end && error.span.end <= bytes.len());
            }
        }
    }
});
