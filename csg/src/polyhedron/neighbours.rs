//! Which faces touch each other at their common corners only.

use super::orientation::{FilteredPoint, are_in_line, cross, difference, dot, orientation};
use super::{Polyhedron, PolyhedronFace, SpacePoint};
use premio_kernel::number::rational::Rational;
use std::cmp::Ordering;

/// The most faces around a corner that are compared with each other.
const MAX_FACES_AROUND: usize = 256;

impl Polyhedron {
    /// For each face the others that share corners with it and are known to touch it only there, or
    /// along a common edge; in increasing order.
    pub(crate) fn neighbours(&self) -> Vec<Vec<usize>> {
        let points: Vec<FilteredPoint> = self.points.iter().map(FilteredPoint::new).collect();
        let mut around = vec![Vec::new(); points.len()];
        for (index, face) in self.faces.iter().enumerate() {
            for corner in face.corners() {
                around[corner].push(index);
            }
        }
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for faces in around {
            if faces.len() > MAX_FACES_AROUND {
                continue;
            }
            for (k, &a) in faces.iter().enumerate() {
                let others = faces[k + 1..].iter().filter(|&&b| b != a);
                pairs.extend(others.map(|&b| [a.min(b), a.max(b)]));
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let faces = self.faces.iter();
        let planes: Vec<Option<[usize; 3]>> = faces.map(|face| plane_of(face, &points)).collect();
        let mut neighbours = vec![Vec::new(); self.faces.len()];
        for pair in pairs {
            let [a, b] = pair;
            let of_pair = FacePair {
                points: &points,
                faces: pair.map(|face| &self.faces[face]),
                planes: pair.map(|face| planes[face]),
            };
            if of_pair.touch_at_corners() {
                neighbours[a].push(b);
                neighbours[b].push(a);
            }
        }
        for of in &mut neighbours {
            of.sort_unstable();
        }
        neighbours
    }
}

/// Three corners of a face that are not in line; of a triangle, in its order.
pub(super) fn plane_of(face: &PolyhedronFace, points: &[FilteredPoint]) -> Option<[usize; 3]> {
    let [first, second, others @ ..] = &face.loops.first()?[..] else {
        return None;
    };
    let is_off = |third: &&usize| !are_in_line([first, second, *third].map(|&i| &points[i]));
    let third = others.iter().find(is_off)?;
    Some([*first, *second, *third])
}

/// Two faces that share a corner.
struct FacePair<'a> {
    points: &'a [FilteredPoint],
    faces: [&'a PolyhedronFace; 2],
    /// Three corners of each that are not in line.
    planes: [Option<[usize; 3]>; 2],
}

impl FacePair<'_> {
    fn touch_at_corners(&self) -> bool {
        let [a, b] = self.faces;
        let is_of_b = |corner: &usize| b.corners().any(|other| other == *corner);
        let mut shared: Vec<usize> = a.corners().filter(is_of_b).collect();
        shared.sort_unstable();
        shared.dedup();
        let swapped = FacePair {
            points: self.points,
            faces: [b, a],
            planes: [self.planes[1], self.planes[0]],
        };
        match shared[..] {
            [corner] => {
                self.is_on_one_side(&shared)
                    || swapped.is_on_one_side(&shared)
                    || self.misses(corner)
                    || swapped.misses(corner)
            }
            [i, j] => {
                let has_edge = |face: &PolyhedronFace| {
                    face.edges().any(|edge| edge == [i, j] || edge == [j, i])
                };
                let is_apart = self.is_on_one_side(&shared) || swapped.is_on_one_side(&shared);
                has_edge(a) && has_edge(b) && is_apart
            }
            _ => false,
        }
    }

    /// The side of the second face's plane on which a corner lies.
    fn side(&self, corner: usize) -> Option<Ordering> {
        let [a, b, c] = self.planes[1]?.map(|i| &self.points[i]);
        Some(orientation([a, b, c, &self.points[corner]]))
    }

    /// Whether all other corners of the first face are strictly on one side of the second one's
    /// plane.
    fn is_on_one_side(&self, shared: &[usize]) -> bool {
        let others = self.faces[0].corners().filter(|i| !shared.contains(i));
        let mut sides = others.map(|corner| self.side(corner));
        let Some(Some(first)) = sides.next() else {
            return false;
        };
        first != Ordering::Equal && sides.all(|side| side == Some(first))
    }

    /// Whether the first face, a triangle, cuts the plane of the second one along a segment from the
    /// common corner that lies outside the second face, a triangle.
    fn misses(&self, corner: usize) -> bool {
        let [Some(own), Some(other)] = self.planes else {
            return false;
        };
        if self.faces.iter().any(|face| face.corners().count() != 3) {
            return false;
        }
        let from = |of: [usize; 3]| {
            let at = of.iter().position(|&i| i == corner)?;
            Some([of[(at + 1) % 3], of[(at + 2) % 3]])
        };
        let (Some(ends), Some(wedge)) = (from(own), from(other)) else {
            return false;
        };
        let apex = &self.points[corner];
        let away = |i: usize| difference(&self.points[i], apex);
        let (ends, [right, left]) = (ends.map(away), wedge.map(away));
        let normal = cross(&right, &left);
        let [h, k] = ends.each_ref().map(|end| dot(end, &normal));
        let [above, beyond] = [&h, &k].map(|height| height.cmp(&Rational::ZERO));
        let direction: SpacePoint = match (above.is_eq(), beyond.is_eq()) {
            (true, false) => ends[0].clone(),
            (false, true) => ends[1].clone(),
            // On one side the face touches the plane at the corner only.
            _ if above == beyond => return false,
            _ => std::array::from_fn(|i| (&ends[1][i] * &h - &ends[0][i] * &k) / (&h - &k)),
        };
        let is_left_of_right = dot(&cross(&right, &direction), &normal);
        let is_right_of_left = dot(&cross(&direction, &left), &normal);
        is_left_of_right < Rational::ZERO || is_right_of_left < Rational::ZERO
    }
}
