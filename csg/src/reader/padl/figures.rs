//! Figures of the plane, solids of them, and unbounded solids: their evaluation.

use std::ops::Range;
use std::rc::Rc;
use std::sync::Arc;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::number::{bad_length, show};
use super::super::refusal::{construction_error, invalid_polyhedron};
use super::super::region::{Region, bad_figure};
use super::super::spanned::Spanned;
use super::super::sweep::{Extrusion, Revolution};
use super::expression::{ListValue, Operand, TupleValue, Value};
use super::keywords::{Construction, Outline};
use super::machine::Machine;
use crate::builder::SolidId;
use crate::construction::convex_hull;
use crate::figure::{ContourCorner, Figure, FigureArc, FigureError, FigureOperation, OffsetJoin};
use crate::polyhedron::{Polyhedron, PolyhedronFace, SpacePoint};
use crate::primitive::{Dimension, Primitive, PrimitiveError, RevolutionAngle, UnboundedPrimitive};
use crate::transform::Transform;
use crate::tree::Operation;

type Number = Spanned<Rational>;

/// The operation of the plane that corresponds to one of space.
fn plane_operation(operation: Operation) -> FigureOperation {
    match operation {
        Operation::Union => FigureOperation::Union,
        Operation::Intersection => FigureOperation::Intersection,
        Operation::Difference => FigureOperation::Difference,
    }
}

/// The arguments of a construction, by their indices.
struct Given {
    figure: Option<Spanned<Option<Rc<Region>>>>,
    solid: SolidId,
    numbers: [Option<Number>; 4],
}

impl Given {
    fn new(
        construction: Construction,
        arguments: impl Iterator<Item = (usize, Operand)>,
    ) -> Result<Self, SpannedError> {
        let mut given = Self {
            figure: None,
            solid: SolidId::EMPTY,
            numbers: [None, None, None, None],
        };
        for (index, operand) in arguments {
            let name = construction.arguments().get(index).copied();
            let name = name.unwrap_or_default();
            let what_for = match name {
                "FIGURE" | "SOLID" => format!("for `{}`", construction.word()),
                name => format!("for `{name}`"),
            };
            let place = operand.span.clone();
            if name == "FIGURE" {
                given.figure = Some(Spanned::new(operand.figure(&what_for)?, place));
            } else if name == "SOLID" {
                given.solid = operand.solid(&what_for)?;
            } else if let Some(slot) = given.numbers.get_mut(index) {
                *slot = Some(Spanned::new(operand.number(&what_for)?, place));
            }
        }
        Ok(given)
    }

    /// An argument that may be left out.
    fn number(&self, index: usize) -> Option<&Number> {
        self.numbers.get(index).and_then(Option::as_ref)
    }

    /// A length greater than zero.
    fn length(&self, index: usize, dimension: Dimension) -> Result<Rational, SpannedError> {
        let known = self.number(index);
        match known {
            Some(Spanned { value, span }) if *value <= Rational::ZERO => {
                let error = PrimitiveError::NotPositive(dimension);
                Err(bad_length(error, Some(value), span.clone()))
            }
            known => Ok(known.map_or(Rational::ZERO, |known| known.value.clone())),
        }
    }
}

/// An unbounded solid.
fn unbounded(
    construction: Construction,
    given: &Given,
    span: &Range<usize>,
) -> Result<UnboundedPrimitive, SpannedError> {
    let number = |index: usize| {
        let known = given.number(index);
        known.map_or(Rational::ZERO, |known| known.value.clone())
    };
    let made = match construction {
        Construction::InfiniteCylinder => {
            UnboundedPrimitive::cylinder(given.length(0, Dimension::Radius)?)
        }
        Construction::InfiniteCone => UnboundedPrimitive::cone(given.length(0, Dimension::Slope)?),
        _ => UnboundedPrimitive::half_space([0, 1, 2].map(number), number(3)),
    };
    made.map_err(|error| bad_length(error, None, span.clone()))
}

impl Machine {
    /// A set operation on figures.
    pub(super) fn combine_figures(
        &mut self,
        operation: Operation,
        left: Option<Rc<Region>>,
        right: Option<Rc<Region>>,
        span: &Range<usize>,
    ) -> Result<Value, SpannedError> {
        let copied = |region: &Option<Rc<Region>>| match region {
            Some(region) if Rc::strong_count(region) > 1 => region.edge_count(),
            _ => 0,
        };
        self.budget
            .count_edges(1 + copied(&left) + copied(&right), span)?;
        let [left, right] = [left, right].map(|region| region.map(Rc::unwrap_or_clone));
        let joined = Region::joined(plane_operation(operation), left, right)?;
        Ok(Value::Figure(joined.map(Rc::new)))
    }

    /// Moves a figure in the plane.
    pub(super) fn move_figure(
        &mut self,
        region: Option<Rc<Region>>,
        moves: &Transform,
        span: &Range<usize>,
    ) -> Result<Value, SpannedError> {
        let Some(region) = region else {
            return Ok(Value::Figure(None));
        };
        self.budget.count_edges(region.edge_count(), span)?;
        let moved = Rc::unwrap_or_clone(region).moved(moves);
        Ok(Value::Figure(Some(Rc::new(moved))))
    }

    /// Makes a figure or a solid of a figure.
    pub(super) fn construct(
        &mut self,
        construction: Construction,
        arguments: &[usize],
        span: &Range<usize>,
    ) -> Result<(), SpannedError> {
        let values = self.pop_many(arguments.len());
        let given = Given::new(construction, arguments.iter().copied().zip(values))?;
        let edges = given.figure.as_ref().and_then(|known| known.value.as_ref());
        let edges = edges.map_or(4, |region| region.edge_count());
        self.budget.count_edges(edges, span)?;
        let value = match construction {
            Construction::Rectangle => {
                let size = [
                    given.length(0, Dimension::X)?,
                    given.length(1, Dimension::Y)?,
                ];
                figure_value(Figure::rectangle(&size), span)?
            }
            Construction::Disc => {
                let radius = given.length(0, Dimension::Radius)?;
                figure_value(Figure::disc(&radius), span)?
            }
            Construction::Offset => offset(&given, span)?,
            Construction::Prism => self.prism(&given, span)?,
            Construction::Revolution => self.revolution(&given, span)?,
            Construction::HalfSpace
            | Construction::InfiniteCylinder
            | Construction::InfiniteCone => {
                let primitive = unbounded(construction, &given, span)?;
                Value::Solid(self.builder.unbounded(primitive))
            }
            Construction::Outside => Value::Solid(self.builder.complement(given.solid)),
        };
        self.push(value, span);
        Ok(())
    }

    fn prism(&mut self, given: &Given, span: &Range<usize>) -> Result<Value, SpannedError> {
        let height = &given.length(1, Dimension::Height)?;
        let top = match given.number(2) {
            Some(Spanned { value, span }) if *value < Rational::ZERO => {
                let error = PrimitiveError::Negative(Dimension::Top);
                return Err(bad_length(error, Some(value), span.clone()));
            }
            top => top.map_or(Rational::ONE, |top| top.value.clone()),
        };
        let extrusion = Extrusion { height, top: &top };
        let solid = match given.figure.as_ref().and_then(|known| known.value.as_ref()) {
            Some(region) => extrusion.solid(&mut self.builder, region, span)?,
            None => SolidId::EMPTY,
        };
        Ok(Value::Solid(solid))
    }

    fn revolution(&mut self, given: &Given, span: &Range<usize>) -> Result<Value, SpannedError> {
        let angle = match given.number(1) {
            Some(degrees) if degrees.value != Rational::from(360) => {
                let angle = RevolutionAngle::new(degrees.value.clone());
                Some(angle.ok_or_else(|| {
                    let found = show(&degrees.value);
                    let expected = "an angle greater than 0, and at most 360 degrees";
                    SpannedError::input(degrees.span.clone(), found, expected)
                })?)
            }
            _ => None,
        };
        let revolution = Revolution {
            angle: angle.as_ref(),
        };
        let solid = match given.figure.as_ref().and_then(|known| known.value.as_ref()) {
            Some(region) => revolution.solid(&mut self.builder, region, span)?,
            None => SolidId::EMPTY,
        };
        Ok(Value::Solid(solid))
    }

    /// The convex hull of solids, or of figures.
    pub(super) fn hull(&mut self, count: usize, span: &Range<usize>) -> Result<(), SpannedError> {
        let operands = self.pop_many(count);
        let is_plane = operands.iter().any(Operand::is_figure);
        let value = match is_plane {
            true => self.hull_of_figures(operands, span)?,
            false => self.hull_of_solids(operands, span)?,
        };
        self.push(value, span);
        Ok(())
    }

    fn hull_of_figures(
        &mut self,
        operands: Vec<Operand>,
        span: &Range<usize>,
    ) -> Result<Value, SpannedError> {
        let mut regions = Vec::with_capacity(operands.len());
        for operand in operands {
            let Some(region) = operand.figure("for `HULL`, as another operand is one")? else {
                continue;
            };
            self.budget.count_edges(region.edge_count(), span)?;
            regions.push(region);
        }
        let hull = Region::hull(regions.iter().map(|region| &**region), span)?;
        Ok(Value::Figure(hull.map(Rc::new)))
    }

    fn hull_of_solids(
        &mut self,
        operands: Vec<Operand>,
        span: &Range<usize>,
    ) -> Result<Value, SpannedError> {
        let mut solids: Vec<SolidId> = Vec::new();
        for operand in operands {
            let solid = operand.solid("or a figure for `HULL`")?;
            let leaves = usize::try_from(self.builder.leaves(solid)).unwrap_or(usize::MAX);
            self.budget.count_edges(leaves, span)?;
            solids.push(solid);
        }
        match convex_hull(&mut self.builder, &solids, 0.0) {
            Ok(hull) => Ok(Value::Solid(hull.solid)),
            Err(error) => Err(construction_error(&error, span)),
        }
    }

    /// Makes a tuple of the last numbers.
    pub(super) fn tuple(
        &mut self,
        counts: &[usize],
        span: &Range<usize>,
    ) -> Result<(), SpannedError> {
        let mut operands = self.pop_many(counts.iter().sum()).into_iter();
        let mut groups = Vec::with_capacity(counts.len());
        for &count in counts {
            let group = operands.by_ref().take(count);
            let group = group.map(|operand| {
                let place = operand.span.clone();
                Ok(Spanned::new(operand.number("of a tuple")?, place))
            });
            groups.push(group.collect::<Result<Vec<Number>, SpannedError>>()?);
        }
        let groups = groups.into_boxed_slice();
        self.push(Value::Tuple(TupleValue { groups }), span);
        Ok(())
    }

    /// Appends the last value, a tuple, to the list before it.
    pub(super) fn append(&mut self, span: &Range<usize>) -> Result<(), SpannedError> {
        self.budget.count_edges(1, span)?;
        let operand = self.pop(span);
        let place = operand.span.clone();
        match operand.value {
            Value::Tuple(tuple) => {
                if let Some(list) = self.list_on_top() {
                    list.append(Spanned::new(tuple, place));
                }
                Ok(())
            }
            other => Err(SpannedError::input(
                place,
                other.describe(),
                "a tuple such as `(1, 2)`",
            )),
        }
    }

    /// Begins the next part of the last value, a list.
    pub(super) fn separate(&mut self) {
        if let Some(list) = self.list_on_top() {
            list.parts.push(Vec::new());
        }
    }

    /// Makes what a list describes.
    pub(super) fn outline(
        &mut self,
        outline: Outline,
        span: &Range<usize>,
    ) -> Result<(), SpannedError> {
        let Value::List(list) = self.pop(span).value else {
            return Ok(());
        };
        let value = match outline {
            Outline::Polygon => polygon(list, span)?,
            Outline::Polyhedron => self.polyhedron(list, span)?,
            Outline::ObliqueFrustum => {
                let frustum = oblique_frustum(list, span)?;
                Value::Solid(self.builder.primitive(frustum))
            }
            Outline::Ellipsoid => {
                let ellipsoid = ellipsoid(list, span)?;
                Value::Solid(self.builder.primitive(ellipsoid))
            }
        };
        self.push(value, span);
        Ok(())
    }

    fn polyhedron(&mut self, list: ListValue, span: &Range<usize>) -> Result<Value, SpannedError> {
        let parts = <[Vec<Spanned<TupleValue>>; 2]>::try_from(list.parts);
        let [points, faces] = parts.map_err(|parts| {
            let found = match parts.len() {
                1 => "points without faces".to_owned(),
                count => format!("{count} lists"),
            };
            let expected = "points, `;` and faces";
            SpannedError::input(span.clone(), found, expected)
        })?;
        let points: Vec<SpacePoint> = points.into_iter().map(point).collect::<Result<_, _>>()?;
        let faces = faces.into_iter().map(|tuple| face(tuple, points.len()));
        let faces: Vec<PolyhedronFace> = faces.collect::<Result<_, _>>()?;
        let made = Polyhedron::from_faces(&points, &faces)
            .map_err(|error| invalid_polyhedron(&error, span))?;
        if made.triangulated > 0 {
            self.remarks.add_triangulated(made.triangulated, span);
        }
        let polyhedron = Arc::new(made.polyhedron);
        let solid = self.builder.primitive(Primitive::Polyhedron { polyhedron });
        Ok(Value::Solid(solid))
    }
}

/// The three tuples of a list.
fn three_tuples(
    list: ListValue,
    expected: &'static str,
    span: &Range<usize>,
) -> Result<[Spanned<TupleValue>; 3], SpannedError> {
    let wrong = |found: String| SpannedError::input(span.clone(), found, expected);
    let [tuples] = <[Vec<Spanned<TupleValue>>; 1]>::try_from(list.parts)
        .map_err(|parts| wrong(format!("{} lists", parts.len())))?;
    <[Spanned<TupleValue>; 3]>::try_from(tuples)
        .map_err(|tuples| wrong(format!("{} tuples", tuples.len())))
}

/// An ellipsoid by its conjugate radii.
fn ellipsoid(list: ListValue, span: &Range<usize>) -> Result<Primitive, SpannedError> {
    let expected = "three conjugate radii `(x, y, z)`";
    let [x, y, z] = three_tuples(list, expected, span)?;
    Primitive::ellipsoid([point(x)?, point(y)?, point(z)?])
        .map_err(|error| bad_length(error, None, span.clone()))
}

/// An oblique frustum by its axes. The third may have the size of the top after its coordinates.
fn oblique_frustum(list: ListValue, span: &Range<usize>) -> Result<Primitive, SpannedError> {
    let expected = "three axes `(x, y, z)`; the third is the centre of the top, with its size after \
                    the coordinates unless it is 1";
    let [x, y, z] = three_tuples(list, expected, span)?;
    let (third, top) = match plain::<4>(&z) {
        Some([a, b, c, top]) => ([a, b, c], top),
        None => (point(z)?, Rational::ONE),
    };
    Primitive::oblique_frustum([point(x)?, point(y)?, third], top.clone())
        .map_err(|error| bad_length(error, Some(&top), span.clone()))
}

/// The value of a figure that was made.
fn figure_value(
    figure: Result<Figure, FigureError>,
    span: &Range<usize>,
) -> Result<Value, SpannedError> {
    let figure = figure.map_err(|error| bad_figure(&error, span))?;
    let region = Region::new(figure, span.clone());
    Ok(Value::Figure(Some(Rc::new(region))))
}

fn offset(given: &Given, span: &Range<usize>) -> Result<Value, SpannedError> {
    let joins = [OffsetJoin::Round, OffsetJoin::Miter, OffsetJoin::Chamfer];
    let ways = joins.into_iter().zip(1..);
    let mut ways = ways.filter_map(|(join, index)| Some((join, given.number(index)?)));
    let (Some((join, distance)), None) = (ways.next(), ways.next()) else {
        let found = "an offset without one distance";
        let expected = "one of `R`, `DELTA` and `CHAMFER`";
        return Err(SpannedError::input(span.clone(), found, expected));
    };
    let Some(region) = given.figure.as_ref().and_then(|known| known.value.as_ref()) else {
        return Ok(Value::Figure(None));
    };
    let offset = region.offset(&distance.value, join, span)?;
    Ok(Value::Figure(offset.map(Rc::new)))
}

/// A polygon, or a figure with arcs, of contours.
fn polygon(list: ListValue, span: &Range<usize>) -> Result<Value, SpannedError> {
    let contour = |tuples: Vec<Spanned<TupleValue>>| tuples.into_iter().map(corner).collect();
    let contours = list.parts.into_iter().map(contour);
    let contours: Vec<Vec<ContourCorner>> = contours.collect::<Result<_, SpannedError>>()?;
    figure_value(Figure::from_contours(&contours), span)
}

/// The error of a tuple with a wrong count of numbers.
fn wrong_tuple(tuple: &Spanned<TupleValue>, expected: &str) -> SpannedError {
    SpannedError::input(tuple.span.clone(), tuple.value.describe(), expected)
}

/// The numbers of a tuple without semicolons.
fn plain<const N: usize>(tuple: &Spanned<TupleValue>) -> Option<[Rational; N]> {
    let [group] = &tuple.value.groups[..] else {
        return None;
    };
    let group: &[Number; N] = group[..].try_into().ok()?;
    Some(group.each_ref().map(|number| number.value.clone()))
}

fn corner(tuple: Spanned<TupleValue>) -> Result<ContourCorner, SpannedError> {
    if let Some(point) = plain::<2>(&tuple) {
        return Ok(ContourCorner { point, arc: None });
    }
    let [x, y, cx, cy, r] = plain::<5>(&tuple).ok_or_else(|| {
        let expected = "a corner `(x, y)`, or `(x, y, cx, cy, r)` where an arc begins";
        wrong_tuple(&tuple, expected)
    })?;
    Ok(ContourCorner {
        point: [x, y],
        arc: Some(FigureArc::from_signed_radius([cx, cy], r)),
    })
}

fn point(tuple: Spanned<TupleValue>) -> Result<SpacePoint, SpannedError> {
    plain::<3>(&tuple).ok_or_else(|| wrong_tuple(&tuple, "a point `(x, y, z)`"))
}

/// A face, by the indices of its points; the loops of its holes follow after semicolons.
fn face(tuple: Spanned<TupleValue>, count: usize) -> Result<PolyhedronFace, SpannedError> {
    let index = |number: &Number| {
        let value = &number.value;
        let is_valid = value.is_int() && *value >= Rational::ZERO && *value < Rational::from(count);
        let index = value.numerator().try_into().ok().filter(|_| is_valid);
        index.ok_or_else(|| {
            let found = show(value).replacen("the value", "the number", 1);
            let expected = format!("the index of a point, from 0 to {}", count.max(1) - 1);
            SpannedError::input(number.span.clone(), found, expected)
        })
    };
    let groups = tuple.value.groups.iter();
    let loops = groups.map(|group| group.iter().map(index).collect());
    let loops: Vec<Vec<usize>> = loops.collect::<Result<_, SpannedError>>()?;
    Ok(PolyhedronFace { loops })
}
