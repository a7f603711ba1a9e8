//! `.csg`: OpenSCAD's flattened output.
//!
//! Blocks are frames on an explicit stack. A plane figure becomes a solid at once, by the extrusion
//! around it, so only solids are combined.

mod arguments;
mod extrusion;
mod figures;
mod hull;
mod measures;
mod nodes;
mod plane;
mod shapes;

use self::arguments::Arguments;
use self::hull::{Around, HullOperand};
use self::measures::{MovedPrimitive, Shape};
use self::nodes::{Kind, Node};
use super::error::SpannedError;
use super::lexer::{Cursor, Dialect, Lexeme, Token};
use super::notes::{Notes, Remarks};
use super::{Program, ReadOptions};
use crate::builder::{Builder, SolidId};
use premio_text::LineColumn;

pub(super) fn read(source: &str, options: &ReadOptions) -> Result<Program, SpannedError> {
    let cursor = Cursor::new(source, Dialect::Scad)?;
    let mut reader = Reader::new(cursor, options.smooth);
    let part = reader.file()?;
    let Remarks { digits, notes } = reader.notes.finish();
    Ok(Program {
        builder: reader.builder,
        part,
        digits,
        notes,
        span: 0..source.len(),
    })
}

/// The relative rounding of the six digits that OpenSCAD writes.
const SIX_DIGITS: f64 = 1e-6;

/// A block that is still open.
struct Frame {
    kind: Kind,
    around: Around,
    children: Vec<SolidId>,
    /// The operands of the hull that this is, or is inside.
    operands: Vec<HullOperand>,
    open: Lexeme,
    /// The child is one statement, without braces.
    single: bool,
    /// Whether the block contributes to the solid.
    live: bool,
    /// Whether this is the subtree marked with `!`.
    root: bool,
}

/// A node with the marks before it.
struct MarkedNode {
    marks: Marks,
    name: Lexeme,
}

/// The marks before a node.
#[derive(Clone, Copy, Default)]
struct Marks {
    /// `*` or `%`: not part of the solid.
    dropped: bool,
    /// `!`: the only part of the solid.
    root: bool,
}

struct Reader<'a> {
    cursor: Cursor<'a>,
    builder: Builder,
    smooth: bool,
    frames: Vec<Frame>,
    notes: Notes,
    marked_root: Option<SolidId>,
}

impl<'a> Reader<'a> {
    fn new(cursor: Cursor<'a>, smooth: bool) -> Self {
        Self {
            cursor,
            builder: Builder::new(),
            smooth,
            frames: Vec::new(),
            notes: Notes::of_digits(SIX_DIGITS),
            marked_root: None,
        }
    }

    fn file(&mut self) -> Result<SolidId, SpannedError> {
        // If a subtree is marked `!`, everything outside it is ignored.
        let live = !self.cursor.contains('!');
        let open = self.cursor.peek();
        self.frames.push(Frame {
            kind: Kind::Union,
            around: Around::Nothing,
            children: Vec::new(),
            operands: Vec::new(),
            open,
            single: false,
            live,
            root: false,
        });
        loop {
            let lexeme = self.cursor.next();
            match lexeme.token {
                Token::End => return self.end_of_file(lexeme),
                Token::Symbol('}') => self.close_block(lexeme)?,
                Token::Symbol(';') => self.stray_semicolon()?,
                _ => self.statement(lexeme)?,
            }
        }
    }

    fn end_of_file(&mut self, end: Lexeme) -> Result<SolidId, SpannedError> {
        match (self.frames.pop(), self.frames.is_empty()) {
            (Some(file), true) => {
                let part = file.kind.combine(&mut self.builder, &file.children);
                Ok(self.marked_root.unwrap_or(part))
            }
            (Some(block), false) => {
                let expected = if block.single { "a node or `;`" } else { "`}`" };
                let start = block.open.span().start;
                let source = self.cursor.source().as_bytes();
                let line = LineColumn::new(source, start).line;
                Err(self
                    .cursor
                    .unexpected(end, expected)
                    .help(format!("the block opened on line {line} is not closed")))
            }
            (None, _) => Ok(SolidId::EMPTY),
        }
    }

    fn close_block(&mut self, brace: Lexeme) -> Result<(), SpannedError> {
        let closes = self.frames.len() > 1 && self.frames.last().is_some_and(|f| !f.single);
        if !closes {
            return Err(self.cursor.unexpected(brace, "a node"));
        }
        self.close_frame()?;
        self.close_singles()
    }

    /// A single `;`: an empty statement, which may also be the whole of a block without braces.
    fn stray_semicolon(&mut self) -> Result<(), SpannedError> {
        self.close_singles()
    }

    fn close_singles(&mut self) -> Result<(), SpannedError> {
        while self.frames.len() > 1 && self.frames.last().is_some_and(|f| f.single) {
            self.close_frame()?;
        }
        Ok(())
    }

    fn close_frame(&mut self) -> Result<(), SpannedError> {
        let Some(frame) = self.frames.pop() else {
            return Ok(());
        };
        if !frame.live {
            return Ok(());
        }
        let part = match (&frame.kind, &frame.around) {
            (Kind::Hull, Around::Hull(hull)) => {
                let shape = hull.hull(&frame.operands, &frame.open.span())?;
                self.place(shape)
            }
            (_, Around::Hull(_)) => {
                if let Some(outer) = self.frames.last_mut() {
                    outer.operands.extend(frame.operands);
                }
                return Ok(());
            }
            _ => frame.kind.combine(&mut self.builder, &frame.children),
        };
        self.give(part, frame.root);
        Ok(())
    }

    /// Adds a finished part to the surrounding block.
    fn give(&mut self, part: SolidId, root: bool) {
        if root {
            self.marked_root.get_or_insert(part);
        } else if let Some(frame) = self.frames.last_mut() {
            frame.children.push(part);
        }
    }

    /// Reads the marks before a node.
    fn marks(&mut self, mut lexeme: Lexeme) -> MarkedNode {
        let mut marks = Marks::default();
        loop {
            match lexeme.token {
                Token::Symbol('*' | '%') => marks.dropped = true,
                Token::Symbol('!') => marks.root = true,
                Token::Symbol('#') => {}
                _ => {
                    let name = lexeme;
                    return MarkedNode { marks, name };
                }
            }
            lexeme = self.cursor.next();
        }
    }

    /// Reads one node, up to the start of its block.
    fn statement(&mut self, first: Lexeme) -> Result<(), SpannedError> {
        let MarkedNode { marks, name } = self.marks(first);
        if name.token != Token::Name {
            return Err(self
                .cursor
                .unexpected(name, "a node such as `cube` or `union`"));
        }
        let mut arguments = Arguments::parse(&mut self.cursor, name)?;
        let outer = self.frames.last();
        let inside_live = outer.is_some_and(|frame| frame.live);
        let live = (inside_live || marks.root) && !marks.dropped;
        let root = marks.root && live;
        let around = match outer {
            Some(frame) if !root => frame.around.clone(),
            _ => Around::Nothing,
        };
        let node = if live {
            let text = self.cursor.text(name);
            nodes::node(
                text,
                name,
                &mut arguments,
                &around,
                self.smooth,
                &mut self.notes,
            )?
        } else {
            Node::Block {
                kind: Kind::Union,
                around,
            }
        };
        match node {
            Node::Shape(shape) => {
                let part = self.place(*shape);
                self.cursor.expect(';', "after a primitive")?;
                self.give(part, root);
                self.close_singles()?;
            }
            Node::Operand(operand) => {
                self.cursor.expect(';', "after a primitive")?;
                if let Some(frame) = self.frames.last_mut() {
                    frame.operands.extend(operand);
                }
                self.close_singles()?;
            }
            Node::Block { kind, around } => self.open_block(kind, around, name, live, root)?,
        }
        Ok(())
    }

    fn place(&mut self, shape: Shape) -> SolidId {
        let Some(MovedPrimitive { primitive, moves }) = shape else {
            return SolidId::EMPTY;
        };
        let part = self.builder.primitive(primitive);
        self.builder.moved(part, moves)
    }

    fn open_block(
        &mut self,
        kind: Kind,
        around: Around,
        open: Lexeme,
        live: bool,
        root: bool,
    ) -> Result<(), SpannedError> {
        let next = self.cursor.peek();
        let single = match next.token {
            Token::Symbol('{') => false,
            Token::Symbol(';' | '*' | '%' | '#' | '!') | Token::Name => true,
            _ => return Err(self.cursor.unexpected(next, "`{`, `;` or a node")),
        };
        if !single {
            self.cursor.next();
        }
        self.frames.push(Frame {
            kind,
            around,
            children: Vec::new(),
            operands: Vec::new(),
            open,
            single,
            live,
            root,
        });
        Ok(())
    }
}
