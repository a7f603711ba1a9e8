//! The colours that `color` gives.

use premio_kernel::colour::Colour;
use premio_kernel::number::rational::to_f64;

use super::super::lexer::Cursor;
use super::arguments::Arguments;
use super::syntax::ScadNode;

/// The colour of what each node makes: that of the outermost `color` around it.
pub(super) fn colours(nodes: &[ScadNode], cursor: &Cursor<'_>) -> Vec<Option<Colour>> {
    let mut colours = vec![None; nodes.len()];
    // Children come before their parents.
    for (index, node) in nodes.iter().enumerate().rev() {
        if cursor.text(node.name) == "color" {
            colours[index] = colours[index].or_else(|| colour(&node.arguments));
        }
        for &child in &node.children {
            colours[child] = colours[index];
        }
    }
    colours
}

/// A list of red, green, blue and perhaps the opacity. OpenSCAD writes a colour that it does not know
/// with negative numbers; that, and a name, is none.
fn colour(arguments: &Arguments) -> Option<Colour> {
    let given = arguments.first()?.items("").ok()?;
    let parts = given.iter().map(|part| part.number().ok().map(to_f64));
    let parts: Vec<f64> = parts.collect::<Option<_>>()?;
    let parts = match *parts.as_slice() {
        [r, g, b] => [r, g, b, 1.0],
        [r, g, b, alpha] => [r, g, b, alpha],
        _ => return None,
    };
    parts
        .iter()
        .all(|part| *part >= 0.0)
        .then(|| Colour::new(parts))
}
