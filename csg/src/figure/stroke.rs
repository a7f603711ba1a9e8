//! Strokes: the regions that a pen of a given width draws along open paths of segments.

use super::chain::joined;
use super::offset::{ahead, corner, corner_piece, normal, region, shifted, strip};
use super::{
    ArcTurn, Figure, FigureArc, FigureEdge, FigureError, FigurePoint, OffsetJoin, PlaneMap,
};
use premio_kernel::number::rational::Rational;

/// The end of a stroke.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StrokeCap {
    /// At the end of the path.
    Butt,
    /// Half the width beyond the end of the path.
    Square,
    /// A half disc.
    Round,
}

/// How a path is stroked.
#[derive(Debug, Clone)]
pub(crate) struct Stroke {
    pub half_width: Rational,
    pub cap: StrokeCap,
    /// The join of segments. A miter that would reach farther than the width from the corner is a
    /// chamfer.
    pub join: OffsetJoin,
}

impl Figure {
    /// The stroke along the segments between consecutive points. That of a single point is a disc
    /// where joins are round, else a square.
    ///
    /// # Errors
    /// There is no point, or edges of the result run so close to each other that it is unclear
    /// which of them are one.
    pub(crate) fn stroke(points: &[FigurePoint], stroke: &Stroke) -> Result<Self, FigureError> {
        let pairs = points.windows(2).filter(|ends| ends[0] != ends[1]);
        let edges = pairs.map(|ends| FigureEdge::line(ends[0].clone(), ends[1].clone()));
        let edges = without_closing(edges.collect());
        if let ([], Some(point)) = (&edges[..], points.first()) {
            return dot(point, stroke);
        }
        let mut pieces = Vec::new();
        for (i, edge) in edges.iter().enumerate() {
            for side in [edge, &edge.reversed()] {
                pieces.extend(strip(side, &stroke.half_width)?);
            }
            let end = match edges.get(i + 1) {
                Some(next) => join(edge, next, stroke)?,
                None => cap(edge, stroke)?,
            };
            pieces.extend(end);
        }
        if let Some(first) = edges.first() {
            pieces.extend(cap(&first.reversed(), stroke)?);
        }
        Self::united(pieces)
    }
}

/// The stroke of a point.
fn dot(point: &FigurePoint, stroke: &Stroke) -> Result<Figure, FigureError> {
    let width = &stroke.half_width;
    let double = || width + width;
    let (figure, offset) = match stroke.join {
        OffsetJoin::Round => (Figure::disc(width)?, point.clone()),
        OffsetJoin::Faceted(count) => (Figure::regular_polygon(width, count)?, point.clone()),
        OffsetJoin::Miter | OffsetJoin::Chamfer => (
            Figure::rectangle(&[double(), double()])?,
            [&point[0] - width, &point[1] - width],
        ),
    };
    figure.mapped(&PlaneMap {
        offset,
        ..PlaneMap::identity()
    })
}

/// The edges with those in line joined, except the last one and the first one of a closed path.
fn without_closing(edges: Vec<FigureEdge>) -> Vec<FigureEdge> {
    let is_closed = edges.first().map(|edge| &edge.start) == edges.last().map(|edge| &edge.end);
    match is_closed {
        true => edges,
        false => joined(edges),
    }
}

/// What a corner adds on its outer side.
fn join(
    edge: &FigureEdge,
    next: &FigureEdge,
    stroke: &Stroke,
) -> Result<Option<Figure>, FigureError> {
    let [m, n] = [edge, next].map(|edge| normal(edge, &edge.start));
    let cos = &m[0] * &n[0] + &m[1] * &n[1];
    let is_sharp = &cos + &cos < -Rational::ONE;
    let join = match stroke.join {
        OffsetJoin::Miter if is_sharp => OffsetJoin::Chamfer,
        join => join,
    };
    let width = &stroke.half_width;
    match corner_piece(edge, next, width, join)? {
        Some(piece) => Ok(Some(piece)),
        None => corner_piece(&next.reversed(), &edge.reversed(), width, join),
    }
}

/// What the end of the last edge adds.
fn cap(edge: &FigureEdge, stroke: &Stroke) -> Result<Option<Figure>, FigureError> {
    let width = &stroke.half_width;
    let at = &edge.end;
    let back = edge.reversed();
    let [right, left] = [edge, &back].map(|side| shifted(side, at, width));
    match stroke.cap {
        StrokeCap::Butt => Ok(None),
        StrokeCap::Square => {
            let n = normal(edge, at);
            let [far_right, far_left] = [&right, &left].map(|from| ahead(from, &n, width));
            let corners = [at.clone(), right, far_right, far_left, left];
            region(corners.map(|point| corner(point, None)).to_vec())
        }
        StrokeCap::Round => {
            let arc = FigureArc {
                centre: at.clone(),
                radius: width.clone(),
                turn: ArcTurn::Counterclockwise,
            };
            region(vec![
                corner(at.clone(), None),
                corner(right, Some(arc)),
                corner(left, None),
            ])
        }
    }
}
