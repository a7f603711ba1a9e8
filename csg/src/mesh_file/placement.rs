//! Affine maps that place objects.

use super::MeshCoordinate;

/// An affine map of space. A point is a row before the matrix, as 3MF writes it.
#[derive(Clone, Debug)]
pub(super) struct PlacementMap<C> {
    rows: [[C; 3]; 3],
    offset: [C; 3],
}

impl<C: MeshCoordinate> PlacementMap<C> {
    /// The map of 3MF's twelve numbers: three rows of the matrix, and the offset.
    pub fn from_text(text: &str) -> Option<Self> {
        let mut words = text.split_whitespace();
        let mut row = || {
            let mut next = || C::from_decimal(words.next()?);
            Some([next()?, next()?, next()?])
        };
        let rows = [row()?, row()?, row()?];
        let offset = row()?;
        words.next().is_none().then_some(Self { rows, offset })
    }

    /// The map that multiplies lengths.
    pub fn scale(factor: C) -> Self {
        let zero = || C::from_quotient(0, 1);
        let row = |i| std::array::from_fn(|j| if i == j { factor.clone() } else { zero() });
        Self {
            rows: std::array::from_fn(row),
            offset: [zero(), zero(), zero()],
        }
    }

    pub fn image(&self, point: &[C; 3]) -> [C; 3] {
        let linear = self.linear(point);
        add(linear, &self.offset)
    }

    fn linear(&self, [x, y, z]: &[C; 3]) -> [C; 3] {
        let [a, b, c] = &self.rows;
        std::array::from_fn(|i| {
            x.clone() * a[i].clone() + y.clone() * b[i].clone() + z.clone() * c[i].clone()
        })
    }

    /// This map and then another.
    pub fn then(&self, next: &Self) -> Self {
        Self {
            rows: self.rows.each_ref().map(|row| next.linear(row)),
            offset: next.image(&self.offset),
        }
    }

    /// Whether it makes a left hand of a right one.
    pub fn is_mirror(&self) -> bool {
        let [a, b, c] = &self.rows;
        let minor = |i: usize, j: usize| b[i].clone() * c[j].clone() - b[j].clone() * c[i].clone();
        let [x, y, z] = a.clone();
        (x * minor(1, 2) + y * minor(2, 0) + z * minor(0, 1)).is_negative()
    }

    /// The length of its longest number.
    pub fn bits(&self) -> usize {
        let numbers = self.rows.iter().flatten().chain(&self.offset);
        numbers.map(C::bits).max().unwrap_or_default()
    }
}

fn add<C: MeshCoordinate>(a: [C; 3], b: &[C; 3]) -> [C; 3] {
    let [x, y, z] = a;
    [x + b[0].clone(), y + b[1].clone(), z + b[2].clone()]
}
