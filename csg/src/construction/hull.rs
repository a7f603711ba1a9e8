//! Convex hulls of solids: of polytopes, of columns between two planes, of balls of one radius, and
//! of what is round about one axis.

use std::sync::Arc;

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::Rational;

use super::disc_hull::disc_hull;
use super::leaves::of_union;
use super::plane_faces::{corners, own_corners};
use super::rounding::rounded_hull;
use super::tapered_hull::{ConvexHull, tapered_hull};
use super::{ConstructionError, frames};
use crate::builder::{Builder, SolidId};
use crate::figure::{Disc, Figure, FigurePoint, HullElement};
use crate::polyhedron::{Polyhedron, SpacePoint, cross};
use crate::primitive::Primitive;
use crate::transform::Transform;
use crate::tree::PlacedPrimitive;

/// The convex hull of solids; empty if they are.
///
/// `noise` is the distance by which coordinates may be off, relative to the size. Axes of rounded
/// corners within this distance of each other are taken for one.
///
/// # Errors
/// A solid is not a union of primitives, or the hull has faces of another kind than those of the
/// primitives.
pub fn convex_hull(
    builder: &mut Builder,
    solids: &[SolidId],
    noise: f64,
) -> Result<ConvexHull, ConstructionError> {
    let exact = |solid: SolidId| ConvexHull { solid, moved: 0.0 };
    let mut leaves: Vec<PlacedPrimitive> = Vec::new();
    for &solid in solids {
        leaves.extend(of_union(builder, solid, "hull")?);
    }
    if leaves.is_empty() {
        return Ok(exact(SolidId::EMPTY));
    }
    let points: Option<Vec<Vec<SpacePoint>>> = leaves.iter().map(corners).collect();
    if let Some(points) = points {
        let hull = Polyhedron::convex_hull(&points.concat())?;
        let polyhedron = Arc::new(hull);
        let hull = builder.primitive(Primitive::Polyhedron { polyhedron });
        return Ok(exact(hull));
    }
    if let Some(balls) = balls(&leaves) {
        let same = balls.iter().all(|ball| ball.radius == balls[0].radius);
        let centres: Vec<SpacePoint> = balls.iter().map(|ball| ball.centre.clone()).collect();
        if same && !are_in_line(&centres) {
            return rounded_hull(builder, &centres, &balls[0].radius).map(exact);
        }
    }
    for frame in axes(&leaves) {
        if let Some(primitive) = between_planes(&leaves, &frame)? {
            return Ok(exact(placed(builder, primitive, &frame)));
        }
        if let Some(primitive) = about_axis(&leaves, &frame)? {
            return Ok(exact(placed(builder, primitive, &frame)));
        }
        if let Some(elements) = ends_of_all(&leaves, &frame) {
            let hull = match tapered_hull(builder, &elements, noise)? {
                Some(hull) => hull,
                None => exact(disc_hull(builder, &elements)?),
            };
            let solid = builder.moved(hull.solid, Transform::from_motion(&frame));
            return Ok(ConvexHull { solid, ..hull });
        }
    }
    Err(ConstructionError::NoHull)
}

/// A primitive moved back from a frame.
fn placed(builder: &mut Builder, part: PlacedPrimitive, frame: &Motion) -> SolidId {
    let motion = part.motion.then(frame);
    let solid = builder.primitive(part.primitive);
    builder.moved(solid, Transform::from_motion(&motion))
}

/// A ball.
struct Ball {
    centre: SpacePoint,
    radius: Rational,
}

/// The balls, if all leaves are some.
fn balls(leaves: &[PlacedPrimitive]) -> Option<Vec<Ball>> {
    let ball = |placed: &PlacedPrimitive| match &placed.primitive {
        Primitive::Sphere { radius } => Some(Ball {
            centre: placed.motion.offset().clone(),
            radius: radius.clone(),
        }),
        _ => None,
    };
    leaves.iter().map(ball).collect()
}

/// Whether all points are on one line.
fn are_in_line(points: &[SpacePoint]) -> bool {
    let from = |p: &SpacePoint| -> SpacePoint { std::array::from_fn(|i| &p[i] - &points[0][i]) };
    let Some(u) = points
        .iter()
        .map(from)
        .find(|u| u.iter().any(|x| !x.is_zero()))
    else {
        return true;
    };
    let mut others = points.iter().map(from);
    others.all(|v| cross(&u, &v).iter().all(Rational::is_zero))
}

/// The frames whose z axis the hull may be upright in, or round about: those of the round
/// primitives, and those through two balls.
fn axes(leaves: &[PlacedPrimitive]) -> Vec<Motion> {
    let is_ball = |placed: &&PlacedPrimitive| matches!(placed.primitive, Primitive::Sphere { .. });
    let round = |placed: &&PlacedPrimitive| own_corners(&placed.primitive).is_none();
    if let Some(first) = leaves.iter().filter(round).find(|placed| !is_ball(placed)) {
        return vec![first.motion.clone()];
    }
    let centres: Vec<&SpacePoint> = leaves
        .iter()
        .filter(is_ball)
        .map(|placed| placed.motion.offset())
        .collect();
    let Some(first) = centres.first() else {
        return Vec::new();
    };
    match centres.iter().find(|c| *c != first) {
        Some(other) => {
            let direction = std::array::from_fn(|i| &other[i] - &first[i]);
            vec![frames::along(first, &direction)]
        }
        None => vec![Motion::translation((*first).clone())],
    }
}

/// The discs, arcs and corners of a leaf in two planes across z.
fn ends(placed: &PlacedPrimitive, back: &Motion) -> Option<Vec<(Rational, HullElement)>> {
    let motion = placed.motion.then(back);
    let [_, _, z] = motion.offset().clone();
    let [x, y, _] = motion.offset().clone();
    let turn = motion.rotation_matrix();
    let up = &turn[2][2];
    let is_upright = up.is_one() || *up == -Rational::ONE;
    let disc = |z: Rational, radius: &Rational| {
        let centre = [x.clone(), y.clone()];
        let radius = radius.clone();
        (z, HullElement::Disc(Disc { centre, radius }))
    };
    match &placed.primitive {
        Primitive::Cylinder { radius, height } if is_upright => {
            Some(vec![disc(z.clone(), radius), disc(z + up * height, radius)])
        }
        Primitive::Frustum { base, top, height } if is_upright => {
            Some(vec![disc(z.clone(), base), disc(z + up * height, top)])
        }
        Primitive::Prism {
            figure,
            height,
            top,
        } if is_upright && top.is_one() => {
            let high = z.clone() + up * height;
            let place = |[u, v]: &FigurePoint| -> FigurePoint {
                std::array::from_fn(|i| &turn[i][0] * u + &turn[i][1] * v + &motion.offset()[i])
            };
            let is_over = *up < Rational::ZERO;
            let elements = figure.hull_elements();
            let elements = elements.iter().map(|e| e.placed(place, is_over));
            let discs = elements.flat_map(|e| [(z.clone(), e.clone()), (high.clone(), e)]);
            Some(discs.collect())
        }
        other => {
            let own = own_corners(other)?;
            let points = own.iter().map(|p| motion.apply_point(p));
            let point = |[x, y, z]: SpacePoint| (z, HullElement::Disc(Disc::point([x, y])));
            Some(points.map(point).collect())
        }
    }
}

/// The discs, arcs and corners of leaves in planes across the z axis of a frame, by their heights.
fn ends_of_all(leaves: &[PlacedPrimitive], frame: &Motion) -> Option<Vec<(Rational, HullElement)>> {
    let back = frame.inverse();
    let all: Option<Vec<_>> = leaves.iter().map(|placed| ends(placed, &back)).collect();
    all.map(|all| all.concat())
}

/// The hull of leaves that end in the same two planes with the same outline: a prism.
fn between_planes(
    leaves: &[PlacedPrimitive],
    frame: &Motion,
) -> Result<Option<PlacedPrimitive>, ConstructionError> {
    let Some(all) = ends_of_all(leaves, frame) else {
        return Ok(None);
    };
    let Some(low) = all.iter().map(|(z, _)| z).min().cloned() else {
        return Ok(None);
    };
    let Some(high) = all.iter().map(|(z, _)| z).max().cloned() else {
        return Ok(None);
    };
    let at = |level: &Rational| -> Vec<HullElement> {
        let own = all.iter().filter(|(z, _)| z == level);
        own.map(|(_, element)| element.clone()).collect()
    };
    let (base, top) = (at(&low), at(&high));
    if base.len() + top.len() < all.len() {
        return Ok(None);
    }
    let [base, top] = [base, top].map(|elements| Figure::hull_of_elements(&elements));
    match (base, top) {
        (Ok(base), Ok(top)) if base == top => Ok(Some(PlacedPrimitive {
            primitive: Primitive::prism(base, &high - &low)?,
            motion: Motion::translation([Rational::ZERO, Rational::ZERO, low]),
        })),
        _ => Ok(None),
    }
}

/// The hull of leaves that are round about z: the hull of their profile, revolved.
fn about_axis(
    leaves: &[PlacedPrimitive],
    frame: &Motion,
) -> Result<Option<PlacedPrimitive>, ConstructionError> {
    let back = frame.inverse();
    let mut discs: Vec<Disc> = Vec::new();
    for placed in leaves {
        let motion = placed.motion.then(&back);
        let [x, y, z] = motion.offset().clone();
        let up = &motion.rotation_matrix()[2][2];
        let is_on_axis = is_negligible(&x, leaves) && is_negligible(&y, leaves);
        let is_upright = up.is_one() || *up == -Rational::ONE;
        if !is_on_axis {
            return Ok(None);
        }
        let rim = |radius: &Rational, z: Rational| {
            [radius.clone(), -radius].map(|x| Disc::point([x, z.clone()]))
        };
        match &placed.primitive {
            Primitive::Sphere { radius } => discs.push(Disc {
                centre: [Rational::ZERO, z],
                radius: radius.clone(),
            }),
            Primitive::Cylinder { radius, height } if is_upright => {
                discs.extend(rim(radius, z.clone()));
                discs.extend(rim(radius, z + up * height));
            }
            Primitive::Frustum { base, top, height } if is_upright => {
                discs.extend(rim(base, z.clone()));
                discs.extend(rim(top, z + up * height));
            }
            Primitive::Torus { major, minor } if is_upright => {
                discs.extend([major.clone(), -major].map(|x| Disc {
                    centre: [x, z.clone()],
                    radius: minor.clone(),
                }));
            }
            _ => return Ok(None),
        }
    }
    let profile = Figure::convex_hull(&discs)?.right_of_axis()?;
    let Some(profile) = profile else {
        return Ok(None);
    };
    Ok(Some(PlacedPrimitive {
        primitive: Primitive::revolution(profile, None)?,
        motion: Motion::identity(),
    }))
}

/// Whether a distance is the rounding of a frame, relative to the leaves.
fn is_negligible(x: &Rational, leaves: &[PlacedPrimitive]) -> bool {
    if x.is_zero() {
        return true;
    }
    let offsets = leaves.iter().flat_map(|placed| placed.motion.offset());
    let size = offsets.fold(Rational::ZERO, |most, x| {
        let size = if *x < Rational::ZERO { -x } else { x.clone() };
        most.max(size)
    });
    let x = if *x < Rational::ZERO { -x } else { x.clone() };
    x * Rational::from(1u64 << 60) <= size
}
