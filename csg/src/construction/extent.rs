//! The size of a solid along the axes.

use super::ConstructionError;
use crate::builder::{Builder, SolidId};
use crate::evaluate::{EvaluationOptions, evaluate};

/// The size of a solid along the axes, from its boundary; `None` if it is empty.
///
/// # Errors
/// The tree exceeds a limit, or its boundary cannot be evaluated.
pub fn extent(builder: &Builder, part: SolidId) -> Result<Option<[f64; 3]>, ConstructionError> {
    let tree = builder.finish(part)?;
    let known = evaluate(&tree, &EvaluationOptions::default())
        .map_err(|error| ConstructionError::Boundary(error.to_string().into()))?;
    if known.brep.topology.face_ids().next().is_none() {
        return Ok(None);
    }
    let bounds = known.tight_bounds();
    Ok(Some([0, 1, 2].map(|i| bounds.max[i] - bounds.min[i])))
}
