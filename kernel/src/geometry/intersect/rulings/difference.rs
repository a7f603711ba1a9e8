//! The difference of the equations of the other quadric and the base, in the base's frame.
//!
//! On the base it equals the other's equation. Where the two surfaces nearly coincide it is small,
//! but computed from the exact coefficients it keeps all its digits.
//!
//! Notation: d is the base's direction, f the other's; o and s are their points and sizes. A
//! quadric is (p - o)ᵀ (I - e f fᵀ/f²) (p - o) = r², with e = 1, r = s for a cylinder, e = 1 + s²,
//! r = 0 for a cone, e = 0, r = s for a sphere.

use crate::geometry::surface::Surface;
use crate::geometry::surface_pair::{Coefficients, SurfacePair};
use crate::geometry::vector::Length;
use crate::number::enclosable::Enclosable;
use crate::number::float::Float;
use crate::number::rational_interval::RationalInterval;
use nalgebra::{Matrix3, Vector3};

/// pᵀ A p + 2 b·p + c in the frame of the base.
pub(super) struct Difference<N: Float = f64> {
    pub a: Matrix3<N>,
    pub b: Vector3<N>,
    pub c: N,
}

/// The sine of the angle between directions below which more bits are used.
const LEAN: f64 = 1.0 / (1 << 10) as f64;

/// The precision in bits.
const BITS: usize = 256;

impl<N: Float> Difference<N> {
    /// The difference for a pair whose first is the base. To first order it is twice the distance
    /// times a length.
    pub fn new(pair: &SurfacePair<'_, N>) -> Self {
        let surfaces = [pair.a.surface, pair.b.surface];
        if surfaces.iter().any(|s| s.is_elliptic()) {
            return Self::of_other(surfaces);
        }
        let [a, b] = [pair.a, pair.b].map(|c| c.numbers());
        let parts = Parts::new(surfaces, &a, &b);
        let lean = Vector3::from(parts.lean).length();
        if lean > N::from_f64(LEAN) {
            return parts.difference(surfaces);
        }
        let [a, b] = [pair.a, pair.b].map(|c| c.computed(BITS));
        Parts::new(surfaces, &a, &b)
            .map(RationalInterval::middle)
            .difference(surfaces)
    }
}

impl<N: Float> Difference<N> {
    /// The other's equation in the base's frame, from the numbers of both.
    fn of_other([base, other]: [&Surface<N>; 2]) -> Self {
        let (f, g) = (base.frame(), other.frame());
        let (squares, constant) = match other {
            Surface::EllipticCylinder(s) => s.equation(),
            Surface::EllipticCone(s) => s.equation(),
            Surface::Ellipsoid(s) => s.equation(),
            Surface::Cylinder(s) => ([N::ONE, N::ONE, N::ZERO], s.radius * s.radius),
            Surface::Cone(s) => {
                let across = s.cos * s.cos;
                ([across, across, -s.sin * s.sin], N::ZERO)
            }
            Surface::Sphere(s) => ([N::ONE; 3], s.radius * s.radius),
            Surface::Plane(_) | Surface::Torus(_) => ([N::ZERO; 3], N::ZERO),
        };
        let axes = [f.x, f.y, f.z].map(|axis| g.components(&axis));
        let away = g.coordinates(&f.origin);
        let form =
            |u: &Vector3<N>, v: &Vector3<N>| (0..3).map(|i| squares[i] * u[i] * v[i]).sum::<N>();
        Self {
            a: Matrix3::from_fn(|i, j| form(&axes[i], &axes[j])),
            b: Vector3::from_fn(|i, _| form(&axes[i], &away)),
            c: form(&away, &away) - constant,
        }
    }
}

/// The terms of the difference, over any number type.
struct Parts<R> {
    /// f/|f|: its component perpendicular to d, and that along d.
    lean: [R; 3],
    along: R,
    /// e of the other, and the component of A along d.
    bulge: R,
    rise: R,
    /// b: its component perpendicular to d, and that along d.
    across: [R; 3],
    up: R,
    /// c.
    level: R,
}

fn dot<R: Enclosable>(a: &[R; 3], b: &[R; 3]) -> R {
    let [x, y, z] = [0, 1, 2].map(|i| a[i].clone() * b[i].clone());
    x + y + z
}

/// a - k b.
fn less<R: Enclosable>(a: &[R; 3], k: &R, b: &[R; 3]) -> [R; 3] {
    [0, 1, 2].map(|i| a[i].clone() - k.clone() * b[i].clone())
}

/// e and r².
fn shape<N: Float, R: Enclosable>(surface: &Surface<N>, size: &R) -> [R; 2] {
    let (one, none) = (R::constant(1.0), R::constant(0.0));
    let square = size.clone() * size.clone();
    match surface {
        Surface::Cylinder(_) => [one, square],
        Surface::Cone(_) => [one + square, none],
        _ => [none, square],
    }
}

impl<R: Enclosable> Parts<R> {
    fn new<N: Float>(
        surfaces: [&Surface<N>; 2],
        base: &Coefficients<R>,
        other: &Coefficients<R>,
    ) -> Self {
        let (d, f) = (&base.direction, &other.direction);
        let [own, own_square] = shape(surfaces[0], &base.size);
        let [bulge, square] = shape(surfaces[1], &other.size);
        let (dd, ff) = (dot(d, d), dot(f, f));
        let turned = dot(d, f).over(dd.clone());
        let perpendicular = less(f, &turned, d);
        let away = less(&base.point, &R::constant(1.0), &other.point);
        let high = dot(&away, d).over(dd.clone());
        let lateral = less(&away, &high, d);
        // (f·δ)/f²
        let reach = dot(f, &away).over(ff.clone());
        let pull = bulge.clone() * reach.clone();
        let across = less(&lateral, &pull, &perpendicular);
        let climb = high - pull.clone() * turned.clone();
        let level = dot(&away, &away) - pull * reach * ff.clone() - square + own_square;
        let (length, size) = (dd.sqrt(), ff.clone().sqrt());
        let tilt = dot(&perpendicular, &perpendicular).over(ff);
        Self {
            lean: perpendicular.map(|x| x.over(size.clone())),
            along: (turned * length.clone()).over(size),
            rise: own - bulge.clone() + bulge.clone() * tilt,
            bulge,
            across,
            up: climb * length,
            level,
        }
    }

    fn map<M>(self, to: impl Fn(&R) -> M) -> Parts<M> {
        Parts {
            lean: self.lean.each_ref().map(&to),
            along: to(&self.along),
            bulge: to(&self.bulge),
            rise: to(&self.rise),
            across: self.across.each_ref().map(&to),
            up: to(&self.up),
            level: to(&self.level),
        }
    }
}

impl<N: Float> Parts<N> {
    /// The difference in the base's frame. For a cone the equation is scaled by cos², so that it is
    /// a distance times a length.
    fn difference(&self, [base, other]: [&Surface<N>; 2]) -> Difference<N> {
        let f = base.frame();
        let scale = match other {
            Surface::Cone(c) => c.cos * c.cos,
            _ => N::ONE,
        };
        let inside = |v: &[N; 3], z: N| {
            let v = Vector3::from(*v);
            Vector3::new(f.x.dot(&v), f.y.dot(&v), z)
        };
        let n = inside(&self.lean, self.along);
        let mut a = n * n.transpose() * -self.bulge;
        a[(2, 2)] = self.rise;
        Difference {
            a: a * scale,
            b: inside(&self.across, self.up) * scale,
            c: self.level * scale,
        }
    }
}
