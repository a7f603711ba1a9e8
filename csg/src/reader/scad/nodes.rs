//! The meaning of OpenSCAD's nodes.

use std::ops::Range;

use premio_kernel::number::rational::Rational;

use super::super::error::SpannedError;
use super::super::lexer::Lexeme;
use super::super::notes::Notes;
use super::super::rigid_fit::{NotRigid, Placement, placement};
use super::arguments::{Argument, Arguments};
use super::extrusion::{self, Raise};
use super::shapes::{self, Shape};
use crate::builder::{Builder, SolidId};
use crate::tree::Operation;
use premio_text::escape::quote;

/// How the children of a block are combined.
pub(super) enum Kind {
    Union,
    Intersection,
    Difference,
    Placed(Box<Placement>),
}

impl Kind {
    pub(super) fn combine(self, builder: &mut Builder, children: &[SolidId]) -> SolidId {
        let op = match self {
            Self::Union | Self::Placed(_) => Operation::Union,
            Self::Intersection => Operation::Intersection,
            Self::Difference => Operation::Difference,
        };
        let part = builder.operation(op, children);
        let Self::Placed(placement) = self else {
            return part;
        };
        let part = if placement.mirrored {
            builder.mirrored_y(part)
        } else {
            part
        };
        builder.moved(part, placement.moves)
    }
}

/// The extrusion around a node, which determines what a plane figure becomes.
#[derive(Clone)]
pub(super) enum Around {
    Nothing,
    Raised(Box<Raise>),
    /// Revolved about an axis, with the placement in the plane so far.
    Revolved(Box<Placement>),
}

pub(super) enum Node {
    Shape(Box<Shape>),
    Block { kind: Kind, around: Around },
}

fn solid(shape: Shape) -> Node {
    Node::Shape(Box::new(shape))
}

/// The supported nodes.
const KNOWN: [&str; 15] = [
    "group",
    "union",
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
    let plane = !matches!(around, Around::Nothing);
    let block = |kind| {
        Ok(Node::Block {
            kind,
            around: around.clone(),
        })
    };
    match name {
        "group" | "union" | "render" | "color" => block(Kind::Union),
        "intersection" | "difference" if matches!(around, Around::Revolved(_)) => {
            Err(not_in_revolution(place, name))
        }
        "intersection" => block(Kind::Intersection),
        "difference" => block(Kind::Difference),
        "multmatrix" => matrix(arguments, around, notes),
        "linear_extrude" | "rotate_extrude" | "cube" | "sphere" | "cylinder" if plane => {
            let found = format!("{} inside an extrusion", quote(name));
            Err(SpannedError::input(place.span(), found, "a plane figure"))
        }
        "linear_extrude" => {
            let around = Around::Raised(Box::new(Raise::new(arguments)?));
            Ok(Node::Block {
                kind: Kind::Union,
                around,
            })
        }
        "rotate_extrude" => revolve(arguments, smooth),
        "cube" => shapes::cube(arguments).map(solid),
        "sphere" => shapes::sphere(arguments, smooth).map(solid),
        "cylinder" => shapes::cylinder(arguments, smooth).map(solid),
        "circle" | "square" | "polygon" => {
            figure(name, place, arguments, around, smooth).map(solid)
        }
        _ => Err(unknown(name, place)),
    }
}

fn figure(
    name: &str,
    place: Lexeme,
    arguments: &mut Arguments,
    around: &Around,
    smooth: bool,
) -> Result<Shape, SpannedError> {
    match (name, around) {
        (_, Around::Nothing) => {
            let found = format!("the plane figure {} outside an extrusion", quote(name));
            Err(SpannedError::input(place.span(), found, "a solid"))
        }
        ("circle", Around::Revolved(placing)) => {
            shapes::revolved_circle(arguments, placing.moves.motion(), smooth)
        }
        (_, Around::Revolved(_)) => Err(not_in_revolution(place, name)),
        ("circle", Around::Raised(raise)) => extrusion::circle(arguments, raise, smooth),
        ("square", Around::Raised(raise)) => extrusion::square(arguments, raise),
        (_, Around::Raised(raise)) => extrusion::polygon(arguments, raise),
    }
}

fn not_in_revolution(place: Lexeme, name: &str) -> SpannedError {
    let found = format!("{} inside `rotate_extrude`", quote(name));
    SpannedError::input(
        place.span(),
        found,
        "a circle away from the axis, which makes a torus",
    )
}

fn unknown(name: &str, place: Lexeme) -> SpannedError {
    let reason = match name {
        "hull" | "minkowski" | "offset" | "projection" | "resize" | "fill" | "roof" => {
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
    if let Some(angle) = arguments.find("angle") {
        let turn = Rational::from(360);
        let value = angle.number()?;
        if *value < turn && *value > -turn {
            return Err(angle.wrong("a whole turn of 360"));
        }
    }
    let around = Around::Revolved(Box::new(Placement::identity()));
    Ok(Node::Block {
        kind: Kind::Union,
        around,
    })
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
    let placement = placement(&[a, b, c], [x, y, z])
        .map_err(|reason| not_rigid(reason, argument.span.clone()))?;
    if placement.replaces() {
        notes.snapped(placement.residual, argument.span.clone());
    }
    match around {
        Around::Nothing => Ok(Node::Block {
            kind: Kind::Placed(Box::new(placement)),
            around: Around::Nothing,
        }),
        Around::Raised(_) => {
            check_plane(&placement, &argument.span)?;
            Ok(Node::Block {
                kind: Kind::Placed(Box::new(placement)),
                around: around.clone(),
            })
        }
        Around::Revolved(outer) => {
            check_plane(&placement, &argument.span)?;
            // A circle is its own mirror image, so only its centre matters.
            let around = Around::Revolved(Box::new(placement.then(outer)));
            Ok(Node::Block {
                kind: Kind::Union,
                around,
            })
        }
    }
}

/// Inside an extrusion only motions in the plane are supported.
fn check_plane(placement: &Placement, span: &Range<usize>) -> Result<(), SpannedError> {
    let motion = placement.moves.motion();
    let matrix = motion.rotation_matrix();
    if matrix[2][2].is_one() && motion.offset()[2].is_zero() {
        return Ok(());
    }
    let found = "a matrix that leaves the plane, inside an extrusion";
    Err(SpannedError::input(
        span.clone(),
        found,
        "a motion in the xy plane",
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
