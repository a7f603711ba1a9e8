//! What a match is handed on as: the report in JSON and CSV, and its explanation in words.

pub mod explain;
pub mod report;
