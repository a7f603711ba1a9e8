use super::*;

fn shift(x: i32, y: i32, z: i32) -> Transform {
    Transform::shift([x, y, z].map(Rational::from))
}

fn ball(b: &mut Builder) -> SolidId {
    b.primitive(Primitive::sphere(Rational::ONE).unwrap())
}

/// The tree as brackets, each leaf shown by the x of its position.
fn text(tree: &Tree) -> String {
    let show = |id: NodeId, below: &[String]| match &tree[id] {
        TreeNode::Leaf(placed) => placed.motion.offset()[0].to_string(),
        TreeNode::Operation { op, children } => {
            let sign = match op {
                Operation::Union => '+',
                Operation::Intersection => '*',
                Operation::Difference => '-',
            };
            let parts: Vec<_> = children.iter().map(|c| below[c.index()].as_str()).collect();
            format!("{sign}({})", parts.join(" "))
        }
    };
    let mut texts = vec![String::new(); tree.nodes().len()];
    for index in (0..texts.len()).rev() {
        texts[index] = show(NodeId(index), &texts);
    }
    texts.first().cloned().unwrap_or_default()
}

fn balls<const N: usize>(b: &mut Builder) -> [SolidId; N] {
    std::array::from_fn(|i| {
        let part = ball(b);
        b.moved(part, shift(i as i32, 0, 0))
    })
}

#[test]
fn empty_children_drop_out() {
    use Operation::*;
    let mut b = Builder::new();
    let [a, c] = balls(&mut b);
    let none = SolidId::EMPTY;
    assert_eq!(b.operation(Union, &[none, a, none]), a);
    assert_eq!(b.operation(Intersection, &[a, none]), none);
    assert_eq!(b.operation(Difference, &[none, a]), none);
    assert_eq!(b.operation(Difference, &[a, none]), a);
    assert_eq!(b.operation(Difference, &[]), none);
    assert_eq!(b.operation(Intersection, &[]), none);
    let part = b.operation(Difference, &[a, none, c]);
    assert_eq!(text(&b.finish(part).unwrap()), "-(0 1)");
    assert!(b.finish(none).unwrap().is_empty());
}

#[test]
fn chains_are_flattened() {
    use Operation::*;
    let mut b = Builder::new();
    let [p, q, r, s] = balls(&mut b);
    for (op, sign) in [(Union, '+'), (Intersection, '*'), (Difference, '-')] {
        let inner = b.operation(op, &[p, q]);
        let inner = b.moved(inner, shift(10, 0, 0));
        let outer = b.operation(op, &[inner, r]);
        assert_eq!(text(&b.finish(outer).unwrap()), format!("{sign}(10 11 2)"));
    }
    let rest = b.operation(Union, &[q, r, s]);
    let part = b.operation(Difference, &[p, rest]);
    assert_eq!(text(&b.finish(part).unwrap()), "-(0 1 2 3)");
    let inner = b.operation(Difference, &[q, r]);
    let part = b.operation(Difference, &[p, inner]);
    assert_eq!(text(&b.finish(part).unwrap()), "-(0 -(1 2))");
}

#[test]
fn mirrors_reach_the_leaves() {
    let mut b = Builder::new();
    let size = [2, 3, 4].map(Rational::from);
    let block = b.primitive(Primitive::block(size).unwrap());
    let at = b.moved(block, shift(1, 10, 1));
    let mirrored = b.mirrored_y(at);
    let tree = b.finish(mirrored).unwrap();
    let (_, placed) = tree.leaves().next().unwrap();
    assert_eq!(&placed.motion, shift(1, -13, 1).motion());
    let twice = b.mirrored_y(mirrored);
    let tree = b.finish(twice).unwrap();
    let (_, placed) = tree.leaves().next().unwrap();
    assert_eq!(&placed.motion, shift(1, 10, 1).motion());
}

#[test]
fn what_is_scaled_is_larger_where_it_lies() {
    let mut b = Builder::new();
    let size = [2, 3, 4].map(Rational::from);
    let block = b.primitive(Primitive::block(size).unwrap());
    let at = b.moved(block, shift(1, 10, 1));
    let twice = b.scaled(at, 2.into());
    let mirrored = b.mirrored_y(twice);
    let part = b.moved(mirrored, shift(0, 0, 7));
    let tree = b.finish(part).unwrap();
    let (_, placed) = tree.leaves().next().unwrap();
    let expected = Primitive::block([4, 6, 8].map(Rational::from)).unwrap();
    assert_eq!(placed.primitive, expected);
    assert_eq!(&placed.motion, shift(2, -26, 9).motion());
}

#[test]
fn deep_trees_need_no_stack() {
    let mut b = Builder::new();
    let mut part = ball(&mut b);
    for i in 0..100_000 {
        let next = ball(&mut b);
        let op = if i % 2 == 0 {
            Operation::Union
        } else {
            Operation::Intersection
        };
        part = b.operation(op, &[next, part]);
        part = b.moved(part, shift(1, 0, 0));
    }
    let tree = b.finish(part).unwrap();
    assert_eq!(tree.leaves().count(), 100_001);
    assert_eq!(tree.nodes().len(), 200_001);
}

#[test]
fn solids_of_another_builder_are_refused() {
    let (mut ours, mut theirs) = (Builder::new(), Builder::new());
    let known = ball(&mut ours);
    // The same place in both builders.
    let foreign = ball(&mut theirs);
    assert_ne!(known, foreign);
    let union = ours.operation(Operation::Union, &[known, foreign]);
    let nested = ours.moved(union, shift(1, 0, 0));
    let only = ours.operation(Operation::Union, &[foreign]);
    let moved = ours.moved(foreign, shift(1, 0, 0));
    let far = SolidId(Some(Slot {
        builder: theirs.identity,
        index: 1000,
    }));
    for part in [foreign, far, union, nested, only, moved] {
        assert_eq!(ours.finish(part), Err(TreeError::ForeignSolid), "{part:?}");
        let written = crate::writer::write(&ours, part, crate::reader::Format::Padl);
        assert_eq!(written, Err(crate::writer::WriteError::ForeignSolid));
    }
    // Operands that do not matter are not examined, and earlier parts do not change.
    let none = ours.operation(Operation::Intersection, &[SolidId::EMPTY, foreign]);
    assert!(ours.finish(none).unwrap().is_empty());
    assert_eq!(text(&ours.finish(known).unwrap()), "0");
}

#[test]
fn an_imported_solid_is_the_same_tree() {
    let mut theirs = Builder::new();
    let [a, b] = balls(&mut theirs);
    let pair = theirs.operation(Operation::Difference, &[a, b]);
    let pair = theirs.moved(pair, shift(5, 0, 0));
    let pair = theirs.mirrored_y(pair);
    let mut ours = Builder::new();
    let [_, c] = balls(&mut ours);
    let moved = ours.moved(c, shift(7, 0, 0));
    let copy = ours.import(&theirs, pair).unwrap();
    assert_eq!(ours.finish(copy), theirs.finish(pair));
    assert_eq!(text(&ours.finish(moved).unwrap()), "8");
    assert_eq!(ours.import(&theirs, copy), Err(TreeError::ForeignSolid));
    let format = crate::reader::Format::Padl;
    let written = |builder, part| crate::writer::write(builder, part, format);
    assert_eq!(written(&ours, copy), written(&theirs, pair));
}

#[test]
fn copies_have_a_limit() {
    let mut b = Builder::new();
    let mut part = ball(&mut b);
    for _ in 0..200 {
        part = b.operation(Operation::Union, &[part, part]);
    }
    assert_eq!(
        b.finish(part),
        Err(TreeError::TooManyLeaves { leaves: u64::MAX })
    );
}

#[test]
fn numbers_have_a_limit() {
    let mut b = Builder::new();
    let mut part = ball(&mut b);
    let mut turn = Transform::new();
    let (axis, degrees) = ([0, 0, 1].map(Rational::from), 7.into());
    turn.push(TransformStep::Turn { axis, degrees }).unwrap();
    for _ in 0..2000 {
        part = b.moved(part, turn.clone());
    }
    assert!(matches!(
        b.finish(part),
        Err(TreeError::NumbersTooLong { .. })
    ));
}
