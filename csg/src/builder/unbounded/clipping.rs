//! Bounded solids that are the same as one without a bound inside a ball.

use super::enclosure::{Ball, FINENESS, LARGER};
use crate::builder::{Builder, SolidId};
use crate::polyhedron::{Polyhedron, PolyhedronFace, SpacePoint, cross, dot};
use crate::primitive::{Primitive, UnboundedPrimitive};
use crate::transform::{Transform, along};
use premio_kernel::number::rational::{Rational, from_f64, to_f64};
use std::sync::Arc;

/// A number of few digits that is at least as large.
fn rounded_up(x: f64) -> Option<Rational> {
    let grid = 2.0_f64.powi(x.log2().floor() as i32 - FINENESS);
    from_f64((x / grid).ceil() * grid)
}

/// A solid that is the same as one without a bound inside a ball; `None` if its numbers are beyond the
/// range of f64.
pub(super) fn clipped(
    builder: &mut Builder,
    primitive: &UnboundedPrimitive,
    ball: &Ball,
) -> Option<SolidId> {
    let Ball { centre, radius } = *ball;
    let [x, y, z] = centre;
    let off_axis = x.hypot(y);
    match primitive {
        UnboundedPrimitive::HalfSpace { normal, offset } => {
            let n = normal.each_ref().map(to_f64);
            let size = n.iter().map(|x| x * x).sum::<f64>().sqrt();
            let terms = n.iter().zip(&centre);
            let level = (terms.map(|(n, x)| n * x).sum::<f64>() - to_f64(offset)) / size;
            match side(level, radius) {
                Some(side) => covered(builder, side, ball),
                None => slab(builder, normal, offset, ball),
            }
        }
        UnboundedPrimitive::Cylinder { radius: own } => {
            match side(off_axis - to_f64(own), radius) {
                Some(side) => covered(builder, side, ball),
                None => {
                    let [from, height] =
                        ball.rounded([z - LARGER * radius, 2.0 * LARGER * radius])?;
                    let cylinder = Primitive::cylinder(own.clone(), height).ok()?;
                    Some(placed(builder, cylinder, along(2, from)))
                }
            }
        }
        UnboundedPrimitive::Cone { slope } => {
            let tangent = to_f64(slope);
            let reach = radius * (1.0 + tangent);
            let side = match side(off_axis - tangent * z, reach) {
                Some(Side::Inside) if z <= radius => None,
                None if z <= -radius => Some(Side::Outside),
                side => side,
            };
            match side {
                Some(side) => covered(builder, side, ball),
                None => {
                    let ends = [-LARGER, LARGER].map(|k| (z + k * radius).max(0.0));
                    let [from, to] = ball.rounded(ends)?;
                    let height = &to - &from;
                    let [base, top] = [&from, &to].map(|z| slope * z);
                    let frustum = Primitive::frustum(base, top, height).ok()?;
                    Some(placed(builder, frustum, along(2, from)))
                }
            }
        }
    }
}

/// Where a ball is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Inside,
    Outside,
}

/// The side on which a ball is all, by the level of its centre, which is negative inside.
fn side(level: f64, radius: f64) -> Option<Side> {
    match level.abs() > radius {
        true if level < 0.0 => Some(Side::Inside),
        true => Some(Side::Outside),
        false => None,
    }
}

/// A solid for one that contains a ball, or has no point of it.
fn covered(builder: &mut Builder, side: Side, ball: &Ball) -> Option<SolidId> {
    if side == Side::Outside {
        return Some(SolidId::EMPTY);
    }
    let corner = ball.rounded(ball.centre.map(|x| x - LARGER * ball.radius))?;
    let size = ball.rounded([2.0 * LARGER * ball.radius; 3])?;
    Some(placed(builder, Primitive::block(size).ok()?, corner))
}

fn placed(builder: &mut Builder, primitive: Primitive, at: SpacePoint) -> SolidId {
    let solid = builder.primitive(primitive);
    builder.moved(solid, Transform::shift(at))
}

/// A cuboid with a face in a plane that contains all of the half-space in a ball.
fn slab(
    builder: &mut Builder,
    normal: &SpacePoint,
    offset: &Rational,
    ball: &Ball,
) -> Option<SolidId> {
    let centre = ball.rounded(ball.centre)?;
    let excess = (dot(normal, &centre) - offset) / dot(normal, normal);
    let foot: SpacePoint = std::array::from_fn(|i| &centre[i] - &normal[i] * &excess);
    let size = |v: &SpacePoint| to_f64(&dot(v, v)).sqrt();
    let least = (0..3).min_by(|&i, &j| {
        let [a, b] = [i, j].map(|i| to_f64(&normal[i]).abs());
        a.total_cmp(&b)
    });
    let u = cross(normal, &along(least.unwrap_or(0), Rational::ONE));
    let v = cross(normal, &u);
    let [a, b] = [&u, &v].map(|v| rounded_up(LARGER * ball.radius / size(v)));
    let (a, b) = (a?, b?);
    let depth = rounded_up(2.0 * LARGER * ball.radius / size(normal))?;
    let corner = |p: i32, q: i32, h: i32| -> SpacePoint {
        let [p, q, h] = [(p, &a), (q, &b), (h, &depth)].map(|(k, by)| Rational::from(k) * by);
        std::array::from_fn(|i| &foot[i] + &u[i] * &p + &v[i] * &q - &normal[i] * &h)
    };
    let around = [(-1, -1), (1, -1), (1, 1), (-1, 1)];
    let points: Vec<SpacePoint> = [0, 1]
        .into_iter()
        .flat_map(|h| around.map(|(p, q)| corner(p, q, h)))
        .collect();
    let sides = (0..4).map(|i| vec![i, i + 4, (i + 1) % 4 + 4, (i + 1) % 4]);
    let faces = [vec![0, 1, 2, 3], vec![7, 6, 5, 4]]
        .into_iter()
        .chain(sides);
    let faces: Vec<PolyhedronFace> = faces.map(PolyhedronFace::simple).collect();
    let polyhedron = Arc::new(Polyhedron::from_faces(&points, &faces).ok()?.polyhedron);
    Some(builder.primitive(Primitive::Polyhedron { polyhedron }))
}
