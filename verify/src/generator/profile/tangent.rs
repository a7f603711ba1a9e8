//! Pairs of primitives that touch by construction.
//!
//! A port is a point of a primitive's boundary with its normal. Two primitives are placed so that
//! the ports of both lie at the origin. Their normals are opposite, for contact from outside, or
//! equal, for contact from inside.

use super::grid;
use crate::generator::model::{
    ModelAxis, ModelNodeId, ModelOperation, ModelPrimitive, ModelStep, PartModel,
};
use crate::generator::random::RandomChoices;

/// The random stream of this profile.
const PURPOSE: u64 = 2;

/// A point of a boundary with the normal there, or with one between the normals of an edge's faces.
#[derive(Clone, Copy, Debug)]
struct Port {
    at: [f64; 3],
    /// The rotation of the normal about z out of the x-z plane, in degrees.
    yaw: f64,
    /// The angle of the normal from x towards z, in degrees, before that rotation.
    tilt: f64,
}

/// Two primitives that touch at a point or along a line or a face, joined by an operation, and up
/// to two more, half of them with a port at that point. Usually all are rotated about an odd axis
/// and moved.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    let mut model = PartModel::default();
    let first = touching(random, &mut model);
    let second = touching(random, &mut model);
    let mut part = join(random, &mut model, [first, second]);
    for _ in 0..random.below(3) {
        let cutter = match random.once_in(2) {
            true => touching(random, &mut model),
            false => {
                let primitive = grid::primitive(random);
                model.leaf(primitive, grid::motion(random))
            }
        };
        part = join(random, &mut model, [part, cutter]);
    }
    if let (true, Some(root)) = (!random.once_in(4), model.node_mut(part)) {
        root.steps = vec![
            ModelStep::Turn(ModelAxis::X, 17.0),
            ModelStep::Turn(ModelAxis::Z, 31.0),
            ModelStep::Shift([0.3, 0.7, -0.2]),
        ];
    }
    model
}

fn join(random: &mut RandomChoices, model: &mut PartModel, parts: [ModelNodeId; 2]) -> ModelNodeId {
    let op = random.choose(&ModelOperation::ALL);
    model.operation(op, parts.to_vec(), Vec::new())
}

/// A primitive that touches the plane z = 0 at the origin, from above or below, rotated about z.
fn touching(random: &mut RandomChoices, model: &mut PartModel) -> ModelNodeId {
    let primitive = grid::primitive(random);
    let Port { at, yaw, tilt } = port(random, &primitive);
    let mut steps = vec![
        ModelStep::Shift(at.map(|x| 0.0 - x)),
        ModelStep::Turn(ModelAxis::Z, -yaw),
        ModelStep::Turn(ModelAxis::Y, tilt - 90.0),
        ModelStep::Turn(
            ModelAxis::Z,
            random.choose(&[0.0, 0.0, 90.0, 45.0, 30.0, 17.0]),
        ),
        ModelStep::Turn(ModelAxis::X, random.choose(&[0.0, 180.0])),
    ];
    steps.retain(|step| {
        !matches!(
            step,
            ModelStep::Turn(_, 0.0) | ModelStep::Shift([0.0, 0.0, 0.0])
        )
    });
    model.leaf(primitive, steps)
}

/// A random port on one of the primitive's faces, edges or corners.
fn port(random: &mut RandomChoices, primitive: &ModelPrimitive) -> Port {
    let port = |at, tilt| Port { at, yaw: 0.0, tilt };
    let part = random.choose(&[0.25, 0.5, 0.5, 0.75]);
    match *primitive {
        ModelPrimitive::Block(size) => on_block(random, size, part),
        ModelPrimitive::Wedge(size) => on_wedge(random, size, part),
        ModelPrimitive::Cylinder { r, h } => on_profile(random, [r, r, h], part),
        ModelPrimitive::Frustum { r1, r2, h } => on_profile(random, [r1, r2, h], part),
        ModelPrimitive::Sphere(r) => {
            let tilt = random.choose(&[90.0, 90.0, 0.0, 30.0]);
            port(on_circle([0.0, 0.0], r, tilt), tilt)
        }
        // On the base, which is all that is known of its place.
        ModelPrimitive::ObliqueFrustum { .. } => port([0.0; 3], -90.0),
        // At the end of its third radius, where the tangent plane is parallel to the others.
        ModelPrimitive::Ellipsoid([_, _, z]) => port(z, 90.0),
        ModelPrimitive::Torus { major, minor } => {
            let tilt = random.choose(&[0.0, 90.0, 180.0, 90.0, 60.0, 120.0, 37.0]);
            port(on_circle([major, 0.0], minor, tilt), tilt)
        }
    }
}

/// The point of a circle in the x-z plane at an angle in degrees.
fn on_circle([x, z]: [f64; 2], r: f64, degrees: f64) -> [f64; 3] {
    let (sin, cos) = match degrees {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        other => other.to_radians().sin_cos(),
    };
    [x + r * cos, 0.0, z + r * sin]
}

fn on_block(random: &mut RandomChoices, [x, y, z]: [f64; 3], part: f64) -> Port {
    let port = |at, yaw, tilt| Port { at, yaw, tilt };
    match random.below(6) {
        0 => port([x, part * y, 0.5 * z], 0.0, 0.0),
        1 => port([0.5 * x, part * y, z], 0.0, 90.0),
        2 => port([part * x, y, 0.5 * z], 90.0, 0.0),
        3 => port([x, part * y, z], 0.0, 45.0),
        4 => port([x, part * y, z], 0.0, 90.0),
        // The corner's normal is the diagonal.
        _ => port([x, y, z], 45.0, 0.5f64.sqrt().atan().to_degrees()),
    }
}

fn on_wedge(random: &mut RandomChoices, [x, y, z]: [f64; 3], part: f64) -> Port {
    let port = |at, yaw, tilt| Port { at, yaw, tilt };
    let slope = x.atan2(z).to_degrees();
    match random.below(6) {
        0 => port([0.25 * x, part * y, 0.0], 0.0, -90.0),
        1 => port([0.0, part * y, 0.25 * z], 0.0, 180.0),
        2 => port([0.25 * x, y, 0.25 * z], 90.0, 0.0),
        3 | 4 => port([part * x, 0.5 * y, (1.0 - part) * z], 0.0, slope),
        _ => port([x, part * y, 0.0], 0.0, 0.0),
    }
}

/// A port on a cylinder or a frustum with two radii and a height.
fn on_profile(random: &mut RandomChoices, [r1, r2, h]: [f64; 3], part: f64) -> Port {
    let port = |at, tilt| Port { at, yaw: 0.0, tilt };
    let slope = (r1 - r2).atan2(h).to_degrees();
    match random.below(7) {
        0 => port([part * r1, 0.0, 0.0], -90.0),
        1 => port([part * r2, 0.0, h], 90.0),
        2 => port([r1, 0.0, 0.0], -45.0),
        // The upper rim, or the apex.
        3 => port([r2, 0.0, h], if r2 == 0.0 { 90.0 } else { 45.0 }),
        4 => port([r2, 0.0, h], slope),
        _ => port([r1 + part * (r2 - r1), 0.0, part * h], slope),
    }
}
