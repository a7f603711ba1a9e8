//! The meaning of OpenSCAD's nodes.

use std::ops::Range;

use premio_kernel::motion::RationalMatrix;
use premio_kernel::number::rational::{Rational, exact_sqrt, from_decimal, to_f64};

use super::super::error::SpannedError;
use super::super::lexer::Lexeme;
use super::super::notes::Notes;
use super::super::rigid_fit::{NotRigid, Placement, placement};
use super::arguments::{Argument, Arguments};
use super::extrusion::{self, Raise};
use super::figures;
use super::hull::{Around, HullFrame, HullOperand};
use super::measures::{Shape, sides};
use super::plane::{Extrusion, Sweep};
use super::shapes;
use crate::builder::{Builder, SolidId};
use crate::figure::PlaneMap;
use crate::primitive::RevolutionAngle;
use crate::tree::Operation;
use premio_text::escape::quote;

/// How the children of a block are combined.
pub(super) enum Kind {
    Union,
    Intersection,
    Difference,
    Placed(Box<Placement>),
    /// Scaled about the origin, and then placed.
    Scaled(Rational, Box<Placement>),
    /// The convex hull of its operands.
    Hull,
}

impl Kind {
    pub(super) fn combine(self, builder: &mut Builder, children: &[SolidId]) -> SolidId {
        let op = match self {
            Self::Union | Self::Placed(_) | Self::Scaled(..) | Self::Hull => Operation::Union,
            Self::Intersection => Operation::Intersection,
            Self::Difference => Operation::Difference,
        };
        let part = builder.operation(op, children);
        let (part, placement) = match self {
            Self::Placed(placement) => (part, placement),
            Self::Scaled(factor, placement) => (builder.scaled(part, factor), placement),
            Self::Union | Self::Intersection | Self::Difference | Self::Hull => return part,
        };
        let part = if placement.mirrored {
            builder.mirrored_y(part)
        } else {
            part
        };
        builder.moved(part, placement.moves)
    }
}

pub(super) enum Node {
    Shape(Box<Shape>),
    /// An operand of the hull around the node.
    Operand(Option<HullOperand>),
    Block {
        kind: Kind,
        around: Around,
    },
}

fn solid(shape: Shape) -> Node {
    Node::Shape(Box::new(shape))
}

/// The supported nodes.
const KNOWN: [&str; 16] = [
    "group",
    "union",
    "hull",
    "difference",
    "intersection",
    "render",
    "color",
    "multmatrix",
    "cube",
    "sphere",
    "cylinder",
    "linear_extrude",
    "rotate_extrude",
    "circle",
    "square",
    "polygon",
];

/// The meaning of a node inside the given extrusion.
pub(super) fn node(
    name: &str,
    place: Lexeme,
    arguments: &mut Arguments,
    around: &Around,
    smooth: bool,
    notes: &mut Notes,
) -> Result<Node, SpannedError> {
    let plane = around.is_plane();
    let block = |kind| {
        Ok(Node::Block {
            kind,
            around: around.clone(),
        })
    };
    match name {
        "group" | "union" | "render" | "color" => block(Kind::Union),
        "intersection" | "difference" | "linear_extrude" | "rotate_extrude"
            if matches!(around, Around::Hull(_)) =>
        {
            let found = format!("{} inside `hull`", quote(name));
            Err(SpannedError::input(
                place.span(),
                found,
                "a shape without operations",
            ))
        }
        "hull" => Ok(hull(around)),
        "intersection" => Ok(combined(Kind::Intersection, around)),
        "difference" => Ok(combined(Kind::Difference, around)),
        "multmatrix" => matrix(arguments, around, notes),
        "linear_extrude" | "rotate_extrude" | "cube" | "sphere" | "cylinder" if plane => {
            let found = format!("{} inside an extrusion", quote(name));
            Err(SpannedError::input(place.span(), found, "a plane figure"))
        }
        "linear_extrude" => {
            let raise = Raise::new(arguments)?;
            Ok(extruded(Sweep::Raised(raise)))
        }
        "rotate_extrude" => revolve(arguments, smooth),
        "cube" | "sphere" | "cylinder" => {
            let shape = match name {
                "cube" => shapes::cube(arguments)?,
                "sphere" => shapes::sphere(arguments, smooth)?,
                _ => shapes::cylinder(arguments, smooth)?,
            };
            match around {
                Around::Hull(hull) => Ok(Node::Operand(hull.solid(&shape, &arguments.span)?)),
                _ => Ok(solid(shape)),
            }
        }
        "circle" | "square" | "polygon" => {
            if let Around::Hull(hull) = around
                && plane
            {
                let figure = figures::figure(name, arguments, smooth)?;
                let operand = figure.map(|figure| hull.figure(&figure, &arguments.span));
                return Ok(Node::Operand(operand.transpose()?.flatten()));
            }
            figure(name, place, arguments, around, smooth).map(solid)
        }
        _ => Err(unknown(name, place)),
    }
}

/// The block of a hull. A hull inside a hull adds nothing to a union.
fn hull(around: &Around) -> Node {
    match around {
        Around::Hull(_) => Node::Block {
            kind: Kind::Union,
            around: around.clone(),
        },
        _ => Node::Block {
            kind: Kind::Hull,
            around: Around::Hull(Box::new(HullFrame::new(around.clone()))),
        },
    }
}

/// The block of an operation that removes material.
fn combined(kind: Kind, around: &Around) -> Node {
    let mut around = around.clone();
    if let Around::Extruded(extrusion) = &mut around {
        extrusion.is_combined = true;
    }
    Node::Block { kind, around }
}

/// The block of an extrusion.
fn extruded(sweep: Sweep) -> Node {
    Node::Block {
        kind: Kind::Union,
        around: Around::Extruded(Box::new(Extrusion::new(sweep))),
    }
}

fn figure(
    name: &str,
    place: Lexeme,
    arguments: &mut Arguments,
    around: &Around,
    smooth: bool,
) -> Result<Shape, SpannedError> {
    let Around::Extruded(extrusion) = around else {
        let found = format!("the plane figure {} outside an extrusion", quote(name));
        return Err(SpannedError::input(place.span(), found, "a solid"));
    };
    if let Some(shape) = primitive(name, arguments, extrusion, smooth)? {
        return Ok(shape);
    }
    let figure = figures::figure(name, arguments, smooth)?;
    figure.map_or(Ok(None), |figure| extrusion.solid(&figure, &arguments.span))
}

/// The primitive that is an extruded figure, if there is one.
fn primitive(
    name: &str,
    arguments: &mut Arguments,
    extrusion: &Extrusion,
    smooth: bool,
) -> Result<Option<Shape>, SpannedError> {
    let is_round = name == "circle" && sides(arguments, smooth)?.is_none();
    match &extrusion.sweep {
        Sweep::Raised(raise) if is_round && extrusion.map.is_identity() => {
            extrusion::circle(arguments, raise).map(Some)
        }
        Sweep::Raised(raise) if extrusion.is_straight() => match name {
            "square" => extrusion::square(arguments, raise).map(Some),
            "polygon" => extrusion::triangle(arguments, raise),
            _ => Ok(None),
        },
        Sweep::Revolved(None) if is_round && extrusion.map.is_rigid() => {
            arguments.bind(&["r", "d"])?;
            shapes::ring(arguments, &extrusion.map)
        }
        _ => Ok(None),
    }
}

fn unknown(name: &str, place: Lexeme) -> SpannedError {
    let reason = match name {
        "minkowski" | "offset" | "projection" | "resize" | "fill" | "roof" => {
            "it is not a regularised set operation or a rigid motion"
        }
        "import" | "surface" | "polyhedron" | "text" => "it is not one of the primitives",
        "translate" | "rotate" | "mirror" | "scale" | "for" | "if" | "module" => {
            "this is not flattened: write the file with `openscad -o part.csg part.scad`"
        }
        _ => {
            let found = format!("the unknown node {}", quote(name));
            let fault = SpannedError::input(place.span(), found, "a node that can be read");
            return fault.suggest(name, KNOWN);
        }
    };
    let found = format!("the node {}", quote(name));
    SpannedError::input(place.span(), found, "a node that can be read").help(reason)
}

fn revolve(arguments: &mut Arguments, smooth: bool) -> Result<Node, SpannedError> {
    arguments.bind(&["angle", "start"])?;
    shapes::check_smooth(arguments, smooth)?;
    if arguments
        .find("start")
        .is_some_and(|start| start.number().is_ok_and(|x| !x.is_zero()))
    {
        return Err(arguments.require("start")?.wrong("a `start` of 0"));
    }
    let turn = Rational::from(360);
    let sweep = match arguments.find("angle") {
        None => None,
        Some(angle) if *angle.number()? >= turn || *angle.number()? <= -&turn => None,
        Some(angle) => {
            let made = RevolutionAngle::new(angle.number()?.clone());
            Some(made.ok_or_else(|| angle.wrong("an angle greater than 0"))?)
        }
    };
    Ok(extruded(Sweep::Revolved(sweep)))
}

/// The rows of a 4 by 4 matrix.
fn rows(argument: &Argument) -> Result<[[Rational; 4]; 4], SpannedError> {
    let mut matrix: [[Rational; 4]; 4] = Default::default();
    let rows: &[Argument; 4] = argument.list("a matrix of four rows")?;
    for (row, argument) in matrix.iter_mut().zip(rows) {
        let entries: &[Argument; 4] = argument.list("a row of four numbers")?;
        for (entry, argument) in row.iter_mut().zip(entries) {
            *entry = argument.number()?.clone();
        }
    }
    let last = [0, 0, 0, 1].map(Rational::from);
    if matrix[3] != last {
        return Err(rows[3].wrong("the last row [0, 0, 0, 1] of a rigid motion"));
    }
    Ok(matrix)
}

fn matrix(
    arguments: &mut Arguments,
    around: &Around,
    notes: &mut Notes,
) -> Result<Node, SpannedError> {
    arguments.bind(&["m"])?;
    let argument = arguments.require("m")?;
    let [a, b, c, _] = rows(argument)?;
    let split = |[x, y, z, t]: [Rational; 4]| ([x, y, z], t);
    let ((a, x), (b, y), (c, z)) = (split(a), split(b), split(c));
    let (linear, offset) = ([a, b, c], [x, y, z]);
    let found = placement(&linear, offset.clone());
    if let Ok(placement) = &found
        && placement.replaces()
    {
        notes.snapped(placement.residual, argument.span.clone());
    }
    match around {
        Around::Nothing => Ok(Node::Block {
            kind: solid_kind(found, &linear, offset, argument)?,
            around: Around::Nothing,
        }),
        Around::Hull(hull) => {
            let upright = [&linear[0][2], &linear[1][2], &linear[2][0], &linear[2][1]];
            if hull.is_plane() || !upright.iter().all(|x| x.is_zero()) || !linear[2][2].is_one() {
                check_plane(&linear, &offset, &argument.span)?;
            }
            let inner = match found {
                Ok(placement) => plane_map(&placement),
                Err(_) => written_map(&linear, &offset),
            };
            let hull = HullFrame {
                map: inner.then(&hull.map),
                lift: &hull.lift + &offset[2],
                ..(**hull).clone()
            };
            Ok(Node::Block {
                kind: Kind::Union,
                around: Around::Hull(Box::new(hull)),
            })
        }
        Around::Extruded(extrusion) => {
            check_plane(&linear, &offset, &argument.span)?;
            let inner = match found {
                Ok(placement) if extrusion.is_straight() && is_upright(&placement) => {
                    return Ok(Node::Block {
                        kind: Kind::Placed(Box::new(placement)),
                        around: around.clone(),
                    });
                }
                Ok(placement) => plane_map(&placement),
                Err(_) => written_map(&linear, &offset),
            };
            let extrusion = Extrusion {
                map: inner.then(&extrusion.map),
                ..(**extrusion).clone()
            };
            Ok(Node::Block {
                kind: Kind::Union,
                around: Around::Extruded(Box::new(extrusion)),
            })
        }
    }
}

/// The placement of solids that a matrix stands for, perhaps after a uniform scale.
fn solid_kind(
    found: Result<Placement, NotRigid>,
    linear: &RationalMatrix,
    offset: [Rational; 3],
    argument: &Argument,
) -> Result<Kind, SpannedError> {
    let reason = match found {
        Ok(placement) => return Ok(Kind::Placed(Box::new(placement))),
        Err(reason) => reason,
    };
    let refused = || not_rigid(reason, argument.span.clone());
    let square = linear.iter().map(|row| &row[0] * &row[0]);
    let square = square.fold(Rational::ZERO, |sum, x| sum + x);
    let factor = exact_sqrt(&square).or_else(|| rounded_root(&square));
    let factor = factor
        .filter(|factor| !factor.is_zero())
        .ok_or_else(refused)?;
    let unscaled = linear
        .each_ref()
        .map(|row| row.each_ref().map(|x| x / &factor));
    let placement = placement(&unscaled, offset).map_err(|_| refused())?;
    Ok(Kind::Scaled(factor, Box::new(placement)))
}

/// The square root rounded to the six digits that OpenSCAD writes.
fn rounded_root(square: &Rational) -> Option<Rational> {
    let root = to_f64(square).sqrt();
    from_decimal(&format!("{root:.5e}")).ok()
}

/// Whether a placement keeps the upper side of the plane.
fn is_upright(placement: &Placement) -> bool {
    placement.moves.motion().rotation_matrix()[2][2].is_one()
}

/// The map of the plane of a rigid placement in it.
fn plane_map(placement: &Placement) -> PlaneMap {
    let motion = placement.moves.motion();
    let [[a, b, _], [c, d, _], _] = motion.rotation_matrix();
    let [x, y, _] = motion.offset().clone();
    let matrix = match placement.mirrored {
        true => [[a, -b], [c, -d]],
        false => [[a, b], [c, d]],
    };
    PlaneMap {
        matrix,
        offset: [x, y],
    }
}

/// The map of the plane that a matrix writes.
fn written_map([a, b, _]: &RationalMatrix, [x, y, _]: &[Rational; 3]) -> PlaneMap {
    PlaneMap {
        matrix: [a, b].map(|row| [row[0].clone(), row[1].clone()]),
        offset: [x.clone(), y.clone()],
    }
}

/// Inside an extrusion only maps of the plane are supported.
fn check_plane(
    [a, b, c]: &RationalMatrix,
    offset: &[Rational; 3],
    span: &Range<usize>,
) -> Result<(), SpannedError> {
    let beyond = [&a[2], &b[2], &c[0], &c[1], &offset[2]];
    if beyond.iter().all(|x| x.is_zero()) {
        return Ok(());
    }
    let found = "a matrix that leaves the plane, inside an extrusion";
    Err(SpannedError::input(
        span.clone(),
        found,
        "a map of the xy plane",
    ))
}

fn not_rigid(reason: NotRigid, span: Range<usize>) -> SpannedError {
    let expected = "a rigid motion, perhaps mirrored";
    match reason {
        NotRigid::Scaled(factor) => {
            let found = format!("a matrix that scales by {factor:.6}");
            SpannedError::input(span, found, expected)
                .help("give the primitives their final sizes in place of a scale")
        }
        NotRigid::Distorted => {
            SpannedError::input(span, "a matrix that changes lengths or angles", expected)
        }
    }
}
