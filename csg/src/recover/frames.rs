//! Frames that primitives share: their axes are parallel to the frame's, up to sign and order.

use crate::primitive::Primitive;
use crate::recover::features::LocalAxis;
use crate::tree::PlacedPrimitive;
use nalgebra::{Matrix3, Vector3};
use premio_kernel::motion::Motion;
use premio_kernel::number::rational::Rational;

/// The angle, in radians, up to which directions are the same: rotations are exact, and those of
/// f64 numbers differ by its precision.
const SAME: f64 = 4096.0 * f64::EPSILON;

/// An axis of a frame with the axis of a primitive that is parallel to it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct AxisUse {
    /// The primitive's axis.
    pub local: LocalAxis,
    /// Whether they have opposite directions.
    pub is_reversed: bool,
}

/// A primitive whose position is determined in a frame.
#[derive(Debug, Clone)]
pub(super) struct Member {
    /// Its index among the leaves.
    pub leaf: usize,
    /// Its own axes along those of the frame.
    pub axes: [AxisUse; 3],
    /// Its rotation in the frame: axes to axes.
    pub turn: Motion,
}

/// A primitive of another frame that has numbers along some axes of this one.
#[derive(Debug, Clone)]
pub(super) struct Guest {
    /// Its index among the leaves.
    pub leaf: usize,
    /// Its own axes along those of the frame, where there is one.
    pub axes: [Option<AxisUse>; 3],
}

/// A frame.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    /// Its rotation.
    pub rotation: Motion,
    /// The primitives whose position is determined in it.
    pub members: Vec<Member>,
    /// Those of frames before it.
    pub guests: Vec<Guest>,
}

/// The frames of primitives, that of most primitives first. Every primitive is a member of one.
pub(super) fn frames(leaves: &[&PlacedPrimitive]) -> Vec<Frame> {
    let mut frames: Vec<Frame> = Vec::new();
    // Primitives with more axes determine frames that the others fit.
    let order = |i: &usize| match leaves[*i].primitive {
        Primitive::Block { .. } | Primitive::Wedge { .. } => 0,
        Primitive::Sphere { .. } => 2,
        _ => 1,
    };
    let mut all: Vec<usize> = (0..leaves.len()).collect();
    all.sort_by_key(order);
    for leaf in all {
        let fits = |frame: &Frame| member(leaf, leaves[leaf], &frame.rotation);
        let best = frames
            .iter()
            .enumerate()
            .filter_map(|(k, frame)| Some((k, fits(frame)?)))
            // The first of the largest.
            .max_by_key(|(k, _)| (frames[*k].members.len(), std::cmp::Reverse(*k)));
        match best {
            Some((k, member)) => frames[k].members.push(member),
            None => frames.extend(founded(leaf, leaves[leaf])),
        }
    }
    frames.sort_by_key(|frame| std::cmp::Reverse(frame.members.len()));
    for k in 1..frames.len() {
        let (before, rest) = frames.split_at_mut(k);
        let leaves_before = before.iter().flat_map(|f| f.members.iter().map(|m| m.leaf));
        let guests = leaves_before.filter_map(|i| guest(i, leaves[i], &rest[0].rotation));
        rest[0].guests = guests.collect();
    }
    frames
}

/// The frame of a primitive's own rotation.
fn founded(leaf: usize, placed: &PlacedPrimitive) -> Option<Frame> {
    let zero = Motion::identity().offset().clone();
    let rotation = Motion::from_matrix(placed.motion.rotation_matrix(), zero)?;
    let first = member(leaf, placed, &rotation)?;
    Some(Frame {
        rotation,
        members: vec![first],
        guests: Vec::new(),
    })
}

/// The axes of a primitive along those of a frame; `None` if an axis of the frame has none.
fn member(leaf: usize, placed: &PlacedPrimitive, rotation: &Motion) -> Option<Member> {
    let axes = axes(placed, rotation);
    let [Some(x), Some(y), Some(z)] = axes else {
        return None;
    };
    let axes = [x, y, z];
    let turn = match own_turn(placed, rotation) {
        Some(turn) => turn,
        None => turn(&axes)?,
    };
    Some(Member { leaf, axes, turn })
}

fn guest(leaf: usize, placed: &PlacedPrimitive, rotation: &Motion) -> Option<Guest> {
    let axes = axes(placed, rotation);
    let any = axes.iter().any(Option::is_some);
    any.then_some(Guest { leaf, axes })
}

/// The axes of a primitive along those of a frame.
fn axes(placed: &PlacedPrimitive, rotation: &Motion) -> [Option<AxisUse>; 3] {
    let local = placed.motion.rotation_f64().transpose() * rotation.rotation_f64();
    std::array::from_fn(|k| axis_along(&placed.primitive, &local.column(k).into()))
}

/// The axis of a primitive along a direction of its own frame.
fn axis_along(primitive: &Primitive, direction: &Vector3<f64>) -> Option<AxisUse> {
    let parallel = (0..3).find(|&k| (0..3).all(|i| i == k || direction[i].abs() <= SAME));
    let along = |k: usize| AxisUse {
        local: LocalAxis::Along(k),
        is_reversed: direction[k] < 0.0,
    };
    let across = AxisUse {
        local: LocalAxis::Across,
        is_reversed: false,
    };
    match primitive {
        Primitive::Block { .. } | Primitive::Wedge { .. } => parallel.map(along),
        Primitive::Sphere { .. } => Some(across),
        _ if parallel == Some(2) => Some(along(2)),
        _ => (direction.z.abs() <= SAME).then_some(across),
    }
}

/// The rotation of a primitive relative to a frame, if it brings axes to axes exactly.
fn own_turn(placed: &PlacedPrimitive, rotation: &Motion) -> Option<Motion> {
    let zero = || Motion::identity().offset().clone();
    let own = Motion::from_matrix(placed.motion.rotation_matrix(), zero())?;
    let relative = own.then(&rotation.inverse());
    let matrix = relative.rotation_matrix();
    let is_simple = matrix.iter().flatten().all(Rational::is_int);
    is_simple.then_some(relative)
}

/// The rotation that brings a primitive's axes to those of a frame. Axes across that of a primitive
/// of revolution may be any.
fn turn(axes: &[AxisUse; 3]) -> Option<Motion> {
    let mut matrix = Matrix3::<i8>::zeros();
    for (k, axis) in axes.iter().enumerate() {
        if let LocalAxis::Along(local) = axis.local {
            matrix[(k, local)] = if axis.is_reversed { -1 } else { 1 };
        }
    }
    complete(&mut matrix);
    let entry = |i: usize, j: usize| Rational::from(matrix[(i, j)]);
    let rows = std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)));
    Motion::from_matrix(rows, Motion::identity().offset().clone())
}

/// Fills the missing columns of a matrix of axes so that it is a rotation.
fn complete(matrix: &mut Matrix3<i8>) {
    let is_empty = |m: &Matrix3<i8>, j: usize| m.column(j).iter().all(|v| *v == 0);
    if (0..3).all(|j| is_empty(matrix, j)) {
        *matrix = Matrix3::identity();
    } else if is_empty(matrix, 0) && is_empty(matrix, 1) {
        // The third axis is given; the first is the next one of the frame.
        let k = (0..3).find(|&i| matrix[(i, 2)] != 0).unwrap_or(2);
        matrix[((k + 1) % 3, 0)] = 1;
        matrix[((k + 2) % 3, 1)] = matrix[(k, 2)];
    }
}
