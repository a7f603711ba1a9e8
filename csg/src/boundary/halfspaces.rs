//! Every primitive as an intersection of half spaces, their surfaces merged to carriers.

use crate::primitive::Primitive;
use crate::tree::{NodeId, Placed, Tree};
use nalgebra::{Matrix3, Point3, Vector3};
use premio_kernel::geometry::bounds::Box3;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};
use premio_kernel::number::rational::{Rational, to_f64};

/// A half space: one side of a surface, and the box of the face it gives its primitive.
#[derive(Clone, Debug)]
pub(super) struct HalfSpace {
    /// The surface, with the half space on its negative side.
    pub surface: Surface,
    /// The box of the face.
    pub bounds: Box3,
}

/// A primitive at its place.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    /// Its leaf in the tree.
    pub leaf: NodeId,
    /// Its half spaces.
    pub sides: Vec<HalfSpace>,
    /// Its box.
    pub bounds: Box3,
}

/// All primitives of a tree.
#[derive(Debug)]
pub(super) struct Solids {
    /// In the order of the leaves.
    pub all: Vec<Solid>,
    /// The box of all.
    pub bounds: Box3,
}

/// The rotation and offset of a primitive, rounded once from their exact values.
struct Pose<'a> {
    placed: &'a Placed,
    turn: Matrix3<f64>,
}

impl Pose<'_> {
    /// The place of an exact point of the primitive's frame, rounded once.
    fn point(&self, p: [Rational; 3]) -> Point3<f64> {
        let q = self.placed.motion.apply_point(&p);
        Point3::new(to_f64(&q[0]), to_f64(&q[1]), to_f64(&q[2]))
    }

    fn axis(&self, i: usize) -> Vector3<f64> {
        self.turn.column(i).into()
    }

    /// The primitive's frame moved to an exact point of it.
    fn frame(&self, p: [Rational; 3]) -> Frame {
        Frame {
            origin: self.point(p),
            x: self.axis(0),
            y: self.axis(1),
            z: self.axis(2),
        }
    }

    fn plane(&self, through: [Rational; 3], normal: Vector3<f64>) -> Surface {
        let origin = self.point(through);
        Surface::Plane(Plane {
            frame: Frame::about(origin, self.turn * normal),
        })
    }

    /// The box of a box of the primitive's frame.
    fn boxed(&self, lo: [f64; 3], hi: [f64; 3]) -> Box3 {
        let offset = self.placed.motion.translation_f64();
        let mid = Vector3::from_fn(|i, _| 0.5 * (lo[i] + hi[i]));
        let half = Vector3::from_fn(|i, _| 0.5 * (hi[i] - lo[i]));
        let centre = self.turn * mid + offset;
        let reach = self.turn.abs() * half;
        Box3 {
            min: (centre - reach).into(),
            max: (centre + reach).into(),
        }
    }
}

fn zero() -> [Rational; 3] {
    [Rational::ZERO, Rational::ZERO, Rational::ZERO]
}

fn up(z: &Rational) -> [Rational; 3] {
    [Rational::ZERO, Rational::ZERO, z.clone()]
}

impl Solids {
    /// The primitives of a tree, not yet merged.
    pub fn of(tree: &Tree) -> Self {
        let all: Vec<Solid> = tree
            .leaves()
            .map(|(leaf, placed)| solid(leaf, placed))
            .collect();
        let bounds = all.iter().fold(Box3::EMPTY, |b, s| b.hull(&s.bounds));
        Self { all, bounds }
    }
}

fn solid(leaf: NodeId, placed: &Placed) -> Solid {
    let pose = Pose {
        placed,
        turn: placed.motion.rotation_f64(),
    };
    let mut sides = Vec::new();
    let mut add = |surface: Surface, lo: [f64; 3], hi: [f64; 3]| {
        let bounds = pose.boxed(lo, hi);
        sides.push(HalfSpace { surface, bounds });
    };
    match &placed.primitive {
        Primitive::Block { size } => {
            let s = [to_f64(&size[0]), to_f64(&size[1]), to_f64(&size[2])];
            for i in 0..3 {
                for high in [false, true] {
                    add_block_side(&pose, size, &s, i, high, &mut add);
                }
            }
        }
        Primitive::Wedge { size } => {
            let s = [to_f64(&size[0]), to_f64(&size[1]), to_f64(&size[2])];
            for (i, high) in [(0, false), (1, false), (1, true), (2, false)] {
                add_block_side(&pose, size, &s, i, high, &mut add);
            }
            let normal = Vector3::new(s[2], 0.0, s[0]).normalize();
            let through = [size[0].clone(), Rational::ZERO, Rational::ZERO];
            add(pose.plane(through, normal), [0.0; 3], s);
        }
        Primitive::Cylinder { radius, height } => {
            let (r, h) = (to_f64(radius), to_f64(height));
            let wall = Cylinder {
                frame: pose.frame(zero()),
                radius: r,
            };
            add(Surface::Cylinder(wall), [-r, -r, 0.0], [r, r, h]);
            add_disc(&pose, &Rational::ZERO, 0.0, r, -1.0, &mut add);
            add_disc(&pose, height, h, r, 1.0, &mut add);
        }
        Primitive::Frustum { base, top, height } => {
            add_frustum(&pose, base, top, height, &mut add);
        }
        Primitive::Sphere { radius } => {
            let r = to_f64(radius);
            let s = Sphere {
                frame: pose.frame(zero()),
                radius: r,
            };
            add(Surface::Sphere(s), [-r; 3], [r; 3]);
        }
        Primitive::Torus { major, minor } => {
            let (a, b) = (to_f64(major), to_f64(minor));
            let t = Torus {
                frame: pose.frame(zero()),
                major: a,
                minor: b,
            };
            let w = to_f64(&(major + minor));
            add(Surface::Torus(t), [-w, -w, -b], [w, w, b]);
        }
    }
    let bounds = match &placed.primitive {
        // A cone's walls have the box of the whole.
        Primitive::Block { .. } | Primitive::Wedge { .. } => {
            sides.iter().fold(Box3::EMPTY, |b, s| b.hull(&s.bounds))
        }
        _ => sides[0].bounds,
    };
    Solid {
        leaf,
        sides,
        bounds,
    }
}

type Add<'a> = dyn FnMut(Surface, [f64; 3], [f64; 3]) + 'a;

fn add_block_side(
    pose: &Pose<'_>,
    size: &[Rational; 3],
    s: &[f64; 3],
    i: usize,
    high: bool,
    add: &mut Add<'_>,
) {
    let (mut lo, mut hi) = ([0.0; 3], *s);
    let mut through = zero();
    let mut normal = Vector3::zeros();
    if high {
        through[i] = size[i].clone();
        lo[i] = s[i];
        normal[i] = 1.0;
    } else {
        hi[i] = 0.0;
        normal[i] = -1.0;
    }
    add(pose.plane(through, normal), lo, hi);
}

fn add_disc(pose: &Pose<'_>, at: &Rational, z: f64, r: f64, sign: f64, add: &mut Add<'_>) {
    add(
        pose.plane(up(at), Vector3::z() * sign),
        [-r, -r, z],
        [r, r, z],
    );
}

fn add_frustum(
    pose: &Pose<'_>,
    base: &Rational,
    top: &Rational,
    height: &Rational,
    add: &mut Add<'_>,
) {
    let (b, t, h) = (to_f64(base), to_f64(top), to_f64(height));
    // The apex lies where the radius runs out, above or below.
    let apex = height.clone() * base.clone() / (base.clone() - top.clone());
    let slope = to_f64(&(base.clone() - top.clone()));
    let length = slope.hypot(h);
    let f = pose.frame(up(&apex));
    let frame = if slope > 0.0 {
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
    add(Surface::Cone(cone), [-r, -r, 0.0], [r, r, h]);
    if b > 0.0 {
        add_disc(pose, &Rational::ZERO, 0.0, b, -1.0, add);
    }
    if t > 0.0 {
        add_disc(pose, height, h, t, 1.0, add);
    }
}
