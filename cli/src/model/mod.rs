//! Models of many setups: shards in files, and what they come to.

pub mod run;
pub mod shard;
