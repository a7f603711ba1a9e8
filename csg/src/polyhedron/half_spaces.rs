//! Convex polyhedra as the intersection of a box with half-spaces.

use super::convex_hull::polygon;
use super::{Polyhedron, PolyhedronFace, SpacePoint, dot};
use premio_kernel::number::rational::Rational;
use std::cmp::Ordering;
use std::collections::{BTreeSet, HashMap};

/// The half-space n · p <= d.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HalfSpace {
    /// The outward normal n.
    pub normal: SpacePoint,
    /// The offset d.
    pub offset: Rational,
}

impl Polyhedron {
    /// The intersection of a box, by the range of each coordinate, with half-spaces; `None` if it has no
    /// inner point.
    pub(crate) fn intersection(
        ranges: &[[Rational; 2]; 3],
        half_spaces: &[HalfSpace],
    ) -> Option<Self> {
        let mut all = half_spaces.iter();
        all.try_fold(Self::cuboid(ranges), Self::cut)
    }

    /// An axis-aligned cuboid. Bit i of a corner's index is the end of the range of coordinate i.
    fn cuboid(ranges: &[[Rational; 2]; 3]) -> Self {
        let corner = |k: usize| std::array::from_fn(|i| ranges[i][k >> i & 1].clone());
        let face = |axis: usize, side: usize| {
            let [i, j] = [(axis + 1) % 3, (axis + 2) % 3].map(|i| 1 << i);
            let around = match side {
                0 => [0, j, i + j, i],
                _ => [0, i, i + j, j],
            };
            PolyhedronFace::simple(around.map(|k| k + (side << axis)).to_vec())
        };
        let faces = (0..3).flat_map(|axis| [0, 1].map(|side| face(axis, side)));
        Self {
            points: (0..8).map(corner).collect(),
            faces: faces.collect(),
        }
    }

    /// The part of a convex polyhedron in a half-space; `None` if it has no inner point.
    fn cut(mut self, half_space: &HalfSpace) -> Option<Self> {
        let excess = |p: &SpacePoint| dot(&half_space.normal, p) - &half_space.offset;
        let levels: Vec<Rational> = self.points.iter().map(excess).collect();
        let has = |sign: Ordering| levels.iter().any(|x| x.cmp(&Rational::ZERO) == sign);
        if !has(Ordering::Less) {
            return None;
        }
        if !has(Ordering::Greater) {
            return Some(self);
        }
        let mut section = Section {
            levels: &levels,
            points: &mut self.points,
            crossings: HashMap::new(),
            corners: BTreeSet::new(),
        };
        let outlines = self.faces.iter().flat_map(|face| &face.loops);
        let cut = outlines.map(|outline| section.cut(outline));
        let mut faces: Vec<Vec<usize>> = cut.filter(|rest| rest.len() > 2).collect();
        let corners = section.corners.into_iter().collect();
        faces.push(polygon(corners, &half_space.normal, |i| &self.points[i]));
        let faces = faces.into_iter().map(PolyhedronFace::simple);
        Some(Self::compact(&self.points, faces.collect()))
    }
}

/// The section of a convex polyhedron by a plane, as far as it is known.
struct Section<'a> {
    /// How far each point is outside, in some unit.
    levels: &'a [Rational],
    points: &'a mut Vec<SpacePoint>,
    /// The points in which edges cross the plane, by their ends.
    crossings: HashMap<[usize; 2], usize>,
    corners: BTreeSet<usize>,
}

impl Section<'_> {
    /// The part of a face that is inside.
    fn cut(&mut self, face: &[usize]) -> Vec<usize> {
        let mut rest = Vec::with_capacity(face.len() + 1);
        let ends = face.iter().cycle().skip(1);
        for (&from, &to) in face.iter().zip(ends) {
            let [a, b] = [from, to].map(|i| self.levels[i].cmp(&Rational::ZERO));
            if a.is_le() {
                rest.push(from);
            }
            if a.is_eq() {
                self.corners.insert(from);
            } else if b.is_ne() && a != b {
                let crossing = self.crossing([from.min(to), from.max(to)]);
                rest.push(crossing);
                self.corners.insert(crossing);
            }
        }
        rest
    }

    fn crossing(&mut self, [from, to]: [usize; 2]) -> usize {
        if let Some(&known) = self.crossings.get(&[from, to]) {
            return known;
        }
        let [a, b] = [from, to].map(|i| &self.levels[i]);
        let part = a / (a - b);
        let [p, q] = [from, to].map(|i| &self.points[i]);
        let point = std::array::from_fn(|i| &p[i] + (&q[i] - &p[i]) * &part);
        self.points.push(point);
        let place = self.points.len() - 1;
        self.crossings.insert([from, to], place);
        place
    }
}
