//! `.json`: the tree itself.

use premio_kernel::number::rational::{Rational, whole};

use super::number::decimal;
use super::{Language, Use, WriteError, indent, push, walk};
use crate::builder::Builder;
use crate::figure::{Figure, FigureEdge};
use crate::polyhedron::PolyhedronFace;
use crate::primitive::Primitive;
use crate::transform::TransformStep;
use crate::tree::Operation;

pub(super) fn write(builder: &Builder, top: Option<Use>) -> Result<String, WriteError> {
    let mut json = Json::default();
    match top {
        Some(top) => walk(builder, top, |_| None, &mut json)?,
        None => json.text.push_str(r#"{"op":"union","children":[]}"#),
    }
    json.text.push('\n');
    Ok(json.text)
}

#[derive(Default)]
struct Json {
    text: String,
    depth: usize,
}

fn list(values: &[Rational]) -> String {
    let all: Vec<String> = values.iter().map(decimal).collect();
    format!("[{}]", all.join(","))
}

fn step(step: &TransformStep) -> String {
    match step {
        TransformStep::Shift(offset) => format!(r#"{{"translate":{}}}"#, list(offset)),
        TransformStep::Turn { axis, degrees } => {
            format!(r#"{{"rotate":[{},{}]}}"#, list(axis), decimal(degrees))
        }
        TransformStep::Quaternion(quaternion) => {
            format!(r#"{{"quaternion":{}}}"#, list(&whole(quaternion)))
        }
    }
}

impl Json {
    /// The transform, if there is one, and the end of the object.
    fn place(&mut self, steps: &[TransformStep]) {
        if !steps.is_empty() {
            let all: Vec<String> = steps.iter().map(step).collect();
            push(
                &mut self.text,
                format_args!(r#","transform":[{}]"#, all.join(",")),
            );
        }
        self.text.push('}');
    }
}

impl Language for Json {
    fn leaf(&mut self, primitive: &Primitive, steps: &[TransformStep]) {
        push(
            &mut self.text,
            format_args!(r#"{{"prim":{}"#, members(primitive)),
        );
        self.place(steps);
    }

    /// JSON has no names.
    fn name(&mut self, _: usize, _: &[TransformStep]) {}

    fn open(&mut self, op: Operation, _: &[TransformStep]) {
        let name = match op {
            Operation::Union => "union",
            Operation::Intersection => "intersection",
            Operation::Difference => "difference",
        };
        self.depth += 1;
        let blanks = indent(self.depth);
        push(
            &mut self.text,
            format_args!("{{\"op\":\"{name}\",\"children\":[\n{blanks}"),
        );
    }

    fn between(&mut self, _: Operation) {
        push(&mut self.text, format_args!(",\n{}", indent(self.depth)));
    }

    fn close(&mut self, steps: &[TransformStep]) {
        self.depth -= 1;
        push(&mut self.text, format_args!("\n{}]", indent(self.depth)));
        self.place(steps);
    }

    fn length(&self) -> usize {
        self.text.len()
    }
}

/// The contours of a figure: lists of corners `[x, y]`, or `[x, y, cx, cy, r]` where an arc about
/// (cx, cy) begins, with a negative radius if it runs clockwise.
fn figure(figure: &Figure) -> String {
    let corner = |edge: &FigureEdge| {
        let mut numbers = edge.start.to_vec();
        if let Some(arc) = &edge.arc {
            numbers.extend(arc.centre.clone());
            numbers.push(arc.signed_radius());
        }
        list(&numbers)
    };
    let contour = |edges: &[FigureEdge]| {
        let corners: Vec<String> = edges.iter().map(corner).collect();
        format!("[{}]", corners.join(","))
    };
    let contours: Vec<String> = figure.contours().map(contour).collect();
    format!("[{}]", contours.join(","))
}

fn members(primitive: &Primitive) -> String {
    match primitive {
        Primitive::Block { size } => format!(r#""block","size":{}"#, list(size)),
        Primitive::Wedge { size } => format!(r#""wedge","size":{}"#, list(size)),
        Primitive::Cylinder { radius, height } => {
            let [r, h] = [radius, height].map(decimal);
            format!(r#""cylinder","r":{r},"h":{h}"#)
        }
        Primitive::Frustum { base, top, height } if top.is_zero() => {
            let [r, h] = [base, height].map(decimal);
            format!(r#""cone","r":{r},"h":{h}"#)
        }
        Primitive::Frustum { base, top, height } => {
            let [r1, r2, h] = [base, top, height].map(decimal);
            format!(r#""frustum","r1":{r1},"r2":{r2},"h":{h}"#)
        }
        Primitive::Sphere { radius } => format!(r#""sphere","r":{}"#, decimal(radius)),
        Primitive::Torus { major, minor } => {
            let [major, minor] = [major, minor].map(decimal);
            format!(r#""torus","R":{major},"r":{minor}"#)
        }
        Primitive::Prism {
            figure: of,
            height,
            top,
        } => {
            let top = match top.is_one() {
                true => String::new(),
                false => format!(r#","top":{}"#, decimal(top)),
            };
            format!(
                r#""prism","figure":{},"h":{}{top}"#,
                figure(of),
                decimal(height)
            )
        }
        Primitive::Revolution { figure: of, angle } => {
            let angle = angle.as_ref().map_or(String::new(), |angle| {
                format!(r#","angle":{}"#, decimal(angle.degrees()))
            });
            format!(r#""revolution","figure":{}{angle}"#, figure(of))
        }
        Primitive::Polyhedron { polyhedron } => {
            let points: Vec<String> = polyhedron.points().iter().map(|p| list(p)).collect();
            let corners = |corners: &Vec<usize>| {
                let corners: Vec<String> = corners.iter().map(usize::to_string).collect();
                format!("[{}]", corners.join(","))
            };
            // A face with holes is a list of loops.
            let face = |face: &PolyhedronFace| {
                let loops: Vec<String> = face.loops.iter().map(corners).collect();
                match &loops[..] {
                    [outline] => outline.clone(),
                    _ => format!("[{}]", loops.join(",")),
                }
            };
            let faces: Vec<String> = polyhedron.faces().iter().map(face).collect();
            format!(
                r#""polyhedron","points":[{}],"faces":[{}]"#,
                points.join(","),
                faces.join(",")
            )
        }
        Primitive::ObliqueFrustum { frustum } => {
            let [x, y, z] = frustum.axes().each_ref().map(|axis| list(axis));
            let top = match frustum.top().is_one() {
                true => String::new(),
                false => format!(r#","top":{}"#, decimal(frustum.top())),
            };
            format!(r#""oblique_frustum","x":{x},"y":{y},"z":{z}{top}"#)
        }
        Primitive::Ellipsoid { radii } => {
            let [x, y, z] = radii.vectors().each_ref().map(|radius| list(radius));
            format!(r#""ellipsoid","x":{x},"y":{y},"z":{z}"#)
        }
    }
}
