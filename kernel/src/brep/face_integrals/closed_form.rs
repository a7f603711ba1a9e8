//! Integrals along edges in closed form: lines and ellipses in a plane, parallels and rulings of
//! surfaces of revolution.
//!
//! Notation: an edge runs over t = m + τ with |τ| ≤ δ, where m is the middle of its range; s is the v
//! at which G starts; W is the coefficient of sin τ in u, U that of cos τ, and X and V those in v.
//!
//! Only the even terms of an integrand remain in an integral over a range that is symmetric in τ.

use super::ground::Ground;
use super::strip::strip;
use super::{Amid, Moments};
use crate::geometry::curve::{Circle, Curve, Line};
use crate::geometry::surface::{Surface, Torus};
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::{Point3, Vector3};

/// ∫ G du and ∫ du over a piece of an edge; `None` if there is no closed form, or if digits would cancel
/// in it.
pub(super) fn along_edge<N: Float>(
    ground: &Ground<N>,
    amid: &Amid<N>,
    curve: &Curve<N>,
    [lo, hi]: [N; 2],
    start: N,
) -> Option<[N; 6]> {
    let arc = Piece {
        middle: N::HALF * (lo + hi),
        half: N::HALF * (hi - lo),
        start,
    };
    let largest = N::from_f64(LARGEST) * amid.size;
    match (&ground.surface, curve) {
        (Surface::Plane(_), Curve::Line(line)) => Some(line_in_plane(ground, line, arc)),
        (Surface::Plane(_), Curve::Circle(c)) if c.radius.is_at_most(largest) => {
            let axes = [c.frame.x * c.radius, c.frame.y * c.radius];
            Some(ellipse_in_plane(ground, &c.frame.origin, axes, arc))
        }
        (Surface::Plane(_), Curve::Ellipse(e)) if e.a.is_at_most(largest) => {
            let axes = [e.frame.x * e.a, e.frame.y * e.b];
            Some(ellipse_in_plane(ground, &e.frame.origin, axes, arc))
        }
        (Surface::Cylinder(_) | Surface::Cone(_), Curve::Line(line)) => {
            is_ruling(ground, amid, line, arc).then_some([N::ZERO; 6])
        }
        (Surface::Torus(torus), Curve::Circle(circle)) if is_meridian(amid, torus, circle) => {
            Some([N::ZERO; 6])
        }
        (Surface::Cylinder(_) | Surface::Cone(_) | Surface::Torus(_), Curve::Circle(circle))
            if circle.radius.is_at_most(largest) =>
        {
            parallel(ground, amid, circle, arc)
        }
        _ => None,
    }
}

/// The largest radius of a circle, relative to the part's size. On a larger circle digits cancel.
const LARGEST: f64 = 4.0;

/// A piece of an edge.
#[derive(Clone, Copy)]
struct Piece<N> {
    /// The middle of its range.
    middle: N,
    /// Half the length of its range.
    half: N,
    /// The v at which G starts.
    start: N,
}

/// The integrals of u', (v - s) u', u (v - s) u' and (v² - s²)/2 u' as those of G u' and u' on a plane.
fn on_plane<N: Float>(ground: &Ground<N>, [one, v, uv, vv]: [N; 4]) -> [N; 6] {
    let frame = ground.surface.frame();
    let origin = frame.origin - ground.reference;
    let height = origin.dot(&frame.z);
    let at = (origin * v + frame.x * uv + frame.y * vv) * height;
    [v, height * v, at.x, at.y, at.z, one]
}

fn line_in_plane<N: Float>(ground: &Ground<N>, line: &Line<N>, arc: Piece<N>) -> [N; 6] {
    let frame = ground.surface.frame();
    let q = frame.coordinates(&(line.origin + line.direction * arc.middle));
    let d = frame.components(&line.direction) * arc.half;
    let (above, third) = (q.y - arc.start, d.y / N::from_f64(3.0));
    let du = N::TWO * d.x;
    on_plane(
        ground,
        [
            du,
            du * above,
            du * (q.x * above + d.x * third),
            N::HALF * du * (above * (q.y + arc.start) + d.y * third),
        ],
    )
}

/// The ellipse of points centre + a cos t + b sin t.
fn ellipse_in_plane<N: Float>(
    ground: &Ground<N>,
    centre: &Point3<N>,
    axes: [Vector3<N>; 2],
    Piece {
        middle,
        half,
        start,
    }: Piece<N>,
) -> [N; 6] {
    let frame = ground.surface.frame();
    let centre = frame.coordinates(centre);
    let [a, b] = axes.map(|axis| frame.components(&axis));
    let (sin, cos) = middle.sin_cos();
    let (even, odd) = (a * cos + b * sin, b * cos - a * sin);
    let [u0, cu, su] = [centre.x, even.x, odd.x];
    let [v0, cv, sv] = [centre.y, even.y, odd.y];
    let Powers {
        c,
        cc,
        ss,
        ccc,
        ssc,
    } = Powers::over(half);
    let one = su * c;
    let above = v0 - start;
    let v = above * one + cv * su * cc - sv * cu * ss;
    let uv = cu * su * (above * (cc - ss) + cv * (ccc - ssc)) + sv * (su * su - cu * cu) * ssc;
    let vv = su
        * (above * (v0 + start) * c + cv * cv * ccc + sv * sv * ssc + N::TWO * v0 * cv * cc)
        - cu * N::TWO * (v0 * sv * ss + cv * sv * ssc);
    on_plane(ground, [one, v, u0 * v + uv, N::HALF * vv])
}

/// The integrals over -δ..δ of cos, cos², sin², cos³ and sin² cos.
struct Powers<N> {
    c: N,
    cc: N,
    ss: N,
    ccc: N,
    ssc: N,
}

impl<N: Float> Powers<N> {
    fn over(half: N) -> Self {
        let (sin, cos) = half.sin_cos();
        let c = N::TWO * sin;
        let ssc = N::TWO * sin * sin * sin / N::from_f64(3.0);
        Self {
            c,
            cc: half + sin * cos,
            ss: half - sin * cos,
            ccc: c - ssc,
            ssc,
        }
    }
}

/// Whether u is constant on a line of a cylinder or a cone, to the precision of the integrals.
fn is_ruling<N: Float>(ground: &Ground<N>, amid: &Amid<N>, line: &Line<N>, arc: Piece<N>) -> bool {
    let frame = ground.surface.frame();
    let d = frame.components(&line.direction);
    let q = frame.coordinates(&(line.origin + line.direction * arc.middle));
    let across = (q.x * d.y - q.y * d.x).abs() * arc.half;
    let ends = [-arc.half, arc.half].map(|half| (q.x + d.x * half).hypot(q.y + d.y * half));
    let nearest = ends[0].min(ends[1]);
    across.is_at_most(amid.part() * nearest * nearest)
}

/// Whether u is constant on a circle of a torus, to the precision of the integrals. Where the tube reaches
/// the axis, edges end there.
fn is_meridian<N: Float>(amid: &Amid<N>, torus: &Torus<N>, circle: &Circle<N>) -> bool {
    let axis = torus.frame.components(&circle.frame.z);
    let centre = torus.frame.coordinates(&circle.frame.origin);
    let part = amid.part();
    axis.z.abs().is_at_most(part)
        && (axis.x * centre.x + axis.y * centre.y)
            .abs()
            .is_at_most(part * torus.major.abs())
}

/// The integrals along a circle about the surface's axis.
fn parallel<N: Float>(
    ground: &Ground<N>,
    amid: &Amid<N>,
    circle: &Circle<N>,
    arc: Piece<N>,
) -> Option<[N; 6]> {
    let frame = ground.surface.frame();
    let axis = frame.components(&circle.frame.z);
    let centre = frame.coordinates(&circle.frame.origin);
    let error = amid.part() * amid.size;
    let is_coaxial = (axis.x.hypot(axis.y) * circle.radius).is_at_most(error)
        && centre.x.hypot(centre.y).is_at_most(error)
        && (N::from_f64(FEW) * error).is_short_of(circle.radius);
    if !is_coaxial {
        return None;
    }
    let place = circle.frame.point(
        circle.radius * arc.middle.cos(),
        circle.radius * arc.middle.sin(),
        N::ZERO,
    );
    let [u, v] = ground.parameters(&place);
    let sign = match axis.z.is_above_zero() {
        true => N::ONE,
        false => -N::ONE,
    };
    let sums = over_parallel(ground, u, arc.half, [arc.start, v]);
    let [a, h, x, y, z] = sums.map(|sum| sign * sum);
    Some([a, h, x, y, z, sign * N::TWO * arc.half])
}

/// The least ratio of a parallel's radius to its error. A smaller parallel may be a point.
const FEW: f64 = 256.0;

/// The integral over u in u - δ..u + δ and over v in a range on a surface of revolution. The integral
/// over v is a trigonometric polynomial of degree two in u, which five values determine.
fn over_parallel<N: Float>(ground: &Ground<N>, u: N, half: N, range: [N; 2]) -> Moments<N> {
    let steps = N::from_f64(5.0);
    let fifth = N::TAU / steps;
    let (sin, cos) = half.sin_cos();
    let (first, second) = (N::TWO * sin, N::TWO * sin * cos);
    let mut sum = [N::ZERO; 5];
    for k in 0..5 {
        let turn = N::from_f64(f64::from(k)) * fifth;
        let (one, two) = (turn.cos(), (N::TWO * turn).cos());
        let weight = (N::TWO * half + N::TWO * (one * first + two * second)) / steps;
        let at = strip(
            &ground.surface,
            &ground.reference,
            u + turn,
            ground.middle.angle,
            range,
        );
        for (s, value) in sum.iter_mut().zip(at) {
            *s += weight * value;
        }
    }
    sum
}

/// The integral over ranges of u and v; `None` if there is no closed form.
pub(super) fn over_ranges<N: Float>(
    ground: &Ground<N>,
    [from, to]: [N; 2],
    range: [N; 2],
) -> Option<Moments<N>> {
    match ground.surface {
        Surface::Cylinder(_) | Surface::Cone(_) | Surface::Sphere(_) | Surface::Torus(_) => {
            let half = N::HALF * (to - from);
            Some(over_parallel(ground, from + half, half, range))
        }
        Surface::Plane(_)
        | Surface::EllipticCylinder(_)
        | Surface::EllipticCone(_)
        | Surface::Ellipsoid(_) => None,
    }
}

#[cfg(test)]
mod tests;
