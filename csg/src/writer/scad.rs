//! `.csg`: OpenSCAD's flattened form, which OpenSCAD can read.

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::to_f64;

use super::number::decimal;
use super::{Language, Use, WriteError, indent, push, walk};
use crate::builder::Builder;
use crate::figure::{Figure, FigureEdge};
use crate::polyhedron::{Polyhedron, PolyhedronFace, SpacePoint};
use crate::primitive::Primitive;
use crate::transform::TransformStep;
use crate::tree::Operation;

pub(super) fn write(builder: &Builder, top: Option<Use>) -> Result<String, WriteError> {
    let mut scad = Scad::default();
    match top {
        Some(top) => walk(builder, top, |_| None, &mut scad)?,
        None => scad.text.push_str("group();"),
    }
    scad.text.push('\n');
    Ok(scad.text)
}

#[derive(Default)]
struct Scad {
    text: String,
    depth: usize,
}

/// The arguments with which OpenSCAD writes a smooth surface.
const SMOOTH: &str = "$fn = 0, $fa = 12, $fs = 2";

impl Scad {
    /// Opens a matrix for each motion, the last of them outermost. A matrix of a single rotation
    /// can be identified by its angle.
    fn begin(&mut self, steps: &[TransformStep]) {
        for motion in motions(steps).iter().rev() {
            push(
                &mut self.text,
                format_args!("multmatrix({}) {{ ", matrix(motion)),
            );
        }
    }

    fn end(&mut self, steps: &[TransformStep]) {
        self.text.push_str(&" }".repeat(motions(steps).len()));
    }
}

/// The motions that are each written as a matrix, in order: a rotation with the translations after
/// it, or a sequence of quarter turns and translations.
fn motions(steps: &[TransformStep]) -> Vec<Motion> {
    let mut motions: Vec<(Motion, bool)> = Vec::new();
    for step in steps {
        // A step was valid when it was read, so it has a motion.
        let motion = step.motion().unwrap_or_default();
        let is_shift = matches!(step, TransformStep::Shift(_));
        match motions.last_mut() {
            Some((last, is_simple)) if is_shift || (*is_simple && step.is_simple()) => {
                *last = last.then(&motion);
            }
            _ => motions.push((motion, step.is_simple())),
        }
    }
    motions.into_iter().map(|(motion, _)| motion).collect()
}

fn matrix(motion: &Motion) -> String {
    let turn = motion.rotation_matrix();
    let row = |i: usize| {
        // An entry without a short decimal is rounded to an f64; the reader finds the nearest
        // rotation.
        let [a, b, c] = turn[i].each_ref().map(to_f64);
        format!("[{a}, {b}, {c}, {}]", decimal(&motion.offset()[i]))
    };
    format!("[{}, {}, {}, [0, 0, 0, 1]]", row(0), row(1), row(2))
}

impl Language for Scad {
    fn leaf(&mut self, primitive: &Primitive, steps: &[TransformStep]) {
        self.begin(steps);
        self.text.push_str(&node(primitive));
        self.end(steps);
    }

    /// Nothing has a name here.
    fn name(&mut self, _: usize, _: &[TransformStep]) {}

    fn open(&mut self, op: Operation, steps: &[TransformStep]) {
        self.begin(steps);
        let name = match op {
            Operation::Union => "union",
            Operation::Intersection => "intersection",
            Operation::Difference => "difference",
        };
        self.depth += 1;
        push(
            &mut self.text,
            format_args!("{name}() {{\n{}", indent(self.depth)),
        );
    }

    fn between(&mut self, _: Operation) {
        push(&mut self.text, format_args!("\n{}", indent(self.depth)));
    }

    fn close(&mut self, steps: &[TransformStep]) {
        self.depth -= 1;
        push(&mut self.text, format_args!("\n{}}}", indent(self.depth)));
        self.end(steps);
    }

    fn length(&self) -> usize {
        self.text.len()
    }
}

/// The polygon of a figure, by points and paths.
fn polygon(figure: &Figure) -> String {
    let corner = |edge: &FigureEdge| {
        let [x, y] = edge.start.each_ref().map(decimal);
        format!("[{x}, {y}]")
    };
    let points: Vec<String> = figure.edges().iter().map(corner).collect();
    let mut first = 0;
    let paths = figure.contours().map(|contour| {
        let path: Vec<String> = (first..first + contour.len())
            .map(|i| i.to_string())
            .collect();
        first += contour.len();
        format!("[{}]", path.join(", "))
    });
    let paths: Vec<String> = paths.collect();
    format!(
        "polygon(points = [{}], paths = [{}]);",
        points.join(", "),
        paths.join(", ")
    )
}

/// OpenSCAD's faces run clockwise as seen from the outside.
fn polyhedron(polyhedron: &Polyhedron) -> String {
    let point = |p: &SpacePoint| {
        let [x, y, z] = p.each_ref().map(decimal);
        format!("[{x}, {y}, {z}]")
    };
    let face = |face: &PolyhedronFace| {
        let corners: Vec<String> = face.corners().map(|i| i.to_string()).collect();
        let backwards: Vec<String> = corners.into_iter().rev().collect();
        format!("[{}]", backwards.join(", "))
    };
    let points: Vec<String> = polyhedron.points().iter().map(point).collect();
    let faces: Vec<String> = polyhedron.faces().iter().map(face).collect();
    format!(
        "polyhedron(points = [{}], faces = [{}], convexity = 1);",
        points.join(", "),
        faces.join(", ")
    )
}

fn node(primitive: &Primitive) -> String {
    match primitive {
        Primitive::Block { size } => {
            let [x, y, z] = size.each_ref().map(decimal);
            format!("cube(size = [{x}, {y}, {z}], center = false);")
        }
        Primitive::Wedge { size } => {
            // Extruded along z from a triangle in x and y, then rotated: z becomes -y and y becomes
            // z.
            let [x, y, z] = size.each_ref().map(decimal);
            format!(
                "multmatrix([[1, 0, 0, 0], [0, 0, -1, {y}], [0, 1, 0, 0], [0, 0, 0, 1]]) {{ \
                 linear_extrude(height = {y}, center = false) {{ \
                 polygon(points = [[0, 0], [{x}, 0], [0, {z}]]); }} }}"
            )
        }
        Primitive::Cylinder { radius, height } => {
            let [r, h] = [radius, height].map(decimal);
            format!("cylinder({SMOOTH}, h = {h}, r1 = {r}, r2 = {r}, center = false);")
        }
        Primitive::Frustum { base, top, height } => {
            let [r1, r2, h] = [base, top, height].map(decimal);
            format!("cylinder({SMOOTH}, h = {h}, r1 = {r1}, r2 = {r2}, center = false);")
        }
        Primitive::Sphere { radius } => format!("sphere({SMOOTH}, r = {});", decimal(radius)),
        Primitive::Torus { major, minor } => {
            let disc = format!(
                "multmatrix([[1, 0, 0, {}], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {{ \
                 circle({SMOOTH}, r = {}); }}",
                decimal(major),
                decimal(minor)
            );
            // OpenSCAD revolves no figure that crosses the axis.
            let kept = match minor > major {
                true => format!(
                    "intersection() {{ {disc} \
                     multmatrix([[1, 0, 0, 0], [0, 1, 0, {}], [0, 0, 1, 0], [0, 0, 0, 1]]) {{ \
                     square(size = [{}, {}], center = false); }} }}",
                    decimal(&-minor),
                    decimal(&(major + minor)),
                    decimal(&(minor + minor))
                ),
                false => disc,
            };
            format!("rotate_extrude(angle = 360, {SMOOTH}) {{ {kept} }}")
        }
        Primitive::Prism {
            figure,
            height,
            top,
        } => {
            let (height, top) = (decimal(height), decimal(top));
            format!(
                "linear_extrude(height = {height}, center = false, scale = [{top}, {top}]) {{ {} }}",
                polygon(figure)
            )
        }
        Primitive::Revolution { figure, angle } => {
            let angle = angle
                .as_ref()
                .map_or("360".to_owned(), |a| decimal(a.degrees()));
            format!(
                "rotate_extrude(angle = {angle}, {SMOOTH}) {{ {} }}",
                polygon(figure)
            )
        }
        Primitive::Polyhedron { polyhedron: of } => polyhedron(of),
        Primitive::ObliqueFrustum { frustum } => {
            let of = format!(
                "cylinder({SMOOTH}, h = 1, r1 = 1, r2 = {}, center = false);",
                decimal(frustum.top())
            );
            mapped(frustum.axes(), &of)
        }
        Primitive::Ellipsoid { radii } => {
            mapped(radii.vectors(), &format!("sphere({SMOOTH}, r = 1);"))
        }
    }
}

/// A shape of which the coordinate axes are mapped to these.
fn mapped(axes: &[SpacePoint; 3], shape: &str) -> String {
    let row = |i: usize| {
        let [x, y, z] = [0, 1, 2].map(|k| decimal(&axes[k][i]));
        format!("[{x}, {y}, {z}, 0]")
    };
    let [x, y, z] = [0, 1, 2].map(row);
    format!("multmatrix([{x}, {y}, {z}, [0, 0, 0, 1]]) {{ {shape} }}")
}
