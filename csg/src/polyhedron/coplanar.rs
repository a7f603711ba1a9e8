//! Faces with a common edge in one plane are one face.

use super::PolyhedronFace;
use super::orientation::{FilteredPoint, are_in_line, is_same_side, orientation};
use std::collections::BTreeMap;

/// The faces, of which those are united that have a common edge, lie in one plane and look the same
/// way.
///
/// Where edges of one plane end in the middle of a straight edge, that edge has no vertex there. So
/// no facet may end there either.
pub(super) fn united(faces: Vec<PolyhedronFace>, points: &[FilteredPoint]) -> Vec<PolyhedronFace> {
    let mut groups = Groups::new(faces.len());
    for [face, other] in neighbours(&faces) {
        if groups.root(face) != groups.root(other)
            && is_coplanar(&faces[face], &faces[other], points)
        {
            groups.unite(face, other);
        }
    }
    let mut members: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for face in 0..faces.len() {
        members.entry(groups.root(face)).or_default().push(face);
    }
    let unite = |members: &Vec<usize>| match &members[..] {
        [alone] => faces[*alone].clone(),
        _ => union_of(members.iter().map(|&face| &faces[face])),
    };
    members.values().map(unite).collect()
}

/// Disjoint sets of faces.
pub(super) struct Groups(Vec<usize>);

impl Groups {
    pub fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    /// The first face of a face's group.
    pub fn root(&mut self, mut face: usize) -> usize {
        while self.0[face] != face {
            self.0[face] = self.0[self.0[face]];
            face = self.0[face];
        }
        face
    }

    pub fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}

/// The pairs of faces with a common edge that no other face has.
fn neighbours(faces: &[PolyhedronFace]) -> Vec<[usize; 2]> {
    let mut around: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for (index, face) in faces.iter().enumerate() {
        for [from, to] in face.edges() {
            let key = [from.min(to), from.max(to)];
            around.entry(key).or_default().push(index);
        }
    }
    let pairs = around.into_values().filter_map(|of| match of[..] {
        [a, b] if a != b => Some([a, b]),
        _ => None,
    });
    pairs.collect()
}

/// Whether two faces lie in one plane and look the same way.
fn is_coplanar(a: &PolyhedronFace, b: &PolyhedronFace, points: &[FilteredPoint]) -> bool {
    let Some(base) = spanning(a, points) else {
        return false;
    };
    let base = base.map(|i| &points[i]);
    let is_on = |i: usize| orientation([base[0], base[1], base[2], &points[i]]).is_eq();
    b.corners().all(is_on) && is_same_side(a, b, points)
}

/// Three corners of a face that are not in line.
fn spanning(face: &PolyhedronFace, points: &[FilteredPoint]) -> Option<[usize; 3]> {
    let mut corners = face.corners();
    let (first, second) = (corners.next()?, corners.next()?);
    let off = |i: &usize| !are_in_line([first, second, *i].map(|i| &points[i]));
    Some([first, second, corners.find(off)?])
}

/// The union of faces of one plane: an edge that two of them have in opposite senses is none of it.
fn union_of<'a>(faces: impl Iterator<Item = &'a PolyhedronFace>) -> PolyhedronFace {
    let mut edges: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    for [from, to] in faces.flat_map(PolyhedronFace::edges) {
        if !take(&mut edges, [to, from]) {
            *edges.entry([from, to]).or_default() += 1;
        }
    }
    let mut loops = Vec::new();
    while let Some((&first, _)) = edges.first_key_value() {
        take(&mut edges, first);
        let [start, mut at] = first;
        let mut corners = vec![start];
        while at != start {
            corners.push(at);
            let mut onwards = edges.range([at, 0]..=[at, usize::MAX]);
            let Some(next) = onwards.next().map(|(&edge, _)| edge) else {
                break;
            };
            take(&mut edges, next);
            at = next[1];
        }
        loops.push(corners);
    }
    PolyhedronFace { loops }
}

/// Removes an edge once; false if there is none.
fn take(edges: &mut BTreeMap<[usize; 2], usize>, edge: [usize; 2]) -> bool {
    let Some(count) = edges.get_mut(&edge) else {
        return false;
    };
    *count -= 1;
    if *count == 0 {
        edges.remove(&edge);
    }
    true
}
