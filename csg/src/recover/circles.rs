//! Centres that lie on a circle about an axis: balls in a groove, rollers on a ring, cylinders that
//! touch from outside or inside.
//!
//! A circle in an odd direction is no relation of numbers along the axes of a frame. The centre is
//! moved to the nearest point of the circle with a rational direction.

use crate::primitive::Primitive;
use premio_kernel::number::rational::{Rational, from_f64, to_f64};

/// A primitive of revolution or a sphere, across a direction.
#[derive(Debug, Clone)]
pub(super) struct Round<'t> {
    /// The primitive.
    pub primitive: &'t Primitive,
    /// Whether its axis is reversed.
    pub is_reversed: bool,
    /// Its centre across the direction.
    pub centre: [f64; 2],
    /// The position of its origin along the direction.
    pub along: f64,
    /// The errors of the position across and along.
    pub errors: [f64; 3],
}

impl Round<'_> {
    /// The radius of a cylinder or sphere.
    fn radius(&self) -> Option<&Rational> {
        match self.primitive {
            Primitive::Cylinder { radius, .. } | Primitive::Sphere { radius } => Some(radius),
            _ => None,
        }
    }

    /// Its range along the direction.
    fn range(&self) -> [f64; 2] {
        let [lo, hi] = match self.primitive {
            Primitive::Cylinder { height, .. } | Primitive::Frustum { height, .. } => {
                [0.0, to_f64(height)]
            }
            Primitive::Sphere { .. } => [0.0, 0.0],
            Primitive::Torus { minor, .. } => [-to_f64(minor), to_f64(minor)],
            Primitive::Prism { height, .. } => [0.0, to_f64(height)],
            Primitive::Block { .. }
            | Primitive::Wedge { .. }
            | Primitive::Revolution { .. }
            | Primitive::Polyhedron { .. }
            | Primitive::ObliqueFrustum { .. }
            | Primitive::Ellipsoid { .. } => [0.0, 0.0],
        };
        let [lo, hi] = match self.is_reversed {
            true => [-hi, -lo],
            false => [lo, hi],
        };
        [self.along + lo, self.along + hi]
    }

    /// The radii of circles about its axis on which the centre of another one may be meant to lie:
    /// those of its own circles, and where their surfaces touch.
    fn circles(&self, other: &Self) -> Vec<Rational> {
        let Some(r) = other.radius() else {
            return Vec::new();
        };
        let own = match self.primitive {
            Primitive::Torus { major, minor } => {
                vec![major.clone(), major + minor, magnitude(major - minor)]
            }
            Primitive::Cylinder { radius, .. } => vec![radius.clone()],
            _ => Vec::new(),
        };
        let touching = own.iter().flat_map(|radius| [radius + r, radius - r]);
        let touching: Vec<Rational> = touching.map(magnitude).collect();
        [own, touching].concat()
    }

    /// Whether a distance is near the radius of a circle for the centre of another one.
    fn is_near_circle(&self, other: &Self, distance: f64, error: f64) -> bool {
        let r = other.size();
        let is_near = |own: f64| {
            [own, own + r, (own - r).abs()]
                .iter()
                .any(|radius| (radius - distance).abs() <= error)
        };
        match self.primitive {
            Primitive::Torus { major, minor } => {
                let [major, minor] = [major, minor].map(to_f64);
                [major, major + minor, (major - minor).abs()]
                    .into_iter()
                    .any(is_near)
            }
            Primitive::Cylinder { radius, .. } => is_near(to_f64(radius)),
            _ => false,
        }
    }

    /// The largest radius of a circle about its axis, without the radius of another one; none if it
    /// has no such circle.
    pub fn reach(&self) -> Option<f64> {
        match self.primitive {
            Primitive::Torus { major, minor } => Some(to_f64(&(major + minor))),
            Primitive::Cylinder { radius, .. } => Some(to_f64(radius)),
            _ => None,
        }
    }

    /// The radius as a member of a circle.
    pub fn size(&self) -> f64 {
        self.radius().map_or(0.0, to_f64)
    }

    /// The radius of the circle on which the centre of another one lies within the rounding; none if
    /// the centre is level with the axis, where the numbers of the frame determine it.
    pub fn circle(&self, other: &Self) -> Option<Rational> {
        let errors: [f64; 3] = std::array::from_fn(|i| self.errors[i] + other.errors[i]);
        let across: [f64; 2] = std::array::from_fn(|i| other.centre[i] - self.centre[i]);
        let ([a, b], [c, d]) = (self.range(), other.range());
        let is_apart = a > d + errors[2] || c > b + errors[2];
        if is_apart || (0..2).any(|i| across[i].abs() <= errors[i]) {
            return None;
        }
        let distance = across[0].hypot(across[1]);
        let error = errors[0].hypot(errors[1]);
        // Nearly all pairs end here, without exact numbers.
        if !self.is_near_circle(other, distance, error) {
            return None;
        }
        let circles = self.circles(other).into_iter();
        let off = |radius: &Rational| (to_f64(radius) - distance).abs();
        let near = circles.filter(|radius| !radius.is_zero() && off(radius) <= error);
        near.min_by(|a, b| off(a).total_cmp(&off(b)))
    }
}

/// The absolute value.
fn magnitude(x: Rational) -> Rational {
    match x < Rational::ZERO {
        true => -x,
        false => x,
    }
}

/// The precision of a direction: it has a short rational tangent of the half angle.
const DIRECTION: f64 = (1u64 << 44) as f64;

/// The point at a distance from the origin in a direction, with rational coordinates.
pub(super) fn at_radius(radius: &Rational, [x, y]: [f64; 2]) -> Option<[Rational; 2]> {
    // The tangent of the half angle from the positive or negative x axis, at most one.
    let half = y / (x.abs() + x.hypot(y));
    let t = from_f64((half * DIRECTION).round() / DIRECTION)?;
    let square = &t * &t;
    let norm = Rational::ONE + &square;
    let cosine = (Rational::ONE - &square) / &norm;
    let sine = Rational::from(2) * t / norm;
    let cosine = if x < 0.0 { -cosine } else { cosine };
    Some([radius * cosine, radius * sine])
}
