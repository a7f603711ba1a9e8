//! The text of a model (`premio.model/1`): it is written with its digest, read, and checked against
//! its own counts and the digest.

use super::consistency::{Consistency, Inconsistency, SourceLimits};
use super::record::{
    Aspect, Codetection, FeatureRecord, ModelHead, NO_DIGEST, Record, RelationRecord, SCHEMA,
};
use premio_text::{Content, Document, TextError, Value};
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};
use std::ops::Range;

/// A model.
#[derive(Clone, Debug)]
pub struct ModelFile {
    /// Its first record.
    pub head: ModelHead,
    /// All of its records.
    pub records: Vec<Record>,
}

impl ModelFile {
    /// Checks that the part has the edges and faces of the features.
    ///
    /// # Errors
    /// One is not, at its line of the model's text.
    pub fn check_sources(&self, text: &str, limits: &SourceLimits) -> Result<(), ModelError> {
        let mut start = 0;
        for (record, line) in self.records.iter().zip(text.lines()) {
            if let Record::Feature(feature) = record {
                let checked = limits.check("source", &feature.source);
                if let Err(error) = checked {
                    return Err(Line::new(line, start)?.inconsistent(&error));
                }
            }
            start += line.len() + 1;
        }
        Ok(())
    }

    /// The error of a value in the first line of the model's text.
    pub fn in_head(&self, text: &str, key: &str, words: &str) -> ModelError {
        let first = text.lines().next().unwrap_or_default();
        Line::new(first, 0).map_or_else(|error| error, |line| line.wrong(key, words))
    }
}

/// The digits of a digest.
pub fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// An error of a model's text, with its position.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{words}")]
pub struct ModelError {
    /// The bytes of the text.
    pub span: Range<usize>,
    /// What was found, and what was expected.
    pub words: String,
}

/// Parses the text of a model.
///
/// # Errors
/// It is no model, has another schema, is inconsistent, or was changed after it was written.
pub fn parse(text: &str) -> Result<ModelFile, ModelError> {
    let first = text.lines().next().unwrap_or_default();
    if first.trim().is_empty() {
        let words = format!("found an empty line, expected the head of a model ({SCHEMA})");
        return Err(ModelError { span: 0..0, words });
    }
    let line = Line::new(first, 0)?;
    line.check_schema()?;
    let head: ModelHead = match line.record()? {
        Record::Model(head) => *head,
        _ => return Err(line.wrong("record", "is not `model` in the first line")),
    };
    let mut consistency = Consistency::new(&head).map_err(|e| line.inconsistent(&e))?;
    let mut records = vec![Record::Model(Box::new(head.clone()))];
    let mut start = first.len() + 1;
    for next in text.lines().skip(1) {
        let line = Line::new(next, start)?;
        let record = line.record()?;
        consistency
            .next(&record)
            .map_err(|e| line.inconsistent(&e))?;
        records.push(record);
        // A line ending of two characters is never written; the digest detects it.
        start += next.len() + 1;
    }
    consistency.finish().map_err(|e| line.inconsistent(&e))?;
    let found = digest(text);
    if found.as_deref() != Some(&head.sha256) {
        let words = "is not that of this file, which was altered after it was written: \
                     make the model again";
        return Err(line.wrong("sha256", words));
    }
    Ok(ModelFile { head, records })
}

/// The byte range of the digest's digits in the first line of a text.
fn digits(text: &str) -> Option<Range<usize>> {
    const MEMBER: &str = "\"sha256\":\"";
    let first = text.lines().next()?;
    let start = first.rfind(MEMBER)? + MEMBER.len();
    let end = start + NO_DIGEST.len();
    // The text ends after them, in quotes.
    first.get(start..end)?;
    first[end..].starts_with('"').then_some(start..end)
}

/// The digest of a text, with zeros in place of its digits.
fn digest(text: &str) -> Option<String> {
    let digits = digits(text)?;
    let mut hash = Sha256::new();
    hash.update(&text[..digits.start]);
    hash.update(NO_DIGEST);
    hash.update(&text[digits.end..]);
    Some(hexadecimal(&hash.finalize()))
}

/// The text with its own digest in the first line; none where there is no place for it.
pub fn sealed(text: &str) -> Option<String> {
    let (digits, digest) = (digits(text)?, digest(text)?);
    Some(format!(
        "{}{digest}{}",
        &text[..digits.start],
        &text[digits.end..]
    ))
}

/// A line, with where it starts in the text.
struct Line {
    document: Document,
    start: usize,
}

impl Line {
    fn new(line: &str, start: usize) -> Result<Self, ModelError> {
        match Document::from_json(line) {
            Ok(document) => Ok(Self { document, start }),
            Err(error) => Err(shifted(error, start)),
        }
    }

    fn wrong(&self, key: &str, words: &str) -> ModelError {
        self.inconsistent(&Inconsistency {
            key: key.to_owned(),
            reason: words.to_owned(),
        })
    }

    fn inconsistent(&self, error: &Inconsistency) -> ModelError {
        let span = self.document.span(&error.key);
        let span = span.unwrap_or(self.document.root.span.clone());
        ModelError {
            span: span.start + self.start..span.end + self.start,
            words: error.to_string(),
        }
    }

    /// Checks that the schema is that of models, before anything else is read.
    fn check_schema(&self) -> Result<(), ModelError> {
        match self.document.root.get("schema").map(|value| &value.content) {
            Some(Content::Text(schema)) if schema == SCHEMA => Ok(()),
            Some(Content::Text(schema)) => {
                let words = format!("is \"{schema}\", expected \"{SCHEMA}\"");
                Err(self.wrong("schema", &words))
            }
            _ => Err(self.wrong("schema", &format!("is missing, expected \"{SCHEMA}\""))),
        }
    }

    fn record(&self) -> Result<Record, ModelError> {
        let root = &self.document.root;
        let kinds = "expected `model`, `feature`, `aspect`, `tuple` or `codetection`";
        let Some(Content::Text(kind)) = root.get("record").map(|value| &value.content) else {
            return Err(self.wrong("record", &format!("is missing, {kinds}")));
        };
        match kind.as_str() {
            "model" => self
                .read::<ModelHead>()
                .map(|head| Record::Model(Box::new(head))),
            "feature" => self
                .read::<FeatureRecord>()
                .map(|f| Record::Feature(Box::new(f))),
            "aspect" => self.read::<Aspect>().map(Record::Aspect),
            "tuple" => self.read::<RelationRecord>().map(Record::Tuple),
            "codetection" => self.read::<Codetection>().map(Record::Codetection),
            other => Err(self.wrong("record", &format!("is \"{other}\", {kinds}"))),
        }
    }

    /// Reads the fields of the line's record.
    fn read<T: DeserializeOwned>(&self) -> Result<T, ModelError> {
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

fn shifted(error: TextError, by: usize) -> ModelError {
    let words = error.to_string();
    let span = error.span.unwrap_or_default();
    ModelError {
        span: span.start + by..span.end + by,
        words,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digest_is_of_all_but_its_own_digits() {
        let text = format!("{{\"a\":1,\"sha256\":\"{NO_DIGEST}\"}}\nmore\n");
        let one = sealed(&text).unwrap();
        assert_ne!(one, text);
        // The result does not depend on the previous digits.
        assert_eq!(sealed(&one), Some(one.clone()));
        assert_ne!(sealed(&one.replace("more", "less")), Some(one));
        assert_eq!(sealed("{}\n"), None);
        assert_eq!(sealed("{\"sha256\":\"ä\"}"), None);
    }

    #[test]
    fn invalid_models_are_reported_at_their_position() {
        for (text, at, words) in [
            ("", 0, "empty line"),
            ("{}", 0, "`schema` is missing"),
            ("{\"schema\":\"premio.model/7\"}", 1, "premio.model/1"),
            ("{\"schema\":\"premio.model/1\"}", 0, "`record` is missing"),
            (
                "{\"schema\":\"premio.model/1\",\"record\":\"x\"}",
                27,
                "`record` is \"x\"",
            ),
            ("[", 1, "end of the text"),
        ] {
            let error = parse(text).unwrap_err();
            assert_eq!(error.span.start, at, "{text}: {error}");
            assert!(error.words.contains(words), "{text}: {error}");
        }
    }
}
