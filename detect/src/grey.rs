//! Grey images.

/// A grey image: levels by rows; pixel (x, y) has its centre at (x, y), y downwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Grey {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Grey levels, row by row; what is not a number is an unknown level, and has no gradient.
    pub levels: Vec<f32>,
}

impl Grey {
    /// The image whose level at column x and row y a function tells.
    pub fn new(width: usize, height: usize, level: impl Fn(usize, usize) -> f32) -> Self {
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Self {
            width,
            height,
            levels: rows.map(|(x, y)| level(x, y)).collect(),
        }
    }
}
