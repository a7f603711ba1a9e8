//! Regions of the plane: figures, and set operations on them.
//!
//! Extruding commutes with set operations, so an extrusion makes a solid of each figure. Where one
//! figure is needed, the operations are evaluated in the plane.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::error::SpannedError;
use crate::figure::{Figure, FigureError, FigureExpression, FigureOperation, OffsetJoin, PlaneMap};
use crate::transform::Transform;

/// The error of a figure that is not exact.
pub(super) fn bad_figure(error: &FigureError, span: &Range<usize>) -> SpannedError {
    SpannedError::input(
        span.clone(),
        error.to_string(),
        "a figure of segments and arcs",
    )
    .about_circles(concerns_circles(error))
}

/// Whether an error is about circles and arcs that polygons could replace.
pub(super) fn concerns_circles(error: &FigureError) -> bool {
    matches!(error, FigureError::Elliptic | FigureError::NoHull)
}

/// A figure of a description.
#[derive(Debug, Clone)]
pub(super) struct RegionFigure {
    /// The figure in its own frame.
    pub base: Figure,
    /// The map to the plane.
    pub map: PlaneMap,
    /// The same map as a motion, if it is one.
    pub moves: Option<Transform>,
    /// Its place in the text.
    pub span: Range<usize>,
}

/// A region of the plane.
#[derive(Debug, Clone)]
pub(super) enum Region {
    Figure(Box<RegionFigure>),
    Combined {
        op: FigureOperation,
        operands: Vec<Region>,
        /// The number of operations inside each other.
        depth: usize,
        /// The number of edges of all figures.
        edges: usize,
    },
}

/// The most operations inside each other that are kept; more are evaluated in the plane.
const MAX_DEPTH: usize = 32;

impl RegionFigure {
    /// The figure in its final place.
    pub fn figure(&self) -> Result<Figure, SpannedError> {
        let made = match self.map.is_identity() {
            true => Ok(self.base.clone()),
            false => self.base.mapped(&self.map),
        };
        made.map_err(|error| bad_figure(&error, &self.span))
    }
}

impl Region {
    pub fn new(figure: Figure, span: Range<usize>) -> Self {
        Self::Figure(Box::new(RegionFigure {
            base: figure,
            map: PlaneMap::identity(),
            moves: Some(Transform::new()),
            span,
        }))
    }

    fn depth(&self) -> usize {
        match self {
            Self::Figure(_) => 0,
            Self::Combined { depth, .. } => *depth,
        }
    }

    /// The place of its first figure.
    pub fn span(&self) -> Range<usize> {
        match self {
            Self::Figure(figure) => figure.span.clone(),
            Self::Combined { operands, .. } => operands.first().map_or(0..0, Self::span),
        }
    }

    /// The image under a map, which is a motion if `moves` says so.
    pub fn mapped(self, map: &PlaneMap, moves: Option<&Transform>) -> Self {
        match self {
            Self::Figure(figure) => Self::Figure(Box::new(RegionFigure {
                map: figure.map.then(map),
                moves: figure
                    .moves
                    .zip(moves)
                    .map(|(own, moves)| own.then(moves.clone())),
                ..*figure
            })),
            Self::Combined {
                op,
                operands,
                depth,
                edges,
            } => Self::Combined {
                op,
                operands: operands.into_iter().map(|r| r.mapped(map, moves)).collect(),
                depth,
                edges,
            },
        }
    }

    /// An operation on regions, of which some may be empty.
    pub fn combined(
        op: FigureOperation,
        operands: Vec<Option<Self>>,
    ) -> Result<Option<Self>, SpannedError> {
        let is_empty = match op {
            FigureOperation::Union => false,
            FigureOperation::Intersection => operands.iter().any(Option::is_none),
            FigureOperation::Difference => operands.first().is_none_or(Option::is_none),
        };
        let mut operands: Vec<Self> = operands.into_iter().flatten().collect();
        if is_empty || operands.is_empty() {
            return Ok(None);
        }
        if operands.len() == 1 {
            return Ok(operands.pop());
        }
        let depth = 1 + operands.iter().map(Self::depth).max().unwrap_or(0);
        let edges = operands.iter().map(Self::edge_count).sum();
        let region = Self::Combined {
            op,
            operands,
            depth,
            edges,
        };
        region.within_depth()
    }

    /// The region, evaluated in the plane if it has too many operations inside each other.
    fn within_depth(self) -> Result<Option<Self>, SpannedError> {
        if self.depth() <= MAX_DEPTH {
            return Ok(Some(self));
        }
        let span = self.span();
        let figure = self.evaluated(&span)?;
        Ok(figure.map(|figure| Self::new(figure, span)))
    }

    /// An operation on two regions, which joins the operands of the first one if it is the same
    /// operation: `(A - B) - C` is `A - B - C`.
    pub fn joined(
        op: FigureOperation,
        first: Option<Self>,
        second: Option<Self>,
    ) -> Result<Option<Self>, SpannedError> {
        let (mut operands, depth, edges) = match first {
            Some(Self::Combined {
                op: own,
                operands,
                depth,
                edges,
            }) if own == op => (operands, depth, edges),
            first => return Self::combined(op, vec![first, second]),
        };
        if op == FigureOperation::Intersection && second.is_none() {
            return Ok(None);
        }
        let depth = depth.max(second.as_ref().map_or(0, |second| 1 + second.depth()));
        let edges = edges + second.as_ref().map_or(0, Self::edge_count);
        operands.extend(second);
        let region = Self::Combined {
            op,
            operands,
            depth,
            edges,
        };
        region.within_depth()
    }

    /// The number of edges of all figures.
    pub fn edge_count(&self) -> usize {
        match self {
            Self::Figure(figure) => figure.base.edges().len(),
            Self::Combined { edges, .. } => *edges,
        }
    }

    /// Whether it is a union of figures.
    pub fn is_union(&self) -> bool {
        match self {
            Self::Figure(_) => true,
            Self::Combined { op, operands, .. } => {
                *op == FigureOperation::Union && operands.iter().all(Self::is_union)
            }
        }
    }

    /// The figures of a union, each in its place; `None` if there is another operation.
    pub fn figures(&self) -> Result<Option<Vec<Figure>>, SpannedError> {
        match self {
            Self::Figure(figure) => Ok(Some(vec![figure.figure()?])),
            Self::Combined {
                op: FigureOperation::Union,
                operands,
                ..
            } => {
                let each = operands.iter().map(Self::figures);
                let each: Option<Vec<Vec<Figure>>> = each.collect::<Result<_, _>>()?;
                Ok(each.map(|each| each.concat()))
            }
            Self::Combined { .. } => Ok(None),
        }
    }

    /// The region as one figure; `None` if it is empty.
    pub fn evaluated(&self, span: &Range<usize>) -> Result<Option<Figure>, SpannedError> {
        if let Self::Figure(figure) = self {
            return figure.figure().map(Some);
        }
        let mut figures = Vec::new();
        let expression = self.expression(&mut figures)?;
        match Figure::evaluated(&figures.iter().collect::<Vec<_>>(), &expression) {
            Ok(figure) => Ok(Some(figure)),
            Err(FigureError::Empty) => Ok(None),
            Err(error) => Err(bad_figure(&error, span)),
        }
    }

    /// The region moved in the plane.
    pub fn moved(self, moves: &Transform) -> Self {
        self.mapped(&PlaneMap::from_transform(moves), Some(moves))
    }

    /// The convex hull of regions; `None` if all are empty.
    pub fn hull<'r>(
        regions: impl Iterator<Item = &'r Self>,
        span: &Range<usize>,
    ) -> Result<Option<Self>, SpannedError> {
        let mut figures: Vec<Figure> = Vec::new();
        for region in regions {
            match region.figures()? {
                Some(own) => figures.extend(own),
                None => figures.extend(region.evaluated(span)?),
            }
        }
        if figures.is_empty() {
            return Ok(None);
        }
        let hull = Figure::hull_of(&figures.iter().collect::<Vec<_>>());
        Self::made(hull, span)
    }

    /// The points within a distance of the region, or those farther than its negative inside it;
    /// `None` if there are none.
    pub fn offset(
        &self,
        distance: &Rational,
        join: OffsetJoin,
        span: &Range<usize>,
    ) -> Result<Option<Self>, SpannedError> {
        match self.evaluated(span)? {
            Some(figure) => Self::made(figure.offset(distance, join), span),
            None => Ok(None),
        }
    }

    /// The region of a figure that was made; `None` if it is empty.
    pub fn made(
        figure: Result<Figure, FigureError>,
        span: &Range<usize>,
    ) -> Result<Option<Self>, SpannedError> {
        match figure {
            Ok(figure) => Ok(Some(Self::new(figure, span.clone()))),
            Err(FigureError::Empty) => Ok(None),
            Err(error) => Err(bad_figure(&error, span)),
        }
    }

    fn expression(&self, figures: &mut Vec<Figure>) -> Result<FigureExpression, SpannedError> {
        match self {
            Self::Figure(figure) => {
                figures.push(figure.figure()?);
                Ok(FigureExpression::Leaf(figures.len() - 1))
            }
            Self::Combined { op, operands, .. } => {
                let each = operands.iter().map(|operand| operand.expression(figures));
                let each = each.collect::<Result<_, _>>()?;
                Ok(FigureExpression::Combined(*op, each))
            }
        }
    }
}
