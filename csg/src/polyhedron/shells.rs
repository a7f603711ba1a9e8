//! The solids that the shells of a mesh bound.
//!
//! A shell is what edges connect. What is inside follows from the shells' orientations, and so it
//! does where shells intersect:
//!
//! - An outward shell bounds a solid. Outward shells are united, also one within another.
//! - An inward shell within a solid bounds a void of the smallest solid around it.
//! - An inward shell within none was turned inside out, and bounds a solid.
//! - If all shells enclose a negative volume, all of them are turned.
//! - A shell without volume is nothing.
//! - Two faces with the same corners in opposite senses are nothing: both sides of them are alike.
//! - A shell that is there twice is there once.

use std::cmp::Ordering;
use std::collections::{BTreeMap, HashMap};

use premio_kernel::number::rational::Rational;

use super::coplanar::Groups;
use super::orientation::{FilteredPoint, cross, difference};
use super::{
    MAX_CORNERS, Polyhedron, PolyhedronError, PolyhedronFace, SpacePoint, check_closed, distinct,
    sixfold_volume_of, without_repeats,
};

/// The largest number of inward shells: each of them is compared with the faces of solids.
const MAX_VOIDS: usize = 10_000;

/// How many triangles of a shell are tried to find a point inside of it.
const MAX_TRIES: usize = 100;

impl Polyhedron {
    /// The polyhedra whose union is the solid that shells bound. The faces have no holes. Solids
    /// with disjoint bounding boxes are one polyhedron.
    ///
    /// # Errors
    /// There are too many corners or shells, the faces are not closed, or they enclose no volume.
    pub(crate) fn from_shells(
        points: &[SpacePoint],
        faces: &[PolyhedronFace],
    ) -> Result<Vec<Self>, PolyhedronError> {
        let count = faces.iter().map(|face| face.corners().count()).sum();
        if count > MAX_CORNERS {
            return Err(PolyhedronError::TooManyCorners { count });
        }
        let first = distinct(points);
        let merged = |face: &PolyhedronFace| {
            let corners = face.corners().map(|i| first[i]).collect();
            PolyhedronFace::simple(without_repeats(corners))
        };
        let merged = faces.iter().map(merged);
        let merged: Vec<_> = merged.filter(|face| face.corners().count() > 2).collect();
        let faces = without_pairs(merged);
        check_closed(&faces)?;
        let faces = without_copies(faces);
        let near: Vec<FilteredPoint> = points.iter().map(FilteredPoint::new).collect();
        let solids = solids(shells(faces, &near), &near)?;
        let parts = apart(solids).into_iter();
        let parts = parts.map(|faces| compact(points, faces));
        match parts.len() {
            0 => Err(PolyhedronError::Empty),
            _ => parts.collect(),
        }
    }
}

/// A connected, closed part of a mesh.
struct Shell {
    faces: Vec<PolyhedronFace>,
    /// Six times the volume that it encloses, less than zero if it is inward.
    volume: Rational,
    bounds: [[f64; 3]; 2],
}

impl Shell {
    fn new(faces: Vec<PolyhedronFace>, points: &[FilteredPoint]) -> Self {
        let volume = sixfold_volume_of(&faces, |i| &points[i].exact);
        let none = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        let corners = faces.iter().flat_map(PolyhedronFace::corners);
        let bounds = corners.fold(none, |[lo, hi], i| {
            let at = points[i].near;
            [
                std::array::from_fn(|k| lo[k].min(at[k])),
                std::array::from_fn(|k| hi[k].max(at[k])),
            ]
        });
        Self {
            faces,
            volume,
            bounds,
        }
    }

    fn reversed(self) -> Self {
        Self {
            faces: self.faces.iter().map(PolyhedronFace::reversed).collect(),
            volume: -self.volume,
            bounds: self.bounds,
        }
    }

    /// Whether another shell lies within this one, if they do not intersect.
    fn contains(&self, other: &Self, points: &[FilteredPoint]) -> bool {
        let [lo, hi] = &self.bounds;
        let [other_lo, other_hi] = &other.bounds;
        if (0..3).any(|k| other_lo[k] < lo[k] || other_hi[k] > hi[k]) {
            return false;
        }
        // Corners may lie on both shells; a point inside of the other one does not.
        let inner = other.triangles(points).take(MAX_TRIES);
        let inner = inner.filter_map(|triangle| other.inner_point(triangle, points));
        let is_within = |point: &FilteredPoint| {
            let beyond = self.crossings(point, points).into_iter();
            let beyond = beyond.filter(|crossing| crossing.x > point.exact[0]);
            beyond.map(|crossing| crossing.sense).sum::<i64>() != 0
        };
        inner.take(1).any(|point| is_within(&point))
    }

    fn triangles<'p>(
        &self,
        points: &'p [FilteredPoint],
    ) -> impl Iterator<Item = [&'p FilteredPoint; 3]> {
        self.faces.iter().flat_map(move |face| {
            let corners: Vec<usize> = face.corners().collect();
            let fan = 1..corners.len().saturating_sub(1);
            fan.map(move |k| [0, k, k + 1].map(|k| &points[corners[k]]))
        })
    }

    /// A point inside, on the line along x through the middle of a triangle.
    fn inner_point(
        &self,
        [a, b, c]: [&FilteredPoint; 3],
        points: &[FilteredPoint],
    ) -> Option<FilteredPoint> {
        let middle = |k: usize| (&a.exact[k] + &b.exact[k] + &c.exact[k]) / Rational::from(3);
        let line = FilteredPoint::new(&[Rational::ZERO, middle(1), middle(2)]);
        let mut crossings = self.crossings(&line, points);
        crossings.sort_by(|a, b| a.x.cmp(&b.x));
        let mut winding = 0;
        for pair in crossings.windows(2) {
            winding += pair[0].sense;
            if winding != 0 && pair[0].x < pair[1].x {
                let x = (&pair[0].x + &pair[1].x) / Rational::from(2);
                let [_, y, z] = line.exact;
                return Some(FilteredPoint::new(&[x, y, z]));
            }
        }
        None
    }

    /// Where the line along x through a point crosses the shell.
    fn crossings(&self, point: &FilteredPoint, points: &[FilteredPoint]) -> Vec<Crossing> {
        let triangles = self.triangles(points);
        let found = triangles.filter_map(|triangle| Crossing::new(triangle, point));
        found.collect()
    }
}

/// A point in which a line along x crosses a triangle.
struct Crossing {
    x: Rational,
    /// One if the line leaves there, minus one if it enters.
    sense: i64,
}

impl Crossing {
    /// Of triangles with a common edge the line crosses one at most: the sides of an edge are
    /// decided alike in all of them.
    fn new(triangle: [&FilteredPoint; 3], point: &FilteredPoint) -> Option<Self> {
        let is_apart = |axis: usize| {
            let at = |p: &FilteredPoint| p.near[axis];
            let is_above = triangle.iter().all(|p| at(p) > at(point));
            is_above || triangle.iter().all(|p| at(p) < at(point))
        };
        if is_apart(1) || is_apart(2) {
            return None;
        }
        let [_, y, z] = &point.exact;
        let corners = triangle.map(|p| &p.exact);
        // The winding number of the triangle's shadow on the plane of y and z (Hormann and Agathos
        // 2001).
        let mut sense = 0;
        for [a, b] in [[0, 1], [1, 2], [2, 0]].map(|edge| edge.map(|i| corners[i])) {
            let left = || {
                let turn = (&b[1] - &a[1]) * (z - &a[2]) - (&b[2] - &a[2]) * (y - &a[1]);
                turn.cmp(&Rational::ZERO)
            };
            match (a[2] <= *z, b[2] <= *z) {
                (true, false) if left() == Ordering::Greater => sense += 1,
                (false, true) if left() == Ordering::Less => sense -= 1,
                _ => {}
            }
        }
        let [a, b, c] = triangle;
        let normal = cross(&difference(b, a), &difference(c, a));
        if sense == 0 || normal[0].is_zero() {
            return None;
        }
        let a = &a.exact;
        let rise = &normal[1] * (y - &a[1]) + &normal[2] * (z - &a[2]);
        let x = &a[0] - rise / &normal[0];
        Some(Self { x, sense })
    }
}

/// The corners of a face from the least one on, in the sense that is less, and whether that is the
/// face's own.
fn canonical(face: &PolyhedronFace) -> (Vec<usize>, bool) {
    let rotated = |mut corners: Vec<usize>| {
        let least = (0..corners.len()).min_by_key(|&k| corners[k]);
        corners.rotate_left(least.unwrap_or_default());
        corners
    };
    let own = rotated(face.corners().collect());
    let other = rotated(face.reversed().corners().collect());
    match own <= other {
        true => (own, true),
        false => (other, false),
    }
}

/// The faces without pairs of the same corners in opposite senses.
fn without_pairs(faces: Vec<PolyhedronFace>) -> Vec<PolyhedronFace> {
    let mut balance: HashMap<Vec<usize>, i64> = HashMap::new();
    for face in &faces {
        let (corners, is_own) = canonical(face);
        *balance.entry(corners).or_default() += if is_own { 1 } else { -1 };
    }
    let mut kept = faces;
    kept.retain(|face| {
        let (corners, is_own) = canonical(face);
        let Some(left) = balance.get_mut(&corners) else {
            return false;
        };
        let step = if is_own { 1 } else { -1 };
        let is_kept = *left * step > 0;
        *left -= if is_kept { step } else { 0 };
        is_kept
    });
    kept
}

/// The faces, each once, if these are closed.
fn without_copies(faces: Vec<PolyhedronFace>) -> Vec<PolyhedronFace> {
    let mut known: HashMap<Vec<usize>, usize> = HashMap::new();
    let is_first =
        |(k, face): (usize, &PolyhedronFace)| *known.entry(canonical(face).0).or_insert(k) == k;
    let first: Vec<bool> = faces.iter().enumerate().map(is_first).collect();
    if first.iter().all(|is_first| *is_first) {
        return faces;
    }
    let once = faces.iter().zip(&first).filter(|(_, is_first)| **is_first);
    let once: Vec<PolyhedronFace> = once.map(|(face, _)| face.clone()).collect();
    match check_closed(&once) {
        Ok(()) => once,
        Err(_) => faces,
    }
}

/// The shells with a volume, turned if they enclose a negative one.
fn shells(faces: Vec<PolyhedronFace>, points: &[FilteredPoint]) -> Vec<Shell> {
    let mut groups = Groups::new(faces.len());
    let mut at_edge: HashMap<[usize; 2], usize> = HashMap::new();
    for (index, face) in faces.iter().enumerate() {
        for [from, to] in face.edges() {
            let known = at_edge.entry([from.min(to), from.max(to)]).or_insert(index);
            groups.unite(*known, index);
        }
    }
    let mut members: BTreeMap<usize, Vec<PolyhedronFace>> = BTreeMap::new();
    for (index, face) in faces.into_iter().enumerate() {
        members.entry(groups.root(index)).or_default().push(face);
    }
    let shells = members.into_values().map(|faces| Shell::new(faces, points));
    let shells: Vec<Shell> = shells.filter(|shell| !shell.volume.is_zero()).collect();
    let volume = shells.iter().fold(Rational::ZERO, |sum, s| sum + &s.volume);
    match volume < Rational::ZERO {
        true => shells.into_iter().map(Shell::reversed).collect(),
        false => shells,
    }
}

/// The outward shells, each with its voids.
fn solids(
    shells: Vec<Shell>,
    points: &[FilteredPoint],
) -> Result<Vec<Vec<Shell>>, PolyhedronError> {
    let is_outward = |shell: &Shell| shell.volume > Rational::ZERO;
    let (outward, inward): (Vec<_>, Vec<_>) = shells.into_iter().partition(is_outward);
    let count = inward.len();
    if count > MAX_VOIDS {
        return Err(PolyhedronError::TooManyShells { count });
    }
    let mut solids: Vec<Vec<Shell>> = outward.into_iter().map(|shell| vec![shell]).collect();
    // The smallest solid comes first, so that the first one around a void is its own.
    solids.sort_by(|a, b| a[0].volume.cmp(&b[0].volume));
    let known = solids.len();
    for shell in inward.into_iter().map(Shell::reversed) {
        let around = |solid: &Vec<Shell>| {
            let [outer, ..] = &solid[..] else {
                return false;
            };
            outer.volume > shell.volume && outer.contains(&shell, points)
        };
        match solids[..known].iter().position(around) {
            Some(solid) => solids[solid].push(shell.reversed()),
            None => solids.push(vec![shell]),
        }
    }
    Ok(solids)
}

/// The faces of solids whose boxes intersect no other box, and those of each other solid.
fn apart(mut solids: Vec<Vec<Shell>>) -> Vec<Vec<PolyhedronFace>> {
    solids.sort_by(|a, b| a[0].bounds[0][0].total_cmp(&b[0].bounds[0][0]));
    let mut is_alone = vec![true; solids.len()];
    for (i, solid) in solids.iter().enumerate() {
        let [lo, hi] = &solid[0].bounds;
        for (j, other) in solids.iter().enumerate().skip(i + 1) {
            let [other_lo, other_hi] = &other[0].bounds;
            if other_lo[0] > hi[0] {
                break;
            }
            if (1..3).all(|k| other_lo[k] <= hi[k] && lo[k] <= other_hi[k]) {
                (is_alone[i], is_alone[j]) = (false, false);
            }
        }
    }
    let (mut alone, mut parts) = (Vec::new(), Vec::new());
    for (solid, is_alone) in solids.into_iter().zip(is_alone) {
        let faces = solid.into_iter().flat_map(|shell| shell.faces);
        match is_alone {
            true => alone.extend(faces),
            false => parts.push(faces.collect()),
        }
    }
    if !alone.is_empty() {
        parts.push(alone);
    }
    parts
}

/// The polyhedron with these faces, of the points that they use.
fn compact(
    points: &[SpacePoint],
    faces: Vec<PolyhedronFace>,
) -> Result<Polyhedron, PolyhedronError> {
    let Polyhedron { points, faces } = Polyhedron::compact(points, faces);
    Ok(Polyhedron::from_faces(&points, &faces)?.polyhedron)
}
