//! Represents every primitive as an intersection of half spaces.

use crate::primitive::Primitive;
use crate::tree::{NodeId, PlacedPrimitive, Tree};
use nalgebra::{Matrix3, Point3, Vector3};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};
use premio_kernel::geometry::vector::Length;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::Compare;
use premio_kernel::number::rational::Rational;

/// A half space: one side of a surface, and the bounding box of the primitive's face on it.
#[derive(Clone, Debug)]
pub(super) struct HalfSpace<N: Float> {
    /// The surface, with the half space on its negative side.
    pub surface: Surface<N>,
    /// The bounding box of the face.
    pub bounds: Aabb,
}

/// A primitive in its final position.
#[derive(Clone, Debug)]
pub(super) struct Solid<N: Float> {
    /// Its leaf in the tree.
    pub leaf: NodeId,
    /// Its half spaces.
    pub sides: Vec<HalfSpace<N>>,
    /// Its bounding box.
    pub bounds: Aabb,
}

/// All primitives of a tree.
#[derive(Debug)]
pub(super) struct HalfSpaceModel<N: Float> {
    /// The primitives, in the order of the leaves.
    pub all: Vec<Solid<N>>,
    /// The bounding box of all.
    pub bounds: Aabb,
}

/// The rotation and offset of a primitive, rounded once from their exact values.
struct Pose<'a, N: Float> {
    placed: &'a PlacedPrimitive,
    turn: Matrix3<N>,
}

impl<N: Float> Pose<'_, N> {
    /// The position of an exact point of the primitive's frame, rounded once.
    fn point(&self, p: [Rational; 3]) -> Point3<N> {
        let q = self.placed.motion.apply_point(&p);
        Point3::from(q.each_ref().map(N::nearest))
    }

    fn axis(&self, i: usize) -> Vector3<N> {
        self.turn.column(i).into()
    }

    /// The primitive's frame moved to an exact point of it.
    fn frame(&self, p: [Rational; 3]) -> Frame<N> {
        Frame {
            origin: self.point(p),
            x: self.axis(0),
            y: self.axis(1),
            z: self.axis(2),
        }
    }

    fn plane(&self, through: [Rational; 3], normal: Vector3<N>) -> Surface<N> {
        let origin = self.point(through);
        Surface::Plane(Plane {
            frame: Frame::about(origin, self.turn * normal),
        })
    }

    /// The enclosing box of a box in the primitive's frame, to rounding.
    fn boxed(&self, lo: [N; 3], hi: [N; 3]) -> Aabb {
        let mid = Vector3::from_fn(|i, _| N::HALF * (lo[i] + hi[i]));
        let half = Vector3::from_fn(|i, _| N::HALF * (hi[i] - lo[i]));
        let centre = self.point(zero()) + self.turn * mid;
        let reach = self.turn.map(N::abs) * half;
        Aabb {
            min: <[N; 3]>::from(centre - reach).map(N::below),
            max: <[N; 3]>::from(centre + reach).map(N::above),
        }
    }
}

fn zero() -> [Rational; 3] {
    [Rational::ZERO, Rational::ZERO, Rational::ZERO]
}

fn up(z: &Rational) -> [Rational; 3] {
    [Rational::ZERO, Rational::ZERO, z.clone()]
}

impl<N: Float> HalfSpaceModel<N> {
    /// The primitives of a tree, with unmerged surfaces.
    pub fn new(tree: &Tree) -> Self {
        let all: Vec<Solid<N>> = tree
            .leaves()
            .map(|(leaf, placed)| solid(leaf, placed))
            .collect();
        let bounds = all.iter().fold(Aabb::EMPTY, |b, s| b.hull(&s.bounds));
        Self { all, bounds }
    }
}

fn solid<N: Float>(leaf: NodeId, placed: &PlacedPrimitive) -> Solid<N> {
    let pose = Pose {
        placed,
        turn: placed.motion.rounded_rotation(),
    };
    let mut sides = Vec::new();
    let mut add = |surface: Surface<N>, lo: [N; 3], hi: [N; 3]| {
        let bounds = pose.boxed(lo, hi);
        sides.push(HalfSpace { surface, bounds });
    };
    match &placed.primitive {
        Primitive::Block { size } => {
            let s = [
                N::nearest(&size[0]),
                N::nearest(&size[1]),
                N::nearest(&size[2]),
            ];
            for i in 0..3 {
                for high in [false, true] {
                    add_block_side(&pose, size, &s, i, high, &mut add);
                }
            }
        }
        Primitive::Wedge { size } => {
            let s = [
                N::nearest(&size[0]),
                N::nearest(&size[1]),
                N::nearest(&size[2]),
            ];
            for (i, high) in [(0, false), (1, false), (1, true), (2, false)] {
                add_block_side(&pose, size, &s, i, high, &mut add);
            }
            let normal = Vector3::new(s[2], N::ZERO, s[0]).unit();
            let through = [size[0].clone(), Rational::ZERO, Rational::ZERO];
            add(pose.plane(through, normal), [N::ZERO; 3], s);
        }
        Primitive::Cylinder { radius, height } => {
            let (r, h) = (N::nearest(radius), N::nearest(height));
            let wall = Cylinder {
                frame: pose.frame(zero()),
                radius: r,
            };
            add(Surface::Cylinder(wall), [-r, -r, N::ZERO], [r, r, h]);
            add_disc(&pose, &Rational::ZERO, N::ZERO, r, -N::ONE, &mut add);
            add_disc(&pose, height, h, r, N::ONE, &mut add);
        }
        Primitive::Frustum { base, top, height } => {
            add_frustum(&pose, base, top, height, &mut add);
        }
        Primitive::Sphere { radius } => {
            let r = N::nearest(radius);
            let s = Sphere {
                frame: pose.frame(zero()),
                radius: r,
            };
            add(Surface::Sphere(s), [-r; 3], [r; 3]);
        }
        Primitive::Torus { major, minor } => {
            let (a, b) = (N::nearest(major), N::nearest(minor));
            let t = Torus {
                frame: pose.frame(zero()),
                major: a,
                minor: b,
            };
            let w = N::nearest(&(major + minor));
            add(Surface::Torus(t), [-w, -w, -b], [w, w, b]);
        }
    }
    let bounds = match &placed.primitive {
        // The wall of a cone has the box of the whole primitive.
        Primitive::Block { .. } | Primitive::Wedge { .. } => {
            sides.iter().fold(Aabb::EMPTY, |b, s| b.hull(&s.bounds))
        }
        _ => sides[0].bounds,
    };
    Solid {
        leaf,
        sides,
        bounds,
    }
}

type Add<'a, N> = dyn FnMut(Surface<N>, [N; 3], [N; 3]) + 'a;

fn add_block_side<N: Float>(
    pose: &Pose<'_, N>,
    size: &[Rational; 3],
    s: &[N; 3],
    i: usize,
    high: bool,
    add: &mut Add<'_, N>,
) {
    let (mut lo, mut hi) = ([N::ZERO; 3], *s);
    let mut through = zero();
    let mut normal = Vector3::zeros();
    if high {
        through[i] = size[i].clone();
        lo[i] = s[i];
        normal[i] = N::ONE;
    } else {
        hi[i] = N::ZERO;
        normal[i] = -N::ONE;
    }
    add(pose.plane(through, normal), lo, hi);
}

fn add_disc<N: Float>(
    pose: &Pose<'_, N>,
    at: &Rational,
    z: N,
    r: N,
    sign: N,
    add: &mut Add<'_, N>,
) {
    add(
        pose.plane(up(at), Vector3::z() * sign),
        [-r, -r, z],
        [r, r, z],
    );
}

fn add_frustum<N: Float>(
    pose: &Pose<'_, N>,
    base: &Rational,
    top: &Rational,
    height: &Rational,
    add: &mut Add<'_, N>,
) {
    let (b, t, h) = (N::nearest(base), N::nearest(top), N::nearest(height));
    // The apex, where the radius becomes zero, lies above or below.
    let apex = height.clone() * base.clone() / (base.clone() - top.clone());
    let slope = N::nearest(&(base.clone() - top.clone()));
    let length = slope.hypot(h);
    let f = pose.frame(up(&apex));
    let frame = if slope.is_above_zero() {
        Frame {
            x: f.x,
            y: -f.y,
            z: -f.z,
            ..f
        }
    } else {
        f
    };
    let cone = Cone {
        frame,
        sin: slope.abs() / length,
        cos: h / length,
    };
    let r = b.max(t);
    add(Surface::Cone(cone), [-r, -r, N::ZERO], [r, r, h]);
    if b.is_above_zero() {
        add_disc(pose, &Rational::ZERO, N::ZERO, b, -N::ONE, add);
    }
    if t.is_above_zero() {
        add_disc(pose, height, h, t, N::ONE, add);
    }
}
