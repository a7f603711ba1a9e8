//! The curves in which consecutive walls of a section meet.
//!
//! Where two walls are tangent within the resolution, the intersection of their carriers gives the
//! middle of the strip in which they coincide. The walls end at the edge's end of the figure, which
//! may be elsewhere in the strip.

use super::distinct_surfaces::CarrierSide;
use super::halfspaces::HalfSpaceModel;
use super::region::WalledRegion;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::curve_surface::lies_on;
use premio_kernel::geometry::intersect::Branch;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::Length;
use premio_kernel::hash::HashMap;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use premio_kernel::number::probes::probes;

/// The joints of all walls, by their carriers.
pub(super) struct WallJoints<N: Float> {
    curves: HashMap<[usize; 2], Vec<Curve<N>>>,
}

impl<N: Float> WallJoints<N> {
    /// The joints of all primitives, whose half spaces have the given carriers.
    pub fn new(solids: &HalfSpaceModel<N>, sides: &[Vec<CarrierSide>]) -> Self {
        let mut curves: HashMap<[usize; 2], Vec<Curve<N>>> = HashMap::default();
        for (solid, sides) in solids.all.iter().zip(sides) {
            let Some(WalledRegion::Section(section)) = &solid.region else {
                continue;
            };
            for joint in section.joints() {
                let mut pair = joint.sides.map(|side| sides[side].carrier);
                pair.sort_unstable();
                if pair[0] != pair[1] {
                    curves.entry(pair).or_default().push(joint.curve);
                }
            }
        }
        Self { curves }
    }

    /// A contact moved to the joint of two walls in its strip; `None` if there is none.
    pub fn contact_at_joint(
        &self,
        pair: [usize; 2],
        contact: &Branch<N>,
        carriers: [&Surface<N>; 2],
        predicates: &Predicates,
    ) -> Option<Branch<N>> {
        let joints = self.curves.get(&pair)?.iter();
        let moved = joints.filter_map(|joint| {
            let strip = Strip {
                contact,
                joint,
                range: joint_range(contact, joint)?,
                carriers,
                predicates,
            };
            Some((strip.width()?, joint, strip.range))
        });
        let nearest = moved.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.map(|(_, joint, range)| Branch {
            curve: joint.clone(),
            range,
            ..contact.clone()
        })
    }
}

/// The range of a joint along a contact of the same kind.
fn joint_range<N: Float>(contact: &Branch<N>, joint: &Curve<N>) -> Option<[N; 2]> {
    match (&contact.curve, joint) {
        (Curve::Circle(_), Curve::Circle(_)) => Some(contact.range),
        (Curve::Line(own), Curve::Line(other)) => {
            let [a, b] = contact
                .range
                .map(|t| joint.parameter(&contact.curve.point(t)));
            let is_reversed = own.direction.dot(&other.direction).is_below_zero();
            Some(if is_reversed { [b, a] } else { [a, b] })
        }
        _ => None,
    }
}

/// The points between a contact of two carriers and a joint.
struct Strip<'a, N: Float> {
    contact: &'a Branch<N>,
    joint: &'a Curve<N>,
    /// The range of the joint.
    range: [N; 2],
    carriers: [&'a Surface<N>; 2],
    predicates: &'a Predicates,
}

impl<N: Float> Strip<'_, N> {
    /// Its width, if both carriers coincide in it.
    fn width(&self) -> Option<N> {
        let resolution = self.predicates.resolution();
        let is_on = |s: &&Surface<N>| lies_on(self.joint, self.range, s, resolution);
        if !self.carriers.iter().all(is_on) {
            return None;
        }
        let mut width = N::ZERO;
        let [lo, hi] = self.contact.range;
        for part in probes().chain([N::ZERO, N::ONE]) {
            let p = self.contact.curve.point(lo + (hi - lo) * part);
            let lateral = self.joint.point(self.joint.parameter(&p)) - p;
            let middle = p + lateral * N::HALF;
            let mut carriers = self.carriers.iter();
            if !carriers.all(|s| self.predicates.within(s.distance(&middle))) {
                return None;
            }
            width = width.max(lateral.length());
        }
        Some(width)
    }
}
