//! Sums with a ball: tubes along edges, balls at corners, and slabs on faces, all of which touch
//! smoothly.

use std::sync::Arc;

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::Rational;

use super::plane_faces::{own_corners, polyhedron, swept_face};
use super::{ConstructionError, frames};
use crate::builder::{Builder, SolidId};
use crate::figure::{
    ArcTurn, ContourCorner, Disc, Figure, FigureArc, FigureEdge, FigurePoint, OffsetJoin,
};
use crate::polyhedron::{Polyhedron, PolyhedronError, SpacePoint, cross, dot};
use crate::primitive::{Primitive, RevolutionAngle};
use crate::transform::Transform;
use crate::tree::{Operation, PlacedPrimitive};

fn ball(
    builder: &mut Builder,
    centre: &SpacePoint,
    radius: &Rational,
) -> Result<SolidId, ConstructionError> {
    let ball = builder.primitive(Primitive::sphere(radius.clone())?);
    Ok(builder.moved(ball, Transform::shift(centre.clone())))
}

fn tube(
    builder: &mut Builder,
    [from, to]: [&SpacePoint; 2],
    radius: &Rational,
) -> Result<SolidId, ConstructionError> {
    let along: SpacePoint = std::array::from_fn(|i| &to[i] - &from[i]);
    let tube = Primitive::cylinder(radius.clone(), frames::length(&along))?;
    let tube = builder.primitive(tube);
    Ok(builder.moved(tube, Transform::from_motion(&frames::along(from, &along))))
}

/// The hull of balls of one radius: the sum of the hull of their centres and a ball.
pub(super) fn rounded_hull(
    builder: &mut Builder,
    centres: &[SpacePoint],
    radius: &Rational,
) -> Result<SolidId, ConstructionError> {
    match Polyhedron::convex_hull(centres) {
        Ok(hull) => rounded_polyhedron(builder, &hull, radius),
        Err(PolyhedronError::Empty) => rounded_polygon(builder, centres, radius),
        Err(error) => Err(error.into()),
    }
}

/// The sum of a polyhedron and a ball.
fn rounded_polyhedron(
    builder: &mut Builder,
    polyhedron: &Polyhedron,
    radius: &Rational,
) -> Result<SolidId, ConstructionError> {
    let primitive = |polyhedron: Polyhedron| Primitive::Polyhedron {
        polyhedron: Arc::new(polyhedron),
    };
    let mut parts = vec![builder.primitive(primitive(polyhedron.clone()))];
    let zero: SpacePoint = std::array::from_fn(|_| Rational::ZERO);
    for face in 0..polyhedron.faces().len() {
        let normal = polyhedron.normal(face);
        let length = frames::length(&normal);
        let up = normal.map(|x| x * radius / &length);
        let slab = swept_face(polyhedron, face, [&zero, &up])?;
        parts.push(builder.primitive(primitive(slab)));
    }
    for [i, j] in polyhedron.faces().iter().flat_map(|face| face.edges()) {
        if i < j {
            let ends = [i, j].map(|k| &polyhedron.points()[k]);
            parts.push(tube(builder, ends, radius)?);
        }
    }
    for corner in polyhedron.points() {
        parts.push(ball(builder, corner, radius)?);
    }
    Ok(builder.operation(Operation::Union, &parts))
}

/// The points between two distances from a convex polygon.
fn slab(
    outline: &[SpacePoint],
    normal: &SpacePoint,
    range: &[Rational; 2],
) -> Result<Polyhedron, PolyhedronError> {
    let size = frames::length(normal);
    let points = range.iter().flat_map(|distance| {
        let by = normal.each_ref().map(|x| x * distance / &size);
        let moved = move |p: &SpacePoint| -> SpacePoint { std::array::from_fn(|i| &p[i] + &by[i]) };
        outline.iter().map(moved)
    });
    Polyhedron::convex_hull(&points.collect::<Vec<_>>())
}

/// The sum of a convex polygon in space and a ball.
fn rounded_polygon(
    builder: &mut Builder,
    points: &[SpacePoint],
    radius: &Rational,
) -> Result<SolidId, ConstructionError> {
    let normal = normal_of(points).ok_or(ConstructionError::NoHull)?;
    // The hull of the points and of copies on one side has the polygon as a face.
    let raised = points
        .iter()
        .flat_map(|p| [p.clone(), std::array::from_fn(|i| &p[i] + &normal[i])]);
    let prism = Polyhedron::convex_hull(&raised.collect::<Vec<_>>())?;
    let is_base = |face: &usize| {
        let own = prism.normal(*face);
        let is_parallel = cross(&own, &normal).iter().all(Rational::is_zero);
        is_parallel && dot(&own, &normal) < Rational::ZERO
    };
    let base = (0..prism.faces().len()).find(is_base);
    let base = base.ok_or(ConstructionError::NoHull)?;
    let outline: Vec<SpacePoint> = prism.corners(base).cloned().collect();
    let slab = slab(&outline, &normal, &[-radius, radius.clone()])?;
    let polyhedron = Arc::new(slab);
    let mut parts = vec![builder.primitive(Primitive::Polyhedron { polyhedron })];
    let next = outline.iter().cycle().skip(1);
    for (from, to) in outline.iter().zip(next) {
        parts.push(tube(builder, [from, to], radius)?);
        parts.push(ball(builder, from, radius)?);
    }
    Ok(builder.operation(Operation::Union, &parts))
}

/// A normal of the plane of points that are not in a line.
fn normal_of(points: &[SpacePoint]) -> Option<SpacePoint> {
    let from = |p: &SpacePoint| -> SpacePoint { std::array::from_fn(|i| &p[i] - &points[0][i]) };
    let is_zero = |u: &SpacePoint| u.iter().all(Rational::is_zero);
    let u = points.iter().map(from).find(|u| !is_zero(u))?;
    let mut normals = points.iter().map(|p| cross(&u, &from(p)));
    normals.find(|n| !is_zero(n))
}

/// The sum of a placed primitive and a ball about the origin.
pub(super) fn rounded(
    builder: &mut Builder,
    placed: &PlacedPrimitive,
    radius: &Rational,
) -> Result<SolidId, ConstructionError> {
    let back = |builder: &mut Builder, solid: SolidId| {
        builder.moved(solid, Transform::from_motion(&placed.motion))
    };
    match &placed.primitive {
        Primitive::Sphere { radius: own } => {
            let ball = builder.primitive(Primitive::sphere(own + radius)?);
            Ok(back(builder, ball))
        }
        Primitive::Torus { major, minor } => {
            let torus = builder.primitive(Primitive::torus(major.clone(), minor + radius)?);
            Ok(back(builder, torus))
        }
        Primitive::Cylinder {
            radius: own,
            height,
        } => {
            let outline = rounded_profile(&[[own, &Rational::ZERO], [own, height]], radius)?;
            let part = builder.primitive(Primitive::revolution(outline, None)?);
            Ok(back(builder, part))
        }
        Primitive::Frustum { base, top, height } => {
            let outline = rounded_profile(&[[base, &Rational::ZERO], [top, height]], radius)?;
            let part = builder.primitive(Primitive::revolution(outline, None)?);
            Ok(back(builder, part))
        }
        Primitive::Prism {
            figure,
            height,
            top,
        } if top.is_one() => {
            let part = rounded_prism(builder, figure, height, radius)?;
            Ok(back(builder, part))
        }
        other => {
            own_corners(other).ok_or(ConstructionError::NoSum)?;
            let part = rounded_polyhedron(builder, &*polyhedron(other)?, radius)?;
            Ok(back(builder, part))
        }
    }
}

/// The right half of the sum of a disc and the hull of points at both sides of the axis.
fn rounded_profile(
    rims: &[[&Rational; 2]],
    radius: &Rational,
) -> Result<Figure, ConstructionError> {
    let discs = rims.iter().flat_map(|[r, z]| {
        [(*r).clone(), -*r].map(|x| Disc {
            centre: [x, (*z).clone()],
            radius: radius.clone(),
        })
    });
    let hull = Figure::convex_hull(&discs.collect::<Vec<_>>())?;
    hull.right_of_axis()?.ok_or(ConstructionError::NoSum)
}

/// The sum of an extruded figure and a ball.
fn rounded_prism(
    builder: &mut Builder,
    figure: &Figure,
    height: &Rational,
    radius: &Rational,
) -> Result<SolidId, ConstructionError> {
    let grown = figure.offset(radius, OffsetJoin::Round)?;
    let wide = builder.primitive(Primitive::prism(grown, height.clone())?);
    let high = Primitive::prism(figure.clone(), height + radius * Rational::from(2))?;
    let high = builder.primitive(high);
    let down = Transform::shift([Rational::ZERO, Rational::ZERO, -radius]);
    let mut parts = vec![wide, builder.moved(high, down)];
    for level in [&Rational::ZERO, height] {
        for contour in figure.contours() {
            let next = contour.iter().cycle().skip(1);
            for (edge, next) in contour.iter().zip(next) {
                parts.push(rounded_edge(builder, edge, level, radius)?);
                if turns_left(edge, next) {
                    parts.push(ball(builder, &raised(&edge.end, level), radius)?);
                }
            }
        }
    }
    Ok(builder.operation(Operation::Union, &parts))
}

fn raised([x, y]: &FigurePoint, level: &Rational) -> SpacePoint {
    [x.clone(), y.clone(), level.clone()]
}

/// The direction of an edge at one of its ends, of any length.
fn direction(edge: &FigureEdge, at: &FigurePoint) -> FigurePoint {
    match &edge.arc {
        Some(arc) => {
            let [x, y] = [0, 1].map(|i| &at[i] - &arc.centre[i]);
            match arc.turn {
                ArcTurn::Counterclockwise => [-y, x],
                ArcTurn::Clockwise => [y, -x],
            }
        }
        None => [0, 1].map(|i| &edge.end[i] - &edge.start[i]),
    }
}

/// Whether the outline turns towards the material between two edges.
fn turns_left(edge: &FigureEdge, next: &FigureEdge) -> bool {
    let (u, v) = (direction(edge, &edge.end), direction(next, &next.start));
    &u[0] * &v[1] - &u[1] * &v[0] > Rational::ZERO
}

/// The sum of an edge of a figure and a ball: a cylinder, or a part of a torus.
fn rounded_edge(
    builder: &mut Builder,
    edge: &FigureEdge,
    level: &Rational,
    radius: &Rational,
) -> Result<SolidId, ConstructionError> {
    let Some(arc) = &edge.arc else {
        let ends = [&edge.start, &edge.end].map(|p| raised(p, level));
        let [from, to] = &ends;
        return tube(builder, [from, to], radius);
    };
    let at = |x: Rational| -> FigurePoint { [x, Rational::ZERO] };
    let disc = |start: FigurePoint, end: FigurePoint| ContourCorner {
        point: start,
        arc: Some(FigureArc {
            centre: end,
            radius: radius.clone(),
            turn: ArcTurn::Counterclockwise,
        }),
    };
    let section = Figure::from_contours(&[vec![
        disc(at(&arc.radius - radius), at(arc.radius.clone())),
        disc(at(&arc.radius + radius), at(arc.radius.clone())),
    ]])?;
    let from = match arc.turn {
        ArcTurn::Counterclockwise => &edge.start,
        ArcTurn::Clockwise => &edge.end,
    };
    let degrees = edge.degrees();
    let angle = RevolutionAngle::new(degrees).ok_or(ConstructionError::NoSum)?;
    let part = builder.primitive(Primitive::revolution(section, Some(angle))?);
    let [x, y] = [0, 1].map(|i| &from[i] - &arc.centre[i]);
    // Half the turn from the first axis to the start.
    let away = frames::length(&[x.clone(), y.clone(), Rational::ZERO]);
    let half = match x < Rational::ZERO {
        true => [y, Rational::ZERO, Rational::ZERO, away - x],
        false => [away + x, Rational::ZERO, Rational::ZERO, y],
    };
    let turn = Motion::from_quaternion(half).unwrap_or_default();
    let turn = turn.then(&Motion::translation(raised(&arc.centre, level)));
    Ok(builder.moved(part, Transform::from_motion(&turn)))
}
