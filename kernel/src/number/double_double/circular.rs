//! Sines, cosines and angles of 106-bit numbers, their most frequent functions.
//!
//! The argument is reduced by multiples of a quarter turn to at most an eighth turn, then by the
//! nearest entry of a table to at most 2^-10. A short Taylor series gives the rest. An arctangent
//! is the f64 angle plus a remainder.

use super::{F106, F237, fast_two_sum, power};
use crate::number::float::{Analytic, Float};
use std::sync::LazyLock;

/// The distance between the arguments of consecutive table entries.
const STEP: f64 = 1.0 / 512.0;

/// The number of table entries, up to an eighth turn.
const PLACES: usize = 403;

/// The number of terms of the Taylor series that contribute for numbers below 2^-8.
const TERMS: usize = 12;

/// The highest power in the series of sines and cosines.
const POWERS: usize = 10;

/// The numbers that the functions look up.
struct Tables {
    /// Sines and cosines.
    circle: Vec<(F106, F106)>,
    /// 1 / n! for n = 1, 2, ...
    shares: [F106; TERMS],
    /// A quarter turn: a number of few bits, whose multiples are exact, and the remainder.
    quarter: (f64, F106),
}

static TABLES: LazyLock<Tables> = LazyLock::new(|| {
    let circle = (0..PLACES).map(|k| {
        let (sin, cos) = F237::from_f64(STEP * k as f64).sin_cos();
        (F106::from_extended(sin), F106::from_extended(cos))
    });
    let mut share = F237::ONE;
    let shares = std::array::from_fn(|n| {
        share /= F237::from_f64((n + 1) as f64);
        F106::from_extended(share)
    });
    let quarter = F237::HALF * F237::PI;
    let upper = (quarter.rounded() * power(SHORT)).floor() * power(-SHORT);
    Tables {
        circle: circle.collect(),
        shares,
        quarter: (upper, F106::from_extended(quarter - F237::from_f64(upper))),
    }
});

/// The number of bits of the upper part of a quarter turn after the binary point.
const SHORT: i64 = 32;

/// The greatest number of quarter turns, whose products with the upper part are exact.
const MOST_TURNS: f64 = 65536.0;

/// 1 / n! for n = 1, 2, ...
pub(super) fn shares() -> &'static [F106] {
    &TABLES.shares
}

/// The sine and the cosine.
pub(super) fn sin_cos(x: F106) -> (F106, F106) {
    let turns = (x.high / std::f64::consts::FRAC_PI_2).round();
    if turns.is_nan() || turns.abs() > MOST_TURNS {
        let (sin, cos) = x.extended().sin_cos();
        return (F106::from_extended(sin), F106::from_extended(cos));
    }
    let tables = &*TABLES;
    let mut rest = x;
    if turns != 0.0 {
        let (upper, lower) = tables.quarter;
        rest = (x - F106::whole_of(turns * upper)) - F106::whole_of(turns) * lower;
    }
    let (sin, cos) = within_eighth(rest, tables);
    match turns.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The sine and the cosine of an angle of at most an eighth turn, except for rounding.
fn within_eighth(x: F106, tables: &Tables) -> (F106, F106) {
    let place = (x.high / STEP).round();
    if place == 0.0 {
        return series(x, tables);
    }
    let (sin, cos) = tables.circle[place.abs() as usize];
    let sin = if place < 0.0 { -sin } else { sin };
    let (s, c) = series(x - F106::whole_of(STEP * place), tables);
    (sin * c + cos * s, cos * c - sin * s)
}

/// The sine and the cosine of an angle of at most 2^-10, by Taylor series.
fn series(x: F106, tables: &Tables) -> (F106, F106) {
    let square = x * x;
    // 1 / n! for n = first, first + 2, ..., with alternating signs.
    let sum = |first: usize| {
        let shares = tables.shares[..POWERS]
            .iter()
            .skip(first - 1)
            .step_by(2)
            .rev();
        shares.fold(F106::ZERO, |sum, &share| share - sum * square)
    };
    (x * sum(1), F106::ONE - square * sum(2))
}

/// The angle of the direction (`along`, `side`); `None` if the f64 angle is not close enough.
pub(super) fn angle(side: F106, along: F106) -> Option<F106> {
    let across = Float::abs(side);
    let near = across.high.atan2(along.high);
    let (sin, cos) = sin_cos(F106::whole_of(near));
    // The third power of the arctangent series is below the precision.
    let rest = (across * cos - along * sin) / (along * cos + across * sin);
    (rest.high.abs() < NEAR)
        .then(|| (fast_two_sum(near, rest.high) + F106::whole_of(rest.low)).copysign(side))
}

/// The greatest error of the f64 start.
const NEAR: f64 = power(-50);
