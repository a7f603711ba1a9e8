//! The pose from three points and their lines of sight (P3P).
//!
//! The points lie at the depths λ along the unit rays y, and their distances are those in the part:
//! |λᵢ yᵢ − λⱼ yⱼ|² = aᵢⱼ, three quadratic forms in λ (Grunert 1841). Two combinations without a
//! constant term are cones through the solutions. As in Lambda Twist (M. Persson, K. Nordberg, ECCV
//! 2018, section 3), a root of a cubic gives a cone of their pencil that is a pair of planes. Each
//! plane intersects another cone of the pencil in up to two lines. Here the cubic is homogeneous in
//! the pencil, so it treats all its cones alike. Newton's method refines each proposal on the three
//! equations, which decide whether it is a solution.

use super::equations::{DISTINCT, Equations as Solved, Linearised};
use super::polynomial::crossings;
use nalgebra::{
    Isometry3, Matrix3, Point3, Rotation3, SymmetricEigen, Translation3, UnitQuaternion, Vector3,
};
use premio_kernel::geometry::frame::perpendicular;

/// Points are collinear if twice the area of their triangle is at most this share of the longest
/// squared distance. They then do not determine the rotation about their line.
const FLAT: f64 = 1.0 / (1 << 20) as f64;
/// A discriminant that is negative by no more than this part may be zero.
const SLACK: f64 = 1.0 / (1 << 10) as f64;

/// The poses of the part in the camera's frame at which three points of the part lie in front of
/// the camera on three rays of length one: all solutions, up to four, a double one once. None where
/// the points are collinear or rays coincide.
pub fn poses(points: &[Point3<f64>; 3], rays: &[Vector3<f64>; 3]) -> Vec<Isometry3<f64>> {
    let Some(equations) = Equations::new(points, rays) else {
        return Vec::new();
    };
    let mut found: Vec<Vector3<f64>> = Vec::new();
    for start in equations.proposals() {
        if let Some(depths) = equations.solution(start).filter(|d| d.min() > 0.0) {
            equations.add(depths, &mut found);
        }
    }
    let seen = |depths: &Vector3<f64>| [0, 1, 2].map(|i| rays[i] * depths[i]);
    let pose = |depths: &Vector3<f64>| moved_onto(points, &seen(depths));
    found.iter().filter_map(pose).collect()
}

/// The equations of the depths, one for each side of the triangle: k is that from point k to the
/// next.
struct Equations {
    rays: [Vector3<f64>; 3],
    /// The squared distances a.
    squares: [f64; 3],
    /// The shortest distance.
    shortest: f64,
}

/// The point after k.
const NEXT: [usize; 3] = [1, 2, 0];

impl Equations {
    fn new(points: &[Point3<f64>; 3], rays: &[Vector3<f64>; 3]) -> Option<Self> {
        let sides = [0, 1, 2].map(|k| points[NEXT[k]] - points[k]);
        let squares = sides.map(|s| s.norm_squared());
        let longest = squares.iter().fold(0.0, |a: f64, b| a.max(*b));
        let spread = sides[0].cross(&sides[1]).norm() > FLAT * longest;
        let distinct = (0..3).all(|k| rays[k].cross(&rays[NEXT[k]]).norm() > 0.0);
        let shortest = squares.iter().fold(longest, |a, b| a.min(*b)).sqrt();
        (spread && distinct).then_some(Self {
            rays: *rays,
            squares,
            shortest,
        })
    }

    /// The quadratic form of a side.
    fn form(&self, k: usize) -> Matrix3<f64> {
        let (i, j) = (k, NEXT[k]);
        let cosine = self.rays[i].dot(&self.rays[j]);
        let mut form = Matrix3::zeros();
        form[(i, i)] = 1.0;
        form[(j, j)] = 1.0;
        form[(i, j)] = -cosine;
        form[(j, i)] = -cosine;
        form
    }

    /// Candidate depths.
    fn proposals(&self) -> Vec<Vector3<f64>> {
        let forms = [0, 1, 2].map(|k| self.form(k));
        let [a, b, c] = self.squares;
        let cones = [forms[0] * b - forms[1] * a, forms[2] * b - forms[1] * c];
        let Some(pair) = Pair::new(&cones.map(|m| m / m.norm())) else {
            return Vec::new();
        };
        let sum = forms[0] + forms[1] + forms[2];
        let whole = a + b + c;
        let mut found = Vec::new();
        for plane in &pair.planes {
            for depths in plane_section(&pair.other, plane) {
                let depths = if depths.sum() < 0.0 { -depths } else { depths };
                let square = depths.dot(&(sum * depths));
                if depths.min() > 0.0 && square > 0.0 {
                    found.push(depths * (whole / square).sqrt());
                }
            }
        }
        found
    }
}

impl Solved for Equations {
    type Unknown = Vector3<f64>;

    /// The relative errors of the squared side lengths, and their derivatives by the depths.
    fn value(&self, depths: &Vector3<f64>) -> Linearised {
        let mut value = Vector3::zeros();
        let mut slope = Matrix3::zeros();
        for (k, square) in self.squares.iter().enumerate() {
            let (i, j) = (k, NEXT[k]);
            // The difference of the points: the quadratic form loses digits for a distant part.
            let side = self.rays[i] * depths[i] - self.rays[j] * depths[j];
            value[k] = side.norm_squared() / square - 1.0;
            slope[(k, i)] = 2.0 * self.rays[i].dot(&side) / square;
            slope[(k, j)] = -2.0 * self.rays[j].dot(&side) / square;
        }
        Linearised { value, slope }
    }

    /// The residual, in units of the rounding error for a distant part.
    fn miss(&self, depths: &Vector3<f64>) -> f64 {
        self.value(depths).value.amax() / (1.0 + depths.max() / self.shortest)
    }

    fn stepped(&self, at: &Vector3<f64>, step: &Vector3<f64>) -> Vector3<f64> {
        at - step
    }

    fn middle(&self, a: &Vector3<f64>, b: &Vector3<f64>) -> Option<Vector3<f64>> {
        ((a - b).amax() <= DISTINCT * b.max()).then(|| (a + b) * 0.5)
    }
}

/// A pair of planes of a pencil of cones, and another cone of it.
struct Pair {
    /// Their normals.
    planes: [Vector3<f64>; 2],
    other: Matrix3<f64>,
}

impl Pair {
    /// The best-conditioned pair of planes of the pencil: it has the greatest product of
    /// eigenvalues of different signs.
    fn new([a, b]: &[Matrix3<f64>; 2]) -> Option<Self> {
        let mut best: Option<(f64, Self)> = None;
        for [x, y] in degenerate(a, b) {
            let eigen = SymmetricEigen::new(a * x + b * y);
            let (high, low) = (eigen.eigenvalues.imax(), eigen.eigenvalues.imin());
            let [h, l] = [high, low].map(|i| eigen.eigenvalues[i]);
            let product = h.max(0.0) * (-l).max(0.0);
            let (v, w) = (
                eigen.eigenvectors.column(high) * h.max(0.0).sqrt(),
                eigen.eigenvectors.column(low) * (-l).max(0.0).sqrt(),
            );
            if best.as_ref().is_none_or(|(p, _)| product > *p) {
                let planes = [v + w, v - w];
                let other = b * x - a * y;
                best = Some((product, Self { planes, other }));
            }
        }
        Some(best?.1)
    }
}

/// The unit vectors (x, y) for which the determinant of x a + y b is zero.
fn degenerate(a: &Matrix3<f64>, b: &Matrix3<f64>) -> Vec<[f64; 2]> {
    // The sum of determinants with one column from `one` and the others from `rest`.
    let mixed = |one: &Matrix3<f64>, rest: &Matrix3<f64>| {
        let column = |i: usize| {
            let mut m = *rest;
            m.set_column(i, &one.column(i));
            m.determinant()
        };
        column(0) + column(1) + column(2)
    };
    let k = [a.determinant(), mixed(b, a), mixed(a, b), b.determinant()];
    let reversed = [k[3], k[2], k[1], k[0]];
    let ratios = crossings(&k, [-1.0, 1.0]).into_iter().map(|y| [1.0, y]);
    let others = crossings(&reversed, [-1.0, 1.0]).into_iter();
    let all = ratios.chain(others.map(|x| [x, 1.0]));
    all.map(|[x, y]| [x / x.hypot(y), y / x.hypot(y)]).collect()
}

/// The unit vectors along which a cone intersects a plane through its apex.
fn plane_section(cone: &Matrix3<f64>, plane: &Vector3<f64>) -> Vec<Vector3<f64>> {
    let Some(normal) = plane.try_normalize(0.0) else {
        return Vec::new();
    };
    let u = perpendicular(&normal);
    let v = normal.cross(&u);
    // (x u + y v)ᵀ cone (x u + y v) = a x² + 2 b x y + c y².
    let (a, b, c) = (u.dot(&(cone * u)), u.dot(&(cone * v)), v.dot(&(cone * v)));
    let inside = b * b - a * c;
    if inside < -SLACK * (a * a + b * b + c * c) {
        return Vec::new();
    }
    let h = -(b + inside.max(0.0).sqrt().copysign(b));
    let along = |[x, y]: [f64; 2]| (u * x + v * y).try_normalize(0.0);
    [[h, a], [c, h]].into_iter().filter_map(along).collect()
}

/// The rigid motion that maps three points to three others with the same distances.
fn moved_onto(points: &[Point3<f64>; 3], seen: &[Vector3<f64>; 3]) -> Option<Isometry3<f64>> {
    let from = points.map(|p| p.coords);
    let length = |k: &usize| (from[NEXT[*k]] - from[*k]).norm_squared();
    // The longest side determines directions best.
    let k = (0..3).max_by(|a, b| length(a).total_cmp(&length(b)))?;
    let triad = |p: &[Vector3<f64>; 3]| {
        let (o, a, b) = (p[k], p[NEXT[k]], p[NEXT[NEXT[k]]]);
        let x = (a - o).try_normalize(0.0)?;
        let z = x.cross(&(b - o)).try_normalize(0.0)?;
        Some(Matrix3::from_columns(&[x, z.cross(&x), z]))
    };
    let rotation = triad(seen)? * triad(&from)?.transpose();
    let rotation = Rotation3::from_matrix_unchecked(rotation);
    let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
    let middle = |p: &[Vector3<f64>; 3]| (p[0] + p[1] + p[2]) / 3.0;
    let shift = middle(seen) - rotation * middle(&from);
    Some(Isometry3::from_parts(Translation3::from(shift), rotation))
}

#[cfg(test)]
mod tests {
    use super::super::tests::{apart, point, pose};
    use super::*;
    use proptest::prelude::*;

    /// The poses found for points at a planted pose, each checked against the rays.
    fn found(points: &[Point3<f64>; 3], planted: &Isometry3<f64>) -> Vec<Isometry3<f64>> {
        let rays = points.map(|p| (planted * p).coords.normalize());
        let found = poses(points, &rays);
        assert!(found.len() <= 4, "{found:?}");
        for pose in &found {
            for (p, ray) in points.iter().zip(&rays) {
                let seen = (pose * p).coords;
                assert!(seen.dot(ray) > 0.0);
                assert!(seen.cross(ray).norm() < 1e-9 * seen.norm(), "{pose}");
            }
        }
        for (i, a) in found.iter().enumerate() {
            assert!(found[..i].iter().all(|b| apart(a, b) > 1e-9), "{found:?}");
        }
        found
    }

    fn nearest(points: &[Point3<f64>; 3], planted: &Isometry3<f64>) -> f64 {
        let all = found(points, planted).into_iter();
        all.map(|p| apart(&p, planted))
            .fold(f64::INFINITY, f64::min)
    }

    /// The conditioning of three points: twice the area of the triangle over the square of the
    /// longest side.
    fn slimness(p: &[Point3<f64>; 3]) -> f64 {
        let s = [0, 1, 2].map(|k| p[NEXT[k]] - p[k]);
        let longest = s.iter().map(|s| s.norm_squared()).fold(0.0, f64::max);
        s[0].cross(&s[1]).norm() / longest
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn a_planted_pose_is_found(p in [point(), point(), point()], planted in pose(3.0..30.0)) {
            prop_assume!(slimness(&p) > 0.02);
            prop_assert!(nearest(&p, &planted) < 1e-6);
        }

        /// Near the danger cylinder, which contains the points and is perpendicular to their plane,
        /// two roots coincide. Rounding changes a double root by the square root of its size.
        #[test]
        fn a_pose_next_to_the_danger_cylinder_is_found(
            angles in [0.0..2.0f64, 2.2..4.2f64, 4.4..6.2f64],
            at in 0.0..std::f64::consts::TAU,
            height in 1.0..8.0f64,
            off in prop_oneof![Just(0.0), -1e-2..1e-2f64, -1e-4..1e-4f64, -1e-6..1e-6f64, -1e-9..1e-9f64],
            planted in pose(0.0..1.0),
        ) {
            let p = angles.map(|a| Point3::new(a.cos(), a.sin(), 0.0));
            let eye = Point3::new((1.0 + off) * at.cos(), (1.0 + off) * at.sin(), height);
            let mut planted = planted;
            planted.translation = Translation3::from(-(planted.rotation * eye.coords));
            let limit = if off.abs() < 1e-5 { 3e-5 } else { 1e-6 };
            prop_assert!(nearest(&p, &planted) < limit);
        }

        /// The triangle from above its middle: the equations of all three sides are the same.
        #[test]
        fn a_regular_triangle_is_found(height in 0.2..50.0f64, off in prop_oneof![Just(0.0), -1e-7..1e-7f64]) {
            let p = [0.0, 1.0, 2.0].map(|k: f64| {
                let a = k * std::f64::consts::TAU / 3.0;
                Point3::new(a.cos(), a.sin(), 0.0)
            });
            let planted = Isometry3::translation(off, 0.0, height);
            prop_assert!(nearest(&p, &planted) < 1e-6);
        }
    }

    #[test]
    fn a_double_root_is_given_once() {
        let p = [0.3, 2.0, 4.4].map(|a: f64| Point3::new(a.cos(), a.sin(), 0.0));
        for k in 0..50 {
            let at = 0.1 * k as f64;
            let eye = Vector3::new(at.cos(), at.sin(), 3.0);
            let planted =
                Isometry3::from_parts(Translation3::from(eye), UnitQuaternion::identity());
            let planted = planted.inverse();
            let turned = UnitQuaternion::from_euler_angles(3.0, 0.0, 0.0);
            let planted = Isometry3::from_parts(Translation3::identity(), turned) * planted;
            let near = found(&p, &planted);
            let near = near.iter().filter(|q| apart(q, &planted) < 1e-4);
            assert_eq!(near.count(), 1, "{k}");
        }
    }

    #[test]
    fn collinear_points_determine_no_pose() {
        let p = [0.0, 1.0, 3.0].map(|x| Point3::new(x, 2.0 * x, -x));
        let planted = Isometry3::translation(0.3, -0.2, 9.0);
        assert!(found(&p, &planted).is_empty());
    }
}
