//! The measures of a file that another program wrote.

use super::answer::StatedMeasures;
use super::mesh::{MeshReadError, measures as mesh_measures};
use crate::checks::step::foreign::{StepMeasureError, measures as step_measures};
use premio_csg::mesh_file::MeshFormat;
use std::fmt;

/// A format of results.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum ResultFormat {
    /// A mesh.
    Mesh(MeshFormat),
    /// STEP.
    Step,
}

/// Why a file has no measures.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ResultFileError {
    /// A mesh has none.
    #[error(transparent)]
    Mesh(#[from] MeshReadError),
    /// A STEP file has none.
    #[error(transparent)]
    Step(#[from] StepMeasureError),
}

impl ResultFormat {
    /// Every format.
    pub const ALL: [Self; 4] = [
        Self::Mesh(MeshFormat::Stl),
        Self::Mesh(MeshFormat::Off),
        Self::Mesh(MeshFormat::Obj),
        Self::Step,
    ];

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Mesh(format) => format.ending(),
            Self::Step => "step",
        }
    }
}

impl fmt::Display for ResultFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.ending())
    }
}

/// The measures of a file. Those of STEP have no bounds.
///
/// # Errors
/// The file is not of this format, has something that is not read, or its shells are not closed.
pub fn measures(bytes: &[u8], format: ResultFormat) -> Result<StatedMeasures, ResultFileError> {
    match format {
        ResultFormat::Mesh(format) => Ok(mesh_measures(bytes, format)?),
        ResultFormat::Step => {
            let found = step_measures(&String::from_utf8_lossy(bytes))?;
            Ok(StatedMeasures {
                volume: Some(found.volume),
                area: Some(found.area),
                solids: Some(found.solids as u64),
                ..StatedMeasures::default()
            })
        }
    }
}
