//! Sines, cosines and angles of 237-bit numbers, their most frequent functions.
//!
//! The argument is reduced by multiples of a quarter turn to at most an eighth turn, then by the
//! nearest entry of a table to at most 2^-10. A short Taylor series gives the rest. An arctangent
//! is the f64 angle plus a remainder, which has a short series in its tangent.

use super::{F237, Float, SHARES, scaled};
use dashu::integer::UBig;
use std::sync::LazyLock;

/// The distance between the arguments of consecutive table entries.
const STEP: f64 = 1.0 / 512.0;

/// The number of table entries, up to an eighth turn.
const PLACES: usize = 403;

/// The sines and cosines of the table's arguments.
static TABLE: LazyLock<[(F237, F237); PLACES]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let (sin, cos) = F237::from_f64(STEP * k as f64).0.sin_cos();
        (F237(sin), F237(cos))
    })
});

/// A quarter turn: a number of few bits, whose multiples are exact, and the remainder.
static QUARTER: LazyLock<[F237; 2]> = LazyLock::new(|| {
    let quarter = quarter_turn();
    let upper = &quarter >> LOW_BITS;
    let rest = quarter - (&upper << LOW_BITS);
    [
        F237(scaled(&upper, LOW_BITS as isize - TURN_BITS)),
        F237(scaled(&(rest >> CUT_BITS), CUT_BITS as isize - TURN_BITS)),
    ]
});

/// The number of bits of a quarter turn that are computed after the binary point.
const TURN_BITS: isize = 512;

/// The number of bits below the upper part. The remainder keeps all but the last `CUT_BITS` of
/// them.
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

/// The greatest number of quarter turns. Above it the reduction loses digits.
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

/// The sine and the cosine of an angle of at most an eighth turn, except for rounding.
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

/// The highest power used in the series.
const TERMS: usize = 20;

/// The sine and the cosine of an angle of at most 2^-10, by Taylor series.
fn series(x: F237) -> (F237, F237) {
    let square = x * x;
    // 1 / n! for n = first, first + 2, ..., with alternating signs.
    let sum = |first: usize| {
        let shares = SHARES[..TERMS].iter().skip(first - 1).step_by(2).rev();
        shares.fold(F237::ZERO, |sum, &share| share - sum * square)
    };
    (x * sum(1), F237::ONE - square * sum(2))
}

/// The angle of the direction (`along`, `side`); `None` if the f64 angle is not close enough.
pub(super) fn angle(side: F237, along: F237) -> Option<F237> {
    let across = Float::abs(side);
    let near = across.rounded().atan2(along.rounded());
    let start = F237::from_f64(near);
    let (sin, cos) = sin_cos(start);
    let rest = (across * cos - along * sin) / (along * cos + across * sin);
    // The fifth power of the arctangent series is below the precision.
    let third = rest * rest * rest / F237::from_f64(3.0);
    (rest.rounded().abs() < NEAR).then(|| (start + (rest - third)).copysign(side))
}

/// The greatest error of the f64 start.
const NEAR: f64 = 1.0 / (1_u64 << 50) as f64;
