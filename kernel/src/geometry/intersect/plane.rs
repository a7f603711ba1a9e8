//! Intersection of a plane with another surface: lines and conics in closed form.

use super::{Branch, Node, RegionOfInterest, SurfaceIntersection, place};
use crate::geometry::curve::{Circle, Conic, Curve, Ellipse, Hyperbola, Line};
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Cone, Cylinder, Plane, Sphere};
use crate::geometry::surface_pair::{PairMeasure, SurfacePair};
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
        pair.how(PairMeasure::PlaneOnSphere),
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
            let on = (meeting.branches.len(), N::ZERO);
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

fn plane_beside_apex<N: Float>(
    p: &Plane<N>,
    c: &Cone<N>,
    h: N,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let (n, z) = (p.frame.z, c.frame.z);
    let cos = n.dot(&z);
    let mut meeting = SurfaceIntersection::nothing();
    let tan = c.sin / c.cos;
    // The semi-latus rectum of every section is the apex's distance from the plane times tan.
    let rectum = h.abs() * tan;
    let at = place(&c.frame.origin);
    if predicates.coincide("plane across axis", pair.how(PairMeasure::Drift), at) {
        let up = -h / cos;
        if up > N::ZERO {
            let frame = c.frame.at(c.frame.origin + z * up);
            meeting.add(
                Curve::Circle(Circle {
                    frame,
                    radius: up * tan,
                }),
                false,
                pair.extent,
            );
        }
        return meeting;
    }
    // The two rulings in the plane of symmetry, and the rates at which they approach the plane.
    let w = (n - z * cos).unit();
    let rulings = [z * c.cos + w * c.sin, z * c.cos - w * c.sin];
    let rates = rulings.map(|r| n.dot(&r));
    let vertex = |i: usize| c.frame.origin - rulings[i] * (h / rates[i]);
    let parallel = [false, true].map(|far| {
        let along = pair.how(PairMeasure::PlaneAlongRuling(far));
        predicates.coincide("ruling along plane", along, at)
    });
    if let Some(i) = parallel.iter().position(|&p| p) {
        if -h / rates[1 - i] > N::ZERO {
            let frame = Frame::toward(vertex(1 - i), n, rulings[i]);
            meeting.add(
                Curve::Conic(Conic::about_vertex(frame, rectum, N::ZERO)),
                false,
                pair.extent,
            );
        }
        return meeting;
    }
    let ahead = rates.map(|r| -h / r > N::ZERO);
    let near = match ahead {
        // The vertex closer to the apex.
        [true, true] => usize::from(rates[1].abs() > rates[0].abs()),
        [true, false] => 0,
        [false, true] => 1,
        [false, false] => return meeting,
    };
    // The distance between the vertices, computed without the apex's coordinates, which would lose
    // digits close to it.
    let product = rates[0] * rates[1];
    let a = h.abs() * c.sin * c.cos / product.abs();
    let b = (rectum * a).sqrt();
    let along = (w * cos - z * n.dot(&w)) * (h * product).signum();
    let x = if near == 0 { -along } else { along };
    let vertex = vertex(near);
    let closed = ahead == [true, true];
    let curve =
        if a > N::from_f64(FAR) * ((vertex - pair.extent.centre).length() + pair.extent.radius) {
            let outward = if closed { N::ONE } else { -N::ONE };
            let frame = Frame::toward(vertex, n, -x * outward);
            Curve::Conic(Conic::about_vertex(frame, rectum, outward * rectum / a))
        } else {
            let frame = Frame::toward(vertex - x * a, n, x);
            if closed {
                Curve::Ellipse(Ellipse { frame, a, b })
            } else {
                Curve::Hyperbola(Hyperbola { frame, a, b })
            }
        };
    meeting.add(curve, false, pair.extent);
    meeting
}
