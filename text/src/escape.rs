//! Any text, written so that a terminal or a format takes it.
//!
//! What comes from outside (names of files, keys, materials, titles) may hold escape sequences,
//! control characters and marks that turn the direction of what follows.

use std::fmt::Write;

/// Whether a character moves a cursor, sets a colour, ends a line or turns the direction of text.
pub fn is_unsafe(letter: char) -> bool {
    letter.is_control()
        || matches!(letter, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2066}'..='\u{2069}' | '\u{feff}')
}

/// A text for a terminal: what is unsafe by its code, as `\u{1b}`; lines stay lines.
pub fn terminal(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '\n' => shown.push('\n'),
            '\t' => shown.push(' '),
            letter if is_unsafe(letter) => shown.extend(letter.escape_unicode()),
            letter => shown.push(letter),
        }
    }
    shown
}

/// A text of one character each: what is unsafe as the replacement character.
pub fn column_by_column(text: &str) -> String {
    let shown = |letter: char| match letter {
        '\r' | '\t' => ' ',
        letter if is_unsafe(letter) => char::REPLACEMENT_CHARACTER,
        letter => letter,
    };
    text.chars().map(shown).collect()
}

/// A piece of a text for a message: short, on one line, in quotes.
pub fn quote(text: &str) -> String {
    const LONGEST: usize = 40;
    let start: String = text.chars().take(LONGEST).collect();
    let dots = if text.chars().nth(LONGEST).is_some() {
        "…"
    } else {
        ""
    };
    format!("`{}{dots}`", terminal(&start).replace('\n', "\\n"))
}

/// The inside of an XML text or attribute.
pub fn xml(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => shown.push_str("&amp;"),
            '<' => shown.push_str("&lt;"),
            '>' => shown.push_str("&gt;"),
            '"' => shown.push_str("&quot;"),
            '\'' => shown.push_str("&apos;"),
            '\t' | '\n' | '\r' | '\u{7f}'.. if is_unsafe(letter) => {
                // Writing to a string does not fail.
                let _ = write!(shown, "&#x{:X};", letter as u32);
            }
            // XML has no place for these, by their codes either.
            '\0'..='\u{1f}' | '\u{fffe}' | '\u{ffff}' => shown.push(char::REPLACEMENT_CHARACTER),
            letter => shown.push(letter),
        }
    }
    shown
}

/// A serialised JSON text, whose strings may hold unsafe characters that JSON lets pass.
pub fn json(text: String) -> String {
    let passes = |letter: char| letter == '\n' || !is_unsafe(letter);
    if text.chars().all(passes) {
        return text;
    }
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        match passes(letter) {
            true => shown.push(letter),
            // None of them is beyond the first 65,536.
            false => {
                let _ = write!(shown, "\\u{:04x}", letter as u32);
            }
        }
    }
    shown
}

/// The inside of a string of ISO 10303-21: quotes and backslashes twice, what is not ASCII by its
/// UTF-16 code.
pub fn step(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '\'' => shown.push_str("''"),
            '\\' => shown.push_str("\\\\"),
            ' '..='~' => shown.push(letter),
            _ => {
                shown.push_str("\\X2\\");
                for unit in letter.encode_utf16(&mut [0; 2]) {
                    let _ = write!(shown, "{unit:04X}");
                }
                shown.push_str("\\X0\\");
            }
        }
    }
    shown
}

/// A text of DXF: what is no ordinary letter by its UTF-16 code, so that it stays in its line.
pub fn dxf(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            // With a letter behind, a caret would be a control character, a backslash a code.
            '^' | '\\' => {
                let _ = write!(shown, "\\U+{:04X}", letter as u32);
            }
            ' '..='~' => shown.push(letter),
            letter => {
                // Letters beyond the first 65,536 are two.
                for half in letter.encode_utf16(&mut [0; 2]) {
                    let _ = write!(shown, "\\U+{half:04X}");
                }
            }
        }
    }
    shown
}

/// A name in a format of lines that has no escapes: what is unsafe as a space.
pub fn line(text: &str) -> String {
    text.replace(is_unsafe, " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOSTILE: &str = "a\u{1b}[31m<b>&\"c'\u{7f}\u{9b}\u{202e}\r\n\t\u{0}\u{2028}ü";

    #[test]
    fn nothing_unsafe_reaches_a_terminal() {
        let shown = terminal(HOSTILE);
        assert!(
            shown.chars().all(|c| c == '\n' || !is_unsafe(c)),
            "{shown:?}"
        );
        assert!(shown.starts_with("a\\u{1b}[31m<b>"), "{shown}");
        assert!(!column_by_column(HOSTILE).contains(|c: char| c != '\u{fffd}' && is_unsafe(c)));
        assert!(!quote(HOSTILE).contains(is_unsafe));
        assert!(!line(HOSTILE).contains(is_unsafe));
    }

    #[test]
    fn json_is_the_same_text_in_ascii_controls() {
        let written = json(serde_json::to_string(HOSTILE).unwrap());
        assert!(!written.contains(is_unsafe), "{written:?}");
        assert_eq!(serde_json::from_str::<String>(&written).unwrap(), HOSTILE);
    }

    #[test]
    fn xml_has_no_markup_of_the_text() {
        let written = xml(HOSTILE);
        assert!(!written.contains(is_unsafe), "{written:?}");
        assert!(!written.contains(['<', '>', '"', '\'']));
        assert!(written.contains("&lt;b&gt;&amp;&quot;c&apos;&#x7F;&#x9B;&#x202E;&#xD;&#xA;&#x9;"));
    }

    #[test]
    fn step_strings_are_ascii() {
        assert_eq!(step("it's a\\b"), "it''s a\\\\b");
        assert_eq!(
            step("Büchse 😀"),
            "B\\X2\\00FC\\X0\\chse \\X2\\D83DDE00\\X0\\"
        );
        assert!(step(HOSTILE).bytes().all(|b| (32..127).contains(&b)));
    }

    #[test]
    fn dxf_texts_stay_in_their_line() {
        assert_eq!(dxf("Ø\n^J"), "\\U+00D8\\U+000A\\U+005EJ");
        assert!(dxf(HOSTILE).bytes().all(|b| (32..127).contains(&b)));
    }
}
