//! `.padl`: a statement for each part that is used more than once, and one for the whole.

use std::collections::{BTreeMap, BTreeSet};

use premio_kernel::number::rational::Rational;

use super::number::quotient;
use super::turns::{AxisTurn, about_axes};
use super::{Language, Use, WriteError, indent, push, walk};
use crate::builder::{Builder, BuilderNode};
use crate::figure::{Figure, FigureEdge};
use crate::polyhedron::{Polyhedron, PolyhedronFace};
use crate::primitive::Primitive;
use crate::transform::TransformStep;
use crate::tree::Operation;

pub(super) fn write(builder: &Builder, top: Use) -> Result<String, WriteError> {
    let named = named(builder, &top);
    let mut padl = Padl::default();
    for (part, &name) in &named {
        push(&mut padl.text, format_args!("P{name} = "));
        let others = |other: &Use| named.get(other).copied().filter(|_| other != part);
        walk(builder, part.clone(), others, &mut padl)?;
        padl.text.push('\n');
    }
    padl.text.push_str("PART = ");
    walk(builder, top, |part| named.get(part).copied(), &mut padl)?;
    padl.text.push('\n');
    Ok(padl.text)
}

/// The operations that are used more than once, numbered such that their components have smaller
/// numbers.
fn named(builder: &Builder, top: &Use) -> BTreeMap<Use, usize> {
    let mut visited: BTreeSet<Use> = BTreeSet::new();
    let mut again: BTreeSet<Use> = BTreeSet::new();
    let mut ahead = vec![top.clone()];
    while let Some(part) = ahead.pop() {
        let part = part.resolved(builder).part;
        let BuilderNode::Operation { children, .. } = builder.draft(part.draft) else {
            continue;
        };
        if visited.contains(&part) {
            again.insert(part);
            continue;
        }
        ahead.extend(children.iter().map(|&child| part.with(child)));
        visited.insert(part);
    }
    again.into_iter().zip(1..).collect()
}

#[derive(Default)]
struct Padl {
    text: String,
    depth: usize,
}

impl Padl {
    fn place(&mut self, steps: &[TransformStep]) {
        let mut words = Vec::new();
        for step in steps {
            match step {
                TransformStep::Shift(offset) => {
                    let moved = offset.iter().zip(["MOVX", "MOVY", "MOVZ"]);
                    let moved = moved.filter(|(by, _)| !by.is_zero());
                    words.extend(moved.map(|(by, word)| format!("{word}={}", quotient(by))));
                }
                TransformStep::Turn { .. } | TransformStep::Quaternion(_) => {
                    let turns = about_axes(step).into_iter();
                    words.extend(turns.map(|AxisTurn { axis, degrees }| {
                        format!("{}={}", ["ROTX", "ROTY", "ROTZ"][axis], quotient(&degrees))
                    }));
                }
            }
        }
        if !words.is_empty() {
            push(&mut self.text, format_args!(" AT ({})", words.join(", ")));
        }
    }
}

impl Language for Padl {
    fn leaf(&mut self, primitive: &Primitive, steps: &[TransformStep]) {
        self.text.push_str(&call(primitive));
        self.place(steps);
    }

    fn name(&mut self, name: usize, steps: &[TransformStep]) {
        push(&mut self.text, format_args!("P{name}"));
        self.place(steps);
    }

    fn open(&mut self, _: Operation, _: &[TransformStep]) {
        self.depth += 1;
        push(&mut self.text, format_args!("(\n{}", indent(self.depth)));
    }

    fn between(&mut self, op: Operation) {
        let word = match op {
            Operation::Union => "UN",
            Operation::Intersection => "INT",
            Operation::Difference => "DIF",
        };
        push(
            &mut self.text,
            format_args!("\n{}{word} ", indent(self.depth)),
        );
    }

    fn close(&mut self, steps: &[TransformStep]) {
        self.depth -= 1;
        push(&mut self.text, format_args!("\n{})", indent(self.depth)));
        self.place(steps);
    }

    fn length(&self) -> usize {
        self.text.len()
    }
}

fn call(primitive: &Primitive) -> String {
    let with = |name: &str, arguments: &[(&str, &Rational)]| {
        let all = arguments.iter();
        let all: Vec<String> = all
            .map(|(key, x)| format!("{key}={}", quotient(x)))
            .collect();
        format!("{name}({})", all.join(", "))
    };
    match primitive {
        Primitive::Block { size: [x, y, z] } => with("BLO", &[("X", x), ("Y", y), ("Z", z)]),
        Primitive::Wedge { size: [x, y, z] } => with("WED", &[("X", x), ("Y", y), ("Z", z)]),
        Primitive::Cylinder { radius, height } => with("CYL", &[("R", radius), ("H", height)]),
        Primitive::Frustum { base, top, height } if top.is_zero() => {
            with("CON", &[("R", base), ("H", height)])
        }
        Primitive::Frustum { base, top, height } => {
            with("CON", &[("R", base), ("H", height), ("R2", top)])
        }
        Primitive::Sphere { radius } => with("SPH", &[("R", radius)]),
        Primitive::Torus { major, minor } => with("TOR", &[("RMAJ", major), ("RMIN", minor)]),
        Primitive::Prism {
            figure,
            height,
            top,
        } => {
            let top = match top.is_one() {
                true => String::new(),
                false => format!(", TOP={}", quotient(top)),
            };
            format!("PRI({}, H={}{top})", polygon(figure), quotient(height))
        }
        Primitive::Revolution { figure, angle } => {
            let angle = angle.as_ref().map_or(String::new(), |angle| {
                format!(", ANGLE={}", quotient(angle.degrees()))
            });
            format!("REV({}{angle})", polygon(figure))
        }
        Primitive::Polyhedron { polyhedron: of } => polyhedron(of),
        Primitive::ObliqueFrustum { frustum } => {
            let [x, y, z] = frustum.axes();
            let top = Some(frustum.top()).filter(|top| !top.is_one());
            let third = tuple(z.iter().chain(top));
            format!("OBL({}, {}, {third})", tuple(x), tuple(y))
        }
        Primitive::Ellipsoid { radii } => {
            let [x, y, z] = radii.vectors().each_ref().map(tuple);
            format!("ELL({x}, {y}, {z})")
        }
    }
}

/// Numbers in brackets.
fn tuple<'a>(numbers: impl IntoIterator<Item = &'a Rational>) -> String {
    let numbers: Vec<String> = numbers.into_iter().map(quotient).collect();
    format!("({})", numbers.join(", "))
}

/// A figure by its corners, with the circle of an arc at its start.
fn polygon(figure: &Figure) -> String {
    let corner = |edge: &FigureEdge| match &edge.arc {
        None => tuple(&edge.start),
        Some(arc) => {
            let radius = arc.signed_radius();
            tuple(edge.start.iter().chain(&arc.centre).chain([&radius]))
        }
    };
    let contour = |edges: &[FigureEdge]| {
        let corners: Vec<String> = edges.iter().map(corner).collect();
        corners.join(", ")
    };
    let contours: Vec<String> = figure.contours().map(contour).collect();
    format!("PGN({})", contours.join("; "))
}

/// A polyhedron by its points and the indices of its faces.
fn polyhedron(of: &Polyhedron) -> String {
    let corners = |corners: &Vec<usize>| {
        let corners: Vec<String> = corners.iter().map(usize::to_string).collect();
        corners.join(", ")
    };
    let face = |face: &PolyhedronFace| {
        let loops: Vec<String> = face.loops.iter().map(corners).collect();
        format!("({})", loops.join("; "))
    };
    let points: Vec<String> = of.points().iter().map(tuple).collect();
    let faces: Vec<String> = of.faces().iter().map(face).collect();
    format!("POLY({}; {})", points.join(", "), faces.join(", "))
}
