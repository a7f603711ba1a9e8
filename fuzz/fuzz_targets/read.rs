//! Arbitrary bytes for each of the readers. None may panic, overflow the stack or hang. A part that
//! is read is written, and must be read again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use premio_csg::reader::{
    FacetLimit, Format, IncludeError, IncludeLoader, IncludePath, Includes, Program, ReadOptions,
    parse, read,
};
use premio_csg::writer::{WriteError, write};

fuzz_target!(|bytes: &[u8]| {
    for facets in [FacetLimit::default(), FacetLimit::None, FacetLimit::All] {
        let options = ReadOptions {
            facets,
            includes: Includes::new(Echo(bytes.to_vec())),
            ..ReadOptions::default()
        };
        for format in Format::ALL {
            match parse("input", bytes, format, &options) {
                Err(error) => {
                    let length = error.text.as_ref().map_or(bytes.len(), |text| text.len());
                    assert!(error.span.start <= error.span.end && error.span.end <= length);
                }
                // The limit of facets does not change what is written.
                Ok(source) if facets == FacetLimit::default() => {
                    again(&source.builder, source.part);
                    alone(&source);
                }
                Ok(_) => {}
            }
        }
    }
});

/// The text without included files describes the same part.
fn alone(source: &Program) {
    let (Some(text), Ok(tree)) = (
        source.standalone.rewritten(),
        source.builder.finish(source.part),
    ) else {
        return;
    };
    let options = ReadOptions::default();
    let other = read("alone", text.as_bytes(), Format::Padl, &options);
    let other = other.unwrap_or_else(|error| panic!("{error}\n{text}")).tree;
    assert!(tree == other, "{text}");
}

/// Every included file has the bytes of the input from a position on, which its name gives.
#[derive(Debug)]
struct Echo(Vec<u8>);

impl IncludeLoader for Echo {
    fn find(&self, _: Option<&str>, path: &str) -> Result<IncludePath, IncludeError> {
        let (name, identity) = (path.to_owned(), path.to_owned());
        Ok(IncludePath { name, identity })
    }

    fn load(&self, file: &IncludePath) -> Result<Vec<u8>, IncludeError> {
        let start = file.name.trim_end_matches(".padl").parse().unwrap_or(0);
        Ok(self.0.get(start..).unwrap_or_default().to_vec())
    }
}

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
