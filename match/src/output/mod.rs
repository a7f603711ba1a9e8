//! The outputs of a match: the report in JSON and CSV, and its explanation in words.

pub mod explain;
pub mod report;
