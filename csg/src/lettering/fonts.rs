//! Fonts by their names: the Liberation fonts, which are embedded, and those of the machine.

use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

/// The name of a font: its family, and how its characters look.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FontName {
    /// The family.
    pub family: String,
    /// The style, as in `Bold Italic`; empty for the regular one.
    pub style: String,
}

impl FontName {
    /// The name in fontconfig's notation, as in `Liberation Sans:style=Bold`. An empty one is the
    /// default font.
    pub fn parse(text: &str) -> Self {
        let mut parts = text.split(':');
        // A size may follow the family after a dash; names of families have dashes, too.
        let family = parts.next().unwrap_or_default().trim();
        let family = match family.rsplit_once('-') {
            Some((name, size)) if size.parse::<f32>().is_ok() => name.trim(),
            _ => family,
        };
        let style = parts.find_map(|part| {
            let (key, value) = part.split_once('=')?;
            key.trim().eq_ignore_ascii_case("style").then_some(value)
        });
        Self {
            family: match family {
                "" => DEFAULT_FAMILY.to_owned(),
                name => name.to_owned(),
            },
            style: style.unwrap_or_default().trim().to_owned(),
        }
    }

    /// Whether its characters are bold.
    pub fn is_bold(&self) -> bool {
        self.has_word("bold")
    }

    /// Whether its characters are slanted.
    pub fn is_italic(&self) -> bool {
        self.has_word("italic") || self.has_word("oblique")
    }

    fn has_word(&self, word: &str) -> bool {
        self.style.to_ascii_lowercase().contains(word)
    }

    fn is_of(&self, family: &str) -> bool {
        let letters = |text: &str| -> String {
            let kept = text.chars().filter(|c| !c.is_whitespace());
            kept.flat_map(char::to_lowercase).collect()
        };
        letters(&self.family) == letters(family)
    }
}

impl fmt::Display for FontName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.family)?;
        match self.style.is_empty() {
            true => Ok(()),
            false => write!(f, " {}", self.style),
        }
    }
}

/// OpenSCAD's default.
const DEFAULT_FAMILY: &str = "Liberation Sans";

/// The bytes of a font.
#[derive(Debug, Clone)]
pub struct FontFile {
    /// The file.
    pub bytes: Cow<'static, [u8]>,
    /// The index of the font in a collection.
    pub index: u32,
}

/// Finds fonts that are not embedded.
pub trait FontSource: fmt::Debug + Send + Sync {
    /// The font of a name; `None` if there is none of this family.
    fn find(&self, name: &FontName) -> Option<FontFile>;
}

/// The fonts for texts: the embedded ones, and those of a source.
#[derive(Clone, Default)]
pub struct Fonts(Option<Arc<dyn FontSource>>);

impl Fonts {
    /// The embedded fonts and those of a source.
    pub fn new(source: impl FontSource + 'static) -> Self {
        Self(Some(Arc::new(source)))
    }

    /// Whether there are fonts that are not embedded.
    pub fn has_source(&self) -> bool {
        self.0.is_some()
    }

    /// The font of a name; `None` if there is none of its family.
    pub(crate) fn find(&self, name: &FontName) -> Option<FontFile> {
        embedded(name).or_else(|| self.0.as_ref()?.find(name))
    }
}

impl fmt::Debug for Fonts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Fonts").field(&self.0).finish()
    }
}

/// Equal if the source is the same one.
impl PartialEq for Fonts {
    fn eq(&self, other: &Self) -> bool {
        match (&self.0, &other.0) {
            (None, None) => true,
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}

impl Eq for Fonts {}

/// The files of a family: regular, bold, italic, bold italic.
type Family = [&'static [u8]; 4];

macro_rules! family {
    ($name:literal) => {
        [
            include_bytes!(concat!("../../fonts/", $name, "-Regular.ttf")),
            include_bytes!(concat!("../../fonts/", $name, "-Bold.ttf")),
            include_bytes!(concat!("../../fonts/", $name, "-Italic.ttf")),
            include_bytes!(concat!("../../fonts/", $name, "-BoldItalic.ttf")),
        ]
    };
}

/// The embedded families: version 2.1.5 of the Liberation fonts.
static EMBEDDED: [(&str, Family); 3] = [
    ("Liberation Sans", family!("LiberationSans")),
    ("Liberation Serif", family!("LiberationSerif")),
    ("Liberation Mono", family!("LiberationMono")),
];

/// The embedded font of a name.
fn embedded(name: &FontName) -> Option<FontFile> {
    let (_, files) = EMBEDDED.iter().find(|(family, _)| name.is_of(family))?;
    let style = usize::from(name.is_bold()) + 2 * usize::from(name.is_italic());
    Some(FontFile {
        bytes: Cow::Borrowed(files[style]),
        index: 0,
    })
}

impl FontFile {
    /// The default font, in the style of a name.
    pub(crate) fn default_for(name: &FontName) -> Self {
        let (_, files) = &EMBEDDED[0];
        let style = usize::from(name.is_bold()) + 2 * usize::from(name.is_italic());
        Self {
            bytes: Cow::Borrowed(files[style]),
            index: 0,
        }
    }
}
