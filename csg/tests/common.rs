//! What several of these tests need.

use premio_csg::builder::{Builder, SolidId};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::primitive::Primitive;
use premio_csg::ray_casting::RayOracle;
use premio_csg::reader::{Format, ReadOptions, read};
use premio_csg::transform::{Transform, TransformStep};
use premio_csg::tree::Tree;
use premio_kernel::number::rational::Rational;

/// A whole number.
pub fn n(x: i32) -> Rational {
    Rational::from(x)
}

/// A block with a corner at the origin.
pub fn block(builder: &mut Builder, size: [i32; 3]) -> SolidId {
    builder.primitive(Primitive::block(size.map(n)).unwrap())
}

/// A solid translated by whole numbers.
pub fn shifted(builder: &mut Builder, part: SolidId, by: [i32; 3]) -> SolidId {
    moved(builder, part, TransformStep::Shift(by.map(n)))
}

/// A solid rotated about (1, 2, 2), which has the length 3.
pub fn turned(builder: &mut Builder, part: SolidId, degrees: i32) -> SolidId {
    rotated(builder, part, [1, 2, 2], degrees)
}

/// A solid rotated about an axis through the origin.
pub fn rotated(builder: &mut Builder, part: SolidId, axis: [i32; 3], degrees: i32) -> SolidId {
    let (axis, degrees) = (axis.map(n), n(degrees));
    moved(builder, part, TransformStep::Turn { axis, degrees })
}

fn moved(builder: &mut Builder, part: SolidId, step: TransformStep) -> SolidId {
    let mut moves = Transform::new();
    moves.push(step).unwrap();
    builder.moved(part, moves)
}

/// The tree of a solid.
pub fn tree_of(make: impl FnOnce(&mut Builder) -> SolidId) -> Tree {
    let mut builder = Builder::new();
    let part = make(&mut builder);
    builder.finish(part).unwrap()
}

/// The tree of a description.
#[track_caller]
pub fn tree(text: &str, format: Format) -> Tree {
    match read("part", text.as_bytes(), format, &ReadOptions::default()) {
        Ok(description) => description.tree,
        Err(error) => panic!("{error}\n{text}"),
    }
}

/// The boundary of a tree, which is valid.
pub fn evaluated(tree: &Tree) -> Evaluation {
    let known = evaluate(tree, &EvaluationOptions::default()).unwrap();
    assert_eq!(known.violations(), []);
    known
}

/// The boundary of a tree, which is valid, has a volume, and agrees with rays.
#[track_caller]
pub fn with_volume(tree: &Tree, volume: f64) -> Evaluation {
    let known = evaluated(tree);
    let found = known.mass().volume;
    let off = (found - volume).abs();
    assert!(off <= volume * 1e-11, "{found} and not {volume}");
    let rays = RayOracle::new(tree).volume(4096, 1);
    let deviation = rays.deviation(volume, 1e-9);
    assert!(deviation < 6.0, "{rays:?} and not {volume}");
    known
}
