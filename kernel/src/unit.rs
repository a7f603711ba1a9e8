//! The unit of lengths, which matters to files only.

/// A unit of lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unit {
    /// Metres.
    Metre,
    /// Centimetres.
    Centimetre,
    /// Millimetres.
    #[default]
    Millimetre,
    /// Micrometres.
    Micrometre,
    /// Inches of 25.4 mm.
    Inch,
}

impl Unit {
    /// The symbol.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Micrometre => "µm",
            Self::Inch => "in",
        }
    }

    /// The length in millimetres.
    pub fn millimetres(self) -> f64 {
        match self {
            Self::Metre => 1000.0,
            Self::Centimetre => 10.0,
            Self::Millimetre => 1.0,
            Self::Micrometre => 0.001,
            Self::Inch => 25.4,
        }
    }
}
