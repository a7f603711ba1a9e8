//! `text`: the figures of its glyphs.

use premio_kernel::number::rational::{Rational, to_f64};

use super::super::error::SpannedError;
use super::super::notes::Notes;
use super::super::region::{Region, bad_figure};
use super::arguments::{Argument, Arguments};
use super::facets::fragments;
use crate::figure::{Figure, FigureError, FigureOperation};
use crate::lettering::{
    FontFile, FontName, Fonts, HorizontalAlignment, TextStyle, VerticalAlignment, contours,
};

/// The figures of a text's glyphs; `None` if it shows nothing.
pub(super) fn text(
    arguments: &mut Arguments,
    fonts: &Fonts,
    notes: &mut Notes,
) -> Result<Option<Region>, SpannedError> {
    arguments.bind(&[
        "text",
        "size",
        "font",
        "direction",
        "language",
        "script",
        "halign",
        "valign",
        "spacing",
    ])?;
    let words = arguments.words("text")?;
    let name = FontName::parse(arguments.words("font")?);
    let font = fonts.find(&name).unwrap_or_else(|| {
        let found = format!("there is no font {name}; Liberation Sans is taken instead");
        notes.add(found, arguments.span.clone());
        FontFile::default_for(&name)
    });
    let style = style(arguments)?;
    if style.size.is_zero() {
        return Ok(None);
    }
    let span = &arguments.span;
    let glyphs = contours(words, &font, &style).map_err(|error| {
        SpannedError::input(span.clone(), error.to_string(), "a text that can be set")
    })?;
    let mut regions = Vec::new();
    for glyph in glyphs.iter().filter(|glyph| !glyph.is_empty()) {
        match Figure::turned_about(glyph) {
            Ok(figure) => regions.push(Some(Region::new(figure, span.clone()))),
            Err(FigureError::Empty) => {}
            Err(error) => return Err(bad_figure(&error, span)),
        }
    }
    Region::combined(FigureOperation::Union, regions)
}

/// Whether the font of a text is an embedded one.
pub(super) fn has_embedded_font(arguments: &Arguments) -> Result<bool, SpannedError> {
    let name = FontName::parse(arguments.words("font")?);
    Ok(Fonts::default().find(&name).is_some())
}

fn style(arguments: &Arguments) -> Result<TextStyle<'_>, SpannedError> {
    let number = |name: &str, default: i32| match arguments.find(name) {
        Some(argument) => Ok(argument.number()?.clone()),
        None => Ok(Rational::from(default)),
    };
    let size = number("size", 10)?;
    // Curves of letters are short: they take an eighth of a circle's segments.
    let sides = fragments(arguments, to_f64(&size))?;
    let segments = ((sides / 8.0).floor() + 1.0).clamp(2.0, MAX_SEGMENTS) as u32;
    Ok(TextStyle {
        size,
        spacing: number("spacing", 1)?,
        direction: arguments.words("direction")?,
        language: match arguments.words("language")? {
            "" => "en",
            language => language,
        },
        script: arguments.words("script")?,
        horizontal: horizontal(arguments)?,
        vertical: vertical(arguments)?,
        segments,
    })
}

/// The largest number of segments of a curve.
const MAX_SEGMENTS: f64 = 1000.0;

fn horizontal(arguments: &Arguments) -> Result<Option<HorizontalAlignment>, SpannedError> {
    match arguments.words("halign")? {
        "left" => Ok(Some(HorizontalAlignment::Left)),
        "center" => Ok(Some(HorizontalAlignment::Center)),
        "right" => Ok(Some(HorizontalAlignment::Right)),
        "" | "default" => Ok(None),
        _ => Err(wrong(arguments, "halign", "`left`, `center` or `right`")),
    }
}

fn vertical(arguments: &Arguments) -> Result<Option<VerticalAlignment>, SpannedError> {
    match arguments.words("valign")? {
        "top" => Ok(Some(VerticalAlignment::Top)),
        "center" => Ok(Some(VerticalAlignment::Center)),
        "baseline" => Ok(Some(VerticalAlignment::Baseline)),
        "bottom" => Ok(Some(VerticalAlignment::Bottom)),
        "" | "default" => Ok(None),
        _ => {
            let expected = "`top`, `center`, `baseline` or `bottom`";
            Err(wrong(arguments, "valign", expected))
        }
    }
}

fn wrong(arguments: &Arguments, name: &str, expected: &str) -> SpannedError {
    match arguments.find(name) {
        Some(argument) => Argument::wrong(argument, expected),
        None => SpannedError::input(arguments.span.clone(), format!("no `{name}`"), expected),
    }
}
