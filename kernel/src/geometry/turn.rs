//! How far above a surface a circle runs, as a trigonometric polynomial of degree two.
//!
//! Over intervals of the angle what is nearly constant along a circle, about nearly the same axis as
//! the surface, is told from its few coefficients; in coordinates it cancels, and only very short
//! intervals tell.

use super::curve::Circle;
use super::surface::Surface;
use super::trigonometric::Trig2;
use super::vector::Length;
use crate::number::interval::Interval;
use crate::number::precision::Number;
use crate::number::scalar::Scalar;
use nalgebra::Point3;

/// A surface's polynomial along a circle: the level times what [`conjugate`] gives.
#[derive(Debug)]
pub(super) struct Turn<N: Number> {
    coefficients: Trig2<N>,
    /// How far rounding takes it off.
    slop: N,
}

/// As many points as coefficients.
const POINTS: u32 = 5;
/// The roundings of a coefficient.
const ROUNDINGS: f64 = 64.0;

impl<N: Number> Turn<N> {
    pub(super) fn of(circle: &Circle<N>, surface: &Surface<N>) -> Self {
        let mut coefficients = [N::ZERO; 5];
        let mut most = N::ZERO;
        for n in 0..POINTS {
            let u = N::TAU * N::whole(n) / N::whole(POINTS);
            let (sin, cos) = u.sin_cos();
            let (x, y) = (circle.radius * cos, circle.radius * sin);
            let p = circle.frame.point(x, y, N::ZERO);
            let value = surface.polynomial(&p);
            most = most.max(size(surface, &p));
            let (sin2, cos2) = (N::TWO * sin * cos, N::TWO * cos * cos - N::ONE);
            let rates = [N::HALF, cos, sin, cos2, sin2];
            for (k, rate) in coefficients.iter_mut().zip(rates) {
                *k += N::TWO / N::whole(POINTS) * rate * value;
            }
        }
        Self {
            coefficients,
            slop: N::of(ROUNDINGS) * N::EPSILON * most,
        }
    }

    /// A range of the surface's level over a range of the angle, in which the circle runs through a
    /// box.
    pub(super) fn level(
        &self,
        t: Interval<N>,
        surface: &Surface<N>,
        place: [Interval<N>; 3],
    ) -> Interval<N> {
        let value = t.harmonic(&self.coefficients, t.sin_cos());
        let value = value + Interval::around(N::ZERO, self.slop);
        value.over(conjugate(surface, surface.frame().local(place)))
    }
}

/// What the terms of a surface's polynomial come to at a point, that its value is rounded by.
fn size<N: Number>(surface: &Surface<N>, p: &Point3<N>) -> N {
    let away = (p - surface.frame().origin).length();
    let (lengths, degree) = match surface {
        Surface::Plane(_) => (away, 1),
        Surface::Cylinder(s) => (away + s.radius, 2),
        Surface::Sphere(s) => (away + s.radius, 2),
        Surface::Cone(_) => (away, 2),
        Surface::Torus(s) => (away + s.major + s.minor, 4),
    };
    lengths.powi(degree)
}

/// What the polynomial is of the level, over a box in the surface's frame.
fn conjugate<N: Number>(surface: &Surface<N>, [x, y, z]: [Interval<N>; 3]) -> Interval<N> {
    let across = (x.square() + y.square()).root();
    match surface {
        Surface::Plane(_) => Interval::point(N::ONE),
        Surface::Cylinder(s) => Interval::point(N::TWO * s.radius),
        Surface::Sphere(s) => Interval::point(N::TWO * s.radius),
        Surface::Cone(s) => across.scale(s.cos) + z.scale(s.sin),
        Surface::Torus(s) => {
            let far = (across + Interval::point(s.major)).square();
            let far = far + z.square() - Interval::point(s.minor * s.minor);
            far.scale(N::TWO * s.minor)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curve::Curve;
    use crate::geometry::frame::Frame;
    use crate::geometry::surface::{Torus, of_every_kind};
    use nalgebra::Vector3;

    #[test]
    fn levels_are_the_surface_s_along_the_circle() {
        let frame = Frame::about(
            Point3::new(0.3, -0.2, 0.1),
            Vector3::new(0.2, 0.3, 0.9).normalize(),
        );
        let surfaces = of_every_kind(frame, 1.2, [1.1, 0.4]);
        let circle = Circle {
            frame: Frame::about(Point3::new(0.0, 0.1, 1.3), Vector3::z()),
            radius: 0.9,
        };
        let curve = Curve::Circle(circle);
        for surface in &surfaces {
            let turn = Turn::of(&circle, surface);
            for k in 0..60 {
                let t = Interval::around(0.1 * f64::from(k), 1e-3);
                let place = curve.box_over(t).unwrap();
                let told = turn.level(t, surface, place);
                let p = curve.point(t.mid());
                let level = surface.level([p.x, p.y, p.z]);
                assert!(told.lo <= level && level <= told.hi, "{told:?} {level}");
                assert!(told.width() < 0.02, "{told:?}");
            }
        }
    }

    #[test]
    fn a_coaxial_circle_next_to_a_torus_is_clear_at_once() {
        let frame = Frame::world();
        let torus = Surface::Torus(Torus {
            frame,
            major: 1.0,
            minor: 0.5,
        });
        let gap = 1.0 / 1024.0;
        let circle = Circle {
            frame: Frame::about(Point3::new(0.0, 0.0, 0.5), Vector3::z()),
            radius: 1.0 + gap,
        };
        let whole = Interval::new(0.0, 6.3);
        let place = Curve::Circle(circle).box_over(whole).unwrap();
        // Its box holds the axis, where nothing is told; a quarter's does not.
        let quarter = Interval::new(0.1, 1.5);
        let near = Curve::Circle(circle).box_over(quarter).unwrap();
        let told = Turn::of(&circle, &torus).level(quarter, &torus, near);
        assert!(
            told.lo > 0.5 * gap * gap && told.hi < 4.0 * gap * gap,
            "{told:?}"
        );
        assert!(Turn::of(&circle, &torus).level(whole, &torus, place).hi > 0.0);
    }
}
