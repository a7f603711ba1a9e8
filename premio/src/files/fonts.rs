//! The fonts of the machine.

use fontdb::{Database, Family, Query, Source, Style, Weight};
use premio_csg::lettering::{FontFile, FontName, FontSource};
use std::fmt;
use std::sync::OnceLock;

/// The fonts that are installed on the machine. They are looked up when a text first needs one.
///
/// # Examples
///
/// ```
/// use premio::files::SystemFonts;
/// use premio::{Fonts, ReadOptions};
///
/// let fonts = Fonts::new(SystemFonts::default());
/// let options = ReadOptions { fonts, ..ReadOptions::default() };
/// # let _ = options;
/// ```
#[derive(Default)]
pub struct SystemFonts(OnceLock<Database>);

impl fmt::Debug for SystemFonts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SystemFonts").finish_non_exhaustive()
    }
}

impl SystemFonts {
    fn database(&self) -> &Database {
        self.0.get_or_init(|| {
            let mut all = Database::new();
            all.load_system_fonts();
            all
        })
    }
}

impl FontSource for SystemFonts {
    fn find(&self, name: &FontName) -> Option<FontFile> {
        let all = self.database();
        let query = Query {
            families: &[Family::Name(&name.family)],
            weight: match name.is_bold() {
                true => Weight::BOLD,
                false => Weight::NORMAL,
            },
            style: match name.is_italic() {
                true => Style::Italic,
                false => Style::Normal,
            },
            ..Query::default()
        };
        let face = all.face(all.query(&query)?)?;
        let bytes = match &face.source {
            Source::Binary(bytes) => bytes.as_ref().as_ref().to_vec(),
            Source::File(path) | Source::SharedFile(path, _) => std::fs::read(path).ok()?,
        };
        Some(FontFile {
            bytes: bytes.into(),
            index: face.index,
        })
    }
}
