//! Converts directions and edges, given as vectors in a text, to exact rotations and lengths.
//!
//! They are exact if the lengths are rational. Otherwise they are the nearest to f64 precision,
//! such that a rotation stays rigid.

use premio_kernel::motion::{Motion, RationalMatrix};
use premio_kernel::number::rational::{Rational, exact_sqrt, from_f64, to_f64};

use super::rigid_fit::placement;
use crate::transform::{Transform, TransformStep};

/// A vector in space.
pub(super) type Vector = [Rational; 3];

pub(super) fn difference(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| &a[i] - &b[i])
}

pub(super) fn sum(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|i| &a[i] + &b[i])
}

pub(super) fn dot(a: &Vector, b: &Vector) -> Rational {
    let [x, y, z] = [0, 1, 2].map(|i| &a[i] * &b[i]);
    x + y + z
}

pub(super) fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

/// The length of a vector: exact if it is rational, otherwise to f64 precision. `None` for zero and
/// beyond the range of f64.
pub(super) fn length(vector: &Vector) -> Option<Rational> {
    let square = dot(vector, vector);
    if square.is_zero() {
        return None;
    }
    exact_sqrt(&square).or_else(|| {
        let length = to_f64(&square).sqrt();
        length.is_normal().then(|| from_f64(length))?
    })
}

/// The direction and the length of an axis.
#[derive(Debug, Clone)]
pub(super) struct Axis {
    /// The rotation that maps z to it.
    pub(super) turn: Transform,
    pub(super) length: Rational,
}

impl Axis {
    /// The axis of a vector; `None` for one without direction.
    pub(super) fn new(vector: &Vector) -> Option<Self> {
        let length = length(vector)?;
        let turn = quarter(vector).map_or_else(|| oblique(vector, &length), Some)?;
        Some(Self { turn, length })
    }
}

/// The quarter turns that map z to a vector along a coordinate axis.
fn quarter([x, y, z]: &Vector) -> Option<Transform> {
    let negative = |value: &Rational| *value < Rational::ZERO;
    let turn = |axis: [i32; 3], degrees: i32| {
        let (axis, degrees) = (axis.map(Rational::from), degrees.into());
        moves(TransformStep::Turn { axis, degrees })
    };
    match (x.is_zero(), y.is_zero(), z.is_zero()) {
        (true, true, false) if negative(z) => turn([1, 0, 0], 180),
        (true, true, false) => Some(Transform::new()),
        (false, true, true) => turn([0, 1, 0], if negative(x) { -90 } else { 90 }),
        (true, false, true) => turn([1, 0, 0], if negative(y) { 90 } else { -90 }),
        _ => None,
    }
}

/// The shortest rotation that maps z, or -z first, to a vector. It is about the cross product of
/// the two, which with the dot product is the quaternion of half the angle.
fn oblique([x, y, z]: &Vector, length: &Rational) -> Option<Transform> {
    let zero = Rational::ZERO;
    if *z >= zero {
        return moves(TransformStep::Quaternion([length + z, -y, x.clone(), zero]));
    }
    let over = moves(TransformStep::Turn {
        axis: [1, 0, 0].map(Rational::from),
        degrees: 180.into(),
    })?;
    let back = moves(TransformStep::Quaternion([length - z, y.clone(), -x, zero]))?;
    Some(over.then(back))
}

fn moves(step: TransformStep) -> Option<Transform> {
    let mut moves = Transform::new();
    moves.push(step).ok()?;
    Some(moves)
}

/// Three perpendicular edges, right-handed.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    /// The rotation that maps x, y and z to them.
    pub(super) turn: Transform,
    pub(super) lengths: [Rational; 3],
    /// The largest difference between unit vectors along the edges used and those written.
    pub(super) residual: f64,
}

impl Frame {
    /// The frame of three edges; `None` unless they are perpendicular, up to the rounding of a
    /// text, and right-handed.
    pub(super) fn new(edges: &[Vector; 3]) -> Option<Self> {
        let [a, b, c] = edges.each_ref().map(length);
        let lengths = [a?, b?, c?];
        // The columns of the matrix are the edges.
        let matrix: RationalMatrix =
            std::array::from_fn(|i| std::array::from_fn(|j| &edges[j][i] / &lengths[j]));
        if let Some(turn) = exact(&matrix) {
            return Some(Self {
                turn,
                lengths,
                residual: 0.0,
            });
        }
        let nearest = placement(&matrix, [0, 0, 0].map(Rational::from)).ok()?;
        (!nearest.mirrored).then_some(Self {
            turn: nearest.moves,
            lengths,
            residual: nearest.residual,
        })
    }
}

/// The rotation of an exactly orthogonal matrix.
fn exact(matrix: &RationalMatrix) -> Option<Transform> {
    Transform::quarter_turns(matrix).or_else(|| {
        Motion::from_matrix(matrix.clone(), [0, 0, 0].map(Rational::from))?;
        quaternions(matrix)
            .into_iter()
            .filter_map(|quaternion| moves(TransformStep::Quaternion(quaternion)))
            .find(|moves| moves.motion().rotation_matrix() == *matrix)
    })
}

/// The quaternion of a rotation matrix, multiplied by four times each of its components in turn. At
/// least one of these is not zero.
fn quaternions(m: &RationalMatrix) -> [[Rational; 4]; 4] {
    let sum = |i: usize, j: usize| &m[i][j] + &m[j][i];
    let wedge = |i: usize, j: usize| &m[i][j] - &m[j][i];
    let one = Rational::ONE;
    let [a, b, c] = [&m[0][0], &m[1][1], &m[2][2]];
    [
        [&one + a + b + c, wedge(2, 1), wedge(0, 2), wedge(1, 0)],
        [wedge(2, 1), &one + a - b - c, sum(0, 1), sum(0, 2)],
        [wedge(0, 2), sum(0, 1), &one - a + b - c, sum(1, 2)],
        [wedge(1, 0), sum(0, 2), sum(1, 2), one - a - b + c],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn vector(v: [i32; 3]) -> Vector {
        v.map(Rational::from)
    }

    fn z() -> Vector {
        vector([0, 0, 1])
    }

    #[test]
    fn axes_of_rational_length_are_exact() {
        for v in [
            [0, 0, 3],
            [0, 0, -3],
            [2, 0, 0],
            [-2, 0, 0],
            [0, 5, 0],
            [0, -5, 0],
            [3, 4, 0],
            [1, -2, 2],
            [-2, 3, -6],
        ] {
            let axis = Axis::new(&vector(v)).unwrap();
            let end = axis.turn.motion().apply_vector(&z());
            assert_eq!(end.map(|x| x * &axis.length), vector(v), "{v:?}");
        }
        assert!(Axis::new(&vector([0, 0, 0])).is_none());
    }

    #[test]
    fn edges_that_are_not_at_right_angles_are_no_frame() {
        let edges = [[1, 0, 0], [0, 1, 0], [0, 1, 1]].map(vector);
        assert!(Frame::new(&edges).is_none());
        let edges = [[1, 0, 0], [0, 1, 0], [0, 0, 0]].map(vector);
        assert!(Frame::new(&edges).is_none());
    }

    proptest! {
        #[test]
        fn any_axis_is_found(v in prop::array::uniform3(-99i32..=99)) {
            prop_assume!(v != [0; 3]);
            let axis = Axis::new(&vector(v)).unwrap();
            let end = axis.turn.motion().apply_vector(&z());
            for (x, y) in end.iter().zip(v) {
                prop_assert!((to_f64(x) * to_f64(&axis.length) - f64::from(y)).abs() < 1e-13);
            }
        }

        #[test]
        fn an_exact_frame_is_found_exactly(
            q in prop::array::uniform4(-9i32..=9),
            lengths in prop::array::uniform3(1i32..99),
        ) {
            prop_assume!(q != [0; 4]);
            let motion = Motion::from_quaternion(q.map(Rational::from)).unwrap();
            let edges = std::array::from_fn(|k| {
                let unit = std::array::from_fn(|i| Rational::from(u8::from(i == k)));
                motion.apply_vector(&unit).map(|x| x * Rational::from(lengths[k]))
            });
            let frame = Frame::new(&edges).unwrap();
            prop_assert_eq!(frame.turn.motion(), &motion);
            prop_assert_eq!(frame.lengths, lengths.map(Rational::from));
            let [a, b, c] = edges;
            prop_assert!(Frame::new(&[b, a, c]).is_none());
        }
    }
}
