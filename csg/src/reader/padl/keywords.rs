//! The words of `.padl`: primitives, figures, operators, motions and functions, and what arguments
//! they take.

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

/// The word of an operation.
pub(super) fn operation_word(operation: Operation) -> &'static str {
    match operation {
        Operation::Union => "UN",
        Operation::Intersection => "INT",
        Operation::Difference => "DIF",
    }
}

/// A function of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Function {
    Sine,
    Cosine,
    Tangent,
    SquareRoot,
    Minimum,
    Maximum,
}

impl Function {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Sine => "sin",
            Self::Cosine => "cos",
            Self::Tangent => "tan",
            Self::SquareRoot => "sqrt",
            Self::Minimum => "min",
            Self::Maximum => "max",
        }
    }

    /// Whether it takes any number of arguments from one, and not one.
    pub(super) fn takes_many(self) -> bool {
        matches!(self, Self::Minimum | Self::Maximum)
    }
}

/// A word with arguments that makes a figure, a solid of a figure, or an unbounded solid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Construction {
    Rectangle,
    Disc,
    Offset,
    Prism,
    Revolution,
    HalfSpace,
    InfiniteCylinder,
    InfiniteCone,
    Outside,
}

impl Construction {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Rectangle => "SQU",
            Self::Disc => "CIR",
            Self::Offset => "OFF",
            Self::Prism => "PRI",
            Self::Revolution => "REV",
            Self::HalfSpace => "HALF",
            Self::InfiniteCylinder => "ICYL",
            Self::InfiniteCone => "ICON",
            Self::Outside => "OUT",
        }
    }

    /// The arguments; those after [`Construction::required`] may be left out.
    pub(super) fn arguments(self) -> &'static [&'static str] {
        match self {
            Self::Rectangle => &["X", "Y"],
            Self::Disc => &["R"],
            Self::Offset => &["FIGURE", "R", "DELTA", "CHAMFER"],
            Self::Prism => &["FIGURE", "H", "TOP"],
            Self::Revolution => &["FIGURE", "ANGLE"],
            Self::HalfSpace => &["NX", "NY", "NZ", "D"],
            Self::InfiniteCylinder => &["R"],
            Self::InfiniteCone => &["SLOPE"],
            Self::Outside => &["SOLID"],
        }
    }

    pub(super) fn required(self) -> usize {
        match self {
            Self::HalfSpace => 3,
            Self::Rectangle | Self::Prism => 2,
            Self::Disc
            | Self::Offset
            | Self::Revolution
            | Self::InfiniteCylinder
            | Self::InfiniteCone
            | Self::Outside => 1,
        }
    }
}

/// A word that makes a figure or a solid from lists of tuples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Outline {
    Polygon,
    Polyhedron,
    ObliqueFrustum,
    Ellipsoid,
}

impl Outline {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Polygon => "PGN",
            Self::Polyhedron => "POLY",
            Self::ObliqueFrustum => "OBL",
            Self::Ellipsoid => "ELL",
        }
    }
}

/// A word with a meaning that a name of the file takes from it.
///
/// It is not reserved: files used such names before the words were added.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Predefined {
    Function(Function),
    Construction(Construction),
    Outline(Outline),
    Hull,
    Pi,
    For,
}

/// All predefined words, in the spelling of messages.
pub(super) const PREDEFINED: [&str; 22] = [
    "sin", "cos", "tan", "sqrt", "pi", "min", "max", "FOR", "SQU", "CIR", "PGN", "OFF", "PRI",
    "REV", "POLY", "OBL", "ELL", "HULL", "HALF", "ICYL", "ICON", "OUT",
];

impl Predefined {
    pub(super) fn new(word: &str) -> Option<Self> {
        Some(match word.to_ascii_uppercase().as_str() {
            "SIN" => Self::Function(Function::Sine),
            "COS" => Self::Function(Function::Cosine),
            "TAN" => Self::Function(Function::Tangent),
            "SQRT" => Self::Function(Function::SquareRoot),
            "MIN" => Self::Function(Function::Minimum),
            "MAX" => Self::Function(Function::Maximum),
            "SQU" => Self::Construction(Construction::Rectangle),
            "CIR" => Self::Construction(Construction::Disc),
            "OFF" => Self::Construction(Construction::Offset),
            "PRI" => Self::Construction(Construction::Prism),
            "REV" => Self::Construction(Construction::Revolution),
            "HALF" => Self::Construction(Construction::HalfSpace),
            "ICYL" => Self::Construction(Construction::InfiniteCylinder),
            "ICON" => Self::Construction(Construction::InfiniteCone),
            "OUT" => Self::Construction(Construction::Outside),
            "PGN" => Self::Outline(Outline::Polygon),
            "POLY" => Self::Outline(Outline::Polyhedron),
            "OBL" => Self::Outline(Outline::ObliqueFrustum),
            "ELL" => Self::Outline(Outline::Ellipsoid),
            "HULL" => Self::Hull,
            "PI" => Self::Pi,
            "FOR" => Self::For,
            _ => return None,
        })
    }
}

/// The word before the step of a range.
pub(super) const STEP: &str = "STEP";

/// The word of a statement that includes a file.
pub(super) const INCLUDE: &str = "INCLUDE";
