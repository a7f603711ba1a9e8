//! The solids that regions of the plane sweep: extrusions and revolutions.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::error::SpannedError;
use super::number::bad_length;
use super::refusal::construction_error;
use super::region::{Region, RegionFigure, bad_figure};
use crate::builder::{Builder, SolidId};
use crate::construction::{AffineMap, ObliquePrism, scaled_prism};
use crate::figure::{Figure, FigureOperation, FigurePoint, PlaneMap};
use crate::primitive::{Primitive, PrimitiveError, RevolutionAngle};
use crate::transform::Transform;
use crate::tree::Operation;

/// A straight extrusion along z, from z = 0.
pub(super) struct Extrusion<'a> {
    pub(super) height: &'a Rational,
    /// The factor of the figure at the height.
    pub(super) top: &'a Rational,
}

impl Extrusion<'_> {
    /// The solid of a region. An error is at the place of a figure, or of the sweep.
    pub(super) fn solid(
        &self,
        builder: &mut Builder,
        region: &Region,
        place: &Range<usize>,
    ) -> Result<SolidId, SpannedError> {
        as_parts_or_whole(region, place, |region| {
            solid_of(builder, region, false, &|builder, figure, _| {
                self.of_figure(builder, figure)
            })
        })
    }

    fn of_figure(
        &self,
        builder: &mut Builder,
        figure: &RegionFigure,
    ) -> Result<SolidId, SpannedError> {
        let span = &figure.span;
        let wrong = |error: PrimitiveError| bad_length(error, None, span.clone());
        let factor = self.top;
        if let Some(moves) = &figure.moves
            && factor.is_one()
        {
            let part = extruded(&figure.base, self.height).map_err(wrong)?;
            let solid = builder.primitive(part.primitive);
            let solid = builder.moved(solid, part.moves);
            return Ok(builder.moved(solid, moves.clone()));
        }
        let is_flat = figure.map.determinant().is_zero();
        if !figure.base.is_polygon() && !is_flat && figure.map.factor().is_none() {
            return self.oblique(builder, &figure.base, &figure.map, span);
        }
        let placed = figure.figure()?;
        if factor.is_one() {
            let part = extruded(&placed, self.height).map_err(wrong)?;
            let solid = builder.primitive(part.primitive);
            return Ok(builder.moved(solid, part.moves));
        }
        let scaled = match placed.centred_disc() {
            Some(radius) => {
                Primitive::frustum(radius.clone(), radius * factor, self.height.clone())
            }
            None => {
                let made = scaled_prism(builder, &placed, self.height, factor);
                return made.map_err(|error| construction_error(&error, span));
            }
        };
        Ok(builder.primitive(scaled.map_err(wrong)?))
    }

    /// The solid of a figure whose arcs become ellipses, or lead to oblique cones.
    fn oblique(
        &self,
        builder: &mut Builder,
        figure: &Figure,
        map: &PlaneMap,
        span: &Range<usize>,
    ) -> Result<SolidId, SpannedError> {
        let prism = ObliquePrism {
            plane: map,
            height: self.height,
            top: self.top,
            space: &AffineMap::identity(),
        };
        let solid = prism.solid(builder, figure);
        solid.map_err(|error| construction_error(&error, span))
    }
}

/// The solid of a region: from the figures that it combines, and if one of them has no exact solid,
/// from their result in the plane.
fn as_parts_or_whole(
    region: &Region,
    span: &Range<usize>,
    mut solid: impl FnMut(&Region) -> Result<SolidId, SpannedError>,
) -> Result<SolidId, SpannedError> {
    let refused = match solid(region) {
        Err(refused) if matches!(region, Region::Combined { .. }) => refused,
        made => return made,
    };
    match region.evaluated(span) {
        Ok(Some(whole)) => solid(&Region::new(whole, region.span())).map_err(|_| refused),
        Ok(None) => Ok(SolidId::EMPTY),
        Err(_) => Err(refused),
    }
}

/// The solid of a region, from the solid of each of its figures. The last argument of `of_figure` says
/// whether the figure is cut by others.
fn solid_of(
    builder: &mut Builder,
    region: &Region,
    is_cut: bool,
    of_figure: &impl Fn(&mut Builder, &RegionFigure, bool) -> Result<SolidId, SpannedError>,
) -> Result<SolidId, SpannedError> {
    match region {
        Region::Figure(figure) => of_figure(builder, figure, is_cut),
        Region::Combined { op, operands, .. } => {
            let is_cut = is_cut || *op != FigureOperation::Union;
            let parts: Vec<SolidId> = operands
                .iter()
                .map(|operand| solid_of(builder, operand, is_cut, of_figure))
                .collect::<Result<_, _>>()?;
            Ok(builder.operation(operation(*op), &parts))
        }
    }
}

/// A primitive and its place.
struct Extruded {
    primitive: Primitive,
    moves: Transform,
}

/// The extruded figure: a block, a wedge, a cylinder or a prism.
fn extruded(figure: &Figure, height: &Rational) -> Result<Extruded, PrimitiveError> {
    if let Some(disc) = figure.as_disc() {
        let [x, y] = disc.centre;
        return Ok(Extruded {
            primitive: Primitive::cylinder(disc.radius, height.clone())?,
            moves: Transform::shift([x, y, Rational::ZERO]),
        });
    }
    if let Some([[x, y], end]) = rectangle(figure) {
        let size = [&end[0] - &x, &end[1] - &y, height.clone()];
        return Ok(Extruded {
            primitive: Primitive::block(size)?,
            moves: Transform::shift([x, y, Rational::ZERO]),
        });
    }
    if let Some(wedge) = wedge(figure, height)? {
        return Ok(wedge);
    }
    Ok(Extruded {
        primitive: Primitive::prism(figure.clone(), height.clone())?,
        moves: Transform::new(),
    })
}

/// The least and the greatest corner of a figure that is a rectangle along the axes.
fn rectangle(figure: &Figure) -> Option<[FigurePoint; 2]> {
    if figure.edges().len() != 4 || !figure.is_polygon() {
        return None;
    }
    let corners = || figure.edges().iter().map(|edge| &edge.start);
    let least: FigurePoint =
        [0, 1].map(|i| corners().map(|p| &p[i]).min().cloned().unwrap_or_default());
    let most: FigurePoint =
        [0, 1].map(|i| corners().map(|p| &p[i]).max().cloned().unwrap_or_default());
    let is_corner = |p: &FigurePoint| (0..2).all(|i| p[i] == least[i] || p[i] == most[i]);
    let is_along = figure
        .edges()
        .iter()
        .all(|edge| edge.start[0] == edge.end[0] || edge.start[1] == edge.end[1]);
    (corners().all(is_corner) && is_along && figure.contours().count() == 1)
        .then_some([least, most])
}

/// A triangle with a right angle between legs along the axes: a wedge. The primitive's right angle
/// lies between x and z, and its length is along y. With u along one leg, v along the other and w
/// upwards, its x is placed along u, its z along v, and its y along w or -w, whichever gives a
/// right-handed rotation.
fn wedge(figure: &Figure, height: &Rational) -> Result<Option<Extruded>, PrimitiveError> {
    let corners: Vec<&FigurePoint> = figure.edges().iter().map(|edge| &edge.start).collect();
    let [a, b, c] = corners[..] else {
        return Ok(None);
    };
    if !figure.is_polygon() {
        return Ok(None);
    }
    let turns = [
        [a, b, c],
        [b, c, a],
        [c, a, b],
        [a, c, b],
        [b, a, c],
        [c, b, a],
    ];
    // The corner with the right angle, followed by the ends of the legs along x and y.
    let right = turns
        .into_iter()
        .find(|[o, p, q]| o[1] == p[1] && o[0] == q[0]);
    let Some([corner, along_x, along_y]) = right else {
        return Ok(None);
    };
    let (leg_x, leg_y) = (&along_x[0] - &corner[0], &along_y[1] - &corner[1]);
    let sign = |leg: &Rational| if *leg > Rational::ZERO { 1i32 } else { -1 };
    let (u, v) = (sign(&leg_x), sign(&leg_y));
    // Columns (u,0,0), (0,0,w), (0,v,0): the determinant is -u v w.
    let w = -u * v;
    let matrix = [[u, 0, 0], [0, 0, v], [0, w, 0]].map(|row| row.map(Rational::from));
    // Along -w the wedge lies below its plane and is lifted by its length.
    let lift = if w < 0 {
        height.clone()
    } else {
        Rational::ZERO
    };
    let offset = [corner[0].clone(), corner[1].clone(), lift];
    let size = [
        leg_x * Rational::from(u),
        height.clone(),
        leg_y * Rational::from(v),
    ];
    let turn = Transform::quarter_turns(&matrix).unwrap_or_default();
    Ok(Some(Extruded {
        primitive: Primitive::wedge(size)?,
        moves: turn.then(Transform::shift(offset)),
    }))
}

pub(super) fn operation(op: FigureOperation) -> Operation {
    match op {
        FigureOperation::Union => Operation::Union,
        FigureOperation::Intersection => Operation::Intersection,
        FigureOperation::Difference => Operation::Difference,
    }
}

/// A revolution about z.
pub(super) struct Revolution<'a> {
    /// The angle; `None` for a whole turn.
    pub(super) angle: Option<&'a RevolutionAngle>,
}

impl Revolution<'_> {
    /// The solid of a region. An error is at the place of a figure, or of the sweep.
    pub(super) fn solid(
        &self,
        builder: &mut Builder,
        region: &Region,
        place: &Range<usize>,
    ) -> Result<SolidId, SpannedError> {
        as_parts_or_whole(region, place, |region| {
            solid_of(builder, region, false, &|builder, figure, is_cut| {
                self.of_figure(builder, figure, is_cut)
            })
        })
    }

    fn of_figure(
        &self,
        builder: &mut Builder,
        region: &RegionFigure,
        is_cut: bool,
    ) -> Result<SolidId, SpannedError> {
        let span = &region.span;
        let wrong = |error: PrimitiveError| bad_length(error, None, span.clone());
        let figure = region.figure()?;
        if let Some(disc) = figure.as_disc()
            && self.angle.is_none()
            && disc.centre[0] > disc.radius
        {
            let [x, z] = disc.centre;
            let torus = builder.primitive(Primitive::torus(x, disc.radius).map_err(wrong)?);
            let lift = Transform::shift([Rational::ZERO, Rational::ZERO, z]);
            return Ok(builder.moved(torus, lift));
        }
        if figure.crosses_axis() && !is_cut {
            return Err(wrong(PrimitiveError::AcrossAxis));
        }
        // OpenSCAD revolves a figure on the other side of the axis, too. Of an operand only the part
        // on this side matters.
        let is_beyond = figure.is_left_of_axis() && !is_cut;
        let figure = match is_beyond {
            true => figure.mirrored_x(),
            false => figure,
        };
        let kept = figure.right_of_axis().map_err(|e| bad_figure(&e, span))?;
        let Some(figure) = kept else {
            return Ok(SolidId::EMPTY);
        };
        let part = Primitive::revolution(figure, self.angle.cloned()).map_err(wrong)?;
        let part = builder.primitive(part);
        Ok(match is_beyond {
            true => builder.moved(part, half_turn()),
            false => part,
        })
    }
}

/// Half a turn about z.
fn half_turn() -> Transform {
    let turn = [[-1, 0, 0], [0, -1, 0], [0, 0, 1]].map(|row| row.map(Rational::from));
    Transform::quarter_turns(&turn).unwrap_or_default()
}
