//! The functions of wider numbers against those of f64.

use crate::number::float::Float;

/// The arguments at which the functions of f64 and of wider numbers are compared: special values, and
/// ordinary ones.
const PLACES: [f64; 17] = [
    0.0, 1e-300, 1e-20, 1e-9, 0.25, 0.5, 0.7, 0.75, 1.0, 1.25, 1.5, 2.0, 3.0, 4.0, 10.0, 700.0, 1e9,
];

fn agrees<N: Float>(a: N, b: f64, about: (&str, f64, f64)) {
    let off = (a.rounded() - b).abs();
    assert!(
        off <= 4.0 * f64::EPSILON * b.abs(),
        "{about:?}: {} {b}",
        a.rounded()
    );
}

/// Compares the functions of one number.
pub(crate) fn functions_of_one_number<N: Float>() {
    for x in PLACES.into_iter().flat_map(|x| [x, -x]) {
        let w = N::from_f64(x);
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

/// Compares the functions of two numbers.
pub(crate) fn functions_of_two_numbers<N: Float>() {
    let all = || PLACES.into_iter().flat_map(|x| [x, -x]);
    for (x, y) in all().flat_map(|x| all().map(move |y| (x, y))) {
        let (a, b) = (N::from_f64(x), N::from_f64(y));
        agrees(a.atan2(b), x.atan2(y), ("atan2", x, y));
        agrees(a.hypot(b), x.hypot(y), ("hypot", x, y));
        agrees(Float::max(a, b), x.max(y), ("max", x, y));
        agrees(Float::min(a, b), x.min(y), ("min", x, y));
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
            N::from_f64(1.75).powi(n),
            1.75_f64.powi(n),
            ("powi", 1.75, f64::from(n)),
        );
    }
}
