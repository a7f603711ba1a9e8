//! Tests of drawing files.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

mod dxf;
mod svg;

use super::*;
use crate::figure::Figure;

/// OpenSCAD's number of segments of a full turn, without `$fn`.
fn fragments(radius: f64) -> u32 {
    let by_length = radius * std::f64::consts::TAU / 2.0;
    by_length.clamp(5.0, 30.0).ceil() as u32
}

/// What `import` says by default, with true circles or with OpenSCAD's polygons.
fn with_options<T>(is_faceted: bool, read: impl FnOnce(&mut DrawingOptions<'_>) -> T) -> T {
    let mut sides = |radius: &Rational| {
        let radius = premio_kernel::number::rational::to_f64(radius);
        is_faceted.then(|| fragments(radius))
    };
    let zero = || Rational::ZERO;
    read(&mut DrawingOptions {
        layer: None,
        id: None,
        origin: [zero(), zero()],
        scale: Rational::ONE,
        dpi: Rational::from(72),
        is_centred: false,
        sides: &mut sides,
        fragments: &fragments,
    })
}

/// A decimal.
fn number(text: &str) -> Rational {
    premio_kernel::number::rational::from_decimal(text).unwrap()
}

/// The number of edges, of arcs and of contours.
fn counts(figure: &Figure) -> [usize; 3] {
    let arcs = figure.edges().iter().filter(|edge| edge.arc.is_some());
    [
        figure.edges().len(),
        arcs.count(),
        figure.contours().count(),
    ]
}

fn is_close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a.abs().max(b.abs())
}
