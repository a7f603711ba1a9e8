//! The nodes of a `.csg` file.
//!
//! Nodes are in the order in which they end, so children precede their parents.

use super::super::error::SpannedError;
use super::super::lexer::{Cursor, Lexeme, Token};
use super::arguments::Arguments;
use premio_text::LineColumn;

/// A node with its arguments and children.
pub(super) struct ScadNode {
    /// The name.
    pub name: Lexeme,
    pub arguments: Arguments,
    /// The indices of its children.
    pub children: Vec<usize>,
    /// Whether it contributes to the solid.
    pub is_live: bool,
    /// Whether it is marked with `!`.
    pub is_root: bool,
    /// Whether it is inside a hull or a Minkowski sum.
    pub is_operand: bool,
}

/// All nodes of a file.
pub(super) struct ScadFile {
    pub nodes: Vec<ScadNode>,
    /// The nodes that are in no other.
    pub top: Vec<usize>,
}

/// A block that is still open.
struct Frame {
    name: Lexeme,
    /// `None` for the whole file.
    arguments: Option<Arguments>,
    children: Vec<usize>,
    /// The child is one statement, without braces.
    is_single: bool,
    is_live: bool,
    is_root: bool,
    /// It is inside a hull or a Minkowski sum.
    is_operand: bool,
}

/// The marks before a node, and its name.
struct MarkedNode {
    /// `*` or `%`: not part of the solid.
    is_dropped: bool,
    /// `!`: the only part of the solid.
    is_root: bool,
    name: Lexeme,
}

/// Reads nodes with an explicit stack, so that no nesting is too deep.
struct Parser<'c, 'a> {
    cursor: &'c mut Cursor<'a>,
    frames: Vec<Frame>,
    nodes: Vec<ScadNode>,
}

/// Reads all nodes.
pub(super) fn parse(cursor: &mut Cursor<'_>) -> Result<ScadFile, SpannedError> {
    // If a subtree is marked `!`, everything outside it is ignored.
    let is_live = !cursor.contains('!');
    let name = cursor.peek();
    let file = Frame {
        name,
        arguments: None,
        children: Vec::new(),
        is_single: false,
        is_live,
        is_root: false,
        is_operand: false,
    };
    let mut parser = Parser {
        cursor,
        frames: vec![file],
        nodes: Vec::new(),
    };
    loop {
        let lexeme = parser.cursor.next();
        match lexeme.token {
            Token::End => return parser.end_of_file(lexeme),
            Token::Symbol('}') => parser.close_block(lexeme)?,
            // An empty statement, which may be the whole of a block without braces.
            Token::Symbol(';') => parser.close_singles(),
            _ => parser.statement(lexeme)?,
        }
    }
}

impl Parser<'_, '_> {
    fn end_of_file(mut self, end: Lexeme) -> Result<ScadFile, SpannedError> {
        let last = self.frames.pop();
        match (last, self.frames.is_empty()) {
            (Some(block), false) => {
                let expected = if block.is_single {
                    "a node or `;`"
                } else {
                    "`}`"
                };
                let start = block.name.span().start;
                let line = LineColumn::new(self.cursor.source().as_bytes(), start).line;
                let error = self.cursor.unexpected(end, expected);
                Err(error.help(format!("the block opened on line {line} is not closed")))
            }
            (file, _) => Ok(ScadFile {
                nodes: self.nodes,
                top: file.map_or(Vec::new(), |file| file.children),
            }),
        }
    }

    fn close_block(&mut self, brace: Lexeme) -> Result<(), SpannedError> {
        let closes = self.frames.len() > 1 && self.frames.last().is_some_and(|f| !f.is_single);
        if !closes {
            return Err(self.cursor.unexpected(brace, "a node"));
        }
        self.close_frame();
        self.close_singles();
        Ok(())
    }

    fn close_singles(&mut self) {
        while self.frames.len() > 1 && self.frames.last().is_some_and(|f| f.is_single) {
            self.close_frame();
        }
    }

    fn close_frame(&mut self) {
        let Some(frame) = self.frames.pop() else {
            return;
        };
        let Some(arguments) = frame.arguments else {
            return;
        };
        self.nodes.push(ScadNode {
            name: frame.name,
            arguments,
            children: frame.children,
            is_live: frame.is_live,
            is_root: frame.is_root,
            is_operand: frame.is_operand,
        });
        if let Some(outer) = self.frames.last_mut() {
            outer.children.push(self.nodes.len() - 1);
        }
    }

    /// Reads the marks before a node.
    fn marks(&mut self, mut lexeme: Lexeme) -> MarkedNode {
        let (mut is_dropped, mut is_root) = (false, false);
        loop {
            match lexeme.token {
                Token::Symbol('*' | '%') => is_dropped = true,
                Token::Symbol('!') => is_root = true,
                Token::Symbol('#') => {}
                _ => {
                    return MarkedNode {
                        is_dropped,
                        is_root,
                        name: lexeme,
                    };
                }
            }
            lexeme = self.cursor.next();
        }
    }

    /// Reads one node, up to the start of its block.
    fn statement(&mut self, first: Lexeme) -> Result<(), SpannedError> {
        let MarkedNode {
            is_dropped,
            is_root,
            name,
        } = self.marks(first);
        if name.token != Token::Name {
            let expected = "a node such as `cube` or `union`";
            return Err(self.cursor.unexpected(name, expected));
        }
        let arguments = Arguments::parse(self.cursor, name)?;
        let is_inside_live = self.frames.last().is_some_and(|frame| frame.is_live);
        let is_live = (is_inside_live || is_root) && !is_dropped;
        let next = self.cursor.peek();
        let is_single = match next.token {
            Token::Symbol('{') => false,
            Token::Symbol(';' | '*' | '%' | '#' | '!') | Token::Name => true,
            _ if is_childless(self.cursor.text(name)) => {
                return self.cursor.expect(';', "after a primitive").map(|_| ());
            }
            _ => return Err(self.cursor.unexpected(next, "`{`, `;` or a node")),
        };
        if is_childless(self.cursor.text(name)) && !next.is(';') && is_live {
            return self.cursor.expect(';', "after a primitive").map(|_| ());
        }
        if !is_single {
            self.cursor.next();
        }
        self.frames.push(Frame {
            name,
            arguments: Some(arguments),
            children: Vec::new(),
            is_single,
            is_live,
            is_root: is_root && is_live,
            is_operand: self.frames.last().is_some_and(|outer| {
                let outer_name = outer
                    .arguments
                    .as_ref()
                    .map(|_| self.cursor.text(outer.name));
                outer.is_operand || matches!(outer_name, Some("hull" | "minkowski"))
            }),
        });
        Ok(())
    }
}

/// Whether a node has no block.
fn is_childless(name: &str) -> bool {
    let known = [
        "cube",
        "sphere",
        "cylinder",
        "polyhedron",
        "square",
        "circle",
        "polygon",
        "text",
        "import",
        "surface",
    ];
    known.contains(&name)
}
