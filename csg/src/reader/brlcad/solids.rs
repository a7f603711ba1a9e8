//! Converts BRL-CAD's solids to primitives: ellipsoids, truncated general cones, tori, and polyhedra of
//! eight corners.

use premio_kernel::number::rational::{Rational, to_f64};

use super::super::frame::{Axis, Frame, Vector, cross, difference, dot, length, sum};
use crate::primitive::{Primitive, PrimitiveError};
use crate::transform::Transform;

/// A primitive in its position.
#[derive(Debug, Clone)]
pub(super) struct Solid {
    pub(super) primitive: Primitive,
    pub(super) moves: Transform,
    /// The largest difference between the vectors used and those written, relative to their length.
    pub(super) residual: f64,
}

/// Why a solid has no exact counterpart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unsupported {
    /// A cone whose ends are not circles.
    Elliptical,
    /// Eight corners that form neither a block nor a right-angled wedge.
    Polyhedron,
    /// A vector of length zero, or beyond the range of f64.
    NoDirection,
    /// A length that is invalid for a solid.
    Size(PrimitiveError),
}

/// The words for a solid that is not supported.
pub(super) struct UnsupportedWords {
    pub found: String,
    pub expected: &'static str,
}

impl Unsupported {
    /// The words for an error.
    pub(super) fn words(self) -> UnsupportedWords {
        let (found, expected) = match self {
            Self::Elliptical => (
                "a cone whose ends are not similar",
                "similar ellipses at both ends",
            ),
            Self::Polyhedron => (
                "a polyhedron of eight corners",
                "a block or a right-angled wedge",
            ),
            Self::NoDirection => ("a vector without direction", "one of some length"),
            Self::Size(error) => {
                let found = format!("a solid of wrong size: {error}");
                let expected = "a solid of positive size";
                return UnsupportedWords { found, expected };
            }
        };
        UnsupportedWords {
            found: found.to_owned(),
            expected,
        }
    }
}

/// The tolerance on vectors, relative to their length.
const MOST: f64 = 1e-6;

/// The deviation of a from being perpendicular to b and equally long: sines and ratios.
fn slant(a: &Vector, b: &Vector) -> f64 {
    let [ab, aa, bb] = [(a, b), (a, a), (b, b)].map(|(x, y)| to_f64(&dot(x, y)));
    match aa > 0.0 && bb > 0.0 {
        true => (ab / (aa.sqrt() * bb.sqrt())).abs(),
        false => 0.0,
    }
}

/// The difference of two lengths, relative to the larger.
fn unlike(a: &Rational, b: &Rational) -> f64 {
    let [a, b] = [to_f64(a), to_f64(b)];
    (a - b).abs() / a.max(b).max(f64::MIN_POSITIVE)
}

/// The length of a vector that may be zero.
fn extent(vector: &Vector) -> Rational {
    length(vector).unwrap_or(Rational::ZERO)
}

/// An ellipsoid: its centre and three half axes. It is a sphere if these are equal and at right angles.
pub(super) fn ellipsoid([v, a, b, c]: [Vector; 4]) -> Result<Solid, Unsupported> {
    let [la, lb, lc] = [&a, &b, &c].map(extent);
    let slants = [slant(&a, &b), slant(&b, &c), slant(&c, &a)];
    let residual = slants
        .into_iter()
        .chain([unlike(&la, &lb), unlike(&la, &lc)]);
    let residual = residual.fold(0.0, f64::max);
    let is_round = residual <= MOST;
    let primitive = match is_round {
        true => Primitive::sphere(la),
        false => Primitive::ellipsoid([a, b, c]),
    };
    Ok(Solid {
        primitive: primitive.map_err(Unsupported::Size)?,
        moves: Transform::shift(v),
        residual: if is_round { residual } else { 0.0 },
    })
}

/// A truncated general cone: the centre of its base, its height vector, two half axes of the base
/// and two of the top.
pub(super) fn cone([v, h, a, b, c, d]: [Vector; 6]) -> Result<Solid, Unsupported> {
    let [la, lb, lc, ld] = [&a, &b, &c, &d].map(extent);
    let round = [
        slant(&a, &b),
        slant(&c, &d),
        unlike(&la, &lb),
        unlike(&lc, &ld),
    ];
    let upright = [&a, &b, &c, &d].map(|radius| slant(radius, &h));
    let [round, upright] = [round, upright].map(|all| all.into_iter().fold(0.0, f64::max));
    if round > MOST || upright > MOST {
        return oblique_cone([v, h, a, b, c, d]);
    }
    let axis = Axis::new(&h).ok_or(Unsupported::NoDirection)?;
    let primitive = Primitive::frustum(la, lc, axis.length).map_err(Unsupported::Size)?;
    Ok(Solid {
        primitive,
        moves: axis.turn.then(Transform::shift(v)),
        residual: round.max(upright),
    })
}

/// A cone whose top is its base, scaled; the larger of the two has the axes.
fn oblique_cone([v, h, a, b, c, d]: [Vector; 6]) -> Result<Solid, Unsupported> {
    let [la, lb, lc, ld] = [&a, &b, &c, &d].map(extent);
    let is_reversed = la < lc;
    let ([x, y], [u, w], [widest, narrowest]) = match is_reversed {
        true => ([c, d], [a, b], [lc, la]),
        false => ([a, b], [c, d], [la, lc]),
    };
    let [other_widest, other_narrowest] = match is_reversed {
        true => [ld, lb],
        false => [lb, ld],
    };
    if widest.is_zero() || other_widest.is_zero() {
        return Err(Unsupported::Elliptical);
    }
    let top = &narrowest / &widest;
    let off = |big: &Vector, small: &Vector| {
        let apart: Vector = std::array::from_fn(|i| &small[i] - &top * &big[i]);
        to_f64(&extent(&apart)) / to_f64(&widest)
    };
    let residual = off(&x, &u).max(off(&y, &w));
    let residual = residual.max(to_f64(&(&other_narrowest / &other_widest - &top)).abs());
    if residual > MOST {
        return Err(Unsupported::Elliptical);
    }
    let (z, base) = match is_reversed {
        true => {
            let base = std::array::from_fn(|i| &v[i] + &h[i]);
            (h.map(|c| -c), base)
        }
        false => (h, v),
    };
    let primitive = Primitive::oblique_frustum([x, y, z], top).map_err(Unsupported::Size)?;
    Ok(Solid {
        primitive,
        moves: Transform::shift(base),
        residual,
    })
}

/// A torus: its centre, its axis, the radius of the spine circle, and the radius of the tube.
pub(super) fn torus(
    [v, h]: [Vector; 2],
    major: Rational,
    minor: Rational,
) -> Result<Solid, Unsupported> {
    let axis = Axis::new(&h).ok_or(Unsupported::NoDirection)?;
    let primitive = Primitive::torus(major, minor).map_err(Unsupported::Size)?;
    Ok(Solid {
        primitive,
        moves: axis.turn.then(Transform::shift(v)),
        residual: 0.0,
    })
}

/// The faces of a polyhedron of eight corners, each as a cycle of corners.
const FACES: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
];

/// A polyhedron of eight corners, some of which may coincide.
pub(super) fn polyhedron(corners: &[Vector; 8]) -> Result<Solid, Unsupported> {
    let distinct = Distinct::new(corners);
    let solid = match distinct.points.len() {
        8 => block(corners),
        6 => wedge(&distinct),
        _ => None,
    };
    solid.ok_or(Unsupported::Polyhedron)
}

/// The distinct corners.
struct Distinct {
    points: Vec<Vector>,
    /// The index of the distinct point for each corner.
    which: [usize; 8],
}

impl Distinct {
    fn new(corners: &[Vector; 8]) -> Self {
        let furthest = corners
            .iter()
            .map(|p| distance(p, &corners[0]))
            .fold(0.0, f64::max);
        let mut points: Vec<Vector> = Vec::new();
        let which = std::array::from_fn(|corner| {
            let same = |p: &Vector| distance(p, &corners[corner]) <= SAME * furthest;
            points.iter().position(same).unwrap_or_else(|| {
                points.push(corners[corner].clone());
                points.len() - 1
            })
        });
        Self { points, which }
    }
}

/// The distance, relative to the polyhedron's size, within which corners coincide.
const SAME: f64 = 1e-9;

fn distance(a: &Vector, b: &Vector) -> f64 {
    to_f64(&extent(&difference(a, b)))
}

/// The edges from a corner, in right-handed order.
fn right_handed([a, b, c]: [Vector; 3]) -> [Vector; 3] {
    match dot(&cross(&a, &b), &c) < Rational::ZERO {
        true => [c, b, a],
        false => [a, b, c],
    }
}

/// The largest distance of points from where they should be, relative to the shortest of three
/// edges; `None` if that exceeds the tolerance.
fn misplaced<const N: usize>(pairs: [(&Vector, Vector); N], edges: &[Vector; 3]) -> Option<f64> {
    let shortest = edges
        .iter()
        .map(|e| to_f64(&extent(e)))
        .fold(f64::MAX, f64::min);
    let furthest = pairs
        .iter()
        .map(|(a, b)| distance(a, b))
        .fold(0.0, f64::max);
    (furthest <= MOST * shortest).then_some(furthest / shortest)
}

fn block(corners: &[Vector; 8]) -> Option<Solid> {
    let [o, a, c, b, d, ad, cd, bd] = corners;
    let edges = [a, b, d].map(|end| difference(end, o));
    let pairs = [
        (c, [0, 1].as_slice()),
        (ad, &[0, 2]),
        (bd, &[1, 2]),
        (cd, &[0, 1, 2]),
    ];
    let pairs = pairs.map(|(point, along)| {
        let add = |at: Vector, &edge: &usize| sum(&at, &edges[edge]);
        (point, along.iter().fold(o.clone(), add))
    });
    let off = misplaced(pairs, &edges)?;
    let frame = Frame::new(&right_handed(edges))?;
    let primitive = Primitive::block(frame.lengths).ok()?;
    Some(Solid {
        primitive,
        moves: frame.turn.then(Transform::shift(o.clone())),
        residual: frame.residual.max(off),
    })
}

/// A wedge: two right-angled triangles, and the prism between them.
fn wedge(distinct: &Distinct) -> Option<Solid> {
    let points = &distinct.points;
    let others = |taken: &[usize]| {
        let free: Vec<usize> = (0..6).filter(|k| !taken.contains(k)).collect();
        free
    };
    for corner in 0..6 {
        for across in others(&[corner]) {
            for x in others(&[corner, across]) {
                for z in others(&[corner, across, x]).into_iter().filter(|&z| z > x) {
                    let rest = others(&[corner, across, x, z]);
                    for ends in [[rest[0], rest[1]], [rest[1], rest[0]]] {
                        let prism = Prism {
                            corner,
                            across,
                            x,
                            z,
                            ends,
                        };
                        if let Some(solid) = prism.solid(points)
                            && prism.has_faces(distinct)
                        {
                            return Some(solid);
                        }
                    }
                }
            }
        }
    }
    None
}

/// The roles of six points in a wedge.
struct Prism {
    /// The corner with the right angle.
    corner: usize,
    /// The opposite corner with the right angle, at the other triangle.
    across: usize,
    x: usize,
    z: usize,
    /// The corners at the other triangle opposite to x and z.
    ends: [usize; 2],
}

impl Prism {
    fn solid(&self, points: &[Vector]) -> Option<Solid> {
        let from = |end: usize| difference(&points[end], &points[self.corner]);
        let edges = [from(self.x), from(self.across), from(self.z)];
        let [x, z] = [self.x, self.z].map(|end| sum(&points[end], &edges[1]));
        let pairs = [(&points[self.ends[0]], x), (&points[self.ends[1]], z)];
        let off = misplaced(pairs, &edges)?;
        let frame = Frame::new(&right_handed(edges))?;
        let primitive = Primitive::wedge(frame.lengths).ok()?;
        let shift = Transform::shift(points[self.corner].clone());
        Some(Solid {
            primitive,
            moves: frame.turn.then(shift),
            residual: frame.residual.max(off),
        })
    }

    /// Whether every face of the eight corners lies in a face of the wedge.
    fn has_faces(&self, distinct: &Distinct) -> bool {
        let Self {
            corner,
            across,
            x,
            z,
            ends: [p, q],
        } = *self;
        let faces: [&[usize]; 5] = [
            &[corner, x, z],
            &[across, p, q],
            &[corner, x, p, across],
            &[corner, z, q, across],
            &[x, z, q, p],
        ];
        FACES.iter().all(|face| {
            let mut points = face.map(|corner| distinct.which[corner]).to_vec();
            points.sort_unstable();
            points.dedup();
            let within = |of: &&[usize]| points.iter().all(|point| of.contains(point));
            points.len() <= 2 || faces.iter().any(within)
        })
    }
}
