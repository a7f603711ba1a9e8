//! The boundary as other programs read it.
//!
//! Other kernels keep what ours does not need: seams along closed surfaces, edges that two faces
//! share and no more, a vertex on every edge, splines for the curves in which a torus or two quadrics
//! meet. `seamed` makes that of a boundary, `spline` follows a curve within a stated distance, and
//! `step` writes both as ISO 10303. `mesh` writes triangles.

pub mod mesh;
mod parameters;
pub mod spline;
pub mod step;
pub mod two_manifold;
