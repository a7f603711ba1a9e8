//! Minkowski sums: with balls, of columns, and of convex polyhedra.

use std::sync::Arc;

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::Rational;

use super::ConstructionError;
use super::leaves::{Column, column, of_union};
use super::plane_faces::{corners, own_corners, polyhedron, swept_face};
use super::rounding::rounded;
use crate::builder::{Builder, SolidId};
use crate::figure::FigureError;
use crate::polyhedron::{MAX_HULL_POINTS, Polyhedron, PolyhedronError, SpacePoint, dot};
use crate::primitive::Primitive;
use crate::transform::Transform;
use crate::tree::{Operation, PlacedPrimitive};

/// The largest number of pairs of primitives that are summed.
const MAX_PAIRS: usize = 10_000;

/// The sums of one point of every solid; empty if one of them is.
///
/// The sum of unions is the union of the sums of all pairs of primitives.
///
/// # Errors
/// A solid is not a union of primitives, or there is no exact sum of two of these.
pub fn minkowski_sum(
    builder: &mut Builder,
    solids: &[SolidId],
) -> Result<SolidId, ConstructionError> {
    let mut rest = solids.iter();
    let Some(&first) = rest.next() else {
        return Ok(SolidId::EMPTY);
    };
    rest.try_fold(first, |sum, &solid| pair(builder, sum, solid))
}

fn pair(builder: &mut Builder, a: SolidId, b: SolidId) -> Result<SolidId, ConstructionError> {
    if a.is_empty() || b.is_empty() {
        return Ok(SolidId::EMPTY);
    }
    let of = |solid| of_union(builder, solid, "Minkowski sum");
    let (a, b) = (of(a)?, of(b)?);
    if a.len().saturating_mul(b.len()) > MAX_PAIRS {
        return Err(ConstructionError::NoSum);
    }
    let mut sums = Vec::with_capacity(a.len() * b.len());
    for one in &a {
        for two in &b {
            sums.push(of_primitives(builder, one, two)?);
        }
    }
    Ok(builder.operation(Operation::Union, &sums))
}

fn of_primitives(
    builder: &mut Builder,
    one: &PlacedPrimitive,
    two: &PlacedPrimitive,
) -> Result<SolidId, ConstructionError> {
    for (ball, other) in [(two, one), (one, two)] {
        if let Primitive::Sphere { radius } = &ball.primitive {
            let sum = rounded(builder, other, radius)?;
            return Ok(builder.moved(sum, Transform::shift(ball.motion.offset().clone())));
        }
    }
    if let Some(sum) = of_columns(builder, one, two)? {
        return Ok(sum);
    }
    match [one, two].map(convex_corners) {
        [Some(p), Some(q)] => hull_of_sums(builder, &p, &q),
        [Some(convex), None] => with_convex(builder, two, &convex),
        [None, Some(convex)] => with_convex(builder, one, &convex),
        [None, None] => Err(ConstructionError::NoSum),
    }
}

/// The hull of the sums of two points.
fn hull_of_sums(
    builder: &mut Builder,
    p: &[SpacePoint],
    q: &[SpacePoint],
) -> Result<SolidId, ConstructionError> {
    let count = p.len().saturating_mul(q.len());
    if count > MAX_HULL_POINTS {
        return Err(PolyhedronError::TooManyPoints { count }.into());
    }
    let sums = p.iter().flat_map(|a| q.iter().map(|b| plus(a, b)));
    let hull = Polyhedron::convex_hull(&sums.collect::<Vec<_>>())?;
    Ok(polyhedral(builder, hull))
}

fn polyhedral(builder: &mut Builder, polyhedron: Polyhedron) -> SolidId {
    let polyhedron = Arc::new(polyhedron);
    builder.primitive(Primitive::Polyhedron { polyhedron })
}

fn plus(a: &SpacePoint, b: &SpacePoint) -> SpacePoint {
    std::array::from_fn(|i| &a[i] + &b[i])
}

/// The sum of a polyhedron and the hull of some points: the moved polyhedron, what its faces sweep
/// along a chord of the hull, and the sums of its edges and the hull.
///
/// A point x is in the sum of a plane face F and a convex B if x - B meets F. It meets the plane in a
/// convex set, which meets the edges of F, or is inside F and meets a chord of x - B that is as high
/// above the plane as B.
fn with_convex(
    builder: &mut Builder,
    placed: &PlacedPrimitive,
    convex: &[SpacePoint],
) -> Result<SolidId, ConstructionError> {
    own_corners(&placed.primitive).ok_or(ConstructionError::NoSum)?;
    let motion = &placed.motion;
    let solid = polyhedron(&placed.primitive)?;
    let solid = solid.mapped(&motion.rotation_matrix(), motion.offset())?;
    if solid.faces().len().saturating_mul(convex.len()) > MAX_PAIRS {
        return Err(ConstructionError::NoSum);
    }
    let whole = polyhedral(builder, solid.clone());
    let mut parts = vec![builder.moved(whole, Transform::shift(convex[0].clone()))];
    for face in 0..solid.faces().len() {
        let normal = solid.normal(face);
        let height = |p: &&SpacePoint| dot(&normal, p);
        let ends = [
            convex.iter().min_by_key(height),
            convex.iter().max_by_key(height),
        ];
        if let [Some(low), Some(high)] = ends {
            let swept = swept_face(&solid, face, [low, high])?;
            parts.push(polyhedral(builder, swept));
        }
    }
    for [i, j] in solid.faces().iter().flat_map(|face| face.edges()) {
        if i < j {
            let ends = [i, j].map(|k| solid.points()[k].clone());
            parts.push(hull_of_sums(builder, &ends, convex)?);
        }
    }
    Ok(builder.operation(Operation::Union, &parts))
}

/// The corners of a convex primitive with plane faces.
fn convex_corners(placed: &PlacedPrimitive) -> Option<Vec<SpacePoint>> {
    let points = corners(placed)?;
    let is_convex = match &placed.primitive {
        Primitive::Prism { figure, .. } => figure.convex_discs().is_some(),
        Primitive::Polyhedron { polyhedron } => {
            let hull = Polyhedron::convex_hull(polyhedron.points()).ok()?;
            hull.sixfold_volume() == polyhedron.sixfold_volume()
        }
        _ => true,
    };
    is_convex.then_some(points)
}

/// The sum of columns along one direction: the sum of their figures, as high as both.
fn of_columns(
    builder: &mut Builder,
    one: &PlacedPrimitive,
    two: &PlacedPrimitive,
) -> Result<Option<SolidId>, ConstructionError> {
    let turn = |placed: &PlacedPrimitive| {
        let shift = placed.motion.offset().each_ref().map(|x| -x);
        placed.motion.then(&Motion::translation(shift))
    };
    let frames = [turn(one), turn(two), Motion::identity()];
    for frame in frames {
        let back = frame.inverse();
        let [Some(a), Some(b)] = [one, two].map(|placed| column(placed, &back)) else {
            continue;
        };
        let Column { figure, range } = a;
        let sum = match figure.minkowski_sum(&b.figure) {
            Ok(sum) => sum,
            Err(FigureError::NoSum) => continue,
            Err(error) => return Err(error.into()),
        };
        let [low, high] = [0, 1].map(|i| &range[i] + &b.range[i]);
        let prism = builder.primitive(Primitive::prism(sum, &high - &low)?);
        let lift = Transform::shift([Rational::ZERO, Rational::ZERO, low]);
        let prism = builder.moved(prism, lift);
        return Ok(Some(builder.moved(prism, Transform::from_motion(&frame))));
    }
    Ok(None)
}
