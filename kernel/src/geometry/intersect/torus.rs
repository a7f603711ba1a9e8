//! Intersection of a torus with another surface: circles if they are coaxial, along a meridian, or
//! Villarceau circles; otherwise a curve in the torus's angles.

use super::contact::{Contact, contacts, parallel};
use super::{Branch, IntersectionError, Node, SurfaceIntersection, parts_on, place, same_line};
use crate::geometry::bivariate_trig_poly::BivariateTrigPoly;
use crate::geometry::curve::{Circle, Curve};
use crate::geometry::curve_surface::lies_on;
use crate::geometry::elliptic_surface::EllipticCone;
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Cone, Plane, Surface, Torus};
use crate::geometry::surface_pair::{PairMeasure, SurfacePair};
use crate::geometry::torus_curve::TorusCurve;
use crate::geometry::trace::{BranchPosition, Singular, trace};
use crate::geometry::unresolved::Unresolved;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::{Predicates, Side};
use nalgebra::{Point3, Vector2};

/// Two tori: the curve in the angles of the smaller one. On the larger one the form is large far
/// from the curve, and so is its rounding error.
pub(super) fn torus_torus<N: Float>(
    t: &Torus<N>,
    o: &Torus<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    if o.reach() < t.reach() {
        torus_with(o, &pair.turned(), predicates)
    } else {
        torus_with(t, pair, predicates)
    }
}

/// A torus, the first of the pair, with another surface.
pub(super) fn torus_with<N: Float>(
    t: &Torus<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    let (other, extent) = (pair.b.surface, pair.extent);
    if let Some(meeting) = coaxial(t, pair, predicates) {
        return Ok(meeting);
    }
    if let Surface::Plane(p) = other
        && let Some(meeting) = central_plane(t, p, pair, predicates)
    {
        return Ok(meeting);
    }
    let contacts = contacts(t, pair, predicates);
    let whole = form(t, other);
    let rest = contacts.iter().fold(whole, |f, c| c.divided_out(&f));
    let mut meeting = traced(t, other, &rest, predicates)?;
    for contact in &contacts {
        // Other common points on the contact circle are singular points of the whole curve.
        let shared = contacts.iter().filter_map(|c| contact.crossing(c));
        let all = contact.zeros(&rest).into_iter().chain(shared);
        meeting.nodes.extend(all.map(|[theta, phi]| Node {
            point: Surface::Torus(*t).point(theta, phi),
            on: Vec::new(),
        }));
        match contact {
            Contact::Meridian(theta) => meeting.add_meridian(t, *theta, true, extent),
            Contact::Rim(_) => meeting.add(Curve::Circle(contact.circle(t)), true, extent),
        }
    }
    Ok(meeting)
}

/// The other surface as a function of the torus's angles, scaled to a distance to first order.
pub(super) fn form<N: Float>(t: &Torus<N>, other: &Surface<N>) -> BivariateTrigPoly<N> {
    let surface = Surface::Torus(*t);
    BivariateTrigPoly::interpolate(|theta, phi| {
        let p = surface.point(theta, phi);
        polynomial_level(other, &p, t)
    })
}

/// A polynomial that vanishes on a surface, scaled to the distance close to it.
fn polynomial_level<N: Float>(s: &Surface<N>, p: &Point3<N>, t: &Torus<N>) -> N {
    let slope = match s {
        Surface::Plane(_) => N::ONE,
        Surface::Cylinder(c) => N::TWO * c.radius,
        Surface::Sphere(c) => N::TWO * c.radius,
        Surface::Cone(c) => {
            let away = (t.frame.origin - c.frame.origin).length().max(t.minor);
            N::TWO * c.sin * away
        }
        Surface::Torus(c) => {
            let out = c.major.abs().max(N::HALF * c.reach());
            N::from_f64(8.0) * c.major.abs() * out * c.minor
        }
        Surface::EllipticCylinder(c) => N::TWO * c.radii[0].min(c.radii[1]),
        Surface::EllipticCone(c) => {
            let away = (t.frame.origin - c.frame.origin).length().max(t.minor);
            N::TWO * c.sine_squared().sqrt() * away
        }
        Surface::Ellipsoid(c) => N::TWO * c.radii.into_iter().fold(c.radii[0], N::min),
    };
    s.polynomial(p) / slope
}

/// A part of a traced branch that is kept.
struct BranchPart<N: Float = f64> {
    /// The index of the branch of the intersection.
    branch: usize,
    range: [N; 2],
}

/// The intersection of a torus with another surface, by tracing the zero set of its polynomial on the
/// torus.
fn traced<N: Float>(
    t: &Torus<N>,
    other: &Surface<N>,
    form: &BivariateTrigPoly<N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    let pair = TracedPair {
        own: Surface::Torus(*t),
        torus: t,
        other,
        predicates,
    };
    let is_on_curve = |angles: &[N; 2]| pair.is_on_zero_set(angles);
    let mut traced = trace(t, form, predicates.resolution(), &is_on_curve)?;
    let mut singular = traced.singular.iter().map(|s| s.angles);
    if let Some(angles) = singular.find(|angles| !is_on_curve(angles)) {
        return Err(Unresolved::at(angles).into());
    }
    pair.classify_near_misses(&traced.close);
    let mut meeting = SurfaceIntersection::nothing();
    let branches = std::mem::take(&mut traced.branches).into_iter().enumerate();
    let parts: Vec<Vec<BranchPart<N>>> = branches
        .map(|(index, branch)| {
            let passes = traced.singular.iter_mut().flat_map(|s| &mut s.on);
            let passes = passes.filter(|on| on.branch == index).map(|on| &mut on.t);
            pair.add_branch(branch, passes.collect(), &mut meeting)
        })
        .collect();
    for singular in &traced.singular {
        pair.add_node(singular, &parts, &mut meeting);
    }
    pair.add_apexes(&mut meeting);
    Ok(meeting)
}

/// A torus and a surface that are intersected by tracing.
struct TracedPair<'a, N: Float> {
    own: Surface<N>,
    torus: &'a Torus<N>,
    other: &'a Surface<N>,
    predicates: &'a Predicates,
}

impl<N: Float> TracedPair<'_, N> {
    /// Whether the point of the torus at two angles lies on the zero set of the other surface's
    /// polynomial, within the resolution. Next to an apex the polynomial is the square of a distance: it
    /// is below the resolution at points that are far from both nappes.
    fn is_on_zero_set(&self, &[theta, phi]: &[N; 2]) -> bool {
        let point = self.own.point(theta, phi);
        let is_on = |sheet: &Surface<N>| self.predicates.within(sheet.distance(&point));
        match other_sheet(self.other) {
            Some(second) => is_on(self.other) || is_on(&second),
            None => true,
        }
    }

    /// Records the points at which the surfaces touch or nearly touch.
    fn classify_near_misses(&self, close: &[[N; 2]]) {
        for [theta, phi] in close {
            let p = self.own.point(*theta, *phi);
            if self.torus.sheet_level([p.x, p.y, p.z]) < -self.predicates.resolution::<N>() {
                continue;
            }
            let distance = self.other.distance(&p);
            self.predicates
                .classify_at_point("torus touches surface", distance, place(&p));
        }
    }

    /// Adds the parts of a traced branch that lie on both surfaces: the form vanishes on both nappes of a
    /// cone and on both sheets of a torus. A branch that is a circle becomes one, and the parameters
    /// `passes` of singular points become those of the circle.
    fn add_branch(
        &self,
        branch: TorusCurve<N>,
        passes: Vec<&mut N>,
        meeting: &mut SurfaceIntersection<N>,
    ) -> Vec<BranchPart<N>> {
        let toric = Curve::Toric(Box::new(branch));
        let circle = circle_of(&toric, self.torus, self.other, self.predicates);
        let mut passed = Vec::with_capacity(passes.len());
        for at in passes {
            if let Some(circle) = &circle {
                *at = circle.parameter(&toric.point(*at));
            }
            passed.push(*at);
        }
        let curve = circle.unwrap_or(toric);
        let whole = [N::ZERO, curve.period().unwrap_or(N::ZERO)];
        let surfaces = [&self.own, self.other];
        let mut kept = Vec::new();
        for range in parts_on_both(&curve, whole, surfaces, self.predicates) {
            let range = range.map(|end| at_pass(&curve, end, &passed, self.predicates));
            kept.push(BranchPart {
                branch: meeting.branches.len(),
                range,
            });
            meeting.branches.push(Branch {
                curve: curve.clone(),
                range,
                closed: range == whole,
                tangent: false,
            });
        }
        kept
    }

    /// Adds the node at a singular point that lies on both surfaces.
    fn add_node(
        &self,
        singular: &Singular<N>,
        parts: &[Vec<BranchPart<N>>],
        meeting: &mut SurfaceIntersection<N>,
    ) {
        let [theta, phi] = singular.angles;
        let point = self.own.point(theta, phi);
        let lies_on =
            |s: &Surface<N>| other_sheet(s).is_none() || self.predicates.within(s.distance(&point));
        if !lies_on(&self.own) || !lies_on(self.other) {
            return;
        }
        let mut on = Vec::new();
        for &BranchPosition { branch, t: at } in &singular.on {
            for &BranchPart { branch, range } in &parts[branch] {
                // A part may extend beyond the period in which it starts.
                let cycle = meeting.branches[branch].curve.period().unwrap_or(N::ZERO);
                let whole = meeting.branches[branch].closed;
                let passes = [at, at + cycle].into_iter().take(2 - usize::from(whole));
                let passes = passes.filter(|&t| t >= range[0] && t <= range[1]);
                on.extend(passes.map(|t| BranchPosition { branch, t }));
            }
        }
        meeting.nodes.push(Node { point, on });
    }

    /// Adds the apexes of each surface that lie on the other.
    fn add_apexes(&self, meeting: &mut SurfaceIntersection<N>) {
        for [a, b] in [[&self.own, self.other], [self.other, &self.own]] {
            let apexes = a.apexes().filter(|p| self.predicates.within(b.distance(p)));
            meeting.nodes.extend(apexes.map(|point| Node {
                point,
                on: Vec::new(),
            }));
        }
    }
}

/// The other nappe of a cone, or the other sheet of a torus: the implicit polynomial of the surface
/// vanishes on it too.
fn other_sheet<N: Float>(surface: &Surface<N>) -> Option<Surface<N>> {
    let turned = |frame: &Frame<N>| Frame {
        y: -frame.y,
        z: -frame.z,
        ..*frame
    };
    match surface {
        Surface::Cone(cone) => Some(Surface::Cone(Cone {
            frame: turned(&cone.frame),
            ..*cone
        })),
        Surface::EllipticCone(cone) => Some(Surface::EllipticCone(EllipticCone {
            frame: turned(&cone.frame),
            ..*cone
        })),
        Surface::Torus(torus) if !torus.is_ring() => Some(Surface::Torus(Torus {
            major: -torus.major,
            ..*torus
        })),
        Surface::Torus(_)
        | Surface::Plane(_)
        | Surface::Cylinder(_)
        | Surface::Sphere(_)
        | Surface::EllipticCylinder(_)
        | Surface::Ellipsoid(_) => None,
    }
}

/// The parts of a curve on the implicit polynomials of two surfaces that lie on both.
fn parts_on_both<N: Float>(
    curve: &Curve<N>,
    range: [N; 2],
    surfaces: [&Surface<N>; 2],
    predicates: &Predicates,
) -> Vec<[N; 2]> {
    let parts = |range, s: &Surface<N>| parts_on(curve, range, s, predicates.resolution());
    let first = parts(range, surfaces[0]);
    let both = first.into_iter().flat_map(|part| parts(part, surfaces[1]));
    both.collect()
}

/// The circle that a branch is, if it is one. A sphere centred on a torus's spine intersects it in
/// circles of the tube, a cone about a tangent of the spine in one circle.
fn circle_of<N: Float>(
    branch: &Curve<N>,
    t: &Torus<N>,
    other: &Surface<N>,
    predicates: &Predicates,
) -> Option<Curve<N>> {
    let period = branch.period()?;
    let [a, b, c] =
        [N::ZERO, N::ONE, N::TWO].map(|third| branch.point(third * period / N::from_f64(3.0)));
    let circle = Curve::Circle(Circle::through(&a, &b, &c)?);
    let on = |s: &Surface<N>| lies_on(&circle, [N::ZERO, N::TAU], s, predicates.resolution());
    (on(&Surface::Torus(*t)) && on(other)).then_some(circle)
}

/// The end of a part of a closed curve, moved to the singular point close to it if there is one.
/// Next to a singular point only rounding determines where the curve leaves a nappe.
fn at_pass<N: Float>(curve: &Curve<N>, end: N, passes: &[N], predicates: &Predicates) -> N {
    let there = curve.point(end);
    let near = passes.iter().map(|&at| {
        let turns = curve
            .period()
            .map_or(N::ZERO, |period| period * ((end - at) / period).round());
        at + turns
    });
    near.filter(|&at| predicates.within((curve.point(at) - there).length()))
        .min_by(|a, b| (*a - end).abs().total_cmp(&(*b - end).abs()))
        .unwrap_or(end)
}

/// A coaxial surface: it intersects the torus in parallel circles, which are the common points of
/// the two profiles in a half plane.
fn coaxial<N: Float>(
    t: &Torus<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Option<SurfaceIntersection<N>> {
    let other = pair.b.surface;
    let f = other.frame();
    let at = place(&t.frame.origin);
    let is_coaxial = match other {
        Surface::Plane(_) => {
            predicates.coincide("plane across axis", pair.how(PairMeasure::Tilt), at)
        }
        Surface::Sphere(_) => {
            predicates.coincide("centre on axis", pair.how(PairMeasure::OffAxis), at)
        }
        Surface::EllipticCylinder(_) | Surface::EllipticCone(_) | Surface::Ellipsoid(_) => false,
        _ => same_line(pair, at, predicates),
    };
    if !is_coaxial {
        return None;
    }
    let up = (f.origin - t.frame.origin).dot(&t.frame.z);
    let sign = t.frame.z.dot(&f.z).signum();
    let profile = Profile {
        tube: Vector2::new(t.major, N::ZERO),
        radius: t.minor,
        pair,
        predicates,
    };
    let points = match other {
        Surface::Plane(_) => profile.line(&Vector2::new(N::ZERO, up), &Vector2::x()),
        Surface::Cylinder(c) => profile.line(&Vector2::new(c.radius, N::ZERO), &Vector2::y()),
        Surface::Cone(c) => {
            let apex = Vector2::new(N::ZERO, up);
            let d = Vector2::new(c.sin, sign * c.cos);
            let mut points = profile.line(&apex, &d);
            points.retain(|p| (p.at - apex).dot(&d) > N::ZERO);
            points
        }
        Surface::Sphere(s) => profile.circle(&Vector2::new(N::ZERO, up), s.radius),
        Surface::Torus(s) => profile.circle(&Vector2::new(s.major, up), s.minor),
        Surface::EllipticCylinder(_) | Surface::EllipticCone(_) | Surface::Ellipsoid(_) => {
            return None;
        }
    };
    let mut meeting = SurfaceIntersection::nothing();
    for ProfilePoint { at: p, tangent } in points {
        if !t.is_ring() && predicates.within(p.x) {
            meeting.nodes.push(Node {
                point: t.frame.point(N::ZERO, N::ZERO, p.y),
                on: Vec::new(),
            });
        } else if p.x > N::ZERO {
            meeting.add(Curve::Circle(parallel(t, p.y, p.x)), tangent, pair.extent);
        }
    }
    Some(meeting)
}

/// The profile of the tube in a half plane bounded by the axis, and the coaxial surface.
struct Profile<'a, N: Float = f64> {
    /// The centre of the tube: its distance from the axis and its height.
    tube: Vector2<N>,
    radius: N,
    pair: &'a SurfacePair<'a, N>,
    predicates: &'a Predicates,
}

/// A common point of two profiles.
struct ProfilePoint<N: Float = f64> {
    at: Vector2<N>,
    /// Whether the profiles are tangent there.
    tangent: bool,
}

impl<N: Float> ProfilePoint<N> {
    fn simple(at: Vector2<N>) -> Self {
        let tangent = false;
        Self { at, tangent }
    }

    fn tangent(at: Vector2<N>) -> Self {
        let tangent = true;
        Self { at, tangent }
    }
}

impl<N: Float> Profile<'_, N> {
    fn side(&self, question: &'static str, relation: PairMeasure, at: &Vector2<N>) -> Side {
        let f = self.pair.a.surface.frame();
        let at = f.point(at.x, N::ZERO, at.y);
        self.predicates
            .classify(question, self.pair.how(relation), place(&at))
    }

    /// The intersections of the circle with the line of a plane, a cylinder or a cone.
    fn line(&self, o: &Vector2<N>, d: &Vector2<N>) -> Vec<ProfilePoint<N>> {
        let foot = o + d * (self.tube - o).dot(d);
        let (h, r) = ((self.tube - foot).length(), self.radius);
        match self.side(
            "line on circle of a profile",
            PairMeasure::LineOnTube,
            &foot,
        ) {
            Side::Outside => Vec::new(),
            Side::On => vec![ProfilePoint::tangent(foot)],
            Side::Inside => {
                let half = ((r - h) * (r + h)).sqrt();
                vec![
                    ProfilePoint::simple(foot - d * half),
                    ProfilePoint::simple(foot + d * half),
                ]
            }
        }
    }

    /// The intersections of the circle with that of a sphere or another tube.
    fn circle(&self, a: &Vector2<N>, r: N) -> Vec<ProfilePoint<N>> {
        let away = self.tube - a;
        let (d, q) = (away.length(), self.radius);
        let concentric = self.side("centre on centre", PairMeasure::BetweenTubes, &self.tube);
        if concentric == Side::On {
            return Vec::new();
        }
        let axis = away / d;
        let foot = a + axis * (N::HALF * (d + (r - q) * (r + q) / d));
        let side = |gap| self.side("circle on circle of a profile", gap, &foot);
        match (side(PairMeasure::NextToTube), side(PairMeasure::InTube)) {
            (Side::On, _) => vec![ProfilePoint::tangent(a + axis * r)],
            (_, Side::On) => vec![ProfilePoint::tangent(a + axis * r.copysign(r - q))],
            (Side::Inside, Side::Inside) => {
                let area = (r + q - d) * (d + (r - q)) * (d - (r - q)) * (d + r + q);
                let half =
                    Vector2::new(-axis.y, axis.x) * (area.max(N::ZERO).sqrt() / (N::TWO * d));
                vec![
                    ProfilePoint::simple(foot - half),
                    ProfilePoint::simple(foot + half),
                ]
            }
            _ => Vec::new(),
        }
    }
}

/// A plane through the torus's centre that contains the axis, or is tangent to the tube twice
/// (Villarceau).
fn central_plane<N: Float>(
    t: &Torus<N>,
    p: &Plane<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Option<SurfaceIntersection<N>> {
    let (n, extent) = (p.frame.z, pair.extent);
    let at = place(&t.frame.origin);
    let height = pair.turned().how(PairMeasure::Height);
    if !predicates.coincide("centre on plane", height, at) {
        return None;
    }
    let mut meeting = SurfaceIntersection::nothing();
    if predicates.coincide("axis in plane", pair.how(PairMeasure::Upright), at) {
        let q = t.frame.components(&n);
        let theta = q.y.atan2(q.x) + N::TAU / N::from_f64(4.0);
        for theta in [theta, theta + N::TAU / N::TWO] {
            meeting.add_meridian(t, theta, false, extent);
        }
        for pole in t.poles() {
            meeting.cross_at(pole, predicates);
        }
        return Some(meeting);
    }
    if !t.is_ring() {
        return None;
    }
    let across = n.cross(&t.frame.z);
    let slope = across.length();
    let gap = pair.how(PairMeasure::PlaneOnBothSides);
    if !predicates.coincide("plane touching a torus twice", gap, at) {
        return None;
    }
    let axis = across / slope;
    for side in [-N::ONE, N::ONE] {
        let frame = p.frame.at(t.frame.origin + axis * (side * t.minor));
        meeting.add(
            Curve::Circle(Circle {
                frame,
                radius: t.major,
            }),
            false,
            extent,
        );
    }
    let reach = ((t.major - t.minor) * (t.major + t.minor)).sqrt();
    let up = n.cross(&axis);
    for side in [-N::ONE, N::ONE] {
        meeting.cross_at(t.frame.origin + up * (side * reach), predicates);
    }
    Some(meeting)
}
