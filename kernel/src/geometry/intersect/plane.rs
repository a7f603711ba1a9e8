//! Intersection of a plane with another surface: lines and conics in closed form.

use super::{Branch, Node, RegionOfInterest, SurfaceIntersection, place};
use crate::geometry::curve::{Circle, Conic, Curve, Ellipse, Hyperbola, Line};
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Cone, Cylinder, Plane, Sphere};
use crate::geometry::surface_pair::{PairMeasure, SurfacePair};
use crate::geometry::trace::BranchPosition;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::{Predicates, Side};
use nalgebra::{Point3, Vector3};

/// The signed height of a point above a plane.
fn height<N: Float>(p: &Plane<N>, x: &Point3<N>) -> N {
    (x - p.frame.origin).dot(&p.frame.z)
}

pub(super) fn plane_plane<N: Float>(
    p: &Plane<N>,
    q: &Plane<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let mut meeting = SurfaceIntersection::nothing();
    let across = p.frame.z.cross(&q.frame.z);
    let at = place(&p.frame.origin);
    if predicates.coincide("plane along plane", pair.how(PairMeasure::Drift), at) {
        return meeting;
    }
    let direction = across.unit();
    // The point of both planes closest to the extent's centre.
    let c = pair.extent.centre;
    let (hp, hq) = (height(p, &c), height(q, &c));
    let cos = p.frame.z.dot(&q.frame.z);
    let sin2 = across.length_squared();
    let origin = c + p.frame.z * ((hq * cos - hp) / sin2) + q.frame.z * ((hp * cos - hq) / sin2);
    // Second iteration: the first step loses digits where the planes are nearly parallel.
    let (hp, hq) = (height(p, &origin), height(q, &origin));
    let origin =
        origin + p.frame.z * ((hq * cos - hp) / sin2) + q.frame.z * ((hp * cos - hq) / sin2);
    meeting.add(Curve::Line(Line { origin, direction }), false, pair.extent);
    meeting
}

pub(super) fn plane_sphere<N: Float>(
    p: &Plane<N>,
    s: &Sphere<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let h = height(p, &s.frame.origin);
    let foot = s.frame.origin - p.frame.z * h;
    match predicates.classify_at_point(
        "plane on sphere",
        pair.how(PairMeasure::PlaneOnBall),
        place(&foot),
    ) {
        Side::Outside => SurfaceIntersection::nothing(),
        Side::On => SurfaceIntersection::touch(foot),
        Side::Inside => {
            let radius = ((s.radius - h.abs()) * (s.radius + h.abs())).sqrt();
            let mut meeting = SurfaceIntersection::nothing();
            let frame = p.frame.at(foot);
            meeting.add(Curve::Circle(Circle { frame, radius }), false, pair.extent);
            meeting
        }
    }
}

/// The ratio of the centre's distance to the extent above which a conic is represented about a
/// point.
const FAR: f64 = 256.0;

/// The ratio of the vertex's distance to the extent up to which a long ellipse is represented about
/// its vertex.
const NEAR: f64 = 16.0;

pub(super) fn plane_cylinder<N: Float>(
    p: &Plane<N>,
    c: &Cylinder<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let (n, z) = (p.frame.z, c.frame.z);
    let cos = n.dot(&z);
    let mut meeting = SurfaceIntersection::nothing();
    let at = place(&c.frame.origin);
    if predicates.coincide("plane along axis", pair.how(PairMeasure::Lean), at) {
        // The axis is parallel to the plane.
        let along = (pair.extent.centre - c.frame.origin).dot(&z);
        let middle = c.frame.origin + z * along;
        let h = height(p, &middle);
        let normal = (n - z * cos).unit();
        let foot = middle - normal * h;
        let line = |origin| {
            Curve::Line(Line {
                origin,
                direction: z,
            })
        };
        match predicates.classify(
            "plane on cylinder",
            pair.how(PairMeasure::PlaneOnCylinder),
            place(&foot),
        ) {
            Side::Outside => {}
            Side::On => meeting.add(line(foot), true, pair.extent),
            Side::Inside => {
                let half = ((c.radius - h.abs()) * (c.radius + h.abs())).sqrt();
                let side = z.cross(&normal) * half;
                meeting.add(line(foot - side), false, pair.extent);
                meeting.add(line(foot + side), false, pair.extent);
            }
        }
        return meeting;
    }
    let centre = c.frame.origin - z * (height(p, &c.frame.origin) / cos);
    let tilt = pair.how(PairMeasure::PlaneAcrossCylinder);
    if predicates.coincide("plane across axis", tilt, at) {
        let frame = c.frame.at(centre);
        meeting.add(
            Curve::Circle(Circle {
                frame,
                radius: c.radius,
            }),
            false,
            pair.extent,
        );
    } else {
        let (a, b) = (c.radius / cos.abs(), c.radius);
        if a > N::from_f64(FAR) * pair.extent.radius {
            add_long_section(p, c, pair.extent, &mut meeting);
            return meeting;
        }
        let frame = Frame::toward(centre, n, z);
        meeting.add(Curve::Ellipse(Ellipse { frame, a, b }), false, pair.extent);
    }
    meeting
}

/// The ellipse of a plane nearly parallel to a cylinder's axis, as far as it can lie in the extent.
///
/// Let X run along the plane's steepest line from the point closest to the extent's centre, and Y
/// across it. The points at X have the distance h + c X from the axis in the direction of the
/// plane's normal, so (h + c X)² + Y² = r².
fn add_long_section<N: Float>(
    p: &Plane<N>,
    s: &Cylinder<N>,
    extent: &RegionOfInterest<N>,
    meeting: &mut SurfaceIntersection<N>,
) {
    let (n, z, r) = (p.frame.z, s.frame.z, s.radius);
    let middle = s.frame.origin + z * (extent.centre - s.frame.origin).dot(&z);
    let c = -n.dot(&z);
    let outward = (n + z * c).unit();
    let h = -height(p, &middle) / n.dot(&outward);
    let foot = middle + outward * h;
    let steep = Frame::toward(foot, n, z);
    let vertex = |side: N| (side * r - h) / c;
    let side = if vertex(N::ONE).abs() < vertex(-N::ONE).abs() {
        N::ONE
    } else {
        -N::ONE
    };
    if vertex(side).abs() <= N::from_f64(NEAR) * extent.radius {
        let inward = steep.x * -(side * c).signum();
        let frame = Frame::toward(foot + steep.x * vertex(side), n, inward);
        let conic = Conic::about_vertex(frame, r * c.abs(), c * c);
        meeting.add(Curve::Conic(conic), false, extent);
    } else if h.abs() < r {
        let half = ((r - h) * (r + h)).sqrt();
        for y in [-half, half] {
            let slope = y.hypot(h * c);
            let normal = steep.x * (-h * c / slope) - steep.y * (y / slope);
            let unit = N::ONE / (slope * slope * slope);
            let conic = Conic {
                frame: Frame::toward(foot + steep.y * y, n, normal),
                curvature: (c * r).powi(2) * unit,
                shear: h * c * y * (N::ONE - c * c) * unit,
                flatness: ((c * c * h).powi(2) + y * y) * unit,
            };
            meeting.add(Curve::Conic(conic), false, extent);
        }
    }
}

pub(super) fn plane_cone<N: Float>(
    p: &Plane<N>,
    c: &Cone<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let apex = c.frame.origin;
    let h = height(p, &apex);
    match predicates.classify_at_point("apex on plane", pair.how(PairMeasure::Height), place(&apex))
    {
        Side::On => plane_through_apex(p, c, pair, predicates),
        _ => plane_beside_apex(p, c, h, pair, predicates),
    }
}

fn plane_through_apex<N: Float>(
    p: &Plane<N>,
    c: &Cone<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let apex = c.frame.origin;
    let n = c.frame.components(&p.frame.z);
    let across = n.x.hypot(n.y);
    // The rulings (sin cos u, sin sin u, cos) in the plane satisfy across · cos(u - u0) = -n_z cot.
    let u0 = n.y.atan2(n.x);
    let ruling = |u: N| {
        let local = Vector3::new(c.sin * u.cos(), c.sin * u.sin(), c.cos);
        Line {
            origin: apex,
            direction: c.frame.vector(&local),
        }
    };
    let mut meeting = SurfaceIntersection::nothing();
    let mut add = |u: N, tangent: bool| {
        let curve = Curve::Line(ruling(u));
        if let Some([_, end]) = curve.range_within(&pair.extent.centre, pair.extent.radius)
            && end > N::ZERO
        {
            let on = BranchPosition {
                branch: meeting.branches.len(),
                t: N::ZERO,
            };
            meeting.branches.push(Branch {
                curve,
                range: [N::ZERO, end],
                closed: false,
                tangent,
            });
            match meeting.nodes.first_mut() {
                Some(node) => node.on.push(on),
                None => meeting.nodes.push(Node {
                    point: apex,
                    on: vec![on],
                }),
            }
        }
    };
    match predicates.classify(
        "plane along a cone's ruling",
        pair.how(PairMeasure::PlaneOnRuling),
        place(&apex),
    ) {
        Side::Outside => return SurfaceIntersection::touch(apex),
        Side::On => add(if n.z > N::ZERO { u0 + N::PI } else { u0 }, true),
        Side::Inside => {
            let half = (-n.z * c.cos / (across * c.sin))
                .clamp(-N::ONE, N::ONE)
                .acos();
            add(u0 - half, false);
            add(u0 + half, false);
        }
    }
    meeting
}

/// The section of a cone by a plane at a distance from its apex.
struct ConeSection<'a, N: Float> {
    plane: &'a Plane<N>,
    cone: &'a Cone<N>,
    /// The distance of the apex above the plane.
    height: N,
    /// The cosine of the angle between the plane's normal and the axis.
    cos: N,
    /// The semi-latus rectum: of every section the apex's distance from the plane times the tangent
    /// of the half angle.
    rectum: N,
}

/// The two rulings of a cone in the plane of symmetry of a section.
struct SymmetricRulings<N: Float> {
    /// The unit vector of the plane of symmetry across the axis.
    across: Vector3<N>,
    /// Their directions.
    directions: [Vector3<N>; 2],
    /// The rates at which they approach the plane.
    rates: [N; 2],
}

fn plane_beside_apex<N: Float>(
    p: &Plane<N>,
    c: &Cone<N>,
    h: N,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let section = ConeSection {
        plane: p,
        cone: c,
        height: h,
        cos: p.frame.z.dot(&c.frame.z),
        rectum: h.abs() * (c.sin / c.cos),
    };
    let at = place(&c.frame.origin);
    let is_along = |far: bool| {
        let along = pair.how(PairMeasure::PlaneAlongRuling(far));
        predicates.coincide("ruling along plane", along, at)
    };
    let curve = if predicates.coincide("plane across axis", pair.how(PairMeasure::Drift), at) {
        section.circle()
    } else {
        let rulings = section.symmetric_rulings();
        match [false, true].map(is_along).iter().position(|&along| along) {
            Some(i) => section.parabola(&rulings, i),
            None => section.central_conic(&rulings, pair.extent),
        }
    };
    let mut meeting = SurfaceIntersection::nothing();
    if let Some(curve) = curve {
        meeting.add(curve, false, pair.extent);
    }
    meeting
}

impl<N: Float> ConeSection<'_, N> {
    /// The circle in a plane across the axis; `None` on the other side of the apex.
    fn circle(&self) -> Option<Curve<N>> {
        let c = self.cone;
        let up = -self.height / self.cos;
        (up > N::ZERO).then(|| {
            Curve::Circle(Circle {
                frame: c.frame.at(c.frame.origin + c.frame.z * up),
                radius: up * (c.sin / c.cos),
            })
        })
    }

    fn symmetric_rulings(&self) -> SymmetricRulings<N> {
        let (n, z, c) = (self.plane.frame.z, self.cone.frame.z, self.cone);
        let across = (n - z * self.cos).unit();
        let directions = [z * c.cos + across * c.sin, z * c.cos - across * c.sin];
        SymmetricRulings {
            across,
            directions,
            rates: directions.map(|r| n.dot(&r)),
        }
    }

    /// The vertex of the section on one of the rulings in its plane of symmetry.
    fn vertex(&self, rulings: &SymmetricRulings<N>, i: usize) -> Point3<N> {
        self.cone.frame.origin - rulings.directions[i] * (self.height / rulings.rates[i])
    }

    /// The parabola in a plane parallel to the i-th ruling; `None` on the other side of the apex.
    fn parabola(&self, rulings: &SymmetricRulings<N>, i: usize) -> Option<Curve<N>> {
        (-self.height / rulings.rates[1 - i] > N::ZERO).then(|| {
            let vertex = self.vertex(rulings, 1 - i);
            let frame = Frame::toward(vertex, self.plane.frame.z, rulings.directions[i]);
            Curve::Conic(Conic::about_vertex(frame, self.rectum, N::ZERO))
        })
    }

    /// The ellipse or the branch of a hyperbola; `None` on the other side of the apex. If its centre
    /// is too far away, it is a conic about its vertex.
    fn central_conic(
        &self,
        rulings: &SymmetricRulings<N>,
        extent: &RegionOfInterest<N>,
    ) -> Option<Curve<N>> {
        let (n, z, c, h) = (
            self.plane.frame.z,
            self.cone.frame.z,
            self.cone,
            self.height,
        );
        let rates = rulings.rates;
        let ahead = rates.map(|r| -h / r > N::ZERO);
        let near = match ahead {
            // The vertex closer to the apex.
            [true, true] => usize::from(rates[1].abs() > rates[0].abs()),
            [true, false] => 0,
            [false, true] => 1,
            [false, false] => return None,
        };
        // The distance between the vertices, computed without the apex's coordinates, which would
        // lose digits close to it.
        let product = rates[0] * rates[1];
        let a = h.abs() * c.sin * c.cos / product.abs();
        let b = (self.rectum * a).sqrt();
        let across = rulings.across;
        let along = (across * self.cos - z * n.dot(&across)) * (h * product).signum();
        let x = if near == 0 { -along } else { along };
        let vertex = self.vertex(rulings, near);
        let closed = ahead == [true, true];
        if a > N::from_f64(FAR) * ((vertex - extent.centre).length() + extent.radius) {
            let outward = if closed { N::ONE } else { -N::ONE };
            let frame = Frame::toward(vertex, n, -x * outward);
            let bend = outward * self.rectum / a;
            return Some(Curve::Conic(Conic::about_vertex(frame, self.rectum, bend)));
        }
        let frame = Frame::toward(vertex - x * a, n, x);
        Some(match closed {
            true => Curve::Ellipse(Ellipse { frame, a, b }),
            false => Curve::Hyperbola(Hyperbola { frame, a, b }),
        })
    }
}
