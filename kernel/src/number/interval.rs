//! Closed intervals of doubles, rounded outwards: the first filter of every sign.

use super::scalar::{Scalar, sinc_jet};
use std::f64::consts::{PI, TAU};
use std::ops::{Add, Mul, Neg, Sub};

/// A closed interval that holds the exact value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lower end.
    pub lo: f64,
    /// The upper end.
    pub hi: f64,
}

/// A double below what was rounded to `x`: by one or two units in the last place, which costs less
/// than the next one. A sum that is rounded to zero is zero; products see to it themselves.
fn down(x: f64) -> f64 {
    if x == 0.0 {
        return 0.0;
    }
    let x = if x > f64::MAX { f64::MAX } else { x };
    x - (x.abs() * f64::EPSILON + f64::MIN_POSITIVE)
}

/// A double above what was rounded to `x`.
fn up(x: f64) -> f64 {
    -down(-x)
}

/// The lesser of two numbers.
fn least(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The greater of two numbers.
fn greatest(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

impl Interval {
    /// The whole line.
    pub const ENTIRE: Interval = Interval {
        lo: f64::NEG_INFINITY,
        hi: f64::INFINITY,
    };

    /// The interval from `lo` to `hi`, given in either order.
    pub fn new(lo: f64, hi: f64) -> Self {
        if lo <= hi {
            Self { lo, hi }
        } else {
            Self { lo: hi, hi: lo }
        }
    }

    /// The single double `x`.
    pub fn point(x: f64) -> Self {
        Self { lo: x, hi: x }
    }

    /// The interval `centre ± radius`, rounded outwards.
    pub fn around(centre: f64, radius: f64) -> Self {
        Self {
            lo: down(centre - radius),
            hi: up(centre + radius),
        }
    }

    /// A double inside.
    pub fn mid(self) -> f64 {
        let m = 0.5 * (self.lo + self.hi);
        if m.is_finite() { m } else { 0.0 }
    }

    /// The length.
    pub fn width(self) -> f64 {
        self.hi - self.lo
    }

    /// Whether zero may be the value.
    pub fn has_zero(self) -> bool {
        !(self.lo > 0.0 || self.hi < 0.0)
    }

    /// The greatest absolute value.
    pub fn magnitude(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    /// What both intervals hold; they are known to share the exact value.
    pub fn meet(self, other: Self) -> Self {
        let lo = self.lo.max(other.lo);
        let hi = self.hi.min(other.hi);
        if lo <= hi { Self { lo, hi } } else { self }
    }

    /// The smallest interval that holds both.
    pub fn hull(self, other: Self) -> Self {
        Self {
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
        }
    }

    /// Whether the two share a point.
    pub fn meets(self, other: Self) -> bool {
        self.lo <= other.hi && other.lo <= self.hi
    }

    /// Where an end is zero, though no factor is: made wide enough for what was lost.
    fn after_product(self, x: Self, y: Self) -> Self {
        let ends = |i: Self| [i.lo, i.hi];
        let lost = |a: f64| {
            ends(y)
                .iter()
                .any(|&b| a != 0.0 && b != 0.0 && a * b == 0.0)
        };
        if (self.lo == 0.0 || self.hi == 0.0) && ends(x).into_iter().any(lost) {
            return Self {
                lo: self.lo - f64::MIN_POSITIVE,
                hi: self.hi + f64::MIN_POSITIVE,
            };
        }
        self
    }

    fn clamp_unit(self) -> Self {
        Self {
            lo: self.lo.max(-1.0),
            hi: self.hi.min(1.0),
        }
    }

    fn cos(self) -> Self {
        if self.width() >= TAU || self.width().is_nan() {
            return Self { lo: -1.0, hi: 1.0 };
        }
        // Turns are counted with a slack that only ever widens the answer.
        let slack = f64::EPSILON * (self.magnitude() + TAU);
        let holds = |offset: f64| {
            let k = ((self.lo - slack - offset) / TAU).ceil();
            k * TAU + offset <= self.hi + slack
        };
        let (a, b) = (self.lo.cos(), self.hi.cos());
        let hi = if holds(0.0) { 1.0 } else { up(up(a.max(b))) };
        let lo = if holds(PI) {
            -1.0
        } else {
            down(down(a.min(b)))
        };
        Self { lo, hi }.clamp_unit()
    }

    fn sin(self) -> Self {
        let shifted = Self {
            lo: self.lo - PI / 2.0,
            hi: self.hi - PI / 2.0,
        };
        let wide = shifted.cos();
        let (a, b) = (self.lo.sin(), self.hi.sin());
        let hi = if wide.hi == 1.0 {
            1.0
        } else {
            up(up(a.max(b)))
        };
        let lo = if wide.lo == -1.0 {
            -1.0
        } else {
            down(down(a.min(b)))
        };
        Self { lo, hi }.clamp_unit()
    }

    /// sin x / x and two derivatives over the interval, for 0 <= x <= pi.
    pub(super) fn sinc_jet(self) -> [Self; 3] {
        // Bounds of the next derivative on the whole line: 0.4362, 1/3, 1/4.
        let centre = sinc_jet(self.mid());
        let radius = 0.5 * self.width();
        let slop = 8.0 * f64::EPSILON;
        [
            Self::around(centre[0], 0.4363 * radius + slop),
            Self::around(centre[1], 0.3334 * radius + slop),
            Self::around(centre[2], 0.25 * radius + slop),
        ]
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Self {
            lo: down(self.lo + o.lo),
            hi: up(self.hi + o.hi),
        }
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Self {
            lo: down(self.lo - o.hi),
            hi: up(self.hi - o.lo),
        }
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            lo: -self.hi,
            hi: -self.lo,
        }
    }
}

/// A product of ends; zero times infinity counts as zero.
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let (mut a, mut b) = (self.lo * o.lo, self.lo * o.hi);
        let (mut c, mut d) = (self.hi * o.lo, self.hi * o.hi);
        if (a + b + c + d).is_nan() {
            (a, b) = (times(self.lo, o.lo), times(self.lo, o.hi));
            (c, d) = (times(self.hi, o.lo), times(self.hi, o.hi));
        }
        Self {
            lo: down(least(least(a, b), least(c, d))),
            hi: up(greatest(greatest(a, b), greatest(c, d))),
        }
        .after_product(self, o)
    }
}

impl Scalar for Interval {
    fn constant(x: f64) -> Self {
        Self::point(x)
    }
    fn scale(self, k: f64) -> Self {
        // The axes of most frames are those of the world.
        if k == 0.0 {
            return Self::point(0.0);
        }
        if k.abs() == 1.0 {
            return if k > 0.0 { self } else { -self };
        }
        let (a, b) = if k >= 0.0 {
            (self.lo * k, self.hi * k)
        } else {
            (self.hi * k, self.lo * k)
        };
        if a == 0.0 && b == 0.0 && self.lo == 0.0 && self.hi == 0.0 {
            return self;
        }
        if a == 0.0 || b == 0.0 || (a + b).is_nan() {
            return self * Self::point(k);
        }
        Self {
            lo: down(a),
            hi: up(b),
        }
    }
    fn square(self) -> Self {
        let (a, b) = (self.lo * self.lo, self.hi * self.hi);
        let lo = if self.has_zero() { 0.0 } else { down(a.min(b)) };
        Self {
            lo,
            hi: up(a.max(b)),
        }
        .after_product(self, self)
    }
    fn over(self, o: Self) -> Self {
        if o.has_zero() {
            return Self::ENTIRE;
        }
        self * Self {
            lo: down(1.0 / o.hi),
            hi: up(1.0 / o.lo),
        }
    }
    fn sqrt(self) -> Self {
        Self {
            lo: down(self.lo.max(0.0).sqrt()).max(0.0),
            hi: up(self.hi.max(0.0).sqrt()),
        }
    }
    fn sin_cos(self) -> (Self, Self) {
        (self.sin(), self.cos())
    }
    fn sinh_cosh(self) -> (Self, Self) {
        let slop = |x: f64| 4.0 * f64::EPSILON * x.abs();
        let (sl, sh) = (self.lo.sinh(), self.hi.sinh());
        let sinh = Self {
            lo: down(sl - slop(sl)),
            hi: up(sh + slop(sh)),
        };
        let (cl, ch) = (self.lo.cosh(), self.hi.cosh());
        let top = cl.max(ch);
        let low = if self.has_zero() {
            1.0
        } else {
            down(cl.min(ch) - slop(cl)).max(1.0)
        };
        (
            sinh,
            Self {
                lo: low,
                hi: up(top + slop(top)),
            },
        )
    }
    fn sinc(self) -> Self {
        self.sinc_jet()[0]
    }
    fn is_like(self, o: Self) -> bool {
        (self * o).lo > 0.0
    }
}
