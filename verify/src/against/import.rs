//! Descriptions as models, so that they are written in any form and can be shrunk.

use crate::generator::model::{
    ModelAxis, ModelNodeId, ModelOperation, ModelPrimitive, ModelStep, Notation, PartModel,
};
use crate::generator::write::{read, write};
use premio_csg::reader::{self, Format, ReadError, ReadOptions};
use premio_csg::tree::Tree;
use premio_csg::writer;
use serde::Deserialize;

/// Why a description is no model.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// It cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// It cannot be written as a tree of primitives.
    #[error("{0}")]
    Write(#[from] writer::WriteError),
    /// It has a step, a primitive or a depth that models do not have.
    #[error("the tree has more than translations and rotations about coordinate axes: {0}")]
    Form(#[from] serde_json::Error),
    /// A rotation has another axis.
    #[error("a rotation about ({}, {}, {}): expected a coordinate axis", .axis[0], .axis[1], .axis[2])]
    Axis {
        /// The axis.
        axis: [f64; 3],
    },
    /// A number is no f64 and no decimal of one.
    #[error("a number has more digits than f64 keeps")]
    Digits,
}

/// A node of the tree as JSON.
#[derive(Debug, Deserialize)]
struct JsonNode {
    #[serde(flatten)]
    kind: JsonNodeKind,
    #[serde(default)]
    transform: Vec<JsonStep>,
}

#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum JsonNodeKind {
    Operation {
        op: JsonOperation,
        children: Vec<JsonNode>,
    },
    Primitive(JsonPrimitive),
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
enum JsonOperation {
    Union,
    Intersection,
    Difference,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(tag = "prim", rename_all = "lowercase")]
enum JsonPrimitive {
    Block {
        size: [f64; 3],
    },
    Wedge {
        size: [f64; 3],
    },
    Cylinder {
        r: f64,
        h: f64,
    },
    Cone {
        r: f64,
        h: f64,
    },
    Frustum {
        r1: f64,
        r2: f64,
        h: f64,
    },
    Sphere {
        r: f64,
    },
    Torus {
        #[serde(rename = "R")]
        major: f64,
        #[serde(rename = "r")]
        minor: f64,
    },
    #[serde(rename = "oblique_frustum")]
    ObliqueFrustum {
        x: [f64; 3],
        y: [f64; 3],
        z: [f64; 3],
        #[serde(default = "one")]
        top: f64,
    },
    Ellipsoid {
        x: [f64; 3],
        y: [f64; 3],
        z: [f64; 3],
    },
}

/// The size of a top that is not given.
fn one() -> f64 {
    1.0
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "lowercase")]
enum JsonStep {
    Translate([f64; 3]),
    Rotate([f64; 3], f64),
}

/// The model of a description: the same tree exactly. `name` is used in messages.
///
/// # Errors
/// The description cannot be read, or has steps or numbers that a model does not have.
pub fn model(name: &str, bytes: &[u8], format: Format) -> Result<PartModel, ImportError> {
    let program = reader::parse(name, bytes, format, &ReadOptions::default())?;
    let tree = program.tree(name, bytes)?;
    let text = writer::write(&program.builder, program.part, Format::Json)?;
    let root: JsonNode = serde_json::from_str(&text)?;
    let mut model = flattened(root)?;
    for notation in [Notation::Decimal, Notation::Binary] {
        model.notation = notation;
        if is_tree_of(&model, &tree) {
            return Ok(model);
        }
    }
    Err(ImportError::Digits)
}

fn is_tree_of(model: &PartModel, tree: &Tree) -> bool {
    read(&write(model, Format::Json), Format::Json).is_ok_and(|found| found.tree == *tree)
}

/// A node whose children are added one by one.
struct OpenNode {
    op: ModelOperation,
    steps: Vec<ModelStep>,
    left: std::vec::IntoIter<JsonNode>,
    children: Vec<ModelNodeId>,
}

/// The nodes in one arena, children first.
fn flattened(root: JsonNode) -> Result<PartModel, ImportError> {
    let mut model = PartModel::default();
    let mut open: Vec<OpenNode> = Vec::new();
    let mut next = Some(root);
    loop {
        let mut finished = None;
        if let Some(node) = next.take() {
            let steps = node.transform.iter().map(step).collect::<Result<_, _>>()?;
            match node.kind {
                JsonNodeKind::Primitive(kind) => {
                    finished = Some(model.leaf(primitive(kind), steps))
                }
                JsonNodeKind::Operation { op, children } => open.push(OpenNode {
                    op: operation(op),
                    steps,
                    left: children.into_iter(),
                    children: Vec::new(),
                }),
            }
        }
        let Some(parent) = open.last_mut() else {
            return Ok(model);
        };
        parent.children.extend(finished);
        next = parent.left.next();
        if next.is_none()
            && let Some(parent) = open.pop()
        {
            let id = model.operation(parent.op, parent.children, parent.steps);
            match open.last_mut() {
                Some(above) => above.children.push(id),
                None => return Ok(model),
            }
        }
    }
}

fn primitive(primitive: JsonPrimitive) -> ModelPrimitive {
    match primitive {
        JsonPrimitive::Block { size } => ModelPrimitive::Block(size),
        JsonPrimitive::Wedge { size } => ModelPrimitive::Wedge(size),
        JsonPrimitive::Cylinder { r, h } => ModelPrimitive::Cylinder { r, h },
        JsonPrimitive::Cone { r, h } => ModelPrimitive::Frustum { r1: r, r2: 0.0, h },
        JsonPrimitive::Frustum { r1, r2, h } => ModelPrimitive::Frustum { r1, r2, h },
        JsonPrimitive::Sphere { r } => ModelPrimitive::Sphere(r),
        JsonPrimitive::Torus { major, minor } => ModelPrimitive::Torus { major, minor },
        JsonPrimitive::ObliqueFrustum { x, y, z, top } => ModelPrimitive::ObliqueFrustum {
            axes: [x, y, z],
            top,
        },
        JsonPrimitive::Ellipsoid { x, y, z } => ModelPrimitive::Ellipsoid([x, y, z]),
    }
}

fn operation(op: JsonOperation) -> ModelOperation {
    match op {
        JsonOperation::Union => ModelOperation::Union,
        JsonOperation::Intersection => ModelOperation::Intersection,
        JsonOperation::Difference => ModelOperation::Difference,
    }
}

fn step(step: &JsonStep) -> Result<ModelStep, ImportError> {
    match *step {
        JsonStep::Translate(by) => Ok(ModelStep::Shift(by)),
        JsonStep::Rotate(axis, degrees) => {
            let along = |known: &ModelAxis| {
                let across = (0..3).filter(|i| *i != known.index());
                across.map(|i| axis[i]).all(|x| x == 0.0)
            };
            let known = ModelAxis::ALL.into_iter().find(along);
            let known = known.ok_or(ImportError::Axis { axis })?;
            let degrees = match axis[known.index()] > 0.0 {
                true => degrees,
                false => -degrees,
            };
            Ok(ModelStep::Turn(known, degrees))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generator::profile::Profile;

    #[test]
    fn a_written_model_is_read_as_it_was() {
        for profile in [
            Profile::Grid,
            Profile::Tangent,
            Profile::Wide,
            Profile::Parts,
            Profile::Rounded,
        ] {
            for seed in 0..10 {
                let known = profile.model(seed);
                let text = write(&known, Format::Padl);
                let read = model("part", text.as_bytes(), Format::Padl).expect(&text);
                let [read, known] = [read, known].map(|model| {
                    let text = write(&model, Format::Json);
                    crate::generator::write::read(&text, Format::Json)
                        .unwrap()
                        .tree
                });
                assert!(read == known, "{profile} {seed}");
            }
        }
    }

    #[test]
    fn other_steps_are_errors() {
        let read = |text: &str| model("part", text.as_bytes(), Format::Json).unwrap_err();
        let part = |steps: &str| format!(r#"{{"prim":"sphere","r":1,"transform":[{steps}]}}"#);
        let turned = part(r#"{"rotate":[[1,1,0],30]}"#);
        assert!(matches!(read(&turned), ImportError::Axis { .. }));
        let other = part(r#"{"quaternion":[1,2,3,4]}"#);
        assert!(matches!(read(&other), ImportError::Form(_)));
        let long = part(r#"{"translate":[0.1234567890123456789012,0,0]}"#);
        assert!(matches!(read(&long), ImportError::Digits));
        assert!(matches!(read("{"), ImportError::Read(_)));
    }
}
