//! Polyhedra: solids that plane polygons bound, with rational corners.

mod convex_hull;
mod coplanar;
mod crossing;
mod half_spaces;
mod neighbours;
mod orientation;
mod shells;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use premio_kernel::number::rational::{Rational, to_f64};

pub use half_spaces::HalfSpace;
use orientation::{FilteredPoint, are_in_line, orientation, plane_normal};
pub(crate) use orientation::{cross, dot};

/// The largest number of corners of all faces.
pub const MAX_CORNERS: usize = 1_000_000;

/// The largest number of points of a convex hull, of which the time grows with the square.
pub const MAX_HULL_POINTS: usize = 20_000;

/// A point of space.
pub type SpacePoint = [Rational; 3];

/// Why faces bound no polyhedron.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PolyhedronError {
    /// There are too many corners.
    #[error("a polyhedron of {count} corners; the limit is {MAX_CORNERS}")]
    TooManyCorners {
        /// The number of corners of all faces.
        count: usize,
    },
    /// There are too many points.
    #[error("a convex hull of {count} points; the limit is {MAX_HULL_POINTS}")]
    TooManyPoints {
        /// The number of points.
        count: usize,
    },
    /// There are too many shells.
    #[error("{count} shells that look inwards; this is more than are placed in others")]
    TooManyShells {
        /// The number of shells that look inwards.
        count: usize,
    },
    /// A face names a point that does not exist.
    #[error("face {face} has the point {point}, and there are {count} points")]
    NoPoint {
        /// The index of the face.
        face: usize,
        /// The index of the point.
        point: usize,
        /// The number of points.
        count: usize,
    },
    /// A face with holes is not plane.
    #[error("face {face} has holes and is not plane")]
    NotPlane {
        /// The index of the face.
        face: usize,
    },
    /// The faces do not close.
    #[error("the edge from point {from} to point {to} has no face on its other side")]
    Open {
        /// The index of the edge's first point.
        from: usize,
        /// The index of the edge's last point.
        to: usize,
    },
    /// The points or the faces enclose no volume.
    #[error("the faces enclose no volume")]
    Empty,
}

/// A solid that plane polygons bound.
///
/// Its corners and the planes of its faces are exact. Faces touch along common edges only.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Polyhedron {
    points: Vec<SpacePoint>,
    faces: Vec<PolyhedronFace>,
}

/// A plane face, which may have holes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct PolyhedronFace {
    /// The corners of its outline and of each hole, as indices of points. As seen from the outside,
    /// the face is on the left of every loop.
    pub loops: Vec<Vec<usize>>,
}

impl PolyhedronFace {
    /// A face without holes.
    pub fn simple(corners: Vec<usize>) -> Self {
        let loops = vec![corners];
        Self { loops }
    }

    /// The corners of all loops.
    pub fn corners(&self) -> impl Iterator<Item = usize> + Clone {
        self.loops.iter().flatten().copied()
    }

    /// Its edges, from corner to corner.
    pub fn edges(&self) -> impl Iterator<Item = [usize; 2]> {
        self.loops.iter().flat_map(|corners| {
            let next = corners.iter().cycle().skip(1);
            corners.iter().zip(next).map(|(&from, &to)| [from, to])
        })
    }

    fn reversed(&self) -> Self {
        let backwards = |corners: &Vec<usize>| corners.iter().rev().copied().collect();
        Self {
            loops: self.loops.iter().map(backwards).collect(),
        }
    }
}

/// A polyhedron, and what was changed to obtain it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PolyhedronRepair {
    /// The polyhedron.
    pub polyhedron: Polyhedron,
    /// The number of faces that are not plane, and were cut into triangles.
    pub triangulated: usize,
    /// Whether all faces were turned inside out.
    pub is_turned: bool,
}

impl Polyhedron {
    /// The polyhedron with these faces.
    ///
    /// Points may coincide. Neighbouring faces of one plane become one. Faces without holes that are not plane are cut into triangles about
    /// their first corner. If the faces enclose a negative volume, all of them are turned.
    ///
    /// # Errors
    /// A face names a point that does not exist, a face with holes is not plane, the faces are not
    /// closed, or they enclose no volume.
    pub fn from_faces(
        points: &[SpacePoint],
        faces: &[PolyhedronFace],
    ) -> Result<PolyhedronRepair, PolyhedronError> {
        let count = faces.iter().map(|face| face.corners().count()).sum();
        if count > MAX_CORNERS {
            return Err(PolyhedronError::TooManyCorners { count });
        }
        for (face, of) in faces.iter().enumerate() {
            if let Some(point) = of.corners().find(|&i| i >= points.len()) {
                let count = points.len();
                return Err(PolyhedronError::NoPoint { face, point, count });
            }
        }
        let first = distinct(points);
        let all: Vec<FilteredPoint> = points.iter().map(FilteredPoint::new).collect();
        let (mut kept, mut triangulated) = (Vec::new(), 0);
        for (index, face) in faces.iter().enumerate() {
            let merged =
                |corners: &Vec<usize>| without_repeats(corners.iter().map(|&i| first[i]).collect());
            let loops = face.loops.iter().map(merged);
            let loops: Vec<Vec<usize>> = loops.filter(|corners| corners.len() > 2).collect();
            let face = PolyhedronFace { loops };
            let corners: Vec<usize> = face.corners().collect();
            match (is_plane(&all, &corners), face.loops.len()) {
                (_, 0) => {}
                (true, _) => kept.push(face),
                (false, 1) => {
                    triangulated += 1;
                    let fan = 1..corners.len() - 1;
                    let triangles = fan.map(|k| vec![corners[0], corners[k], corners[k + 1]]);
                    kept.extend(triangles.map(PolyhedronFace::simple));
                }
                (false, _) => return Err(PolyhedronError::NotPlane { face: index }),
            }
        }
        let kept = without_flat(kept, &all);
        check_closed(&kept)?;
        let kept = coplanar::united(kept, &all);
        let mut polyhedron = Self::compact(points, kept);
        let volume = polyhedron.sixfold_volume();
        if volume.is_zero() {
            return Err(PolyhedronError::Empty);
        }
        let is_turned = volume < Rational::ZERO;
        if is_turned {
            polyhedron.faces = polyhedron.reversed_faces();
        }
        Ok(PolyhedronRepair {
            polyhedron,
            triangulated,
            is_turned,
        })
    }

    /// A polyhedron with the points that its faces use.
    fn compact(points: &[SpacePoint], mut faces: Vec<PolyhedronFace>) -> Self {
        let used: BTreeSet<usize> = faces.iter().flat_map(PolyhedronFace::corners).collect();
        let used: Vec<usize> = used.into_iter().collect();
        for i in faces
            .iter_mut()
            .flat_map(|face| face.loops.iter_mut().flatten())
        {
            *i = used.partition_point(|&known| known < *i);
        }
        let points = used.into_iter().map(|i| points[i].clone());
        Self {
            points: points.collect(),
            faces,
        }
    }

    /// Its corners.
    pub fn points(&self) -> &[SpacePoint] {
        &self.points
    }

    /// Its faces.
    pub fn faces(&self) -> &[PolyhedronFace] {
        &self.faces
    }

    fn reversed_faces(&self) -> Vec<PolyhedronFace> {
        self.faces.iter().map(PolyhedronFace::reversed).collect()
    }

    /// The corners of a face.
    pub(crate) fn corners(&self, face: usize) -> impl Iterator<Item = &SpacePoint> {
        self.faces[face].corners().map(|i| &self.points[i])
    }

    /// The outward normal of a face, of any length.
    pub(crate) fn normal(&self, face: usize) -> SpacePoint {
        normal_of(&self.faces[face], |i| &self.points[i])
    }

    /// Six times the volume that the faces enclose.
    pub(crate) fn sixfold_volume(&self) -> Rational {
        sixfold_volume_of(&self.faces, |i| &self.points[i])
    }

    /// The least and the greatest corner of its bounding box, in f64.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let none = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        self.points.iter().fold(none, |[lo, hi], point| {
            let at = point.each_ref().map(to_f64);
            [
                std::array::from_fn(|i| lo[i].min(at[i])),
                std::array::from_fn(|i| hi[i].max(at[i])),
            ]
        })
    }

    /// The image with all lengths multiplied by `factor`, which must be greater than zero.
    pub(crate) fn scaled(&self, factor: &Rational) -> Self {
        let by = |p: &SpacePoint| p.each_ref().map(|x| x * factor);
        Self {
            points: self.points.iter().map(by).collect(),
            faces: self.faces.clone(),
        }
    }

    /// The mirror image under `y -> -y`.
    pub(crate) fn mirrored_y(&self) -> Self {
        let flip = |[x, y, z]: &SpacePoint| [x.clone(), -y, z.clone()];
        Self {
            points: self.points.iter().map(flip).collect(),
            faces: self.reversed_faces(),
        }
    }

    /// The image under an affine map that keeps or reverses the orientation.
    ///
    /// # Errors
    /// The map makes it flat.
    pub(crate) fn mapped(
        &self,
        matrix: &[[Rational; 3]; 3],
        offset: &SpacePoint,
    ) -> Result<Self, PolyhedronError> {
        let image = |p: &SpacePoint| -> SpacePoint {
            std::array::from_fn(|i| dot(&matrix[i], p) + &offset[i])
        };
        let determinant = dot(&matrix[0], &cross(&matrix[1], &matrix[2]));
        if determinant.is_zero() {
            return Err(PolyhedronError::Empty);
        }
        let faces = match determinant < Rational::ZERO {
            true => self.reversed_faces(),
            false => self.faces.clone(),
        };
        Ok(Self {
            points: self.points.iter().map(image).collect(),
            faces,
        })
    }
}

/// Six times the volume that faces enclose.
fn sixfold_volume_of<'a>(
    faces: &[PolyhedronFace],
    point: impl Fn(usize) -> &'a SpacePoint,
) -> Rational {
    let mut sum = Rational::ZERO;
    for corners in faces.iter().flat_map(|face| &face.loops) {
        let [a, rest @ ..] = &corners[..] else {
            continue;
        };
        for pair in rest.windows(2) {
            let [p, q, r] = [*a, pair[0], pair[1]].map(&point);
            sum += dot(p, &cross(q, r));
        }
    }
    sum
}

/// The outward normal of a face, of any length.
pub(crate) fn normal_of<'a>(
    face: &PolyhedronFace,
    point: impl Fn(usize) -> &'a SpacePoint,
) -> SpacePoint {
    let normals = face
        .loops
        .iter()
        .map(|corners| plane_normal(corners.iter().map(|&i| point(i))));
    let zero = std::array::from_fn(|_| Rational::ZERO);
    normals.fold(zero, |sum: SpacePoint, normal| {
        std::array::from_fn(|i| &sum[i] + &normal[i])
    })
}

/// The indices of points that are listed loop after loop, by the lengths of the loops.
pub(crate) fn index_loops(lengths: impl Iterator<Item = usize>) -> Vec<Vec<usize>> {
    let mut first = 0;
    let of = lengths.map(|length| {
        first += length;
        (first - length..first).collect()
    });
    of.collect()
}

/// For every point, the index of the first one at its place.
fn distinct(points: &[SpacePoint]) -> Vec<usize> {
    let mut known: HashMap<&SpacePoint, usize> = HashMap::new();
    let points = points.iter().enumerate();
    points
        .map(|(i, point)| *known.entry(point).or_insert(i))
        .collect()
}

/// A closed list of corners without equal neighbours.
fn without_repeats(mut corners: Vec<usize>) -> Vec<usize> {
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    corners
}

/// Whether all corners lie in the plane of three of them.
fn is_plane(points: &[FilteredPoint], corners: &[usize]) -> bool {
    let [a, b, rest @ ..] = corners else {
        return true;
    };
    let (a, b) = (&points[*a], &points[*b]);
    let is_off_line = |c: &&usize| !are_in_line([a, b, &points[**c]]);
    let Some(c) = rest.iter().find(is_off_line) else {
        return true;
    };
    let on = |d: &usize| orientation([a, b, &points[*c], &points[*d]]).is_eq();
    rest.iter().all(on)
}

/// The faces with area, and those without if they are needed to close the others.
fn without_flat(faces: Vec<PolyhedronFace>, points: &[FilteredPoint]) -> Vec<PolyhedronFace> {
    let has_area = |face: &PolyhedronFace| {
        let normal = normal_of(face, |i| &points[i].exact);
        normal.iter().any(|x| !x.is_zero())
    };
    let (faces, mut flat): (Vec<_>, Vec<_>) = faces.into_iter().partition(has_area);
    // A flat face closes an edge that is subdivided on one side only.
    if check_closed(&faces).is_ok() {
        flat.clear();
    }
    faces.into_iter().chain(flat).collect()
}

/// Every edge has as many faces on one side as on the other.
fn check_closed(faces: &[PolyhedronFace]) -> Result<(), PolyhedronError> {
    let mut balance: BTreeMap<[usize; 2], i64> = BTreeMap::new();
    for [from, to] in faces.iter().flat_map(PolyhedronFace::edges) {
        let (key, by) = match from < to {
            true => ([from, to], 1),
            false => ([to, from], -1),
        };
        *balance.entry(key).or_default() += by;
    }
    match balance.into_iter().find(|(_, sum)| *sum != 0) {
        Some(([from, to], sum)) if sum > 0 => Err(PolyhedronError::Open { from, to }),
        Some(([from, to], _)) => Err(PolyhedronError::Open { from: to, to: from }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests;
