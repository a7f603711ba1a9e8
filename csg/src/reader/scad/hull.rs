//! Convex hulls of figures, and of upright cylinders, prisms and blocks of one height.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::figures::{bad_figure, mapped};
use super::measures::{MovedPrimitive, Shape, checked};
use super::plane::Extrusion;
use crate::figure::{Disc, Figure, FigureError, PlaneMap};
use crate::primitive::Primitive;
use crate::transform::Transform;

/// The extrusion or the hull around a node, which determines what the node becomes.
#[derive(Clone)]
pub(super) enum Around {
    Nothing,
    Extruded(Box<Extrusion>),
    /// A convex hull.
    Hull(Box<HullFrame>),
}

impl Around {
    /// Whether plane figures are expected.
    pub(super) fn is_plane(&self) -> bool {
        match self {
            Self::Nothing => false,
            Self::Extruded(_) => true,
            Self::Hull(hull) => hull.is_plane(),
        }
    }
}

/// The inside of a hull: what is around the hull, and the map between it and a node inside it.
#[derive(Clone)]
pub(super) struct HullFrame {
    pub outer: Around,
    pub map: PlaneMap,
    /// The shift along z.
    pub lift: Rational,
}

/// An operand of a hull.
pub(super) struct HullOperand {
    discs: Vec<Disc>,
    /// The range along z; `None` for a plane figure.
    range: Option<[Rational; 2]>,
}

impl HullFrame {
    pub(super) fn new(outer: Around) -> Self {
        Self {
            outer,
            map: PlaneMap::identity(),
            lift: Rational::ZERO,
        }
    }

    /// Whether the hull is one of plane figures.
    pub(super) fn is_plane(&self) -> bool {
        !matches!(self.outer, Around::Nothing)
    }

    /// A figure as an operand.
    pub(super) fn figure(
        &self,
        figure: &Figure,
        span: &Range<usize>,
    ) -> Result<Option<HullOperand>, SpannedError> {
        let Some(figure) = mapped(figure, &self.map, span)? else {
            return Ok(None);
        };
        let discs = figure.discs().ok_or_else(|| not_exact(span))?;
        Ok(Some(HullOperand { discs, range: None }))
    }

    /// A primitive as an operand: its outline along z, and its range.
    pub(super) fn solid(
        &self,
        shape: &Shape,
        span: &Range<usize>,
    ) -> Result<Option<HullOperand>, SpannedError> {
        let Some(MovedPrimitive { primitive, moves }) = shape else {
            return Ok(None);
        };
        let (figure, height) = match primitive {
            Primitive::Cylinder { radius, height } => (Figure::disc(radius), height),
            Primitive::Block { size: [x, y, z] } => (Figure::rectangle(&[x.clone(), y.clone()]), z),
            Primitive::Prism {
                figure,
                height,
                top,
            } if top.is_one() => (Ok((**figure).clone()), height),
            _ => return Err(not_exact(span)),
        };
        let motion = moves.motion();
        if !motion.rotation_matrix()[2][2].is_one() {
            return Err(not_exact(span));
        }
        let [x, y, z] = motion.offset().clone();
        let own = PlaneMap {
            offset: [x, y],
            ..PlaneMap::identity()
        };
        let inner = Self {
            map: own.then(&self.map),
            ..self.clone()
        };
        let figure = figure.map_err(|error| bad_figure(&error, span))?;
        let Some(operand) = inner.figure(&figure, span)? else {
            return Ok(None);
        };
        let low = z + &self.lift;
        let range = Some([low.clone(), low + height]);
        Ok(Some(HullOperand { range, ..operand }))
    }

    /// The solid of the hull of some operands.
    pub(super) fn hull(
        &self,
        operands: &[HullOperand],
        span: &Range<usize>,
    ) -> Result<Shape, SpannedError> {
        let Some(first) = operands.first() else {
            return Ok(None);
        };
        if operands.iter().any(|operand| operand.range != first.range) {
            return Err(not_exact(span));
        }
        let discs: Vec<Disc> = operands.iter().flat_map(|o| o.discs.clone()).collect();
        let figure = match Figure::convex_hull(&discs) {
            Ok(figure) => figure,
            Err(FigureError::Empty) => return Ok(None),
            Err(error) => return Err(bad_figure(&error, span)),
        };
        match (&self.outer, &first.range) {
            (Around::Extruded(extrusion), _) => extrusion.solid(&figure, span),
            (_, Some([low, high])) => {
                let prism = checked(Primitive::prism(figure, high - low), span)?;
                let lift = [Rational::ZERO, Rational::ZERO, low.clone()];
                Ok(Some(MovedPrimitive::new(prism, Transform::shift(lift))))
            }
            _ => Ok(None),
        }
    }
}

/// The error of a hull that is not exact, or not supported.
fn not_exact(span: &Range<usize>) -> SpannedError {
    SpannedError::input(
        span.clone(),
        "a hull of other shapes",
        "a hull of discs and polygons, or of cylinders, prisms and blocks along z of one height",
    )
}
