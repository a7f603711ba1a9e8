//! BRL-CAD's solids as primitives: spheres among ellipsoids, right circular cylinders and cones
//! among truncated general cones, tori, blocks and wedges among polyhedra of eight corners.

use premio_kernel::number::rational::{Rational, to_f64};

use super::super::frame::{Axis, Frame, Vector, cross, difference, dot, length, sum};
use crate::primitive::{Primitive, PrimitiveError};
use crate::transform::Transform;

/// A primitive at its place.
#[derive(Debug, Clone)]
pub(super) struct Solid {
    pub(super) primitive: Primitive,
    pub(super) moves: Transform,
    /// How far the vectors are from those of the solid, relative to their length.
    pub(super) residual: f64,
}

/// Why a solid is none of ours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Unsupported {
    /// Its axes are not equal and at right angles.
    Ellipsoid,
    /// A cone whose ends are no circles.
    Elliptical,
    /// A cone whose axis is not at right angles to its ends.
    Oblique,
    /// Eight corners, but of no block and no right-angled wedge.
    Polyhedron,
    /// A vector of no length, or beyond the range of f64 values.
    NoDirection,
    /// A length that makes no solid.
    Size(PrimitiveError),
}

impl Unsupported {
    /// What was found, and what was expected.
    pub(super) fn parts(self) -> (String, &'static str) {
        let (found, expected) = match self {
            Self::Ellipsoid => (
                "an ellipsoid whose axes are not equal and at right angles",
                "a sphere",
            ),
            Self::Elliptical => ("a cone of elliptical section", "circles at both ends"),
            Self::Oblique => ("an oblique cone", "an axis at right angles to its ends"),
            Self::Polyhedron => (
                "a polyhedron of eight corners",
                "a block or a right-angled wedge",
            ),
            Self::NoDirection => ("a vector without direction", "one of some length"),
            Self::Size(error) => {
                let found = format!("a solid of wrong size: {error}");
                return (found, "a solid of positive size");
            }
        };
        (found.to_owned(), expected)
    }
}

/// How far, relative to their length, vectors may be from those of a solid.
const MOST: f64 = 1e-6;

/// How far a is from being at right angles to b, and from being as long: sines and ratios.
fn slant(a: &Vector, b: &Vector) -> f64 {
    let [ab, aa, bb] = [(a, b), (a, a), (b, b)].map(|(x, y)| to_f64(&dot(x, y)));
    match aa > 0.0 && bb > 0.0 {
        true => (ab / (aa.sqrt() * bb.sqrt())).abs(),
        false => 0.0,
    }
}

/// How far two lengths are from being the same, relative to the greater.
fn unlike(a: &Rational, b: &Rational) -> f64 {
    let [a, b] = [to_f64(a), to_f64(b)];
    (a - b).abs() / a.max(b).max(f64::MIN_POSITIVE)
}

/// The length of a vector that may be zero.
fn extent(vector: &Vector) -> Rational {
    length(vector).unwrap_or(Rational::ZERO)
}

/// An ellipsoid: its middle and three half axes.
pub(super) fn ellipsoid([v, a, b, c]: [Vector; 4]) -> Result<Solid, Unsupported> {
    let [la, lb, lc] = [&a, &b, &c].map(extent);
    let slants = [slant(&a, &b), slant(&b, &c), slant(&c, &a)];
    let residual = slants
        .into_iter()
        .chain([unlike(&la, &lb), unlike(&la, &lc)]);
    let residual = residual.fold(0.0, f64::max);
    if residual > MOST {
        return Err(Unsupported::Ellipsoid);
    }
    let primitive = Primitive::sphere(la).map_err(Unsupported::Size)?;
    let moves = Transform::shift(v);
    Ok(Solid {
        primitive,
        moves,
        residual,
    })
}

/// A truncated general cone: the middle of its base, its height, two half axes of the base and two
/// of the top.
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
    if round > MOST {
        return Err(Unsupported::Elliptical);
    }
    if upright > MOST {
        return Err(Unsupported::Oblique);
    }
    let axis = Axis::new(&h).ok_or(Unsupported::NoDirection)?;
    let primitive = Primitive::frustum(la, lc, axis.length).map_err(Unsupported::Size)?;
    Ok(Solid {
        primitive,
        moves: axis.turn.then(Transform::shift(v)),
        residual: round.max(upright),
    })
}

/// A torus: its middle, its axis, the radius of the circle that the tube runs along, and the tube's.
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

/// The faces of a polyhedron of eight corners, each run around.
const FACES: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
];

/// A polyhedron of eight corners, some of which may be in one place.
pub(super) fn polyhedron(corners: &[Vector; 8]) -> Result<Solid, Unsupported> {
    let distinct = Distinct::new(corners);
    let solid = match distinct.points.len() {
        8 => block(corners),
        6 => wedge(&distinct),
        _ => None,
    };
    solid.ok_or(Unsupported::Polyhedron)
}

/// The corners that are in places of their own.
struct Distinct {
    points: Vec<Vector>,
    /// Which of the points each corner is.
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

/// Corners nearer than this part of the polyhedron's size are in one place.
const SAME: f64 = 1e-9;

fn distance(a: &Vector, b: &Vector) -> f64 {
    to_f64(&extent(&difference(a, b)))
}

/// The edges from a corner, run so that they are right-handed.
fn right_handed([a, b, c]: [Vector; 3]) -> [Vector; 3] {
    match dot(&cross(&a, &b), &c) < Rational::ZERO {
        true => [c, b, a],
        false => [a, b, c],
    }
}

/// How far points are from where they should be, relative to the shortest of three edges; `None`
/// where that is too far.
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

/// Two right-angled triangles, and what lies between them.
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

/// Which of six points are what of a wedge.
struct Prism {
    /// Where the right angle is.
    corner: usize,
    /// The same, across.
    across: usize,
    x: usize,
    z: usize,
    /// Across from x and z.
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

    /// Whether every face of the eight corners lies in one of the wedge.
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
