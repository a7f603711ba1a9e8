//! XML, event after event.
//!
//! No tree is built, so that what an element costs does not depend on the elements around it. A
//! document type is refused: its entities could be longer than the file.

use std::borrow::Cow;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::MeshFileError;
use super::words::text;

/// The beginning of an element, its end, or the text between.
pub(super) enum XmlEvent<'t> {
    Start(XmlElement<'t>),
    End,
    Text(Cow<'t, str>),
}

/// The beginning of an element.
pub(super) struct XmlElement<'t>(BytesStart<'t>);

impl XmlElement<'_> {
    /// Its name without a prefix.
    pub fn name(&self) -> &str {
        self.0.local_name().into_inner()
    }

    /// The value of an attribute, by its name without a prefix. References are not replaced.
    pub fn attribute(&self, name: &str) -> Option<Cow<'_, str>> {
        let mut attributes = self.0.attributes();
        // The time of the check grows with the square of the number of attributes.
        attributes.with_checks(false);
        let mut attributes = attributes.filter_map(Result::ok);
        let found = attributes.find(|attribute| attribute.key.local_name().into_inner() == name);
        found.map(|attribute| attribute.value)
    }
}

pub(super) struct XmlReader<'t> {
    text: &'t str,
    reader: Reader<&'t [u8]>,
    depth: usize,
}

impl<'t> XmlReader<'t> {
    pub fn new(bytes: &'t [u8]) -> Result<Self, MeshFileError> {
        let text = text(bytes)?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut reader = Reader::from_str(text);
        reader.config_mut().expand_empty_elements = true;
        let depth = 0;
        Ok(Self {
            text,
            reader,
            depth,
        })
    }

    /// The next event; `None` at the end.
    pub fn next(&mut self) -> Result<Option<XmlEvent<'t>>, MeshFileError> {
        loop {
            let event = self.reader.read_event();
            let event = event.map_err(|_| self.wrong("well-formed XML"))?;
            return Ok(Some(match event {
                Event::Start(start) | Event::Empty(start) => {
                    self.depth += 1;
                    XmlEvent::Start(XmlElement(start))
                }
                Event::End(_) => {
                    self.depth = self.depth.saturating_sub(1);
                    XmlEvent::End
                }
                Event::Text(text) => XmlEvent::Text(text.into_inner()),
                Event::CData(text) => XmlEvent::Text(text.into_inner()),
                // A reference is no part of a number.
                Event::GeneralRef(_) => XmlEvent::Text(Cow::Borrowed("&")),
                Event::DocType(_) => return Err(self.wrong("XML without a document type")),
                Event::Comment(_) | Event::Decl(_) | Event::PI(_) => continue,
                Event::Eof if self.depth == 0 => return Ok(None),
                Event::Eof => return Err(self.wrong("the end of every element")),
            }));
        }
    }

    /// The error at the line that was read last.
    pub fn wrong(&self, expected: &'static str) -> MeshFileError {
        let at = usize::try_from(self.reader.buffer_position()).unwrap_or(usize::MAX);
        let before = &self.text.as_bytes()[..at.min(self.text.len())];
        let line = before.iter().filter(|byte| **byte == b'\n').count() + 1;
        MeshFileError::Line { line, expected }
    }
}
