use super::*;
use crate::number::extended::F237;
use std::cell::Cell;

fn roots(f: impl Fn(Jet<Interval>) -> Jet<Interval>, breaks: &[f64]) -> Vec<Root> {
    match isolate(&|t| f(Jet::variable(t)), breaks, 1e-11) {
        Roots::At { roots, .. } => roots,
        Roots::Everywhere => panic!("everywhere"),
    }
}

fn k(x: f64) -> Jet<Interval> {
    Jet::constant(x)
}

fn misses(f: impl Fn(Jet<Interval>) -> Jet<Interval>, breaks: &[f64]) -> Vec<f64> {
    match isolate_closely(&|t| f(Jet::variable(t)), breaks, 1e-11).unwrap() {
        Roots::At { misses, .. } => misses.iter().map(|m| m.value).collect(),
        Roots::Everywhere => panic!("everywhere"),
    }
}

#[test]
fn what_nearly_touches_is_told_once() {
    let near = 5e-10;
    for breaks in [&[-1.0, 1.0][..], &[-1.0, 0.0, 1.0]] {
        let above = misses(|t| t * t + k(near), breaks);
        assert_eq!(above.len(), 1, "{above:?}");
        assert!((above[0] - near).abs() < 1e-15);
        // A slow descent to a root is not a near miss.
        let flat = misses(|t| t * t * t * t, breaks);
        assert!(flat.is_empty(), "{flat:?}");
    }
    // Nor is a short piece of it that is hardly steeper than a constant.
    let flat = misses(|t| t * t * t * t, &[-1.0, 2e-3, 2.005e-3, 1.0]);
    assert!(flat.is_empty(), "{flat:?}");
    // The maximum between two roots is reported.
    let between = misses(|t| t * t - k(near), &[-1.0, 1.0]);
    assert_eq!(between, [-near]);
    // A closed curve may start at its closest point.
    assert_eq!(misses(|t| t * t + k(near), &[0.0, 1.0]), [near]);
    assert_eq!(misses(|t| t * k(0.0) + k(near), &[0.0, 4.0]), [near]);
    assert!(misses(|t| t - k(near), &[-1.0, 0.0, 1.0]).is_empty());
}

#[test]
fn simple_roots_are_found_in_order() {
    let r = roots(
        |t| (t - k(0.25)) * (t - k(0.5)) * (t + k(2.0)),
        &[-3.0, 1.0],
    );
    let t: Vec<f64> = r.iter().map(|r| r.t).collect();
    assert_eq!(t.len(), 3);
    for (a, b) in t.iter().zip([-2.0, 0.25, 0.5]) {
        assert!((a - b).abs() < 1e-14);
    }
    assert!(r.iter().all(|r| r.contact == RootKind::Simple));
}

#[test]
fn a_double_root_touches_and_a_triple_one_crosses() {
    let r = roots(|t| (t - k(0.3)).square() * (t + k(1.0)), &[0.0, 1.0]);
    assert_eq!(r.len(), 1);
    assert_eq!(r[0].contact, RootKind::Touching);
    assert!((r[0].t - 0.3).abs() < 1e-12);
    let r = roots(|t| (t - k(0.3)).square() * (t - k(0.3)), &[0.0, 1.0]);
    assert_eq!(r.len(), 1);
    assert_eq!(r[0].contact, RootKind::Inflected);
    assert!((r[0].t - 0.3).abs() < 1e-8);
}

#[test]
fn roots_apart_by_more_than_the_band_stay_apart() {
    // The extremum is -1e-10, ten times the resolution.
    let r = roots(|t| (t - k(0.3)).square() - k(1e-10), &[0.0, 1.0]);
    assert_eq!(r.len(), 2);
    // The extremum is 1e-10: no root.
    let r = roots(|t| (t - k(0.3)).square() + k(1e-10), &[0.0, 1.0]);
    assert!(r.is_empty());
}

#[test]
fn rounding_at_the_edge_of_the_band_makes_no_roots() {
    // A triple root, with noise of a thousandth of the resolution.
    let noise = |t: Interval| Interval::point(1e-14 * (t.mid() * 1e9).sin());
    let f = |t: Interval| {
        let x = Jet::variable(t) - k(0.3);
        let mut y = x.square() * x;
        y.v = y.v + noise(t);
        y
    };
    let Roots::At { roots, .. } = isolate(&f, &[0.0, 1.0], 1e-11) else {
        panic!("everywhere");
    };
    assert_eq!(roots.len(), 1);
    assert!(roots[0].lo < 0.3 && roots[0].hi > 0.3);
}

#[test]
fn trigonometric_roots_and_a_zero_function() {
    let r = roots(|t| t.sin_cos().0, &[0.5, 7.0]);
    assert_eq!(r.len(), 2);
    assert!((r[0].t - std::f64::consts::PI).abs() < 1e-15);
    let z = isolate(&|t| Jet::variable(t).scale(0.0), &[0.0, 1.0], 1e-11);
    assert_eq!(z, Roots::Everywhere);
}

#[test]
fn a_crossing_lies_in_its_cluster() {
    // Flat at 0, where it touches zero. The crossing is far from there, and the pieces close to it
    // are within the resolution.
    let f = |t: Jet<Interval>| t.square() * t.square() * (k(1.0) - t).scale(1e-8);
    let r = roots(f, &[0.0, 0.5, 1.0 - 1e-4, 1.0 + 1e-4, 1.5]);
    let [touch, crossing] = r.as_slice() else {
        panic!("{r:?}")
    };
    assert_eq!(touch.contact, RootKind::Touching);
    assert_eq!(crossing.contact, RootKind::Simple);
    assert!((crossing.t - 1.0).abs() < 1e-12, "{crossing:?}");
}

#[test]
fn a_root_at_the_very_end_is_kept() {
    let r = roots(|t| t - k(1.0), &[0.0, 1.0]);
    assert_eq!(r.len(), 1);
    assert!((r[0].t - 1.0).abs() < 1e-11);
}

/// A function close to zero, known at every point only to slightly more than the resolution.
/// Halving to the last digit would need millions of pieces.
#[test]
fn what_rounding_hides_is_told_in_few_pieces() {
    let asked = std::cell::Cell::new(0);
    let noise = |size: f64| Interval {
        lo: -1.1 * size,
        hi: 1.2 * size,
    };
    let noisy = |t: Interval| {
        asked.set(asked.get() + 1);
        let Jet { v, d, dd } = Jet::variable(t).square().square();
        Jet {
            v: v + noise(1e-11),
            d: d + noise(1e-5),
            dd: dd + noise(1.0),
        }
    };
    let Roots::At { roots, .. } = isolate_closely(&noisy, &[-1.0, 1.0], 1e-11).unwrap() else {
        panic!("everywhere");
    };
    assert_eq!(roots.len(), 1, "{roots:?}");
    assert_eq!(roots[0].contact, RootKind::Touching);
    assert!(roots[0].t.abs() < 6e-3, "{roots:?}");
    assert!(asked.get() < 10_000, "{}", asked.get());
}

/// Along a curve whose points are solved for, ranges are far wider than values. A function that is
/// 1e-20 over a whole piece is distinguished from zero by a polynomial model, not by halving.
#[test]
fn what_runs_along_zero_is_told_at_once() {
    struct Along<'a>(&'a Cell<usize>);
    impl Function<F237> for Along<'_> {
        fn over(&self, t: Interval<F237>) -> Jet<Interval<F237>> {
            self.0.set(self.0.get() + 1);
            let wave = Jet::variable(t).times(3.0).sin_cos().0.times(1e-20);
            let width = t.width();
            let around = |v: Interval<F237>| v + Interval::new(-width, width);
            Jet {
                v: around(wave.v),
                d: around(wave.d),
                dd: Interval::ENTIRE,
            }
        }
    }
    let asked = Cell::new(0);
    let ends = [F237::from_f64(0.5), F237::from_f64(1.5)];
    let zeros = isolate(&Along(&asked), &ends, F237::from_f64(1e-45));
    let Roots::At { roots, .. } = zeros else {
        panic!("everywhere");
    };
    let found: Vec<f64> = roots.iter().map(|r| r.t.rounded()).collect();
    assert_eq!(found, [std::f64::consts::FRAC_PI_3]);
    assert!(asked.get() < 200, "{}", asked.get());
}
