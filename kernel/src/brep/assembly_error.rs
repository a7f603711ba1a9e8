//! Why edges do not form a boundary.

use super::region::RegionError;

/// Why edges do not form a boundary. Each is a failure of this program for the part.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AssemblyError {
    /// The coedges of a face do not close at a vertex.
    #[error("the boundary of a face is open at ({:.9}, {:.9}, {:.9})", place[0], place[1], place[2])]
    OpenLoop {
        /// The vertex.
        place: [f64; 3],
    },
    /// The order of a face's edges around a vertex is ambiguous.
    #[error("the edges around ({:.9}, {:.9}, {:.9}) cannot be put in order", place[0], place[1], place[2])]
    AmbiguousVertex {
        /// The vertex.
        place: [f64; 3],
    },
    /// The loops of a surface cannot be grouped into faces.
    #[error(transparent)]
    Region(#[from] RegionError),
    /// A shell encloses no volume that can be distinguished from rounding.
    #[error("a shell near ({:.9}, {:.9}, {:.9}) encloses no volume above rounding", place[0], place[1], place[2])]
    ZeroVolumeShell {
        /// A point of it.
        place: [f64; 3],
    },
    /// It cannot be determined in which solid a void lies.
    #[error("it cannot be determined which solid contains the void at ({:.9}, {:.9}, {:.9})", place[0], place[1], place[2])]
    OrphanVoid {
        /// A point of the void's boundary.
        place: [f64; 3],
    },
}
