//! Set operations.

use serde::{Deserialize, Serialize};

/// A regularised set operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum ModelOperation {
    /// The points in any child.
    Union,
    /// The points in every child.
    Intersection,
    /// The points in the first child and in no later one.
    Difference,
}

impl ModelOperation {
    /// The operations.
    pub const ALL: [Self; 3] = [Self::Union, Self::Intersection, Self::Difference];
}
