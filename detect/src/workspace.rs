//! Memory that detections reuse.

use super::gradient::Gradient;

/// Memory that one detection leaves to the next, so that none of the image's size is allocated
/// again. The next result does not depend on its content.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    /// The gradient where it is known; elsewhere old values.
    pub(super) gradient: Gradient,
    /// By pixel of the image: zero, or the mark of an edge pixel. All are zero between detections.
    pub(super) marks: Vec<u32>,
    /// The edge pixels by their index in the image, row by row.
    pub(super) found: Vec<u32>,
    /// Pixels to be processed.
    pub(super) queue: Vec<u32>,
}

impl Workspace {
    /// An empty workspace; it grows to the size of the images that it is used on.
    pub(crate) fn new() -> Self {
        Self::default()
    }

    pub(super) fn resize(&mut self, width: usize, height: usize) {
        self.gradient.resize(width, height);
        self.marks.resize(width * height, 0);
        self.found.clear();
        self.queue.clear();
    }

    /// Clears the marks of the found pixels.
    pub(super) fn clear(&mut self) {
        for &place in &self.found {
            self.marks[place as usize] = 0;
        }
        self.found.clear();
    }
}

/// The eight neighbours of a pixel in an image, in cyclic order; those with even index share a
/// side.
pub(super) fn neighbours(place: u32, width: usize) -> [u32; 8] {
    // Edge pixels lie two pixels or more within the image, so that none of these is outside.
    let (p, w) = (place, width as u32);
    [
        p + 1,
        p + w + 1,
        p + w,
        p + w - 1,
        p - 1,
        p - w - 1,
        p - w,
        p - w + 1,
    ]
}
