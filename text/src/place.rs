//! Places in texts, and names that are near to one another.

/// A line and a column, both from 1; columns count characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineColumn {
    /// The line.
    pub line: usize,
    /// The column.
    pub column: usize,
}

impl LineColumn {
    /// Where a byte of a text stands.
    pub fn new(text: &[u8], at: usize) -> Self {
        let before = &text[..at.min(text.len())];
        let line = before.iter().filter(|&&b| b == b'\n').count() + 1;
        let start = before.iter().rposition(|&b| b == b'\n');
        let start = start.map_or(0, |i| i + 1);
        let column = String::from_utf8_lossy(&before[start..]).chars().count() + 1;
        Self { line, column }
    }
}

/// The name that is nearest to a word, if one is so near that it may be meant.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 64;
    if word.len() > LONGEST {
        return None;
    }
    let word = word.to_lowercase();
    let allowed = match word.chars().count() {
        0 | 1 => return None,
        2 | 3 => 1,
        4..=7 => 2,
        n => n / 2,
    };
    let distance = |name: &str| {
        let name = name.to_lowercase();
        // What a name begins with counts as near to it.
        let starts = name.len() > 2 && word.starts_with(&name);
        strsim::osa_distance(&word, &name).saturating_sub(usize::from(starts))
    };
    let known = known.into_iter().filter(|name| name.len() <= LONGEST);
    known
        .map(|name| (distance(name), name))
        .filter(|(distance, name)| *distance <= allowed || word.starts_with(*name))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_count_characters() {
        let text = "ä = 1\nöb".as_bytes();
        let at = LineColumn::new(text, text.len() - 1);
        assert_eq!(at, LineColumn { line: 2, column: 2 });
        assert_eq!(LineColumn::new(b"", 9), LineColumn { line: 1, column: 1 });
    }

    #[test]
    fn the_name_that_is_meant_is_found() {
        let known = ["focal", "film", "resolution"];
        assert_eq!(nearest("focal_lenght", known), Some("focal"));
        assert_eq!(nearest("flim", known), Some("film"));
        assert_eq!(nearest("dist", known), None);
        assert_eq!(nearest("x", known), None);
    }
}
