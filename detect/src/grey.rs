//! Grey images.

/// A grey image: levels by rows; pixel (x, y) has its centre at (x, y), y downwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Grey {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Grey levels, row by row; NaN is an unknown level, and has no gradient.
    pub levels: Vec<f32>,
}

impl Grey {
    /// The image whose levels a function of column and row gives.
    pub fn new(width: usize, height: usize, level: impl Fn(usize, usize) -> f32) -> Self {
        let rows = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Self {
            width,
            height,
            levels: rows.map(|(x, y)| level(x, y)).collect(),
        }
    }
}
