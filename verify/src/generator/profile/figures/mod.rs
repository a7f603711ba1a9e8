//! Solids of figures as OpenSCAD has them: extrusions, revolutions, hulls and Minkowski sums, on a
//! half-unit grid.

mod plane;

use super::grid;
use crate::generator::figure::{CircleForm, ModelSweep, SweepMotion};
use crate::generator::model::{
    ModelConstruction, ModelNodeId, ModelOperation, ModelPrimitive, ModelStep, Notation, PartModel,
};
use crate::generator::random::RandomChoices;

/// The random stream of this profile.
const PURPOSE: u64 = 7;

/// One to three solids, combined.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    let mut model = PartModel::with_notation(Notation::Decimal);
    let count = random.choose(&[1, 2, 2, 3]);
    let parts: Vec<ModelNodeId> = (0..count)
        .map(|_| moved_solid(random, &mut model))
        .collect();
    if count > 1 {
        use ModelOperation::{Difference, Intersection, Union};
        let op = random.choose(&[Union, Difference, Intersection, Difference]);
        model.operation(op, parts, Vec::new());
    }
    model
}

/// A solid, usually moved.
fn moved_solid(random: &mut RandomChoices, model: &mut PartModel) -> ModelNodeId {
    let solid = match random.below(10) {
        0..4 => extrusion(random, model),
        4..7 => revolution(random, model),
        7 | 8 => hull(random, model),
        _ => minkowski(random, model),
    };
    if !random.once_in(3) {
        let steps = grid::motion(random);
        if let Some(node) = model.node_mut(solid) {
            node.steps.extend(steps);
        }
    }
    solid
}

/// A figure, extruded; one in six to a scaled copy.
fn extrusion(random: &mut RandomChoices, model: &mut PartModel) -> ModelNodeId {
    let scale = match random.once_in(6) {
        true => random.choose(&[0.0, 0.25, 0.5, 2.0]),
        false => 1.0,
    };
    let motion = SweepMotion::Extrusion {
        h: random.half(1, 8),
        scale,
        is_centred: random.once_in(3),
    };
    let figure = plane::figure(random);
    model.sweep(ModelSweep { figure, motion }, Vec::new())
}

/// The part of a figure right of the axis, revolved; one in four by a part of a turn, one in five to
/// a polygon.
fn revolution(random: &mut RandomChoices, model: &mut PartModel) -> ModelNodeId {
    let degrees = match random.once_in(4) {
        true => random.choose(&[30.0, 90.0, 135.0, 180.0, 270.0, 300.0]),
        false => 360.0,
    };
    let form = match degrees == 360.0 && random.once_in(5) {
        true => CircleForm::Polygon(random.choose(&[3, 4, 5, 6, 8])),
        false => CircleForm::Circle,
    };
    let figure = plane::right_of_axis(random);
    let motion = SweepMotion::Revolution { degrees, form };
    model.sweep(ModelSweep { figure, motion }, Vec::new())
}

/// The hull of two to four shapes of one kind, for which there is an exact one.
fn hull(random: &mut RandomChoices, model: &mut PartModel) -> ModelNodeId {
    let count = random.between(2, 4);
    let radius = random.half(1, 3);
    let height = random.half(1, 4);
    let kind = random.below(5);
    let shapes = (0..count).map(|_| {
        let primitive = match kind {
            0 => ModelPrimitive::Sphere(radius),
            1 => ModelPrimitive::Cylinder {
                r: random.half(1, 3),
                h: height,
            },
            2 => return polytope(random, model),
            // Shapes about one axis.
            _ => return coaxial(random, model),
        };
        let [x, y, z] = [0; 3].map(|_| random.half(0, 8) - 2.0);
        let z = if kind == 0 { z } else { 0.0 };
        model.leaf(primitive, vec![ModelStep::Shift([x, y, z])])
    });
    let shapes = shapes.collect();
    model.construction(ModelConstruction::Hull, shapes)
}

/// A ball, a cylinder or a cone about z.
fn coaxial(random: &mut RandomChoices, model: &mut PartModel) -> ModelNodeId {
    let primitive = match random.below(3) {
        0 => ModelPrimitive::Sphere(random.half(1, 4)),
        1 => ModelPrimitive::Cylinder {
            r: random.half(1, 4),
            h: random.half(1, 4),
        },
        _ => ModelPrimitive::Frustum {
            r1: random.half(1, 4),
            r2: 0.0,
            h: random.half(1, 4),
        },
    };
    let up = ModelStep::Shift([0.0, 0.0, random.half(0, 8) - 2.0]);
    model.leaf(primitive, vec![up])
}

/// A convex polytope: a block, or a convex polygon extruded, maybe to a point.
fn polytope(random: &mut RandomChoices, model: &mut PartModel) -> ModelNodeId {
    let steps = grid::motion(random);
    if random.once_in(2) {
        let size = [0; 3].map(|_| random.half(1, 6));
        return model.leaf(ModelPrimitive::Block(size), steps);
    }
    let motion = SweepMotion::Extrusion {
        h: random.half(1, 4),
        scale: random.choose(&[0.0, 0.5, 1.0]),
        is_centred: false,
    };
    let figure = plane::convex(random);
    model.sweep(ModelSweep { figure, motion }, steps)
}

/// The sum of a polytope and a polytope, a ball or a cylinder; or of an extruded figure and a
/// cylinder of the same direction.
fn minkowski(random: &mut RandomChoices, model: &mut PartModel) -> ModelNodeId {
    let first = match random.once_in(3) {
        true => extrusion(random, model),
        false => polytope(random, model),
    };
    let second = match random.below(4) {
        0 => polytope(random, model),
        1 => model.leaf(ModelPrimitive::Sphere(random.half(1, 3)), Vec::new()),
        _ => {
            let (r, h) = (random.half(1, 3), random.half(1, 3));
            model.leaf(ModelPrimitive::Cylinder { r, h }, Vec::new())
        }
    };
    model.construction(ModelConstruction::Minkowski, vec![first, second])
}
