//! Removes triangles of zero area, which rounding produces. A side of length zero is merged to a
//! point. A triangle with collinear corners is flipped with the neighbour across its longest side.

use super::Facet;
use nalgebra::Point3;
use robust::{Coord, orient2d};
use std::collections::HashMap;

/// Removes the triangles of zero area. Every remaining side has two triangles; otherwise the corner
/// where one does not is returned as the error.
pub(super) fn mend(points: &[Point3<f64>], facets: &mut Vec<Facet>) -> Result<(), u32> {
    merge_short_edges(points, facets);
    let mut sides = sides(facets)?;
    let mut waiting: Vec<usize> = (0..facets.len()).collect();
    waiting.retain(|&f| is_flat(points, &facets[f]));
    // Usually each takes one flip; the count stops those that would never end.
    let mut turns = 2 * facets.len();
    while let Some(flat) = waiting.pop() {
        if !is_flat(points, &facets[flat]) {
            continue;
        }
        let [corner, ..] = facets[flat].corners;
        turns = turns.checked_sub(1).ok_or(corner)?;
        let pair = turned(points, facets, &sides, flat).ok_or(corner)?;
        for NewFacet { index, facet } in pair {
            facets[index] = facet;
            sides.extend(sides_of(&facet).map(|side| (side, index)));
            waiting.push(index);
        }
    }
    Ok(())
}

/// The sides of a triangle, each from one corner to the next.
pub(super) fn sides_of(facet: &Facet) -> [[u32; 2]; 3] {
    let [a, b, c] = facet.corners;
    [[a, b], [b, c], [c, a]]
}

/// Merges the two corners at the ends of every side of length zero.
fn merge_short_edges(points: &[Point3<f64>], facets: &mut Vec<Facet>) {
    let mut same: HashMap<u32, u32> = HashMap::new();
    let first = |same: &HashMap<u32, u32>, mut corner: u32| {
        while let Some(&earlier) = same.get(&corner) {
            corner = earlier;
        }
        corner
    };
    for [a, b] in facets.iter().flat_map(sides_of) {
        if points[a as usize] == points[b as usize] {
            let [a, b] = [a, b].map(|c| first(&same, c));
            if a != b {
                same.insert(a.max(b), a.min(b));
            }
        }
    }
    if same.is_empty() {
        return;
    }
    for corner in facets.iter_mut().flat_map(|f| &mut f.corners) {
        *corner = first(&same, *corner);
    }
    facets.retain(|f| sides_of(f).iter().all(|[a, b]| a != b));
}

/// The triangle of each side. Each side occurs once in each direction.
fn sides(facets: &[Facet]) -> Result<HashMap<[u32; 2], usize>, u32> {
    let mut sides = HashMap::with_capacity(3 * facets.len());
    for (number, facet) in facets.iter().enumerate() {
        for side in sides_of(facet) {
            if sides.insert(side, number).is_some() {
                return Err(side[0]);
            }
        }
    }
    let mut all = facets.iter().flat_map(sides_of);
    match all.find(|[a, b]| !sides.contains_key(&[*b, *a])) {
        Some([a, _]) => Err(a),
        None => Ok(sides),
    }
}

/// Whether the corners are collinear, exactly.
fn is_flat(points: &[Point3<f64>], facet: &Facet) -> bool {
    let corners = facet.corners.map(|c| points[c as usize]);
    [[0, 1], [1, 2], [2, 0]].iter().all(|&[i, j]| {
        let [a, b, c] = corners.map(|p| Coord { x: p[i], y: p[j] });
        orient2d(a, b, c) == 0.0
    })
}

/// A triangle that replaces the one at an index.
struct NewFacet {
    index: usize,
    facet: Facet,
}

/// The two triangles that replace a flat one and its neighbour across the longest side: the corner
/// between the two others is joined to the neighbour's opposite corner.
fn turned(
    points: &[Point3<f64>],
    facets: &[Facet],
    sides: &HashMap<[u32; 2], usize>,
    flat: usize,
) -> Option<[NewFacet; 2]> {
    let at = |c: u32| points[c as usize];
    let of = facets[flat].corners;
    let middle = (0..3).find(|&k| {
        let from = |j: usize| at(of[(k + j) % 3]) - at(of[k]);
        from(1).dot(&from(2)) < 0.0
    })?;
    let [q, r, p] = [0, 1, 2].map(|j| of[(middle + j) % 3]);
    let across = *sides.get(&[p, r])?;
    let facet = facets[across];
    let start = facet.corners.iter().position(|&c| c == p)?;
    let [from, to, apex] = [0, 1, 2].map(|j| (start + j) % 3);
    let s = facet.corners[apex];
    // A side that was flipped away is still listed.
    let taken = |side: [u32; 2]| {
        let of = sides.get(&side);
        of.is_some_and(|&f| sides_of(&facets[f]).contains(&side))
    };
    if taken([q, s]) || taken([s, q]) {
        return None;
    }
    let normal = if facets[flat].face == facet.face {
        facets[flat].normals[middle]
    } else {
        (facet.normals[from] + facet.normals[to]).normalize()
    };
    let near = Facet {
        corners: [p, q, s],
        normals: [facet.normals[from], normal, facet.normals[apex]],
        ..facet
    };
    let far = Facet {
        corners: [q, r, s],
        normals: [normal, facet.normals[to], facet.normals[apex]],
        ..facet
    };
    let replaced = |index: usize, facet: Facet| NewFacet { index, facet };
    Some([replaced(flat, near), replaced(across, far)])
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests {
    use super::*;
    use nalgebra::Vector3;
    use premio_kernel::brep::topology::FaceId;

    fn facet(corners: [u32; 3], face: u32) -> Facet {
        Facet {
            corners,
            normals: [Vector3::z(); 3],
            face: FaceId(face),
            solid: 0,
        }
    }

    /// A tetrahedron with a fifth point in the middle of the side from 0 to 1. Towards 2 it is a
    /// corner of two triangles, towards 3 a corner of a triangle of zero area.
    fn tetrahedron() -> (Vec<Point3<f64>>, Vec<Facet>) {
        let points = [
            [0.0, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.0, 0.0, 2.0],
            [1.0, 0.0, 0.0],
        ];
        let facets = [
            ([0, 2, 4], 0),
            ([4, 2, 1], 0),
            ([0, 4, 1], 1),
            ([0, 1, 3], 1),
            ([0, 3, 2], 2),
            ([1, 2, 3], 3),
        ];
        let facets = facets.map(|(corners, face)| facet(corners, face)).to_vec();
        (points.map(Point3::from).to_vec(), facets)
    }

    #[test]
    fn a_triangle_in_a_line_gives_way() {
        let (points, mut facets) = tetrahedron();
        mend(&points, &mut facets).unwrap();
        assert_eq!(facets.len(), 6);
        assert!(facets.iter().all(|f| !is_flat(&points, f)));
        assert!(sides(&facets).is_ok());
        // Side 3 of the fifth point belongs to the face in whose middle it was.
        assert!(facets.iter().all(|f| f.corners != [0, 4, 1]));
        assert_eq!(facets.iter().filter(|f| f.face == FaceId(1)).count(), 2);
    }

    #[test]
    fn a_side_without_length_is_drawn_together() {
        let (mut points, mut facets) = tetrahedron();
        points[4] = points[0];
        mend(&points, &mut facets).unwrap();
        assert_eq!(facets.len(), 4);
        assert!(facets.iter().all(|f| !f.corners.contains(&4)));
    }

    #[test]
    fn what_is_left_open_is_an_error() {
        let (points, mut facets) = tetrahedron();
        facets.pop();
        assert!(mend(&points, &mut facets).is_err());
        let (mut points, mut facets) = tetrahedron();
        // All corners are coplanar, and only triangles of zero area remain.
        points[3] = points[0];
        points[2] = points[0];
        let flat = mend(&points, &mut facets);
        assert!(flat.is_err() || facets.is_empty());
    }
}
