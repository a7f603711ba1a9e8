//! The boundary as other programs read it.
//!
//! Other kernels keep what ours does not need: seams along closed surfaces, edges that two faces
//! share and no more, a vertex on every edge, splines for the curves in which a torus or two quadrics
//! meet. [`two_manifold`] makes that of a boundary. [`step`] writes it as ISO 10303, with splines within
//! a stated distance of their curves. [`mesh`] writes triangles.

pub mod mesh;
mod parameters;
mod spline;
pub mod step;
pub mod two_manifold;

pub use spline::SplineError;
