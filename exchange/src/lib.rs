//! Export of the boundary to other programs.
//!
//! Other kernels need things that this one does not: seams along closed surfaces, edges shared by
//! at most two faces, a vertex on every edge, and splines for the intersection curves of a torus or
//! of two quadrics. [`two_manifold`] converts a boundary to that form. [`step`] writes it as ISO
//! 10303, with splines within a stated distance of their curves. [`mesh`] writes triangles. STEP, glTF
//! and 3MF files have the colours of faces ([`FaceColours`]).

mod face_colours;
pub mod mesh;
mod parameters;
mod rational_circle;
mod spline;
pub mod step;
pub mod two_manifold;

pub use face_colours::FaceColours;
pub use spline::SplineError;
