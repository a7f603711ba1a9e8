//! The icosahedral lattice: a geodesic grid (Kenner, 1976), class I.

use super::cone::Cap;
use super::{MAX_POINTS, SphereError, SphereSampling};
use nalgebra::Vector3;

/// The largest frequency: its 10f² + 2 points are just within the greatest number of points.
const MOST: usize = 647;
const _: () = assert!(10 * MOST * MOST + 2 <= MAX_POINTS);

/// The twelve vertices of the icosahedron, on the unit sphere.
fn vertices() -> [Vector3<f64>; 12] {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let (a, b) = (1.0, golden);
    [
        (0.0, a, b),
        (0.0, -a, b),
        (0.0, a, -b),
        (0.0, -a, -b),
        (a, b, 0.0),
        (-a, b, 0.0),
        (a, -b, 0.0),
        (-a, -b, 0.0),
        (b, 0.0, a),
        (b, 0.0, -a),
        (-b, 0.0, a),
        (-b, 0.0, -a),
    ]
    .map(|(x, y, z)| Vector3::new(x, y, z).normalize())
}

/// Whether two vertices are joined: the cosine between them is 1/√5 if so, else negative.
fn joined(a: &Vector3<f64>, b: &Vector3<f64>) -> bool {
    a.dot(b) > 0.0
}

/// All points of a frequency, each once: the vertices, the inner points of the edges, and those of
/// the faces; only of edges and faces that caps may reach.
fn grid(f: usize, caps: &[Cap]) -> impl Iterator<Item = Vector3<f64>> {
    let corners = vertices();
    let mixed = move |on: [usize; 3], by: [usize; 3]| {
        let sum: Vector3<f64> = (0..3).map(|i| corners[on[i]] * by[i] as f64).sum();
        sum.normalize()
    };
    let reached = move |on: [usize; 3]| {
        let middle = mixed(on, [1; 3]);
        let most = on.map(|i| middle.angle(&corners[i]));
        let most = most.into_iter().fold(0.0, f64::max);
        caps.iter().any(|cap| cap.reaches(&middle, most))
    };
    let pairs = (0..12_usize).flat_map(|a| (a + 1..12).map(move |b| (a, b)));
    let edges = pairs.filter(move |&(a, b)| joined(&corners[a], &corners[b]));
    let faces = edges.clone().flat_map(move |(a, b)| {
        let closes =
            move |&c: &usize| joined(&corners[a], &corners[c]) && joined(&corners[b], &corners[c]);
        (b + 1..12).filter(closes).map(move |c| [a, b, c])
    });
    let on_edges = edges
        .filter(move |&(a, b)| reached([a, b, b]))
        .flat_map(move |(a, b)| (1..f).map(move |i| mixed([a, b, b], [f - i, i, 0])));
    let on_faces = faces
        .filter(move |&face| reached(face))
        .flat_map(move |face| {
            (1..f).flat_map(move |i| (1..f - i).map(move |j| mixed(face, [f - i - j, i, j])))
        });
    corners.into_iter().chain(on_edges).chain(on_faces)
}

/// The angle in radians of the longest edge of a frequency.
///
/// Lifting stretches most where a face is nearest to the centre, in its middle, so the edges around
/// there are evaluated.
fn longest(f: usize) -> f64 {
    let corners = vertices();
    // These three are joined to one another.
    let (a, b, c) = (corners[0], corners[4], corners[5]);
    let at = |i: usize, j: usize| {
        let rest = f.saturating_sub(i + j);
        (a * rest as f64 + b * i as f64 + c * j as f64).normalize()
    };
    let near = |middle: usize| middle.saturating_sub(2)..=middle + 2;
    let mut most = 0.0_f64;
    for i in near(f / 3) {
        for j in near(f / 3) {
            // The two upper sides of the triangle under (i, j), and its lower one.
            if i + j < f {
                let (p, q, r) = (at(i, j), at(i + 1, j), at(i, j + 1));
                most = most.max(p.angle(&q)).max(p.angle(&r)).max(q.angle(&r));
            }
        }
    }
    most
}

/// Whether a frequency may have a number of points in the caps, by a bound that no frequency
/// exceeds.
///
/// The edges are no shorter than an edge of the icosahedron (1.0514) over f, lifted from the planes
/// of its faces at 0.7946 from the centre, where that stretches least: by 0.7946, towards a vertex.
/// So caps of half that size around the points do not overlap, and lie in the requested caps
/// widened by as much.
fn may_hold(f: usize, caps: &[Cap], count: usize) -> bool {
    let half = 0.5 * 0.83 / f as f64;
    let share = |angle: f64| (0.5 * angle.min(std::f64::consts::PI)).sin().powi(2);
    let most: f64 = caps
        .iter()
        .map(|cap| share(cap.half_angle + half) / share(half))
        .sum();
    10 * f * f + 2 >= count && most >= count as f64
}

/// The points of a frequency that are in the caps.
fn within(f: usize, caps: &[Cap]) -> impl Iterator<Item = Vector3<f64>> {
    grid(f, caps).filter(move |p| caps.iter().any(|cap| cap.contains(p)))
}

/// The points of the smallest frequency that has the requested number or angle.
pub(super) fn points(
    sampling: SphereSampling,
    caps: &[Cap],
) -> Result<Vec<Vector3<f64>>, SphereError> {
    let f = match sampling {
        SphereSampling::Count(count) => (1..=MOST)
            .find(|&f| may_hold(f, caps, count) && within(f, caps).nth(count - 1).is_some()),
        SphereSampling::Angle(degrees) => (1..=MOST).find(|&f| longest(f) <= degrees.to_radians()),
    };
    let f = f.ok_or(SphereError::TooMany)?;
    Ok(within(f, caps).collect())
}

#[cfg(test)]
mod tests {
    use super::super::cone::caps;
    use super::*;

    #[test]
    fn the_longest_edge_is_near_the_middle_of_a_face() {
        let corners = vertices();
        let on = [corners[0], corners[4], corners[5]];
        assert!(joined(&on[0], &on[1]) && joined(&on[1], &on[2]) && joined(&on[0], &on[2]));
        for f in 1..=40 {
            let at = |i: usize, j: usize| {
                let by = [f - i - j, i, j];
                let sum: Vector3<f64> = (0..3).map(|k| on[k] * by[k] as f64).sum();
                sum.normalize()
            };
            let (mut most, mut least) = (0.0_f64, 4.0_f64);
            for i in 0..f {
                for j in 0..f - i {
                    let (p, q, r) = (at(i, j), at(i + 1, j), at(i, j + 1));
                    for edge in [p.angle(&q), p.angle(&r), q.angle(&r)] {
                        most = most.max(edge);
                        least = least.min(edge);
                    }
                }
            }
            assert!(
                (longest(f) - most).abs() < 1e-12,
                "{f}: {} {most}",
                longest(f)
            );
            assert!(least >= 0.83 / f as f64, "{f}: {}", least * f as f64);
        }
    }

    #[test]
    fn every_point_is_made_once() {
        for f in [1, 2, 3, 4, 7, 12] {
            let all: Vec<_> = grid(f, &caps(&[]).unwrap()).collect();
            assert_eq!(all.len(), 10 * f * f + 2);
            for (i, p) in all.iter().enumerate() {
                assert!((p.norm() - 1.0).abs() < 1e-15);
                assert!(all[..i].iter().all(|q| (p - q).norm() > 0.8 / f as f64));
            }
        }
    }
}
