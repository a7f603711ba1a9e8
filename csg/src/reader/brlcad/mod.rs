//! `.asc`: BRL-CAD's text database, version 5: Tcl commands that define solids and combinations of
//! them. Lengths are in millimetres.
//!
//! Objects that are not part of the requested part are not examined, except for their names.

mod combination;
mod keywords;
mod matrix;
mod solids;

use std::collections::HashMap;
use std::ops::Range;

use premio_kernel::number::rational::Rational;

use self::combination::{Combination, Item};
use self::keywords::{Word, commands};
use self::solids::{Solid, Unsupported, UnsupportedWords};
use super::error::SpannedError;
use super::frame::Vector;
use super::notes::{Notes, Remarks};
use super::number::{bad_length, literal};
use super::rigid_fit::F64_DIGITS;
use super::{PartPlace, Program, ReadOptions, StandaloneText};
use crate::builder::{Builder, SolidId};
use crate::primitive::UnboundedPrimitive;
use crate::tree::Operation;
use premio_text::LineColumn;
use premio_text::escape::quote;

pub(super) fn read(source: &str, options: &ReadOptions) -> Result<Program, SpannedError> {
    if source.starts_with("I ") {
        let found = "a database of BRL-CAD's version 4";
        return Err(SpannedError::input(0..1, found, "one of version 5")
            .help("`asc2g` and then `g2asc` of a newer BRL-CAD make one of the other"));
    }
    let database = Database::new(source)?;
    let mut reader = Reader {
        database: &database,
        builder: Builder::new(),
        // Only numbers with all digits of an f64 are replaced by exact ones.
        notes: Notes::of_digits(0.0),
        parts: HashMap::new(),
    };
    let top = match &options.part {
        Some(name) => database.find(name, source.len())?,
        None => database.top(source, &mut reader.notes)?,
    };
    let part = reader.part(top)?;
    let Remarks { digits, notes } = reader.notes.finish();
    Ok(Program {
        builder: reader.builder,
        part,
        digits,
        notes,
        standalone: StandaloneText::AsRead,
        included: Vec::new(),
        place: PartPlace::new(database.objects[top].name.span.clone()),
    })
}

/// An object defined under a name.
#[derive(Debug)]
struct Object<'a> {
    name: Word<'a>,
    kind: Word<'a>,
    /// Alternating attribute names and values.
    attributes: Vec<Word<'a>>,
}

impl<'a> Object<'a> {
    fn is_combination(&self) -> bool {
        self.kind.text == "comb"
    }

    fn attribute(&self, name: &str) -> Option<&Word<'a>> {
        let mut pairs = self.attributes.chunks_exact(2);
        pairs.find(|pair| pair[0].text == name).map(|pair| &pair[1])
    }

    fn require(&self, name: &str) -> Result<&Word<'a>, SpannedError> {
        self.attribute(name).ok_or_else(|| {
            let kind = self.kind.text;
            let found = format!("the {kind} {} without `{name}`", quote(self.name.text));
            let expected = format!("the attribute `{name}`");
            SpannedError::input(self.name.span.clone(), found, expected)
        })
    }

    fn number(&self, name: &str) -> Result<Rational, SpannedError> {
        number(self.require(name)?)
    }

    fn vectors<const N: usize>(&self, names: [&str; N]) -> Result<[Vector; N], SpannedError> {
        let all: Result<Vec<Vector>, SpannedError> = names
            .iter()
            .map(|name| vector(self.require(name)?))
            .collect();
        // One vector for each name.
        Ok(all?
            .try_into()
            .unwrap_or_else(|_| std::array::from_fn(|_| Vector::default())))
    }
}

fn number(word: &Word<'_>) -> Result<Rational, SpannedError> {
    literal(word.text, word.span.clone())
}

fn vector(word: &Word<'_>) -> Result<Vector, SpannedError> {
    let numbers: Result<Vec<Rational>, SpannedError> = word.list()?.iter().map(number).collect();
    let wrong = |_| word.unexpected("three numbers");
    numbers?.try_into().map_err(wrong)
}

/// All objects of a text.
#[derive(Debug)]
struct Database<'a> {
    objects: Vec<Object<'a>>,
    names: HashMap<&'a str, usize>,
}

impl<'a> Database<'a> {
    fn new(source: &'a str) -> Result<Self, SpannedError> {
        let mut database = Self {
            objects: Vec::new(),
            names: HashMap::new(),
        };
        for command in commands(source)? {
            match command[0].text {
                "put" => database.put(source, &command)?,
                // Colours and units do not change a solid: lengths are millimetres.
                "title" | "units" | "attr" | "color" => {}
                word => {
                    let found = format!("the unknown command {}", quote(word));
                    let known = ["put", "title", "units", "attr", "color"];
                    let expected = format!("one of `{}`", known.join("`, `"));
                    let fault = SpannedError::input(command[0].span.clone(), found, expected);
                    return Err(fault.suggest(word, known));
                }
            }
        }
        Ok(database)
    }

    fn put(&mut self, source: &str, command: &[Word<'a>]) -> Result<(), SpannedError> {
        let [_, name, kind, attributes @ ..] = command else {
            let last = &command[command.len() - 1];
            let expected = "`put NAME TYPE`, and the attributes of the object";
            return Err(last.unexpected(expected));
        };
        if attributes.len() % 2 == 1 {
            let last = &attributes[attributes.len() - 1];
            return Err(last.unexpected("an attribute with its value"));
        }
        if let Some(&earlier) = self.names.get(name.text) {
            let start = self.objects[earlier].name.span.start;
            let line = LineColumn::new(source.as_bytes(), start).line;
            let found = format!("{}, which is put already", quote(name.text));
            return Err(SpannedError::input(name.span.clone(), found, "a new name")
                .help(format!("it was put on line {line}")));
        }
        self.names.insert(name.text, self.objects.len());
        self.objects.push(Object {
            name: name.clone(),
            kind: kind.clone(),
            attributes: attributes.to_vec(),
        });
        Ok(())
    }

    fn find(&self, name: &str, end: usize) -> Result<usize, SpannedError> {
        self.names.get(name).copied().ok_or_else(|| {
            let found = format!("no object called {}", quote(name));
            let fault = SpannedError::input(end..end, found, "the name of an object in the file");
            fault.suggest(name, self.sorted())
        })
    }

    /// All names, sorted, so that the same one of several similar names is always proposed.
    fn sorted(&self) -> Vec<&'a str> {
        let mut names: Vec<&str> = self.names.keys().copied().collect();
        names.sort_unstable();
        names
    }

    /// The only object that no other contains: a combination, if there is one at the top.
    fn top(&self, source: &str, notes: &mut Notes) -> Result<usize, SpannedError> {
        let mut held = vec![false; self.objects.len()];
        for object in self.objects.iter().filter(|object| object.is_combination()) {
            for leaf in Combination::new(object)?.leaves() {
                if let Some(&index) = self.names.get(leaf.text) {
                    held[index] = true;
                }
            }
        }
        let free: Vec<usize> = (0..held.len()).filter(|&index| !held[index]).collect();
        let (combinations, others): (Vec<usize>, Vec<usize>) = free
            .into_iter()
            .partition(|&index| self.objects[index].is_combination());
        match (combinations.as_slice(), others.as_slice()) {
            (&[top], []) | (&[], &[top]) => Ok(top),
            (&[top], left @ [first, ..]) => {
                let name = quote(self.objects[top].name.text);
                let rest = self.list(left);
                let text = format!("{name} is read; it does not contain {rest}");
                notes.add(text, self.objects[*first].name.span.clone());
                Ok(top)
            }
            (&[], &[]) => Err(self.no_top(source)),
            (several @ [_, second, ..], _) | ([], several @ [_, second, ..]) => {
                let found = format!(
                    "several objects that no other contains: {}",
                    self.list(several)
                );
                let span = self.objects[*second].name.span.clone();
                let expected = "one, or `--part` and the name of the one to read";
                Err(SpannedError::input(span, found, expected))
            }
        }
    }

    fn no_top(&self, source: &str) -> SpannedError {
        let end = source.len();
        match self.objects.first() {
            None => SpannedError::input(end..end, "no object in the file", "a `put` of a solid"),
            Some(first) => {
                let found = "combinations that contain one another";
                let expected = "an object that no other contains";
                SpannedError::input(first.name.span.clone(), found, expected)
            }
        }
    }

    /// Names for a message, the first of many.
    fn list(&self, objects: &[usize]) -> String {
        const SHOWN: usize = 8;
        let names = objects
            .iter()
            .take(SHOWN)
            .map(|&index| quote(self.objects[index].name.text));
        let shown = names.collect::<Vec<_>>().join(", ");
        match objects.len().saturating_sub(SHOWN) {
            0 => shown,
            more => format!("{shown} and {more} more"),
        }
    }
}

/// Creates the part of each object once.
struct Reader<'a> {
    database: &'a Database<'a>,
    builder: Builder,
    notes: Notes,
    /// The parts created; `None` for a combination whose members are being created.
    parts: HashMap<usize, Option<SolidId>>,
}

/// A pending task.
enum Task<'a> {
    /// Create an object.
    Enter(usize),
    /// Combine the members of one, which exist.
    Combine(usize, Combination<'a>),
}

impl<'a> Reader<'a> {
    fn part(&mut self, top: usize) -> Result<SolidId, SpannedError> {
        let mut tasks = vec![Task::Enter(top)];
        while let Some(task) = tasks.pop() {
            match task {
                Task::Enter(index) if self.parts.contains_key(&index) => {}
                Task::Enter(index) => self.enter(index, &mut tasks)?,
                Task::Combine(index, combination) => {
                    let part = self.combine(&combination)?;
                    self.parts.insert(index, Some(part));
                }
            }
        }
        Ok(self
            .parts
            .get(&top)
            .copied()
            .flatten()
            .unwrap_or(SolidId::EMPTY))
    }

    fn enter(&mut self, index: usize, tasks: &mut Vec<Task<'a>>) -> Result<(), SpannedError> {
        let object = &self.database.objects[index];
        if !object.is_combination() {
            let part = self.solid(object)?;
            self.parts.insert(index, Some(part));
            return Ok(());
        }
        let combination = Combination::new(object)?;
        self.parts.insert(index, None);
        let mut members = Vec::new();
        for leaf in combination.leaves() {
            let member = self.member(leaf)?;
            if self.parts.get(&member) == Some(&None) {
                let found = format!("{}, which contains itself", quote(leaf.text));
                return Err(SpannedError::input(
                    leaf.span.clone(),
                    found,
                    "no cycle of combinations",
                ));
            }
            members.push(member);
        }
        tasks.push(Task::Combine(index, combination));
        tasks.extend(members.into_iter().rev().map(Task::Enter));
        Ok(())
    }

    fn member(&self, leaf: &Word<'_>) -> Result<usize, SpannedError> {
        self.database.names.get(leaf.text).copied().ok_or_else(|| {
            let found = format!("the unknown name {}", quote(leaf.text));
            let fault = SpannedError::input(
                leaf.span.clone(),
                found,
                "the name of an object in the file",
            );
            fault.suggest(leaf.text, self.database.sorted())
        })
    }

    fn combine(&mut self, combination: &Combination<'a>) -> Result<SolidId, SpannedError> {
        let mut parts: Vec<SolidId> = Vec::new();
        for item in &combination.items {
            match item {
                Item::Leaf { name, matrix } => {
                    let part = self.parts.get(&self.member(name)?).copied().flatten();
                    // Members are created before the combination that contains them.
                    let part = part.unwrap_or(SolidId::EMPTY);
                    parts.push(match matrix {
                        Some(word) => self.placed(part, word)?,
                        None => part,
                    });
                }
                Item::Operator(operator) => {
                    let (right, left) = (parts.pop(), parts.pop());
                    let pair = [left, right].map(|part| part.unwrap_or(SolidId::EMPTY));
                    parts.push(operator.apply(&mut self.builder, pair));
                }
            }
        }
        Ok(parts.pop().unwrap_or(SolidId::EMPTY))
    }

    fn placed(&mut self, part: SolidId, word: &Word<'_>) -> Result<SolidId, SpannedError> {
        let matrix = matrix::Placed::new(word)?;
        self.replaced(matrix.residual, word.span.clone());
        let scaled = self.builder.scaled(part, matrix.factor);
        let part = match matrix.mirrored {
            true => self.builder.mirrored_y(scaled),
            false => scaled,
        };
        Ok(self.builder.moved(part, matrix.moves))
    }

    /// Notes that vectors or a matrix were replaced, unless only by f64 rounding.
    fn replaced(&mut self, residual: f64, span: Range<usize>) {
        if residual > F64_DIGITS {
            self.notes.snapped(residual, span);
        }
    }

    fn solid(&mut self, object: &Object<'_>) -> Result<SolidId, SpannedError> {
        if object.kind.text == "half" {
            let [normal] = object.vectors(["N"])?;
            let half_space = UnboundedPrimitive::half_space(normal, object.number("d")?);
            let half_space =
                half_space.map_err(|error| bad_length(error, None, object.kind.span.clone()))?;
            return Ok(self.builder.unbounded(half_space));
        }
        let solid = self.shape(object)?.map_err(|reason| {
            let UnsupportedWords { found, expected } = reason.words();
            let found = format!("{}, {found}", quote(object.name.text));
            SpannedError::input(object.kind.span.clone(), found, expected)
        })?;
        self.replaced(solid.residual, object.name.span.clone());
        let part = self.builder.primitive(solid.primitive);
        Ok(self.builder.moved(part, solid.moves))
    }

    fn shape(&self, object: &Object<'_>) -> Result<Result<Solid, Unsupported>, SpannedError> {
        const KNOWN: [&str; 7] = ["arb8", "ell", "half", "sph", "tgc", "rec", "tor"];
        Ok(match object.kind.text {
            "ell" | "sph" => solids::ellipsoid(object.vectors(["V", "A", "B", "C"])?),
            "tgc" | "rec" => solids::cone(object.vectors(["V", "H", "A", "B", "C", "D"])?),
            "tor" => {
                let axis = object.vectors(["V", "H"])?;
                solids::torus(axis, object.number("r_a")?, object.number("r_h")?)
            }
            "arb8" => {
                let names = ["V1", "V2", "V3", "V4", "V5", "V6", "V7", "V8"];
                solids::polyhedron(&object.vectors(names)?)
            }
            kind => {
                let name = quote(object.name.text);
                let found = format!("{name}, an object of type {}", quote(kind));
                let expected =
                    format!("`comb` or a solid that is exact here: {}", KNOWN.join(", "));
                return Err(SpannedError::input(
                    object.kind.span.clone(),
                    found,
                    expected,
                ));
            }
        })
    }
}

impl combination::Operator {
    fn apply(self, builder: &mut Builder, pair: [SolidId; 2]) -> SolidId {
        let [left, right] = pair;
        match self {
            Self::Union => builder.operation(Operation::Union, &pair),
            Self::Intersection => builder.operation(Operation::Intersection, &pair),
            Self::Difference => builder.operation(Operation::Difference, &pair),
            // The points in exactly one of the two.
            Self::Exclusive => {
                let one = builder.operation(Operation::Difference, &pair);
                let other = builder.operation(Operation::Difference, &[right, left]);
                builder.operation(Operation::Union, &[one, other])
            }
        }
    }
}
