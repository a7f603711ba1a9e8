//! The operations that all floating-point numbers of more bits than f64 have in common.

#[cfg(test)]
pub(crate) mod comparison;

/// Implements [`Analytic`](super::float::Analytic), assignments and sums for a type of numbers with
/// the four operations, a module `circular` with sines and cosines, and a method `growth` for
/// e^|x| - 1.
macro_rules! wide_float {
    ($number:ident) => {
        $crate::number::wide_float::assigning!($number: Add AddAssign add add_assign;
            Sub SubAssign sub sub_assign; Mul MulAssign mul mul_assign;
            Div DivAssign div div_assign);

        impl std::iter::Sum for $number {
            fn sum<I: Iterator<Item = Self>>(all: I) -> Self {
                all.fold(Self::ZERO, |sum, x| sum + x)
            }
        }

        impl num_traits::Zero for $number {
            fn zero() -> Self {
                Self::ZERO
            }
            fn is_zero(&self) -> bool {
                *self == Self::ZERO
            }
        }

        impl num_traits::One for $number {
            fn one() -> Self {
                Self::ONE
            }
        }

        impl Analytic for $number {
            type Float = Self;
            fn constant(x: Self) -> Self {
                x
            }
            fn scale(self, k: Self) -> Self {
                self * k
            }
            fn square(self) -> Self {
                self * self
            }
            fn over(self, divisor: Self) -> Self {
                self / divisor
            }
            fn root(self) -> Self {
                Float::max(self, Self::ZERO).sqrt()
            }
            fn known_within(self, [lo, hi]: [Self; 2]) -> Self {
                match self >= lo {
                    true => Float::min(self, hi),
                    false => lo,
                }
            }
            fn sin_cos(self) -> (Self, Self) {
                circular::sin_cos(self)
            }
            fn twice(self, (sin, cos): (Self, Self)) -> (Self, Self) {
                (Self::TWO * sin * cos, (cos - sin) * (cos + sin))
            }
            fn sinh_cosh(self) -> (Self, Self) {
                let rise = self.growth();
                let fall = match rise.is_finite() {
                    true => rise / (rise + Self::ONE),
                    false => Self::ONE,
                };
                let sinh = (Self::HALF * (rise + fall)).copysign(self);
                (sinh, Self::ONE + Self::HALF * (rise - fall))
            }
            fn sinc(self) -> Self {
                $crate::number::analytic::sinc_jet(self)[0]
            }
            fn is_like(self, o: Self) -> bool {
                self * o > Self::ZERO
            }
            fn representative(self) -> Self {
                self
            }
        }
    };
}

/// Implements the assigning operators by the others.
macro_rules! assigning {
    ($number:ident: $($operator:ident $assign:ident $name:ident $assigning:ident);*) => {
        $(
            impl std::ops::$assign for $number {
                fn $assigning(&mut self, o: Self) {
                    *self = std::ops::$operator::$name(*self, o);
                }
            }
        )*
    };
}

pub(crate) use {assigning, wide_float};
