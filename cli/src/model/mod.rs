//! Models of many setups: their files.

pub mod file;
pub mod format;
#[cfg(feature = "parquet")]
mod parquet;
