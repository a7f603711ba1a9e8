//! The pose from three lines and the planes through the eye and their images (P3L).
//!
//! Notation: n is the unit normal of a plane through the eye, p a point of a line of the part, d
//! its direction, R and t the rotation and translation of the part.
//!
//! The plane contains the line where n · R d = 0 and n · (R p + t) = 0. The first three equations
//! determine the rotation, and the others then the translation (M. Dhome, M. Richetin, J.-T.
//! Lapresté, G. Rives, PAMI 11, 1989; H. Chen, PAMI 13, 1991). R maps the first direction to u, at
//! the angle α in its plane, and the part is rotated about u by ψ. With w the normal of that plane
//! and v = w × u, the two other equations are A cos ψ + B sin ψ + C = 0, with A, B and C of degree
//! one in cos α and sin α. Eliminating ψ leaves a polynomial of degree eight in tan α/2. Its roots
//! are only starts: Newton's method refines each on the three equations, which decide whether it is
//! a solution.

use super::equations::{DISTINCT, Equations as Solved, Linearised};
use super::polynomial::proposals;
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use premio_kernel::geometry::frame::Frame;

/// A line of a part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartLine {
    /// A point of it.
    pub point: Point3<f64>,
    /// Its direction, of length one.
    pub direction: Vector3<f64>,
}

/// If the determinant of the planes' normals is smaller than this, the planes intersect in one line
/// up to rounding.
const FLAT: f64 = 1.0 / (1 << 20) as f64;
/// A polynomial is identically zero if no coefficient is greater than this.
const NOTHING: f64 = 1.0 / (1u64 << 48) as f64;

/// The poses of the part in the camera's frame at which its three lines lie in three planes through
/// the eye: all solutions, up to eight, a double one once. The unit normals are in the camera's
/// frame. The lines need not lie in front of the camera.
///
/// None where the planes intersect in a line through the eye, as for three lines with a common
/// point: the distance is then not determined, though [`rotations`] are. None, either, where the
/// rotation is not determined: for three parallel lines, and for two parallel ones in the same
/// plane.
pub fn poses(lines: &[PartLine; 3], normals: &[Vector3<f64>; 3]) -> Vec<Isometry3<f64>> {
    let planes = Matrix3::from_rows(&normals.map(|n| n.transpose()));
    if planes.determinant().abs() < FLAT {
        return Vec::new();
    }
    let lu = planes.lu();
    let pose = |rotation: UnitQuaternion<f64>| {
        let off = |i: usize| normals[i].dot(&(rotation * lines[i].point.coords));
        let shift = lu.solve(&-Vector3::new(off(0), off(1), off(2)))?;
        Some(Isometry3::from_parts(Translation3::from(shift), rotation))
    };
    let all = rotations(&lines.map(|l| l.direction), normals).into_iter();
    all.filter_map(pose).collect()
}

/// The rotations of the part into the camera's frame that map three directions into three planes;
/// all vectors are of length one. All solutions, up to eight, a double one once; none where the
/// solutions are not isolated.
pub fn rotations(
    directions: &[Vector3<f64>; 3],
    normals: &[Vector3<f64>; 3],
) -> Vec<UnitQuaternion<f64>> {
    let equations = Equations {
        directions: *directions,
        normals: *normals,
    };
    let mut found = Vec::new();
    for start in equations.proposals() {
        if let Some(rotation) = equations.solution(start) {
            equations.add(rotation, &mut found);
        }
    }
    found.retain(|rotation| !equations.is_free(rotation));
    found
}

struct Equations {
    directions: [Vector3<f64>; 3],
    normals: [Vector3<f64>; 3],
}

impl Equations {
    /// Candidate rotations.
    fn proposals(&self) -> Vec<UnitQuaternion<f64>> {
        let angles = Angles::new(self);
        let mut found = Vec::new();
        // tan α/2 is at most one in magnitude on one half of the circle, and tan (α − π)/2 on the
        // other.
        for half in [1.0, -1.0] {
            let k = angles.polynomial(half);
            if k.iter().all(|c| c.abs() < NOTHING) {
                return Vec::new();
            }
            for t in proposals(&k, [-1.0, 1.0]) {
                let whole = half / (1.0 + t * t);
                found.extend(angles.rotations(whole * (1.0 - t * t), whole * 2.0 * t));
            }
        }
        found
    }

    /// Whether the equations also hold for further rotations about an axis.
    fn is_free(&self, rotation: &UnitQuaternion<f64>) -> bool {
        let slope = self.value(rotation).slope;
        if slope.determinant().abs() > FLAT {
            return false;
        }
        let row = |i: usize| slope.row(i).transpose();
        let axes = [(0, 1), (1, 2), (2, 0)].map(|(i, j)| row(i).cross(&row(j)));
        let longest = axes.iter().max_by(|a, b| a.norm().total_cmp(&b.norm()));
        let Some(axis) = longest.and_then(|a| a.try_normalize(FLAT)) else {
            return true;
        };
        // A quarter of a radian: far from any double root.
        let turned = UnitQuaternion::from_scaled_axis(axis * 0.25) * rotation;
        self.miss(&turned) < FLAT
    }
}

impl Solved for Equations {
    type Unknown = UnitQuaternion<f64>;

    /// The cosines that are to be zero, and their derivatives by a rotation about the camera's
    /// axes.
    fn value(&self, rotation: &UnitQuaternion<f64>) -> Linearised {
        let turned = self.directions.map(|d| rotation * d);
        let value = [0, 1, 2].map(|i| self.normals[i].dot(&turned[i]));
        let slope = [0, 1, 2].map(|i| turned[i].cross(&self.normals[i]).transpose());
        Linearised {
            value: Vector3::from(value),
            slope: Matrix3::from_rows(&slope),
        }
    }

    fn miss(&self, rotation: &UnitQuaternion<f64>) -> f64 {
        self.value(rotation).value.amax()
    }

    fn stepped(&self, at: &UnitQuaternion<f64>, step: &Vector3<f64>) -> UnitQuaternion<f64> {
        UnitQuaternion::from_scaled_axis(-step) * at
    }

    fn middle(
        &self,
        a: &UnitQuaternion<f64>,
        b: &UnitQuaternion<f64>,
    ) -> Option<UnitQuaternion<f64>> {
        (a.angle_to(b) <= DISTINCT).then(|| middle(a, b))
    }
}

/// The midpoint of two nearby rotations. An interpolation by angles loses the digits of small ones.
fn middle(a: &UnitQuaternion<f64>, b: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    let (a, b) = (a.into_inner(), b.into_inner());
    let sign = 1.0f64.copysign(a.dot(&b));
    UnitQuaternion::new_normalize(a + b * sign)
}

/// The equations in the angles α and ψ.
struct Angles {
    /// The axes of the plane of the first line, and its normal.
    plane: Frame,
    /// The axes perpendicular to the first direction, and that direction.
    part: Frame,
    /// By other line: the components of its direction along these axes of the part, and of its
    /// normal along the axes of the plane.
    others: [[Vector3<f64>; 2]; 2],
}

/// The coefficients A, B, C of A cos ψ + B sin ψ + C, each as a constant and its factors of cos α
/// and sin α.
type Terms = [[f64; 3]; 3];

impl Angles {
    fn new(equations: &Equations) -> Self {
        let plane = Frame::about(Point3::origin(), equations.normals[0]);
        let part = Frame::about(Point3::origin(), equations.directions[0]);
        let other = |i: usize| {
            let direction = part.components(&equations.directions[i]);
            [direction, plane.components(&equations.normals[i])]
        };
        Self {
            others: [other(1), other(2)],
            plane,
            part,
        }
    }

    /// n · R d = d_z n·u + d_x (n·v cos ψ + n·w sin ψ) + d_y (n·w cos ψ − n·v sin ψ), with
    /// n·u = n_x cos α + n_y sin α and n·v = n_y cos α − n_x sin α.
    fn terms(&self, i: usize) -> Terms {
        let [d, n] = &self.others[i];
        [
            [d.y * n.z, d.x * n.y, -d.x * n.x],
            [d.x * n.z, -d.y * n.y, d.y * n.x],
            [0.0, d.z * n.x, d.z * n.y],
        ]
    }

    /// The resultant of both equations without ψ, times (1 + t²)⁴ with t = tan α/2; on the other
    /// half of the circle t = tan (α − π)/2.
    fn polynomial(&self, half: f64) -> [f64; 9] {
        let by_tangent = |[k, c, s]: [f64; 3]| {
            let (c, s) = (half * c, half * s);
            [k + c, 2.0 * s, k - c]
        };
        let [[a, b, c], [d, e, f]] = [0, 1].map(|i| self.terms(i).map(by_tangent));
        // By Cramer's rule, cos ψ = x/z and sin ψ = y/z.
        let x = difference(&product(&b, &f), &product(&c, &e));
        let y = difference(&product(&c, &d), &product(&a, &f));
        let z = difference(&product(&a, &e), &product(&b, &d));
        let mut k = [0.0; 9];
        for i in 0..5 {
            for j in 0..5 {
                k[i + j] += x[i] * x[j] + y[i] * y[j] - z[i] * z[j];
            }
        }
        k
    }

    /// The rotations at an α, from the equation that determines ψ better.
    fn rotations(&self, cos: f64, sin: f64) -> [UnitQuaternion<f64>; 2] {
        let at = |[k, c, s]: [f64; 3]| k + c * cos + s * sin;
        let [first, second] = [0, 1].map(|i| self.terms(i).map(at));
        let amplitude = |[a, b, _]: &[f64; 3]| a.hypot(*b);
        let better = amplitude(&first) >= amplitude(&second);
        let [a, b, c] = if better { first } else { second };
        let middle = b.atan2(a);
        let half_angle = (-c / a.hypot(b)).clamp(-1.0, 1.0).acos();
        [middle - half_angle, middle + half_angle].map(|psi| self.rotation([cos, sin], psi))
    }

    fn rotation(&self, [cos, sin]: [f64; 2], psi: f64) -> UnitQuaternion<f64> {
        let (e, f, w) = (self.plane.x, self.plane.y, self.plane.z);
        let u = e * cos + f * sin;
        let v = f * cos - e * sin;
        let x = v * psi.cos() + w * psi.sin();
        let to = Matrix3::from_columns(&[x, u.cross(&x), u]);
        let from = Matrix3::from_columns(&[self.part.x, self.part.y, self.part.z]);
        let rotation = Rotation3::from_matrix_unchecked(to * from.transpose());
        UnitQuaternion::from_rotation_matrix(&rotation)
    }
}

/// The product of two polynomials of degree two.
fn product(a: &[f64; 3], b: &[f64; 3]) -> [f64; 5] {
    let mut c = [0.0; 5];
    for i in 0..3 {
        for j in 0..3 {
            c[i + j] += a[i] * b[j];
        }
    }
    c
}

fn difference(a: &[f64; 5], b: &[f64; 5]) -> [f64; 5] {
    [0, 1, 2, 3, 4].map(|i| a[i] - b[i])
}

#[cfg(test)]
mod tests {
    use super::super::tests::{apart, direction, point, pose};
    use super::*;
    use proptest::prelude::*;

    fn line(point: Point3<f64>, direction: Vector3<f64>) -> PartLine {
        PartLine { point, direction }
    }

    /// The planes through the eye and the lines at a planted pose.
    fn planes(lines: &[PartLine; 3], planted: &Isometry3<f64>) -> [Vector3<f64>; 3] {
        lines.map(|l| {
            let at = (planted * l.point).coords;
            at.cross(&(planted * l.direction)).normalize()
        })
    }

    /// How well a pose is determined: by the normals, and by the rotations that move directions out
    /// of the planes.
    fn determinacy(lines: &[PartLine; 3], planted: &Isometry3<f64>) -> f64 {
        let normals = planes(lines, planted);
        let turns = [0, 1, 2].map(|i| (planted * lines[i].direction).cross(&normals[i]));
        let of = |rows: [Vector3<f64>; 3]| rows[0].cross(&rows[1]).dot(&rows[2]).abs();
        of(normals).min(of(turns))
    }

    /// The distance of the nearest pose found from the planted one. Each pose is checked against
    /// the planes.
    fn nearest(lines: &[PartLine; 3], planted: &Isometry3<f64>) -> f64 {
        let normals = planes(lines, planted);
        let found = poses(lines, &normals);
        assert!(found.len() <= 8, "{found:?}");
        for pose in &found {
            for (l, n) in lines.iter().zip(&normals) {
                assert!(n.dot(&(pose * l.direction)).abs() < 1e-11);
                let off = n.dot(&(pose * l.point).coords).abs();
                assert!(
                    off < 1e-11 * (1.0 + pose.translation.vector.norm()),
                    "{off}"
                );
            }
        }
        for (i, a) in found.iter().enumerate() {
            assert!(found[..i].iter().all(|b| apart(a, b) > 1e-9), "{found:?}");
        }
        let all = found.into_iter().map(|p| apart(&p, planted));
        all.fold(f64::INFINITY, f64::min)
    }

    fn any() -> impl Strategy<Value = PartLine> {
        (point(), direction()).prop_map(|(p, d)| line(p, d))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn a_planted_pose_is_found(lines in [any(), any(), any()], planted in pose(3.0..10.0)) {
            prop_assume!(determinacy(&lines, &planted) > 1e-4);
            prop_assert!(nearest(&lines, &planted) < 1e-6);
        }

        #[test]
        fn nearly_parallel_lines_are_found(
            p in [point(), point(), point()],
            d in [direction(), direction(), direction()],
            off in prop_oneof![Just(0.0), -1e-2..1e-2f64, -1e-5..1e-5f64, -1e-9..1e-9f64],
            which in 0..3usize,
            planted in pose(3.0..10.0),
        ) {
            let mut lines = [0, 1, 2].map(|i| line(p[i], d[i]));
            let next = NEXT[which];
            lines[next].direction = (d[which] + d[next] * off).normalize();
            prop_assume!(determinacy(&lines, &planted) > 1e-4);
            prop_assert!(nearest(&lines, &planted) < 1e-6);
        }

        /// Three directions of a block, in any order; square, or nearly so.
        #[test]
        fn directions_of_a_block_are_found(
            p in [point(), point(), point()],
            d in [direction(), direction(), direction()],
            off in prop_oneof![Just(0.0), -1e-2..1e-2f64, -1e-5..1e-5f64, -1e-9..1e-9f64],
            kinds in [0..3usize, 0..3usize, 0..3usize],
            planted in pose(3.0..10.0),
        ) {
            let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
            let lines = [0, 1, 2].map(|i| line(p[i], (axes[kinds[i]] + d[i] * off).normalize()));
            prop_assume!(determinacy(&lines, &planted) > 1e-4);
            prop_assert!(nearest(&lines, &planted) < 1e-6);
        }

        /// Two of the lines intersect.
        #[test]
        fn a_corner_and_a_line_are_found(
            p in [point(), point()],
            d in [direction(), direction(), direction()],
            planted in pose(3.0..10.0),
        ) {
            let lines = [line(p[0], d[0]), line(p[0], d[1]), line(p[1], d[2])];
            prop_assume!(determinacy(&lines, &planted) > 1e-4);
            prop_assert!(nearest(&lines, &planted) < 1e-6);
        }

        /// Where three lines have a common point, only the rotation is determined.
        #[test]
        fn a_corner_determines_its_rotation(
            p in point(),
            d in [direction(), direction(), direction()],
            square: bool,
            planted in pose(3.0..10.0),
        ) {
            let d = if square { [Vector3::x(), Vector3::y(), Vector3::z()] } else { d };
            let lines = d.map(|d| line(p, d));
            let normals = planes(&lines, &planted);
            prop_assert!(poses(&lines, &normals).is_empty());
            let turns = [0, 1, 2].map(|i| (planted * d[i]).cross(&normals[i]));
            prop_assume!(turns[0].cross(&turns[1]).dot(&turns[2]).abs() > 1e-4);
            let found = rotations(&d, &normals);
            let best = found.iter().map(|r| r.angle_to(&planted.rotation));
            prop_assert!(best.fold(f64::INFINITY, f64::min) < 1e-9);
        }

        #[test]
        fn parallel_lines_determine_no_pose(
            p in [point(), point(), point()],
            d in [direction(), direction()],
            planted in pose(3.0..10.0),
        ) {
            let lines = p.map(|p| line(p, d[0]));
            prop_assert!(poses(&lines, &planes(&lines, &planted)).is_empty());
            // Two of them in one plane with the eye.
            let behind = planted.inverse_transform_point(&((planted * p[0]) * 2.0));
            let lines = [line(p[0], d[0]), line(behind, d[0]), line(p[1], d[1])];
            let normals = planes(&lines, &planted);
            prop_assert!(poses(&lines, &normals).is_empty());
            prop_assert!(rotations(&lines.map(|l| l.direction), &normals).is_empty());
        }

        /// A rotation is chosen that moves no direction out of its plane: a double root.
        #[test]
        fn a_double_root_is_given_once(
            d in [direction(), direction(), direction()],
            axis in direction(),
            planted in pose(3.0..10.0),
        ) {
            let turned = d.map(|d| planted * d);
            // n is perpendicular to t, and t × n to the axis.
            let normals = turned.map(|t| t.cross(&axis.cross(&t)).normalize());
            let rows = [0, 1, 2].map(|i| turned[i].cross(&normals[i]));
            prop_assert!(rows.iter().all(|r| r.dot(&axis).abs() < 1e-12));
            let found = rotations(&d, &normals);
            let angles = found.iter().map(|r| r.angle_to(&planted.rotation));
            let near: Vec<f64> = angles.filter(|a| *a < 1e-5).collect();
            prop_assert_eq!(near.len(), 1, "{:?}", near);
        }
    }

    /// The line after each.
    const NEXT: [usize; 3] = [1, 2, 0];
}
