//! Numbers and predicates of the plane: exact, filtered in f64.

use super::{ArcTurn, FigurePoint};
use premio_kernel::number::rational::{Rational, from_f64, to_f64};
use std::cmp::Ordering;

/// A point with its rounded coordinates.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FilteredPoint {
    pub exact: FigurePoint,
    /// The rounded coordinates, as ordered bits are not needed: they follow from the exact ones.
    near: OrderedPair,
}

/// Two f64 that are compared by their total order.
#[derive(Debug, Clone, Copy)]
struct OrderedPair([f64; 2]);

impl PartialEq for OrderedPair {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for OrderedPair {}

impl PartialOrd for OrderedPair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for OrderedPair {
    fn cmp(&self, other: &Self) -> Ordering {
        let [a, b] = [&self.0, &other.0];
        a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
    }
}

impl FilteredPoint {
    pub fn new(exact: &FigurePoint) -> Self {
        Self {
            exact: exact.clone(),
            near: OrderedPair(exact.each_ref().map(to_f64)),
        }
    }

    pub fn near(&self) -> [f64; 2] {
        self.near.0
    }

    /// Compares a coordinate with that of another point. Rounding keeps the order.
    pub fn compare(&self, other: &Self, axis: usize) -> Ordering {
        let rounded = self.near.0[axis].partial_cmp(&other.near.0[axis]);
        match rounded {
            Some(order @ (Ordering::Less | Ordering::Greater)) => order,
            _ => self.exact[axis].cmp(&other.exact[axis]),
        }
    }

    /// Whether it is another point.
    pub fn is_at(&self, other: &Self) -> bool {
        self.near.0 == other.near.0 && self.exact == other.exact
    }
}

/// The side of the line from `a` to `b` on which `c` lies: greater on the left.
pub(super) fn orientation(a: &FilteredPoint, b: &FilteredPoint, c: &FilteredPoint) -> Ordering {
    let ([ax, ay], [bx, by], [cx, cy]) = (a.near(), b.near(), c.near());
    let [ux, uy, vx, vy] = [bx - ax, by - ay, cx - ax, cy - ay];
    let size = [ax, ay, bx, by, cx, cy]
        .iter()
        .fold(0.0f64, |m, x| m.max(x.abs()));
    let span = [ux, uy, vx, vy].iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let value = ux * vy - uy * vx;
    if value.abs() > 32.0 * f64::EPSILON * size * span {
        return if value > 0.0 {
            Ordering::Greater
        } else {
            Ordering::Less
        };
    }
    cross(&a.exact, &b.exact, &c.exact).cmp(&Rational::ZERO)
}

/// Twice the signed area of a triangle.
pub(super) fn cross(a: &FigurePoint, b: &FigurePoint, c: &FigurePoint) -> Rational {
    (&b[0] - &a[0]) * (&c[1] - &a[1]) - (&b[1] - &a[1]) * (&c[0] - &a[0])
}

/// Whether a direction from the centre `c` of an arc lies in the sector of the arc from `s` to `e`.
pub(super) fn is_in_sector(
    d: [f64; 2],
    s: [f64; 2],
    e: [f64; 2],
    c: [f64; 2],
    turn: ArcTurn,
) -> bool {
    let [s, e] = match turn {
        ArcTurn::Counterclockwise => [s, e],
        ArcTurn::Clockwise => [e, s],
    };
    let [s, e] = [s, e].map(|p| [p[0] - c[0], p[1] - c[1]]);
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    match cross(s, e) >= 0.0 && (cross(s, e) > 0.0 || s[0] * e[0] + s[1] * e[1] < 0.0) {
        true => cross(s, d) >= 0.0 && cross(d, e) >= 0.0,
        false => !(cross(e, d) > 0.0 && cross(d, s) > 0.0),
    }
}

/// The direction of an angle in degrees: exact where sine and cosine are multiples of a half, else
/// rounded to f64. Directions that are symmetric about an axis or a diagonal have the same numbers.
pub(crate) fn direction(degrees: &Rational) -> FigurePoint {
    let right = Rational::from(90);
    let turns = Rational::from((degrees / &right).floor());
    let mut rest = degrees - &turns * &right;
    let is_steep = &rest + &rest > right;
    if is_steep {
        rest = &right - rest;
    }
    let [mut cos, mut sin] = shallow(&rest);
    if is_steep {
        std::mem::swap(&mut cos, &mut sin);
    }
    match quarter(&turns) {
        0 => [cos, sin],
        1 => [-sin, cos],
        2 => [-cos, -sin],
        _ => [sin, -cos],
    }
}

/// A number of quarter turns within a whole turn.
fn quarter(turns: &Rational) -> u8 {
    let whole = Rational::from((turns / Rational::from(4)).floor());
    let rest = turns - whole * Rational::from(4);
    (0..4).find(|&k| rest == Rational::from(k)).unwrap_or(0)
}

/// The direction of an angle from 0 to 45 degrees.
fn shallow(degrees: &Rational) -> FigurePoint {
    let number = |x: f64| from_f64(x).unwrap_or(Rational::ZERO);
    if degrees.is_zero() {
        return [Rational::ONE, Rational::ZERO];
    }
    let (sin, cos) = to_f64(degrees).to_radians().sin_cos();
    if *degrees == Rational::from(30) {
        return [number(cos), Rational::ONE / Rational::from(2)];
    }
    // At 45 degrees sine and cosine are equal, and rounding may tell them apart.
    match *degrees == Rational::from(45) {
        true => [number(cos), number(cos)],
        false => [number(cos), number(sin)],
    }
}
