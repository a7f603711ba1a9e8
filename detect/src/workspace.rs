//! Memory that detections share.

use super::gradient::Gradient;

/// Memory that one detection leaves to the next, so that none of the image's size is made anew. It
/// holds nothing that the next result depends on.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    /// The gradient where it is known; elsewhere what was left there.
    pub(super) gradient: Gradient,
    /// By pixel of the image: zero, or what a step notes of an edge pixel. All zero between
    /// detections.
    pub(super) marks: Vec<u32>,
    /// The edge pixels by their place in the image, row by row.
    pub(super) found: Vec<u32>,
    /// Pixels to be looked at.
    pub(super) queue: Vec<u32>,
}

impl Workspace {
    /// A workspace; it takes the size of the images that it is used on.
    pub fn new() -> Self {
        Self::default()
    }

    pub(super) fn resize(&mut self, width: usize, height: usize) {
        self.gradient.resize(width, height);
        self.marks.resize(width * height, 0);
        self.found.clear();
        self.queue.clear();
    }

    /// Takes what is found out of the marks.
    pub(super) fn clear(&mut self) {
        for &place in &self.found {
            self.marks[place as usize] = 0;
        }
        self.found.clear();
    }
}

/// The eight neighbours of a place in an image, in turn; those with even index share a side.
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
