//! The integrands of a face: along its edges and between two v, also in f64 where that may be
//! accurate enough.

use super::Moments;
use super::strip::strip;
use crate::geometry::curve::Curve;
use crate::geometry::elliptic_surface::{EllipticCone, EllipticCylinder};
use crate::geometry::surface::Surface;
use crate::geometry::vector::rounded;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use crate::number::quadrature::Integrand;
use nalgebra::{Point3, Vector3};

/// A surface with the origins of its integrals along v.
pub(super) struct Ground<N: Float = f64> {
    pub surface: Surface<N>,
    pub reference: Point3<N>,
    /// The v at which the surface is cut open or has a pole.
    pub base: N,
    /// The angle about a torus's tube relative to which angles are measured.
    pub middle: Middle<N>,
}

/// An angle about a torus's tube amid a face. Relative to it a thin strip is no difference of large
/// angles.
#[derive(Clone, Copy)]
pub(super) struct Middle<N: Float = f64> {
    pub angle: N,
    pub sin: N,
    pub cos: N,
}

impl<N: Float> Middle<N> {
    pub fn at(angle: N) -> Self {
        let (sin, cos) = angle.sin_cos();
        Self { angle, sin, cos }
    }

    fn to_f64(self) -> Middle {
        Middle {
            angle: self.angle.rounded(),
            sin: self.sin.rounded(),
            cos: self.cos.rounded(),
        }
    }
}

impl<N: Float> Ground<N> {
    /// The surface rounded to f64.
    pub fn to_f64(&self) -> Ground {
        Ground {
            surface: self.surface.to_f64(),
            reference: rounded(&self.reference).into(),
            base: self.base.rounded(),
            middle: self.middle.to_f64(),
        }
    }

    /// The parameters of a point on the surface. The angle about a torus's tube lies within half a
    /// turn of the middle.
    pub fn parameters(&self, p: &Point3<N>) -> [N; 2] {
        let mut parameters = self.surface.parameters(p);
        if let Surface::Torus(s) = &self.surface {
            let q = s.frame.coordinates(p);
            let (out, up) = (q.x.hypot(q.y) - s.major, q.z);
            let Middle { sin, cos, .. } = self.middle;
            parameters[1] = (up * cos - out * sin).atan2(out * cos + up * sin);
        }
        parameters
    }

    /// The integral along v at one u.
    fn along(&self, u: N, range: [N; 2]) -> Moments<N> {
        strip(&self.surface, &self.reference, u, self.middle.angle, range)
    }

    /// G du/dt and du/dt on an edge. G starts at `start`, and v is the one closest to `near`.
    fn on_edge(&self, curve: &Curve<N>, t: N, [start, near]: [N; 2]) -> [N; 6] {
        let j = curve.jet(t);
        let p = Point3::new(j[0].v, j[1].v, j[2].v);
        let f = self.surface.frame();
        let q = f.coordinates(&p);
        let d = f.components(&Vector3::new(j[0].d, j[1].d, j[2].d));
        let [u, mut v] = self.parameters(&p);
        let turn =
            |q: &Vector3<N>, d: &Vector3<N>| (q.x * d.y - q.y * d.x) / (q.x * q.x + q.y * q.y);
        let rate = match &self.surface {
            Surface::Plane(_) => d.x,
            Surface::Ellipsoid(s) => turn(&s.on_axes(&q), &s.on_axes(&d)),
            Surface::EllipticCylinder(EllipticCylinder { radii: [a, b], .. })
            | Surface::EllipticCone(EllipticCone { slopes: [a, b], .. }) => {
                let turn = (q.x * d.y - q.y * d.x) / (*a * *b);
                turn / ((q.x / *a).square() + (q.y / *b).square())
            }
            _ => turn(&q, &d),
        };
        if let Surface::Torus(_) = self.surface {
            v -= N::TAU * ((v - near) / N::TAU).round();
        }
        if rate.is_exactly(N::ZERO) || !rate.is_finite() {
            return [N::ZERO; 6];
        }
        let [a, h, x, y, z] = self.along(u, [start, v]).map(|g| g * rate);
        [a, h, x, y, z, rate]
    }
}

/// The edge rounded to f64.
#[derive(Clone, Copy)]
pub(super) struct RoundedEdge<'a> {
    pub ground: &'a Ground,
    pub curve: &'a Curve,
}

/// The integrand along an edge.
pub(super) struct OnEdge<'a, N: Float> {
    pub ground: &'a Ground<N>,
    pub curve: &'a Curve<N>,
    /// The v at which G starts, and a v on the edge.
    pub from: [N; 2],
    pub rounded_f64: Option<RoundedEdge<'a>>,
}

impl<N: Float> Integrand<N, 6> for OnEdge<'_, N> {
    fn at(&self, t: N) -> [N; 6] {
        self.ground.on_edge(self.curve, t, self.from)
    }

    fn roughly(&self, t: f64) -> Option<[f64; 6]> {
        let RoundedEdge { ground, curve } = self.rounded_f64?;
        Some(ground.on_edge(curve, t, self.from.map(N::rounded)))
    }
}

/// The integrand over u, between two v.
pub(super) struct Between<'a, N: Float> {
    pub ground: &'a Ground<N>,
    pub range: [N; 2],
    pub rounded_f64: Option<&'a Ground>,
}

impl<N: Float> Integrand<N, 5> for Between<'_, N> {
    fn at(&self, u: N) -> Moments<N> {
        self.ground.along(u, self.range)
    }

    fn roughly(&self, u: f64) -> Option<Moments<f64>> {
        Some(self.rounded_f64?.along(u, self.range.map(N::rounded)))
    }
}
