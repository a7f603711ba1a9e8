//! The outlines of a text: polygons, as OpenSCAD's `text` gives them.
//!
//! | module | what it gives |
//! | --- | --- |
//! | `fonts` | the font of a name: an embedded one, or one of the machine |
//! | `glyphs` | the contours of a glyph |
//!
//! The corners are those of OpenSCAD 2021.01: HarfBuzz's rules place the glyphs, outlines are in
//! units of 1/1000, and advances, offsets and alignments in units of 1/1024.

mod fonts;
mod glyphs;

pub use fonts::{FontFile, FontName, FontSource, Fonts};

use crate::figure::FigurePoint;
use glyphs::{Glyph, GlyphPen, HALVES};
use harfrust::{Buffer, Direction, Language, Script, ShapeOptions, ShaperFont};
use premio_kernel::number::rational::{Rational, to_f64};
use skrifa::outline::DrawSettings;
use skrifa::prelude::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

/// The parts of a unit length in which outlines are given.
const OUTLINE_UNITS: i32 = 1000;

/// The parts of a unit length in which advances, offsets and alignments are given.
const ADVANCE_UNITS: i32 = 1024;

/// The dots for an inch, and the points of an inch: a text of size 72 has an em of 100.
const RESOLUTION: [i64; 2] = [100, 72];

/// The largest size.
const MAX_SIZE: i32 = 10_000;

/// The outline units of a pixel, to which heights of texts are rounded.
const PIXEL: i32 = 64;

/// The largest number of characters.
pub(crate) const MAX_CHARACTERS: usize = 10_000;

/// Where a text lies along a line, relative to the origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum HorizontalAlignment {
    Left,
    Center,
    Right,
}

/// Where a text lies across its line, relative to the origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum VerticalAlignment {
    Top,
    Center,
    Baseline,
    Bottom,
}

/// How a text is set.
#[derive(Debug, Clone)]
pub(crate) struct TextStyle<'a> {
    pub size: Rational,
    /// A factor of the advance of every glyph.
    pub spacing: Rational,
    /// The direction, or an empty text for the script's.
    pub direction: &'a str,
    pub language: &'a str,
    pub script: &'a str,
    pub horizontal: Option<HorizontalAlignment>,
    pub vertical: Option<VerticalAlignment>,
    /// The number of segments of a curve.
    pub segments: u32,
}

/// Why a text has no outlines.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub(crate) enum LetteringError {
    #[error("a font that cannot be read: {0}")]
    Font(Box<str>),
    #[error("a text of {0} characters; the limit is {MAX_CHARACTERS}")]
    TooLong(usize),
    #[error("a size of more than {MAX_SIZE}")]
    TooLarge,
}

/// The contours of a glyph.
pub(crate) type GlyphContours = Vec<Vec<FigurePoint>>;

/// A glyph and its place, in units.
struct PlacedGlyph {
    glyph: Glyph,
    offset: [i32; 2],
    advance: [i32; 2],
}

/// The contours of the glyphs of a text, as polygons.
///
/// # Errors
/// The font cannot be read, or the text is too long or too large.
pub(crate) fn contours(
    text: &str,
    font: &FontFile,
    style: &TextStyle<'_>,
) -> Result<Vec<GlyphContours>, LetteringError> {
    if text.chars().nth(MAX_CHARACTERS).is_some() {
        return Err(LetteringError::TooLong(text.chars().count()));
    }
    let Some(em) = em(&style.size)? else {
        return Ok(Vec::new());
    };
    let (glyphs, direction) = placed(text, font, style, em)?;
    let is_vertical = matches!(direction, Direction::TopToBottom | Direction::BottomToTop);
    let mut pen = start(&glyphs, style, is_vertical);
    let [outline, advance] = [OUTLINE_UNITS, ADVANCE_UNITS].map(Rational::from);
    let mut all = Vec::new();
    for placed in &glyphs {
        let at: [Rational; 2] = std::array::from_fn(|i| &pen[i] + Rational::from(placed.offset[i]));
        let contours = placed.glyph.polygons(style.segments);
        let moved = |p: &FigurePoint| -> FigurePoint {
            std::array::from_fn(|i| rounded(&(&p[i] / &outline + &at[i] / &advance)))
        };
        let contours = contours.iter().map(|c| c.iter().map(moved).collect());
        all.push(contours.collect());
        for (pen, by) in pen.iter_mut().zip(placed.advance) {
            *pen += Rational::from(by) * &style.spacing;
        }
    }
    Ok(all)
}

/// A coordinate with the decimals that a corner has.
fn rounded(x: &Rational) -> Rational {
    let parts = Rational::from(10_i64.pow(DECIMALS));
    Rational::from((x * &parts).round()) / parts
}

/// The decimals of a corner.
const DECIMALS: u32 = 12;

/// The height of the em in units; `None` if nothing is shown.
fn em(size: &Rational) -> Result<Option<i32>, LetteringError> {
    if *size > Rational::from(MAX_SIZE) {
        return Err(LetteringError::TooLarge);
    }
    let [dots, points] = RESOLUTION;
    let height = to_f64(&(size * Rational::from(OUTLINE_UNITS))).trunc() as i64;
    let em = (height * dots + points / 2) / points;
    Ok(i32::try_from(em).ok().filter(|em| *em > 0))
}

/// The glyphs of a text in their order, and the direction of the text.
fn placed(
    text: &str,
    font: &FontFile,
    style: &TextStyle<'_>,
    em: i32,
) -> Result<(Vec<PlacedGlyph>, Direction), LetteringError> {
    let broken = |why: &dyn std::fmt::Display| LetteringError::Font(why.to_string().into());
    let index = font.index;
    let face = FontRef::from_index(&font.bytes, index).map_err(|e| broken(&e))?;
    let shaped = harfrust::Font::new(font.bytes.to_vec(), index);
    let shaped = shaped.ok_or_else(|| broken(&"no tables"))?;
    let mut buffer = Buffer::new();
    buffer.push_str(&visible(text, &shaped));
    buffer.set_language(style.language.parse::<Language>().ok());
    buffer.set_script(style.script.parse::<Script>().ok());
    if let Ok(direction) = style.direction.parse::<Direction>() {
        buffer.set_direction(direction);
    }
    buffer.guess_segment_properties();
    let direction = buffer.direction();
    let shaper = ShaperFont::new(&shaped).with_scale(em);
    harfrust::shape(&shaper, &mut buffer, ShapeOptions::new()).map_err(|e| broken(&e))?;
    let outlines = face.outline_glyphs();
    let scale = Rational::from(em) / Rational::from(HALVES * i32::from(units_per_em(&face)));
    let size = Size::unscaled();
    let mut glyphs = Vec::new();
    for (info, position) in buffer.glyph_infos().iter().zip(buffer.glyph_positions()) {
        let mut pen = GlyphPen::default();
        if let Some(outline) = outlines.get(info.glyph_id.into()) {
            let settings = DrawSettings::unhinted(size, LocationRef::default());
            outline.draw(settings, &mut pen).map_err(|e| broken(&e))?;
        }
        glyphs.push(PlacedGlyph {
            glyph: pen.glyph(&scale),
            offset: [position.x_offset, position.y_offset],
            advance: [position.x_advance, position.y_advance],
        });
    }
    Ok((glyphs, direction))
}

/// The font units of an em.
fn units_per_em(face: &FontRef<'_>) -> u16 {
    let metrics = face.metrics(Size::unscaled(), LocationRef::default());
    metrics.units_per_em.max(1)
}

/// The text in the codes of the font: symbol fonts have their characters in a private area.
fn visible(text: &str, font: &harfrust::Font) -> String {
    let private = |c: char| char::from_u32(0xf000 + u32::from(c)).filter(|_| u32::from(c) < 0x100);
    match font.charmap().unicode_is_symbol() {
        true => text.chars().map(|c| private(c).unwrap_or(c)).collect(),
        false => text.to_owned(),
    }
}

/// The place where a text starts, in units of advances.
fn start(glyphs: &[PlacedGlyph], style: &TextStyle<'_>, is_vertical: bool) -> [Rational; 2] {
    let advance = |i: usize| {
        let sum: i64 = glyphs.iter().map(|g| i64::from(g.advance[i])).sum();
        Rational::from(sum) * &style.spacing
    };
    // The boxes are rounded to whole pixels.
    let boxes: Vec<[[i32; 2]; 2]> = glyphs.iter().filter_map(|g| g.glyph.pixels()).collect();
    let most = |of: &dyn Fn(&[[i32; 2]; 2]) -> i32| boxes.iter().map(of).max().unwrap_or(0).max(0);
    let (width, above, below) = match is_vertical {
        false => {
            let (above, below) = (most(&|b| b[1][1]), most(&|b| -b[0][1]));
            (advance(0), Rational::from(above), Rational::from(below))
        }
        true => {
            let width = Rational::from(most(&|b| b[1][0] - b[0][0]));
            (width, advance(1), Rational::ZERO)
        }
    };
    let half = |x: Rational| x / Rational::from(2);
    let x = match style.horizontal {
        Some(HorizontalAlignment::Right) => -width,
        Some(HorizontalAlignment::Center) => -half(width),
        Some(HorizontalAlignment::Left) | None => Rational::ZERO,
    };
    let y = match style.vertical {
        Some(VerticalAlignment::Top) => -above,
        Some(VerticalAlignment::Bottom) => below,
        Some(VerticalAlignment::Center) => half(below - above),
        Some(VerticalAlignment::Baseline) | None => Rational::ZERO,
    };
    [x, y]
}

#[cfg(test)]
mod tests;
