//! The convex hull of points in space: gift wrapping (Chand and Kapur 1970) with whole facets, so
//! that any number of points may lie in a plane.

use super::orientation::{FilteredPoint, are_in_line, cross, difference, orientation};
use super::{MAX_HULL_POINTS, Polyhedron, PolyhedronError, PolyhedronFace, SpacePoint, distinct};
use premio_kernel::number::rational::Rational;
use std::cmp::Ordering;
use std::collections::{BTreeSet, VecDeque};

impl Polyhedron {
    /// The convex hull of points.
    ///
    /// # Errors
    /// There are too many, or they lie in a plane.
    pub fn convex_hull(points: &[SpacePoint]) -> Result<Self, PolyhedronError> {
        if points.len() > MAX_HULL_POINTS {
            let count = points.len();
            return Err(PolyhedronError::TooManyPoints { count });
        }
        let first = distinct(points);
        let own = points.iter().enumerate().filter(|(i, _)| first[*i] == *i);
        let points: Vec<FilteredPoint> = own.map(|(_, p)| FilteredPoint::new(p)).collect();
        let faces = Wrapping { points: &points }
            .facets()
            .ok_or(PolyhedronError::Empty)?;
        let exact: Vec<SpacePoint> = points.into_iter().map(|p| p.exact).collect();
        let faces = faces.into_iter().map(PolyhedronFace::simple);
        Ok(Self::compact(&exact, faces.collect()))
    }
}

/// The points to be wrapped.
struct Wrapping<'a> {
    points: &'a [FilteredPoint],
}

impl Wrapping<'_> {
    /// All facets, counterclockwise as seen from the outside; `None` if the points lie in a plane.
    fn facets(&self) -> Option<Vec<Vec<usize>>> {
        let mut done: BTreeSet<[usize; 2]> = BTreeSet::new();
        let mut open: VecDeque<[usize; 2]> = VecDeque::new();
        let mut facets = Vec::new();
        let mut next = Some(self.first_facet()?);
        while let Some(facet) = next {
            let ends = facet.iter().cycle().skip(1);
            for (&from, &to) in facet.iter().zip(ends) {
                done.insert([from, to]);
                open.push_back([to, from]);
            }
            facets.push(facet);
            while open.front().is_some_and(|edge| done.contains(edge)) {
                open.pop_front();
            }
            next = match open.front() {
                Some(&edge) => Some(self.facet_at(edge)?),
                None => None,
            };
        }
        Some(facets)
    }

    /// A facet: that through an edge of the hull's shadow on the plane of x and y.
    fn first_facet(&self) -> Option<Vec<usize>> {
        let exact = |i: usize| &self.points[i].exact;
        let lowest = (0..self.points.len()).min_by(|&a, &b| exact(a).cmp(exact(b)))?;
        // The next corner of the shadow, counterclockwise, and any point above or below it.
        let turn = |a: usize, b: usize| {
            let [u, v] = [a, b].map(|i| difference(&self.points[i], &self.points[lowest]));
            (&u[0] * &v[1] - &u[1] * &v[0]).cmp(&Rational::ZERO)
        };
        let is_beside = |i: &usize| exact(*i)[..2] != exact(lowest)[..2];
        let others = (0..self.points.len()).filter(is_beside);
        let next = others.reduce(|best, i| match turn(best, i) {
            Ordering::Less => i,
            _ => best,
        })?;
        // With a point below the lowest one, the plane through the edge is vertical.
        let [x, y, z] = exact(lowest).clone();
        let below = FilteredPoint::new(&[x, y, z - Rational::ONE]);
        let [a, b] = [next, lowest].map(|i| &self.points[i]);
        let on: Vec<usize> = (0..self.points.len())
            .filter(|&i| orientation([a, b, &below, &self.points[i]]).is_eq())
            .collect();
        match on.iter().all(|&i| are_in_line([a, b, &self.points[i]])) {
            true => {
                let least = on.iter().copied().min_by(|&a, &b| exact(a).cmp(exact(b)))?;
                let most = on.iter().copied().max_by(|&a, &b| exact(a).cmp(exact(b)))?;
                self.facet_at([least, most])
            }
            false => Some(polygon(on, &normal([a, b, &below]), |i| {
                &self.points[i].exact
            })),
        }
    }

    /// The facet on the left of a directed edge of the hull, as seen from the outside.
    fn facet_at(&self, [from, to]: [usize; 2]) -> Option<Vec<usize>> {
        let [a, b] = [from, to].map(|i| &self.points[i]);
        let mut plane: Option<usize> = None;
        for i in 0..self.points.len() {
            let point = &self.points[i];
            match plane {
                None if !are_in_line([a, b, point]) => plane = Some(i),
                None => {}
                Some(c) if orientation([a, b, &self.points[c], point]).is_gt() => plane = Some(i),
                Some(_) => {}
            }
        }
        let c = plane?;
        let corners = [a, b, &self.points[c]];
        let on = |i: &usize| {
            let [a, b, c] = corners;
            orientation([a, b, c, &self.points[*i]]).is_eq()
        };
        let on: Vec<usize> = (0..self.points.len()).filter(on).collect();
        // All points in one plane bound nothing.
        (on.len() < self.points.len())
            .then(|| polygon(on, &normal(corners), |i| &self.points[i].exact))
    }
}

/// The convex hull of points in a plane, counterclockwise about the normal: the monotone chain
/// (Andrew 1979).
pub(super) fn polygon<'a>(
    mut on: Vec<usize>,
    normal: &SpacePoint,
    point: impl Fn(usize) -> &'a SpacePoint,
) -> Vec<usize> {
    // The plane is projected along the axis on which the normal is longest.
    let size = |i: usize| match normal[i] < Rational::ZERO {
        true => -&normal[i],
        false => normal[i].clone(),
    };
    let axis = (0..3).max_by(|&a, &b| size(a).cmp(&size(b))).unwrap_or(2);
    let (mut u, mut v) = ((axis + 1) % 3, (axis + 2) % 3);
    if normal[axis] < Rational::ZERO {
        std::mem::swap(&mut u, &mut v);
    }
    let at = |i: usize, axis: usize| &point(i)[axis];
    on.sort_by(|&a, &b| at(a, u).cmp(at(b, u)).then(at(a, v).cmp(at(b, v))));
    let turn = |a: usize, b: usize, c: usize| {
        let by = |i: usize, axis: usize| at(i, axis) - at(a, axis);
        (by(b, u) * by(c, v) - by(b, v) * by(c, u)).cmp(&Rational::ZERO)
    };
    let half = |points: &mut dyn Iterator<Item = usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..]
                && turn(a, b, point) != Ordering::Greater
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let lower = half(&mut on.iter().copied());
    let upper = half(&mut on.iter().rev().copied());
    lower.into_iter().chain(upper).collect()
}

fn normal([a, b, c]: [&FilteredPoint; 3]) -> SpacePoint {
    cross(&difference(b, a), &difference(c, a))
}
