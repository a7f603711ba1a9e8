//! Arbitrary bytes for each of the readers. None may panic, overflow the stack or hang. A part that
//! is read is written, and must be read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use premio_csg::reader::{FacetLimit, Format, ReadOptions, parse, read};
use premio_csg::writer::{WriteError, write};

fuzz_target!(|bytes: &[u8]| {
    for facets in [FacetLimit::default(), FacetLimit::None, FacetLimit::All] {
        let options = ReadOptions {
            facets,
            ..ReadOptions::default()
        };
        for format in Format::ALL {
            match parse("input", bytes, format, &options) {
                Err(error) => {
                    assert!(error.span.start <= error.span.end && error.span.end <= bytes.len());
                }
                // The limit of facets does not change what is written.
                Ok(source) if facets == FacetLimit::default() => again(&source.builder, source.part),
                Ok(_) => {}
            }
        }
    }
});

/// Writes a part in each language; a language that can express it must give the same tree.
fn again(builder: &premio_csg::builder::Builder, part: premio_csg::builder::SolidId) {
    let Ok(tree) = builder.finish(part) else {
        return;
    };
    if tree.leaves().count() > 1000 {
        return;
    }
    for format in [Format::Csg, Format::Json] {
        // Values that these cannot express are rounded, and may then give no solid.
        if let Ok(text) = write(builder, part, format) {
            let _ = read("again", text.as_bytes(), format, &ReadOptions::default());
        }
    }
    match write(builder, part, Format::Padl) {
        Err(WriteError::Empty) => {}
        // Numbers of a thousand digits are rounded, too.
        Ok(text) if text.len() > 1000 => {}
        written => {
            let text = written.expect("a small part is written");
            let other = read(
                "again",
                text.as_bytes(),
                Format::Padl,
                &ReadOptions::default(),
            );
            let other = other.unwrap_or_else(|error| panic!("{error}\n{text}")).tree;
            assert!(tree.departure(&other).is_some(), "{text}");
        }
    }
}
