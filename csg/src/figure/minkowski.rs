//! Minkowski sums of figures.

use super::set_operations::FigureExpression;
use super::{Disc, Figure, FigureError, FigureOperation, FigurePoint, OffsetJoin, PlaneMap};

impl Figure {
    /// The sums of a point of one figure and a point of the other.
    ///
    /// # Errors
    /// Neither figure is a disc, and neither both are convex hulls of discs nor one of them is a
    /// convex polygon and the other a polygon.
    pub fn minkowski_sum(&self, other: &Self) -> Result<Self, FigureError> {
        for (one, two) in [(self, other), (other, self)] {
            if let Some(arc) = two.edges.first().and_then(|edge| edge.arc.as_ref())
                && two.is_disc()
            {
                let grown = one.offset(&arc.radius, OffsetJoin::Round)?;
                return grown.mapped(&shift(&arc.centre));
            }
        }
        if let (Some(one), Some(two)) = (self.convex_discs(), other.convex_discs()) {
            let sums = one.iter().flat_map(|a| {
                two.iter().map(|b| Disc {
                    centre: sum(&a.centre, &b.centre),
                    radius: &a.radius + &b.radius,
                })
            });
            return Self::convex_hull(&sums.collect::<Vec<_>>());
        }
        for (one, two) in [(self, other), (other, self)] {
            if one.is_polygon() && two.is_polygon() && two.convex_discs().is_some() {
                return polygon_sum(one, two);
            }
        }
        Err(FigureError::NoSum)
    }
}

fn sum(a: &FigurePoint, b: &FigurePoint) -> FigurePoint {
    [0, 1].map(|i| &a[i] + &b[i])
}

fn shift(by: &FigurePoint) -> PlaneMap {
    PlaneMap {
        offset: by.clone(),
        ..PlaneMap::identity()
    }
}

/// The sum of a polygon and a convex one: the union of one copy and of the sums with every edge.
fn polygon_sum(one: &Figure, two: &Figure) -> Result<Figure, FigureError> {
    let corners = || two.edges.iter().map(|edge| &edge.start);
    let first = corners().next().cloned().unwrap_or_default();
    let mut pieces = vec![one.mapped(&shift(&first))?];
    for edge in &one.edges {
        let points = corners().flat_map(|corner| {
            let ends = [&edge.start, &edge.end];
            ends.map(|end| Disc::point(sum(end, corner)))
        });
        pieces.push(Figure::convex_hull(&points.collect::<Vec<_>>())?);
    }
    let leaves = (0..pieces.len()).map(FigureExpression::Leaf).collect();
    let pieces: Vec<&Figure> = pieces.iter().collect();
    let union = FigureExpression::Combined(FigureOperation::Union, leaves);
    Figure::evaluated(&pieces, &union)
}
