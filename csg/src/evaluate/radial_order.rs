//! The radial order of the carriers' half sheets around a piece.
//!
//! Half sheets are sorted by their angles and, where they are tangent, by their bends. Within the
//! resolution neither may be conclusive: carriers may lie close to the piece rather than on it, or
//! nearly coincide over the whole piece. Then the surfaces themselves are compared just outside the
//! resolution. Two that coincide within it need not be tangent in the piece, and their bends there
//! say nothing about where they separate.

use super::arrangement::Arrangement;
use super::edge_candidates::EdgeCandidate;
use super::error::EvaluationError;
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::topology::Sense;
use premio_kernel::geometry::frame::perpendicular;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::{Length, rounded};
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates, Side};

/// One of the two half sheets of a carrier at a point of a piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfSheet<N: Float = f64> {
    /// The carrier, by its index among the piece's carriers.
    pub carrier: usize,
    /// The direction away from the piece.
    pub direction: Vector3<N>,
    /// Its angle about the tangent.
    angle: N,
    /// The rate at which it turns counterclockwise with the distance.
    bend: N,
    /// The side of the carrier just counterclockwise of the half sheet.
    pub beyond: Sense,
}

/// A sheet at which material begins or ends.
#[derive(Clone, Copy)]
pub(super) struct MaterialChange {
    /// The index of the sheet.
    pub sheet: usize,
    /// Whether there is material beyond it.
    pub after: bool,
}

/// The direction in which a carrier leaves a piece.
struct Axis<N: Float = f64> {
    carrier: usize,
    /// The direction across the piece.
    direction: Vector3<N>,
    /// Its curvature in that direction, positive counterclockwise.
    rise: N,
}

impl<N: Float> Axis<N> {
    /// The direction or its opposite, whichever is closer to another one.
    fn aligned(&self, direction: &Vector3<N>) -> Vector3<N> {
        self.direction * self.direction.dot(direction).signum()
    }
}

/// The sine of the angle below which two sheets may cross farther from a piece than the resolution,
/// although both contain it.
const SHALLOW: f64 = 1.0 / (1 << 8) as f64;

/// A point of a piece at which its carriers are sorted.
pub(super) struct Spot<'a, N: Float = f64> {
    pub arrangement: &'a Arrangement<N>,
    pub predicates: &'a Predicates,
    pub piece: &'a EdgeCandidate<N>,
    pub point: Point3<N>,
    /// The unit tangent of the piece.
    pub tangent: Vector3<N>,
}

impl<N: Float> Spot<'_, N> {
    /// The half sheets around the piece, counterclockwise about its tangent. Only those are included
    /// on which a primitive present there may have a face, by the index of the carrier in the piece
    /// and the direction away from it: where others lie within the resolution is of no effect.
    pub(super) fn sheets(
        &self,
        may_have_face: impl Fn(usize, &Vector3<N>) -> bool,
    ) -> Result<Vec<HalfSheet<N>>, EvaluationError> {
        let carriers = &self.piece.carriers;
        let mut sheets = Vec::with_capacity(2 * carriers.len());
        // A carrier tangent to an earlier one takes its angle, so that only the bend separates
        // them.
        let mut axes: Vec<Axis<N>> = Vec::new();
        for (at, &carrier) in carriers.iter().enumerate() {
            let direction = self.across(carrier);
            let ways = [direction, -direction];
            let present = ways.map(|way| may_have_face(at, &way));
            if present == [false, false] {
                continue;
            }
            let direction = self.aligned(carrier, direction, &mut axes);
            for (way, present) in [direction, -direction].into_iter().zip(present) {
                if present {
                    sheets.push(self.sheet(at, way));
                }
            }
        }
        sheets.sort_by(|a, b| a.angle.total_cmp(&b.angle).then(a.bend.total_cmp(&b.bend)));
        let has_touching = self.has_touching(&sheets);
        if carriers.len() > 2 || has_touching {
            self.settle(&mut sheets)?;
        }
        Ok(sheets)
    }

    /// The unit direction in a carrier across the piece.
    fn across(&self, carrier: usize) -> Vector3<N> {
        let normal = self.surface(carrier).normal(&self.point);
        normal.cross(&self.tangent).unit()
    }

    /// The curvature of a carrier in a direction, positive counterclockwise.
    fn rise(&self, carrier: usize, direction: &Vector3<N>) -> N {
        let surface = self.surface(carrier);
        let up = surface
            .normal(&self.point)
            .dot(&self.tangent.cross(direction));
        -surface.normal_curvature(&self.point, direction) * up.signum()
    }

    /// The direction of an earlier carrier that one touches, or its own, which is added to these.
    fn aligned(
        &self,
        carrier: usize,
        direction: Vector3<N>,
        axes: &mut Vec<Axis<N>>,
    ) -> Vector3<N> {
        let rise = |direction: &Vector3<N>| self.rise(carrier, direction);
        if let Some(axis) = axes
            .iter()
            .find(|a| self.touches(a, carrier, &direction, rise))
        {
            return axis.aligned(&direction);
        }
        axes.push(Axis {
            carrier,
            direction,
            rise: rise(&direction),
        });
        direction
    }

    /// The half sheet of the carrier of an index in the piece, in a direction.
    fn sheet(&self, at: usize, direction: Vector3<N>) -> HalfSheet<N> {
        let carrier = self.piece.carriers[at];
        let e1 = perpendicular(&self.tangent);
        let e2 = self.tangent.cross(&e1);
        let normal = self.surface(carrier).normal(&self.point);
        let up = normal.dot(&self.tangent.cross(&direction));
        HalfSheet {
            carrier: at,
            direction,
            angle: direction.dot(&e2).atan2(direction.dot(&e1)),
            bend: self.rise(carrier, &direction),
            beyond: match up.is_above_zero() {
                true => Sense::Against,
                false => Sense::Along,
            },
        }
    }

    /// Whether two consecutive sheets of one angle have bends that the resolution does not separate.
    fn has_touching(&self, sheets: &[HalfSheet<N>]) -> bool {
        let reach = self.piece.reach(self.arrangement);
        let mut touching = false;
        for pair in sheets.windows(2) {
            let gap = (pair[1].bend - pair[0].bend).abs() * reach * reach;
            let place = rounded(&self.point);
            touching |= pair[0].angle.is_exactly(pair[1].angle)
                && self.predicates.classify("sheets that touch", gap, place) == Side::On;
        }
        touching
    }

    /// Sorts sheets that angles and bends do not separate. Such sheets start close to the piece
    /// rather than at it, within the resolution, or differ by less than the resolution over their
    /// length. They are sorted by the order of the surfaces just outside the resolution of the
    /// piece, where other pieces may be.
    fn settle(&self, sheets: &mut [HalfSheet<N>]) -> Result<(), EvaluationError> {
        // Sheets of nearly the same direction must be adjacent.
        let n = sheets.len();
        let gap = |i: usize| match i {
            0 => sheets[0].angle + N::TAU - sheets[n - 1].angle,
            _ => sheets[i].angle - sheets[i - 1].angle,
        };
        let widest = (0..n).max_by(|&i, &j| gap(i).total_cmp(&gap(j)));
        sheets.rotate_left(widest.unwrap_or(0));
        let reach = self.piece.reach(self.arrangement);
        let is_swapped = |a: &HalfSheet<N>, b: &HalfSheet<N>| {
            let sine = a.direction.cross(&b.direction).length();
            let is_shallow = a.direction.dot(&b.direction).is_above_zero()
                && sine.is_short_of(N::from_f64(SHALLOW));
            let gap = (a.bend - b.bend) * reach * reach;
            let is_one = a.angle.is_exactly(b.angle);
            let both = [a, b].map(|s| self.piece.carriers[s.carrier]);
            if a.carrier == b.carrier || !is_shallow {
                Some(false)
            } else if !is_one && self.are_crossing_planes(both) {
                // They are in the order of their angles, also where rounding hides it nearby.
                Some(false)
            } else if is_one && self.is_tangent_along(both) && !self.predicates.within(gap) {
                Some(gap.is_above_zero())
            } else {
                self.lies_beyond([a, b], is_one)
            }
        };
        // Insertion sort: an order within the resolution need not be total.
        for end in 1..n {
            for i in (0..end).rev() {
                match is_swapped(&sheets[i], &sheets[i + 1]) {
                    Some(true) => sheets.swap(i, i + 1),
                    Some(false) => break,
                    None => {
                        return Err(EvaluationError::AmbiguousEdgeOrder {
                            place: rounded(&self.point),
                        });
                    }
                }
            }
        }
        Ok(())
    }

    /// Whether a sheet lies counterclockwise of another that leaves in nearly the same direction.
    /// They are compared at the resolution's distance. If rounding hides the order there, they are
    /// compared farther out: as far as the angle between them decides, or if they coincide within the
    /// resolution, over half their length.
    fn lies_beyond(&self, [a, b]: [&HalfSheet<N>; 2], is_one: bool) -> Option<bool> {
        let [first, second] = [a, b].map(|s| self.surface(self.piece.carriers[s.carrier]));
        let (reach, out) = (self.piece.reach(self.arrangement), b.beyond.sign::<N>());
        let sine = a.direction.cross(&b.direction).length();
        let decided_by_angle = sine / (N::from_f64(4.0) * (a.bend - b.bend).abs());
        let farthest = match is_one {
            true => N::HALF * reach,
            false => (N::HALF * reach).min(decided_by_angle),
        };
        let offset = |step: N| {
            let q = self.point + a.direction * step;
            let q = q - first.normal(&q) * first.distance(&q);
            -out * second.distance(&q)
        };
        let resolution = self.predicates.resolution::<N>();
        let rounding = N::ROUNDING * (reach + self.point.coords.length());
        let steps = std::iter::successors(Some(resolution), |step| Some(N::TWO * *step));
        let mut offsets = steps
            .take_while(|step| step.is_exactly(resolution) || step.is_short_of(farthest))
            .map(offset);
        offsets
            .find(|away| away.abs().is_beyond(rounding))
            .map(N::is_above_zero)
    }

    /// Whether a carrier that leaves a piece in a direction is tangent to an earlier one: along the
    /// entire piece, by their angle, or as far as their distance is within the resolution.
    fn touches(
        &self,
        axis: &Axis<N>,
        carrier: usize,
        direction: &Vector3<N>,
        rise: impl Fn(&Vector3<N>) -> N,
    ) -> bool {
        let tangent = self.is_tangent_along([axis.carrier, carrier]);
        // Two carriers that intersect in the piece only cross there, at however small an angle,
        // unless their curve is one of tangency.
        if tangent || self.piece.carriers.len() == 2 {
            return tangent;
        }
        let sine = axis.direction.cross(direction).length();
        let bend = (rise(&axis.direction) - axis.rise).abs();
        self.predicates
            .within(sine * self.piece.reach(self.arrangement))
            || self.predicates.within(sine * sine / (N::TWO * bend))
    }

    /// Whether two carriers are planes whose line is the piece's.
    fn are_crossing_planes(&self, [a, b]: [usize; 2]) -> bool {
        let is_plane = |c: usize| matches!(self.surface(c), Surface::Plane(_));
        let mut crossing = self.piece.crossing.iter();
        is_plane(a) && is_plane(b) && crossing.any(|pair| *pair == [a.min(b), a.max(b)])
    }

    /// Whether two carriers are tangent along the entire piece, by their intersection curve.
    fn is_tangent_along(&self, [a, b]: [usize; 2]) -> bool {
        let mut tangent = self.piece.tangent.iter();
        tangent.any(|t| *t == [a, b] || *t == [b, a])
    }

    /// Whether two carriers that are not tangent along the piece, but within the resolution, continue
    /// through it as faces, both with material on one side. Their order at the piece says nothing about that
    /// at neighbouring pieces.
    pub(super) fn has_doubtful_order(
        &self,
        sheets: &[HalfSheet<N>],
        changes: &[MaterialChange],
    ) -> bool {
        let of = |c: &MaterialChange| &sheets[c.sheet];
        let side = |c: &MaterialChange| (of(c).beyond == Sense::Along) == c.after;
        let mut through: Vec<&HalfSheet<N>> = Vec::new();
        let mut rest = changes;
        while let Some((a, later)) = rest.split_first() {
            let mut same = later.iter().filter(|b| of(b).carrier == of(a).carrier);
            if same.any(|b| side(b) == side(a)) {
                through.push(of(a));
            }
            rest = later;
        }
        let mut rest = &through[..];
        while let Some((a, others)) = rest.split_first() {
            let is_doubtful = |b: &&HalfSheet<N>| {
                let sine = a.direction.cross(&b.direction).length();
                let both = [a, *b].map(|s| self.piece.carriers[s.carrier]);
                sine.is_exactly(N::ZERO) && !self.is_tangent_along(both)
            };
            if others.iter().any(is_doubtful) {
                return true;
            }
            rest = others;
        }
        false
    }

    fn surface(&self, carrier: usize) -> &Surface<N> {
        &self.arrangement.carriers[carrier]
    }
}
