#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use super::rounding::Rounding;
use super::{PrimitiveRelation, Recovery, recovered};
use crate::builder::{Builder, SolidId};
use crate::primitive::Primitive;
use crate::transform::{Transform, TransformStep};
use crate::tree::{Operation, PlacedPrimitive, Tree};
use premio_kernel::number::rational::{Rational, from_decimal, to_f64};
use proptest::prelude::*;

fn number(text: &str) -> Rational {
    from_decimal(text).unwrap()
}

/// A primitive at a position in the frame of a part, with rotations before it.
#[derive(Clone)]
struct Piece {
    primitive: Primitive,
    turns: Vec<(usize, &'static str)>,
    at: [String; 3],
}

fn piece(primitive: Primitive, turns: &[(usize, &'static str)], at: [&str; 3]) -> Piece {
    Piece {
        primitive,
        turns: turns.to_vec(),
        at: at.map(str::to_owned),
    }
}

fn block(size: [&str; 3]) -> Primitive {
    Primitive::block(size.map(number)).unwrap()
}

fn cylinder(radius: &str, height: &str) -> Primitive {
    Primitive::cylinder(number(radius), number(height)).unwrap()
}

fn sphere(radius: &str) -> Primitive {
    Primitive::sphere(number(radius)).unwrap()
}

fn torus(major: &str, minor: &str) -> Primitive {
    Primitive::torus(number(major), number(minor)).unwrap()
}

const ODD: [(usize, &str); 3] = [(0, "184.059"), (1, "145.776"), (2, "282.167")];

fn turned(mut transform: Transform, turns: &[(usize, &str)]) -> Transform {
    for (axis, degrees) in turns {
        let step = TransformStep::about(*axis, number(degrees));
        transform.push(step).unwrap();
    }
    transform
}

/// The union of pieces whose common frame is rotated. With a number of decimals every position is
/// rounded in the surroundings, as by a program that exports them one by one.
fn part(pieces: &[Piece], turns: &[(usize, &str)], decimals: Option<usize>) -> Tree {
    let mut builder = Builder::new();
    let solids: Vec<SolidId> = pieces
        .iter()
        .map(|piece| {
            let own = turned(Transform::new(), &piece.turns);
            let at = piece.at.each_ref().map(|x| number(x));
            let transform = match decimals {
                None => turned(own.then(Transform::shift(at)), turns),
                Some(decimals) => {
                    let frame = turned(Transform::new(), turns);
                    let meant = frame.motion().apply_point(&at);
                    let written = meant.map(|x| number(&format!("{:.decimals$}", to_f64(&x))));
                    own.then(frame).then(Transform::shift(written))
                }
            };
            let solid = builder.primitive(piece.primitive.clone());
            builder.moved(solid, transform)
        })
        .collect();
    let part = builder.operation(Operation::Union, &solids);
    builder.finish(part).unwrap()
}

/// A rounded box: three blocks, with a cylinder along each edge and a sphere in each corner.
fn rounded_box() -> Vec<Piece> {
    let (x, y, z, r) = ("31.04", "18.56", "12.58", "4.38");
    let outer = |size: &str| {
        let r = number(r);
        format!("{}", to_f64(&(number(size) + &r + r)))
    };
    let (wide_x, wide_y, wide_z) = (outer(x), outer(y), outer(z));
    let minus = "-4.38";
    let mut pieces = vec![
        piece(block([x, y, &wide_z]), &[], ["0", "0", minus]),
        piece(block([&wide_x, y, z]), &[], [minus, "0", "0"]),
        piece(block([x, &wide_y, z]), &[], ["0", minus, "0"]),
    ];
    for a in ["0", x] {
        for b in ["0", y] {
            pieces.extend(["0", z].map(|c| piece(sphere(r), &[], [a, b, c])));
            pieces.push(piece(cylinder(r, z), &[], [a, b, "0"]));
        }
        for c in ["0", z] {
            pieces.push(piece(cylinder(r, y), &[(0, "-90")], [a, "0", c]));
        }
    }
    for b in ["0", y] {
        for c in ["0", z] {
            pieces.push(piece(cylinder(r, x), &[(1, "90")], ["0", b, c]));
        }
    }
    pieces
}

fn placed(tree: &Tree) -> Vec<&PlacedPrimitive> {
    tree.leaves().map(|(_, placed)| placed).collect()
}

/// Asserts that two trees are the same, and names the positions that differ.
#[track_caller]
fn assert_same(found: &Tree, meant: &Tree, what: &str) {
    let positions = |tree: &Tree| -> Vec<[f64; 3]> {
        let inverse = placed(tree)[0].motion.inverse();
        let local = |p: &&PlacedPrimitive| inverse.apply_vector(p.motion.offset());
        let all = placed(tree);
        all.iter().map(|p| local(p).map(|x| to_f64(&x))).collect()
    };
    for (k, (a, b)) in placed(found).iter().zip(placed(meant)).enumerate() {
        let [x, y] = [found, meant].map(|tree| positions(tree)[k]);
        assert!(**a == *b, "{what}: leaf {k} at {x:?}, meant {y:?}");
    }
}

fn count(recovery: &Recovery, kind: PrimitiveRelation) -> usize {
    let found = recovery.relations.iter().find(|r| r.kind == kind);
    found.map_or(0, |relation| relation.count)
}

/// The numbers of the part have two decimals, so that nothing shorter lies within the rounding.
#[test]
fn a_rounded_box_is_as_it_was_meant() {
    let pieces = rounded_box();
    let meant = part(&pieces, &ODD, None);
    for decimals in 4..=9 {
        let recovery = recovered(&part(&pieces, &ODD, Some(decimals))).unwrap();
        assert_same(&recovery.tree, &meant, &format!("{decimals} decimals"));
        assert_eq!(recovery.contradictory, 0);
        assert!(count(&recovery, PrimitiveRelation::Tangent) > 0);
        let most = 0.5 * 3f64.sqrt() * 10f64.powi(-(decimals as i32));
        assert!(recovery.furthest <= most && recovery.furthest > 0.1 * most);
        let (builder, solid) = recovery.to_builder().unwrap();
        assert!(builder.finish(solid).unwrap() == recovery.tree);
    }
    assert!(recovered(&meant).is_none());
}

/// A ball in a groove, at 30 degrees: the centre lies on the circle, exactly.
#[test]
fn balls_in_a_groove_lie_on_its_circle() {
    let (cosine, sine) = (0.75f64.sqrt(), 0.5);
    let at = |x: f64, y: f64| [format!("{x:.15}"), format!("{y:.15}"), "0".to_owned()];
    let balls = [1.0, -1.0].map(|side| Piece {
        primitive: sphere("3.04"),
        turns: Vec::new(),
        at: at(20.78 * cosine, side * 20.78 * sine),
    });
    let ring = piece(torus("20.78", "3.04"), &[], ["0", "0", "0"]);
    let hub = piece(cylinder("15", "8"), &[], ["0", "0", "-4"]);
    let pieces = [&[ring, hub][..], &balls].concat();
    let recovery = recovered(&part(&pieces, &ODD, Some(6))).unwrap();
    assert_eq!(count(&recovery, PrimitiveRelation::OnCircle), 2);
    let leaves = placed(&recovery.tree);
    let inverse = leaves[0].motion.inverse();
    for ball in &leaves[2..] {
        let [x, y, z] = inverse.apply_point(ball.motion.offset());
        assert!(z.is_zero());
        assert_eq!(&x * &x + &y * &y, number("20.78") * number("20.78"));
    }
}

/// The pipes on both ends of an elbow of 45 degrees: their axes touch the circle of the torus, in
/// two frames.
#[test]
fn pipes_fit_an_elbow() {
    let elbow = piece(torus("30", "5"), &[], ["0", "0", "0"]);
    let first = piece(cylinder("5", "40"), &[(0, "90")], ["30", "0", "0"]);
    // Along the tangent at 45 degrees.
    let other = turned(
        Transform::shift([number("30"), number("0"), number("0")]),
        &[(2, "45")],
    );
    let at = other
        .motion()
        .offset()
        .each_ref()
        .map(|x| format!("{:.15}", to_f64(x)));
    let second = Piece {
        primitive: cylinder("5", "40"),
        turns: vec![(0, "-90"), (2, "45")],
        at,
    };
    let recovery = recovered(&part(&[elbow, first, second], &ODD, Some(6))).unwrap();
    let leaves = placed(&recovery.tree);
    let inverse = leaves[0].motion.inverse();
    let [x, y, z] = inverse.apply_point(leaves[2].motion.offset());
    assert!(z.is_zero());
    assert_eq!(&x * &x + &y * &y, number("900"));
}

/// Steps of ten times the last digit are meant.
#[test]
fn deliberate_steps_stay() {
    let pieces = [
        piece(block(["20", "10", "5"]), &[], ["0", "0", "0"]),
        piece(block(["20", "10", "5"]), &[], ["20", "0", "0.00001"]),
        piece(block(["20", "10", "5"]), &[], ["40", "0.00002", "0"]),
        piece(cylinder("2", "5.00003"), &[], ["10", "5", "0"]),
    ];
    let meant = part(&pieces, &ODD, None);
    let recovery = recovered(&part(&pieces, &ODD, Some(6))).unwrap();
    let inverse = placed(&meant)[0].motion.inverse();
    for (a, b) in placed(&recovery.tree).iter().zip(placed(&meant)) {
        let [a, b] = [*a, b].map(|p| inverse.apply_point(p.motion.offset()));
        let off: Vec<f64> = (0..3).map(|i| to_f64(&(&a[i] - &b[i])).abs()).collect();
        // A step that no relation determines is as it was written.
        assert!(off.iter().all(|x| *x <= 0.9e-6), "{off:?}");
    }
}

/// A block 1e-5 longer than the gap: its ends cannot both be flush, and only one is.
#[test]
fn contradictory_relations_are_left_out() {
    let pieces = [
        piece(block(["10", "10", "10"]), &[], ["0", "0", "0"]),
        piece(block(["10.00001", "10", "5"]), &[], ["0", "0", "10"]),
        piece(block(["10", "10", "5"]), &[], ["0", "0", "-5"]),
    ];
    let recovery = recovered(&part(&pieces, &ODD, Some(5))).unwrap();
    // Along x one end of the long block against both others, along y two of each pair, along z one
    // of two pairs: 2 + 2 + 6 + 2.
    assert_eq!(count(&recovery, PrimitiveRelation::Coplanar), 12);
    assert_eq!(recovery.contradictory, 2);
    let leaves = placed(&recovery.tree);
    assert_eq!(leaves[1].primitive, block(["10.00001", "10", "5"]));
}

/// Coordinates that a person wrote, one of them a near miss.
#[test]
fn near_misses_of_a_person_stay() {
    let pieces = [
        piece(block(["4", "4", "4"]), &[], ["0", "0", "0"]),
        piece(block(["4", "4", "4"]), &[], ["4.0000001", "1.5", "0.25"]),
        piece(cylinder("1", "4"), &[], ["2.5", "1.25", "3.75"]),
        piece(sphere("1"), &[], ["6.5", "2.5", "3.125"]),
    ];
    assert!(recovered(&part(&pieces, &[], None)).is_none());
    assert!(recovered(&part(&pieces[..2], &ODD, Some(7))).is_none());
}

fn rounding(all: &[&str]) -> Option<Rounding> {
    let all: Vec<Rational> = all.iter().map(|x| number(x)).collect();
    Rounding::new(all.iter())
}

#[test]
fn digits_tell_the_rounding() {
    let six = [
        "0.123457",
        "1.23457",
        "12.3457",
        "123.457",
        "-98.7654",
        "0.0345678",
    ];
    assert_eq!(rounding(&six), Some(Rounding::SixDigits(7)));
    // Five decimals, of which OpenSCAD kept six digits.
    let twice = [
        "0.12346", "1.23457", "12.3457", "123.457", "-98.7654", "0.03457",
    ];
    assert_eq!(rounding(&twice), Some(Rounding::SixDigits(5)));
    let fixed = [
        "0.12346",
        "1.23457",
        "12.34568",
        "123.45679",
        "-98.76543",
        "0.03457",
    ];
    assert_eq!(rounding(&fixed), Some(Rounding::Decimals(5)));
    // With zeros and a few short numbers, too; not with few numbers, or most of them short.
    let some = [&fixed[..], &["0", "0", "0", "2.5", "10"]].concat();
    assert_eq!(rounding(&some), Some(Rounding::Decimals(5)));
    assert_eq!(rounding(&fixed[..5]), None);
    let short = [&fixed[..], &["1", "2", "3", "4", "5", "6"]].concat();
    assert_eq!(rounding(&short), None);
    // Three decimals are a person's, and so are numbers next to short ones.
    assert_eq!(
        rounding(&["0.123", "1.234", "2.345", "3.456", "4.567", "5.678"]),
        None
    );
    let near = [
        "1.0000001",
        "2.0000003",
        "-0.9999999",
        "4.5000001",
        "3.0000002",
        "7.0000001",
    ];
    assert_eq!(rounding(&near), None);
}

#[test]
fn the_error_is_half_a_unit_of_the_last_digit() {
    let error = |rounding: Rounding, x: &str| rounding.error(&number(x));
    assert_eq!(error(Rounding::Decimals(5), "12.34568"), 0.5e-5);
    assert_eq!(error(Rounding::SixDigits(7), "12.3457"), 0.5e-4);
    assert_eq!(error(Rounding::SixDigits(7), "0.0123457"), 0.5e-7);
    assert_eq!(error(Rounding::SixDigits(5), "0.01235"), 0.5e-5);
    assert_eq!(error(Rounding::SixDigits(7), "0"), 0.5e-5);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Whatever is recovered, no primitive moves further than the rounding.
    #[test]
    fn nothing_moves_further_than_the_rounding(
        places in prop::collection::vec((0usize..4, prop::array::uniform3(-40i32..40)), 3..10),
        decimals in 4usize..=9,
    ) {
        let kinds = [block(["5", "10", "7.5"]), cylinder("2.5", "10"), sphere("5"), torus("7.5", "2.5")];
        let at = |k: i32| format!("{}", f64::from(k) * 2.5);
        let pieces: Vec<Piece> = places.iter().map(|(kind, place)| Piece {
            primitive: kinds[*kind].clone(),
            turns: Vec::new(),
            at: place.map(at),
        }).collect();
        let written = part(&pieces, &ODD, Some(decimals));
        if let Some(recovery) = recovered(&written) {
            let most = 0.5 * 10f64.powi(-(decimals as i32)) * 3.0;
            prop_assert!(recovery.furthest <= most, "{} of {}", recovery.furthest, most);
            for (a, b) in written.leaves().zip(recovery.tree.leaves()) {
                prop_assert_eq!(&a.1.primitive, &b.1.primitive);
            }
        }
    }
}
