//! The findings of a run.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A finding: a wrong or a refused tree.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Find {
    /// The file, if the tree is of one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// The message.
    pub text: String,
    /// The smallest tree found that fails in the same way, in padl.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shrunk: Option<String>,
}

/// Findings by seed.
pub type Finds = BTreeMap<u64, Find>;

impl Find {
    /// A finding of a tree, perhaps of a file.
    pub fn new(text: String, file: Option<&str>) -> Self {
        Self {
            file: file.map(str::to_owned),
            text,
            shrunk: None,
        }
    }
}
