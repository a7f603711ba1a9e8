//! Contacts: curves along which two carriers are tangent, where another curve runs close by.
//!
//! Tangent carriers are within the resolution of each other over a strip. A curve of one of them
//! and a third carrier inside the strip lies on both. The contact may then be moved to that curve,
//! whose position is accurate. Two curves that bounded a strip too narrow to be resolved would
//! leave its faces without an order.

use super::arrangement::{Arrangement, IntersectionCurve};
use nalgebra::Point3;
use premio_kernel::geometry::curve_surface::lies_on;
use premio_kernel::geometry::vector::Length;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use premio_kernel::number::probes::probes;

impl<N: Float> Arrangement<N> {
    /// Moves contacts to curves that run inside their strips.
    pub(super) fn settle_contacts(&mut self, predicates: &Predicates) {
        let mut settled = vec![false; self.meetings.len()];
        for i in 0..self.meetings.len() {
            let contact = &self.meetings[i];
            let [both] = contact.tangent[..] else {
                continue;
            };
            // A contact that has already been moved stays. One that crosses other curves is
            // accurate at the crossings.
            if contact.carriers[..] != both || !contact.cuts.is_empty() {
                continue;
            }
            let nearest = (0..self.meetings.len())
                .filter(|&j| !settled[j])
                .filter_map(|j| Some((self.strip(both, i, j, predicates)?, j)))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((_, j)) = nearest {
                self.meetings[j].tangent.push(both);
                settled[i] = true;
            }
        }
        let mut settled = settled.into_iter();
        self.meetings.retain(|_| settled.next() == Some(false));
    }

    /// The width of the strip between the contact of two carriers and another curve of one of them,
    /// if that runs along all of it and is a different curve.
    fn strip(
        &self,
        both: [usize; 2],
        contact: usize,
        other: usize,
        predicates: &Predicates,
    ) -> Option<N> {
        let (contact, other) = (&self.meetings[contact], &self.meetings[other]);
        let third = both.map(|c| !other.carriers.contains(&c));
        if third[0] == third[1] {
            return None;
        }
        let carriers = both.map(|c| &self.carriers[c]);
        let missing = carriers[usize::from(third[1])];
        if !lies_on(&other.curve, other.range, missing, predicates.resolution()) {
            return None;
        }
        let mut width: N = N::ZERO;
        let [lo, hi] = contact.range;
        for part in probes().chain([N::ZERO, N::ONE]) {
            let t = lo + (hi - lo) * part;
            let p = contact.curve.point(t);
            let lateral = other.closest(&p, predicates.reach())? - p;
            let along = lateral.dot(&contact.curve.tangent(t)).abs();
            let middle = p + lateral * N::HALF;
            let inside = carriers
                .iter()
                .all(|s| predicates.within(s.distance(&middle)));
            let across = lateral.length() + predicates.reach::<N>();
            if !inside || (N::TWO * along).is_beyond(across) {
                return None;
            }
            width = width.max(lateral.length());
        }
        (!predicates.within(width)).then_some(width)
    }
}

impl<N: Float> IntersectionCurve<N> {
    /// The point of the curve closest to `p`, unless that is beyond the ends by more than `reach`.
    fn closest(&self, p: &Point3<N>, reach: N) -> Option<Point3<N>> {
        let [lo, hi] = self.range;
        let t = self.curve.in_cycle(self.curve.parameter(p), lo);
        let q = self.curve.point(t.clamp(lo, hi));
        let beyond = (q - self.curve.point(t)).length();
        beyond.is_within(reach).then_some(q)
    }
}
