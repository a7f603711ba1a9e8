use super::*;
use crate::number::analytic::sinc_jet;
use crate::number::rational::{from_decimal, from_f64, to_f64};
use crate::number::wide_float::comparison;
use proptest::prelude::*;

fn near(a: F237, b: F237) -> bool {
    Float::abs(a - b) <= Float::abs(b) * F237::ROUNDING
}

/// The sine and the cosine by Taylor's series in fractions.
fn by_fractions(x: f64) -> (F237, F237) {
    let x = from_f64(x).unwrap();
    let (mut term, mut sums) = (Rational::ONE, [Rational::ZERO, Rational::ZERO]);
    for n in 0..140_u8 {
        let sign = if n % 4 < 2 { 1 } else { -1 };
        sums[usize::from(n % 2)] += term.clone() * Rational::from(sign);
        term = term * x.clone() / Rational::from(n + 1);
    }
    let [cos, sin] = sums;
    (F237::nearest(&sin), F237::nearest(&cos))
}

#[test]
fn sines_are_their_series() {
    let eighth = std::f64::consts::FRAC_PI_4;
    let turns = (-9..10).map(|k| f64::from(k) * eighth);
    let beside = turns.flat_map(|x| [x, x.next_up(), x + 0.001, x - 0.0078]);
    for x in beside.chain([1e-40, 0.3, 0.49, 1.0, -2.0, 6.0]) {
        let (sin, cos) = F237::from_f64(x).sin_cos();
        let (s, c) = by_fractions(x);
        assert!(near(sin, s), "{x} {sin:?} {s:?}");
        assert!(near(cos, c), "{x} {cos:?} {c:?}");
        let back = sin.atan2(cos);
        let turned =
            F237::from_f64(x) - F237::TAU * F237::from_f64((x / std::f64::consts::TAU).round());
        let apart = Float::abs(back - turned);
        let off = Float::min(apart, Float::abs(apart - F237::TAU));
        assert!(
            off <= Float::abs(F237::from_f64(x)) * F237::ROUNDING,
            "{x} {back:?}"
        );
    }
    // For large arguments the library's function is used.
    let x = F237::from_f64(123_456.75);
    let y = F237::from_f64(1_000_000.5);
    for x in [x, y] {
        let (sin, cos) = (F237(x.0.sin()), F237(x.0.cos()));
        assert!(near(x.sin_cos().0, sin) && near(x.sin_cos().1, cos));
    }
}

#[test]
fn functions_have_all_digits() {
    for x in [-3.7, -1e-20, 1e-9, 0.3, 1.0, 2.5, 40.0].map(F237::from_f64) {
        let (sin, cos) = x.sin_cos();
        assert!(near(sin * sin + cos * cos, F237::ONE), "{x:?}");
        assert!(near(x.sinh().asinh(), x), "{x:?}");
        assert!(
            near(x.sinh() * x.sinh() + F237::ONE, x.cosh() * x.cosh()),
            "{x:?}"
        );
        assert!(near(sin.atan2(cos).sin(), sin), "{x:?}");
    }
    let x = F237::from_f64(1.25);
    assert!(near(x.acosh().cosh(), x));
    assert!(near(
        x.hypot(F237::from_f64(3.0)) * x.hypot(F237::from_f64(3.0)),
        F237::from_f64(10.5625)
    ));
    assert!(near(
        F237::from_f64(-0.5).acos() * F237::from_f64(3.0),
        F237::TAU
    ));
    let third = F237::nearest(&(Rational::ONE / Rational::from(3)));
    assert!(near(third * F237::from_f64(3.0), F237::ONE));
}

#[test]
fn functions_are_those_of_doubles() {
    comparison::functions_of_one_number::<F237>();
    comparison::functions_of_two_numbers::<F237>();
}

#[test]
fn small_angles_are_those_of_their_series() {
    for n in [-7, -20, -60, -110, -119, -121, -400] {
        let x = F237::from_f64(1.3) * F237(f256::TWO).powi(n);
        let x2 = x * x;
        let terms = |first: i32| {
            // The terms of an alternating series of powers over factorials.
            let mut term = F237::ONE;
            (0..20).fold(F237::ZERO, |sum, k| {
                let now = sum + term;
                let n = F237::whole(first + 2 * k);
                term *= -x2 / ((n + F237::ONE) * (n + F237::TWO));
                now
            })
        };
        assert!(near(x.sin(), x * terms(1)), "sin {n}");
        assert!(near(x.sin_cos().0, x * terms(1)), "sin {n}");
        assert!(near(x.cos(), terms(0)), "cos {n}");
        assert!(near((x.sin() / x.cos()).atan(), x), "atan {n}");
        assert!(near(x.sin().atan2(x.cos()), x), "atan2 {n}");
        assert!(near(x.sinh().asinh(), x), "asinh {n}");
    }
}

#[test]
fn sinc_is_smooth_where_its_series_ends() {
    let [a, b] = [0.499_999_999_9, 0.500_000_000_1].map(F237::from_f64);
    for i in 0..2 {
        // The mean of the derivatives at both ends is the slope in between, to third order.
        let rise = sinc_jet(b)[i] - sinc_jet(a)[i];
        let mean = F237::HALF * (sinc_jet(a)[i + 1] + sinc_jet(b)[i + 1]);
        let off = Float::abs(rise / (b - a) - mean);
        assert!(off < F237::from_f64(1e-18), "{off:?}");
    }
}

#[test]
fn doubles_bound_what_lies_between_them() {
    let third = F237::ONE / F237::from_f64(3.0);
    assert_eq!(third.rounded(), 1.0 / 3.0);
    assert!(F237::from_f64(third.below()) < third && third < F237::from_f64(third.above()));
    assert_eq!(third.above(), third.below().next_up());
    assert_eq!(F237::from_f64(0.1).below(), 0.1);
    assert_eq!(F237::from_f64(0.1).above(), 0.1);
    assert_eq!(F237::ZERO.rounded(), 0.0);
    assert_eq!(F237::NEG_INFINITY.rounded(), f64::NEG_INFINITY);
    assert!(F237::NAN.rounded().is_nan());
}

proptest! {
    #[test]
    fn a_double_survives(x in proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL) {
        prop_assert_eq!(F237::from_f64(x).rounded(), x);
        prop_assert_eq!(F237::from_f64(x).exact(), from_f64(x));
    }

    #[test]
    fn a_rational_is_rounded_once(digits in "[1-9][0-9]{0,60}", e in -80i32..80) {
        let exact = from_decimal(&format!("-{digits}e{e}")).unwrap();
        let near = F237::nearest(&exact);
        prop_assert_eq!(near.rounded(), to_f64(&exact));
        let off = near.exact().unwrap() / exact - Rational::ONE;
        let most = F237::EPSILON.exact().unwrap();
        prop_assert!(-most.clone() <= off && off <= most);
    }
}

/// Below a power of two the exponential split off a power too many. Logarithms and arc functions are
/// those of the library, and do not know about it.
#[test]
fn inverse_functions_next_to_powers_of_two() {
    // The argument of an exponential of 2^119 is 83 times its rounding.
    let near = |a: F237, b: F237| Float::abs(a - b) <= b * F237(power(-225));
    for (k, m) in (0..120).flat_map(|k| (1..200).map(move |m| (k, m))) {
        for sign in [F237::ONE, -F237::ONE] {
            let x = F237(power(k)) * (F237::ONE + sign * F237(power(-m)));
            assert!(near(x.asinh().sinh(), x), "asinh {k} {m}");
            assert!(near(x.acosh().cosh(), x) || x < F237::ONE, "acosh {k} {m}");
            let c = F237(power(-k)) * (F237::ONE + sign * F237(power(-m)));
            let off = Float::abs(c.acos().cos() - c);
            assert!(off <= F237::ROUNDING || c > F237::ONE, "acos {k} {m}");
            assert!(near(c.atan().sin(), c * c.atan().cos()), "atan {k} {m}");
        }
    }
}
