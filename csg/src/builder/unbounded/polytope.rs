//! The polytope that half-spaces of planes have in common inside a box, exactly.

use super::enclosure::Ball;
use super::enclosure::BoundingCell;
use crate::builder::Placement;
use crate::polyhedron::{Polyhedron, SpacePoint, dot};
use premio_kernel::number::rational::Rational;
use std::cmp::Ordering;

/// The half-space n · p <= d.
#[derive(Debug, Clone)]
pub(super) struct HalfSpace {
    pub normal: SpacePoint,
    pub offset: Rational,
}

impl HalfSpace {
    /// The half-space as a placement moves it.
    pub fn placed(&self, placement: &Placement) -> Self {
        let mut normal = self.normal.clone();
        if placement.mirrored {
            normal[1] = -&normal[1];
        }
        let normal = placement.motion.apply_vector(&normal);
        let offset = match &placement.factor {
            Some(factor) => &self.offset * factor,
            None => self.offset.clone(),
        };
        let moved = dot(&normal, placement.motion.offset());
        Self {
            offset: offset + moved,
            normal,
        }
    }

    /// How far a point is outside, in some unit.
    fn excess(&self, p: &SpacePoint) -> Rational {
        dot(&self.normal, p) - &self.offset
    }
}

/// What half-spaces have in common in a box around a ball.
#[derive(Debug, Clone)]
pub(super) enum Common {
    Nothing,
    Polytope(Polyhedron),
}

impl Common {
    /// What half-spaces have in common; `None` if the numbers of the box are beyond the range of f64.
    pub fn new(half_spaces: &[HalfSpace], ball: &Ball) -> Option<Self> {
        let mut faces = cube(ball)?;
        for half_space in half_spaces {
            match cut(faces, half_space) {
                Some(rest) => faces = rest,
                None => return Some(Self::Nothing),
            }
        }
        let points: Vec<SpacePoint> = faces.into_iter().flatten().collect();
        Polyhedron::convex_hull(&points).ok().map(Self::Polytope)
    }
}

fn difference(a: &SpacePoint, b: &SpacePoint) -> SpacePoint {
    std::array::from_fn(|i| &a[i] - &b[i])
}

/// The faces of a cube around a ball, as cycles of corners.
fn cube(ball: &Ball) -> Option<Vec<Vec<SpacePoint>>> {
    let BoundingCell(ranges) = ball.cube();
    let corner = |ends: [usize; 3]| -> [f64; 3] { std::array::from_fn(|i| ranges[i][ends[i]]) };
    let mut faces = Vec::with_capacity(6);
    for axis in 0..3 {
        let [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
        for side in [0, 1] {
            let around = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[p, q]| {
                let mut ends = [side; 3];
                (ends[i], ends[j]) = (p, q);
                ball.rounded(corner(ends))
            });
            faces.push(around.into_iter().collect::<Option<Vec<SpacePoint>>>()?);
        }
    }
    Some(faces)
}

/// A convex polyhedron, by the cycles of corners around its faces, cut by a half-space; `None` if no
/// inner point is left.
fn cut(faces: Vec<Vec<SpacePoint>>, half_space: &HalfSpace) -> Option<Vec<Vec<SpacePoint>>> {
    let levels: Vec<Vec<Rational>> = faces
        .iter()
        .map(|face| face.iter().map(|p| half_space.excess(p)).collect())
        .collect();
    let has = |sign: Ordering| {
        levels
            .iter()
            .flatten()
            .any(|x| x.cmp(&Rational::ZERO) == sign)
    };
    if !has(Ordering::Less) {
        return None;
    }
    if !has(Ordering::Greater) {
        return Some(faces);
    }
    let (mut kept, mut section) = (Vec::with_capacity(faces.len() + 1), Vec::new());
    for (face, levels) in faces.iter().zip(&levels) {
        let rest = cut_face(face, levels, &mut section);
        if rest.len() > 2 {
            kept.push(rest);
        }
    }
    kept.push(cycle(section, &half_space.normal));
    Some(kept)
}

/// The part of a face inside. Its points in the plane are added to the section.
fn cut_face(
    face: &[SpacePoint],
    levels: &[Rational],
    section: &mut Vec<SpacePoint>,
) -> Vec<SpacePoint> {
    let mut rest = Vec::with_capacity(face.len() + 1);
    for k in 0..face.len() {
        let next = (k + 1) % face.len();
        let (a, b) = (&levels[k], &levels[next]);
        if *a <= Rational::ZERO {
            rest.push(face[k].clone());
        }
        if a.is_zero() {
            section.push(face[k].clone());
        }
        let crosses = |a: &Rational, b: &Rational| *a < Rational::ZERO && *b > Rational::ZERO;
        if crosses(a, b) || crosses(b, a) {
            let part = a / (a - b);
            let along = difference(&face[next], &face[k]);
            let point: SpacePoint = std::array::from_fn(|i| &face[k][i] + &along[i] * &part);
            rest.push(point.clone());
            section.push(point);
        }
    }
    rest
}

/// The corners of the convex hull of points in a plane, in order around its normal (Andrew 1979).
fn cycle(mut points: Vec<SpacePoint>, normal: &SpacePoint) -> Vec<SpacePoint> {
    let across = (0..3).find(|&i| !normal[i].is_zero()).unwrap_or(2);
    let [i, j] = [(across + 1) % 3, (across + 2) % 3];
    points.sort_by(|a, b| (&a[i], &a[j]).cmp(&(&b[i], &b[j])));
    points.dedup();
    let turns_left = |a: &SpacePoint, b: &SpacePoint, c: &SpacePoint| {
        let (u, v) = (difference(b, a), difference(c, b));
        &u[i] * &v[j] > &u[j] * &v[i]
    };
    let half = |points: &mut dyn Iterator<Item = SpacePoint>| {
        let mut chain: Vec<SpacePoint> = Vec::new();
        for point in points {
            while let [.., a, b] = chain.as_slice()
                && !turns_left(a, b, &point)
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let lower = half(&mut points.iter().cloned());
    let upper = half(&mut points.iter().rev().cloned());
    [lower, upper].concat()
}
