//! Why figures cannot be made.

use super::MAX_EDGES;

/// Why contours bound no figure.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// There are too many edges.
    #[error("a figure of {count} edges; the limit is {MAX_EDGES}")]
    TooManyEdges {
        /// The number of edges.
        count: usize,
    },
    /// An arc crosses another edge.
    #[error("an arc crosses another edge near ({x}, {y})", x = at[0], y = at[1])]
    ArcCrosses {
        /// The rounded place.
        at: [String; 2],
    },
    /// An end of an arc is not on its circle.
    #[error("an arc from a point that is not on its circle")]
    OffCircle,
    /// A factor or matrix does not map circles to circles.
    #[error("a map that makes ellipses of arcs")]
    Elliptic,
    /// Too many edges cross or are close to each other.
    #[error("a figure of {count} edges of which too many cross or are close to each other")]
    TooComplex {
        /// The number of edges.
        count: usize,
    },
    /// Edges are so close that it is unclear which of them are one.
    #[error("edges nearly coincide near ({x}, {y}), closer than a figure is known", x = at[0], y = at[1])]
    Undecided {
        /// The rounded place.
        at: [String; 2],
    },
    /// It is unclear in which order a convex hull passes arcs.
    #[error("a convex hull of arcs that nearly coincide")]
    NoHull,
    /// A Minkowski sum is not supported.
    #[error("a Minkowski sum of figures of which none is a disc or a convex polygon")]
    NoSum,
    /// The region is empty.
    #[error("a figure without area")]
    Empty,
}
