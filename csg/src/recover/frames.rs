//! Frames that primitives share: their axes are parallel to the frame's, up to sign and order.

use crate::primitive::Primitive;
use crate::recover::features::LocalAxis;
use crate::tree::PlacedPrimitive;
use nalgebra::{Matrix3, Vector3};
use premio_kernel::motion::{Motion, RationalMatrix};
use premio_kernel::number::rational::{Rational, to_f64};

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

/// A primitive in f64: what decides which frames it fits.
struct Pose<'t> {
    placed: &'t PlacedPrimitive,
    rotation: Matrix3<f64>,
    origin: Vector3<f64>,
    /// The radius of a ball about its origin that contains it.
    reach: f64,
}

impl<'t> Pose<'t> {
    fn new(placed: &'t PlacedPrimitive) -> Self {
        let lengths = placed.primitive.lengths();
        Self {
            placed,
            rotation: placed.motion.rotation_f64(),
            origin: placed.motion.translation_f64(),
            reach: lengths.into_iter().map(to_f64).sum(),
        }
    }

    fn meets(&self, other: &Self) -> bool {
        (self.origin - other.origin).norm() <= self.reach + other.reach
    }

    /// Its axes along those of a frame.
    fn axes(&self, frame: &Matrix3<f64>) -> [Option<AxisUse>; 3] {
        let local = self.rotation.transpose() * frame;
        std::array::from_fn(|k| axis_along(&self.placed.primitive, &local.column(k).into()))
    }
}

/// The leaves that share a frame.
struct Group {
    rotation: Matrix3<f64>,
    /// The leaf whose rotation it has.
    first: usize,
    leaves: Vec<usize>,
}

/// The frames of primitives, that of most primitives first. Every primitive is a member of one.
pub(super) fn frames(leaves: &[&PlacedPrimitive]) -> Vec<Frame> {
    let poses: Vec<Pose<'_>> = leaves.iter().map(|placed| Pose::new(placed)).collect();
    let groups = groups(&poses);
    let mut frames: Vec<Frame> = Vec::with_capacity(groups.len());
    for (k, group) in groups.iter().enumerate() {
        frames.extend(frame(group, &groups[..k], &poses));
    }
    frames
}

/// The groups of primitives that share a frame, the largest first.
fn groups(poses: &[Pose<'_>]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    // Primitives with more axes determine frames that the others fit.
    let order = |i: &usize| match poses[*i].placed.primitive {
        Primitive::Block { .. } | Primitive::Wedge { .. } | Primitive::Prism { .. } => 0,
        Primitive::Sphere { .. } => 2,
        _ => 1,
    };
    let mut all: Vec<usize> = (0..poses.len()).collect();
    all.sort_by_key(order);
    for leaf in all {
        let fits = |group: &Group| {
            poses[leaf]
                .axes(&group.rotation)
                .iter()
                .all(Option::is_some)
        };
        let fitting = (0..groups.len()).filter(|&k| fits(&groups[k]));
        // The first of the largest.
        match fitting.max_by_key(|&k| (groups[k].leaves.len(), std::cmp::Reverse(k))) {
            Some(k) => groups[k].leaves.push(leaf),
            None => groups.push(Group {
                rotation: poses[leaf].rotation,
                first: leaf,
                leaves: vec![leaf],
            }),
        }
    }
    groups.sort_by_key(|group| std::cmp::Reverse(group.leaves.len()));
    groups
}

/// The frame of a group, with the guests from groups before it that meet a member.
fn frame(group: &Group, before: &[Group], poses: &[Pose<'_>]) -> Option<Frame> {
    let zero = Motion::identity().offset().clone();
    let own = poses[group.first].placed.motion.rotation_matrix();
    let rotation = Motion::from_matrix(own, zero)?;
    let mut turns = OwnTurns::new(&rotation);
    let members = group.leaves.iter();
    let member = |&leaf: &usize| member(leaf, &poses[leaf], group, &mut turns);
    let members = members.map(member).collect::<Option<Vec<Member>>>()?;
    let others = before.iter().flat_map(|group| &group.leaves);
    let guests = others.filter_map(|&leaf| {
        let axes = poses[leaf].axes(&group.rotation);
        let meets = || group.leaves.iter().any(|&k| poses[k].meets(&poses[leaf]));
        let is_guest = axes.iter().any(Option::is_some) && meets();
        is_guest.then_some(Guest { leaf, axes })
    });
    Some(Frame {
        guests: guests.collect(),
        rotation,
        members,
    })
}

fn member(leaf: usize, pose: &Pose<'_>, group: &Group, turns: &mut OwnTurns<'_>) -> Option<Member> {
    let [Some(x), Some(y), Some(z)] = pose.axes(&group.rotation) else {
        return None;
    };
    let axes = [x, y, z];
    let turn = match turns.relative_to_frame(&pose.placed.motion.rotation_matrix()) {
        Some(turn) => turn,
        None => turn(&axes)?,
    };
    Some(Member { leaf, axes, turn })
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
        Primitive::Block { .. }
        | Primitive::Wedge { .. }
        | Primitive::Prism { .. }
        | Primitive::Polyhedron { .. } => parallel.map(along),
        Primitive::Revolution { angle: Some(_), .. } => parallel.map(along),
        Primitive::Sphere { .. } => Some(across),
        _ if parallel == Some(2) => Some(along(2)),
        _ => (direction.z.abs() <= SAME).then_some(across),
    }
}

/// The rotations of primitives relative to a frame. Most primitives have one of a few.
struct OwnTurns<'f> {
    inverse: Motion,
    frame: &'f Motion,
    known: Vec<OwnTurn>,
}

/// The rotation of a primitive relative to a frame.
struct OwnTurn {
    rotation: RationalMatrix,
    /// None unless it brings axes to axes exactly.
    turn: Option<Motion>,
}

impl<'f> OwnTurns<'f> {
    fn new(frame: &'f Motion) -> Self {
        Self {
            inverse: frame.inverse(),
            frame,
            known: Vec::new(),
        }
    }

    /// The relative rotation, if it brings axes to axes exactly.
    fn relative_to_frame(&mut self, rotation: &RationalMatrix) -> Option<Motion> {
        if let Some(known) = self.known.iter().find(|own| own.rotation == *rotation) {
            return known.turn.clone();
        }
        let turn = self.relative(rotation);
        if self.known.len() < KNOWN {
            self.known.push(OwnTurn {
                rotation: rotation.clone(),
                turn: turn.clone(),
            });
        }
        turn
    }

    fn relative(&self, rotation: &RationalMatrix) -> Option<Motion> {
        if *rotation == self.frame.rotation_matrix() {
            return Some(Motion::identity());
        }
        let own = Motion::from_matrix(rotation.clone(), Motion::identity().offset().clone())?;
        let relative = own.then(&self.inverse);
        let matrix = relative.rotation_matrix();
        let is_simple = matrix.iter().flatten().all(Rational::is_int);
        is_simple.then_some(relative)
    }
}

/// The number of rotations that are remembered.
const KNOWN: usize = 32;

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
