//! `premio convert`: a description in another language.

use crate::arguments::ConvertOptions;
use crate::diagnostics::{CliError, counted};
use crate::session::Session;
use crate::{input, output};
use premio_csg::reader::{self, Format, Program, ReadOptions};
use premio_csg::recover::recovered;
use premio_csg::tree::Tree;
use premio_csg::writer;

/// Runs the command.
pub fn run(options: &ConvertOptions, session: Session) -> Result<(), CliError> {
    let voice = session.voice;
    let name = options.file.display().to_string();
    let target = input::format(&options.output)?;
    let mut source = source(&name, options, session)?;
    let failed = |e: &dyn std::fmt::Display| CliError::limit(format!("{name}: {e}"));
    let mut tree = source.builder.finish(source.part).map_err(|e| failed(&e))?;
    if options.recover {
        match recovered(&tree) {
            Some(recovery) => {
                let described = recovery.to_builder().map_err(|e| failed(&e))?;
                (source.builder, source.part) = described;
                voice.note(&name, &recovery.to_string());
                tree = recovery.tree;
            }
            None => voice.note(&name, NOTHING_RECOVERED),
        }
    }
    if tree.is_empty() {
        voice.note(&name, input::EMPTY);
    }
    let text = match writer::write(&source.builder, source.part, target) {
        Err(e @ writer::WriteError::ReadOnly) => {
            let file = options.output.display();
            return Err(CliError::input(format!("{file}: {e}")));
        }
        written => written.map_err(|e| failed(&e))?,
    };
    // The written text is read again to find what the language could not express.
    let read = reader::read(&name, text.as_bytes(), target, &ReadOptions::default());
    let again =
        read.map_err(|e| CliError::limit(format!("the written text cannot be read: {e}")))?;
    let digits = source.digits.filter(|_| again.digits.is_none());
    let lost = [lost(&tree, &again.tree, target), digits.map(coarse)];
    for note in lost.into_iter().flatten() {
        if options.exact {
            return Err(CliError::limit(format!("{name}: {note}")));
        }
        voice.note(&name, &note);
    }
    output::write(&text, Some(&options.output))
}

/// The note on a description that stays as it is.
const NOTHING_RECOVERED: &str = "no relation of primitives is recovered: the coordinates are not \
    rounded by a program, or all relations are exact";

fn source(name: &str, options: &ConvertOptions, session: Session) -> Result<Program, CliError> {
    let input::DescriptionSource { format, text, how } =
        input::description(&options.file, &options.reading, session)?;
    let source = reader::parse(name, &text, format, &how).map_err(|e| CliError::read(&e, &text))?;
    session.voice.notes(name, &text, &source.notes);
    Ok(source)
}

/// The note on numbers of few digits, which are written with all of theirs.
fn coarse(digits: f64) -> String {
    format!(
        "numbers of few digits: points nearer than {digits:.1e} of the part's size coincide in the \
         file that was read; in the written file they do so only with such a `--resolution`"
    )
}

/// The note on what a language could not express of a tree.
fn lost(tree: &Tree, again: &Tree, target: Format) -> Option<String> {
    if tree == again {
        return None;
    }
    let what = target.ending();
    Some(match tree.departure(again) {
        Some(off) => format!(
            "{} of {} cannot be held exactly by .{what}: written within {:.1e}",
            counted(off.leaves, "primitive"),
            tree.leaves().count(),
            off.furthest
        ),
        None => format!("the part becomes another tree in .{what}; the points are not compared"),
    })
}
