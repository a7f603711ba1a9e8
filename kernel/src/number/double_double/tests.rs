use super::*;
use crate::number::wide_float::comparison;
use proptest::prelude::*;

/// The relative difference from a number of 237 bits, in units of 2^-106.
fn units(a: F106, b: F237) -> f64 {
    let off = Float::abs(a.extended() - b).rounded();
    let size = Float::abs(b).rounded();
    if off == 0.0 {
        0.0
    } else {
        off / size * power(106)
    }
}

/// A sum of two f64 that fill 106 bits.
fn number() -> impl Strategy<Value = F106> {
    let parts = (1.0..2.0, -0.5..0.5, -40..40_i64, any::<bool>());
    parts.prop_map(|(high, low, n, negative)| {
        let x = fast_two_sum(high, low * power(-53)).by_power(power(n));
        if negative { -x } else { x }
    })
}

/// Numbers next to one another, so that their difference cancels.
fn close() -> impl Strategy<Value = (F106, F106)> {
    let step = (-1.0..1.0, 0..110_i64);
    (number(), step).prop_map(|(x, (part, n))| {
        let factor = F106::ONE + F106::whole_of(part * power(-n));
        (x, x * factor)
    })
}

fn operations_are_near(a: F106, b: F106) {
    let (x, y) = (a.extended(), b.extended());
    assert!(units(a + b, x + y) <= 3.0, "{a:?} + {b:?}");
    assert!(units(a - b, x - y) <= 3.0, "{a:?} - {b:?}");
    assert!(units(a * b, x * y) <= 7.0, "{a:?} * {b:?}");
    assert!(units(a / b, x / y) <= 15.0, "{a:?} / {b:?}");
    assert_eq!(a.partial_cmp(&b), x.partial_cmp(&y));
    assert_eq!(a == b, x == y);
    for z in [a + b, a - b, a * b, a / b] {
        assert_eq!(z.high + z.low, z.high, "{z:?} is normal");
    }
}

proptest! {
    #[test]
    fn operations_are_those_of_237_bits((a, b) in (number(), number())) {
        operations_are_near(a, b);
    }

    #[test]
    fn operations_that_cancel_are_those_of_237_bits((a, b) in close()) {
        operations_are_near(a, -b);
        operations_are_near(a, b);
    }

    #[test]
    fn functions_are_those_of_237_bits(x in number(), y in number()) {
        // A sine or cosine is known to the precision of one.
        let off = |a: F106, b: F237| Float::abs(a.extended() - b).rounded() * power(106);
        let w = x.extended();
        prop_assert!(off(x.sin(), w.sin()) <= 16.0);
        prop_assert!(off(x.cos(), w.cos()) <= 16.0);
        prop_assert!(units(x.atan2(y), w.atan2(y.extended())) <= 32.0);
        prop_assert!(units(x.hypot(y), w.hypot(y.extended())) <= 16.0);
        prop_assert!(units(Float::abs(x).sqrt(), Float::abs(w).sqrt()) <= 8.0);
        prop_assert!(units(x.asinh(), w.asinh()) <= 256.0);
        prop_assert!(units(x.atan(), w.atan()) <= 32.0);
        if x.high.abs() <= 600.0 {
            prop_assert!(units(x.sinh(), w.sinh()) <= 256.0);
            prop_assert!(units(x.cosh(), w.cosh()) <= 256.0);
        }
        if x.high.abs() < 1.0 {
            prop_assert!(units(x.acos(), w.acos()) <= 64.0);
        }
        if x.high > 1.0 {
            prop_assert!(units(x.acosh(), w.acosh()) <= 256.0);
        }
    }

    #[test]
    fn integers_are_those_of_237_bits(x in number(), y in number()) {
        let w = x.extended();
        prop_assert_eq!(x.floor().extended(), w.floor());
        prop_assert_eq!(x.ceil().extended(), w.ceil());
        prop_assert_eq!(x.round().extended(), w.round());
        prop_assert_eq!(x.fract().extended(), w.fract());
        prop_assert!(F237::from_f64(x.below().next_up()) >= w);
        prop_assert!(F237::from_f64(x.below()) <= w && F237::from_f64(x.above()) >= w);
        let rest = x.rem_euclid(y);
        prop_assert!(rest >= F106::ZERO && rest <= Float::abs(y));
        prop_assert_eq!(F106::nearest(&x.exact().unwrap()), x);
    }
}

#[test]
fn functions_are_those_of_doubles() {
    comparison::functions_of_one_number::<F106>();
    comparison::functions_of_two_numbers::<F106>();
}

#[test]
fn numbers_beyond_the_range_are_infinite_or_undefined() {
    let (great, infinite) = (F106::MAX, F106::INFINITY);
    assert_eq!(great * F106::TWO, infinite);
    assert_eq!(great + great, infinite);
    assert_eq!(infinite + F106::ONE, infinite);
    assert_eq!(infinite * -F106::ONE, F106::NEG_INFINITY);
    assert_eq!(F106::ONE / F106::ZERO, infinite);
    assert_eq!(F106::ONE / infinite, F106::ZERO);
    assert_eq!(infinite.sqrt(), infinite);
    assert!((infinite - infinite).is_nan());
    assert!((infinite * F106::ZERO).is_nan());
    assert!((-F106::ONE).sqrt().is_nan());
    for (lo, hi) in [(F106::ZERO, F106::NAN), (F106::NAN, F106::ZERO)] {
        assert_eq!(lo.partial_cmp(&hi), None);
    }
    assert_eq!(Float::max(F106::NAN, F106::ONE), F106::ONE);
    assert_eq!(Float::min(F106::ONE, F106::NAN), F106::ONE);
}

#[test]
fn pi_has_all_digits() {
    assert_eq!(F106::PI, F106::from_extended(F237::PI));
    assert_eq!(F106::TAU, F106::TWO * F106::PI);
}
