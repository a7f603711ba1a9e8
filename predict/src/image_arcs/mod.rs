//! The curves that divide an image into regions: the visible pieces of contours and the boundaries
//! of cast shadows. `highlight` adds the outlines of highlights.

pub(crate) mod arc;
pub(crate) mod crossings;
pub(crate) mod flatten;
pub mod lit_scene;
pub(crate) mod pierce;
pub(crate) mod regions;
pub(crate) mod scanline;
pub(crate) mod shadow;

pub use arc::{ArcSource, PredictedArc};
pub use lit_scene::LitScene;
pub use regions::{Region, RegionPoint, RegionSample, Regions};
