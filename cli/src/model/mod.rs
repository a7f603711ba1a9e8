//! Models of many setups: shards in files, and what they come to.

pub mod file;
pub mod format;
#[cfg(feature = "parquet")]
mod parquet;
pub mod run;
pub mod shard;
