//! The colours of faces.

use premio_kernel::brep::topology::FaceId;
use premio_kernel::colour::Colour;

/// The colours of faces, by their indices; those after the last have none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FaceColours(pub Vec<Option<Colour>>);

impl FaceColours {
    /// The colour of a face.
    pub fn of(&self, face: FaceId) -> Option<Colour> {
        self.0.get(face.index()).copied().flatten()
    }
}
