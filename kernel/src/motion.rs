//! Exact rigid motions.
//!
//! A rotation is built from a rational quaternion, so its matrix is exactly orthogonal. Motions
//! compose and invert exactly, and things that coincide before a common motion coincide after it.

use std::sync::Arc;

use dashu::base::Sign;
use nalgebra::{Matrix3, Vector3};

use crate::number::float::Float;
use crate::number::rational::{Rational, bits, exact_sqrt, from_f64, to_f64, whole};

/// A 3x3 matrix by rows.
pub type RationalMatrix = [[Rational; 3]; 3];

/// A rigid motion `p -> R p + t`, with `R` exactly orthogonal and of determinant +1.
///
/// A pure translation stores no rotation, so it is cheap to build and to apply.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Motion {
    rotation: Option<Arc<RationalMatrix>>,
    translation: [Rational; 3],
}

/// Why a motion could not be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MotionError {
    /// The axis has length zero and therefore no direction.
    #[error("an axis of length zero")]
    ZeroAxis,
    /// A number exceeds the range of f64, in which the tangent of the half angle is computed.
    #[error("an axis beyond the range of f64")]
    OutOfRange,
}

impl Default for Motion {
    fn default() -> Self {
        Self::identity()
    }
}

impl Motion {
    /// The identity motion.
    pub fn identity() -> Self {
        Self::translation([Rational::ZERO, Rational::ZERO, Rational::ZERO])
    }

    /// A translation.
    pub fn translation(offset: [Rational; 3]) -> Self {
        Self {
            rotation: None,
            translation: offset,
        }
    }

    /// A rotation about an axis through the origin, by an angle in degrees, right-handed.
    ///
    /// Multiples of 90 degrees about a coordinate axis are exact. Any other angle is replaced by
    /// the nearest one with a rational quaternion `(1, s a)`, where `a` is the axis as given and `s
    /// = tan(angle / 2) / |a|` is rounded to an f64. The axis itself is kept exactly.
    ///
    /// # Errors
    /// The axis is zero, or beyond the range of f64.
    pub fn rotation(axis: [Rational; 3], degrees: &Rational) -> Result<Self, MotionError> {
        let axis = unit_if_rational(axis)?;
        let angle = reduce_degrees(degrees);
        let [x, y, z] = axis.direction;
        let (w, s) = half_angle(&angle, axis.length)?;
        Ok(Self::from_quaternion([w, &s * x, &s * y, s * z]).unwrap_or_default())
    }

    /// The rotation of a quaternion `w + x i + y j + z k`, which need not have unit length; `None`
    /// if it is zero.
    pub fn from_quaternion([w, x, y, z]: [Rational; 4]) -> Option<Self> {
        let [ww, xx, yy, zz] = [&w * &w, &x * &x, &y * &y, &z * &z];
        let norm = &ww + &xx + &yy + &zz;
        if norm.is_zero() {
            return None;
        }
        let two = Rational::from(2);
        let double = |a: &Rational, b: &Rational| &two * a * b;
        let [xy, xz, yz] = [double(&x, &y), double(&x, &z), double(&y, &z)];
        let [wx, wy, wz] = [double(&w, &x), double(&w, &y), double(&w, &z)];
        let matrix = [
            [&ww + &xx - &yy - &zz, &xy - &wz, &xz + &wy],
            [&xy + &wz, &ww - &xx + &yy - &zz, &yz - &wx],
            [&xz - &wy, &yz + &wx, &ww - &xx - &yy + &zz],
        ];
        let scaled = matrix.map(|row| row.map(|entry| entry / &norm));
        Some(Self::from_parts(scaled, Self::identity().translation))
    }

    /// A quaternion `w + x i + y j + z k` of the rotation, of any length.
    pub fn quaternion(&self) -> [Rational; 4] {
        let m = self.rotation_matrix();
        let one = Rational::ONE;
        let [xx, yy, zz] = [&m[0][0], &m[1][1], &m[2][2]];
        let [wx, wy, wz] = [
            &m[2][1] - &m[1][2],
            &m[0][2] - &m[2][0],
            &m[1][0] - &m[0][1],
        ];
        let [xy, xz, yz] = [
            &m[0][1] + &m[1][0],
            &m[0][2] + &m[2][0],
            &m[1][2] + &m[2][1],
        ];
        // Each is the quaternion times four times one of its entries, which may be zero.
        let multiples = [
            [&one + xx + yy + zz, wx.clone(), wy.clone(), wz.clone()],
            [wx, &one + xx - yy - zz, xy.clone(), xz.clone()],
            [wy, xy, &one - xx + yy - zz, yz.clone()],
            [wz, xz, yz, &one - xx - yy + zz],
        ];
        let found = multiples
            .into_iter()
            .enumerate()
            .find(|(k, multiple)| !multiple[*k].is_zero());
        found.map_or_else(Default::default, |(_, multiple)| whole(&multiple))
    }

    /// The motion with this rotation matrix and translation; `None` unless the matrix is exactly
    /// orthogonal with determinant +1.
    pub fn from_matrix(rotation: RationalMatrix, translation: [Rational; 3]) -> Option<Self> {
        let orthogonal = (0..3).all(|i| {
            (i..3).all(|j| {
                let product = dot(&rotation[i], &rotation[j]);
                if i == j {
                    product.is_one()
                } else {
                    product.is_zero()
                }
            })
        });
        (orthogonal && determinant(&rotation).is_one())
            .then(|| Self::from_parts(rotation, translation))
    }

    fn from_parts(rotation: RationalMatrix, translation: [Rational; 3]) -> Self {
        // A rotation whose trace is 3 is the identity.
        let trace = &rotation[0][0] + &rotation[1][1] + &rotation[2][2];
        let identity = trace == Rational::from(3);
        Self {
            rotation: (!identity).then(|| Arc::new(rotation)),
            translation,
        }
    }

    /// The composition: this motion first, then the other.
    pub fn then(&self, other: &Self) -> Self {
        let translation = other.apply_point(&self.translation);
        let rotation = match (&self.rotation, &other.rotation) {
            (None, rotation) | (rotation, None) => rotation.clone(),
            (Some(first), Some(second)) => {
                return Self::from_parts(product(second, first), translation);
            }
        };
        Self {
            rotation,
            translation,
        }
    }

    /// The inverse motion.
    pub fn inverse(&self) -> Self {
        let rotation = self
            .rotation
            .as_ref()
            .map(|matrix| Arc::new(transpose(matrix)));
        let turned = Self {
            rotation,
            translation: Self::identity().translation,
        };
        let translation = turned.apply_vector(&self.translation).map(|x| -x);
        Self {
            translation,
            ..turned
        }
    }

    /// The mirror image of this motion: `S M S`, with `S` the reflection `y -> -y`.
    pub fn mirrored_y(&self) -> Self {
        let rotation = self.rotation.as_ref().map(|matrix| {
            let mut matrix = RationalMatrix::clone(matrix);
            for (i, j) in [(0, 1), (1, 0), (1, 2), (2, 1)] {
                matrix[i][j] = -std::mem::take(&mut matrix[i][j]);
            }
            Arc::new(matrix)
        });
        let [x, y, z] = self.translation.clone();
        Self {
            rotation,
            translation: [x, -y, z],
        }
    }

    /// This motion with all lengths multiplied by `factor`: the rotation is unchanged, the
    /// translation is scaled.
    pub fn scaled(&self, factor: &Rational) -> Self {
        Self {
            rotation: self.rotation.clone(),
            translation: self.translation.each_ref().map(|x| x * factor),
        }
    }

    /// The image of a point.
    pub fn apply_point(&self, point: &[Rational; 3]) -> [Rational; 3] {
        let [x, y, z] = self.apply_vector(point);
        let [a, b, c] = &self.translation;
        [x + a, y + b, z + c]
    }

    /// The image of a direction: it is rotated, not translated.
    pub fn apply_vector(&self, vector: &[Rational; 3]) -> [Rational; 3] {
        match &self.rotation {
            None => vector.clone(),
            Some(matrix) => [0, 1, 2].map(|i| dot(&matrix[i], vector)),
        }
    }

    /// Whether the rotation is the identity.
    pub(crate) fn is_translation(&self) -> bool {
        self.rotation.is_none()
    }

    /// Whether this is the identity.
    pub fn is_identity(&self) -> bool {
        self.is_translation() && self.translation.iter().all(Rational::is_zero)
    }

    /// The rotation matrix, by rows.
    pub fn rotation_matrix(&self) -> RationalMatrix {
        match &self.rotation {
            Some(matrix) => RationalMatrix::clone(matrix),
            None => [0, 1, 2].map(|i| [0, 1, 2].map(|j| Rational::from(u8::from(i == j)))),
        }
    }

    /// The translation: the image of the origin.
    pub fn offset(&self) -> &[Rational; 3] {
        &self.translation
    }

    /// The rotation matrix with entries rounded to the nearest f64.
    pub fn rotation_f64(&self) -> Matrix3<f64> {
        self.rounded_rotation()
    }

    /// Whether it turns by multiples of 90° about the coordinate axes.
    pub fn is_by_quarter_turns(&self) -> bool {
        let is_whole = |x: &Rational| x.is_zero() || x.is_one() || (-x).is_one();
        let mut entries = self
            .rotation
            .iter()
            .flat_map(|matrix| matrix.iter().flatten());
        entries.all(is_whole)
    }

    /// The rotation, rounded once to the precision of `N`.
    pub fn rounded_rotation<N: Float>(&self) -> Matrix3<N> {
        match &self.rotation {
            Some(matrix) => Matrix3::from_fn(|i, j| N::nearest(&matrix[i][j])),
            None => Matrix3::identity(),
        }
    }

    /// The translation, rounded to the nearest f64.
    pub fn translation_f64(&self) -> Vector3<f64> {
        Vector3::from_fn(|i, _| to_f64(&self.translation[i]))
    }

    /// The length in bits of the longest number in this motion. It grows as motions are composed.
    pub fn bits(&self) -> usize {
        let rotation = self.rotation.iter().flat_map(|m| m.iter().flatten());
        let longest = rotation.chain(&self.translation).map(bits).max();
        longest.unwrap_or(0)
    }
}

/// An axis as given, or normalised to unit length if its length is rational.
struct Axis {
    direction: [Rational; 3],
    /// The length of `direction`, rounded.
    length: f64,
}

fn unit_if_rational(axis: [Rational; 3]) -> Result<Axis, MotionError> {
    let square = dot(&axis, &axis);
    if square.is_zero() {
        return Err(MotionError::ZeroAxis);
    }
    if let Some(length) = exact_sqrt(&square) {
        return Ok(Axis {
            direction: axis.map(|x| x / &length),
            length: 1.0,
        });
    }
    let length = to_f64(&square).sqrt();
    if !length.is_normal() {
        return Err(MotionError::OutOfRange);
    }
    Ok(Axis {
        direction: axis,
        length,
    })
}

/// The angle modulo 360 degrees, in [-180, 180].
fn reduce_degrees(degrees: &Rational) -> Rational {
    let turn = Rational::from(360);
    let turns = (degrees / &turn).round();
    degrees - turn * Rational::from(turns)
}

/// The real part of the quaternion, and the factor that multiplies the axis.
fn half_angle(angle: &Rational, length: f64) -> Result<(Rational, Rational), MotionError> {
    let right = Rational::from(90);
    let straight = Rational::from(180);
    let magnitude = if angle.sign() == Sign::Negative {
        -angle
    } else {
        angle.clone()
    };
    if magnitude == straight {
        return Ok((Rational::ZERO, Rational::ONE));
    }
    let tangent = if magnitude.is_zero() {
        0.0
    } else if magnitude == right {
        1.0
    } else {
        (to_f64(&magnitude) / 2.0).to_radians().tan()
    };
    let factor = from_f64(tangent / length).ok_or(MotionError::OutOfRange)?;
    Ok((Rational::ONE, factor * angle.sign()))
}

/// The dot product. Products with 0 and 1, which are common in matrices, are skipped.
fn dot(a: &[Rational; 3], b: &[Rational; 3]) -> Rational {
    let mut sum = Rational::ZERO;
    for (x, y) in a.iter().zip(b) {
        if x.is_zero() || y.is_zero() {
            continue;
        }
        sum += if x.is_one() {
            y.clone()
        } else if y.is_one() {
            x.clone()
        } else {
            x * y
        };
    }
    sum
}

fn transpose(matrix: &RationalMatrix) -> RationalMatrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| matrix[j][i].clone()))
}

fn product(a: &RationalMatrix, b: &RationalMatrix) -> RationalMatrix {
    let columns = transpose(b);
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| dot(&a[i], &columns[j])))
}

fn determinant(m: &RationalMatrix) -> Rational {
    let minor = |j: usize, k: usize| &m[1][j] * &m[2][k] - &m[1][k] * &m[2][j];
    let cross = [minor(1, 2), minor(2, 0), minor(0, 1)];
    dot(&m[0], &cross)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn integers(v: [i32; 3]) -> [Rational; 3] {
        v.map(Rational::from)
    }

    fn turn(axis: [i32; 3], degrees: i32) -> Motion {
        Motion::rotation(integers(axis), &degrees.into()).unwrap()
    }

    #[test]
    fn quarter_turns_are_exact() {
        assert_eq!(
            turn([0, 0, 7], 90).apply_point(&integers([1, 2, 3])),
            integers([-2, 1, 3])
        );
        assert_eq!(
            turn([0, 0, -7], 90).apply_point(&integers([1, 2, 3])),
            integers([2, -1, 3])
        );
        assert_eq!(
            turn([1, 0, 0], 90).apply_point(&integers([1, 2, 3])),
            integers([1, -3, 2])
        );
        assert_eq!(
            turn([0, 1, 0], 450).apply_point(&integers([1, 2, 3])),
            integers([3, 2, -1])
        );
        assert_eq!(
            turn([0, 1, 0], -180).apply_point(&integers([1, 2, 3])),
            integers([-1, 2, -3])
        );
        assert!(turn([3, 1, 2], 720).is_identity());
    }

    #[test]
    fn a_turn_is_close_to_its_angle() {
        let m = turn([0, 0, 1], 30).rotation_f64();
        assert!((m[(0, 0)] - 0.75f64.sqrt()).abs() < 2e-16);
        assert!((m[(1, 0)] - 0.5).abs() < 2e-16);
        let about_diagonal = turn([1, 1, 1], 120).rotation_f64();
        assert!((about_diagonal[(1, 0)] - 1.0).abs() < 4e-16);
    }

    #[test]
    fn the_axis_stays_where_it_is() {
        let axis = integers([1, 2, -5]);
        assert_eq!(turn([1, 2, -5], 37).apply_point(&axis), axis);
    }

    #[test]
    fn bad_axes_are_refused() {
        let degrees = Rational::from(10);
        assert_eq!(
            Motion::rotation(integers([0, 0, 0]), &degrees),
            Err(MotionError::ZeroAxis)
        );
        let tiny = Rational::from_parts(1.into(), dashu::integer::UBig::ONE << 2000);
        let axis = [tiny.clone(), tiny, Rational::ZERO];
        assert_eq!(
            Motion::rotation(axis, &degrees),
            Err(MotionError::OutOfRange)
        );
    }

    #[test]
    fn a_matrix_must_be_a_rotation() {
        let mirror = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]].map(integers);
        let sheared = [[1, 1, 0], [0, 1, 0], [0, 0, 1]].map(integers);
        assert_eq!(Motion::from_matrix(mirror, integers([0, 0, 0])), None);
        assert_eq!(Motion::from_matrix(sheared, integers([0, 0, 0])), None);
        let turned = turn([1, 2, 3], 17);
        let again = Motion::from_matrix(turned.rotation_matrix(), integers([0, 0, 0]));
        assert_eq!(again, Some(turned));
    }

    fn motions() -> impl Strategy<Value = Motion> {
        let axis = prop::array::uniform3(-9i32..=9);
        let offset = prop::array::uniform3(-1e3f64..1e3);
        (axis, -720.0f64..720.0, offset).prop_map(|(axis, degrees, offset)| {
            let shift = Motion::translation(offset.map(|x| from_f64(x).unwrap()));
            let degrees = from_f64(degrees).unwrap();
            let axis = integers(if axis == [0; 3] { [0, 1, 0] } else { axis });
            Motion::rotation(axis, &degrees).unwrap().then(&shift)
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn rotations_are_exactly_orthogonal(a in motions(), b in motions()) {
            let both = a.then(&b);
            prop_assert!(Motion::from_matrix(both.rotation_matrix(), both.offset().clone()).is_some());
        }

        #[test]
        fn a_motion_is_undone_exactly(a in motions(), b in motions()) {
            prop_assert!(a.then(&a.inverse()).is_identity());
            prop_assert_eq!(a.then(&b).inverse(), b.inverse().then(&a.inverse()));
        }

        #[test]
        fn motions_compose(a in motions(), b in motions(), p in prop::array::uniform3(-99i32..99)) {
            let p = integers(p);
            prop_assert_eq!(a.then(&b).apply_point(&p), b.apply_point(&a.apply_point(&p)));
        }

        #[test]
        fn a_mirror_image_moves_mirrored_points(a in motions(), p in prop::array::uniform3(-99i32..99)) {
            let mirror = |[x, y, z]: [Rational; 3]| [x, -y, z];
            let p = integers(p);
            let expected = mirror(a.apply_point(&mirror(p.clone())));
            prop_assert_eq!(a.mirrored_y().apply_point(&p), expected);
        }

        #[test]
        fn the_angle_is_kept(degrees in -179.0f64..179.0) {
            let angle = from_f64(degrees).unwrap();
            let m = Motion::rotation(integers([0, 0, 2]), &angle).unwrap().rotation_f64();
            prop_assert!((m[(1, 0)] - degrees.to_radians().sin()).abs() < 1e-15);
            prop_assert!((m[(0, 0)] - degrees.to_radians().cos()).abs() < 1e-15);
        }
    }
}
