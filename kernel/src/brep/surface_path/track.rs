//! The curve of a path, by the length along it.

use crate::geometry::elliptic_surface::eccentric_angle;
use crate::geometry::frame::Frame;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use nalgebra::{Point3, Vector3};

/// The curve along which a path runs.
#[derive(Clone, Copy, Debug)]
pub(super) enum Track<N: Float = f64> {
    /// The straight line in a direction.
    Line(Vector3<N>),
    /// The circle about the frame's z axis, starting at its x axis, with the radius.
    Circle(Frame<N>, N),
    /// An ellipse with the radii along x and y, starting at the eccentric angle. In place of its
    /// length, the angle times the greater radius is used.
    Ellipse(Frame<N>, [N; 2], N),
}

impl<N: Float> Track<N> {
    /// The same from the same start in the opposite direction.
    pub fn reversed(&self) -> Self {
        match *self {
            Self::Line(d) => Self::Line(-d),
            Self::Circle(f, r) => Self::Circle(Frame::toward(f.origin, -f.z, f.x), r),
            Self::Ellipse(f, radii, start) => {
                let turned = Frame {
                    y: -f.y,
                    z: -f.z,
                    ..f
                };
                Self::Ellipse(turned, radii, -start)
            }
        }
    }

    /// The length once round; `None` for a line.
    pub fn round(&self) -> Option<N> {
        match *self {
            Self::Line(_) => None,
            Self::Circle(_, radius) => Some(N::TAU * radius),
            Self::Ellipse(_, [a, b], _) => Some(N::TAU * a.max(b)),
        }
    }

    /// The point at the length s from the start.
    pub fn point(&self, start: &Point3<N>, s: N) -> Point3<N> {
        match *self {
            Self::Line(d) => start + d * s,
            Self::Circle(ref f, r) => {
                let (sin, cos) = (s / r).sin_cos();
                f.point(r * cos, r * sin, N::ZERO)
            }
            Self::Ellipse(ref f, [a, b], start) => {
                let (sin, cos) = (start + s / a.max(b)).sin_cos();
                f.point(a * cos, b * sin, N::ZERO)
            }
        }
    }

    /// The length at which it passes a point of it.
    pub fn at(&self, start: &Point3<N>, p: &Point3<N>) -> N {
        match *self {
            Self::Line(d) => (p - start).dot(&d),
            Self::Circle(ref f, r) => {
                let q = f.coordinates(p);
                q.y.atan2(q.x).rem_euclid(N::TAU) * r
            }
            Self::Ellipse(ref f, [a, b], start) => {
                let q = f.coordinates(p);
                let turned = eccentric_angle([q.x, q.y], [a, b]) - start;
                turned.rem_euclid(N::TAU) * a.max(b)
            }
        }
    }

    /// The unit direction at a point of it.
    pub fn direction(&self, p: &Point3<N>) -> Vector3<N> {
        match *self {
            Self::Line(d) => d,
            Self::Circle(ref f, _) => f.z.cross(&(p - f.origin)).unit(),
            Self::Ellipse(ref f, [a, b], _) => {
                let q = f.coordinates(p);
                (f.y * (q.x * b / a) - f.x * (q.y * a / b)).unit()
            }
        }
    }
}
