//! The positions of the primitives of a tree while their relations are recovered.

use crate::recover::alignment::{Node, aligned};
use crate::recover::circles::{Round, at_radius};
use crate::recover::features::{Feature, LocalAxis, features};
use crate::recover::frames::{AxisUse, Frame, Member};
use crate::recover::rounding::Rounding;
use crate::recover::{PrimitiveRelation, PrimitiveRelationCount, Recovery};
use crate::transform::{Transform, TransformStep};
use crate::tree::{NodeId, PlacedPrimitive, Tree, TreeNode};
use premio_kernel::motion::{Motion, MotionError};
use premio_kernel::number::rational::{Rational, to_f64};
use std::collections::BTreeMap;

/// The placement of a member at a position in its frame.
fn transform(
    frame: &Frame,
    member: &Member,
    position: Coordinates,
) -> Result<Transform, MotionError> {
    let turn = Transform::quarter_turns(&member.turn.rotation_matrix());
    let mut transform = turn.unwrap_or_default();
    transform.push(TransformStep::Shift(position))?;
    if !frame.rotation.is_identity() {
        let quaternion = frame.rotation.quaternion();
        transform.push(TransformStep::Quaternion(quaternion))?;
    }
    Ok(transform)
}

/// Three coordinates.
type Coordinates = [Rational; 3];

/// Which coordinates are rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rounded {
    /// Those of the surroundings.
    Outside,
    /// Those in the frame of each primitive.
    InFrame,
}

/// The positions of primitives.
#[derive(Debug)]
pub(super) struct Placement<'t> {
    leaves: Vec<(NodeId, &'t PlacedPrimitive)>,
    rounding: Rounding,
    rounded: Rounded,
    /// By leaf: its new motion, once its frame is done.
    motions: Vec<Option<Motion>>,
    /// By leaf: the steps of its new motion, if it moves.
    transforms: Vec<Option<Transform>>,
    relations: BTreeMap<PrimitiveRelation, usize>,
    contradictory: usize,
}

/// A primitive on a circle about the axis of another one.
#[derive(Debug, Clone)]
struct OnCircle {
    /// The indices of both in their frame.
    centre: usize,
    member: usize,
    /// The axis of the frame that is normal to the circle.
    axis: usize,
    radius: Rational,
}

/// The members of a frame with their coordinates in it.
struct FrameCoordinates<'f> {
    frame: &'f Frame,
    written: Vec<Coordinates>,
    errors: Vec<[f64; 3]>,
    /// By member and axis: the new coordinate.
    new: Vec<[Option<Rational>; 3]>,
}

impl<'t> Placement<'t> {
    /// The positions as written, and their rounding; `None` if they are not rounded.
    pub fn new(tree: &'t Tree, frames: &[Frame]) -> Option<(Self, Rounding)> {
        let leaves: Vec<_> = tree.leaves().collect();
        let outside = leaves.iter().flat_map(|leaf| leaf.1.motion.offset());
        let in_frames = || {
            let members = frames
                .iter()
                .flat_map(|f| f.members.iter().map(move |m| (f, m)));
            // Without a rotation these are the coordinates outside.
            let members = members.filter(|(frame, _)| !frame.rotation.is_identity());
            let local = |(frame, member): (&Frame, &Member)| {
                let inverse = frame.rotation.inverse();
                inverse.apply_vector(leaves[member.leaf].1.motion.offset())
            };
            members.flat_map(local).collect::<Vec<_>>()
        };
        let (rounding, rounded) = match Rounding::new(outside) {
            Some(rounding) => (rounding, Rounded::Outside),
            None => (Rounding::new(in_frames().iter())?, Rounded::InFrame),
        };
        let count = leaves.len();
        let placement = Self {
            leaves,
            rounding,
            rounded,
            motions: vec![None; count],
            transforms: vec![None; count],
            relations: BTreeMap::new(),
            contradictory: 0,
        };
        Some((placement, rounding))
    }

    /// Aligns the members of a frame with each other and with its guests.
    pub fn align(&mut self, frame: &Frame) {
        let mut coordinates = self.coordinates(frame);
        let circles = self.circles(&coordinates);
        for axis in 0..3 {
            self.align_along(axis, &mut coordinates, &circles);
        }
        for circle in &circles {
            self.place_on_circle(circle, &mut coordinates);
        }
        for (k, member) in frame.members.iter().enumerate() {
            let new = &coordinates.new[k];
            let is_new = new.iter().any(Option::is_some);
            let at = |axis: usize| {
                let written = &coordinates.written[k][axis];
                new[axis].clone().unwrap_or_else(|| written.clone())
            };
            let transform = is_new.then(|| transform(frame, member, [at(0), at(1), at(2)]));
            let transform = transform.and_then(Result::ok);
            let old = &self.leaves[member.leaf].1.motion;
            let motion = transform.as_ref().map_or(old, Transform::motion).clone();
            self.motions[member.leaf] = Some(motion);
            self.transforms[member.leaf] = transform;
        }
    }

    fn coordinates<'f>(&self, frame: &'f Frame) -> FrameCoordinates<'f> {
        let inverse = frame.rotation.inverse();
        let offset = |m: &Member| self.leaves[m.leaf].1.motion.offset();
        let members = &frame.members;
        let written: Vec<Coordinates> = members
            .iter()
            .map(|m| inverse.apply_vector(offset(m)))
            .collect();
        let errors = members.iter().zip(&written);
        let errors = errors.map(|(m, written)| match self.rounded {
            Rounded::InFrame => written.each_ref().map(|x| self.rounding.error(x)),
            Rounded::Outside => {
                let outside = offset(m).each_ref().map(|x| self.rounding.error(x));
                let rotation = frame.rotation.rotation_f64();
                let is_simple = rotation.iter().all(|x| x.fract() == 0.0);
                let turned = if is_simple {
                    0.0
                } else {
                    self.rounding.rotation_error()
                };
                let length: f64 = offset(m).iter().map(|x| to_f64(x).abs()).sum();
                let along = |k: usize| -> f64 {
                    let moved = (0..3).map(|i| rotation[(i, k)].abs() * outside[i]);
                    moved.sum::<f64>() + turned * length
                };
                std::array::from_fn(along)
            }
        });
        FrameCoordinates {
            frame,
            errors: errors.collect(),
            new: vec![Default::default(); members.len()],
            written,
        }
    }

    /// The numbers of a primitive along an axis of a frame.
    fn numbers(&self, leaf: usize, axis: AxisUse) -> Vec<Feature> {
        let mut all = features(&self.leaves[leaf].1.primitive, axis.local);
        if axis.is_reversed {
            for feature in &mut all {
                feature.offset = -feature.offset.clone();
            }
        }
        all
    }

    fn align_along(
        &mut self,
        axis: usize,
        coordinates: &mut FrameCoordinates<'_>,
        circles: &[OnCircle],
    ) {
        let frame = coordinates.frame;
        let is_on_circle = |k: usize| circles.iter().any(|c| c.member == k && c.axis != axis);
        let members: Vec<usize> = (0..frame.members.len())
            .filter(|&k| !is_on_circle(k))
            .collect();
        let mut nodes: Vec<Node> = members
            .iter()
            .map(|&k| {
                let member = &frame.members[k];
                Node {
                    position: coordinates.written[k][axis].clone(),
                    error: coordinates.errors[k][axis],
                    features: self.numbers(member.leaf, member.axes[axis]),
                }
            })
            .collect();
        let inverse = frame.rotation.inverse();
        for guest in &frame.guests {
            let motion = self.motions[guest.leaf].as_ref();
            if let (Some(used), Some(motion)) = (guest.axes[axis], motion) {
                let [x, y, z] = inverse.apply_vector(motion.offset());
                nodes.push(Node {
                    position: [x, y, z][axis].clone(),
                    error: 0.0,
                    features: self.numbers(guest.leaf, used),
                });
            }
        }
        let alignment = aligned(&nodes);
        self.contradictory += alignment.contradictory;
        for kind in alignment.relations {
            *self.relations.entry(kind).or_default() += 1;
        }
        for (&k, position) in members.iter().zip(alignment.positions) {
            coordinates.new[k][axis] = position;
        }
    }

    /// The members of a frame that lie on a circle about another one and are not placed by numbers.
    fn circles(&self, coordinates: &FrameCoordinates<'_>) -> Vec<OnCircle> {
        let mut found: Vec<OnCircle> = Vec::new();
        let mut is_found = vec![false; coordinates.written.len()];
        for axis in 0..3 {
            for circle in self.circles_about(coordinates, axis) {
                if !std::mem::replace(&mut is_found[circle.member], true) {
                    found.push(circle);
                }
            }
        }
        let numbers = [0, 1, 2].map(|axis| self.sorted_numbers(coordinates, axis, &is_found));
        found.retain(|circle| {
            !is_found[circle.centre] && !self.has_place(coordinates, circle, &numbers)
        });
        found
    }

    /// The members that lie on a circle about an axis.
    fn circles_about(&self, coordinates: &FrameCoordinates<'_>, axis: usize) -> Vec<OnCircle> {
        let all = 0..coordinates.written.len();
        let rounds = all.filter_map(|k| Some((k, self.round(coordinates, axis, k)?)));
        let mut rounds: Vec<(usize, Round<'_>)> = rounds.collect();
        rounds.sort_by(|a, b| a.1.centre[0].total_cmp(&b.1.centre[0]));
        let largest = rounds.iter().map(|r| r.1.size()).fold(0.0, f64::max);
        let coarsest = rounds.iter().map(|r| r.1.errors[0]).fold(0.0, f64::max);
        let mut found = Vec::new();
        for (centre, round) in &rounds {
            let Some(reach) = round.reach() else {
                continue;
            };
            let reach = reach + largest + 2.0 * coarsest;
            let start = rounds.partition_point(|r| r.1.centre[0] < round.centre[0] - reach);
            let near = rounds[start..].iter();
            let near = near.take_while(|r| r.1.centre[0] <= round.centre[0] + reach);
            for (member, other) in near.filter(|r| r.0 != *centre) {
                found.extend(round.circle(other).map(|radius| OnCircle {
                    centre: *centre,
                    member: *member,
                    axis,
                    radius,
                }));
            }
        }
        found.sort_by_key(|circle| (circle.centre, circle.member));
        found
    }

    /// The numbers along an axis, in their order, of members that are on no circle.
    fn sorted_numbers(
        &self,
        coordinates: &FrameCoordinates<'_>,
        axis: usize,
        is_on_circle: &[bool],
    ) -> Vec<f64> {
        let others = (0..is_on_circle.len()).filter(|k| !is_on_circle[*k]);
        let mut all: Vec<f64> = others
            .flat_map(|k| self.numbers_of(coordinates, k, axis))
            .collect();
        all.sort_by(f64::total_cmp);
        all
    }

    /// The numbers of a member along an axis.
    fn numbers_of(&self, coordinates: &FrameCoordinates<'_>, k: usize, axis: usize) -> Vec<f64> {
        let member = &coordinates.frame.members[k];
        let own = &coordinates.written[k][axis];
        let all = self.numbers(member.leaf, member.axes[axis]);
        all.iter().map(|f| to_f64(&(own + &f.offset))).collect()
    }

    /// A member as a primitive of revolution about an axis of the frame.
    fn round(
        &self,
        coordinates: &FrameCoordinates<'_>,
        axis: usize,
        k: usize,
    ) -> Option<Round<'t>> {
        let member = &coordinates.frame.members[k];
        let placed = self.leaves[member.leaf].1;
        let used = member.axes[axis];
        let is_sphere = member.axes.iter().all(|a| a.local == LocalAxis::Across);
        let across = [(axis + 1) % 3, (axis + 2) % 3];
        let is_round = across
            .iter()
            .all(|&i| member.axes[i].local == LocalAxis::Across);
        let is_along = is_round && used.local == LocalAxis::Along(2);
        if !(is_sphere || is_along) {
            return None;
        }
        let written = &coordinates.written[k];
        let errors = &coordinates.errors[k];
        Some(Round {
            primitive: &placed.primitive,
            is_reversed: used.is_reversed,
            centre: across.map(|i| to_f64(&written[i])),
            along: to_f64(&written[axis]),
            errors: [errors[across[0]], errors[across[1]], errors[axis]],
        })
    }

    /// Whether numbers of members that are on no circle determine the place of one across the axis.
    fn has_place(
        &self,
        coordinates: &FrameCoordinates<'_>,
        circle: &OnCircle,
        others: &[Vec<f64>; 3],
    ) -> bool {
        let across = [(circle.axis + 1) % 3, (circle.axis + 2) % 3];
        across.iter().all(|&axis| {
            let error = 2.0 * coordinates.errors[circle.member][axis];
            let own = self.numbers_of(coordinates, circle.member, axis);
            own.iter().any(|x| {
                let next = others[axis].partition_point(|y| *y < x - error);
                others[axis].get(next).is_some_and(|y| *y <= x + error)
            })
        })
    }

    /// Moves a member onto its circle.
    fn place_on_circle(&mut self, circle: &OnCircle, coordinates: &mut FrameCoordinates<'_>) {
        let across = [(circle.axis + 1) % 3, (circle.axis + 2) % 3];
        let centre = across.map(|i| {
            let new = &coordinates.new[circle.centre][i];
            new.clone()
                .unwrap_or_else(|| coordinates.written[circle.centre][i].clone())
        });
        let written = across.map(|i| coordinates.written[circle.member][i].clone());
        let direction: [f64; 2] = std::array::from_fn(|i| to_f64(&(&written[i] - &centre[i])));
        let Some(at) = at_radius(&circle.radius, direction) else {
            return;
        };
        let place: [Rational; 2] = std::array::from_fn(|i| &centre[i] + &at[i]);
        let moved = |i: usize| to_f64(&(&place[i] - &written[i])).abs();
        let error = |i: usize| coordinates.errors[circle.member][across[i]];
        let most = 2.0 * error(0).hypot(error(1));
        if moved(0).hypot(moved(1)) > most {
            self.contradictory += 1;
            return;
        }
        *self
            .relations
            .entry(PrimitiveRelation::OnCircle)
            .or_default() += 1;
        for (i, x) in across.into_iter().zip(place) {
            coordinates.new[circle.member][i] = Some(x);
        }
    }

    /// The tree with the new positions; `None` if no relation was destroyed.
    pub fn recovery(self, tree: &Tree, rounding: Rounding) -> Option<Recovery> {
        if self.relations.is_empty() {
            return None;
        }
        let mut recovered = tree.clone();
        let (mut moved, mut furthest) = (0, 0.0f64);
        for ((id, placed), motion) in self.leaves.iter().zip(self.motions) {
            let Some(motion) = motion.filter(|motion| *motion != placed.motion) else {
                continue;
            };
            let by = motion.translation_f64() - placed.motion.translation_f64();
            (moved, furthest) = (moved + 1, furthest.max(by.norm()));
            let primitive = placed.primitive.clone();
            recovered.nodes[id.index()] = TreeNode::Leaf(PlacedPrimitive { primitive, motion });
        }
        let counts = self.relations.into_iter();
        Some(Recovery {
            transforms: self.transforms,
            tree: recovered,
            rounding,
            relations: counts
                .map(|(kind, count)| PrimitiveRelationCount { kind, count })
                .collect(),
            contradictory: self.contradictory,
            moved,
            furthest,
        })
    }
}
