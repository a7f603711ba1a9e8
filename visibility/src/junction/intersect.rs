//! Where two contours cross in the image.
//!
//! One contour's points are substituted into the equation of the other's cone of sight: a plane
//! through the eye for a line, a quadric cone for a conic. Line and line, and line and conic have
//! closed forms. Two conics give a polynomial of degree four in the tangent of half the angle.
//! Other curves are isolated on their parameter against these, and two other curves are intersected
//! as graphs over a direction.

use crate::camera::projection::Projection;
use crate::contour_generator::contour_arc::ContourArc;
use crate::image_curve::edgewise::Edgewise;
use crate::image_curve::monotone_arc::passes;
use crate::image_curve::polynomial::{QuarticPolynomial, crossings};
use crate::image_curve::{Basis, Image, flat_of, image_distance, line_on_conic};
use crate::junction::intersect_general::general_pair;
use crate::scene::Scene;
use crate::scene::tolerance::IMAGE_TOLERANCE;
use nalgebra::{Matrix3, Point3, Rotation3, Vector2, Vector3};
use premio_kernel::number::analytic::dot;
use premio_kernel::number::bisection::bisect;
use premio_kernel::number::float::Analytic;
use premio_kernel::number::interval::Interval;
use premio_kernel::number::predicates::{Compare, ROUNDING};
use premio_kernel::number::roots::{Root, RootKind, Roots, isolate};
use std::f64::consts::TAU;

/// How two contours intersect in the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlap {
    /// In points only.
    No,
    /// They lie on one curve.
    Yes,
}

/// The number of points that determine whether a curve lies on a line or a conic.
const PLACES: usize = 19;

/// Curves overlap if they coincide over more than the whole divided by this.
const MOST: f64 = 64.0;

/// An arbitrary rotation, so that conics of symmetric parts do not cross at the ends of the halves.
const TURN: f64 = 0.618_033_988_749_894_9;

/// Reports the crossings of two arcs in the image: the parameters on both.
pub fn cross(
    a: &ContourArc<'_>,
    b: &ContourArc<'_>,
    projection: &Projection,
    resolution: f64,
    found: &mut impl FnMut(f64, f64),
) -> Overlap {
    let near = IMAGE_TOLERANCE * resolution;
    match (&a.image, &b.image) {
        (Image::Point, _) | (_, Image::Point) => Overlap::No,
        (Image::Edgewise(on), _) => edgewise(on, a, b, resolution, found),
        (_, Image::Edgewise(on)) => edgewise(on, b, a, resolution, &mut |s, t| found(t, s)),
        (Image::General, Image::General) => general_pair(a, b, projection, resolution, found),
        (Image::General, _) => general(a, b, projection, resolution, found),
        (_, Image::General) => general(b, a, projection, resolution, &mut |s, t| found(t, s)),
        (Image::Conic { .. }, Image::Conic { .. }) => conics(a, b, near, found),
        (Image::Conic { .. }, _) => line_and_conic(b, a, near, &mut |s, t| found(t, s)),
        (_, Image::Conic { .. }) => line_and_conic(a, b, near, found),
        _ => lines(a, b, near, found),
    }
}

/// The homogeneous image at a parameter.
fn at(contour_arc: &ContourArc<'_>, t: f64) -> Vector3<f64> {
    match &contour_arc.image {
        Image::Line {
            origin, direction, ..
        } => origin + direction * t,
        Image::Conic { basis, map, .. } | Image::Flat { basis, map, .. } => map * basis.at(t),
        Image::Point | Image::Edgewise(_) | Image::General => Vector3::z(),
    }
}

/// Both on lines.
fn lines(
    a: &ContourArc<'_>,
    b: &ContourArc<'_>,
    near: f64,
    found: &mut impl FnMut(f64, f64),
) -> Overlap {
    let (Some(la), Some(lb)) = (a.image.line(), b.image.line()) else {
        return Overlap::No;
    };
    let on = |s: &ContourArc<'_>, l: &Vector3<f64>| {
        let [lo, hi] = s.range;
        let most = near * l.x.hypot(l.y);
        [lo, hi, 0.5 * (lo + hi)]
            .iter()
            .all(|t| l.dot(&at(s, *t)).is_within(most))
    };
    if on(a, lb) && on(b, la) {
        return Overlap::Yes;
    }
    line_parameters(a, lb, &mut |t| {
        let h = at(a, t);
        b.image.parameters(&h, b.range, &mut |s| found(t, s));
    });
    Overlap::No
}

/// Reports where an arc intersects a line in the image.
fn line_parameters(a: &ContourArc<'_>, l: &Vector3<f64>, found: &mut impl FnMut(f64)) {
    match &a.image {
        Image::Line {
            origin, direction, ..
        } => {
            let slope = l.dot(direction);
            if !slope.is_exactly(0.0) {
                found(-l.dot(origin) / slope);
            }
        }
        Image::Flat { basis, map, .. } => {
            line_on_conic(*basis, &map.tr_mul(l), a.range, found);
        }
        _ => {}
    }
}

/// A conic in the image, as the map from its own basis. For a circle seen almost edge-on its form
/// in image coordinates has no significant digits left. In the basis it is the form of the unit
/// circle.
#[derive(Clone, Copy)]
struct ConicImage<'x> {
    basis: Basis,
    map: &'x Matrix3<f64>,
    inverse: &'x Matrix3<f64>,
}

impl<'x> ConicImage<'x> {
    fn new(image: &'x Image) -> Option<Self> {
        match image {
            Image::Conic {
                basis,
                map,
                inverse,
                ..
            } => Some(Self {
                basis: *basis,
                map,
                inverse,
            }),
            _ => None,
        }
    }

    /// The ratio of the area to the sum of the squares of two conjugate radii, at the origin of the
    /// basis: a half for a circle, zero for a conic seen edge-on.
    fn roundness(&self) -> f64 {
        let origin = self.map.column(2);
        let radius = |i: usize| {
            let column = self.map.column(i);
            let across = |k: usize| column[k] * origin.z - origin[k] * column.z;
            Vector2::new(across(0), across(1))
        };
        let [p, q] = [radius(0), radius(1)];
        p.perp(&q).abs() / (p.norm_squared() + q.norm_squared())
    }

    /// Whether an image point lies within `near` of it, as a distance in space, or within rounding
    /// error.
    fn passes(&self, h: &Vector3<f64>, near: f64) -> bool {
        let form = self.basis.conic();
        let point = self.inverse * h;
        let half_slope = form * point;
        let polar = self.inverse.tr_mul(&half_slope);
        let rounding = ROUNDING * half_slope.abs().dot(&(self.inverse.abs() * h.abs()));
        let reach = 2.0 * (near * polar.x.hypot(polar.y) + rounding);
        point.dot(&half_slope).is_within(reach)
    }

    /// The form, in the basis of another map, of the points that lie on it.
    fn form_over(&self, map: &Matrix3<f64>) -> Matrix3<f64> {
        let over = self.inverse * map;
        over.tr_mul(&(self.basis.conic() * over))
    }

    /// The parameters at which it crosses a line. Where it departs from the line by no more than
    /// `near`, it only touches.
    fn crossings_with(&self, line: &Vector3<f64>, range: [f64; 2], near: f64) -> Vec<f64> {
        let k = self.map.tr_mul(line);
        let mut roots = Vec::new();
        line_on_conic(self.basis, &k, range, &mut |t| roots.push(t));
        let &[first, second] = &roots[..] else {
            return roots;
        };
        let rise = |t: f64| k.dot(&self.basis.at(t)).abs();
        let middle = 0.5 * (first + second);
        let between = match self.basis {
            // Both arcs that the line cuts off.
            Basis::Circular => rise(middle).min(rise(middle + 0.5 * TAU)),
            _ => rise(middle),
        };
        match between.is_within(near * line.x.hypot(line.y)) {
            true => Vec::new(),
            false => roots,
        }
    }
}

/// `a` is on a line.
fn line_and_conic(
    a: &ContourArc<'_>,
    b: &ContourArc<'_>,
    near: f64,
    found: &mut impl FnMut(f64, f64),
) -> Overlap {
    let (Some(conic), Some(line)) = (ConicImage::new(&b.image), a.image.line()) else {
        return Overlap::No;
    };
    for s in conic.crossings_with(line, b.range, near) {
        let h = at(b, s);
        a.image.parameters(&h, a.range, &mut |t| found(t, s));
    }
    Overlap::No
}

/// Both on conics. The points of the thinner one are substituted into the equation of the other: in
/// the other order the two crossings of a thin ellipse are almost a double root.
fn conics(
    a: &ContourArc<'_>,
    b: &ContourArc<'_>,
    near: f64,
    found: &mut impl FnMut(f64, f64),
) -> Overlap {
    let (Some(first), Some(second)) = (ConicImage::new(&a.image), ConicImage::new(&b.image)) else {
        return Overlap::No;
    };
    if second.roundness().is_short_of(first.roundness()) {
        return conics_in_order([b, a], [second, first], near, &mut |s, t| found(t, s));
    }
    conics_in_order([a, b], [first, second], near, found)
}

fn conics_in_order(
    [a, b]: [&ContourArc<'_>; 2],
    [first, second]: [ConicImage<'_>; 2],
    near: f64,
    found: &mut impl FnMut(f64, f64),
) -> Overlap {
    let [lo, hi] = a.range;
    let touches = |t: f64| second.passes(&(first.map * first.basis.at(t)), near);
    // Five points determine a conic.
    let mut places = [0.03, 0.21, 0.47, 0.68, 0.91].iter();
    if places.all(|part| touches(lo + (hi - lo) * part)) {
        return Overlap::Yes;
    }
    let form = second.form_over(first.map);
    conic_parameters(first.basis, &form, a.range, &|t, _| touches(t), &mut |t| {
        let h = first.map * first.basis.at(t);
        b.image.parameters(&h, b.range, &mut |s| found(t, s));
    });
    Overlap::No
}

/// Reports where b(t)ᵀ G b(t) changes its sign in the range.
fn conic_parameters(
    basis: Basis,
    g: &Matrix3<f64>,
    [lo, hi]: [f64; 2],
    touches: &impl Fn(f64, f64) -> bool,
    found: &mut impl FnMut(f64),
) {
    match basis {
        Basis::Circular => {
            for half in 0..2 {
                let turn = TURN + 0.5 * TAU * f64::from(half);
                let spin = Rotation3::from_axis_angle(&Vector3::z_axis(), turn);
                let g = spin.matrix().tr_mul(&(g * spin.matrix()));
                // b = (1 - u², 2 u, 1 + u²) with u = tan(t/2).
                let k = binary([1.0, 0.0, -1.0], [0.0, 2.0, 0.0], [1.0, 0.0, 1.0], &g);
                let angle = |u: f64| turn + 2.0 * u.atan();
                crossings(&k, [-1.0, 1.0], &|u, v| touches(angle(u), v), &mut |u| {
                    found(lo + (angle(u) - lo).rem_euclid(TAU));
                });
            }
        }
        Basis::Graph(c) => {
            let rest = [1.0, 2.0 * c.shear, c.curvature * c.flatness];
            let k = binary([0.0, 0.0, 2.0 * c.curvature], [0.0, 2.0, 0.0], rest, g);
            let ends = [lo, hi].map(|t| c.chord(t));
            let t = |m: f64| c.end_of_chord(m).unwrap_or(f64::NAN);
            crossings(&k, ends, &|m, v| touches(t(m), v), &mut |m| found(t(m)));
        }
        Basis::Hyperbolic => {
            // 2 e b = (e² + 1, e² - 1, 2 e) with e = exp t.
            let k = binary([1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], [0.0, 2.0, 0.0], g);
            let ends = [lo.exp(), hi.exp()];
            crossings(&k, ends, &|e, v| touches(e.ln(), v), &mut |e| found(e.ln()));
        }
    }
}

/// vᵀ G v for a vector of three quadratics.
fn binary(x: [f64; 3], y: [f64; 3], z: [f64; 3], g: &Matrix3<f64>) -> QuarticPolynomial {
    let v = [x, y, z];
    let mut k = [0.0; 5];
    for i in 0..3 {
        for j in 0..3 {
            for (m, p) in v[i].iter().enumerate() {
                for (n, q) in v[j].iter().enumerate() {
                    k[m + n] += g[(i, j)] * p * q;
                }
            }
        }
    }
    k
}

/// A curve that is neither line nor conic against one that is.
fn general(
    a: &ContourArc<'_>,
    b: &ContourArc<'_>,
    projection: &Projection,
    resolution: f64,
    found: &mut impl FnMut(f64, f64),
) -> Overlap {
    let near = IMAGE_TOLERANCE * resolution;
    if falls_on(a, b, projection, near) {
        return Overlap::Yes;
    }
    let middle = a.curve.point(0.5 * (a.range[0] + a.range[1]));
    let middle = projection.homogeneous(&middle);
    let image = |t: Interval| projection.homogeneous_over(a.curve.jet_over(t));
    let solve = |breaks: &[f64]| match &b.image {
        Image::Conic { basis, inverse, .. } => {
            let scale = 0.5 / (least_slope(b, projection) * middle.z);
            let form = basis.conic();
            let f = |t: Interval| {
                let h = image(t);
                let p = [0, 1, 2].map(|i| dot(&inverse.row(i).transpose(), h));
                let row = |i: usize| dot(&form.row(i).transpose(), p);
                (p[0] * row(0) + p[1] * row(1) + p[2] * row(2)).scale(scale)
            };
            isolate(&f, breaks, near)
        }
        other => {
            let line = other.line().copied().unwrap_or_else(Vector3::z);
            let line = line / line.x.hypot(line.y);
            isolate(&|t: Interval| dot(&line, image(t)), breaks, near)
        }
    };
    let mut together = 0.0;
    for breaks in a.runs_next_to(&b.hull) {
        match solve(&breaks) {
            Roots::Everywhere => together += a.length_between(&breaks),
            Roots::At { roots, .. } => {
                for r in &roots {
                    if let Some(both) = both_branches(r, [a, b], projection, resolution) {
                        both.into_iter().for_each(|s| found(r.t, s));
                        continue;
                    }
                    let branch = |s: f64| Branch {
                        a,
                        b,
                        projection,
                        next_to: s,
                    };
                    let h = projection.homogeneous(&a.curve.point(r.t));
                    b.image.parameters(&h, b.range, &mut |s| {
                        let branch = branch(s);
                        if let Some(t) = place_of(r, [a, b], |t| branch.ahead(t)) {
                            found(t, branch.parameter(t).unwrap_or(s));
                        }
                    });
                }
            }
        }
    }
    overlap_of(together, a)
}

/// The least slope of a conic's equation at some points of an arc of it, normalised to depth one. A
/// value divided by it is at most the distance from the conic. Away from the conic the slope may
/// vanish.
fn least_slope(b: &ContourArc<'_>, projection: &Projection) -> f64 {
    let Some(conic) = ConicImage::new(&b.image) else {
        return 1.0;
    };
    let [lo, hi] = b.range;
    let slopes = (0..=SLOPES).map(|k| {
        let t = lo + (hi - lo) * f64::from(k) / f64::from(SLOPES);
        let point = projection.homogeneous(&b.curve.point(t));
        let form = conic.basis.conic();
        let polar = conic.inverse.tr_mul(&(form * (conic.inverse * point)));
        polar.x.hypot(polar.y) / point.z
    });
    slopes.fold(f64::INFINITY, f64::min)
}

/// The number of intervals between the points at which a conic's slope is evaluated.
const SLOPES: u32 = 8;

/// The place where a root on `a` is a crossing. A root of even multiplicity is a crossing only
/// where the curves intersect in space, so that the front one changes. A root that is
/// indistinguishable from a common junction is placed there: the curves touch, and the root may be
/// a long way off.
pub fn place_of(
    root: &Root,
    [a, b]: [&ContourArc<'_>; 2],
    ahead: impl Fn(f64) -> Option<f64>,
) -> Option<f64> {
    let within = |t: &f64| t.lies_in([root.lo, root.hi]);
    let shared = |id: u32| b.junctions().any(|other| other.junction == id);
    let mut known = a
        .junctions()
        .filter(|at| within(&at.t) && shared(at.junction));
    if let Some(at) = known.next() {
        return Some(at.t);
    }
    if root.contact != RootKind::Touching {
        return Some(root.t);
    }
    let (from, to) = (ahead(root.lo)?, ahead(root.hi)?);
    let nearer = |t: f64| ahead(t).unwrap_or(from);
    let changes = from.is_below_zero() != to.is_below_zero();
    changes.then(|| bisect(root.lo, root.hi, from, nearer))
}

/// Two branches of a conic coincide in the image within this multiple of the touching distance, and
/// are apart in space by more than [`APART`] times as much.
const BRANCHES: f64 = 4.0;
/// See [`BRANCHES`].
const APART: f64 = 4.0;

/// The parameters at which a curve `a` crosses the two branches of a conic `b` that is seen nearly
/// edge-on, at a root of even multiplicity. The branches coincide in the image and are apart in
/// space. Each is a crossing, because an arc of the conic may contain only one of them. `None` where
/// the curve touches the conic.
fn both_branches(
    root: &Root,
    [a, b]: [&ContourArc<'_>; 2],
    projection: &Projection,
    resolution: f64,
) -> Option<[f64; 2]> {
    let conic = ConicImage::new(&b.image).filter(|_| root.contact == RootKind::Touching)?;
    let p = a.curve.point(root.t);
    let ahead = p + a.curve.derivative(root.t);
    let tangent = (projection.homogeneous(&p)).cross(&projection.homogeneous(&ahead));
    let mut crossed = Vec::new();
    let mut push = |s| crossed.push(s);
    line_on_conic(conic.basis, &conic.map.tr_mul(&tangent), b.range, &mut push);
    let &[first, second] = &crossed[..] else {
        return None;
    };
    let near = BRANCHES * IMAGE_TOLERANCE * resolution;
    let points = [first, second].map(|s| b.curve.point(s));
    let mut distances = points.iter().map(|q| image_distance(projection, &p, q));
    let coincide = distances.all(|distance| distance.is_within(near));
    let are_apart = (points[1] - points[0]).norm().is_beyond(APART * near);
    (coincide && are_apart).then_some([first, second])
}

/// The branch of a line or conic `b` that passes points of another curve `a` in the image, near a
/// parameter: one seen edge-on passes them twice.
struct Branch<'x> {
    a: &'x ContourArc<'x>,
    b: &'x ContourArc<'x>,
    projection: &'x Projection,
    next_to: f64,
}

impl Branch<'_> {
    /// The parameter on `b` of the point with the image of `a` at `t`.
    fn parameter(&self, t: f64) -> Option<f64> {
        let away = |s: f64| {
            let away = (s - self.next_to).abs();
            let period = self.b.curve.period();
            period.map_or(away, |period| away.min(period - away))
        };
        let h = self.projection.homogeneous(&self.a.curve.point(t));
        let mut nearest: Option<f64> = None;
        self.b.image.parameters(&h, self.b.range, &mut |s| {
            if nearest.is_none_or(|n| away(s).is_short_of(away(n))) {
                nearest = Some(s);
            }
        });
        nearest
    }

    /// How far `b` lies in front of the point of `a` there.
    fn ahead(&self, t: f64) -> Option<f64> {
        let p = self.a.curve.point(t);
        let v = self.projection.towards_eye(&p).direction;
        let q = self.b.curve.point(self.parameter(t)?);
        Some((q - p).dot(&v))
    }
}

/// Whether the image of a curve lies on the line or conic of another: no other curve of these kinds
/// intersects one in so many points.
fn falls_on(a: &ContourArc<'_>, b: &ContourArc<'_>, projection: &Projection, near: f64) -> bool {
    let [lo, hi] = a.range;
    let at = |k: usize| lo + (hi - lo) * ((k as f64 + 0.5) / PLACES as f64);
    (0..PLACES).all(|k| {
        let h = projection.homogeneous(&a.curve.point(at(k)));
        match (ConicImage::new(&b.image), b.image.line()) {
            (Some(conic), _) => conic.passes(&h, near),
            (_, Some(line)) => line.dot(&h).is_within(near * line.x.hypot(line.y)),
            _ => false,
        }
    })
}

/// Whether curves overlap that coincide over a length of the image of `a`: near a tangency the
/// length is short.
pub fn overlap_of(together: f64, a: &ContourArc<'_>) -> Overlap {
    if (together * MOST).is_beyond(a.length_between(&a.range)) {
        Overlap::Yes
    } else {
        Overlap::No
    }
}

/// Intersects a curve on a surface seen edge-on with any other.
fn edgewise(
    on: &Edgewise,
    a: &ContourArc<'_>,
    b: &ContourArc<'_>,
    resolution: f64,
    found: &mut impl FnMut(f64, f64),
) -> Overlap {
    let near = IMAGE_TOLERANCE * resolution;
    if on.contains(b.curve, b.range, near) {
        return Overlap::Yes;
    }
    for s in on.passed_by(b.curve, b.range, near) {
        let p = b.curve.point(s);
        on.parameters(a.curve, a.range, p, resolution, &mut |t| found(t, s));
    }
    Overlap::No
}

/// The parameters at which an arc's image passes through that of a point.
pub fn parameters_at(
    contour_arc: &ContourArc<'_>,
    p: &Point3<f64>,
    scene: &Scene<'_>,
    found: &mut impl FnMut(f64),
) {
    let projection = scene.projection;
    match &contour_arc.image {
        Image::Edgewise(on) => on.parameters(
            contour_arc.curve,
            contour_arc.range,
            *p,
            scene.resolution,
            found,
        ),
        Image::General => {
            let p = flat_of(projection, p);
            passes(
                contour_arc.curve,
                &contour_arc.stretches,
                projection,
                p,
                found,
            );
        }
        image => image.parameters(&projection.homogeneous(p), contour_arc.range, found),
    }
}
