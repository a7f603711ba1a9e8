//! Solids constructed from others: convex hulls, Minkowski sums, affine images, sections and
//! shadows, where these are exact on planes, quadrics of revolution and tori.
//!
//! | module | what it gives |
//! | --- | --- |
//! | `leaves` | the placed primitives of a union, and their columns |
//! | `plane_faces` | the corners and faces of primitives with plane faces |
//! | `evaluated` | the exact boundary of solids with plane faces |
//! | `frames` | rotations along given directions |
//! | `hull` | convex hulls |
//! | `tapered_hull` | hulls of plates with rounded corners about common axes |
//! | `disc_hull` | hulls of discs and points in parallel planes |
//! | `rounding` | sums with a ball |
//! | `minkowski` | other sums |
//! | `affine_map`, `affine` | affine maps, and images under them |
//! | `oblique_prism` | prisms with elliptic walls |
//! | `extent` | sizes along the axes |
//! | `projection` | sections with the plane z = 0, and shadows on it |

mod affine;
mod affine_map;
mod disc_hull;
mod evaluated;
mod extent;
mod frames;
mod hull;
mod leaves;
mod minkowski;
mod oblique_prism;
mod plane_faces;
mod projection;
mod rounding;
mod tapered_hull;

pub use affine::mapped;
pub use affine_map::AffineMap;
pub use extent::extent;
pub use hull::convex_hull;
pub use minkowski::minkowski_sum;
pub use oblique_prism::{ObliquePrism, scaled_prism};
pub use projection::{section, shadow};
pub use tapered_hull::ConvexHull;

use crate::builder::TreeError;
use crate::figure::FigureError;
use crate::polyhedron::PolyhedronError;
use crate::primitive::PrimitiveError;

/// Why a construction has no exact result.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ConstructionError {
    /// The operand is not a union of primitives.
    #[error("a {0} of a difference or an intersection")]
    NotUnion(&'static str),
    /// The hull has faces that are not on planes, cylinders, cones, spheres or tori.
    #[error("a hull with faces that are on no plane, cylinder, cone, sphere or torus")]
    NoHull,
    /// The sum has other faces, or is not supported.
    #[error("a Minkowski sum of these shapes")]
    NoSum,
    /// The map makes other surfaces of revolutions.
    #[error("a map that changes the shape of revolutions")]
    Elliptic,
    /// The figure of a prism with elliptic walls has arcs whose chords cross other edges.
    #[error("a prism with elliptic walls of a figure whose chords cross its edges")]
    CrossedChords,
    /// The section or the shadow has other edges than segments and arcs, or is not supported.
    #[error("a {0} of these shapes")]
    NoProjection(&'static str),
    /// A figure of the result is not valid.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A polyhedron of the result is not valid.
    #[error(transparent)]
    Polyhedron(#[from] PolyhedronError),
    /// A primitive of the result is not valid.
    #[error(transparent)]
    Primitive(#[from] PrimitiveError),
    /// The boundary of a solid, from which its size comes, cannot be evaluated.
    #[error("{0}")]
    Boundary(Box<str>),
    /// The tree exceeds a limit.
    #[error(transparent)]
    Tree(#[from] TreeError),
}

impl ConstructionError {
    /// Whether the result is empty.
    pub fn is_empty(&self) -> bool {
        matches!(
            self,
            Self::Figure(FigureError::Empty)
                | Self::Polyhedron(PolyhedronError::Empty)
                | Self::Primitive(PrimitiveError::Flat)
        )
    }
}
