//! The colours of faces: styled items of a presentation (ISO 10303-46).

use super::part21::{Exchange, Id, List, Real};
use super::shape::WrittenFace;
use crate::FaceColours;
use premio_kernel::colour::Colour;
use std::collections::BTreeMap;

/// Styles the faces that have a colour, in the context of the shape.
pub(super) fn styles(
    exchange: &mut Exchange,
    colours: &FaceColours,
    context: Id,
    faces: &[WrittenFace],
) {
    let mut known: BTreeMap<Colour, Id> = BTreeMap::new();
    let mut items = Vec::new();
    for face in faces {
        let Some(colour) = colours.of(face.source) else {
            continue;
        };
        let style = *known
            .entry(colour)
            .or_insert_with(|| assignment(exchange, colour));
        let id = face.id;
        items.push(exchange.add(format_args!("STYLED_ITEM('',({style}),{id})")));
    }
    if !items.is_empty() {
        exchange.add(format_args!(
            "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',{},{context})",
            List(&items)
        ));
    }
}

/// The assignment of the style of a colour, for both sides of a surface.
fn assignment(exchange: &mut Exchange, colour: Colour) -> Id {
    let [r, g, b, alpha] = colour.parts();
    let [r, g, b] = [r, g, b].map(Real);
    let colour = exchange.add(format_args!("COLOUR_RGB('',{r},{g},{b})"));
    let fill = exchange.add(format_args!("FILL_AREA_STYLE_COLOUR('',{colour})"));
    let fill = exchange.add(format_args!("FILL_AREA_STYLE('',({fill}))"));
    let mut styles = vec![exchange.add(format_args!("SURFACE_STYLE_FILL_AREA({fill})"))];
    if alpha < 1.0 {
        let through = Real(1.0 - alpha);
        let through = exchange.add(format_args!("SURFACE_STYLE_TRANSPARENT({through})"));
        styles.push(exchange.add(format_args!(
            "SURFACE_STYLE_RENDERING_WITH_PROPERTIES(.NORMAL_SHADING.,{colour},({through}))"
        )));
    }
    let sides = exchange.add(format_args!("SURFACE_SIDE_STYLE('',{})", List(&styles)));
    let usage = exchange.add(format_args!("SURFACE_STYLE_USAGE(.BOTH.,{sides})"));
    exchange.add(format_args!("PRESENTATION_STYLE_ASSIGNMENT(({usage}))"))
}
