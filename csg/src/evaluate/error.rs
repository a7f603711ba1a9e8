//! Why no boundary can be computed for a tree.

use premio_kernel::brep::assembly_error::AssemblyError;
use premio_kernel::brep::check::Violation;
use premio_kernel::geometry::intersect::IntersectionError;

/// Why no boundary can be computed for a tree.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluationError {
    /// Two surfaces intersect in a way that the kernel does not support.
    #[error(transparent)]
    Intersection(#[from] IntersectionError),
    /// The order of the faces around an edge is ambiguous.
    #[error("the order of the faces around an edge near ({:.6}, {:.6}, {:.6}) is ambiguous", place[0], place[1], place[2])]
    AmbiguousEdgeOrder {
        /// The approximate location.
        place: [f64; 3],
    },
    /// It cannot be determined whether a closed surface without an edge is a face.
    #[error(
        "it cannot be determined whether the sphere or torus near ({:.6}, {:.6}, {:.6}) is a face: other surfaces lie within the resolution all over it",
        place[0], place[1], place[2]
    )]
    UndecidedClosedFace {
        /// A point of it.
        place: [f64; 3],
    },
    /// The pieces do not form a boundary.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// Surfaces nearly coincide, so that f64 does not determine their intersection.
    #[error(
        "the intersection near ({:.6}, {:.6}, {:.6}) is known to {distance:.1e} only, and the resolution is {resolution:.1e}: surfaces nearly coincide there",
        place[0], place[1], place[2]
    )]
    IllConditioned {
        /// The approximate location.
        place: [f64; 3],
        /// The distance between entities that should coincide, in the part's unit.
        distance: f64,
        /// The resolution.
        resolution: f64,
    },
    /// A curve runs so close to a surface that their common points cannot be separated.
    #[error(
        "the points near ({:.6}, {:.6}, {:.6}) in which a curve intersects a surface cannot be separated: they nearly coincide there",
        place[0], place[1], place[2]
    )]
    InseparablePoints {
        /// The approximate location.
        place: [f64; 3],
    },
    /// The walls of a frustum are nearly those of a cylinder.
    #[error(
        "the apex of the frustum near ({:.6}, {:.6}, {:.6}) is {away:.1e} away: rounding moves its walls by more than the resolution",
        place[0], place[1], place[2]
    )]
    NearCylinder {
        /// The approximate location.
        place: [f64; 3],
        /// The distance of the apex, in the part's unit.
        away: f64,
    },
    /// In exact evaluation: something that is zero to 237 bits is proven not to be zero.
    #[error(
        "{question} near ({:.6}, {:.6}, {:.6}): they do not coincide, but their distance is below what 237 bits resolve",
        place[0], place[1], place[2]
    )]
    UnprovenCoincidence {
        /// The question.
        question: &'static str,
        /// The approximate location.
        place: [f64; 3],
    },
    /// The faces of a polyhedron cross each other.
    #[error(
        "faces of a polyhedron cross each other near ({:.6}, {:.6}, {:.6}): faces may touch at common edges and corners only",
        place[0], place[1], place[2]
    )]
    SelfIntersection {
        /// The rounded location.
        place: [f64; 3],
    },
    /// The description's numbers are too large or too small for f64.
    #[error("the part's size is beyond the range of lengths from 1e-50 to 1e50")]
    Size,
    /// The part is too far from the origin for f64.
    #[error(
        "the part, of size {size:.3e}, lies up to {far:.3e} from the origin: its coordinates are rounded by more than a millionth of its size"
    )]
    TooFarFromOrigin {
        /// The greatest coordinate.
        far: f64,
        /// The diagonal of its box.
        size: f64,
    },
    /// The resolution is finer than f64 supports, or too coarse for the part.
    #[error(
        "a resolution of {asked:e} is beyond the range from {least:.1e} to {most:.1e} for a part of this size"
    )]
    Resolution {
        /// The requested resolution.
        asked: f64,
        /// The finest resolution that f64 supports.
        least: f64,
        /// The coarsest resolution: a hundredth of the part's size.
        most: f64,
    },
    /// The pairs of faces that may intersect, or their intersection curves and points, exceed the
    /// limit.
    #[error("the faces of the part intersect in more than {most} places, the limit")]
    EntityLimit {
        /// The limit.
        most: usize,
    },
    /// The boundary breaks one of its own rules, so a decision was wrong.
    #[error("the computed boundary is invalid: {0}")]
    InvalidBoundary(Violation),
    /// The tree contradicts a face, so a decision was wrong.
    #[error(
        "the computed boundary has a face near ({:.6}, {:.6}, {:.6}) where the description has none",
        place[0], place[1], place[2]
    )]
    Contradiction {
        /// A point of the face.
        place: [f64; 3],
    },
}

impl EvaluationError {
    /// Whether more bits may succeed where these failed.
    pub(super) fn is_of_rounding(&self) -> bool {
        match self {
            Self::Intersection(_)
            | Self::AmbiguousEdgeOrder { .. }
            | Self::UndecidedClosedFace { .. }
            | Self::Assembly(_)
            | Self::IllConditioned { .. }
            | Self::InseparablePoints { .. }
            | Self::InvalidBoundary(_)
            | Self::Contradiction { .. }
            | Self::NearCylinder { .. }
            | Self::UnprovenCoincidence { .. }
            | Self::Resolution { .. } => true,
            Self::SelfIntersection { .. }
            | Self::Size
            | Self::TooFarFromOrigin { .. }
            | Self::EntityLimit { .. } => false,
        }
    }
}
