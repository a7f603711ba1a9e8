//! The keywords of `.padl`: primitives, operators, motions, and what arguments they take.

use crate::tree::Operation;

/// The primitives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    Block,
    Wedge,
    Cylinder,
    Cone,
    Sphere,
    Torus,
}

impl Shape {
    pub(super) fn keyword(self) -> &'static str {
        match self {
            Self::Block => "BLO",
            Self::Wedge => "WED",
            Self::Cylinder => "CYL",
            Self::Cone => "CON",
            Self::Sphere => "SPH",
            Self::Torus => "TOR",
        }
    }

    /// The arguments; those after [`Shape::required`] may be left out.
    pub(super) fn arguments(self) -> &'static [&'static str] {
        match self {
            Self::Block | Self::Wedge => &["X", "Y", "Z"],
            Self::Cylinder => &["R", "H"],
            Self::Cone => &["R", "H", "R2"],
            Self::Sphere => &["R"],
            Self::Torus => &["RMAJ", "RMIN"],
        }
    }

    pub(super) fn required(self) -> usize {
        match self {
            Self::Block | Self::Wedge => 3,
            Self::Cylinder | Self::Cone | Self::Torus => 2,
            Self::Sphere => 1,
        }
    }
}

/// The names of the motions: three translations, three rotations.
pub(super) const MOTIONS: [&str; 6] = ["MOVX", "MOVY", "MOVZ", "ROTX", "ROTY", "ROTZ"];

/// A reserved word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Keyword {
    Shape(Shape),
    Operation(Operation),
    At,
}

/// All reserved words, in the spelling of messages.
pub(super) const KEYWORDS: [&str; 10] = [
    "BLO", "WED", "CYL", "CON", "SPH", "TOR", "UN", "INT", "DIF", "AT",
];

impl Keyword {
    pub(super) fn new(word: &str) -> Option<Self> {
        Some(match word.to_ascii_uppercase().as_str() {
            "BLO" => Self::Shape(Shape::Block),
            "WED" => Self::Shape(Shape::Wedge),
            "CYL" => Self::Shape(Shape::Cylinder),
            "CON" => Self::Shape(Shape::Cone),
            "SPH" => Self::Shape(Shape::Sphere),
            "TOR" => Self::Shape(Shape::Torus),
            "UN" => Self::Operation(Operation::Union),
            "INT" => Self::Operation(Operation::Intersection),
            "DIF" => Self::Operation(Operation::Difference),
            "AT" => Self::At,
            _ => return None,
        })
    }
}
