use super::*;
use crate::number::rational::{from_decimal, from_f64, to_f64};
use proptest::prelude::*;

fn near(a: Wide, b: Wide) -> bool {
    Number::abs(a - b) <= Number::abs(b) * Wide::ROUNDING
}

/// The sine and the cosine by Taylor's series in fractions.
fn by_fractions(x: f64) -> (Wide, Wide) {
    let x = from_f64(x).unwrap();
    let (mut term, mut sums) = (Rational::ONE, [Rational::ZERO, Rational::ZERO]);
    for n in 0..140_u8 {
        let sign = if n % 4 < 2 { 1 } else { -1 };
        sums[usize::from(n % 2)] += term.clone() * Rational::from(sign);
        term = term * x.clone() / Rational::from(n + 1);
    }
    let [cos, sin] = sums;
    (Wide::nearest(&sin), Wide::nearest(&cos))
}

#[test]
fn sines_are_their_series() {
    let eighth = std::f64::consts::FRAC_PI_4;
    let turns = (-9..10).map(|k| f64::from(k) * eighth);
    let beside = turns.flat_map(|x| [x, x.next_up(), x + 0.001, x - 0.0078]);
    for x in beside.chain([1e-40, 0.3, 0.49, 1.0, -2.0, 6.0]) {
        let (sin, cos) = Wide::of(x).sin_cos();
        let (s, c) = by_fractions(x);
        assert!(near(sin, s), "{x} {sin:?} {s:?}");
        assert!(near(cos, c), "{x} {cos:?} {c:?}");
        let back = sin.atan2(cos);
        let turned = Wide::of(x) - Wide::TAU * Wide::of((x / std::f64::consts::TAU).round());
        let apart = Number::abs(back - turned);
        let off = Number::min(apart, Number::abs(apart - Wide::TAU));
        assert!(
            off <= Number::abs(Wide::of(x)) * Wide::ROUNDING,
            "{x} {back:?}"
        );
    }
    // Far off, the library's.
    let x = Wide::of(123_456.75);
    let y = Wide::of(1_000_000.5);
    for x in [x, y] {
        let (sin, cos) = (Wide(x.0.sin()), Wide(x.0.cos()));
        assert!(near(x.sin_cos().0, sin) && near(x.sin_cos().1, cos));
    }
}

#[test]
fn functions_have_all_digits() {
    for x in [-3.7, -1e-20, 1e-9, 0.3, 1.0, 2.5, 40.0].map(Wide::of) {
        let (sin, cos) = x.sin_cos();
        assert!(near(sin * sin + cos * cos, Wide::ONE), "{x:?}");
        assert!(near(x.sinh().asinh(), x), "{x:?}");
        assert!(
            near(x.sinh() * x.sinh() + Wide::ONE, x.cosh() * x.cosh()),
            "{x:?}"
        );
        assert!(near(sin.atan2(cos).sin(), sin), "{x:?}");
    }
    let x = Wide::of(1.25);
    assert!(near(x.acosh().cosh(), x));
    assert!(near(
        x.hypot(Wide::of(3.0)) * x.hypot(Wide::of(3.0)),
        Wide::of(10.5625)
    ));
    assert!(near(Wide::of(-0.5).acos() * Wide::of(3.0), Wide::TAU));
    let third = Wide::nearest(&(Rational::ONE / Rational::from(3)));
    assert!(near(third * Wide::of(3.0), Wide::ONE));
}

/// Where the functions of doubles and of wide numbers are held against each other: special
/// values, and ordinary ones.
const PLACES: [f64; 17] = [
    0.0, 1e-300, 1e-20, 1e-9, 0.25, 0.5, 0.7, 0.75, 1.0, 1.25, 1.5, 2.0, 3.0, 4.0, 10.0, 700.0, 1e9,
];

fn agrees(a: Wide, b: f64, about: (&str, f64, f64)) {
    let off = (a.rounded() - b).abs();
    assert!(
        off <= 4.0 * f64::EPSILON * b.abs(),
        "{about:?}: {} {b}",
        a.rounded()
    );
}

#[test]
fn functions_of_one_number_are_those_of_doubles() {
    for x in PLACES.into_iter().flat_map(|x| [x, -x]) {
        let w = Wide::of(x);
        let about = |name| (name, x, 0.0);
        agrees(w.sin(), x.sin(), about("sin"));
        agrees(w.cos(), x.cos(), about("cos"));
        agrees(w.sin_cos().0, x.sin(), about("sin of both"));
        agrees(w.sin_cos().1, x.cos(), about("cos of both"));
        agrees(w.atan(), x.atan(), about("atan"));
        agrees(w.asinh(), x.asinh(), about("asinh"));
        agrees(w.floor(), x.floor(), about("floor"));
        agrees(w.ceil(), x.ceil(), about("ceil"));
        agrees(w.round(), x.round(), about("round"));
        agrees(w.fract(), x.fract(), about("fract"));
        if x.abs() <= 700.0 {
            agrees(w.sinh(), x.sinh(), about("sinh"));
            agrees(w.cosh(), x.cosh(), about("cosh"));
        }
        if x.abs() <= 1.0 {
            agrees(w.acos(), x.acos(), about("acos"));
        }
        if x >= 0.0 {
            agrees(w.sqrt(), x.sqrt(), about("sqrt"));
        }
        if x >= 1.0 {
            agrees(w.acosh(), x.acosh(), about("acosh"));
        }
    }
}

#[test]
fn functions_of_two_numbers_are_those_of_doubles() {
    let all = || PLACES.into_iter().flat_map(|x| [x, -x]);
    for (x, y) in all().flat_map(|x| all().map(move |y| (x, y))) {
        let (a, b) = (Wide::of(x), Wide::of(y));
        agrees(a.atan2(b), x.atan2(y), ("atan2", x, y));
        agrees(a.hypot(b), x.hypot(y), ("hypot", x, y));
        agrees(Number::max(a, b), x.max(y), ("max", x, y));
        agrees(Number::min(a, b), x.min(y), ("min", x, y));
        if y != 0.0 && x.abs() < 1e3 && y.abs() > 1e-3 {
            let most = 4.0 * f64::EPSILON * y.abs();
            let off = (a.rem_euclid(b).rounded() - x.rem_euclid(y)).abs();
            assert!(off <= most || y.abs() - off <= most, "rem_euclid {x} {y}");
        }
        assert_eq!(a < b, x < y);
        assert_eq!(a == b, x == y);
    }
    for n in -5..6 {
        agrees(
            Wide::of(1.75).powi(n),
            1.75_f64.powi(n),
            ("powi", 1.75, f64::from(n)),
        );
    }
}

#[test]
fn small_angles_are_those_of_their_series() {
    for n in [-7, -20, -60, -110, -119, -121, -400] {
        let x = Wide::of(1.3) * Wide(f256::TWO).powi(n);
        let x2 = x * x;
        let terms = |first: i32| {
            // The terms of a series of alternating powers over factorials.
            let mut term = Wide::ONE;
            (0..20).fold(Wide::ZERO, |sum, k| {
                let now = sum + term;
                let n = Wide::whole(first + 2 * k);
                term *= -x2 / ((n + Wide::ONE) * (n + Wide::TWO));
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
    let [a, b] = [0.499_999_999_9, 0.500_000_000_1].map(Wide::of);
    for i in 0..2 {
        // The mean of the derivative at both ends is the slope between, to the third order.
        let rise = sinc_jet(b)[i] - sinc_jet(a)[i];
        let mean = Wide::HALF * (sinc_jet(a)[i + 1] + sinc_jet(b)[i + 1]);
        let off = Number::abs(rise / (b - a) - mean);
        assert!(off < Wide::of(1e-18), "{off:?}");
    }
}

#[test]
fn doubles_bound_what_lies_between_them() {
    let third = Wide::ONE / Wide::of(3.0);
    assert_eq!(third.rounded(), 1.0 / 3.0);
    assert!(Wide::of(third.below()) < third && third < Wide::of(third.above()));
    assert_eq!(third.above(), third.below().next_up());
    assert_eq!(Wide::of(0.1).below(), 0.1);
    assert_eq!(Wide::of(0.1).above(), 0.1);
    assert_eq!(Wide::ZERO.rounded(), 0.0);
    assert_eq!(Wide::NEG_INFINITY.rounded(), f64::NEG_INFINITY);
    assert!(Wide::NAN.rounded().is_nan());
}

proptest! {
    #[test]
    fn a_double_survives(x in proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL) {
        prop_assert_eq!(Wide::of(x).rounded(), x);
        prop_assert_eq!(Wide::of(x).exact(), from_f64(x));
    }

    #[test]
    fn a_rational_is_rounded_once(digits in "[1-9][0-9]{0,60}", e in -80i32..80) {
        let exact = from_decimal(&format!("-{digits}e{e}")).unwrap();
        let near = Wide::nearest(&exact);
        prop_assert_eq!(near.rounded(), to_f64(&exact));
        let off = near.exact().unwrap() / exact - Rational::ONE;
        let most = Wide::EPSILON.exact().unwrap();
        prop_assert!(-most.clone() <= off && off <= most);
    }
}
