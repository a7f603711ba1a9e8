//! Lengths of vectors, and small linear systems, in any precision.

use crate::number::float::Float;
use nalgebra::{Point3, SVector, Vector3};

/// The length of a vector.
pub trait Length<N> {
    /// The length.
    fn length(&self) -> N;
    /// The square of the length.
    fn length_squared(&self) -> N;
    /// The unit vector in the same direction; NaN if the length is zero.
    #[must_use]
    fn unit(&self) -> Self;
}

impl<N: Float, const D: usize> Length<N> for SVector<N, D> {
    fn length(&self) -> N {
        self.length_squared().sqrt()
    }
    fn length_squared(&self) -> N {
        self.dot(self)
    }
    fn unit(&self) -> Self {
        self / self.length()
    }
}

/// The solution of m x = right by Gaussian elimination with partial pivoting; `None` if m is
/// singular.
pub fn solution<N: Float, const D: usize>(mut m: [[N; D]; D], mut right: [N; D]) -> Option<[N; D]> {
    for k in 0..D {
        let pivot = (k..D).max_by(|&i, &j| m[i][k].abs().total_cmp(&m[j][k].abs()))?;
        m.swap(k, pivot);
        right.swap(k, pivot);
        if m[k][k] == N::ZERO {
            return None;
        }
        let (row, below) = (m[k], k + 1..D);
        for i in below {
            let part = m[i][k] / row[k];
            m[i].iter_mut()
                .zip(row)
                .for_each(|(x, above)| *x -= part * above);
            let above = right[k];
            right[i] -= part * above;
        }
    }
    for k in (0..D).rev() {
        let rest: N = (k + 1..D).map(|j| m[k][j] * right[j]).sum();
        right[k] = (right[k] - rest) / m[k][k];
    }
    Some(right)
}

/// The unit vector in the direction of a vector; `None` if its length is zero.
pub(crate) fn direction<N: Float>(v: &Vector3<N>) -> Option<Vector3<N>> {
    let length = v.length();
    (length > N::ZERO).then(|| v / length)
}

/// A point rounded to f64.
pub fn rounded<N: Float>(p: &Point3<N>) -> [f64; 3] {
    [p.x, p.y, p.z].map(N::rounded)
}
