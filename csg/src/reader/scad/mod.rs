//! `.csg`: OpenSCAD's flattened output.
//!
//! | module | what it gives |
//! | --- | --- |
//! | `arguments` | the arguments of a node |
//! | `syntax` | the nodes of the file |
//! | `facets` | which circles are meant as polygons |
//! | `measures` | lengths and radii |
//! | `figures` | plane figures |
//! | `import` | the contents of other files |
//! | `resize` | new sizes as factors |
//! | `shapes` | solids |
//! | `slices` | how many slices an extrusion has |
//! | `text` | the figures of texts |
//! | `twist` | extrusions that are made of slices |
//! | `sweep` | the arguments of extrusions and revolutions |
//! | `matrix` | motions and scales |
//! | `nodes` | the meaning of every node |

mod arguments;
mod colour;
mod facets;
mod figures;
mod import;
mod matrix;
mod measures;
mod nodes;
mod resize;
mod shapes;
mod slices;
mod sweep;
mod syntax;
mod text;
mod twist;

use self::nodes::Evaluator;
use super::error::SpannedError;
use super::lexer::{Cursor, Dialect};
use super::notes::Remarks;
use super::{PartPlace, Program, ReadOptions, StandaloneText};

/// The relative rounding of the six digits that OpenSCAD writes.
const SIX_DIGITS: f64 = 1e-6;

/// What is advised where circles have no exact result.
const POLYGONS: &str = "with `--facets all` circles are read as OpenSCAD's polygons";

pub(super) fn read(
    name: &str,
    source: &str,
    options: &ReadOptions,
) -> Result<Program, SpannedError> {
    let mut cursor = Cursor::new(source, Dialect::Scad)?;
    let file = syntax::parse(&mut cursor)?;
    let mut evaluator = Evaluator::new(&cursor, name, options);
    let is_literal = evaluator.rule.is_literal();
    let part = evaluator.solid(file).map_err(|error| match is_literal {
        true => error,
        false => error.help_with_circles(POLYGONS),
    })?;
    let Evaluator {
        builder,
        mut notes,
        rule,
        files,
        has_other_fonts,
        ..
    } = evaluator;
    rule.remark(&mut notes);
    let Remarks { digits, notes } = notes.finish();
    Ok(Program {
        builder,
        part,
        digits,
        notes,
        standalone: match has_other_fonts || !files.paths.is_empty() {
            true => StandaloneText::Unavailable,
            false => StandaloneText::AsRead,
        },
        included: files.paths,
        place: PartPlace::new(0..source.len()),
    })
}
