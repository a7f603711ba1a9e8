//! The placement of a primitive: its surfaces, boxes and hulls from exact coordinates in its frame.

use crate::evaluate::face_hulls::FaceHull;
use crate::evaluate::walls::{Wall, WallKind};
use crate::tree::PlacedPrimitive;
use nalgebra::{Matrix3, Point3, Vector3};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};
use premio_kernel::geometry::vector::Length;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::Compare;
use premio_kernel::number::rational::Rational;

/// The rotation and offset of a primitive, rounded once from their exact values.
pub(super) struct Pose<'a, N: Float> {
    pub(super) placed: &'a PlacedPrimitive,
    pub(super) turn: Matrix3<N>,
    pub(super) origin: Point3<N>,
    /// Whether the rotation is not one by quarter turns.
    is_oblique: bool,
}

impl<'a, N: Float> Pose<'a, N> {
    pub(super) fn new(placed: &'a PlacedPrimitive) -> Self {
        Self {
            placed,
            turn: placed.motion.rounded_rotation(),
            origin: rounded_image(placed, &zero()),
            is_oblique: !placed.motion.is_by_quarter_turns(),
        }
    }

    /// The position of a rounded point of the primitive's frame.
    fn rounded_point(&self, p: [N; 3]) -> Point3<N> {
        self.origin + self.turn * Vector3::from(p)
    }

    /// The hull of a box in the primitive's frame; `None` if it is the box of space.
    pub(super) fn hull_of_box(&self, lo: [N; 3], hi: [N; 3]) -> Option<FaceHull> {
        let corners = (0..8).map(|k| {
            let corner = std::array::from_fn(|i| if k >> i & 1 == 0 { lo[i] } else { hi[i] });
            self.rounded_point(corner)
        });
        self.is_oblique
            .then(|| FaceHull::of_box(corners, [0, 1, 2].map(|i| self.axis(i))))
    }

    /// The hull of a polygon in the primitive's frame.
    pub(super) fn hull_of_polygon(
        &self,
        corners: impl Iterator<Item = [N; 3]>,
        surface: &Surface<N>,
    ) -> FaceHull {
        let corners = corners.map(|corner| self.rounded_point(corner));
        FaceHull::of_polygon(corners, &surface.frame().z)
    }

    /// The position of an exact point of the primitive's frame, rounded once.
    fn point(&self, p: [Rational; 3]) -> Point3<N> {
        rounded_image(self.placed, &p)
    }

    fn axis(&self, i: usize) -> Vector3<N> {
        self.turn.column(i).into()
    }

    /// The primitive's frame moved to an exact point of it.
    pub(super) fn frame(&self, p: [Rational; 3]) -> Frame<N> {
        Frame {
            origin: self.point(p),
            x: self.axis(0),
            y: self.axis(1),
            z: self.axis(2),
        }
    }

    pub(super) fn plane(&self, through: [Rational; 3], normal: Vector3<N>) -> Surface<N> {
        let origin = self.point(through);
        Surface::Plane(Plane {
            frame: Frame::about(origin, self.turn * normal),
        })
    }

    /// The surface of a wall.
    pub(super) fn wall(&self, wall: &Wall) -> Surface<N> {
        let exact = &wall.coefficients;
        let (size, tube) = (N::nearest(&exact.size), N::nearest(&exact.tube));
        let direction = Vector3::from(exact.direction.each_ref().map(N::nearest));
        if wall.kind == WallKind::Plane {
            return self.plane(exact.point.clone(), direction.unit());
        }
        let frame = self.frame(exact.point.clone());
        match wall.kind {
            WallKind::Plane | WallKind::Cylinder => Surface::Cylinder(Cylinder {
                frame,
                radius: size,
            }),
            WallKind::Cone => {
                let frame = match direction.z.is_above_zero() {
                    true => frame,
                    false => Frame {
                        y: -frame.y,
                        z: -frame.z,
                        ..frame
                    },
                };
                let length = size.hypot(N::ONE);
                Surface::Cone(Cone {
                    frame,
                    sin: size / length,
                    cos: N::ONE / length,
                })
            }
            WallKind::Sphere => Surface::Sphere(Sphere {
                frame,
                radius: size,
            }),
            WallKind::Torus => Surface::Torus(Torus {
                frame,
                major: size,
                minor: tube,
            }),
        }
    }

    /// The enclosing box of a box in the primitive's frame, to rounding.
    pub(super) fn boxed(&self, lo: [N; 3], hi: [N; 3]) -> Aabb {
        let mid = Vector3::from_fn(|i, _| N::HALF * (lo[i] + hi[i]));
        let half = Vector3::from_fn(|i, _| N::HALF * (hi[i] - lo[i]));
        let centre = self.origin + self.turn * mid;
        let reach = self.turn.map(N::abs) * half;
        Aabb {
            min: <[N; 3]>::from(centre - reach).map(N::below),
            max: <[N; 3]>::from(centre + reach).map(N::above),
        }
    }
}

/// The position of an exact point of a primitive's frame, rounded once.
fn rounded_image<N: Float>(placed: &PlacedPrimitive, p: &[Rational; 3]) -> Point3<N> {
    let q = placed.motion.apply_point(p);
    Point3::from(q.each_ref().map(N::nearest))
}

pub(super) fn zero() -> [Rational; 3] {
    [Rational::ZERO, Rational::ZERO, Rational::ZERO]
}

pub(super) fn up(z: &Rational) -> [Rational; 3] {
    [Rational::ZERO, Rational::ZERO, z.clone()]
}
