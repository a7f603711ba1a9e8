//! The rounding of a description's coordinates, known from the digits that they carry.
//!
//! Where a program rounded all coordinates, most of them carry the full number of digits, and the
//! last digits are random. Where a person wrote them, most are short, also if one of them is
//! 1.0000001.

use premio_kernel::number::rational::{Rational, to_decimal, to_f64};
use std::fmt;

/// The rounding of coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rounding {
    /// All have at most this number of digits after the point.
    Decimals(u32),
    /// All have at most six significant digits, as OpenSCAD writes them.
    SixDigits,
}

impl fmt::Display for Rounding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Decimals(digits) => write!(f, "{digits} decimals"),
            Self::SixDigits => f.write_str("6 significant digits"),
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
        let decimals: Vec<u32> = all.iter().filter_map(|x| decimals(x)).collect();
        let most = decimals.iter().copied().max()?;
        if decimals.len() < all.len() || !DECIMALS.contains(&most) {
            return None;
        }
        let random = |rounding: Self| {
            let random = |x: &&&Rational| rounding.has_random_digits(x);
            all.iter().filter(random).count()
        };
        let candidates = [Self::Decimals(most), Self::SixDigits].map(|r| (random(r), r));
        let [(fixed, _), (relative, _)] = candidates;
        let (count, rounding) = candidates[usize::from(relative > fixed)];
        let enough = count >= MIN_RANDOM && SHARE[1] * count >= SHARE[0] * all.len();
        enough.then_some(rounding)
    }

    /// The largest difference of a written coordinate from the one that was meant.
    pub fn error(self, x: &Rational) -> f64 {
        let digits = match self {
            Self::Decimals(digits) => i32::try_from(digits.max(decimals(x).unwrap_or(0))),
            Self::SixDigits => Ok(5 - magnitude(x)),
        };
        digits.map_or(0.0, |digits| 0.5 * 10f64.powi(-digits))
    }

    /// Whether the last three of all digits are random: not zeros but for a small deviation.
    fn has_random_digits(self, x: &Rational) -> bool {
        let digits = match self {
            Self::Decimals(digits) => i32::try_from(digits).unwrap_or(0),
            Self::SixDigits => 5 - magnitude(x),
        };
        let Some(units) = in_units(x, digits) else {
            return false;
        };
        let last = units.rem_euclid(LAST);
        (NEAR_ZEROS + 1..LAST - NEAR_ZEROS).contains(&last)
    }
}

/// The number of digits after the point of a finite decimal.
fn decimals(x: &Rational) -> Option<u32> {
    let text = to_decimal(x)?;
    let after = text.split_once('.').map_or(0, |(_, after)| after.len());
    u32::try_from(after).ok()
}

/// A number in units of its last digit; `None` if there are further digits.
fn in_units(x: &Rational, digits: i32) -> Option<i128> {
    let scaled = x * Rational::from(10u8).pow(digits as isize);
    let (numerator, denominator) = scaled.into_parts();
    denominator
        .is_one()
        .then(|| i128::try_from(numerator).ok())?
}

/// The exponent of the first significant digit.
fn magnitude(x: &Rational) -> i32 {
    let x = to_f64(x);
    match x == 0.0 || !x.is_finite() {
        true => 0,
        false => x.abs().log10().floor() as i32,
    }
}
