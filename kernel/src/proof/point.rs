//! The exact common zero of three polynomials close to a given point.
//!
//! Kantorovich's theorem (1948) proves its existence and bounds its distance; Newton's method gives
//! its digits. A separation bound determines whether a further polynomial h is zero there. Let R(s,
//! Z) be the resultant of h - Z and of the three polynomials, perturbed by s xᵈ, s yᵈ and s zᵈ. The
//! coefficient of its lowest power of s is a non-zero polynomial in Z with integer coefficients. It
//! vanishes at the value of h at every isolated zero of the three (Canny 1990, on generalised
//! characteristic polynomials). So that value is zero, or at least one over that polynomial's
//! greatest coefficient, which the heights and the degrees bound (Sombra 2004).

use super::fixed::Place;
use super::polynomial::Polynomial;
use crate::number::float::Float;
use crate::number::rational::{Rational, to_f64};
use dashu::base::{Abs, BitTest};
use dashu::integer::IBig;
use nalgebra::{Point3, Vector3};

/// Whether a polynomial is zero at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZeroTest {
    /// It is zero, which is proven.
    Zero,
    /// It is not zero, which is proven.
    Apart,
    /// A decision would take too many bits.
    Open,
}

/// An exact point: the zero of three polynomials close to a given point.
#[derive(Clone, Debug)]
pub struct AlgebraicPoint {
    base: [Form; 3],
    place: Place,
    /// log₂ of a bound of the distance of the zero from `place`.
    off: f64,
}

/// The number of bits after the binary point at the start.
pub(super) const FIRST: usize = 256;
/// The number of Newton steps from a point known to some thirty digits to all of the first bits.
const STEPS: usize = 5;
/// The largest number of bits.
const MOST: usize = 1 << 17;
/// The least sine between a gradient and the span of those before, tried in turn: from clearly to
/// barely independent.
const INDEPENDENT: [f64; 3] = [
    1.0 / (1 << 6) as f64,
    1.0 / (1 << 20) as f64,
    1.0 / (1u64 << 45) as f64,
];
/// The number of bits by which a gradient must exceed its rounding.
const CLEAR: usize = 100;
/// Guard bits of the bounds.
const SPARE: usize = 64;

/// log₂ of a number's absolute value, rounded up; for zero that of one.
fn log2(x: &IBig) -> f64 {
    x.bit_len() as f64
}

/// The determinant of a matrix of three rows.
fn determinant(m: &[[IBig; 3]; 3]) -> IBig {
    let minor = |i: usize, j: usize| &m[1][i] * &m[2][j] - &m[1][j] * &m[2][i];
    &m[0][0] * minor(1, 2) - &m[0][1] * minor(0, 2) + &m[0][2] * minor(0, 1)
}

/// A polynomial with its gradient.
#[derive(Clone, Debug)]
pub(super) struct Form {
    pub level: Polynomial,
    gradient: [Polynomial; 3],
}

impl Form {
    pub fn new(level: &Polynomial) -> Self {
        Self {
            level: level.clone(),
            gradient: level.gradient(),
        }
    }

    fn slope(&self, place: &Place) -> [IBig; 3] {
        self.gradient.each_ref().map(|d| place.value(d))
    }

    /// The direction of the gradient at a point; `None` unless the gradient exceeds its rounding by
    /// `clear` bits.
    pub fn direction(&self, place: &Place, clear: usize) -> Option<Vector3<f64>> {
        let slope = self.slope(place);
        let most = slope.iter().map(|x| x.clone().abs()).max()?;
        let rounding = self.gradient.iter().map(|d| place.rounding(d)).max()?;
        if most.bit_len() < rounding + clear {
            return None;
        }
        let part = |x: &IBig| Rational::from(x.clone()) / Rational::from(most.clone());
        let [x, y, z] = slope.each_ref().map(|x| to_f64(&part(x)));
        Some(Vector3::new(x, y, z).normalize())
    }
}

impl AlgebraicPoint {
    /// The zero, close to a point, of the first three polynomials with independent gradients.
    /// `None` unless its existence and uniqueness are proven.
    pub fn next_to<'p, N: Float>(
        polynomials: impl IntoIterator<Item = &'p Polynomial>,
        p: &Point3<N>,
    ) -> Option<Self> {
        let place = Place::new(p, FIRST)?;
        let forms = polynomials.into_iter().map(Form::new);
        let known: Vec<DirectedForm> = forms
            .filter_map(|form| {
                let direction = form.direction(&place, CLEAR)?;
                Some(DirectedForm { form, direction })
            })
            .collect();
        let base = INDEPENDENT
            .iter()
            .find_map(|&least| independent(&known, least))?;
        Self::new(base, place)
    }

    fn new(base: [Form; 3], mut place: Place) -> Option<Self> {
        for _ in 0..STEPS {
            place = stepped(&base, &place)?;
        }
        let mut point = Self {
            base,
            place,
            off: f64::INFINITY,
        };
        point.off = point.kantorovich()?;
        Some(point)
    }

    /// The vector to it from another point, to the precision of `N`.
    pub fn from<N: Float>(&self, p: &Point3<N>) -> Vector3<N> {
        let one = Rational::from(IBig::ONE << self.place.bits);
        let at = |i: usize| N::nearest(&(Rational::from(self.place.at[i].clone()) / &one));
        Vector3::new(at(0), at(1), at(2)) - p.coords
    }

    /// log₂ of a bound of the distance of the zero from `place`; `None` where the theorem does not
    /// apply.
    fn kantorovich(&self) -> Option<f64> {
        let (place, bits) = (&self.place, self.place.bits as f64);
        let slopes = self.base.each_ref().map(|form| form.slope(place));
        // log₂ of the greatest component of each gradient, rounded down.
        let sizes = slopes.each_ref().map(|slope| {
            let most = slope.iter().map(log2).fold(0.0, f64::max);
            most - 1.0 - bits
        });
        // No minor of unit vectors exceeds one, and no gradient is longer than four times its
        // rounded-down size.
        let total: f64 = sizes.iter().map(|size| size + 2.0).sum();
        let inverse = 2.0 + total + 3.0 * bits - (log2(&determinant(&slopes)) - 1.0);
        if inverse > bits / 4.0 {
            return None;
        }
        let (mut value, mut bend) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        for (Form { level, gradient }, size) in self.base.iter().zip(sizes) {
            let off = place.value(level).bit_len().max(place.rounding(level)) + 1;
            value = value.max(off as f64 - bits - size);
            // The second derivatives within one unit.
            let around = level.degree().saturating_sub(2) as usize * (place.magnitude() + 1);
            let second = gradient.iter().flat_map(|d| d.gradient());
            let second = second.map(|d| d.length()).max().unwrap_or(0);
            bend = bend.max((second + around) as f64 + 4.0 - size);
        }
        let step = inverse + value + 1.0;
        // h = β K η is less than a half, so the zero lies within twice the step.
        (step < -1.0 && inverse + bend + step < -2.0).then_some(step + 1.0)
    }

    /// The number of bits after the binary point that prove a value of h to be zero.
    fn separation(&self, h: &Polynomial) -> f64 {
        let [a, b, c] = self.base.each_ref().map(|form| &form.level);
        let all = [a, b, c, h];
        let degrees = all.map(|p| f64::from(p.degree()));
        let product: f64 = degrees.iter().product();
        let sum = |(p, d): (&&Polynomial, &f64)| {
            let terms = (d + 1.0) * (d + 2.0) * (d + 3.0) / 6.0;
            product / d * (2.0 * terms.log2() + p.height() as f64 + 1.0)
        };
        all.iter().zip(&degrees).map(sum).sum::<f64>() + 1.0
    }

    /// Whether a polynomial is one of the three that define the point.
    pub fn is_defined_by(&self, p: &Polynomial) -> bool {
        self.base.iter().any(|form| form.level == *p)
    }

    /// Whether a polynomial is zero at the point.
    pub fn is_zero_of(&mut self, h: &Polynomial) -> ZeroTest {
        if self.is_defined_by(h) {
            return ZeroTest::Zero;
        }
        if h.degree() == 0 {
            return match h.height() {
                0 => ZeroTest::Zero,
                _ => ZeroTest::Apart,
            };
        }
        let slopes = h.gradient();
        let steep = slopes.iter().map(Polynomial::length).max().unwrap_or(0) as f64 + 2.0;
        let steep = steep + (h.degree() as usize * (self.place.magnitude() + 1)) as f64;
        let bound = self.separation(h);
        loop {
            let bits = self.place.bits as f64;
            let rounding = self.place.rounding(h) as f64 - bits;
            let off = rounding.max(steep + self.off) + 1.0;
            let value = self.place.value(h);
            // A number of n bits is at least 2^(n - 1).
            if !value.is_zero() && log2(&value) - 1.0 - bits > off {
                return ZeroTest::Apart;
            }
            if off.max(log2(&value) - bits) + 1.0 < -bound {
                return ZeroTest::Zero;
            }
            let wanted = bound + steep + self.place.rounding(h) as f64;
            let wanted = wanted as usize + SPARE;
            if wanted > MOST || self.place.bits >= 2 * wanted || self.refine(wanted).is_none() {
                return ZeroTest::Open;
            }
        }
    }

    /// Computes so many bits, or more if the point is ill-conditioned.
    fn refine(&mut self, wanted: usize) -> Option<()> {
        let loss = (self.off + self.place.bits as f64).max(0.0) as usize;
        let last = wanted.max(self.place.bits + 1) + 2 * loss;
        let mut goals = vec![last];
        while let Some(&goal) = goals.last() {
            if goal <= self.place.bits + loss + SPARE {
                break;
            }
            goals.push(goal / 2 + loss + SPARE);
            if goals.len() > STEPS * STEPS {
                return None;
            }
        }
        for goal in goals.into_iter().rev() {
            let place = self.place.with_bits(goal.max(self.place.bits));
            self.place = stepped(&self.base, &place)?;
        }
        self.off = self.kantorovich()?;
        Some(())
    }
}

/// A polynomial, and the direction of its gradient at a point.
struct DirectedForm {
    form: Form,
    direction: Vector3<f64>,
}

/// The first three polynomials whose gradients are independent: the sine between each and the span
/// of those before is at least `least`.
fn independent(known: &[DirectedForm], least: f64) -> Option<[Form; 3]> {
    let mut chosen: Vec<Form> = Vec::new();
    let mut span: Vec<Vector3<f64>> = Vec::new();
    for DirectedForm { form, direction } in known {
        let rest = span.iter().fold(*direction, |d, e| d - e * e.dot(&d));
        if rest.norm() > least {
            span.push(rest.normalize());
            chosen.push(form.clone());
        }
        if chosen.len() == 3 {
            break;
        }
    }
    chosen.try_into().ok()
}

/// The Newton step from a point; `None` if the gradients are dependent.
fn stepped(base: &[Form; 3], place: &Place) -> Option<Place> {
    let values = base.each_ref().map(|form| place.value(&form.level));
    let slopes = base.each_ref().map(|form| form.slope(place));
    let divisor = determinant(&slopes);
    if divisor.is_zero() {
        return None;
    }
    let mut at = place.at.clone();
    for (axis, x) in at.iter_mut().enumerate() {
        let mut replaced = slopes.clone();
        for (row, value) in replaced.iter_mut().zip(&values) {
            row[axis] = value.clone();
        }
        *x -= (determinant(&replaced) << place.bits) / &divisor;
    }
    Some(Place {
        bits: place.bits,
        at,
    })
}
