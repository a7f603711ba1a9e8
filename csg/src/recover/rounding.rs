//! The rounding of a description's coordinates, known from the digits that they carry.
//!
//! Where a program rounded all coordinates, most of them carry the full number of digits, and the
//! last digits are random. Where a person wrote them, most are short, also if one of them is
//! 1.0000001.

use premio_kernel::number::rational::{Rational, to_f64};
use std::fmt;

/// The rounding of coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rounding {
    /// All have at most this number of digits after the point.
    Decimals(u32),
    /// All have at most six significant digits, as OpenSCAD writes them, and this number of digits
    /// after the point: they may have been rounded twice.
    SixDigits(u32),
}

impl fmt::Display for Rounding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Decimals(digits) => write!(f, "{digits} decimals"),
            Self::SixDigits(_) => f.write_str("6 significant digits"),
        }
    }
}

/// The numbers of decimals that are taken for a program's rounding. With more of them coordinates
/// differ by less than the resolution.
const DECIMALS: std::ops::RangeInclusive<u32> = 4..=10;
/// The least number of coordinates with random last digits.
const MIN_RANDOM: usize = 6;
/// Of the coordinates other than zero, the least share with random last digits: 7 of 10. Of rounded
/// ones 96 of 100 have.
const SHARE: [usize; 2] = [7, 10];
/// The last digits that are looked at, as a power of ten, and how far from zeros they must be to
/// count as random.
const LAST: i128 = 1000;
const NEAR_ZEROS: i128 = 20;

impl Rounding {
    /// The rounding of coordinates, if a program rounded them.
    pub fn new<'a>(coordinates: impl Iterator<Item = &'a Rational>) -> Option<Self> {
        let all: Vec<&Rational> = coordinates.filter(|x| !x.is_zero()).collect();
        let decimals: Option<Vec<u32>> = all.iter().map(|x| decimals(x)).collect();
        let most = decimals?.into_iter().max()?;
        if !DECIMALS.contains(&most) {
            return None;
        }
        // A number of the largest magnitude has no digit beyond the sixth by chance only.
        let rounding = match all.iter().all(|x| in_units(x, 5 - magnitude(x)).is_some()) {
            true => Self::SixDigits(most),
            false => Self::Decimals(most),
        };
        let count = all.iter().filter(|x| rounding.has_random_digits(x)).count();
        let enough = count >= MIN_RANDOM && SHARE[1] * count >= SHARE[0] * all.len();
        enough.then_some(rounding)
    }

    /// The largest difference of the entries of a rotation matrix from those that were meant:
    /// angles are decimals, and six digits of a matrix are not.
    pub(super) fn rotation_error(self) -> f64 {
        match self {
            Self::Decimals(_) => 0.0,
            Self::SixDigits(_) => 0.5 * 10f64.powi(-6),
        }
    }

    /// The largest difference of a written coordinate from the one that was meant.
    pub fn error(self, x: &Rational) -> f64 {
        0.5 * 10f64.powi(-self.digits(x))
    }

    /// The number of digits after the point to which a number is rounded, negative before it.
    fn digits(self, x: &Rational) -> i32 {
        let fixed = |digits: u32| i32::try_from(digits).unwrap_or(i32::MAX);
        match self {
            Self::Decimals(digits) => fixed(digits),
            Self::SixDigits(digits) => fixed(digits).min(5 - magnitude(x)),
        }
    }

    /// Whether the last three of all digits are random: not zeros but for a small deviation.
    fn has_random_digits(self, x: &Rational) -> bool {
        let Some(units) = in_units(x, self.digits(x)) else {
            return false;
        };
        let last = units.rem_euclid(LAST);
        (NEAR_ZEROS + 1..LAST - NEAR_ZEROS).contains(&last)
    }
}

/// The number of digits after the point of a decimal; `None` if there are more than a program's
/// rounding leaves.
fn decimals(x: &Rational) -> Option<u32> {
    let denominator = u64::try_from(x.denominator()).ok()?;
    (0..=*DECIMALS.end()).find(|digits| 10u64.pow(*digits) % denominator == 0)
}

/// A number in units of its last digit; `None` if there are further digits.
fn in_units(x: &Rational, digits: i32) -> Option<i128> {
    let numerator = i128::try_from(x.numerator()).ok()?;
    let denominator = i128::try_from(x.denominator()).ok()?;
    let power = 10i128.checked_pow(digits.unsigned_abs())?;
    let (above, below) = match digits >= 0 {
        true => (numerator.checked_mul(power)?, denominator),
        false => (numerator, denominator.checked_mul(power)?),
    };
    (above % below == 0).then_some(above / below)
}

/// The exponent of the first significant digit.
fn magnitude(x: &Rational) -> i32 {
    let x = to_f64(x);
    match x == 0.0 || !x.is_finite() {
        true => 0,
        false => x.abs().log10().floor() as i32,
    }
}
