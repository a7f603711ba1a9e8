//! Limbs in closed form: how far surfaces are from touching a plane through the eye.
//!
//! Notation: n·x + d = 0 with |n| = 1 is the plane through the eye and the tangent of a limb's
//! image, in the part's frame; c is a centre, p a point of an axis, z its direction, a an apex, r
//! and R radii.
//!
//! The plane is tangent to the surface. It is tangent to a sphere where |n·c + d| = r. It is
//! tangent to a cylinder where it is parallel to the axis, n·z = 0, and |n·p + d| = r. It is
//! tangent to a cone where it contains the apex, n·a + d = 0, and |n·z| is the sine of the half
//! angle (M. Dhome, J.-T. Lapresté, G. Rives, M. Richetin, ECCV 1990). For a cylinder and a cone
//! this is equivalent to tangency to two inscribed balls at two heights of the axis, so that all
//! residuals are lengths. It is tangent to a torus where |n·c + d| = |R sin θ ± r|, with θ the
//! angle of n and the axis: it touches the ball of radius r about the nearest or the farthest point
//! of the spine.

use nalgebra::{Isometry3, Point3, Vector3, Vector6};
use premio_kernel::geometry::surface::Surface;

/// The distance of a plane from tangency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LimbPoint {
    /// The signed distance, in the part's unit: positive where the plane does not intersect the
    /// surface, negative where it cuts it.
    pub distance: f64,
    /// Its derivative by the rotation of the part about its origin, in radians about the camera's
    /// axes, and by the translation: the step of `refine::moved`.
    pub slope: Vector6<f64>,
}

/// The distances of a surface, of a part at a pose, from tangency to a plane through the eye with a
/// unit normal in the camera's frame. All are zero where the plane contains the eye and the tangent
/// of a limb. There is one for a sphere and a torus, and two for a cylinder and a cone: of the
/// inscribed balls at two heights of their frame's z axis, above the apex for a cone. There is none
/// for a plane, which has no limb.
///
/// Of a torus's two possible tangencies, the nearer one is used.
pub fn touches(
    normal: &Vector3<f64>,
    pose: &Isometry3<f64>,
    surface: &Surface,
    heights: [f64; 2],
) -> Vec<LimbPoint> {
    let plane = Plane { normal, pose };
    let frame = surface.frame();
    let at = |h: f64| frame.origin + frame.z * h;
    match surface {
        Surface::Plane(_) => Vec::new(),
        Surface::Sphere(s) => {
            let level = plane.level(&frame.origin);
            vec![level.on(level.distance).less(s.radius)]
        }
        Surface::Cylinder(s) => {
            let levels = heights.map(|h| plane.level(&at(h)));
            let side = levels[0].distance + levels[1].distance;
            levels.map(|l| l.on(side).less(s.radius)).to_vec()
        }
        Surface::Cone(s) => {
            let levels = heights.map(|h| plane.level(&at(h)));
            // The side of the plane on which the axis lies.
            let side = heights[0] * levels[0].distance + heights[1] * levels[1].distance;
            let touch = |i: usize| levels[i].on(side).less(heights[i] * s.sin);
            vec![touch(0), touch(1)]
        }
        Surface::Torus(s) => {
            let level = plane.level(&frame.origin);
            let level = level.on(level.distance);
            let reach = plane.across(&frame.z, s.major);
            let next = level.plus(&reach, -1.0);
            let next = next.on(next.distance).less(s.minor);
            let far = level.plus(&reach, 1.0).less(s.minor);
            let nearer = next.distance.abs() <= far.distance.abs();
            vec![if nearer { next } else { far }]
        }
    }
}

/// A plane through the eye, and the pose of a part.
struct Plane<'a> {
    normal: &'a Vector3<f64>,
    pose: &'a Isometry3<f64>,
}

impl Plane<'_> {
    /// The signed distance of a point of the part from the plane.
    fn level(&self, p: &Point3<f64>) -> LimbPoint {
        let turned = self.pose.rotation * p.coords;
        let turn = turned.cross(self.normal);
        LimbPoint {
            distance: self.normal.dot(&(turned + self.pose.translation.vector)),
            slope: stacked(&turn, self.normal),
        }
    }

    /// A length times the sine of the angle between the normal and an axis of the part.
    fn across(&self, axis: &Vector3<f64>, length: f64) -> LimbPoint {
        let axis = self.pose.rotation * axis;
        let cosine = self.normal.dot(&axis);
        let cross = axis.cross(self.normal);
        let sine = cross.norm();
        // Where the normal is along the axis, the sine is zero and has no derivative.
        let rate = if sine > 0.0 { -cosine / sine } else { 0.0 };
        LimbPoint {
            distance: length * sine,
            slope: stacked(&(cross * (length * rate)), &Vector3::zeros()),
        }
    }
}

fn stacked(turn: &Vector3<f64>, shift: &Vector3<f64>) -> Vector6<f64> {
    Vector6::new(turn.x, turn.y, turn.z, shift.x, shift.y, shift.z)
}

impl LimbPoint {
    /// The distance with the sign of a given side of the plane.
    fn on(self, side: f64) -> Self {
        let sign = 1.0f64.copysign(side);
        Self {
            distance: sign * self.distance,
            slope: self.slope * sign,
        }
    }

    fn less(self, radius: f64) -> Self {
        Self {
            distance: self.distance - radius,
            ..self
        }
    }

    fn plus(self, other: &Self, factor: f64) -> Self {
        Self {
            distance: self.distance + other.distance * factor,
            slope: self.slope + other.slope * factor,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::refine::moved;
    use super::super::tests::{CAMERA, direction, pose};
    use super::*;
    use premio_csg::evaluate::{EvaluationOptions, evaluate};
    use premio_csg::reader::{Format, ReadOptions, read};
    use premio_kernel::geometry::frame::Frame;
    use premio_kernel::geometry::surface::{Cone, Cylinder, Sphere, Torus};
    use premio_visibility::contours::ContourKind;
    use premio_visibility::contours::contours;
    use proptest::prelude::*;

    /// Checks the limbs that `visibility` finds at a pose against the plane of every tangent.
    fn check(description: &str, planted: &Isometry3<f64>, limbs: usize) {
        let (format, options) = (Format::Json, ReadOptions::default());
        let tree = read("limb", description.as_bytes(), format, &options)
            .unwrap()
            .tree;
        let evaluation = evaluate(&tree, &EvaluationOptions::default()).unwrap();
        let (brep, resolution) = (&evaluation.brep, evaluation.f64_resolution());
        let seen = contours(brep, &CAMERA.at(planted, [1280, 960]), resolution).unwrap();
        let of_limbs = seen.contours.iter().filter(|c| c.kind == ContourKind::Limb);
        let mut count = 0;
        for contour in of_limbs {
            count += 1;
            let surface = brep.surface(contour.faces[0]);
            for piece in &contour.pieces {
                for k in 1..20 {
                    let t = piece.range[0] + (piece.range[1] - piece.range[0]) * k as f64 / 20.0;
                    let at = (planted * contour.space_curve.point(t)).coords;
                    let along = planted * contour.space_curve.tangent(t);
                    let normal = at.cross(&along).normalize();
                    let touches = touches(&normal, planted, surface, [0.5, 2.0]);
                    assert!(!touches.is_empty());
                    for touch in touches {
                        assert!(touch.distance.abs() < 1e-9, "{touch:?} of {surface:?}");
                    }
                }
            }
        }
        assert!(count >= limbs, "{count}");
    }

    fn placed(z: f64) -> Isometry3<f64> {
        let turn = nalgebra::UnitQuaternion::from_euler_angles(1.9, 0.4, -0.7);
        Isometry3::from_parts(nalgebra::Translation3::new(0.4, -0.6, z), turn)
    }

    #[test]
    fn limbs_of_a_cylinder_touch() {
        check(
            r#"{"prim": "cylinder", "r": 1.5, "h": 4}"#,
            &placed(12.0),
            2,
        );
    }

    #[test]
    fn limbs_of_a_cone_touch() {
        check(r#"{"prim": "cone", "r": 1.5, "h": 4}"#, &placed(12.0), 2);
    }

    #[test]
    fn the_limb_of_a_sphere_touches() {
        check(r#"{"prim": "sphere", "r": 1.5}"#, &placed(9.0), 1);
    }

    #[test]
    fn limbs_of_a_torus_touch() {
        for turn in [0.1, 0.7, 1.4] {
            let turn = nalgebra::UnitQuaternion::from_euler_angles(turn, 0.1, 0.0);
            let planted = Isometry3::from_parts(placed(12.0).translation, turn);
            check(r#"{"prim": "torus", "R": 2, "r": 0.75}"#, &planted, 1);
        }
    }

    fn surfaces(frame: Frame) -> [Surface; 4] {
        [
            Surface::Sphere(Sphere { frame, radius: 0.7 }),
            Surface::Cylinder(Cylinder { frame, radius: 0.7 }),
            Surface::Cone(Cone {
                frame,
                sin: 0.6,
                cos: 0.8,
            }),
            Surface::Torus(Torus {
                frame,
                major: 1.0,
                minor: 0.3,
            }),
        ]
    }

    proptest! {
        #[test]
        fn derivatives_are_those_of_steps(
            z in direction(),
            normal in direction(),
            origin in super::super::tests::point(),
            planted in pose(2.0..9.0),
        ) {
            const STEP: f64 = 1e-6;
            let at = |pose: &Isometry3<f64>, s: &Surface| touches(&normal, pose, s, [0.4, 1.5]);
            for surface in surfaces(Frame::about(origin, z)) {
                let here = at(&planted, &surface);
                for i in 0..6 {
                    let mut step = Vector6::zeros();
                    step[i] = STEP;
                    let (a, b) = (at(&moved(&planted, &-step), &surface), at(&moved(&planted, &step), &surface));
                    for (k, touch) in here.iter().enumerate() {
                        // The distance has a kink where the nearer side or tangency changes.
                        let change = (b[k].distance - a[k].distance) / (2.0 * STEP);
                        let kink = (a[k].distance + b[k].distance - 2.0 * touch.distance).abs() > 1e-9;
                        prop_assert!(kink || (change - touch.slope[i]).abs() < 1e-6);
                    }
                }
            }
        }

        /// The distance from the axis equals the radius at a limb of a cylinder only where the
        /// plane is parallel to the axis.
        #[test]
        fn planes_that_are_not_tangent_are_detected(axis in direction(), planted in pose(3.0..9.0), askew in 0.1..1.0f64) {
            let frame = Frame::about(Point3::origin(), axis);
            let cylinder = Surface::Cylinder(Cylinder { frame, radius: 0.5 });
            let (centre, z) = (planted.translation.vector, planted * axis);
            let side = z.cross(&centre).normalize();
            let normal = (side + z * askew).normalize();
            let off = touches(&normal, &planted, &cylinder, [-1.0, 1.0]);
            let apart = (off[0].distance - off[1].distance).abs();
            prop_assert!((apart - 2.0 * normal.dot(&z).abs()).abs() < 1e-9);
        }
    }
}
