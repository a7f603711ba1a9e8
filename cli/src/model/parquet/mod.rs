//! Models as Apache Parquet: one table, whose columns identify its rows.
//!
//! Rows are features, aspects, the features of each aspect, and relations, in the order of the
//! records; values that a row does not have are null. The co-detection of features is in the
//! features' rows. The first record is the file's metadata, under the name of the format.

mod column;
#[cfg(test)]
mod tests;

use ::parquet::errors::ParquetError;
use ::parquet::file::metadata::KeyValue;
use ::parquet::file::properties::WriterProperties;
use ::parquet::file::writer::SerializedFileWriter;
use ::parquet::schema::parser::parse_message_type;
use column::COLUMNS;
use premio_predict::model::record::{Record, SCHEMA};
use serde_json::Value;
use std::collections::HashMap;
use std::sync::Arc;

/// Why there is no table.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// A record cannot be written as JSON.
    #[error("a record of the model: {0}")]
    Record(#[from] serde_json::Error),
    /// A value does not have the type of its column.
    #[error("column `{column}` of the model: found {found}")]
    Cell {
        /// The column.
        column: &'static str,
        /// The value.
        found: Value,
    },
    /// The table could not be written.
    #[error("{0}")]
    Parquet(#[from] ParquetError),
}

/// The table of a model.
pub fn bytes(records: &[Record]) -> Result<Vec<u8>, TableError> {
    let TableRows { head, rows } = rows(records)?;
    let head = KeyValue::new(SCHEMA.to_owned(), head.to_string());
    let properties = WriterProperties::builder()
        .set_created_by(concat!("premio ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_key_value_metadata(Some(vec![head]))
        .build();
    let fields: String = COLUMNS.iter().map(column::Column::field).collect();
    let schema = parse_message_type(&format!("message premio_model {{ {fields} }}"))?;
    let mut writer = SerializedFileWriter::new(Vec::new(), Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for column in COLUMNS {
        if let Some(mut cells) = group.next_column()? {
            column.write(&rows, &mut cells)?;
            cells.close()?;
        }
    }
    group.close()?;
    Ok(writer.into_inner()?)
}

/// The records of a model.
struct TableRows {
    /// The first record.
    head: Value,
    /// The rows of the others.
    rows: Vec<Value>,
}

/// The rows of a model's table.
fn rows(records: &[Record]) -> Result<TableRows, TableError> {
    let mut head = Value::Null;
    let mut rows = Vec::new();
    let mut together = together(records)?;
    for record in records {
        let mut row = serde_json::to_value(record)?;
        match record {
            Record::Model(_) => head = row,
            Record::Feature(feature) => {
                row["together"] = together.remove(&feature.rank).unwrap_or_default();
                rows.push(row);
            }
            Record::Aspect(aspect) => {
                let features = row["features"].take();
                rows.push(row);
                let Value::Array(features) = features else {
                    continue;
                };
                rows.extend(features.into_iter().map(|mut feature| {
                    feature["record"] = "aspectfeature".into();
                    feature["aspect"] = aspect.rank.into();
                    feature
                }));
            }
            Record::Tuple(_) => rows.push(row),
            Record::Codetection(_) => {}
        }
    }
    Ok(TableRows { head, rows })
}

/// By feature: its node of the co-detection tree.
fn together(records: &[Record]) -> Result<HashMap<usize, Value>, TableError> {
    let trees = records.iter().filter_map(|record| match record {
        Record::Codetection(found) => Some(&found.tree),
        _ => None,
    });
    let mut nodes = HashMap::new();
    for node in trees.flatten() {
        nodes.insert(node.feature, serde_json::to_value(node)?);
    }
    Ok(nodes)
}
