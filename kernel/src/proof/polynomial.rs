//! Polynomials in x, y and z with integer coefficients, which represent surfaces without rounding.

use crate::geometry::surface::Surface;
use crate::geometry::surface_pair::{Coefficients, ConjugateAxes};
use crate::number::float::Float;
use crate::number::rational::Rational;
use dashu::base::{BitTest, Gcd};
use dashu::integer::{IBig, UBig};
use std::collections::BTreeMap;

/// The exponents of x, y and z.
pub(super) type Exponents = [u8; 3];

/// A polynomial in x, y and z; without terms it is zero.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Polynomial {
    terms: BTreeMap<Exponents, IBig>,
}

/// Three polynomials, the components of a vector.
type Vector = [Polynomial; 3];

impl Polynomial {
    fn constant(value: IBig) -> Self {
        let mut all = Self::default();
        all.add_term([0; 3], value);
        all
    }

    /// The terms by their exponents.
    pub(super) fn terms(&self) -> impl Iterator<Item = (&Exponents, &IBig)> {
        self.terms.iter()
    }

    /// The degree; that of zero is 0.
    pub fn degree(&self) -> u32 {
        let of = |e: &Exponents| e.iter().map(|&n| u32::from(n)).sum();
        self.terms.keys().map(of).max().unwrap_or(0)
    }

    /// log₂ of the greatest coefficient, rounded up.
    pub fn height(&self) -> usize {
        let bits = self.terms.values().map(BitTest::bit_len);
        bits.max().unwrap_or(0)
    }

    /// log₂ of the sum of all coefficients' absolute values, rounded up.
    pub(super) fn length(&self) -> usize {
        let count = self.terms.len().max(1);
        self.height() + count.next_power_of_two().bit_len() - 1
    }

    fn add_term(&mut self, exponents: Exponents, value: IBig) {
        let known = self.terms.entry(exponents).or_default();
        *known += value;
        if known.is_zero() {
            self.terms.remove(&exponents);
        }
    }

    fn plus(&self, o: &Self) -> Self {
        let mut sum = self.clone();
        for (e, c) in &o.terms {
            sum.add_term(*e, c.clone());
        }
        sum
    }

    fn minus(&self, o: &Self) -> Self {
        self.plus(&o.scaled(&-IBig::ONE))
    }

    fn times(&self, o: &Self) -> Self {
        let mut product = Self::default();
        for (a, c) in &self.terms {
            for (b, d) in &o.terms {
                product.add_term([0, 1, 2].map(|i| a[i] + b[i]), c * d);
            }
        }
        product
    }

    fn scaled(&self, by: &IBig) -> Self {
        let mut all = Self::default();
        for (e, c) in &self.terms {
            all.add_term(*e, c * by);
        }
        all
    }

    /// The same polynomial divided by the common factor of its coefficients.
    fn reduced(&self) -> Self {
        let common = |known: UBig, c: &IBig| {
            let size = UBig::try_from(if *c < IBig::ZERO { -c } else { c.clone() });
            known.gcd(size.unwrap_or(UBig::ONE))
        };
        let Some(first) = self.terms.values().next() else {
            return Self::default();
        };
        let start = common(UBig::ZERO, first);
        let factor = IBig::from(self.terms.values().fold(start, common));
        let terms = self.terms.iter().map(|(e, c)| (*e, c / &factor));
        Self {
            terms: terms.collect(),
        }
    }

    /// The derivative along an axis.
    pub(super) fn derivative(&self, axis: usize) -> Self {
        let mut all = Self::default();
        for (e, c) in &self.terms {
            if e[axis] > 0 {
                let mut lower = *e;
                lower[axis] -= 1;
                all.add_term(lower, c * IBig::from(e[axis]));
            }
        }
        all
    }

    /// The derivatives along the three axes.
    pub fn gradient(&self) -> Vector {
        [0, 1, 2].map(|axis| self.derivative(axis))
    }

    /// The components of the cross product of two gradients, which is zero where the surfaces are
    /// tangent.
    pub fn touching(&self, o: &Self) -> Vector {
        cross(&self.gradient(), &o.gradient()).map(|p| p.reduced())
    }

    /// The determinant of three gradients, which is zero where the curve of two surfaces is tangent
    /// to the third.
    pub fn dependence(&self, o: &Self, third: &Self) -> Self {
        dot(&cross(&self.gradient(), &o.gradient()), &third.gradient()).reduced()
    }

    /// The plane through a point, perpendicular to a direction.
    pub fn plane(point: &[Rational; 3], direction: &[Rational; 3]) -> Self {
        let away = away(point).components;
        dot(&whole_vector(direction), &away).reduced()
    }

    /// The polynomial of a surface; that of a cone has both nappes.
    pub fn new<N: Float>(kind: &Surface<N>, exact: &Coefficients<Rational>) -> Self {
        if let Some(axes) = &exact.axes {
            return Self::elliptic(&exact.point, axes, kind);
        }
        let IntegralOffset {
            components: v,
            factor: q,
        } = away(&exact.point);
        let d = whole_vector(&exact.direction);
        let square = |p: &Self| p.times(p);
        let (vv, dd) = (dot(&v, &v), dot(&d, &d));
        let up = dot(&d, &v);
        let [a, b] = parts(&exact.size);
        let across = dd.times(&vv).minus(&square(&up));
        let all = match kind {
            Surface::Plane(_) => up,
            Surface::Sphere(_) | Surface::Ellipsoid(_) => vv
                .scaled(&(&b * &b))
                .minus(&Self::constant(&a * &a * &q * &q)),
            Surface::Cylinder(_) | Surface::EllipticCylinder(_) => across
                .scaled(&(&b * &b))
                .minus(&dd.scaled(&(&a * &a * &q * &q))),
            Surface::Cone(_) | Surface::EllipticCone(_) => {
                let along = square(&up).scaled(&(&a * &a + &b * &b));
                along.minus(&dd.times(&vv).scaled(&(&b * &b)))
            }
            Surface::Torus(_) => {
                let [c, e] = parts(&exact.tube);
                // Both radii over a common denominator.
                let (major, minor, m) = (&a * &e, &c * &b, &b * &e);
                let squares = (&major * &major - &minor * &minor) * &q * &q;
                let sum = vv.scaled(&(&m * &m)).plus(&Self::constant(squares));
                let round = across.scaled(&(IBig::from(4) * &major * &major * &q * &q * &m * &m));
                dd.times(&square(&sum)).minus(&round)
            }
        };
        all.reduced()
    }

    /// The polynomial of an elliptic surface with a point and conjugate axes x, y and z:
    /// (y × z · v)² + (z × x · v)², less (x × y · v)² for a cone, or the square of the volume for a
    /// cylinder; for an ellipsoid the sum of all three, less the square of the volume.
    fn elliptic<N: Float>(
        point: &[Rational; 3],
        axes: &ConjugateAxes<Rational>,
        kind: &Surface<N>,
    ) -> Self {
        let IntegralOffset {
            components: v,
            factor: q,
        } = away(point);
        let flat: [Rational; 9] = std::array::from_fn(|i| axes[i / 3][i % 3].clone());
        let all = least_multiple(&flat);
        let scaled = |axis: &[Rational; 3]| {
            let whole = |c: &Rational| c.numerator() * (&all / IBig::from(c.denominator().clone()));
            axis.each_ref().map(|c| Self::constant(whole(c)))
        };
        let [x, y, z] = axes.each_ref().map(scaled);
        let normals = [cross(&y, &z), cross(&z, &x), cross(&x, &y)];
        let volume = dot(&x, &normals[0]).scaled(&q);
        let [a, b, c] = normals.each_ref().map(|n| dot(n, &v));
        let square = |p: &Self| p.times(p);
        let across = square(&a).plus(&square(&b));
        // The columns have the common denominator in all components: v is divided by it as well.
        let less_volume = |form: Self| form.scaled(&(&all * &all)).minus(&square(&volume));
        let whole = match kind {
            Surface::EllipticCone(_) => across.minus(&square(&c)),
            Surface::Ellipsoid(_) => less_volume(across.plus(&square(&c))),
            _ => less_volume(across),
        };
        whole.reduced()
    }
}

/// The least common multiple of the denominators.
fn least_multiple(numbers: &[Rational]) -> IBig {
    let least = |a: UBig, b: UBig| {
        let common = (&a).gcd(&b);
        a / common * b
    };
    let all = numbers.iter().map(|x| x.denominator().clone());
    IBig::from(all.fold(UBig::ONE, least))
}

/// The numerator and the denominator.
fn parts(x: &Rational) -> [IBig; 2] {
    [x.numerator().clone(), IBig::from(x.denominator().clone())]
}

/// Three numbers times a factor that makes them integers.
struct IntegralMultiple {
    numbers: [IBig; 3],
    factor: IBig,
}

/// Three numbers times the smallest factor that makes them integers.
fn whole(numbers: &[Rational; 3]) -> IntegralMultiple {
    let all = least_multiple(numbers);
    let times = |x: &Rational| x.numerator() * (&all / IBig::from(x.denominator().clone()));
    IntegralMultiple {
        numbers: numbers.each_ref().map(times),
        factor: all,
    }
}

fn whole_vector(direction: &[Rational; 3]) -> Vector {
    whole(direction).numbers.map(Polynomial::constant)
}

/// q (x - p) with integers q and q p.
struct IntegralOffset {
    components: Vector,
    /// q.
    factor: IBig,
}

/// q (x - p) with the smallest q that makes it integral.
fn away(point: &[Rational; 3]) -> IntegralOffset {
    let IntegralMultiple {
        numbers: p,
        factor: q,
    } = whole(point);
    let component = |axis: usize| {
        let mut all = Polynomial::constant(-p[axis].clone());
        let mut exponents = [0; 3];
        exponents[axis] = 1;
        all.add_term(exponents, q.clone());
        all
    };
    IntegralOffset {
        components: [0, 1, 2].map(component),
        factor: q,
    }
}

fn dot(a: &Vector, b: &Vector) -> Polynomial {
    let [x, y, z] = [0, 1, 2].map(|i| a[i].times(&b[i]));
    x.plus(&y).plus(&z)
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i].times(&b[j]).minus(&a[j].times(&b[i])))
}
