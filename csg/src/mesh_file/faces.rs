//! Faces of any number of corners in two lists.

/// Polygons of points, all in one list: a mesh may have millions.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct MeshFaces {
    corners: Vec<usize>,
    /// The end of each face in `corners`.
    ends: Vec<usize>,
}

impl MeshFaces {
    /// Adds a face.
    pub(super) fn push(&mut self, corners: &[usize]) {
        self.corners.extend_from_slice(corners);
        self.ends.push(self.corners.len());
    }

    /// The corners of all faces, face after face.
    pub fn corners(&self) -> &[usize] {
        &self.corners
    }

    /// The corners of each face, counterclockwise as seen from the outside.
    pub fn iter(&self) -> impl Iterator<Item = &[usize]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        let spans = starts.zip(&self.ends);
        spans.map(|(start, end)| self.corners.get(start..*end).unwrap_or_default())
    }

    /// The number of faces.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no face.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }
}
