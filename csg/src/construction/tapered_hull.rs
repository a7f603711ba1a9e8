//! Hulls of plates with rounded corners about common axes: cones at the corners, and planes between
//! them.
//!
//! The outlines of the plates are offsets of one polygon of axes. So the radius of the hull at a
//! height is the same function of the height at every corner, up to a constant: the upper hull of
//! the plates' radii.

use std::sync::Arc;

use premio_kernel::number::rational::{Rational, to_f64};

use super::ConstructionError;
use crate::builder::{Builder, SolidId};
use crate::figure::{Disc, Figure, FigurePoint, HullElement, outer_tangent};
use crate::polyhedron::{Polyhedron, SpacePoint};
use crate::primitive::Primitive;
use crate::transform::Transform;
use crate::tree::Operation;

/// A convex solid, and how far its coordinates are from those that were given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConvexHull {
    /// The solid.
    pub solid: SolidId,
    /// The greatest distance by which axes were moved onto each other.
    pub moved: f64,
}

/// The largest number of planes in which plates end.
const MAX_LEVELS: usize = 64;

/// The outline of the plates at a height.
struct Level {
    height: Rational,
    /// How much larger the radii are than those of the lowest level.
    growth: Rational,
}

/// The hull of elements at heights along z; `None` if it has other faces. Axes within `noise`, which
/// is relative to the size, are one.
pub(super) fn tapered_hull(
    builder: &mut Builder,
    elements: &[(Rational, HullElement)],
    noise: f64,
) -> Result<Option<ConvexHull>, ConstructionError> {
    let mut heights: Vec<&Rational> = elements.iter().map(|(height, _)| height).collect();
    heights.sort_unstable();
    heights.dedup();
    if heights.len() < 2 || heights.len() > MAX_LEVELS {
        return Ok(None);
    }
    let Some(core) = corners(elements, heights[0]) else {
        return Ok(None);
    };
    let size = elements.iter().map(|(_, e)| e.reach()).fold(0.0, f64::max);
    let noise = noise * size;
    let mut moved = 0.0f64;
    let mut levels = Vec::new();
    for height in heights {
        let grown = corners(elements, height).and_then(|own| growth(&core, &own, noise));
        let Some((growth, by)) = grown else {
            return Ok(None);
        };
        moved = moved.max(by);
        let height = height.clone();
        levels.push(Level { height, growth });
    }
    let mut parts = Vec::new();
    for slab in upper_hull(levels).windows(2) {
        parts.extend(tapered_slab(builder, &core, [&slab[0], &slab[1]])?);
    }
    let solid = builder.operation(Operation::Union, &parts);
    Ok(Some(ConvexHull { solid, moved }))
}

/// The discs in the corners of the hull of the elements at a height, counterclockwise.
fn corners(elements: &[(Rational, HullElement)], height: &Rational) -> Option<Vec<Disc>> {
    let own = elements.iter().filter(|(z, _)| z == height);
    let own: Vec<HullElement> = own.map(|(_, element)| element.clone()).collect();
    let figure = Figure::hull_of_elements(&own).ok()?;
    let edges = figure.edges();
    let mut discs = Vec::new();
    for (k, edge) in edges.iter().enumerate() {
        let before = &edges[(k + edges.len() - 1) % edges.len()];
        match &edge.arc {
            Some(arc) => discs.push(Disc {
                centre: arc.centre.clone(),
                radius: arc.radius.clone(),
            }),
            None if before.arc.is_none() => discs.push(Disc::point(edge.start.clone())),
            None => {}
        }
    }
    // A single disc is round about one axis, which is another construction.
    (discs.len() > 1).then_some(discs)
}

/// How much larger the radii of corners are than those of others with the same axes, and how far the
/// axes are apart.
fn growth(core: &[Disc], own: &[Disc], noise: f64) -> Option<(Rational, f64)> {
    let distance = |a: &Disc, b: &Disc| {
        let [x, y] = [0, 1].map(|i| to_f64(&(&a.centre[i] - &b.centre[i])));
        x.hypot(y)
    };
    if core.len() != own.len() {
        return None;
    }
    let first = (0..own.len()).min_by(|&a, &b| {
        let away = |k: usize| distance(&core[0], &own[k]);
        away(a).total_cmp(&away(b))
    })?;
    let by = &own[first].radius - &core[0].radius;
    let mut moved = 0.0f64;
    for (k, disc) in core.iter().enumerate() {
        let other = &own[(first + k) % own.len()];
        let differs = to_f64(&(&other.radius - &disc.radius - &by)).abs();
        moved = moved.max(distance(disc, other)).max(differs);
    }
    let is_same = moved.total_cmp(&noise).is_le();
    is_same.then_some((by, moved))
}

/// The levels of which no other two enclose the radius: a concave chain (Andrew 1979).
fn upper_hull(levels: Vec<Level>) -> Vec<Level> {
    let mut chain: Vec<Level> = Vec::new();
    for level in levels {
        while let [.., a, b] = &chain[..] {
            let [up, next] = [b, &level].map(|l| &l.height - &a.height);
            let [own, other] = [b, &level].map(|l| &l.growth - &a.growth);
            if own * next > other * up {
                break;
            }
            chain.pop();
        }
        chain.push(level);
    }
    chain
}

/// The part of the hull between two levels: cones at the corners, and the polyhedron between the
/// lines in which planes touch them.
fn tapered_slab(
    builder: &mut Builder,
    core: &[Disc],
    levels: [&Level; 2],
) -> Result<Vec<SolidId>, ConstructionError> {
    let height = &levels[1].height - &levels[0].height;
    let grown = |disc: &Disc, level: &Level| Disc {
        centre: disc.centre.clone(),
        radius: &disc.radius + &level.growth,
    };
    let mut parts = Vec::new();
    for disc in core {
        let [base, top] = levels.map(|level| grown(disc, level).radius);
        if base.is_zero() && top.is_zero() {
            continue;
        }
        let cone = builder.primitive(Primitive::frustum(base, top, height.clone())?);
        let [x, y] = disc.centre.clone();
        let place = Transform::shift([x, y, levels[0].height.clone()]);
        parts.push(builder.moved(cone, place));
    }
    let mut points: Vec<SpacePoint> = Vec::new();
    for (k, disc) in core.iter().enumerate() {
        let next = &core[(k + 1) % core.len()];
        for level in levels {
            let ends = outer_tangent(&grown(disc, level), &grown(next, level));
            let raised = |[x, y]: FigurePoint| [x, y, level.height.clone()];
            points.extend(ends.map(raised));
        }
    }
    let polyhedron = Arc::new(Polyhedron::convex_hull(&points)?);
    parts.push(builder.primitive(Primitive::Polyhedron { polyhedron }));
    Ok(parts)
}
