//! The half spaces of a primitive that is their intersection.

use super::HalfSpace;
use super::pose::{Pose, up, zero};
use crate::evaluate::{ellipsoid_side, oblique_sides};
use crate::primitive::Primitive;
use nalgebra::Vector3;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Cone, Cylinder, Sphere, Surface, Torus};
use premio_kernel::geometry::vector::Length;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::Compare;
use premio_kernel::number::rational::Rational;

/// The half spaces of a primitive, the wall first; none of one that is not an intersection of them.
pub(super) fn sides<N: Float>(pose: &Pose<'_, N>) -> Vec<HalfSpace<N>> {
    let mut sides = Sides {
        pose,
        all: Vec::new(),
    };
    match &pose.placed.primitive {
        Primitive::Block { size } => sides.add_block(size),
        Primitive::Wedge { size } => sides.add_wedge(size),
        Primitive::Cylinder { radius, height } => sides.add_cylinder(radius, height),
        Primitive::Frustum { base, top, height } => sides.add_frustum([base, top], height),
        Primitive::Sphere { radius } => sides.add_sphere(radius),
        Primitive::Torus { major, minor } => sides.add_torus(major, minor),
        Primitive::ObliqueFrustum { frustum } => {
            for side in oblique_sides::sides(frustum, pose.placed) {
                let [lo, hi] = side.bounds.map(|corner| corner.map(N::from_f64));
                sides.add(side.surface, lo, hi);
            }
        }
        Primitive::Ellipsoid { radii } => {
            let reach = radii.reach().map(N::from_f64);
            let surface = ellipsoid_side::surface(radii, pose.placed);
            sides.add(surface, reach.map(|r| -r), reach);
        }
        Primitive::Prism { .. } | Primitive::Revolution { .. } | Primitive::Polyhedron { .. } => {}
    }
    sides.all
}

/// The half spaces of a primitive so far.
struct Sides<'a, N: Float> {
    pose: &'a Pose<'a, N>,
    all: Vec<HalfSpace<N>>,
}

/// An end of a range along an axis.
#[derive(Clone, Copy, PartialEq, Eq)]
enum RangeEnd {
    Low,
    High,
}

impl<N: Float> Sides<'_, N> {
    /// Adds a half space with the box of its face in the primitive's frame.
    fn add(&mut self, surface: Surface<N>, lo: [N; 3], hi: [N; 3]) {
        self.all.push(HalfSpace {
            surface,
            bounds: self.pose.boxed(lo, hi),
            hull: self.pose.hull_of_box(lo, hi),
        });
    }

    fn add_block(&mut self, size: &[Rational; 3]) {
        for axis in 0..3 {
            for end in [RangeEnd::Low, RangeEnd::High] {
                self.add_block_side(size, axis, end);
            }
        }
    }

    fn add_wedge(&mut self, size: &[Rational; 3]) {
        use RangeEnd::{High, Low};
        for (axis, end) in [(0, Low), (1, Low), (1, High), (2, Low)] {
            self.add_block_side(size, axis, end);
        }
        let s = size.each_ref().map(N::nearest);
        let normal = Vector3::new(s[2], N::ZERO, s[0]).unit();
        let through = [size[0].clone(), Rational::ZERO, Rational::ZERO];
        self.add(self.pose.plane(through, normal), [N::ZERO; 3], s);
    }

    /// Adds the side of a block across an axis.
    fn add_block_side(&mut self, size: &[Rational; 3], axis: usize, end: RangeEnd) {
        let (mut lo, mut hi) = ([N::ZERO; 3], size.each_ref().map(N::nearest));
        let mut through = zero();
        let mut normal = Vector3::zeros();
        match end {
            RangeEnd::High => {
                through[axis] = size[axis].clone();
                lo[axis] = hi[axis];
                normal[axis] = N::ONE;
            }
            RangeEnd::Low => {
                hi[axis] = N::ZERO;
                normal[axis] = -N::ONE;
            }
        }
        self.add(self.pose.plane(through, normal), lo, hi);
    }

    fn add_cylinder(&mut self, radius: &Rational, height: &Rational) {
        let (r, h) = (N::nearest(radius), N::nearest(height));
        let wall = Cylinder {
            frame: self.pose.frame(zero()),
            radius: r,
        };
        self.add(Surface::Cylinder(wall), [-r, -r, N::ZERO], [r, r, h]);
        self.add_disc(&Rational::ZERO, r, -N::ONE);
        self.add_disc(height, r, N::ONE);
    }

    /// Adds the end at a height, with its normal up or down.
    fn add_disc(&mut self, height: &Rational, r: N, sign: N) {
        let z = N::nearest(height);
        let plane = self.pose.plane(up(height), Vector3::z() * sign);
        self.add(plane, [-r, -r, z], [r, r, z]);
    }

    fn add_frustum(&mut self, [base, top]: [&Rational; 2], height: &Rational) {
        let (b, t, h) = (N::nearest(base), N::nearest(top), N::nearest(height));
        // The apex, where the radius becomes zero, lies above or below.
        let apex = height.clone() * base.clone() / (base.clone() - top.clone());
        let slope = N::nearest(&(base.clone() - top.clone()));
        let length = slope.hypot(h);
        let f = self.pose.frame(up(&apex));
        let frame = match slope.is_above_zero() {
            true => Frame {
                x: f.x,
                y: -f.y,
                z: -f.z,
                ..f
            },
            false => f,
        };
        let cone = Cone {
            frame,
            sin: slope.abs() / length,
            cos: h / length,
        };
        let r = b.max(t);
        self.add(Surface::Cone(cone), [-r, -r, N::ZERO], [r, r, h]);
        if b.is_above_zero() {
            self.add_disc(&Rational::ZERO, b, -N::ONE);
        }
        if t.is_above_zero() {
            self.add_disc(height, t, N::ONE);
        }
    }

    fn add_sphere(&mut self, radius: &Rational) {
        let r = N::nearest(radius);
        let sphere = Sphere {
            frame: self.pose.frame(zero()),
            radius: r,
        };
        self.add(Surface::Sphere(sphere), [-r; 3], [r; 3]);
    }

    fn add_torus(&mut self, major: &Rational, minor: &Rational) {
        let b = N::nearest(minor);
        let torus = Torus {
            frame: self.pose.frame(zero()),
            major: N::nearest(major),
            minor: b,
        };
        let w = N::nearest(&(major + minor));
        self.add(Surface::Torus(torus), [-w, -w, -b], [w, w, b]);
    }
}
