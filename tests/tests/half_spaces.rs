//! Unbounded solids: the same part of primitives, and of half-spaces and complements.

use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadError, ReadOptions, read};
use premio_csg::tree::Tree;
use proptest::prelude::*;
use proptest::test_runner::Config;

/// Two descriptions of one solid: by primitives, and by half-spaces and complements.
#[derive(Clone, Debug)]
struct Pair {
    bounded: String,
    unbounded: String,
}

impl Pair {
    fn moved(&self, at: &str) -> Self {
        let moved = |text: &str| format!("({text}) AT ({at})");
        Self {
            bounded: moved(&self.bounded),
            unbounded: moved(&self.unbounded),
        }
    }

    /// An operation, and what it is by De Morgan's laws.
    fn combined(&self, op: &str, other: &Self) -> Self {
        let (a, b) = (&self.unbounded, &other.unbounded);
        Self {
            bounded: format!("({} {op} {})", self.bounded, other.bounded),
            unbounded: match op {
                "UN" => format!("OUT(OUT({a}) INT OUT({b}))"),
                "INT" => format!("({a} DIF OUT({b}))"),
                _ => format!("({a} INT OUT({b}))"),
            },
        }
    }
}

/// A length on the half-unit grid.
fn length() -> impl Strategy<Value = f64> {
    (1..8_i32).prop_map(|x| 0.5 * f64::from(x))
}

fn leaf() -> impl Strategy<Value = Pair> {
    (0..6_i32, length(), length(), length()).prop_map(|(kind, a, b, c)| {
        let [bounded, unbounded] = match kind {
            0 => [
                format!("BLO(X={a}, Y={b}, Z={c})"),
                format!(
                    "HALF(-1,0,0) INT HALF(0,-2,0) INT HALF(0,0,-3) INT HALF(1,0,0,{a}) INT HALF(0,3,0,3*{b}) INT HALF(0,0,1,{c})"
                ),
            ],
            1 => [
                format!("CYL(R={a}, H={b})"),
                format!("ICYL(R={a}) INT HALF(0,0,-1) INT HALF(0,0,1/2,{b}/2)"),
            ],
            2 => [
                format!("CON(R={a}, H={b})"),
                format!("ICON(SLOPE={a}/{b}) AT (ROTX=180, MOVZ={b}) INT HALF(0,0,-1)"),
            ],
            3 => [
                format!("SPH(R={a}) DIF BLO(X=20, Y=20, Z=20) AT (MOVX=-10, MOVY=-10, MOVZ={b}-1)"),
                format!("SPH(R={a}) DIF HALF(0,0,-1,1-{b})"),
            ],
            4 => [
                format!(
                    "BLO(X={a}, Y={b}, Z={c}) DIF (BLO(X=20, Y=20, Z=20) AT (MOVX={a}/2) UN BLO(X=20, Y=20, Z=20) AT (MOVY={b}/2))"
                ),
                format!(
                    "BLO(X={a}, Y={b}, Z={c}) DIF (HALF(1,0,0,-{a}/2) AT (ROTZ=180) UN HALF(0,-2,0,-{b}))"
                ),
            ],
            _ => [format!("SPH(R={a})"), format!("OUT(OUT(SPH(R={a})))")],
        };
        Pair { bounded, unbounded }
    })
}

fn placed() -> impl Strategy<Value = Pair> {
    let motion = (
        0..3_usize,
        prop::sample::select(vec![0, 30, 90]),
        length(),
        length(),
    );
    (leaf(), motion).prop_map(|(leaf, (axis, angle, x, y))| {
        let axis = ["X", "Y", "Z"][axis];
        leaf.moved(&format!("ROT{axis}={angle}, MOVX={x}, MOVY={y}"))
    })
}

fn part() -> impl Strategy<Value = Pair> {
    let more = prop::collection::vec(
        (prop::sample::select(vec!["UN", "INT", "DIF"]), placed()),
        1..4,
    );
    (placed(), more).prop_map(|(first, more)| {
        more.iter()
            .fold(first, |part, (op, other)| part.combined(op, other))
    })
}

fn described(text: &str) -> Result<Tree, ReadError> {
    let text = format!("P = {text}");
    let options = ReadOptions::default();
    read("p.padl", text.as_bytes(), Format::Padl, &options).map(|description| description.tree)
}

fn evaluated(text: &str) -> Evaluation {
    let tree = described(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    evaluate(&tree, &EvaluationOptions::default()).unwrap_or_else(|e| panic!("{text}: {e}"))
}

proptest! {
    #![proptest_config(Config { cases: 150, failure_persistence: None, ..Config::default() })]

    #[test]
    fn half_spaces_and_complements_make_the_same_part(pair in part()) {
        let [bounded, unbounded] = [&pair.bounded, &pair.unbounded].map(|text| evaluated(text));
        let [a, b] = [&bounded, &unbounded].map(Evaluation::mass);
        prop_assert!((a.volume - b.volume).abs() <= 1e-9 * a.volume.abs().max(1.0), "{} {}", a.volume, b.volume);
        prop_assert!((a.area - b.area).abs() <= 1e-7 * a.area.abs().max(1.0), "{} {}", a.area, b.area);
        let [a, b] = [bounded, unbounded].map(|e| e.brep.topology.census());
        prop_assert_eq!(a, b);
    }
}

/// The message of an unbounded part.
fn refusal(text: &str) -> String {
    described(text)
        .err()
        .map_or_else(String::new, |error| error.to_string())
}

#[test]
fn an_unbounded_part_is_refused_with_a_direction() {
    for (text, toward) in [
        ("HALF(0,0,1)", "toward -z"),
        ("HALF(1,0,0) INT HALF(0,1,0) INT HALF(0,0,1)", "toward -x"),
        ("ICYL(R=2) AT (ROTY=90)", "toward +x"),
        ("ICYL(R=2) AT (ROTX=90) INT HALF(0,1,0,5)", "toward -y"),
        ("ICON(SLOPE=1/4) DIF SPH(R=3)", "toward +z"),
        ("OUT(BLO(X=1,Y=1,Z=1))", "on every side"),
        ("SPH(R=2) UN OUT(SPH(R=5))", "on every side"),
        (
            "SPH(R=1) AT (MOVX=5) UN ICON(SLOPE=1) AT (ROTX=180)",
            "toward -z",
        ),
    ] {
        let message = refusal(text);
        assert!(message.contains(toward), "{text}: {message}");
    }
}

/// Half-spaces that have a point, a line or nothing in common make an empty or an unbounded part.
#[test]
fn half_spaces_without_a_common_inner_point_have_an_end() {
    let [x, y, z] = ["1,0,0", "0,1,0", "0,0,1"].map(|axis| {
        let [a, b, c] = [0, 1, 2].map(|i| axis.split(',').nth(i).unwrap().parse::<i32>().unwrap());
        format!("HALF({a},{b},{c}) INT HALF({},{},{})", -a, -b, -c)
    });
    let volume = |text: &str| evaluated(text).mass().volume;
    assert_eq!(volume(&format!("{x} INT {y} INT {z}")), 0.0);
    assert_eq!(volume(&format!("BLO(X=4,Y=4,Z=4) INT {x}")), 0.0);
    assert_eq!(volume("BLO(X=4,Y=4,Z=4) INT HALF(1,1,1,-1)"), 0.0);
    assert_eq!(
        volume("HALF(1,0,0,-1) INT HALF(-1,0,0,-1) INT SPH(R=4)"),
        0.0
    );
    assert!(refusal(&x).contains("unbounded"));
}

/// Planes and axes at small angles: the part reaches far, and is bounded.
#[test]
fn a_part_that_reaches_far_is_bounded() {
    for angle in [1.0, 0.1, 0.01, 0.001] {
        // Between two planes that meet at the angle, and a third one.
        let wedge = format!(
            "HALF(0,0,-1) INT HALF(0,0,1) AT (ROTY={angle}, MOVZ=1) INT HALF(-1,0,0) INT HALF(0,1,0,1) INT HALF(0,-1,0,1)"
        );
        let tan = f64::tan(f64::to_radians(angle));
        let volume = evaluated(&wedge).mass().volume;
        approx::assert_relative_eq!(volume, 1.0 / tan, max_relative = 1e-9);
        let crossing = format!("ICYL(R=1) INT ICYL(R=1) AT (ROTX={angle})");
        let volume = evaluated(&crossing).mass().volume;
        let sin = f64::sin(f64::to_radians(angle));
        approx::assert_relative_eq!(volume, 16.0 / 3.0 / sin, max_relative = 1e-9);
    }
}
