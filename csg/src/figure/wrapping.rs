//! The order in which the boundary of a convex hull passes points, discs and arcs: gift wrapping
//! with common tangents (Jarvis 1973).
//!
//! A supporting line turns once around all elements. It touches an arc only while the normal of the
//! line is among the arc's; before and after that it touches the ends of the arc, which are points.

use super::FigurePoint;
use super::hull_elements::{Disc, HullElement, square};
use premio_kernel::number::predicates::RELATIVE_RESOLUTION;
use premio_kernel::number::rational::{Rational, to_f64};
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, TAU};

/// An element with what f64 needs.
struct Shape<'a> {
    disc: &'a Disc,
    centre: [f64; 2],
    radius: f64,
    /// The first normal of an arc and the angle that it turns.
    normals: Option<[f64; 2]>,
    ends: Option<&'a [FigurePoint; 2]>,
}

/// A common tangent: its direction, and the distance between its points of contact.
#[derive(Clone, Copy)]
struct Heading {
    angle: f64,
    along: f64,
}

/// The rounding of a direction, in units of f64's.
const ROUNDINGS: f64 = 64.0;

/// The square of a tangent, relative to the distance of the centres, below which it is computed
/// exactly.
const SHORT: f64 = 1.0 / 1024.0;

impl<'a> Shape<'a> {
    fn new(element: &'a HullElement) -> Self {
        let disc = element.disc();
        let ends = match element {
            HullElement::Disc(_) => None,
            HullElement::Arc { ends, .. } => Some(ends),
        };
        let normal = |p: &FigurePoint| {
            let [x, y] = [0, 1].map(|i| to_f64(&(&p[i] - &disc.centre[i])));
            y.atan2(x)
        };
        let normals = ends.map(|[first, last]| {
            let (from, to) = (normal(first), normal(last));
            [from, (to - from).rem_euclid(TAU)]
        });
        Self {
            disc,
            centre: disc.centre.each_ref().map(to_f64),
            radius: to_f64(&disc.radius),
            normals,
            ends,
        }
    }

    /// Whether a supporting line with this normal touches it.
    fn is_touched(&self, normal: f64) -> bool {
        let Some([first, turned]) = self.normals else {
            return true;
        };
        let slack = ROUNDINGS * f64::EPSILON;
        let at = (normal - first).rem_euclid(TAU);
        at <= turned + slack || at >= TAU - slack
    }

    /// The least height of its points, and the abscissa there.
    fn lowest(&self) -> Option<[f64; 2]> {
        let [x, y] = self.centre;
        self.is_touched(-FRAC_PI_2).then_some([y - self.radius, x])
    }

    /// Whether it is the point at an end of an arc.
    fn is_end(&self, arc: &Self, end: usize) -> bool {
        let is_point = self.disc.radius.is_zero();
        is_point && arc.ends.is_some_and(|ends| ends[end] == self.disc.centre)
    }

    /// The common tangent to another element that has both on its left. A point within `touching` of
    /// a circle, and a circle that touches another one from the inside, have none.
    fn tangent(&self, other: &Self, touching: f64) -> Option<Heading> {
        let at_end = |arc: &Self, by: usize| {
            let [first, turned] = arc.normals?;
            let angle = first + turned * by as f64 + FRAC_PI_2;
            Some(Heading { angle, along: 0.0 })
        };
        if other.is_end(self, 1) {
            return at_end(self, 1);
        }
        if self.is_end(other, 0) {
            return at_end(other, 0);
        }
        if other.is_end(self, 0) || self.is_end(other, 1) {
            return None;
        }
        let u = [0, 1].map(|i| other.centre[i] - self.centre[i]);
        let less = self.radius - other.radius;
        let square = u[0] * u[0] + u[1] * u[1];
        let mut along = square - less * less;
        if along < SHORT * square {
            along = to_f64(&tangent_square(self.disc, other.disc));
        }
        if along <= 2.0 * touching * self.radius.max(other.radius) {
            return None;
        }
        let along = along.sqrt();
        let angle = u[1].atan2(u[0]) + less.atan2(along);
        let normal = angle - FRAC_PI_2;
        let is_common = self.is_touched(normal) && other.is_touched(normal);
        is_common.then_some(Heading { angle, along })
    }
}

/// The square of the length of two discs' outer tangent.
fn tangent_square(a: &Disc, b: &Disc) -> Rational {
    let less = &a.radius - &b.radius;
    square(a, b) - &less * &less
}

/// The order in which the boundary of the hull passes the elements, counterclockwise. An element may
/// be passed several times. No element is passed if the wrapping does not close.
pub(super) fn wrapped(elements: &[HullElement]) -> Vec<usize> {
    let shapes: Vec<Shape<'_>> = elements.iter().map(Shape::new).collect();
    let Some(start) = first(&shapes) else {
        return Vec::new();
    };
    let mut order = vec![start];
    let mut heading = 0.0;
    let mut steps: HashMap<[usize; 2], usize> = HashMap::new();
    let touching = touching(&shapes);
    for _ in 0..4 * shapes.len() {
        let at = order[order.len() - 1];
        let Some((next, angle)) = onwards(&shapes, at, heading, touching) else {
            break;
        };
        heading = angle;
        // Of points in line with the first one only the outermost is passed again.
        let step = order.len() - 1;
        if let Some(first) = steps.insert([at, next], step) {
            return order.drain(first..step).collect();
        }
        order.push(next);
    }
    Vec::new()
}

/// The distance within which elements touch.
fn touching(shapes: &[Shape<'_>]) -> f64 {
    let reach = |shape: &Shape<'_>| {
        let [x, y] = shape.centre.map(f64::abs);
        x.max(y) + shape.radius
    };
    RELATIVE_RESOLUTION * shapes.iter().map(reach).fold(0.0, f64::max)
}

/// The element with the lowest point, of several the one farthest to the right.
fn first(shapes: &[Shape<'_>]) -> Option<usize> {
    let low = shapes.iter().enumerate();
    let low = low.filter_map(|(i, shape)| Some((i, shape.lowest()?)));
    let lowest = low.min_by(|(_, a), (_, b)| a[0].total_cmp(&b[0]).then(b[1].total_cmp(&a[1])));
    lowest.map(|(i, _)| i)
}

/// The element that the supporting line meets next, and its direction then.
fn onwards(shapes: &[Shape<'_>], at: usize, heading: f64, touching: f64) -> Option<(usize, f64)> {
    let same = ROUNDINGS * f64::EPSILON;
    let others = (0..shapes.len()).filter(|&j| j != at);
    let tangents = others.filter_map(|j| {
        let tangent = shapes[at].tangent(&shapes[j], touching)?;
        let by = (tangent.angle - heading).rem_euclid(TAU);
        // A tangent in the direction of the line differs from it by rounding.
        let by = if by > TAU - same { 0.0 } else { by };
        Some((j, by, tangent))
    });
    let next = tangents.reduce(|best, other| {
        let is_better = match (other.1 - best.1).abs() <= same {
            true => other.2.along > best.2.along,
            false => other.1 < best.1,
        };
        if is_better { other } else { best }
    });
    next.map(|(j, _, tangent)| (j, tangent.angle))
}
