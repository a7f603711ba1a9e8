//! Closed floating-point intervals, rounded outwards: the first filter of every predicate.

use super::analytic::{harmonic_slope, sinc_jet};
use super::float::{Analytic, Float, harmonic};
use std::ops::{Add, Mul, Neg, Sub};

/// A closed interval that contains the exact value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<N = f64> {
    /// The lower end.
    pub lo: N,
    /// The upper end.
    pub hi: N,
}

/// A number below `x`, the rounded result of an operation. It is one or two units in the last place
/// lower, which costs less than finding the next one. A sum that rounds to zero is exactly zero;
/// products handle their own underflow.
fn down<N: Float>(x: N) -> N {
    if x == N::ZERO {
        return N::ZERO;
    }
    let x = if x > N::MAX { N::MAX } else { x };
    x - (x.abs() * N::EPSILON + N::MIN_POSITIVE)
}

/// A number above `x`, the rounded result of an operation.
fn up<N: Float>(x: N) -> N {
    -down(-x)
}

/// The smaller of two numbers.
fn least<N: Float>(a: N, b: N) -> N {
    if a < b { a } else { b }
}

/// The larger of two numbers.
fn greatest<N: Float>(a: N, b: N) -> N {
    if a > b { a } else { b }
}

impl<N: Float> Interval<N> {
    /// The entire line.
    pub const ENTIRE: Self = Self {
        lo: N::NEG_INFINITY,
        hi: N::INFINITY,
    };

    /// The interval from `lo` to `hi`, given in either order.
    pub fn new(lo: N, hi: N) -> Self {
        if lo <= hi {
            Self { lo, hi }
        } else {
            Self { lo: hi, hi: lo }
        }
    }

    /// The interval that contains `x` only.
    pub fn point(x: N) -> Self {
        Self { lo: x, hi: x }
    }

    /// The interval `centre ± radius`, rounded outwards.
    pub fn around(centre: N, radius: N) -> Self {
        Self {
            lo: down(centre - radius),
            hi: up(centre + radius),
        }
    }

    /// A number inside, close to the midpoint.
    pub fn mid(self) -> N {
        let m = N::HALF * (self.lo + self.hi);
        if m.is_finite() { m } else { N::ZERO }
    }

    /// The length.
    pub fn width(self) -> N {
        self.hi - self.lo
    }

    /// Whether it contains zero.
    pub fn has_zero(self) -> bool {
        !(self.lo > N::ZERO || self.hi < N::ZERO)
    }

    /// Whether the value is certainly greater than zero.
    pub fn is_above_zero(self) -> bool {
        self.lo > N::ZERO
    }

    /// The greatest absolute value in it.
    pub fn magnitude(self) -> N {
        self.lo.abs().max(self.hi.abs())
    }

    /// The intersection. Both intervals must contain the exact value.
    pub fn intersection(self, other: Self) -> Self {
        let lo = self.lo.max(other.lo);
        let hi = self.hi.min(other.hi);
        if lo <= hi { Self { lo, hi } } else { self }
    }

    /// Widens an end that underflowed to zero although no factor is zero.
    fn after_product(self, x: Self, y: Self) -> Self {
        let ends = |i: Self| [i.lo, i.hi];
        let lost = |a: N| {
            ends(y)
                .iter()
                .any(|&b| a != N::ZERO && b != N::ZERO && a * b == N::ZERO)
        };
        if (self.lo == N::ZERO || self.hi == N::ZERO) && ends(x).into_iter().any(lost) {
            return Self {
                lo: self.lo - N::MIN_POSITIVE,
                hi: self.hi + N::MIN_POSITIVE,
            };
        }
        self
    }

    /// The enclosing f64 interval.
    pub(crate) fn to_f64(self) -> Interval {
        Interval {
            lo: self.lo.below(),
            hi: self.hi.above(),
        }
    }

    fn clamp_unit(self) -> Self {
        Self {
            lo: self.lo.max(-N::ONE),
            hi: self.hi.min(N::ONE),
        }
    }

    /// Sine and cosine: from their values at the ends, and from the extrema inside.
    fn waves(self) -> [Self; 2] {
        if self.width() >= N::TAU || self.width().is_nan() {
            return [Self {
                lo: -N::ONE,
                hi: N::ONE,
            }; 2];
        }
        // The number of turns is computed with a slack that can only widen the result.
        let slack = N::EPSILON * (self.magnitude() + N::TAU);
        let holds = |offset: N| {
            let k = ((self.lo - slack - offset) / N::TAU).ceil();
            k * N::TAU + offset <= self.hi + slack
        };
        let between = |a: N, b: N, top: N, bottom: N| {
            let hi = if holds(top) { N::ONE } else { up(up(a.max(b))) };
            let lo = if holds(bottom) {
                -N::ONE
            } else {
                down(down(a.min(b)))
            };
            Self { lo, hi }.clamp_unit()
        };
        let (lo, quarter) = (self.lo.sin_cos(), N::PI / N::TWO);
        let hi = if self.lo == self.hi {
            lo
        } else {
            self.hi.sin_cos()
        };
        [
            between(lo.0, hi.0, quarter, -quarter),
            between(lo.1, hi.1, N::ZERO, N::PI),
        ]
    }

    /// sin x / x and two derivatives over the interval, for 0 <= x <= pi.
    pub(super) fn sinc_jet(self) -> [Self; 3] {
        if let Some(jet) = self.coarsely(Interval::sinc_jet) {
            return jet;
        }
        // Bounds, on the entire line, of the derivative of each function: 0.4362, 1/3, 1/4.
        let centre = sinc_jet(self.mid());
        let radius = N::HALF * self.width();
        let slop = N::from_f64(8.0) * N::EPSILON;
        [
            Self::around(centre[0], N::from_f64(0.4363) * radius + slop),
            Self::around(centre[1], N::from_f64(0.3334) * radius + slop),
            Self::around(centre[2], N::from_f64(0.25) * radius + slop),
        ]
    }
}

impl<N: Float> Add for Interval<N> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        if let Some(sum) = self.coarse_sum(o, |x, y| x + y) {
            return sum;
        }
        Self {
            lo: down(self.lo + o.lo),
            hi: up(self.hi + o.hi),
        }
    }
}

impl<N: Float> Sub for Interval<N> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        if let Some(difference) = self.coarse_sum(o, |x, y| x - y) {
            return difference;
        }
        Self {
            lo: down(self.lo - o.hi),
            hi: up(self.hi - o.lo),
        }
    }
}

impl<N: Float> Neg for Interval<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            lo: -self.hi,
            hi: -self.lo,
        }
    }
}

/// A product of interval ends; zero times infinity is zero.
fn times<N: Float>(a: N, b: N) -> N {
    if a == N::ZERO || b == N::ZERO {
        N::ZERO
    } else {
        a * b
    }
}

impl<N: Float> Mul for Interval<N> {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        if let Some(product) = self.coarse_product(o, |x, y| x * y) {
            return product;
        }
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

impl<N: Float> Analytic for Interval<N> {
    type Float = N;
    fn constant(x: N) -> Self {
        Self::point(x)
    }
    fn scale(self, k: N) -> Self {
        // Most frames have the axes of the world, so zero is common.
        if k == N::ZERO {
            return Self::point(N::ZERO);
        }
        if k.abs() == N::ONE {
            return if k > N::ZERO { self } else { -self };
        }
        if let Some(product) = self.coarse_product(Self::point(k), |x, y| x * y) {
            return product;
        }
        let (a, b) = if k >= N::ZERO {
            (self.lo * k, self.hi * k)
        } else {
            (self.hi * k, self.lo * k)
        };
        if a == N::ZERO && b == N::ZERO && self.lo == N::ZERO && self.hi == N::ZERO {
            return self;
        }
        if a == N::ZERO || b == N::ZERO || (a + b).is_nan() {
            return self * Self::point(k);
        }
        Self {
            lo: down(a),
            hi: up(b),
        }
    }
    fn square(self) -> Self {
        if let Some(square) = self.coarse_product(self, |x, _| x.square()) {
            return square;
        }
        let (a, b) = (self.lo * self.lo, self.hi * self.hi);
        let lo = if self.has_zero() {
            N::ZERO
        } else {
            down(a.min(b))
        };
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
        if let Some(quotient) = self.coarse_product(o, |x, y| x.over(y)) {
            return quotient;
        }
        self * Self {
            lo: down(N::ONE / o.hi),
            hi: up(N::ONE / o.lo),
        }
    }
    fn root(self) -> Self {
        if let Some(root) = self.coarse_product(self, |x, _| x.root()) {
            return root;
        }
        Self {
            lo: down(self.lo.max(N::ZERO).sqrt()).max(N::ZERO),
            hi: up(self.hi.max(N::ZERO).sqrt()),
        }
    }
    fn known_within(self, [lo, hi]: [N; 2]) -> Self {
        self.intersection(Self { lo, hi })
    }
    fn sin_cos(self) -> (Self, Self) {
        if let Some([sin, cos]) = self.coarsely(Interval::waves) {
            return (sin, cos);
        }
        let [sin, cos] = self.waves();
        (sin, cos)
    }
    fn sinh_cosh(self) -> (Self, Self) {
        if let Some([sinh, cosh]) = self.coarsely(|x| x.sinh_cosh().into()) {
            return (sinh, cosh);
        }
        let slop = |x: N| N::ROUNDING * x.abs();
        let ((sl, cl), (sh, ch)) = (self.lo.sinh_cosh(), self.hi.sinh_cosh());
        let sinh = Self {
            lo: down(sl - slop(sl)),
            hi: up(sh + slop(sh)),
        };
        let top = cl.max(ch);
        let low = if self.has_zero() {
            N::ONE
        } else {
            down(cl.min(ch) - slop(cl)).max(N::ONE)
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
    fn harmonic(self, k: &[N; 5], at: (Self, Self)) -> Self {
        let direct = harmonic(k, at);
        if N::TWO * direct.mid().abs() > direct.width() {
            return direct;
        }
        // The mean value form.
        let middle = Self::point(self.mid());
        let slope = harmonic(&harmonic_slope(k), at);
        direct.intersection(harmonic(k, middle.sin_cos()) + slope * (self - middle))
    }
    fn is_like(self, o: Self) -> bool {
        (self * o).lo > N::ZERO
    }
    fn representative(self) -> N {
        self.mid()
    }
}
