//! Models as text: padl, csg (as OpenSCAD flattens) and json.

use super::model::{
    ModelAxis, ModelNodeKind, ModelOperation, ModelPrimitive, ModelStep, Notation, PartModel,
};
use super::openscad;
use premio_csg::builder::{Builder, SolidId};
use premio_csg::primitive::{self, PrimitiveError};
use premio_csg::reader::{self, Description, ReadError, ReadOptions};
use premio_csg::transform::{self, Transform};
use premio_csg::tree;
use premio_csg::writer;
use premio_kernel::number::rational::{Rational, from_decimal, from_f64};

pub use premio_csg::reader::Format;

/// The language of a model's description: the wanted one, or `.csg` if the model has figures.
pub fn format(model: &PartModel, wanted: Format) -> Format {
    match model.has_figures() {
        true => Format::Csg,
        false => wanted,
    }
}

/// A model's description. It is `.csg` in any case if the model has figures; see [`format()`].
///
/// Text in padl and json is read as the same tree. A csg has matrices. The reader converts them to
/// rotations by whole quarters of a degree if that explains their digits. It reads other rotations
/// as rigid ones to f64 precision.
pub fn write(model: &PartModel, format: Format) -> String {
    if model.has_figures() {
        return openscad::text(model);
    }
    let BuiltModel { builder, solid } = built(model);
    // A model is small, and consists of primitives.
    writer::write(&builder, solid, format).unwrap_or_default()
}

/// The tree of a model, with its exact numbers.
///
/// # Errors
/// The model is beyond a stated limit, or a shape has no exact boundary.
pub fn description(model: &PartModel) -> Result<Description, ReadError> {
    let text = write(model, Format::Json);
    read(&text, format(model, Format::Json))
}

/// Reads a text that [`write()`] made.
///
/// # Errors
/// The text does not describe a solid in this format, or it is beyond a stated limit.
pub fn read(text: &str, format: Format) -> Result<Description, ReadError> {
    reader::read("model", text.as_bytes(), format, &ReadOptions::default())
}

/// The solid of a model, with its builder.
struct BuiltModel {
    builder: Builder,
    solid: SolidId,
}

fn built(model: &PartModel) -> BuiltModel {
    let mut builder = Builder::new();
    let mut parts: Vec<SolidId> = Vec::with_capacity(model.nodes().len());
    let exact = |value: f64| number(value, model.notation);
    for node in model.nodes() {
        let part = match &node.kind {
            // A primitive with an invalid length is omitted.
            ModelNodeKind::Leaf(primitive) => match solid(primitive, &exact) {
                Ok(primitive) => builder.primitive(primitive),
                Err(_) => SolidId::EMPTY,
            },
            ModelNodeKind::Operation(op, children) => {
                let children: Vec<SolidId> = children.iter().map(|&child| parts[child]).collect();
                builder.operation(operation(*op), &children)
            }
            // Models with these are `.csg`, which has its own writer.
            ModelNodeKind::Sweep(_) | ModelNodeKind::Construction(..) => SolidId::EMPTY,
        };
        parts.push(builder.moved(part, placed(&node.steps, &exact)));
    }
    BuiltModel {
        builder,
        solid: parts.last().copied().unwrap_or(SolidId::EMPTY),
    }
}

/// The exact number that a finite f64 of a model represents.
fn number(value: f64, notation: Notation) -> Rational {
    let exact = match notation {
        Notation::Binary => from_f64(value),
        Notation::Decimal => from_decimal(&value.to_string()).ok(),
    };
    exact.unwrap_or(Rational::ZERO)
}

fn solid(
    primitive: &ModelPrimitive,
    number: &impl Fn(f64) -> Rational,
) -> Result<primitive::Primitive, PrimitiveError> {
    use primitive::Primitive as Exact;
    match *primitive {
        ModelPrimitive::Block(size) => Exact::block(size.map(number)),
        ModelPrimitive::Wedge(size) => Exact::wedge(size.map(number)),
        ModelPrimitive::Cylinder { r, h } => Exact::cylinder(number(r), number(h)),
        ModelPrimitive::Frustum { r1, r2, h } => Exact::frustum(number(r1), number(r2), number(h)),
        ModelPrimitive::Sphere(r) => Exact::sphere(number(r)),
        ModelPrimitive::Torus { major, minor } => Exact::torus(number(major), number(minor)),
        ModelPrimitive::ObliqueFrustum { axes, top } => {
            Exact::oblique_frustum(axes.map(|axis| axis.map(number)), number(top))
        }
        ModelPrimitive::Ellipsoid(radii) => Exact::ellipsoid(radii.map(|axis| axis.map(number))),
    }
}

fn operation(op: ModelOperation) -> tree::Operation {
    match op {
        ModelOperation::Union => tree::Operation::Union,
        ModelOperation::Intersection => tree::Operation::Intersection,
        ModelOperation::Difference => tree::Operation::Difference,
    }
}

fn placed(steps: &[ModelStep], number: &impl Fn(f64) -> Rational) -> Transform {
    let mut moves = Transform::new();
    for step in steps {
        let step = match *step {
            ModelStep::Shift(by) => transform::TransformStep::Shift(by.map(number)),
            ModelStep::Turn(axis, degrees) => transform::TransformStep::Turn {
                axis: ModelAxis::vector(axis, 1.0).map(number),
                degrees: number(degrees),
            },
        };
        // A coordinate axis has a direction.
        let _ = moves.push(step);
    }
    moves
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generator::profile::Profile;
    use premio_csg::evaluate::evaluate;

    fn volume(description: &Description) -> f64 {
        let part = evaluate(&description.tree, &Default::default()).unwrap();
        part.mass().volume
    }

    #[test]
    fn padl_and_json_are_the_same_tree() {
        let profiles = Profile::ALL.into_iter();
        for profile in profiles.filter(|profile| *profile != Profile::Figures) {
            for seed in 0..25 {
                let model = profile.model(seed);
                let [padl, json] = [Format::Padl, Format::Json].map(|f| {
                    let text = write(&model, f);
                    read(&text, f).expect(&text).tree
                });
                assert!(padl == json, "{profile} {seed}");
            }
        }
    }

    #[test]
    fn csg_is_the_same_tree_where_turns_are_of_quarter_degrees() {
        for seed in 0..200 {
            let model = Profile::Grid.model(seed);
            let [csg, json] = [Format::Csg, Format::Json].map(|f| {
                let text = write(&model, f);
                read(&text, f).expect(&text).tree
            });
            assert!(csg == json, "seed {seed}");
        }
    }

    #[test]
    fn csg_has_the_same_volume() {
        for profile in [Profile::Tangent, Profile::Near] {
            for seed in 0..12 {
                let model = profile.model(seed);
                let [csg, json] = [Format::Csg, Format::Json]
                    .map(|f| read(&write(&model, f), f).unwrap())
                    .map(|description| volume(&description));
                let off = 1e-9;
                assert!((csg - json).abs() < off, "{profile} {seed}: {csg} {json}");
            }
        }
    }

    #[test]
    fn small_numbers_have_no_exponent() {
        let step = ModelStep::Shift([2f64.powi(-60), 0.0, -1e-9]);
        let model = PartModel::new(ModelPrimitive::Sphere(0.5), vec![step]);
        for format in [Format::Padl, Format::Csg, Format::Json] {
            let text = write(&model, format);
            assert!(text.contains("0.000000000000000000867"), "{text}");
            assert!(!text.contains("e-"), "{text}");
        }
    }
}
