//! Prisms whose walls are elliptic: figures with arcs that a map stretches, or that are scaled along
//! the prism about a point that is not the centre of the arcs.
//!
//! A contour is the polygon of its chords, and the segments between chords and arcs: those of arcs
//! that bulge outwards are added, the others removed. A segment is the part of a frustum beyond the
//! plane of a chord.

use std::sync::Arc;

use premio_kernel::number::predicates::Compare;
use premio_kernel::number::rational::{Rational, to_f64};

use super::affine_map::AffineMap;
use super::plane_faces::polyhedron;
use super::{ConstructionError, frames};
use crate::builder::{Builder, SolidId};
use crate::figure::{
    ArcTurn, Disc, Figure, FigureArc, FigureEdge, FigureError, FigureOperation, FigurePoint,
    PlaneMap,
};
use crate::polyhedron::SpacePoint;
use crate::primitive::{Primitive, PrimitiveError};
use crate::transform::Transform;
use crate::tree::Operation;

/// A prism of a figure under maps.
pub struct ObliquePrism<'a> {
    /// A map of the figure's plane, of which the image is extruded.
    pub plane: &'a PlaneMap,
    /// The height.
    pub height: &'a Rational,
    /// The factor by which the image is scaled about the z axis at the height.
    pub top: &'a Rational,
    /// A map of the prism.
    pub space: &'a AffineMap,
}

/// A piece of a contour, in the figure's plane: a polygon, or a segment of a disc.
struct Segment {
    disc: Disc,
    /// A rectangle whose side is the chord's line, around the part of the disc beyond it.
    beyond: Figure,
    bulges: bool,
}

/// The relative difference of areas that is rounding.
const ROUNDING: f64 = 1.0 / (1u64 << 30) as f64;

impl ObliquePrism<'_> {
    /// The solid of a figure.
    ///
    /// # Errors
    /// The chords of the figure's arcs cross other edges, or the maps are flat.
    pub fn solid(
        &self,
        builder: &mut Builder,
        figure: &Figure,
    ) -> Result<SolidId, ConstructionError> {
        if let Some(disc) = figure.as_disc() {
            return self.frustum(builder, &disc);
        }
        if figure.is_polygon() {
            return self.polygon(builder, figure);
        }
        let [outer, holes] = figure.contour_figures();
        let is_inside = |inner: &Figure, outer: &Figure| {
            let ([lo, hi], [from, to]) = (inner.bounds(), outer.bounds());
            (0..2).all(|i| lo[i].reaches(from[i]) && hi[i].is_at_most(to[i]))
        };
        if outer
            .iter()
            .any(|own| holes.iter().any(|hole| is_inside(own, hole)))
        {
            // An island in a hole.
            return Err(ConstructionError::CrossedChords);
        }
        let mut solids = |contours: &[Figure]| -> Result<SolidId, ConstructionError> {
            let each = contours.iter().map(|own| self.contour(builder, own));
            let each: Vec<SolidId> = each.collect::<Result<_, _>>()?;
            Ok(builder.operation(Operation::Union, &each))
        };
        let (outer, holes) = (solids(&outer)?, solids(&holes)?);
        Ok(builder.operation(Operation::Difference, &[outer, holes]))
    }

    /// The solid of a counterclockwise contour.
    fn contour(&self, builder: &mut Builder, own: &Figure) -> Result<SolidId, ConstructionError> {
        if let Some(disc) = own.as_disc() {
            return self.frustum(builder, &disc);
        }
        if own.is_polygon() {
            return self.polygon(builder, own);
        }
        let chords: Vec<FigurePoint> = own.edges().iter().map(|edge| edge.start.clone()).collect();
        let polygon = match chords.len() > 2 {
            true => match Figure::polygon(&[chords]) {
                Err(FigureError::Empty) => None,
                made => Some(made?),
            },
            false => None,
        };
        let segments = own.edges().iter().filter_map(segment);
        let segments: Vec<Segment> = segments.collect::<Result<_, _>>()?;
        if !are_the_contour(own, polygon.as_ref(), &segments)? {
            return Err(ConstructionError::CrossedChords);
        }
        let mut added = Vec::new();
        let mut removed = Vec::new();
        if let Some(polygon) = &polygon {
            added.push(self.polygon(builder, polygon)?);
        }
        for segment in &segments {
            let whole = self.frustum(builder, &segment.disc)?;
            let beyond = self.polygon(builder, &segment.beyond)?;
            let part = builder.operation(Operation::Intersection, &[whole, beyond]);
            match segment.bulges {
                true => added.push(part),
                false => removed.push(part),
            }
        }
        let added = builder.operation(Operation::Union, &added);
        let all: Vec<SolidId> = std::iter::once(added).chain(removed).collect();
        Ok(builder.operation(Operation::Difference, &all))
    }

    /// The frustum of a disc.
    fn frustum(&self, builder: &mut Builder, disc: &Disc) -> Result<SolidId, ConstructionError> {
        let [x, y] = self.plane.apply(&disc.centre);
        let radius = |k: usize| {
            let [a, b] = [0, 1].map(|i| &self.plane.matrix[i][k] * &disc.radius);
            self.space.vector(&[a, b, Rational::ZERO])
        };
        let growth = self.top - Rational::ONE;
        let up = self
            .space
            .vector(&[&x * &growth, &y * &growth, self.height.clone()]);
        let axes = [radius(0), radius(1), up];
        let base = self.space.point(&[x, y, Rational::ZERO]);
        oblique_frustum(builder, axes, self.top.clone(), base)
    }

    /// The polyhedron of a polygon.
    fn polygon(&self, builder: &mut Builder, own: &Figure) -> Result<SolidId, ConstructionError> {
        let figure = own.mapped(self.plane)?;
        let prism = Primitive::scaled_prism(figure, self.height.clone(), self.top.clone())?;
        if self.space.is_identity() {
            return Ok(builder.primitive(prism));
        }
        let image = polyhedron(&prism)?.mapped(&self.space.matrix, &self.space.offset)?;
        let polyhedron = Arc::new(image);
        Ok(builder.primitive(Primitive::Polyhedron { polyhedron }))
    }
}

/// A prism of a figure that is scaled about z on the way up: one primitive, unless arcs off the axis
/// lead to elliptic cones.
///
/// # Errors
/// The height is not greater than zero, the factor is negative, or the chords of the figure's arcs
/// cross other edges.
pub fn scaled_prism(
    builder: &mut Builder,
    figure: &Figure,
    height: &Rational,
    top: &Rational,
) -> Result<SolidId, ConstructionError> {
    match Primitive::scaled_prism(figure.clone(), height.clone(), top.clone()) {
        Err(PrimitiveError::ObliqueArc) => ObliquePrism {
            plane: &PlaneMap::identity(),
            height,
            top,
            space: &AffineMap::identity(),
        }
        .solid(builder, figure),
        made => Ok(builder.primitive(made?)),
    }
}

/// An oblique frustum, or a right one if it is one: of radii across its axis.
pub(super) fn oblique_frustum(
    builder: &mut Builder,
    axes: [SpacePoint; 3],
    top: Rational,
    base: SpacePoint,
) -> Result<SolidId, ConstructionError> {
    let right = frames::right_frustum(&axes, &top);
    let (primitive, place) = match right {
        Some((primitive, motion)) => (primitive?, Transform::from_motion(&motion)),
        None => (Primitive::oblique_frustum(axes, top)?, Transform::new()),
    };
    let part = builder.primitive(primitive);
    let part = builder.moved(part, place);
    Ok(builder.moved(part, Transform::shift(base)))
}

/// The segment between an arc and its chord.
fn segment(edge: &FigureEdge) -> Option<Result<Segment, ConstructionError>> {
    let arc = edge.arc.as_ref()?;
    let disc = Disc {
        centre: arc.centre.clone(),
        radius: arc.radius.clone(),
    };
    let bulges = arc.turn == ArcTurn::Counterclockwise;
    Some(beyond(edge, arc, bulges).map(|beyond| Segment {
        disc,
        beyond,
        bulges,
    }))
}

/// A rectangle beyond the chord of an arc that holds the whole disc's part there.
fn beyond(edge: &FigureEdge, arc: &FigureArc, bulges: bool) -> Result<Figure, ConstructionError> {
    let [start, end] = [&edge.start, &edge.end];
    let along = [0, 1].map(|i| &end[i] - &start[i]);
    let length = to_f64(&(&along[0] * &along[0] + &along[1] * &along[1])).sqrt();
    // As many chords as cover the diameter, at both ends and across.
    let count = Rational::from((2.0 * to_f64(&arc.radius) / length).ceil().min(1e9) as u64 + 1);
    let side = if bulges {
        &count * Rational::ONE
    } else {
        -&count
    };
    let across = [&along[1] * &side, -&along[0] * &side];
    let at = |from: &FigurePoint, by: &Rational, out: bool| -> FigurePoint {
        std::array::from_fn(|i| {
            let moved = &from[i] + &along[i] * by;
            if out { moved + &across[i] } else { moved }
        })
    };
    let mut corners = vec![
        at(start, &-&count, false),
        at(start, &-&count, true),
        at(end, &count, true),
        at(end, &count, false),
    ];
    if !bulges {
        corners.reverse();
    }
    Ok(Figure::polygon(&[corners])?)
}

/// Whether the polygon and the segments make the contour, by the areas in the plane.
fn are_the_contour(
    own: &Figure,
    polygon: Option<&Figure>,
    segments: &[Segment],
) -> Result<bool, ConstructionError> {
    let mut added: Vec<Figure> = polygon.cloned().into_iter().collect();
    let mut removed = Vec::new();
    for segment in segments {
        let disc = Figure::disc(&segment.disc.radius)?;
        let place = PlaneMap {
            offset: segment.disc.centre.clone(),
            ..PlaneMap::identity()
        };
        let disc = disc.mapped(&place)?;
        let part = Figure::combined(FigureOperation::Intersection, &[&disc, &segment.beyond])?;
        match segment.bulges {
            true => added.push(part),
            false => removed.push(part),
        }
    }
    let added: Vec<&Figure> = added.iter().collect();
    let added = Figure::combined(FigureOperation::Union, &added)?;
    let all: Vec<&Figure> = std::iter::once(&added).chain(&removed).collect();
    let made = Figure::combined(FigureOperation::Difference, &all)?;
    let off = (made.area() - own.area()).abs();
    Ok(off.is_at_most(ROUNDING * own.area()))
}
