//! The tree of a combination: a list `{op left right}` or `{l name}` or `{l name matrix}`.

use super::super::error::SpannedError;
use super::Object;
use super::keywords::{Mark, Marks, Word};

/// An operator of a tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Operator {
    Union,
    Intersection,
    Difference,
    Exclusive,
}

/// A member or an operator of a tree, in the order in which they are evaluated.
#[derive(Debug)]
pub(super) enum Item<'a> {
    Leaf {
        name: Word<'a>,
        matrix: Option<Word<'a>>,
    },
    /// On the two before it.
    Operator(Operator),
}

/// The components of a combination in postfix order: an operator follows its two operands.
#[derive(Debug, Default)]
pub(super) struct Combination<'a> {
    pub(super) items: Vec<Item<'a>>,
}

/// A list that is not closed yet.
struct Open<'a> {
    start: usize,
    words: Vec<Word<'a>>,
    /// The number of its operands.
    operands: usize,
}

const EXPECTED: &str = "a member `l NAME` or an operation: `u`, `n`, `-` or `^` and two operands";

impl<'a> Combination<'a> {
    /// The tree of an object; without a tree it is empty.
    pub(super) fn new(object: &Object<'a>) -> Result<Self, SpannedError> {
        let mut combination = Self::default();
        let Some(tree) = object.attribute("tree") else {
            return Ok(combination);
        };
        if tree.text.trim().is_empty() {
            return Ok(combination);
        }
        let mut open = vec![Open::at(tree.span.start)];
        let mut ahead = Marks::new(tree);
        loop {
            match ahead.next()? {
                Mark::Open(at) => open.push(Open::at(at)),
                Mark::Word(word) => {
                    if let Some(list) = open.last_mut() {
                        list.words.push(word);
                    }
                }
                Mark::Close(at) => {
                    let Some(list) = open.pop() else { continue };
                    combination.close(tree, &list, at, open.last_mut())?;
                }
                Mark::End => {
                    if let Some(list) = open.pop() {
                        combination.close(tree, &list, tree.span.end, None)?;
                    }
                    return Ok(combination);
                }
            }
        }
    }

    /// The end of a list: a name or a matrix in braces, a member, or an operation.
    fn close(
        &mut self,
        tree: &Word<'a>,
        list: &Open<'a>,
        end: usize,
        around: Option<&mut Open<'a>>,
    ) -> Result<(), SpannedError> {
        let whole = tree.part(list.start..end);
        if let Some(outer) = around {
            if outer.words.first().is_some_and(|word| word.text == "l") {
                outer.words.push(whole);
                return Ok(());
            }
            outer.operands += 1;
        }
        let operator = match list.words.first().map(|word| word.text) {
            Some("l") => return self.leaf(&whole, list),
            Some("u") => Operator::Union,
            Some("n" | "+") => Operator::Intersection,
            Some("-") => Operator::Difference,
            Some("^") => Operator::Exclusive,
            _ => return Err(list.words.first().unwrap_or(&whole).unexpected(EXPECTED)),
        };
        if list.operands != 2 || list.words.len() != 1 {
            return Err(whole.unexpected("an operator and its two operands"));
        }
        self.items.push(Item::Operator(operator));
        Ok(())
    }

    fn leaf(&mut self, whole: &Word<'a>, list: &Open<'a>) -> Result<(), SpannedError> {
        let (name, matrix) = match list.words.as_slice() {
            [_, name] => (name, None),
            [_, name, matrix] => (name, Some(matrix.clone())),
            _ => return Err(whole.unexpected("`l NAME`, perhaps with a matrix")),
        };
        let name = name.clone();
        self.items.push(Item::Leaf { name, matrix });
        Ok(())
    }

    /// The names of its members, in the order in which they are evaluated.
    pub(super) fn leaves(&self) -> impl Iterator<Item = &Word<'a>> {
        self.items.iter().filter_map(|item| match item {
            Item::Leaf { name, .. } => Some(name),
            Item::Operator(_) => None,
        })
    }
}

impl Open<'_> {
    fn at(start: usize) -> Self {
        Self {
            start,
            words: Vec::new(),
            operands: 0,
        }
    }
}
