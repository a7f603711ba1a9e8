//! Models as `.csg` with figures, sweeps, hulls and Minkowski sums, as OpenSCAD flattens them.

use super::figure::{CircleForm, ModelFigure, ModelSweep, OffsetCorner, SweepMotion};
use super::model::{
    ModelAxis, ModelConstruction, ModelNode, ModelNodeKind, ModelOperation, ModelPrimitive,
    ModelStep, PartModel,
};
use std::fmt::{Display, Write};

/// The text of a model.
///
/// Matrices have all digits of the f64.
pub(super) fn text(model: &PartModel) -> String {
    let mut texts: Vec<String> = Vec::with_capacity(model.nodes().len());
    for node in model.nodes() {
        let text = of_node(node, &texts);
        texts.push(text);
    }
    texts.pop().unwrap_or_default()
}

/// The text of a node, with the texts of all earlier nodes.
fn of_node(node: &ModelNode, earlier: &[String]) -> String {
    let operands = |children: &[usize]| -> String {
        let texts = children.iter().map(|&child| earlier[child].as_str());
        texts.collect()
    };
    let text = match &node.kind {
        ModelNodeKind::Leaf(primitive) => of_primitive(primitive),
        ModelNodeKind::Sweep(sweep) => of_sweep(sweep),
        ModelNodeKind::Operation(op, children) => block(operation(*op), "", &operands(children)),
        ModelNodeKind::Construction(construction, children) => {
            let name = match construction {
                ModelConstruction::Hull => "hull",
                ModelConstruction::Minkowski => "minkowski",
            };
            block(name, "", &operands(children))
        }
    };
    node.steps
        .iter()
        .fold(text, |text, step| moved(step, &text))
}

/// A module with operands.
fn block(name: &str, arguments: &str, operands: &str) -> String {
    let mut text = format!("{name}({arguments}) {{\n");
    for line in operands.lines() {
        let _ = writeln!(text, "\t{line}");
    }
    text + "}\n"
}

fn operation(op: ModelOperation) -> &'static str {
    match op {
        ModelOperation::Union => "union",
        ModelOperation::Intersection => "intersection",
        ModelOperation::Difference => "difference",
    }
}

/// A matrix that maps the coordinate axes to these.
fn matrix(axes: [[f64; 3]; 3]) -> String {
    let row = |i: usize| format!("[{}, {}, {}, 0]", axes[0][i], axes[1][i], axes[2][i]);
    format!("[{}, {}, {}, [0, 0, 0, 1]]", row(0), row(1), row(2))
}

fn of_primitive(primitive: &ModelPrimitive) -> String {
    let extrusion = |corners: Vec<[f64; 2]>, h| {
        of_sweep(&ModelSweep {
            figure: ModelFigure::Polygon(corners),
            motion: SweepMotion::Extrusion {
                h,
                scale: 1.0,
                is_centred: false,
            },
        })
    };
    let frustum = |r1, r2, h| {
        let round = circles(CircleForm::Circle);
        format!("cylinder({round}, h = {h}, r1 = {r1}, r2 = {r2}, center = false);\n")
    };
    match *primitive {
        ModelPrimitive::Block(size) => format!("cube(size = {}, center = false);\n", list(&size)),
        ModelPrimitive::Wedge([x, y, z]) => {
            // The triangle's z is the extrusion's y, and the extrusion runs against y.
            let upright = ModelStep::Turn(ModelAxis::X, 90.0);
            let triangle = extrusion(vec![[0.0, 0.0], [x, 0.0], [0.0, z]], y);
            let steps = [upright, ModelStep::Shift([0.0, y, 0.0])];
            steps.iter().fold(triangle, |text, step| moved(step, &text))
        }
        ModelPrimitive::Cylinder { r, h } => frustum(r, r, h),
        ModelPrimitive::Frustum { r1, r2, h } => frustum(r1, r2, h),
        ModelPrimitive::ObliqueFrustum { axes, top } => {
            block("multmatrix", &matrix(axes), &frustum(1.0, top, 1.0))
        }
        ModelPrimitive::Ellipsoid(radii) => {
            let ball = format!("sphere({}, r = 1);\n", circles(CircleForm::Circle));
            block("multmatrix", &matrix(radii), &ball)
        }
        ModelPrimitive::Sphere(r) => format!("sphere({}, r = {r});\n", circles(CircleForm::Circle)),
        ModelPrimitive::Torus { major, minor } => {
            let disc = ModelFigure::Disc {
                r: minor,
                form: CircleForm::Circle,
            };
            of_sweep(&ModelSweep {
                figure: ModelFigure::Moved {
                    turn: 0.0,
                    shift: [major, 0.0],
                    of: Box::new(disc),
                },
                motion: SweepMotion::Revolution {
                    degrees: 360.0,
                    form: CircleForm::Circle,
                },
            })
        }
    }
}

fn of_sweep(sweep: &ModelSweep) -> String {
    let figure = of_figure(&sweep.figure);
    match sweep.motion {
        SweepMotion::Extrusion {
            h,
            scale,
            is_centred,
        } => {
            let round = circles(CircleForm::Circle);
            let scale = match scale == 1.0 {
                true => String::new(),
                false => format!("scale = [{scale}, {scale}], "),
            };
            let arguments = format!("height = {h}, center = {is_centred}, {scale}{round}");
            block("linear_extrude", &arguments, &figure)
        }
        SweepMotion::Revolution { degrees, form } => {
            let arguments = format!("angle = {degrees}, {}", circles(form));
            block("rotate_extrude", &arguments, &figure)
        }
    }
}

fn of_figure(figure: &ModelFigure) -> String {
    let operands: String = figure.operands().iter().map(of_figure).collect();
    match figure {
        ModelFigure::Rectangle(size) => {
            format!("square(size = {}, center = false);\n", list(size))
        }
        ModelFigure::Disc { r, form } => {
            format!("circle({}, r = {r});\n", circles(*form))
        }
        ModelFigure::Polygon(corners) => {
            let corners: Vec<String> = corners.iter().map(|corner| list(corner)).collect();
            format!(
                "polygon(points = {}, paths = undef, convexity = 1);\n",
                list(&corners)
            )
        }
        ModelFigure::Operation(op, _) => block(operation(*op), "", &operands),
        ModelFigure::Hull(_) => block("hull", "", &operands),
        ModelFigure::Offset {
            distance, corner, ..
        } => {
            let arguments = match corner {
                OffsetCorner::Round => format!("r = {distance}, {}", circles(CircleForm::Circle)),
                OffsetCorner::Sharp => format!("delta = {distance}, chamfer = false"),
                OffsetCorner::Chamfer => format!("delta = {distance}, chamfer = true"),
            };
            block("offset", &arguments, &operands)
        }
        ModelFigure::Moved { turn, shift, .. } => {
            let [x, y] = *shift;
            let steps = [
                ModelStep::Turn(ModelAxis::Z, *turn),
                ModelStep::Shift([x, y, 0.0]),
            ];
            steps.iter().fold(operands, |text, step| moved(step, &text))
        }
    }
}

/// The arguments that say what circles are.
fn circles(form: CircleForm) -> String {
    let corners = match form {
        CircleForm::Circle => 0,
        CircleForm::Polygon(corners) => corners,
    };
    format!("$fn = {corners}, $fa = 12, $fs = 2")
}

fn list(values: &[impl Display]) -> String {
    let values: Vec<String> = values.iter().map(|value| value.to_string()).collect();
    format!("[{}]", values.join(", "))
}

/// A step as a matrix.
fn moved(step: &ModelStep, operand: &str) -> String {
    let mut rows = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| f64::from(u8::from(i == j))));
    match *step {
        ModelStep::Shift(by) => (0..3).for_each(|i| rows[i][3] = by[i]),
        ModelStep::Turn(axis, degrees) => {
            let (i, j) = ((axis.index() + 1) % 3, (axis.index() + 2) % 3);
            let (sin, cos) = sin_cos(degrees);
            (rows[i][i], rows[i][j]) = (cos, -sin);
            (rows[j][i], rows[j][j]) = (sin, cos);
        }
    }
    // Adding zero makes zero of minus zero.
    let rows = rows.map(|row| list(&row.map(|x| x + 0.0)));
    block("multmatrix", &list(&rows), operand)
}

/// Sine and cosine of an angle in degrees, exact for quarter turns.
fn sin_cos(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        degrees => degrees.to_radians().sin_cos(),
    }
}
