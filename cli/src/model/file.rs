//! Models in files: read, held against their own counts, and against their digest.

use crate::diagnostics::Failure;
use crate::session::Session;
use premio_predict::model::consistency::{Consistency, Inconsistency};
use premio_predict::model::record::{
    Aspect, Codetection, Feature, Head, NO_DIGEST, Record, SCHEMA, Tuple,
};
use premio_text::{Content, Document, TextError, Value};
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};
use std::ops::Range;
use std::path::Path;

/// A model.
#[derive(Debug)]
pub struct ModelFile {
    /// Its first record.
    pub head: Head,
    /// All of its records.
    pub records: Vec<Record>,
}

/// The digits of a digest.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Reads a model.
///
/// # Errors
/// The file is none, is of another schema, says what does not add up, or is not as it was written.
pub fn read(path: &Path, session: Session) -> Result<ModelFile, Failure> {
    let text = session.limits.read_text(path)?;
    let name = path.display().to_string();
    parsed(&text).map_err(|wrong| Failure::at(&name, &text, Some(wrong.span), &wrong.words))
}

/// What is wrong with a model's text, and where.
#[derive(Debug)]
struct Wrong {
    span: Range<usize>,
    words: String,
}

/// The records of a text.
fn parsed(text: &str) -> Result<ModelFile, Wrong> {
    let first = text.lines().next().unwrap_or_default();
    if first.trim().is_empty() {
        let words = format!("found an empty line, expected the head of a model ({SCHEMA})");
        return Err(Wrong { span: 0..0, words });
    }
    let line = Line::of(first, 0)?;
    line.check_schema()?;
    let head: Head = match line.record()? {
        Record::Model(head) => *head,
        _ => return Err(line.wrong("record", "is not `model` in the first line")),
    };
    let mut consistency = Consistency::new(&head).map_err(|e| line.inconsistent(&e))?;
    let mut records = vec![Record::Model(Box::new(head.clone()))];
    let mut start = first.len() + 1;
    for next in text.lines().skip(1) {
        let line = Line::of(next, start)?;
        let record = line.record()?;
        consistency
            .next(&record)
            .map_err(|e| line.inconsistent(&e))?;
        records.push(record);
        // An ending of two characters is not one that was written; the digest tells.
        start += next.len() + 1;
    }
    consistency.finish().map_err(|e| line.inconsistent(&e))?;
    let found = digest(text, &head.sha256);
    if found.as_deref() != Some(&head.sha256) {
        let words = "is not that of this file, which was altered after it was written: \
                     make the model again";
        return Err(line.wrong("sha256", words));
    }
    Ok(ModelFile { head, records })
}

/// The digest of a text whose first line holds these digits, with zeros in their place.
fn digest(text: &str, digits: &str) -> Option<String> {
    let first = text.lines().next()?;
    let member = format!("\"sha256\":\"{digits}\"");
    let start = first.rfind(&member)? + member.len() - 1 - digits.len();
    let mut hash = Sha256::new();
    hash.update(&text[..start]);
    hash.update(NO_DIGEST);
    hash.update(&text[start + digits.len()..]);
    Some(hexadecimal(&hash.finalize()))
}

/// A line, with where it starts in the text.
struct Line {
    document: Document,
    start: usize,
}

impl Line {
    fn of(line: &str, start: usize) -> Result<Self, Wrong> {
        match Document::from_json(line) {
            Ok(document) => Ok(Self { document, start }),
            Err(error) => Err(shifted(error, start)),
        }
    }

    fn wrong(&self, key: &str, words: &str) -> Wrong {
        self.inconsistent(&Inconsistency {
            key: key.to_owned(),
            reason: words.to_owned(),
        })
    }

    fn inconsistent(&self, error: &Inconsistency) -> Wrong {
        let span = self.document.span(&error.key);
        let span = span.unwrap_or(self.document.root.span.clone());
        Wrong {
            span: span.start + self.start..span.end + self.start,
            words: error.to_string(),
        }
    }

    /// Whether the schema is that of models, before anything else is looked at.
    fn check_schema(&self) -> Result<(), Wrong> {
        match self.document.root.get("schema").map(|value| &value.content) {
            Some(Content::Text(schema)) if schema == SCHEMA => Ok(()),
            Some(Content::Text(schema)) => {
                let words = format!("is \"{schema}\", expected \"{SCHEMA}\"");
                Err(self.wrong("schema", &words))
            }
            _ => Err(self.wrong("schema", &format!("is missing, expected \"{SCHEMA}\""))),
        }
    }

    fn record(&self) -> Result<Record, Wrong> {
        let root = &self.document.root;
        let kinds = "expected `model`, `feature`, `aspect`, `tuple` or `codetection`";
        let Some(Content::Text(kind)) = root.get("record").map(|value| &value.content) else {
            return Err(self.wrong("record", &format!("is missing, {kinds}")));
        };
        match kind.as_str() {
            "model" => self
                .read::<Head>()
                .map(|head| Record::Model(Box::new(head))),
            "feature" => self.read::<Feature>().map(|f| Record::Feature(Box::new(f))),
            "aspect" => self.read::<Aspect>().map(Record::Aspect),
            "tuple" => self.read::<Tuple>().map(Record::Tuple),
            "codetection" => self.read::<Codetection>().map(Record::Codetection),
            other => Err(self.wrong("record", &format!("is \"{other}\", {kinds}"))),
        }
    }

    /// What the line holds besides the kind of its record.
    fn read<T: DeserializeOwned>(&self) -> Result<T, Wrong> {
        let Content::Object(members) = &self.document.root.content else {
            return Err(self.wrong("record", "is missing"));
        };
        let others = members.iter().filter(|member| member.key != "record");
        let value = Value {
            content: Content::Object(others.cloned().collect()),
            span: self.document.root.span.clone(),
        };
        value.read().map_err(|error| shifted(error, self.start))
    }
}

fn shifted(error: TextError, by: usize) -> Wrong {
    let words = error.to_string();
    let span = error.span.unwrap_or_default();
    Wrong {
        span: span.start + by..span.end + by,
        words,
    }
}
