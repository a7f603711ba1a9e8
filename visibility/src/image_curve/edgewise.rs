//! Curves without a closed form on a surface that is seen edge-on, such as the mouth of a branch on
//! the wall of a pipe seen along its axis. Their images lie on the surface's image, a line or a
//! conic, and turn back on themselves.
//!
//! Two such curves on one surface overlap. Every other curve crosses them where it intersects the
//! surface. So no image has to be searched in two parameters.

use crate::camera::projection::{Projection, ViewRay};
use nalgebra::Point3;
use premio_kernel::geometry::curve::{Curve, Line};
use premio_kernel::geometry::curve_plane::{line_intersections, plane_roots};
use premio_kernel::geometry::curve_surface::cut;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Plane, Surface};
use premio_kernel::number::float::Analytic;
use premio_kernel::number::interval::Interval;
use premio_kernel::number::jet::Jet;
use premio_kernel::number::predicates::Compare;
use premio_kernel::number::roots::{Roots, isolate};

/// The cylinder that an image lies on, and where it turns back on itself.
#[derive(Clone, Debug)]
pub struct Edgewise {
    /// A cylinder, round or elliptic, seen along its axis.
    pub carrier: Surface,
    /// The parameters of the turning points.
    pub turns: Vec<f64>,
}

/// The number of points that determine whether a curve lies on a surface: no other curve of these
/// kinds intersects a cylinder in so many points of a range, unless it is constructed to.
const PLACES: usize = 17;

impl Edgewise {
    /// The curve over `range` on one of the surfaces, if that is seen edge-on: its angle to
    /// parallel sight has a sine of less than `tilt`. `resolution` is the resolution of the part.
    pub fn new<'a>(
        curve: &Curve,
        range: [f64; 2],
        surfaces: impl Iterator<Item = &'a Surface>,
        projection: &Projection,
        resolution: f64,
        tilt: f64,
    ) -> Option<Self> {
        let ViewRay::Direction(sight) = projection.sight else {
            return None;
        };
        let is_seen_along =
            |surface: &Surface| surface.frame().z.cross(&sight).norm().is_within(tilt);
        let (carrier, radius) = surfaces.into_iter().find_map(|surface| match surface {
            Surface::Cylinder(s) if is_seen_along(surface) => Some((*surface, s.radius)),
            Surface::EllipticCylinder(s) if is_seen_along(surface) => {
                Some((*surface, s.radii[0].max(s.radii[1])))
            }
            _ => None,
        })?;
        // The turning points are zeros of x y' - y x', the product of both radii times the derivative
        // of the angle.
        let f = |t: Interval| {
            let [x, y, _] = carrier.frame().local(curve.jet_over(t));
            Jet {
                v: (x.v * y.d - y.v * x.d).scale(1.0 / radius),
                d: (x.v * y.dd - y.v * x.dd).scale(1.0 / radius),
                dd: Interval::ENTIRE,
            }
        };
        let turns = match isolate(&f, &curve.breaks(range[0], range[1]), resolution) {
            Roots::Everywhere => Vec::new(),
            Roots::At { roots, .. } => roots.iter().map(|r| r.t).collect(),
        };
        Some(Self { carrier, turns })
    }

    /// Whether another curve lies on the carrier.
    pub fn contains(&self, curve: &Curve, [lo, hi]: [f64; 2], near: f64) -> bool {
        let at = |k: usize| lo + (hi - lo) * ((k as f64 + 0.5) / PLACES as f64);
        (0..PLACES).all(|k| self.carrier.distance(&curve.point(at(k))).is_within(near))
    }

    /// The parameters at which another curve intersects the carrier. Where it departs from the carrier
    /// by no more than `near`, it only touches.
    pub fn passed_by(&self, curve: &Curve, range: [f64; 2], near: f64) -> Vec<f64> {
        match cut(curve, range, &self.carrier, near) {
            Roots::Everywhere => Vec::new(),
            Roots::At { roots, .. } => roots.iter().map(|r| r.t).collect(),
        }
    }

    /// The parameters of the curve itself whose image is that of the point `p`.
    pub fn parameters(
        &self,
        curve: &Curve,
        range: [f64; 2],
        p: Point3<f64>,
        resolution: f64,
        found: &mut impl FnMut(f64),
    ) {
        let frame = self.carrier.frame();
        let q = frame.coordinates(&p);
        let size = q.x.hypot(q.y);
        // The image of the axis is not on the circle's image.
        if size.is_exactly(0.0) {
            return;
        }
        let (cos, sin) = (q.x / size, q.y / size);
        // On the wall the image is that of a ruling.
        let [u, _] = self.carrier.parameters(&p);
        let ruling = Line {
            origin: self.carrier.point(u, 0.0),
            direction: frame.z,
        };
        if line_intersections(curve, range, &ruling, resolution, &mut |t, _| found(t)) {
            return;
        }
        let plane = Plane {
            frame: Frame::about(frame.origin, frame.y * cos - frame.x * sin),
        };
        plane_roots(curve, range, &plane, resolution, &mut |t, _| {
            // On the ray from the axis through the point, not the one opposite.
            let at = frame.coordinates(&curve.point(t));
            if (at.x * cos + at.y * sin).is_above_zero() {
                found(t);
            }
        });
    }
}
