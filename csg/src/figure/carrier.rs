//! Edges of figures in 106 bits: their supports, and where these intersect.

use super::{ArcTurn, FigureEdge, FigurePoint};
use premio_kernel::number::double_double::F106;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::Compare;

/// A point in 106 bits.
pub(super) type Point = [F106; 2];

/// The line or the circle that supports an edge.
#[derive(Debug, Clone, Copy)]
pub(super) enum Support {
    /// A line by its unit direction.
    Line { direction: Point },
    /// A circle.
    Circle {
        centre: Point,
        radius: F106,
        turn: ArcTurn,
    },
}

/// An edge with its support.
#[derive(Debug, Clone, Copy)]
pub(super) struct SupportedEdge {
    pub start: Point,
    pub end: Point,
    pub support: Support,
}

pub(super) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn plus(a: Point, b: Point, by: F106) -> Point {
    [a[0] + b[0] * by, a[1] + b[1] * by]
}

pub(super) fn cross(a: Point, b: Point) -> F106 {
    a[0] * b[1] - a[1] * b[0]
}

pub(super) fn dot(a: Point, b: Point) -> F106 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn length(a: Point) -> F106 {
    a[0].hypot(a[1])
}

/// A quarter turn to the left.
pub(super) fn left(a: Point) -> Point {
    [-a[1], a[0]]
}

pub(super) fn nearest(p: &FigurePoint) -> Point {
    p.each_ref().map(F106::nearest)
}

/// The common points of two supports.
pub(super) enum Common {
    /// None, or one or two.
    Points(Vec<Point>),
    /// The supports coincide within the tolerance.
    All,
}

impl SupportedEdge {
    pub fn new(edge: &FigureEdge) -> Self {
        let [start, end] = [&edge.start, &edge.end].map(nearest);
        let support = match &edge.arc {
            Some(arc) => Support::Circle {
                centre: nearest(&arc.centre),
                radius: F106::nearest(&arc.radius),
                turn: arc.turn,
            },
            None => {
                let along = minus(end, start);
                let size = length(along);
                Support::Line {
                    direction: along.map(|x| x / size),
                }
            }
        };
        Self {
            start,
            end,
            support,
        }
    }

    /// How far along the edge the foot of a point is: a length on a line, an angle from the start
    /// in the sense of the arc on a circle, from minus a half turn to three halves.
    pub fn parameter(&self, p: Point) -> F106 {
        match self.support {
            Support::Line { direction } => dot(minus(p, self.start), direction),
            Support::Circle { centre, turn, .. } => {
                let [s, q] = [self.start, p].map(|x| minus(x, centre));
                let angle = cross(s, q).atan2(dot(s, q));
                let angle = match turn {
                    ArcTurn::Counterclockwise => angle,
                    ArcTurn::Clockwise => -angle,
                };
                // Points a little before the start come before it.
                let sweep = self.sweep();
                match angle.is_below_zero()
                    && (angle + F106::TAU).is_short_of(F106::HALF * (sweep + F106::TAU))
                {
                    true => angle + F106::TAU,
                    false => angle,
                }
            }
        }
    }

    /// The parameter of its end.
    pub fn sweep(&self) -> F106 {
        match self.support {
            Support::Line { direction } => dot(minus(self.end, self.start), direction),
            Support::Circle { centre, turn, .. } => {
                let [s, e] = [self.start, self.end].map(|x| minus(x, centre));
                let angle = cross(s, e).atan2(dot(s, e));
                let angle = match turn {
                    ArcTurn::Counterclockwise => angle,
                    ArcTurn::Clockwise => -angle,
                };
                match angle.is_above_zero() {
                    true => angle,
                    false => angle + F106::TAU,
                }
            }
        }
    }

    /// The point in the middle between two points of the edge.
    pub fn middle(&self, from: Point, to: Point) -> Point {
        match self.support {
            Support::Line { .. } => [0, 1].map(|i| F106::HALF * (from[i] + to[i])),
            Support::Circle {
                centre,
                radius,
                turn,
            } => {
                let chord = minus(to, from);
                let outwards = left(chord).map(|x| match turn {
                    ArcTurn::Counterclockwise => -x,
                    ArcTurn::Clockwise => x,
                });
                plus(centre, outwards, radius / length(outwards))
            }
        }
    }

    /// The unit direction of the edge at a point of it.
    pub fn tangent(&self, p: Point) -> Point {
        match self.support {
            Support::Line { direction } => direction,
            Support::Circle {
                centre,
                radius,
                turn,
            } => {
                let ahead = left(minus(p, centre)).map(|x| x / radius);
                match turn {
                    ArcTurn::Counterclockwise => ahead,
                    ArcTurn::Clockwise => ahead.map(|x| -x),
                }
            }
        }
    }

    /// The curvature, positive to the left.
    pub fn curvature(&self) -> F106 {
        match self.support {
            Support::Line { .. } => F106::ZERO,
            Support::Circle { radius, turn, .. } => match turn {
                ArcTurn::Counterclockwise => F106::ONE / radius,
                ArcTurn::Clockwise => -F106::ONE / radius,
            },
        }
    }

    /// Its distance from a point.
    pub fn distance(&self, p: Point) -> F106 {
        let at = self.parameter(p);
        let is_over = !at.is_below_zero() && !at.is_beyond(self.sweep());
        let to_ends = length(minus(p, self.start)).min(length(minus(p, self.end)));
        match (self.support, is_over) {
            (_, false) => to_ends,
            (Support::Line { direction }, true) => cross(direction, minus(p, self.start)).abs(),
            (Support::Circle { centre, radius, .. }, true) => {
                (length(minus(p, centre)) - radius).abs()
            }
        }
    }

    /// Its share of the winding number about a point: that of the chord, and that of the segment
    /// between the chord and the arc.
    pub fn winding(&self, p: Point) -> i32 {
        let side = cross(minus(self.end, self.start), minus(p, self.start));
        let is_above = |q: Point| q[1].is_beyond(p[1]);
        let chord = match (is_above(self.start), is_above(self.end)) {
            (false, true) if side.is_above_zero() => 1,
            (true, false) if !side.is_above_zero() => -1,
            _ => 0,
        };
        let Support::Circle {
            centre,
            radius,
            turn,
        } = self.support
        else {
            return chord;
        };
        let is_within = length(minus(p, centre)).is_short_of(radius);
        match turn {
            ArcTurn::Counterclockwise if is_within && !side.is_above_zero() => chord + 1,
            ArcTurn::Clockwise if is_within && side.is_above_zero() => chord - 1,
            _ => chord,
        }
    }

    /// The common points of the supports of two edges. Supports that come closer than the tolerance
    /// without crossing touch in a point.
    pub fn common(&self, other: &Self, tolerance: F106) -> Common {
        match (self.support, other.support) {
            (Support::Line { direction }, Support::Line { direction: across }) => {
                let away = [other.start, other.end].map(|p| cross(direction, minus(p, self.start)));
                let back = [self.start, self.end].map(|p| cross(across, minus(p, other.start)));
                let is_on = |x: &F106| x.is_within(tolerance);
                if away.iter().all(is_on) && back.iter().all(is_on) {
                    return Common::All;
                }
                let [from, to] = away;
                if (from - to).abs().is_at_most(F106::ZERO) {
                    return Common::Points(Vec::new());
                }
                let along = minus(other.end, other.start);
                Common::Points(vec![plus(other.start, along, from / (from - to))])
            }
            (Support::Circle { centre, radius, .. }, Support::Line { direction }) => {
                on_line(centre, radius, other.start, direction, tolerance)
            }
            (Support::Line { .. }, Support::Circle { .. }) => other.common(self, tolerance),
            (
                Support::Circle { centre, radius, .. },
                Support::Circle {
                    centre: other,
                    radius: size,
                    ..
                },
            ) => on_circle(centre, radius, other, size, tolerance),
        }
    }
}

fn on_line(c: Point, r: F106, through: Point, u: Point, tolerance: F106) -> Common {
    let away = minus(c, through);
    let (along, across) = (dot(away, u), cross(u, away));
    let foot = plus(through, u, along);
    let gap = across.abs() - r;
    Common::Points(if gap.is_within(tolerance) {
        vec![foot]
    } else if gap.is_above_zero() {
        Vec::new()
    } else {
        let half = (r * r - across * across).sqrt();
        vec![plus(foot, u, -half), plus(foot, u, half)]
    })
}

fn on_circle(c: Point, r: F106, d: Point, s: F106, tolerance: F106) -> Common {
    let between = minus(d, c);
    let away = length(between);
    if (away + (r - s).abs()).is_at_most(tolerance) {
        return Common::All;
    }
    let least = (r - s).abs();
    if away.is_at_most(F106::ZERO) {
        return Common::Points(Vec::new());
    }
    let u = between.map(|x| x / away);
    let outside = away - (r + s);
    let inside = least - away;
    Common::Points(if outside.is_within(tolerance) {
        vec![plus(c, u, r)]
    } else if inside.is_within(tolerance) {
        // The smaller circle touches the larger one from the inside.
        let by = if r.is_beyond(s) { r } else { -r };
        vec![plus(c, u, by)]
    } else if outside.is_above_zero() || inside.is_above_zero() {
        Vec::new()
    } else {
        let along = (away * away + r * r - s * s) / (F106::TWO * away);
        let half = (r * r - along * along).sqrt();
        let foot = plus(c, u, along);
        vec![plus(foot, left(u), half), plus(foot, left(u), -half)]
    })
}
