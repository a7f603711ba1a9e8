//! Sines and angles of 237 bits: what is most often asked of these numbers.
//!
//! An angle is brought to within an eighth turn of a quarter turn, and to within 2^-10 of a place of a
//! table; what is left has a short series. An angle of a tangent is that in f64, and the rest,
//! whose sine is known.

use super::{F237, Float, SHARES, scaled};
use dashu::integer::UBig;
use std::sync::LazyLock;

/// Places of the table, from one to the next.
const STEP: f64 = 1.0 / 512.0;

/// How many places there are up to an eighth turn.
const PLACES: usize = 403;

/// The sines and cosines of the places.
static TABLE: LazyLock<[(F237, F237); PLACES]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let (sin, cos) = F237::from_f64(STEP * k as f64).0.sin_cos();
        (F237(sin), F237(cos))
    })
});

/// A quarter turn as a number of few bits, so that its multiples are exact, and the rest of it.
static QUARTER: LazyLock<[F237; 2]> = LazyLock::new(|| {
    let quarter = quarter_turn();
    let upper = &quarter >> LOW_BITS;
    let rest = quarter - (&upper << LOW_BITS);
    [
        F237(scaled(&upper, LOW_BITS as isize - TURN_BITS)),
        F237(scaled(&(rest >> CUT_BITS), CUT_BITS as isize - TURN_BITS)),
    ]
});

/// So many bits of a quarter turn are known after the point.
const TURN_BITS: isize = 512;

/// The upper part leaves so many of them to the rest, which keeps all but the last.
const LOW_BITS: usize = 352;
const CUT_BITS: usize = 100;

/// pi / 2 = 8 arctan 1/5 - 2 arctan 1/239 (Machin, 1706), times 2^512.
fn quarter_turn() -> UBig {
    let spare = 32;
    let one = UBig::ONE << (TURN_BITS as usize + spare);
    let arctan = |n: u32| {
        let (mut term, mut sums) = (&one / UBig::from(n), [UBig::ZERO, UBig::ZERO]);
        for k in 0_u32.. {
            let share = &term / UBig::from(2 * k + 1);
            if share == UBig::ZERO {
                break;
            }
            sums[(k % 2) as usize] += share;
            term /= UBig::from(n * n);
        }
        let [plus, minus] = sums;
        plus - minus
    };
    (arctan(5) * UBig::from(8u32) - arctan(239) * UBig::from(2u32)) >> spare
}

/// More quarter turns than that leave fewer digits.
const MOST_TURNS: f64 = 65536.0;

/// The sine and the cosine.
pub(super) fn sin_cos(x: F237) -> (F237, F237) {
    let turns = (x.rounded() / std::f64::consts::FRAC_PI_2).round();
    if turns.is_nan() || turns.abs() > MOST_TURNS {
        let (sin, cos) = x.0.sin_cos();
        return (F237(sin), F237(cos));
    }
    let mut rest = x;
    if turns != 0.0 {
        let [upper, lower] = *QUARTER;
        rest = (x - F237::from_f64(turns) * upper) - F237::from_f64(turns) * lower;
    }
    let (sin, cos) = within_eighth(rest);
    match turns.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The sine and the cosine of an angle within an eighth turn, but for rounding.
fn within_eighth(x: F237) -> (F237, F237) {
    let place = (x.rounded() / STEP).round();
    if place == 0.0 {
        return series(x);
    }
    let (sin, cos) = TABLE[place.abs() as usize];
    let sin = if place < 0.0 { -sin } else { sin };
    let (s, c) = series(x - F237::from_f64(STEP * place));
    (sin * c + cos * s, cos * c - sin * s)
}

/// Powers that count in the series.
const TERMS: usize = 20;

/// The sine and the cosine of an angle of no more than 2^-10, by Taylor's series.
fn series(x: F237) -> (F237, F237) {
    let square = x * x;
    // One over the factorials of first, first + 2, ..., with signs in turn.
    let sum = |first: usize| {
        let shares = SHARES[..TERMS].iter().skip(first - 1).step_by(2).rev();
        shares.fold(F237::ZERO, |sum, &share| share - sum * square)
    };
    (x * sum(1), F237::ONE - square * sum(2))
}

/// The angle of a direction; none where f64 values do not know it nearly.
pub(super) fn angle(side: F237, along: F237) -> Option<F237> {
    let across = Float::abs(side);
    let near = across.rounded().atan2(along.rounded());
    let start = F237::from_f64(near);
    let (sin, cos) = sin_cos(start);
    let rest = (across * cos - along * sin) / (along * cos + across * sin);
    // Of the series of the arctangent the fifth power is beyond all digits.
    let third = rest * rest * rest / F237::from_f64(3.0);
    (rest.rounded().abs() < NEAR).then(|| (start + (rest - third)).copysign(side))
}

/// How near a start has to be.
const NEAR: f64 = 1.0 / (1_u64 << 50) as f64;
