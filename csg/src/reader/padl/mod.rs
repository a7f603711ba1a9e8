//! `.padl`: named numbers, solids and figures, one per line.
//!
//! Brackets of all kinds are frames on an explicit stack, so their depth is not limited by the
//! program's stack. An expression is read into steps of a stack machine. Outside of loops and parts
//! with parameters, a step is evaluated as soon as it is read.

mod brackets;
mod budget;
mod code;
mod expression;
mod figures;
mod functions;
mod include;
mod keywords;
mod lists;
mod loops;
mod machine;
mod parser;
mod parts;
mod primitives;
mod remarks;
mod scope;
mod session;
mod sources;
mod statement;

use super::error::SpannedError;
use super::{Program, ReadOptions};
use parser::Parser;
use session::{Session, TextPiece};

pub(super) fn read(
    name: &str,
    source: &str,
    options: &ReadOptions,
) -> Result<Program, SpannedError> {
    let mut session = Session::new(name, source, options);
    match read_all(&mut session, source) {
        Ok(()) => {}
        Err(error) => return Err(session.sources.locate(error)),
    }
    session.finish(source.len())
}

fn read_all(session: &mut Session<'_>, source: &str) -> Result<(), SpannedError> {
    session.check_overrides()?;
    let uncut = read_text(session, source, 0)?;
    if !session.pieces.is_empty() {
        session.pieces.push(TextPiece::Span(uncut..source.len()));
    }
    session.check_applied()
}

/// Reads the statements of a text; returns the position from which the text is unchanged.
fn read_text(session: &mut Session<'_>, source: &str, base: usize) -> Result<usize, SpannedError> {
    let mut parser = Parser::new(session, source, base)?;
    while parser.statement()? {}
    Ok(parser.uncut)
}
