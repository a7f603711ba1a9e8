#![allow(clippy::unwrap_used, reason = "a test fails by it")]
use super::*;
use crate::figure::Figure;
use premio_kernel::number::rational::to_f64;

fn style(segments: u32) -> TextStyle<'static> {
    TextStyle {
        size: Rational::from(10),
        spacing: Rational::ONE,
        direction: "",
        language: "en",
        script: "",
        horizontal: None,
        vertical: None,
        segments,
    }
}

fn font(name: &str) -> FontFile {
    Fonts::default().find(&FontName::parse(name)).unwrap()
}

/// The box of some contours.
fn bounds(glyphs: &[GlyphContours]) -> [[f64; 2]; 2] {
    let points = glyphs.iter().flatten().flatten();
    let points = points.map(|p| p.each_ref().map(to_f64));
    points.fold([[f64::MAX; 2], [f64::MIN; 2]], |[lo, hi], p| {
        [
            [lo[0].min(p[0]), lo[1].min(p[1])],
            [hi[0].max(p[0]), hi[1].max(p[1])],
        ]
    })
}

#[test]
fn names_of_fonts() {
    let name = |family: &str, style: &str| FontName {
        family: family.to_owned(),
        style: style.to_owned(),
    };
    let regular = name("Liberation Sans", "");
    for text in ["", "Liberation Sans", " Liberation Sans-12", ":style="] {
        assert_eq!(FontName::parse(text), regular);
    }
    let bold = FontName::parse("Liberation Mono:style=Bold Italic:lang=en");
    assert_eq!(bold, name("Liberation Mono", "Bold Italic"));
    assert!(bold.is_bold() && bold.is_italic());
    assert!(
        Fonts::default()
            .find(&FontName::parse("No Such Font"))
            .is_none()
    );
    assert!(
        Fonts::default()
            .find(&FontName::parse("liberationsans"))
            .is_some()
    );
}

/// An `l` is a rectangle: 62 to 242 units of 2048 wide and 1484 high in Liberation Sans.
#[test]
fn a_letter_of_straight_lines() {
    let glyphs = contours("l", &font(""), &style(5)).unwrap();
    assert_eq!(glyphs.len(), 1);
    let figure = Figure::polygon(&glyphs[0]).unwrap();
    assert_eq!(figure.edges().len(), 4);
    let em = 10.0 * 100.0 / 72.0;
    let [lo, hi] = bounds(&glyphs);
    let pixel = f64::from(PIXEL) / f64::from(OUTLINE_UNITS);
    assert!((hi[1] - lo[1] - em * 1484.0 / 2048.0).abs() < pixel);
    assert!((hi[0] - lo[0] - em * 180.0 / 2048.0).abs() < pixel);
}

#[test]
fn texts_are_aligned() {
    let width = |spacing: i32| {
        let spaced = TextStyle {
            spacing: Rational::from(spacing),
            horizontal: Some(HorizontalAlignment::Right),
            ..style(2)
        };
        bounds(&contours("lll", &font(""), &spaced).unwrap())
    };
    let [[left, _], [right, _]] = width(1);
    assert!(left < 0.0 && right < 0.0);
    // Two more advances lie between the first and the last letter.
    let [[wide, _], _] = width(2);
    let advance = 10.0 * 100.0 / 72.0 * 455.0 / 2048.0 * 1000.0 / 1024.0;
    assert!((wide - left + 3.0 * advance).abs() < 1e-3);
    let centred = TextStyle {
        vertical: Some(VerticalAlignment::Center),
        ..style(2)
    };
    let [_, low] = bounds(&contours("l", &font(""), &style(2)).unwrap())[0];
    let [[_, lo], [_, hi]] = bounds(&contours("l", &font(""), &centred).unwrap());
    // The height is measured in other units, and up to whole pixels.
    assert_eq!(low, 0.0);
    assert!((lo + (hi - lo) / 2.0 * 1000.0 / 1024.0).abs() < 0.064);
    let under = TextStyle {
        vertical: Some(VerticalAlignment::Top),
        ..style(2)
    };
    let [_, hi] = bounds(&contours("g", &font(""), &under).unwrap());
    let height = 10.0 * 100.0 / 72.0 * 1082.0 / 2048.0;
    assert!((hi[1] - height * 24.0 / 1024.0).abs() < 0.064);
}

#[test]
fn curves_have_the_given_number_of_segments() {
    let corners = |segments: u32| -> usize {
        let glyphs = contours("o", &font("Liberation Serif"), &style(segments)).unwrap();
        glyphs[0].iter().map(Vec::len).sum()
    };
    let [two, four] = [corners(2), corners(4)];
    assert!(two > 8);
    // A start for each of the two contours.
    assert_eq!(four - 2, 2 * (two - 2));
}

#[test]
fn blanks_and_unknown_characters() {
    let blank = contours("  ", &font(""), &style(2)).unwrap();
    assert!(blank.iter().all(Vec::is_empty));
    assert!(contours("", &font(""), &style(2)).unwrap().is_empty());
    let long = "x".repeat(MAX_CHARACTERS + 1);
    let refused = contours(&long, &font(""), &style(2));
    assert_eq!(refused, Err(LetteringError::TooLong(MAX_CHARACTERS + 1)));
    for size in [-1, 0] {
        let none = TextStyle {
            size: Rational::from(size),
            ..style(2)
        };
        assert_eq!(contours("x", &font(""), &none), Ok(Vec::new()));
    }
    let broken = FontFile {
        bytes: vec![0; 99].into(),
        index: 0,
    };
    assert!(contours("x", &broken, &style(2)).is_err());
    // A character that the font does not have is its box for missing ones.
    assert!(!contours("\u{10ffff}", &font(""), &style(2)).unwrap()[0].is_empty());
}
