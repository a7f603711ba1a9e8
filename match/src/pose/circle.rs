//! The pose of a circle of known radius from the conic of its image (D. Forsyth et al., PAMI 13,
//! 1991; Q. Chen, H. Wu, T. Wada, ECCV 2004).
//!
//! Notation: C is the centre of the circle, r its radius, n its unit normal, x a line of sight, δ =
//! n·C, c = C/δ and ρ = r/δ.
//!
//! The lines of sight form the cone |δ x − C (n·x)|² = r² (n·x)². Its matrix, divided by δ², is Q =
//! I − c nᵀ − n cᵀ + (|c|² − ρ²) n nᵀ: the identity plus the product of two planes, n mᵀ + m nᵀ
//! with m = −c + (|c|² − ρ²)/2 n. The image determines the cone up to a factor. That factor is the
//! second eigenvalue. The other eigenvectors determine the two planes, and either may be that of
//! the circle. As n·c = 1, |c|² − ρ² = 2 (n·m + 1), c = (n·m + 1) n − m, and δ = r/ρ.

use crate::camera::Pinhole;
use nalgebra::{
    Isometry3, Matrix3, Point3, Rotation3, SymmetricEigen, Translation3, UnitQuaternion, Vector3,
};
use premio_kernel::geometry::frame::Frame;
use std::f64::consts::TAU;

/// A visible circle, in the camera's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenCircle {
    /// Its centre, in the unit of the radius.
    pub centre: Point3<f64>,
    /// Its unit normal, on the side of the eye.
    pub normal: Vector3<f64>,
}

/// Eigenvalues with a smaller relative difference are equal up to rounding: the cone is circular.
const ROUND: f64 = 1.0 / (1u64 << 48) as f64;

/// The circles of a radius whose image is the conic a x² + b x y + c y² + d x + e y + f = 0, x to
/// the right and y down in pixels. The centre lies in front of the camera, z > 0. There are two;
/// one where the circle's centre is on the axis of its cone, and none where the conic is not that
/// of a cone.
pub fn circles(conic: &[f64; 6], camera: &Pinhole, radius: f64) -> Vec<SeenCircle> {
    let Some([first, middle, last]) = axes(conic, camera) else {
        return Vec::new();
    };
    // The planes are a v₁ + b v₃ and a v₁ − b v₃.
    let a = first.eigenvalue / middle.eigenvalue - 1.0;
    let b = 1.0 - last.eigenvalue / middle.eigenvalue;
    let [v, w] = [first.eigenvector * a.sqrt(), last.eigenvector * b.sqrt()];
    let planes = [[w + v, v - w], [w - v, -w - v]];
    let count = if a > ROUND * b { 2 } else { 1 };
    let circle = |[p, q]: &[Vector3<f64>; 2]| {
        let length = p.norm();
        let (n, m) = (p / length, q * (0.5 * length));
        let along = n.dot(&m) + 1.0;
        let c = n * along - m;
        let ratio = (c.norm_squared() - 2.0 * along).sqrt();
        let depth = (radius / ratio).copysign(c.z);
        let centre = Point3::from(c * depth);
        let normal = n * -1.0f64.copysign(c.z);
        // A ratio that is NaN is rejected, too.
        (ratio > 0.0 && centre.z > 0.0).then_some(SeenCircle { centre, normal })
    };
    planes[..count].iter().filter_map(circle).collect()
}

/// An axis of a cone.
struct ConeAxis {
    eigenvalue: f64,
    eigenvector: Vector3<f64>,
}

/// The axes of the cone of a conic in falling order of the eigenvalues, two positive and one
/// negative.
fn axes(conic: &[f64; 6], camera: &Pinhole) -> Option<[ConeAxis; 3]> {
    let [a, b, c, d, e, f] = *conic;
    let (b, d, e) = (0.5 * b, 0.5 * d, 0.5 * e);
    let k = camera.matrix();
    let cone = k.transpose() * Matrix3::new(a, b, d, b, c, e, d, e, f) * k;
    let size = cone.amax();
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    let cone = cone / size;
    // With two eigenvalues of another sign the determinant has that of the third.
    let cone = cone * -cone.determinant().signum();
    let eigen = SymmetricEigen::new(cone);
    let axis = |i: usize| ConeAxis {
        eigenvalue: eigen.eigenvalues[i],
        eigenvector: eigen.eigenvectors.column(i).into_owned(),
    };
    let mut axes = [axis(0), axis(1), axis(2)];
    axes.sort_by(|p, q| q.eigenvalue.total_cmp(&p.eigenvalue));
    (axes[1].eigenvalue > 0.0 && axes[2].eigenvalue < 0.0).then_some(axes)
}

/// The poses of the part in the camera's frame at which a circular edge of the part is a given
/// circle: first with the edge's axis along the circle's normal, then against it. Each is rotated
/// about the axis in `turns` equal steps from an arbitrary direction. `edge` has its origin in the
/// centre of the edge, in the part's frame, and z along the axis.
pub fn edge_poses(edge: &Frame, seen: &SeenCircle, turns: usize) -> Vec<Isometry3<f64>> {
    let from = columns(edge).transpose();
    let pose = |axis: Vector3<f64>, k: usize| {
        let about = UnitQuaternion::from_scaled_axis(axis * (TAU * k as f64 / turns as f64));
        let to = columns(&Frame::about(seen.centre, axis));
        let rotation = Rotation3::from_matrix_unchecked(to * from);
        let rotation = about * UnitQuaternion::from_rotation_matrix(&rotation);
        let shift = seen.centre - rotation * edge.origin;
        Isometry3::from_parts(Translation3::from(shift), rotation)
    };
    let senses = [seen.normal, -seen.normal].into_iter();
    senses
        .flat_map(|axis| (0..turns).map(move |k| pose(axis, k)))
        .collect()
}

fn columns(frame: &Frame) -> Matrix3<f64> {
    Matrix3::from_columns(&[frame.x, frame.y, frame.z])
}

#[cfg(test)]
mod tests {
    use super::super::tests::{CAMERA, direction, pose};
    use super::*;
    use proptest::prelude::*;

    /// The conic of the image of a circle.
    fn image(centre: &Point3<f64>, n: &Vector3<f64>, radius: f64) -> [f64; 6] {
        let c = centre.coords;
        let d = n.dot(&c);
        let mixed = c * n.transpose() + n * c.transpose();
        let plane = n * n.transpose();
        let square = c.norm_squared() - radius * radius;
        let cone = Matrix3::identity() * (d * d) - mixed * d + plane * square;
        let k = CAMERA.matrix().try_inverse().unwrap();
        let q = k.transpose() * cone * k;
        let (xy, x, y) = (2.0 * q[(0, 1)], 2.0 * q[(0, 2)], 2.0 * q[(1, 2)]);
        [q[(0, 0)], xy, q[(1, 1)], x, y, q[(2, 2)]]
    }

    /// The greatest distance of points of a circle from a conic, in pixels, to first order.
    fn off(circle: &SeenCircle, radius: f64, [a, b, c, d, e, f]: &[f64; 6]) -> f64 {
        let frame = Frame::about(circle.centre, circle.normal);
        let at = |k: usize| {
            let (sin, cos) = (0.5 * k as f64).sin_cos();
            let p = CAMERA.project(&frame.point(radius * cos, radius * sin, 0.0));
            let value = a * p.x * p.x + b * p.x * p.y + c * p.y * p.y + d * p.x + e * p.y + f;
            let slope = [2.0 * a * p.x + b * p.y + d, b * p.x + 2.0 * c * p.y + e];
            value.abs() / slope[0].hypot(slope[1])
        };
        (0..13).map(at).fold(0.0, f64::max)
    }

    fn check(planted: &SeenCircle, radius: f64, limit: f64) -> Result<(), TestCaseError> {
        let conic = image(&planted.centre, &planted.normal, radius);
        let conic = conic.map(|k| k * -7.0);
        let found = circles(&conic, &CAMERA, radius);
        prop_assert!((1..=2).contains(&found.len()), "{found:?}");
        for circle in &found {
            prop_assert!(circle.normal.dot(&circle.centre.coords) < 0.0);
            prop_assert!(off(circle, radius, &conic) < 1e-6, "{circle:?}");
        }
        let near = |c: &SeenCircle| {
            let shift = (c.centre - planted.centre).norm() / planted.centre.z;
            shift.max((c.normal - planted.normal).norm())
        };
        let best = found.iter().map(near).fold(f64::INFINITY, f64::min);
        prop_assert!(best < limit, "{best}");
        Ok(())
    }

    /// A circle with a normal towards the eye, at the position of a pose.
    fn towards(pose: &Isometry3<f64>, n: &Vector3<f64>) -> SeenCircle {
        let centre = Point3::from(pose.translation.vector);
        let normal = n * -1.0f64.copysign(n.dot(&centre.coords));
        SeenCircle { centre, normal }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]

        #[test]
        fn a_planted_circle_is_found(n in direction(), at in pose(3.0..30.0), radius in 0.2..1.0f64) {
            let planted = towards(&at, &n);
            let sight = planted.centre.coords.normalize();
            let cosine = -sight.dot(&planted.normal);
            prop_assume!(cosine > 0.03);
            prop_assume!(cosine < 0.999);
            check(&planted, radius, 1e-6)?;
        }

        /// A circle viewed along its axis or nearly so. Rounding changes a double root by the
        /// square root of its size.
        #[test]
        fn a_circle_from_above_is_found(
            n in direction(),
            at in pose(3.0..10.0),
            off in prop_oneof![Just(0.0), 0.0..1e-2f64, 0.0..1e-5f64, 0.0..1e-8f64],
        ) {
            let sight = Vector3::new(at.translation.x, at.translation.y, at.translation.z).normalize();
            let normal = (n * off - sight).normalize();
            let centre = Point3::from(at.translation.vector);
            check(&SeenCircle { centre, normal }, 0.5, 1e-4)?;
        }

        #[test]
        fn edges_lie_on_the_circle(
            z in direction(),
            origin in super::super::tests::point(),
            n in direction(),
            at in pose(3.0..10.0),
            turns in 1..9usize,
        ) {
            let (edge, seen) = (Frame::about(origin, z), towards(&at, &n));
            let poses = edge_poses(&edge, &seen, turns);
            prop_assert_eq!(poses.len(), 2 * turns);
            for (i, pose) in poses.iter().enumerate() {
                prop_assert!((pose * edge.origin - seen.centre).norm() < 1e-10);
                let sense = if i < turns { 1.0 } else { -1.0 };
                prop_assert!((pose * edge.z - seen.normal * sense).norm() < 1e-12);
                let before = &poses[(i + 1) % turns + i / turns * turns];
                let angle = before.rotation.angle_to(&pose.rotation);
                let step = TAU / turns as f64;
                prop_assert!((angle - step.min(TAU - step)).abs() < 1e-7);
            }
        }
    }

    #[test]
    fn a_circle_along_the_axis_of_its_cone_is_given_once() {
        let camera = Pinhole {
            focal: [1024.0, 1024.0],
            centre: [512.0, 256.0],
            skew: 0.0,
        };
        // (x - 512)² + (y - 256)² = 128²
        let f = 512.0 * 512.0 + 256.0 * 256.0 - 128.0 * 128.0;
        let found = circles(&[1.0, 0.0, 1.0, -1024.0, -512.0, f], &camera, 2.0);
        assert_eq!(found.len(), 1);
        assert!((found[0].centre - Point3::new(0.0, 0.0, 16.0)).norm() < 1e-9);
        assert!((found[0].normal + Vector3::z()).norm() < 1e-9);
    }

    #[test]
    fn what_is_no_cone_is_no_circle() {
        for conic in [[0.0; 6], [1.0, 0.0, 1.0, 0.0, 0.0, 1.0], [f64::NAN; 6]] {
            assert!(circles(&conic, &CAMERA, 1.0).is_empty());
        }
    }
}
