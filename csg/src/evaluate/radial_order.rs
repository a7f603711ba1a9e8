//! The half sheets of carriers around a piece, in order.
//!
//! Sheets start in directions that angles tell, and where they touch, bends. Within the resolution
//! neither may: there carriers lie next to a piece rather than on it, or along one another as far as
//! the piece reaches. Then the surfaces as they are tell the order, just out of the resolution: two
//! that are one there need not touch in the piece, and how they bend in it says nothing of where they
//! part.

use super::EvaluationError;
use super::arrangement::Arrangement;
use super::edge_candidates::EdgeCandidate;
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::topology::Sense;
use premio_kernel::geometry::frame::perpendicular;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::{Length, rounded};
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates, Side};

/// A half sheet of a carrier at a point of a piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct HalfSheet<N: Float = f64> {
    /// The carrier, as its place among the piece's carriers.
    pub carrier: usize,
    /// Away from the piece.
    direction: Vector3<N>,
    /// Its angle about the tangent.
    angle: N,
    /// How fast it turns counterclockwise with the distance.
    bend: N,
    /// The side of the carrier just counterclockwise of the sheet.
    pub beyond: Sense,
}

/// How a carrier leaves a piece.
struct Axis<N: Float = f64> {
    carrier: usize,
    /// Across the piece.
    direction: Vector3<N>,
    /// How it bends up, counterclockwise, in that direction.
    rise: N,
}

impl<N: Float> Axis<N> {
    /// Its direction, as near to another one as it can be.
    fn aligned(&self, direction: &Vector3<N>) -> Vector3<N> {
        self.direction * self.direction.dot(direction).signum()
    }
}

/// Sheets at a smaller angle may cross farther from a piece than the resolution, though both are on
/// it.
const SHALLOW: f64 = 1.0 / (1 << 8) as f64;

/// A point of a piece, from which its carriers are seen.
pub(super) struct Spot<'a, N: Float = f64> {
    pub arrangement: &'a Arrangement<N>,
    pub predicates: &'a Predicates,
    pub piece: &'a EdgeCandidate<N>,
    pub point: Point3<N>,
    /// Of the piece, a unit vector.
    pub tangent: Vector3<N>,
}

impl<N: Float> Spot<'_, N> {
    /// The half sheets around the piece, counterclockwise about its tangent, of the carriers (by
    /// their places among the piece's) on which a primitive that is there has a face.
    pub(super) fn sheets(
        &self,
        has_face: impl Fn(usize) -> bool,
    ) -> Result<Vec<HalfSheet<N>>, EvaluationError> {
        let Self {
            piece,
            point: p,
            tangent,
            ..
        } = self;
        let e1 = perpendicular(tangent);
        let e2 = tangent.cross(&e1);
        let mut sheets = Vec::with_capacity(2 * piece.carriers.len());
        // A carrier tangent to an earlier one takes its angle: only the bend tells them apart.
        let mut axes: Vec<Axis<N>> = Vec::new();
        for (at, &c) in piece.carriers.iter().enumerate() {
            if !has_face(at) {
                continue;
            }
            let surface = self.surface(c);
            let normal = surface.normal(p);
            let mut direction = normal.cross(tangent).unit();
            let rise = |direction: &Vector3<N>| {
                let up = normal.dot(&tangent.cross(direction));
                -surface.normal_curvature(p, direction) * up.signum()
            };
            match axes.iter().find(|a| self.touches(a, c, &direction, rise)) {
                Some(a) => direction = a.aligned(&direction),
                None => axes.push(Axis {
                    carrier: c,
                    direction,
                    rise: rise(&direction),
                }),
            }
            for d in [direction, -direction] {
                let l = tangent.cross(&d);
                let up = normal.dot(&l);
                sheets.push(HalfSheet {
                    carrier: at,
                    direction: d,
                    angle: d.dot(&e2).atan2(d.dot(&e1)),
                    bend: rise(&d),
                    beyond: if up.is_above_zero() {
                        Sense::Against
                    } else {
                        Sense::Along
                    },
                });
            }
        }
        sheets.sort_by(|a, b| a.angle.total_cmp(&b.angle).then(a.bend.total_cmp(&b.bend)));
        let reach = self.piece.reach(self.arrangement);
        let mut is_tied = piece.carriers.len() > 2;
        for pair in sheets.windows(2) {
            let gap = (pair[1].bend - pair[0].bend).abs() * reach * reach;
            is_tied |= pair[0].angle.is_exactly(pair[1].angle)
                && self
                    .predicates
                    .classify("sheets that touch", gap, rounded(p))
                    == Side::On;
        }
        if is_tied {
            self.settle(&mut sheets)?;
        }
        Ok(sheets)
    }

    /// Puts sheets in order whose angles and bends do not tell it: where they do not start at the
    /// piece but, within the resolution, next to it, or differ by less than the resolution as far as
    /// they reach. Their order is that of the surfaces just out of the piece's resolution, where
    /// other pieces may be.
    fn settle(&self, sheets: &mut [HalfSheet<N>]) -> Result<(), EvaluationError> {
        // What lies nearly in one direction is to stand together.
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
            } else if is_one && self.is_told_to_touch(both) && !self.predicates.within(gap) {
                Some(gap.is_above_zero())
            } else {
                self.lies_beyond([a, b], is_one)
            }
        };
        // By insertion: an order within the resolution need not be a total one.
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

    /// Whether a sheet lies counterclockwise of another that leaves in nearly the same direction, at
    /// the resolution's distance, or where rounding hides it there and they are one within the
    /// resolution, farther out.
    fn lies_beyond(&self, [a, b]: [&HalfSheet<N>; 2], is_one: bool) -> Option<bool> {
        let [first, second] = [a, b].map(|s| self.surface(self.piece.carriers[s.carrier]));
        let (reach, out) = (self.piece.reach(self.arrangement), b.beyond.sign::<N>());
        let farthest = if is_one { N::HALF * reach } else { N::ZERO };
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

    /// Whether a carrier that leaves a piece in a direction touches an earlier one: all along it, by
    /// their angle, or as near to it as they are apart.
    fn touches(
        &self,
        axis: &Axis<N>,
        carrier: usize,
        direction: &Vector3<N>,
        rise: impl Fn(&Vector3<N>) -> N,
    ) -> bool {
        let told = self.is_told_to_touch([axis.carrier, carrier]);
        // What meets in the piece alone crosses there, however little, unless it is told to touch.
        if told || self.piece.carriers.len() == 2 {
            return told;
        }
        let sine = axis.direction.cross(direction).length();
        let bend = (rise(&axis.direction) - axis.rise).abs();
        self.predicates
            .within(sine * self.piece.reach(self.arrangement))
            || self.predicates.within(sine * sine / (N::TWO * bend))
    }

    /// Whether two carriers touch all along the piece, by the curve in which they meet.
    fn is_told_to_touch(&self, [a, b]: [usize; 2]) -> bool {
        let mut told = self.piece.tangent.iter();
        told.any(|t| *t == [a, b] || *t == [b, a])
    }

    fn surface(&self, carrier: usize) -> &Surface<N> {
        &self.arrangement.carriers[carrier]
    }
}
